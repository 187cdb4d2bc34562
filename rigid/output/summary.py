"""A result in a few lines, as text for a terminal and as HTML for a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from math import degrees
from typing import Any

from .units import units_of

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


def title_of_pulse(pulse: Any) -> str:
    """When and where it is."""
    when = f"from t = {pulse.t_start:.6g} to {pulse.t_end:.6g}, phi = {pulse.phi_start:.6g} to {pulse.phi_end:.6g}"
    return f"{type(pulse).__name__} {when}{' (cut)' if pulse.cut else ''}"


def lines_of_pulse(pulse: Any) -> list[Line]:
    """What every pulse has to tell; a cut one has no restitution."""
    rebounds = ("newton", "Newton"), ("poisson", "Poisson"), ("energetic", "energetic")
    told = ", ".join(f"{name} {getattr(pulse, f'{key}_restitution'):.6g}" for key, name in rebounds)
    impulses = f"J_N = {pulse.normal_impulse:.6g}, J_F = {pulse.friction_impulse:.6g}{unit_in(pulse, 'normal_impulse')}"
    return [
        ("impulses", f"{impulses}; J_F/J_N = {pulse.impulse_ratio:.6g}"),
        ("peak N", f"{pulse.peak_normal_force:.6g}{unit_in(pulse, 'peak_normal_force')}"),
        ("friction loss", f"{pulse.friction_loss:.6g}{unit_in(pulse, 'friction_loss')}"),
        *([] if pulse.cut else [("restitution", told)]),
    ]


def lines_of_motion(motion: Any) -> list[Line]:
    """What every motion has to tell."""
    hoop, friction, release = motion.scene.hoop, motion.scene.friction, motion.scene.release
    return [
        ("scene", f"k = {hoop.k:g}, r = {hoop.r:g}, m_h/m = {hoop.mass_ratio:g}, mu_s = {friction.mu_s:g}, "
                  f"mu = {friction.mu:g}, from {degrees(release.phi0):g} degrees"),
        ("phases", some([str(phase.kind) for phase in motion.phases[:SHOWN]], len(motion.phases))),
        ("turns", some([f"phi = {turn.phi:.6g}" for turn in motion.turns[:SHOWN]], len(motion.turns))),
        ("pulses", some([f"J_F/J_N = {p.impulse_ratio:.6g}{' (cut)' if p.cut else ''}"
                         for p in motion.pulses[:SHOWN]], len(motion.pulses))),
    ]  # fmt: skip


def table_of_pulses(pulses: Sequence[Any]) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Header and rows, of the first of them."""
    header = ("pulse", "t", "J_N", "J_F", "J_F/J_N", "friction loss", "peak N")
    rows = [
        (str(number), f"{p.t_start:.6g} to {p.t_end:.6g}", *(f"{value:.6g}" for value in (
            p.normal_impulse, p.friction_impulse, p.impulse_ratio, p.friction_loss, p.peak_normal_force)))
        for number, p in enumerate(pulses[:SHOWN], 1)
    ]  # fmt: skip
    return header, rows


def unit_in(pulse: Any, name: str) -> str:
    """What to print behind a measure of a pulse: its unit, or nothing of a pulse that belongs to no motion."""
    scene = getattr(pulse.sample, "scene", None)
    return "" if scene is None else f" {units_of(type(pulse))[name].label(scene)}"  # type: ignore[arg-type]


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
