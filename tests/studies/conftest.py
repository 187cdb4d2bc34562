"""How the tests of the studies reach the command line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from studies.cli import hoop as cli
from studies.plots import pulse as figures


@pytest.fixture
def hoop(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str, str]]:
    """Run a command line in this process: exit status, stdout, stderr."""

    def run(*arguments: object) -> tuple[int, str, str]:
        status = cli.run([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return status, out, err

    return run


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures of a run are empty files: of commands that are run for what else they leave, and for where."""

    def save(figure: Figure, path: Path) -> Path:
        path.touch()
        return path

    monkeypatch.setattr(figures, "save", save)
