"""Every command in the README runs as printed."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
HANGS = 1800  # seconds; the longest command takes a minute or two, on a busy machine many times that
README = (ROOT / "README.md").read_text(encoding="utf-8")


def commands() -> list[str]:
    """Lines of the README's shell blocks, without those that make the environment this test runs in."""
    blocks = re.findall(r"```sh\n(.*?)```", README, flags=re.DOTALL)
    lines = [line.split("  #")[0].strip() for block in blocks for line in block.splitlines()]
    return [line for line in lines if line and "venv" not in line and not line.startswith("git clone")]


#: what makes a command that takes minutes a short one, appended
LESS = {
    "hoop study stiffness": "--count 3",
    "hoop study limit": "",
    "hoop study hop": "--bisections 0 --rtol 1e-2",
    "hoop study atlas": "--side 64",
    "hoop bench rigid": "",
    "hoop stress": "--scenes 20",
    "hoop validate": "",
    "hoop paper": "",
}


def less(command: str) -> str | None:
    """What to append to a command that takes long, None for one that does not."""
    return next((more for name, more in LESS.items() if command.startswith(f"{name} ") or command == name), None)


def quick(command: str) -> bool:
    return less(command) is None


def run(command: str, folder: Path) -> None:
    """In a process of its own, by the code of this checkout and no other that may be installed."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}
    program, *words = shlex.split(command)
    assert program == "hoop"
    line = [sys.executable, "-c", "from studies.cli import main; main()", *words]
    done = subprocess.run(line, cwd=folder, env=environment, capture_output=True, text=True, timeout=HANGS)
    assert done.returncode == 0, f"{command}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"


@pytest.mark.slow
def test_quick_commands_run_in_their_order(tmp_path: Path) -> None:
    found = [command for command in commands() if quick(command)]
    assert found, "the README shows no command"
    for command in found:
        if ".gif" in command or "--png" in command or "--html" in command:
            pytest.importorskip("pyvista")
            if not renders():
                continue
        run(command, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("command", [command for command in commands() if not quick(command)])
def test_a_long_command_runs(command: str, tmp_path: Path) -> None:
    """As printed, but shorter by more options, and over the two ends of a range alone: some take minutes."""
    ends = re.sub(r"(=[^\s:]+:[^\s:]+):\d+", r"\1:2", command)
    run(f"{ends} {less(command)}", tmp_path)


def test_every_command_that_is_made_shorter_is_shown() -> None:
    shown = [command for command in commands() if not quick(command)]
    assert all(any(command.startswith(name) for command in shown) for name in LESS)


def renders() -> bool:
    from meshes.draw.display import renderer_problem

    return renderer_problem() is None


def test_python_examples_run() -> None:
    blocks = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    assert blocks, "the README shows no Python"
    for block in blocks:
        exec(compile(block, "README.md", "exec"), {})


@pytest.mark.slow
def test_python_examples_are_typed(tmp_path: Path) -> None:
    """For a user's checker, which has the packages and their ``py.typed`` alone."""
    script = tmp_path / "example.py"
    script.write_text("\n".join(re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)), encoding="utf-8")
    options = ["--strict", "--follow-imports", "silent", "--cache-dir", "types"]
    command = [sys.executable, "-m", "mypy", *options, script.name]
    environment = {**os.environ, "MYPYPATH": str(ROOT)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=HANGS)
    assert done.returncode == 0, done.stdout


PAGES = [page for page in sorted(ROOT.glob("**/*.md")) if ".venv" not in page.parts]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_formulas_and_tables_hold_together(page: Path) -> None:
    """A formula that goes on in the next line is none, and a bar in one is the end of a table's cell."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    lines = [re.sub(r"`[^`]*`", "", line) for line in text.splitlines()]
    assert not [line for line in lines if line.replace("$$", "").count("$") % 2]
    tables = re.findall(r"(?:^\|.*\n)+", "\n".join(lines), flags=re.MULTILINE)
    cells = [[len(re.findall(r"(?<!\\)\|", row)) for row in table.splitlines()] for table in tables]
    assert not [counts for counts in cells if len(set(counts)) > 1]


def test_both_set_up_lines_are_one_line_each() -> None:
    lines = [line for line in README.splitlines() if "venv .venv" in line]
    assert len(lines) == 2
    assert sum("pytest" in line for line in lines) == 1
    assert sum("hoop study stiffness" in line for line in lines) == 1
