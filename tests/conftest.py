"""The same examples in every run of the same files, kernels that are compiled and loaded before the first test, a
process for each file.

HYPOTHESIS_PROFILE=explore looks for new examples, as `hoop stress --seed N` does.
"""

import os
import sys

import pytest
from apart import Apart, can_fork
from hypothesis import settings

settings.register_profile("same", derandomize=True, database=None)
settings.register_profile("explore")
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))


def pytest_configure(config: pytest.Config) -> None:
    from studies.machine import one_blas_thread

    one_blas_thread()
    if can_fork(config):
        config.pluginmanager.register(Apart())


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> None:
    """Kernels for all files, whose processes are forked from this one: loaded once, and not by each.

    On a machine that has not run this code yet others compile them: that takes more memory than any test.
    """
    if session.config.option.collectonly or "flexible" not in sys.modules:
        return  # no test that needs the dear one was collected
    from studies.machine.kernels import LEVELS, compile_on_all_cores, missing, prepare

    if missing(LEVELS):
        compile_on_all_cores(("rigid", *LEVELS))
    prepare(*LEVELS)
