"""Tables that fit the screen: what does not fit beside the rest comes below it, and no number is ever cut."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite

from rich.cells import cell_len
from rich.table import Table

_WORDS = 16
"""Cells to which a column of words may be narrowed, its entries then running over several lines."""


def number(value: float | None, digits: int = 6) -> str:
    """A number for a table; a dash for none."""
    if value is None or not isfinite(value):
        return "-"
    return f"{value:.{digits}g}"


def power_of(symbol: str, exponent: float) -> str:
    """A power in words: "ε", "ε^0.667"."""
    return symbol if exponent == 1 else f"{symbol}^{exponent:.3g}"


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a sheet."""

    heading: str
    """Its name and, on a second line, its unit."""
    cells: Sequence[str]
    """What stands in each row."""
    words: bool = False
    """Words may run over several lines and stand to the left; numbers do neither."""
    joined: bool = False
    """Stays beside the column before it, as an uncertainty beside its value."""

    @property
    def natural(self) -> int:
        """Cells of screen that it would like to have."""
        return max(cell_len(line) for text in (self.heading, *self.cells) for line in (text.splitlines() or [""]))

    @property
    def least(self) -> int:
        """Cells of screen that it must have."""
        return min(self.natural, _WORDS) if self.words else self.natural


@dataclass(frozen=True, slots=True)
class Sheet:
    """Rows under a title. The ``keys`` say which row it is; they stand in every block that the ``columns`` are broken
    into."""

    title: str
    keys: Sequence[Column]
    columns: Sequence[Column]
    rules: Sequence[int] = field(default=())
    """Rows above which there is a line."""

    def to_dict(self) -> dict[str, object]:
        """Title, heads and rows, for a page."""
        columns = [*self.keys, *self.columns]
        rows = list(zip(*(column.cells for column in columns), strict=True))
        return {"title": self.title, "heads": [column.heading for column in columns], "rows": rows}

    def tables(self, width: int) -> list[Table]:
        """The sheet in as many tables, one below the other, as a screen of ``width`` cells takes."""
        keys, groups = list(self.keys), _joined(self.columns)
        if groups and _width(keys) + max(map(_extent, groups)) > width and len(keys) > 1:
            numbers = Column("row", [str(n) for n in range(1, len(keys[0].cells) + 1)])
            keys, groups = [numbers], [*([key] for key in keys), *groups]
        blocks: list[list[Column]] = [list(keys)]
        for group in groups:
            if len(blocks[-1]) > len(keys) and _width(blocks[-1]) + _extent(group) > width:
                blocks.append(list(keys))
            blocks[-1] += group
        titles = [self.title, *[f"{self.title}, continued"] * (len(blocks) - 1)]
        return [self._table(title, block, width) for title, block in zip(titles, blocks, strict=True)]

    def _table(self, title: str, columns: list[Column], width: int) -> Table:
        spare = max(width - _width(columns), 0)
        table = Table(title=title, title_justify="left")
        for column in columns:
            more = min(spare, column.natural - column.least)
            spare -= more
            table.add_column(
                column.heading,
                justify="left" if column.words else "right",
                no_wrap=not column.words,
                overflow="fold",
                min_width=column.least + more,
            )
        for number, row in enumerate(zip(*(column.cells for column in columns), strict=True)):
            if number in self.rules:
                table.add_section()
            table.add_row(*row)
        return table


def _joined(columns: Sequence[Column]) -> list[list[Column]]:
    groups: list[list[Column]] = []
    for column in columns:
        if column.joined and groups:
            groups[-1].append(column)
        else:
            groups.append([column])
    return groups


def _extent(columns: Sequence[Column]) -> int:
    """Cells of columns with a space on either side and a line after each."""
    return sum(column.least + 3 for column in columns)


def _width(columns: Sequence[Column]) -> int:
    """Cells of a table of them."""
    return _extent(columns) + 1
