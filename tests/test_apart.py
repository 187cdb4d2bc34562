"""What pytest says of files that ran each in a process of its own, and what they leave behind."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from apart import can_fork

HERE = Path(__file__).parent

CONFTEST = """
from apart import Apart

def pytest_configure(config):
    config.pluginmanager.register(Apart())
"""
FIRST = """
def test_that_passes(tmp_path):
    (tmp_path / "much.bin").write_bytes(bytes(1000))

def test_a_second(tmp_path_factory):
    (tmp_path_factory.mktemp("more") / "much.bin").write_bytes(bytes(1000))
"""
SECOND = """
import os
import signal

def test_that_passes(tmp_path):
    (tmp_path / "much.bin").write_bytes(bytes(1000))

def test_that_fails(tmp_path):
    (tmp_path / "evidence.txt").touch()
    assert "OF_APART" not in os.environ

def test_whose_process_dies(tmp_path):
    if "OF_APART" in os.environ:
        os.kill(os.getpid(), signal.SIGKILL)

def test_behind_it(tmp_path):
    pass
"""


@pytest.fixture(name="run")
def run_of_two_files(tmp_path, request):
    """Run two small files of tests, more in its environment: what it prints, its temporary folder."""
    if not can_fork(request.config):
        pytest.skip("no safe fork here: one process for all")
    files, temporary = tmp_path / "files", tmp_path / "temporary"
    files.mkdir()
    temporary.mkdir()
    for name, text in {"conftest.py": CONFTEST, "test_first.py": FIRST, "test_second.py": SECOND}.items():
        (files / name).write_text(text)

    def run(**more: str) -> tuple[str, Path]:
        of_others = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
        environment = of_others | {"PYTHONPATH": str(HERE), "TMPDIR": str(temporary)} | more
        line = [sys.executable, "-m", "pytest", "-c", str(HERE.parent / "pyproject.toml"), "--rootdir", str(files), "."]
        done = subprocess.run(line, cwd=files, env=environment, capture_output=True, text=True, check=False)
        return done.stdout, temporary

    return run


def test_tests_that_pass_leave_nothing_behind(run):
    told, temporary = run()
    assert "6 passed" in told
    assert [path for path in temporary.rglob("*") if path.is_file()] == []
    assert list(temporary.glob("pytest-of-*/pytest-[0-9]*")) == []


def test_a_failure_and_a_process_that_dies_are_told_and_leave_their_files(run):
    told, temporary = run(OF_APART="fails")
    assert "2 failed, 4 passed" in told
    assert "the process of this file ended: status 9" in told
    assert len(list(temporary.rglob("evidence.txt"))) == 1
    assert list(temporary.rglob("much.bin")) != []
