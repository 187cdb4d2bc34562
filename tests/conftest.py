"""The same examples in every run, kernels that are compiled and loaded before the first test, a process for each file.

HYPOTHESIS_PROFILE=explore looks for new examples, as `hoop stress --seed N` does.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from apart import Apart, can_fork
from hypothesis import settings

settings.register_profile("same", derandomize=True, database=None)
settings.register_profile("explore")
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))

ROOT = Path(__file__).parent.parent


def pytest_configure(config: pytest.Config) -> None:
    if can_fork(config):
        config.pluginmanager.register(Apart())


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> None:
    """Kernels for all files, whose processes are forked from this one: loaded once, and not by each.

    On a machine that has not run this code yet others compile them: that takes more memory than any test.
    """
    if session.config.option.collectonly or "flexible" not in sys.modules:
        return  # no test that needs the dear one was collected
    from studies.running.solvers import LEVELS, missing, prepare

    if absent := missing(LEVELS):
        programs = [f"from studies.running.solvers import prepare; prepare({name!r})" for name in ("rigid", *absent)]
        others = [subprocess.Popen([sys.executable, "-c", program], cwd=ROOT) for program in programs]
        assert [other.wait() for other in others] == [0] * len(others)
    prepare(*LEVELS)
