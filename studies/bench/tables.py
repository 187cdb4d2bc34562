"""Benchmarks as tables on the screen."""

from __future__ import annotations

from math import isfinite
from typing import Any

from rich.table import Table

from .race import Result


def _number(value: float, digits: int = 3) -> str:
    return f"{value:.{digits}g}" if isfinite(value) else "-"


def bench_tables(result: Result) -> list[Any]:
    """Rows, fitted exponents, stated ratios."""
    rows = Table(title="Run time against error", title_justify="left")
    for heading in ("scene", "solver", "setting"):
        rows.add_column(heading)
    for heading in ("median [ms]", "least [ms]", "clock", "error", "peak [MB]"):
        rows.add_column(heading, justify="right")
    rows.add_column("")
    for row in result.rows:
        rows.add_row(
            row.scene, row.solver, row.setting, _number(1e3 * row.median, 4), _number(1e3 * row.least, 4), row.clock,
            _number(row.error, 2), _number(row.peak_memory), row.note,
        )  # fmt: skip
    shown: list[Any] = [rows]
    if result.exponents:
        fits = Table("cost against", "exponent", title="Fitted exponents", title_justify="left")
        for name, power in result.exponents.items():
            fits.add_row(name, f"{power:.2f}")
        shown.append(fits)
    claims = Table(title="Stated ratios", title_justify="left")
    for heading in ("what", "measured", "stated", "holds"):
        claims.add_column(heading, justify="left" if heading == "what" else "right")
    for claim in result.claims:
        sense = "≤" if claim.at_most else "≥"
        holds = claim.why_not or ("yes" if claim.holds else "NO")
        claims.add_row(claim.name, _number(claim.measured), f"{sense} {claim.stated:g}", holds)
    shown.append(claims)
    return shown
