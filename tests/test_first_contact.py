"""The README's two set-up lines in one clone, in either order, and then a user who works somewhere else."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("rigid", "meshes", "flexible", "studies")
NO_REGISTRY = re.compile(r"Could not find a version|No matching distribution|NewConnectionError|ConnectTimeout")


def clone(target: Path) -> Path:
    """What a clone of this checkout has: its files without what git ignores."""
    named = ["README.md", "LICENSE", "CITATION.cff", "pyproject.toml", *PACKAGES, "tests"]
    target.mkdir()
    for name in named:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, target / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copyfile(ROOT / name, target / name)
    return target


def set_up_lines(folder: Path) -> dict[str, str]:
    """The README's lines by name, from the copy in ``folder``, shortened: fewer rungs, one file of tests."""
    text = (folder / "README.md").read_text(encoding="utf-8")
    job, tests = [line for line in text.splitlines() if "venv .venv" in line]
    assert job.endswith("--out study")
    assert tests.endswith("-m pytest")
    return {"job": f"{job} --count 3", "tests": f"{tests} tests/rigid/test_paper_numbers.py"}


def sh(line: str, folder: Path) -> str:
    """Run a line in a shell that knows nothing of this test's environment but caches."""
    hidden = ("PYTHONPATH", "VIRTUAL_ENV", "PYTHONHOME", "PYTHONDONTWRITEBYTECODE")
    environment = {name: value for name, value in os.environ.items() if name not in hidden}
    environment["PATH"] = os.pathsep.join([str(Path(sys.base_prefix) / "bin"), environment.get("PATH", "")])
    environment["PIP_NO_COMPILE"] = "1"  # of two gigabytes most is never imported here
    done = subprocess.run(line, shell=True, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0 and NO_REGISTRY.search(done.stderr):
        pytest.skip(f"no registry to install from: {done.stderr.strip().splitlines()[-1]}")
    assert done.returncode == 0, f"{line}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
    return done.stdout


@pytest.mark.slow
def test_the_two_set_up_lines_after_one_another(tmp_path):
    """The tests' line after the main job's, and the main job's after that: both orders, and all of it installed once.

    The tests' line alone is what .ci/run begins with.
    """
    here = clone(tmp_path / "hoop-pulse")
    lines = set_up_lines(here)
    sh(lines["job"], here)
    assert (here / "study" / "report.html").is_file()
    sh(lines["tests"], here)
    for package in PACKAGES:  # nothing of ours is left where it would hide another installation
        assert not list((here / ".venv").rglob(f"site-packages/{package}"))
    work_elsewhere(here, tmp_path / "after the tests")
    sh(lines["job"], here)
    for package in PACKAGES:  # no link to the clone, which may go
        assert len(list((here / ".venv").rglob(f"site-packages/{package}"))) == 1
    shutil.rmtree(here / "flexible")
    told = work_elsewhere(here, tmp_path / "after the job", "study stiffness paper-3.3-massless --count 3 --out study")
    assert "J_F/J_N" in told
    assert (tmp_path / "after the job" / "study" / "report.html").is_file()


def work_elsewhere(here: Path, elsewhere: Path, more: str = "--version") -> str:
    """``hoop flexible`` and ``hoop view``, by what is installed in a clone, from another folder; what ``more`` says."""
    elsewhere.mkdir()
    hoop = here / ".venv" / "bin" / "hoop"
    assert "J_F/J_N" in sh(f"'{hoop}' flexible paper-3.3-massless --out pulse --fields --frames 3", elsewhere)
    assert (elsewhere / "pulse").is_dir()
    problem = sh(f"'{here}/.venv/bin/python' -c '{RENDERER}'", elsewhere).strip()
    if problem == "None":
        sh(f"'{hoop}' view pulse --png pulse.png", elsewhere)
        assert (elsewhere / "pulse.png").stat().st_size > 0
    else:  # a sentence and no more: nothing to draw with
        with pytest.raises(AssertionError, match="hoop: "):
            sh(f"'{hoop}' view pulse --png pulse.png", elsewhere)
    return sh(f"'{hoop}' {more}", elsewhere)


RENDERER = "from meshes.draw.display import renderer_problem; print(renderer_problem())"


def test_the_copy_of_the_readme_has_both_lines(tmp_path):
    shutil.copyfile(ROOT / "README.md", tmp_path / "README.md")
    assert set(set_up_lines(tmp_path)) == {"job", "tests"}
