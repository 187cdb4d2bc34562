"""How the tests of the studies reach the command line."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from studies.cli import hoop as cli


@pytest.fixture
def hoop(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str, str]]:
    """Run a command line in this process: exit status, stdout, stderr."""

    def run(*arguments: object) -> tuple[int, str, str]:
        status = cli.run([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return status, out, err

    return run
