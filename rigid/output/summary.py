"""A result in a few lines, as text for a terminal and as HTML for a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

Line = tuple[str, str]
"""What is told, and what there is to tell."""

WIDTH = 100  # of a line, after which it is cut
SHOWN = 5  # of a list


def some(items: Sequence[object], count: int | None = None) -> str:
    """How many there are, and the first of them."""
    count = len(items) if count is None else count
    said = ", ".join(str(item) for item in items[:SHOWN])
    return f"{count}" + (f": {said}" if said else "") + (", ..." if count > SHOWN else "")


def text(title: str, lines: Iterable[Line]) -> str:
    """Lines below a title, each with its name in a column of its own."""
    told = list(lines)
    wide = max((len(name) for name, _ in told), default=0)
    rows = [title, *(f"  {name:{wide}}  {content}" for name, content in told)]
    return "\n".join(row if len(row) <= WIDTH else row[: WIDTH - 3] + "..." for row in rows)


def html(title: str, lines: Iterable[Line], header: Sequence[str] = (), rows: Iterable[Sequence[str]] = ()) -> str:
    """The same as HTML, with a table below."""
    told = "".join(f"<tr><th style='text-align:left'>{escape(n)}</th><td>{escape(c)}</td></tr>" for n, c in lines)
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>" if body else ""
    return f"<div><b>{escape(title)}</b><table>{told}</table>{table}</div>"


class Summarised:
    """A result that shows itself: by its title and lines, and in a notebook by a table as well if it has one."""

    __slots__ = ()

    def _title(self) -> str:
        raise NotImplementedError

    def _lines(self) -> Iterable[Line]:
        raise NotImplementedError

    def _table(self) -> tuple[Sequence[str], Iterable[Sequence[str]]]:
        """Header and rows."""
        return (), ()

    def __repr__(self) -> str:
        return text(self._title(), self._lines())

    def _repr_html_(self) -> str:
        return html(self._title(), self._lines(), *self._table())
