"""What the paper's text says that its figures show, looked for in the points of ours."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import pi

import numpy as np

from rigid import Kind

from . import figures as paper
from .numbers import Verdict
from .panels import Array, Figure
from .sampling import Line, lines, motion_of

CLOSE = 0.05  # "nearly the same": relative to the larger of two curves


def _only(figure: Figure, side: str) -> Line:
    """The curve of a panel that has one."""
    (line,) = lines(figure, side)
    return line


def _labelled(figure: Figure, side: str) -> dict[str, Line]:
    return {line.curve.label: line for line in lines(figure, side)}


def _said(figure: Figure, what: str, ours: str, agrees: bool) -> Verdict:
    return Verdict(
        f"fig. {figure.number}", what, "seen", ours, bool(agrees), "" if agrees else "our curve does not show it"
    )


def _changes(line: Line) -> list[tuple[str, str, int]]:
    """Where a phase ends and the next begins: both kinds, and the index of the later one's first point."""
    at = np.flatnonzero(line.phase[1:] != line.phase[:-1]) + 1
    return [(str(line.phase[i - 1]), str(line.phase[i]), int(i)) for i in at]


def _inside_pulse(line: Line) -> tuple[int, int]:
    """First points of the roll and of the skid inside the first pulse."""
    stops = {(before, after): i for before, after, i in _changes(line)}
    return stops[Kind.SPIN, Kind.ROLL], stops[Kind.ROLL, Kind.SKID]


def figure_2() -> Iterator[Verdict]:
    """Slip velocity, k = 0.1: plateaus, and a second pulse without a reversal."""
    left, right = (_only(paper.FIGURE_2, side) for side in ("left", "right"))
    largest = float(np.abs(left.y[left.phase == Kind.ROLL]).max())
    yield _said(paper.FIGURE_2, "slip is 0 while the hoop rolls", f"|v| <= {largest:g}", largest == 0)
    roll, skid = _inside_pulse(right)
    # the last slipping point before the plateau has its own round-off
    ordered = bool(
        (right.y[: roll - 1] < 0).all() and (right.y[roll:skid] == 0).all() and (right.y[skid + 1 :] > 0).all()
    )
    span = f"t = {right.t[roll]:.5f} to {right.t[skid]:.5f}"
    yield _said(paper.FIGURE_2, "short plateau at 0 in the first pulse, from spinning to skidding", span, ordered)
    second = motion_of("paper-3.1", 6).pulses[1]
    least = float(left.y[(left.t >= second.t_start) & (left.t <= second.t_end)].min())
    yield _said(paper.FIGURE_2, "slip stays positive through the second pulse", f"v >= {least:.3f}", least > 0)


def figure_3() -> Iterator[Verdict]:
    """Normal force, k = 0.1: jumps at the changes of phase, next to nothing between pulses."""
    left, right = (_only(paper.FIGURE_3, side) for side in ("left", "right"))
    for i, change in zip(_inside_pulse(right), ("spin to roll", "roll to skid"), strict=True):
        jump = f"{right.y[i - 1]:.1f} to {right.y[i]:.1f}"
        yield _said(paper.FIGURE_3, f"N jumps from {change} in the first pulse", jump, right.y[i] != right.y[i - 1])
    first, second = motion_of("paper-3.1", 6).pulses[:2]
    gap = second.t_start - first.t_end
    between = left.y[(left.t > first.t_end + gap / 4) & (left.t < second.t_start - gap / 4)]
    small = float(between.max())
    yield _said(
        paper.FIGURE_3, "N is almost 0 between pulses", f"N <= {small:.3f} half way", small < 1e-3 * float(left.y.max())
    )
    slips = _changes(left)[0][2]
    jump = f"{left.y[slips - 1]:.3f} to {left.y[slips]:.3f}"
    yield _said(paper.FIGURE_3, "N jumps at the first roll to spin", jump, left.y[slips] < left.y[slips - 1])


def figure_4() -> Iterator[Verdict]:
    """Friction force, k = 0.1: from +mu N to -mu N."""
    force, normal = _only(paper.FIGURE_4, "right"), _only(paper.FIGURE_3, "right")
    roll, skid = _inside_pulse(force)
    before, after = (force.y[i] / normal.y[i] for i in (roll - 1, skid))
    mu = motion_of("paper-3.1").scene.friction.mu
    agrees = bool(np.allclose([before, after], [mu, -mu], rtol=1e-9))
    ours = f"{before:+.2f} N to {after:+.2f} N in {force.t[skid] - force.t[roll]:.4f}"
    yield _said(paper.FIGURE_4, "F changes from +mu N to -mu N inside the pulse, abruptly", ours, agrees)


def figure_5() -> Iterator[Verdict]:
    """Angular velocity and acceleration: the text states nothing of them."""
    largest = [float(np.abs(_only(paper.FIGURE_5, side).y).max()) for side in ("left", "right")]
    ours = f"to {largest[0]:.4g} and {largest[1]:.4g}"
    yield Verdict("fig. 5", "phidot and phiddot of three cycles: drawn, no number printed", "-", ours, None)


