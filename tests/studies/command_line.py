"""The command line in a process of its own, and what it may say."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
HANGS = 600
"""Seconds after which a process is taken to hang: on a busy machine one that compiles first may take minutes."""
ROOT = HERE.parents[1]

SCENE = """\
[hoop]
k = {k}
r = 1.02
[friction]
mu_s = 0.35
mu = 0.3
[release]
phi0_deg = 10
[run]
until = "pulse"
"""


def command(*arguments: object) -> list[str]:
    """A command line for a process of its own."""
    return [sys.executable, "-c", "from studies.cli import main; main()", *map(str, arguments)]


def environment(**more: str) -> dict[str, str]:
    """An environment in which this checkout is found and nothing uses more than one thread."""
    path = os.pathsep.join([str(ROOT), str(HERE), *filter(None, [os.environ.get("PYTHONPATH")])])
    return {**os.environ, "PYTHONPATH": path, "OMP_NUM_THREADS": "1", **more}


def process(*arguments: object, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run a command line in a process of its own to its end."""
    settings: dict[str, Any] = {"capture_output": True, "text": True, "timeout": HANGS, "env": environment()}
    return subprocess.run(command(*arguments), check=False, **(settings | options))


def is_one_sentence(err: str) -> bool:
    """Whether stderr holds one line that ends like a sentence, and no traceback."""
    lines = err.strip().splitlines()
    return len(lines) == 1 and lines[0].startswith("hoop: ") and lines[0].endswith((".", "?", "-h."))
