"""All rows, and the table that a screen shows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from math import isfinite
from textwrap import fill
from typing import Any

from ..plots.sheet import Column, Sheet, number
from .row import Row

SOURCES = ("paper", "point_mass", "dispute", "ring", "contact", "limit", "published")


def validate(progress: Callable[[float], object] | None = None) -> list[Row]:
    """Everything published or provable beside what the solvers find, in the order of ``SOURCES``."""
    found: list[Row] = []
    for done, name in enumerate(SOURCES, 1):
        found += import_module(f"{__package__}.{name}").rows()
        if progress is not None:
            progress(done / len(SOURCES))
    return found


def failed(rows: Sequence[Row]) -> list[Row]:
    """The rows that do not hold."""
    return [row for row in rows if row.verdict == "fail"]


def to_dict(rows: Sequence[Row]) -> dict[str, Any]:
    """As JSON prints it."""
    return {"rows": [row.to_dict() for row in rows], "failed": len(failed(rows))}


def fitted(rows: Sequence[Row], width: int) -> list[Any]:
    """All rows for a screen of ``width`` cells: the table where it fits whole, else an entry for each row."""
    whole = sheet(rows)
    return [whole] if len(whole.tables(width)) == 1 else entries(rows, width)


def entries(rows: Sequence[Row], width: int) -> list[str]:
    """Row by row the verdict, what is compared, and below it the value, ours and their difference."""
    sources, indent = _sources(rows), max(len(row.verdict) for row in rows) + 2
    told = []
    for row in rows:
        what = f"[{sources.index(_source(row)) + 1}] {row.what}"
        numbers = f"value {_shown(row.value)}, ours {_shown(row.ours)}"
        if isfinite(row.difference):
            numbers += f", difference {number(row.difference, 2)}"
        if row.within:
            numbers += f", allowed {number(row.within, 2)}"
        ends: Any = {"width": width, "subsequent_indent": " " * indent, "break_on_hyphens": False}
        head = fill(what, initial_indent=row.verdict.ljust(indent), **ends)
        told.append(f"{head}\n{fill(numbers, initial_indent=' ' * indent, **ends)}")
    return told


def sheet(rows: Sequence[Row]) -> Sheet:
    """What is compared, the value, ours, their difference; the sources below, by their numbers."""
    sources = _sources(rows)
    return Sheet(
        "Truth from outside",
        [Column("what", [row.what for row in rows], words=True)],
        [
            Column("value", [_shown(row.value) for row in rows]),
            Column("ours", [_shown(row.ours) for row in rows]),
            Column("difference", [number(row.difference, 2) for row in rows]),
            Column("allowed", [number(row.within or None, 2) for row in rows]),
            Column("verdict", [row.verdict for row in rows]),
            Column("source", [f"[{sources.index(_source(row)) + 1}]" for row in rows]),
        ],
    )


def notes(rows: Sequence[Row]) -> list[str]:
    """The sources by number, what is known of the rows that do not simply hold, and how many do."""
    told = [f"[{place}] {source}" for place, source in enumerate(_sources(rows), 1)]
    told += [f"{row.what}: {row.verdict}; {row.why}." for row in rows if row.verdict != "pass" and row.why]
    count = {
        verdict: sum(row.verdict == verdict for row in rows) for verdict in ("pass", "differs", "no number", "fail")
    }
    said = ", ".join(f"{n} {verdict}" for verdict, n in count.items())
    return [*told, f"{len(rows)} rows: {said}."]


def _source(row: Row) -> str:
    return row.source.partition(", sec.")[0]


def _sources(rows: Sequence[Row]) -> list[str]:
    return list(dict.fromkeys(map(_source, rows)))


def _shown(value: float | str | None) -> str:
    return value if isinstance(value, str) else number(value, 9)
