"""The site has a page for every package with all that its face has, and no link of its own leads nowhere."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from studies import site as pages
from studies.site import PACKAGES, main

pytest.importorskip("pdoc")
slow = pytest.mark.slow  # what looks at the whole site, which takes seconds in a process of its own to build
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built in a process of its own: it writes into the modules' docstrings."""
    out = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "studies.site", str(out)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == str(out / "index.html")
    return out


@pytest.mark.parametrize(("line", "status"), [("--help", 0), ("--out=site", 2), ("a.md", 2)])
def test_what_is_no_folder_is_not_written_to(tmp_path: Path, monkeypatch, line: str, status: int) -> None:
    """An option was a folder of that name, and a file a traceback."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.md").touch()
    told = CliRunner().invoke(main, [line])
    assert told.exit_code == status
    assert "Usage: " in told.output
    assert [path.name for path in tmp_path.iterdir()] == ["a.md"]


def test_an_installed_package_has_no_pages_to_make_a_site_of(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(pages, "ROOT", tmp_path)
    told = CliRunner().invoke(main, [str(tmp_path / "site")])
    assert told.exit_code == 2
    assert "installed package" in told.output
    assert not list(tmp_path.iterdir())


@slow
@pytest.mark.parametrize("package", PACKAGES)
def test_everything_of_a_face_is_there(site: Path, package: str) -> None:
    page = (site / f"{package}.html").read_text(encoding="utf-8")
    names = importlib.import_module(package).__all__
    assert not {name for name in names if f'id="{name}"' not in page}
    for theory in (ROOT / package).rglob("README.md"):
        assert theory.read_text(encoding="utf-8").splitlines()[0].lstrip("# ") in page


@slow
def test_links_lead_somewhere(site: Path) -> None:
    texts = {page.name: page.read_text(encoding="utf-8") for page in site.glob("*.html")}
    for name, text in texts.items():
        for target, place in re.findall(r'(?:src|href)="([^"#:$]*?)(#[^"]*)?"', text):
            assert (site / target).exists(), (name, target)
            aim = texts.get(target or name)
            assert not place or aim is None or f'id="{place[1:]}"' in aim, (name, target, place)


@slow
def test_formulas_are_shown_without_a_network(site: Path) -> None:
    """As many as the theory has, as MathML; no page loads a program from elsewhere, no TeX is left, no word for one."""
    for package in ("rigid", "flexible", "studies"):
        page = (site / f"{package}.html").read_text(encoding="utf-8")
        theory = "".join(path.read_text(encoding="utf-8") for path in (ROOT / package).rglob("README.md"))
        shown = len(re.findall(r"<math[^>]*display=\"block\"", page))
        assert shown == theory.count("```math") + theory.count("$$") // 2 > 0
        words = re.sub(r"<(pre|code).*?</\1>", "", page, flags=re.DOTALL)
        assert not re.search(r"\\(frac|dot|omega|varphi)\b|formula\d+x", words)
    for page in site.glob("*.html"):
        assert not re.search(r"<script[^>]*src=\"http", page.read_text(encoding="utf-8"))
