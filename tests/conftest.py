"""The same examples in every run; HYPOTHESIS_PROFILE=explore looks for new ones, as `hoop stress --seed N` does."""

import os

from hypothesis import settings

settings.register_profile("same", derandomize=True, database=None)
settings.register_profile("explore")
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))
