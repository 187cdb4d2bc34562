"""Benchmarks as tables on the screen."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

from ...plots.sheet import Column, Sheet
from ..race import NAN, Result, Row


def _number(value: float, digits: int = 3) -> str:
    return f"{value:.{digits}g}" if isfinite(value) else "-"


def bench_tables(result: Result) -> list[Any]:
    """Rows, fitted exponents, stated ratios."""
    rows = result.rows
    keys = _keys(rows)
    columns = [
        Column("median\n[ms]", [_number(1e3 * row.median, 4) for row in rows]),
        Column("least\n[ms]", [_number(1e3 * row.least, 4) for row in rows], joined=True),
        Column("clock", [row.clock for row in rows], joined=True),
        Column("error", [_number(row.error, 2) for row in rows]),
        Column("peak\n[MB]", [_number(row.peak_memory) for row in rows]),
    ]
    if any(row.note for row in rows):
        columns.append(Column("note", [row.note for row in rows], words=True))
    shown: list[Any] = [Sheet("Run time against error", keys, columns)]
    if result.compared:
        shown.append(_compared(result))
    if result.parts:
        shown.append(
            _of(
                "What the error is made up of",
                [row for row in rows if result.parts[0] in row.more],
                result.parts,
                error=True,
            )
        )
    for title, names in result.told.items():
        shown.append(_of(title, [row for row in rows if names[0] in row.more], names))
    if result.exponents:
        against = [Column("cost against", list(result.exponents), words=True)]
        powers = [Column("exponent", [f"{power:.2f}" for power in result.exponents.values()])]
        shown.append(Sheet("Fitted exponents", against, powers))
    claims = result.claims
    shown.append(
        Sheet(
            "Stated ratios",
            [Column("what", [claim.name for claim in claims], words=True)],
            [
                Column("measured", [_number(claim.measured) for claim in claims]),
                Column("stated", [f"{'≤' if claim.at_most else '≥'} {claim.stated:g}" for claim in claims]),
                Column("holds", [c.why_not or ("yes" if c.holds else "NO") for c in claims], words=True),
            ],
        )
    )
    return shown


def _of(title: str, rows: Sequence[Row], names: Sequence[str], error: bool = False) -> Sheet:
    """Entries of ``Row.more``, each a column, and the error."""
    columns = [
        Column(name, [_number(row.more.get(name, NAN), 3 if name == "steps" else 2) for row in rows]) for name in names
    ]
    if error:
        columns.append(Column("error", [_number(row.error, 2) for row in rows]))
    return Sheet(title, _keys(rows), columns)


def _keys(rows: Sequence[Row]) -> list[Column]:
    return [Column(name, [getattr(row, name) for row in rows], words=True) for name in ("scene", "solver", "setting")]


def _compared(result: Result) -> Sheet:
    """What the solvers found, and how far off in percent."""
    rows = [row for row in result.rows if any(name in row.more for name in result.compared)]
    keys = _keys(rows)
    columns = []
    for name in result.compared:
        columns.append(Column(name, [_number(row.more.get(name, NAN), 4) for row in rows]))
        off = [_number(100 * row.more.get(f"{name} off", NAN), 2) for row in rows]
        columns.append(Column("off\n[%]", off, joined=True))
    return Sheet("What they found", keys, columns)