def figure_8() -> Iterator[Verdict]:
    """Light hoops."""
    peaks = [float(line.y.max()) for line in lines(paper.FIGURE_8, "right")]
    falls = peaks[0] > 2 * peaks[1] > 4 * peaks[2]
    ours = ", ".join(f"{peak:.4g}" for peak in peaks)
    yield _said(paper.FIGURE_8, "the peak of N falls dramatically with m_h/m = 0, 0.01, 0.1", ours, falls)


def figure_9() -> Iterator[Verdict]:
    """One density."""
    line = _only(paper.FIGURE_9, "left")
    kinds = ", ".join(sorted(set(line.phase.tolist())))
    yield _said(paper.FIGURE_9, "rolls throughout", kinds, kinds == Kind.ROLL)


def figure_10() -> Iterator[Verdict]:
    """k = 1e-5."""
    ends = [float(line.x[_changes(line)[0][2]]) for line in lines(paper.FIGURE_10, "left")]
    ours = f"to phi = {ends[0]:.4f}, {ends[1]:.4f}"
    yield _said(paper.FIGURE_10, "the first rolling lasts longer with .7/.6 than with .35/.3", ours, ends[1] > ends[0])


def figure_11() -> Iterator[Verdict]:
    """Four frictions: forces."""
    normal, force = (_labelled(paper.FIGURE_11, side) for side in ("left", "right"))
    peaks = {label: float(line.y.max()) for label, line in normal.items()}
    ours = ", ".join(f"{peak:.2f}" for peak in peaks.values())
    yield _said(paper.FIGURE_11, "N is largest without friction", ours, max(peaks, key=lambda k: peaks[k]) == "0/0")
    rough, usual = peaks["1.2/1"], peaks["0.35/0.3"]
    same = abs(rough - usual) < CLOSE * rough
    yield _said(paper.FIGURE_11, "largest N nearly the same for .35 and 1.2", f"{usual:.2f}, {rough:.2f}", same)
    at = np.linspace(pi - 0.3, pi + 0.3, 61)
    f, g, n = (_at(line, at) for line in (force["0.35/0.3"], force["1.2/1"], normal["0.35/0.3"]))
    apart, held = float(np.abs(f - g).max()), float((np.abs(f) / n).max())
    near = apart < CLOSE * np.abs(force["1.2/1"].y).max()
    ours = f"F {apart:.2g} apart, |F| <= {held:.2f} N"
    yield _said(
        paper.FIGURE_11,
        "near phi = pi: F nearly the same for .35 and 1.2, well below .35 N",
        ours,
        near and held < 0.5 * 0.35,
    )
    kinds = ", ".join(sorted(set(normal["1.2/1"].phase.tolist())))
    yield _said(paper.FIGURE_11, "1.2/1 rolls throughout", kinds, kinds == Kind.ROLL)


def figure_12() -> Iterator[Verdict]:
    """Four frictions: squared angular velocity."""
    curves = _labelled(paper.FIGURE_12, "left")
    rolls = curves["1.2/1"]
    worst = 0.0
    for label in ("0.09/0.076", "0.35/0.3"):
        line = curves[label]
        first = _changes(line)[0][2]
        worst = max(worst, float(np.abs(line.y[:first] - _rolled(line.x[:first], rolls)).max()))
    yield _said(paper.FIGURE_12, "phidot^2 is one curve up to each one's first slip", f"to {worst:.0e}", worst < 1e-9)
    usual = curves["0.35/0.3"]
    within = usual.x < rolls.x.max()
    apart = float(np.abs(usual.y[within] - _at(rolls, usual.x[within])).max() / rolls.y.max())
    yield _said(paper.FIGURE_12, "nearly the same for .35 and 1.2", f"{apart:.1%} of the peak apart", apart < 2 * CLOSE)


def _at(line: Line, x: Array) -> Array:
    """A curve at abscissas within it."""
    return np.interp(x, line.x, line.y)


def _rolled(phi: Array, rolls: Line) -> Array:
    """phidot^2 of a hoop that rolls from its release on, (7)."""
    zeta = motion_of(rolls.curve.scene).scene.hoop.constants.zeta
    return 2 * (np.cos(rolls.x[0]) - np.cos(phi)) / (zeta + 2 * (1 + np.cos(phi)))


FIGURES: tuple[Callable[[], Iterator[Verdict]], ...] = (
    figure_2, figure_3, figure_4, figure_5, figure_8, figure_9, figure_10, figure_11, figure_12,
)  # fmt: skip
"""Figures 6 and 7 show numbers alone, which are among those of section 3.2."""


def statements() -> list[Verdict]:
    """Every statement about a figure, looked for in ours."""
    return [verdict for figure in FIGURES for verdict in figure()]
