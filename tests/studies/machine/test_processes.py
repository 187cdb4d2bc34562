"""Worker processes: what comes back from them, and when there are none."""

from __future__ import annotations

import sys
from subprocess import run

import pytest
from command_line import environment

from studies.machine.processes import Processes

AT_ONCE = 60  # seconds, in which a worker starts on a busy machine


class Gone(Exception):
    """What cannot be made again where it is read, for a file that is not there."""

    def __reduce__(self):
        return open, ("/no/such/file",)


def gone() -> Gone:
    return Gone()


@pytest.fixture
def worker():
    processes = Processes(1)
    yield processes
    processes.stop()


def test_an_answer_that_cannot_be_read_is_the_failure_of_its_task(worker):
    """And not of the worker, which goes on."""
    with pytest.raises(FileNotFoundError, match="no/such/file"):
        worker.submit(gone).result(timeout=AT_ONCE)
    with pytest.raises(FileNotFoundError, match="no/such/file"):
        worker.submit(str, Gone()).result(timeout=AT_ONCE)
    assert worker.submit(abs, -3).result(timeout=AT_ONCE) == 3


def test_workers_that_were_ended_take_no_task(worker):
    worker.stop()
    with pytest.raises(RuntimeError, match="ended"):
        worker.submit(abs, -3)


def test_a_script_that_its_workers_would_run_again_is_told(tmp_path):
    """Each of them imports it, and has no pool of its own."""
    script = tmp_path / "script.py"
    script.write_text("from studies.machine.processes import Processes\n\nProcesses(1).submit(abs, -3).result()\n")
    ended = run([sys.executable, str(script)], env=environment(), capture_output=True, text=True, timeout=AT_ONCE)
    assert ended.returncode != 0
    assert "if __name__ == '__main__'" in ended.stderr
