"""The notebooks run, and say what they said when they were stored."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from studies.notebooks.__main__ import BOOKS, HERE, run

pytestmark = pytest.mark.slow
needs_nbclient = pytest.mark.skipif(find_spec("nbclient") is None, reason="nbclient is not installed")

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.\d+(?:e[-+]?\d+)?")
ANY = re.compile(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?")


def outputs(book: Any) -> list[Any]:
    return [o for cell in book.cells if cell.cell_type == "code" for o in cell.outputs]


def printed(book: Any) -> list[str]:
    """What was printed, and what the last lines of cells have shown."""
    shown = {"stream": lambda o: o.text, "execute_result": lambda o: o.data["text/plain"]}
    return [shown[o.output_type](o) for o in outputs(book) if o.output_type in shown]


def pictures(book: Any) -> int:
    return sum("image/png" in o.get("data", {}) for o in outputs(book))


def test_every_notebook_is_listed() -> None:
    assert {path.stem for path in HERE.glob("*.ipynb")} == set(BOOKS)


@needs_nbclient
@pytest.mark.parametrize("name", BOOKS)
def test_a_notebook_runs_as_it_is_stored(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Measures are good to 0.1 %, the tolerance of the runs being 1e-4 at most; what is small prints as small.

    How often a chattering hoop hops is no number to hold a machine to, nor how many steps a run takes: of whole
    numbers, and of that notebook, the words are compared.
    """
    import nbformat

    monkeypatch.delenv("MPLBACKEND", raising=False)
    path: Path = HERE / f"{name}.ipynb"
    stored = nbformat.read(path, as_version=4)
    found = run(path)
    assert pictures(found) == pictures(stored) > 0
    told, before = printed(found), printed(stored)
    assert len(told) == len(before) > 0
    for new, old in zip(told, before, strict=True):
        assert ANY.sub("#", new).split() == ANY.sub("#", old).split()
        if name == "hop":
            continue
        for a, b in zip(map(float, NUMBER.findall(new)), map(float, NUMBER.findall(old)), strict=True):
            assert a == pytest.approx(b, rel=1e-3, abs=1e-4)
