"""Worker processes: what comes back from them, and when there are none."""

from __future__ import annotations

import sys
from multiprocessing.context import SpawnProcess
from pathlib import Path
from subprocess import CompletedProcess, run
from typing import Any

import pytest
from command_line import environment

from studies.machine.processes import Processes, WorkerDied

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


SCRIPT = """\
import studies

with studies.pool(2) as place:
    lists = {"sweep": {"scene": "paper-3.1", "solvers": ["rigid"]}, "hoop": {"k": [0.1, 0.2, 0.3]}}
    print(studies.run_sweep(lists, place))
"""


def run_script(script: Path, **options: Any) -> CompletedProcess[str]:
    words = {"env": environment(), "capture_output": True, "text": True, "timeout": AT_ONCE, "check": False}
    return run([sys.executable, script], **words, **options)


def test_a_script_that_its_workers_would_run_again_is_told_once(tmp_path):
    """Each of them imports it, and would have a pool of its own: it is the error of the sweep, and no row's."""
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    ended = run_script(script)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr.count("Traceback") == 1
    assert "StudyError: No worker can begin" in ended.stderr
    assert "if __name__ == '__main__'" in ended.stderr


def test_a_script_without_a_file_has_no_workers(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    with script.open() as text:
        ended = run_script(Path("-"), stdin=text)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr.count("Traceback") == 1
    assert "there is no file" in ended.stderr


def test_a_script_that_fails_in_its_workers_is_told_with_its_own_words(tmp_path):
    """Whatever it fails of there, the next worker would too."""
    script = tmp_path / "script.py"
    below = SCRIPT.replace("\n", "\n    ")
    script.write_text(f"if __name__ == '__main__':\n    {below}\nelse:\n    raise ValueError('no licence here')\n")
    ended = run_script(script)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert "ValueError: no licence here" in ended.stderr
    assert "StudyError: No worker can begin" in ended.stderr


def test_workers_of_other_processes_than_ours_say_what_they_import(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import multiprocessing\n\nif __name__ == '__main__':\n"
        "    child = multiprocessing.get_context('spawn').Process(target=print)\n    child.start()\n    child.join()\n"
        "else:\n    from studies.machine.processes import Processes\n\n    Processes(1)\n"
    )
    assert "Workers import this script: what is to run once" in run_script(script).stderr


def test_a_worker_that_is_killed_as_it_begins_is_a_death_like_any_other(monkeypatch):
    """Of want of memory, say: the next one may be spared."""
    start, first = SpawnProcess.start, []

    def started(worker):
        start(worker)
        if not first:
            first.append(worker)
            worker.kill()

    monkeypatch.setattr(SpawnProcess, "start", started)
    processes = Processes(1)
    try:
        with pytest.raises(WorkerDied):
            processes.submit(abs, -3).result(timeout=AT_ONCE)
        assert processes.submit(abs, -3).result(timeout=AT_ONCE) == 3
    finally:
        processes.stop()
