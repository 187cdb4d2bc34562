"""The closing table: figure or number, the paper's, ours, agrees or why not; for the screen and as files."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path

from rich import box
from rich.table import Table

from ..running.files import write_text
from ..running.history import rows_to_csv
from .numbers import Verdict, numbers
from .seen import statements

WIDTH = 80  # columns of a plain screen


def closing() -> list[Verdict]:
    """Every printed number, then everything that the text says of a figure."""
    return [number.verdict for number in numbers()] + statements()


def reasons(verdicts: Sequence[Verdict]) -> list[str]:
    """Why some do not agree, each reason once; its place in the list is its number in the table."""
    return list(dict.fromkeys(verdict.why for verdict in verdicts if verdict.why))


def _agrees(verdict: Verdict, why: Sequence[str]) -> str:
    if verdict.agrees is None:
        return "-"
    return "yes" if verdict.agrees else f"no ({why.index(verdict.why) + 1})"


def summary(verdicts: Sequence[Verdict]) -> str:
    """How many agree, in a sentence."""
    compared = [verdict.agrees for verdict in verdicts if verdict.agrees is not None]
    agree = sum(compared)
    rest = len(compared) - agree
    told = f"{agree} of {len(compared)} agree, numbers to one unit of the last digit that the paper prints or cuts off"
    return told + (f"; for the other {rest} the reasons are:" if rest else ".")


def screen(verdicts: Sequence[Verdict]) -> list[Table | str]:
    """As a table no wider than a plain screen, and the reasons under it."""
    why = reasons(verdicts)
    table = Table(
        title="The paper's figures and numbers, and ours",
        title_justify="left",
        box=box.SIMPLE_HEAD,
        padding=0,
        pad_edge=False,
    )
    for heading, width in (("where", 12), ("what", 31), ("paper", 9), ("ours", 14)):
        table.add_column(heading, width=width, justify="left" if width > 9 else "right")
    table.add_column("agrees", width=6)
    for verdict in verdicts:
        table.add_row(verdict.place, verdict.what, verdict.paper, verdict.ours, _agrees(verdict, why))
    notes = (f"({i}) {reason}." for i, reason in enumerate(why, 1))
    return [table, *(textwrap.fill(text, WIDTH) for text in (summary(verdicts), *notes))]


def write(verdicts: Sequence[Verdict], captions: Sequence[str], out: Path) -> None:
    """``table.csv`` with all digits and ``table.md`` with the figures' captions."""
    rows = (
        [v.place, v.what, v.paper, v.ours, "" if v.difference is None else f"{v.difference:.2g}", v.agrees, v.why]
        for v in verdicts
    )
    header = ["where", "what", "paper", "ours", "difference", "agrees", "why not"]
    write_text(out / "table.csv", rows_to_csv(header, rows))
    why = reasons(verdicts)
    head = ["where", "what", "paper", "ours", "agrees"]
    cells = [[v.place, v.what, v.paper, v.ours, _agrees(v, why)] for v in verdicts]
    lines = [
        "| " + " | ".join(entry.replace("|", "\\|") for entry in row) + " |"
        for row in [head, ["---"] * len(head), *cells]
    ]
    notes = [f"{i}. {reason}." for i, reason in enumerate(why, 1)]
    text = ["# The paper's figures and numbers, and ours", "", *lines, "", summary(verdicts), "", *notes, ""]
    write_text(out / "table.md", "\n".join([*text, "## Figures", "", *captions, ""]))
