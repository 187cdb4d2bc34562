"""Worker processes: what they have from the beginning, and what of the process that asks for them."""

from __future__ import annotations

import os
import sys

import pytest

from studies.machine.processes import Processes

AHEAD = "this"  # nothing but a test imports it


@pytest.fixture
def workers():
    made = []

    def make(*arguments):
        made.append(Processes(*arguments))
        return made[-1]

    yield make
    for processes in made:
        processes.stop()


def loaded(name: str) -> bool:
    return name in sys.modules


@pytest.mark.skipif(sys.platform != "linux", reason="workers are forked on Linux alone")
def test_what_tasks_take_is_there_before_the_first_of_them(workers):
    assert AHEAD not in sys.modules
    assert workers(1, (AHEAD,)).submit(loaded, AHEAD).result()
    assert not workers(1).submit(loaded, AHEAD).result()


@pytest.mark.parametrize("ahead", [(), (AHEAD,)], ids=["each by itself", "forked"])
def test_a_worker_has_the_environment_of_now(workers, monkeypatch, ahead):
    """However old the process that it is forked from; but one thread for a core."""
    for value in ("before", "now"):
        monkeypatch.setenv("HOOP_PULSE_TEST", value)
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
        processes = workers(1, ahead)
        assert processes.submit(os.getenv, "HOOP_PULSE_TEST").result() == value
        assert processes.submit(os.getenv, "OPENBLAS_NUM_THREADS").result() == "1"
    assert os.environ["OPENBLAS_NUM_THREADS"] == "7"
