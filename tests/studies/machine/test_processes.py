"""Worker processes: what they have from the beginning, and what of the process that asks for them."""

from __future__ import annotations

import os
import sys

import pytest

from studies.machine.processes import Processes

AHEAD = "this"  # nothing but a test imports it

on_linux = pytest.mark.skipif(sys.platform != "linux", reason="workers are forked there alone")


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


@on_linux
def test_what_tasks_take_is_there_before_the_first_of_them(workers):
    assert AHEAD not in sys.modules
    assert workers(1, (AHEAD,)).submit(loaded, AHEAD).result()
    assert not workers(1).submit(loaded, AHEAD).result()


@on_linux
@pytest.mark.parametrize("trouble", [OSError("AF_UNIX path too long"), EOFError("unexpected EOF")])
def test_where_none_can_be_forked_each_is_by_itself(workers, monkeypatch, trouble):
    def refused(worker):
        raise trouble

    monkeypatch.setattr("multiprocessing.context.ForkServerProcess.start", refused)
    processes = workers(2, (AHEAD,))
    for _ in range(2):
        assert not processes.submit(loaded, AHEAD).result()


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
