"""Curves through a pulse, drawn: forces over time, impulse space, the energy ledger. Nothing here computes physics."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from ..running.history import Columns
from .difference import FORCES
from .style import OKABE_ITO, RIGID, STYLE, UNDER, blank, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["OKABE_ITO", "RIGID", "STYLE", "Curve", "energy", "impulses", "pulse", "save"]

Curve = tuple[str, Columns, Any]
"""A curve through a pulse: its label, its time histories, its colour."""

_WORDS = {
    "kinetic": "kinetic",
    "gravity": "gravity",
    "ring_strain": "strain of the ring",
    "contact_spring": "springs of the contact",
    "friction_loss": "lost to friction",
    "damping_loss": "lost to damping",
    "numerical_loss": "lost to the time integrator",
}


def pulse(
    curves: Sequence[Curve], title: str = "", apart: Sequence[Columns] = (), raised: str = "foundation"
) -> Figure:
    """N, F and slip velocity over time through a pulse; beside it the same around the largest jump of F.

    Time counts from the instant at which the disk is lowest, which all curves share. The last curve is the
    reference, from which the jump is taken; ``apart`` is how far each of the others is from it, and has panels of its
    own, as the curves themselves lie upon one another. ``raised`` is what the labels are values of.
    """
    labels = ("normal force $N/(mg)$", "friction force $F/(mg)$", r"slip velocity $v/\sqrt{gR}$")
    with matplotlib.rc_context(STYLE):
        figure = blank(14.0 if apart else 11.0, 8.0)
        panels = figure.subplots(3, 3 if apart else 2, sharex="col", width_ratios=[3, 2, 3] if apart else [3, 2])
        grid = panels[:, :2]
        low, high = _around_the_jump(curves[-1][1])
        for label, columns, colour in curves:
            t = _since_lowest(columns)
            style: Any = {"color": colour, "label": label, **(UNDER if colour == RIGID else {"alpha": 0.9})}
            for row, name in zip(grid, FORCES, strict=True):
                for axes in row:
                    axes.plot(t, columns[name], **style)
        for (whole, close), name, label in zip(grid, FORCES, labels, strict=True):
            zero = name == "normal_force"
            _robust_limits(whole, [columns[name] for _, columns, _ in curves], floor=zero)
            times = [(_since_lowest(columns), columns[name]) for _, columns, _ in curves]
            _robust_limits(close, [values[(t >= low) & (t <= high)] for t, values in times], floor=zero)
            whole.set_ylabel(label)
            whole.axvspan(low, high, color="0.94", zorder=0)
            close.set_xlim(low, high)
            close.locator_params(axis="x", nbins=6)
            if not zero:
                for axes in (whole, close):
                    axes.axhline(0, color="0.6", linewidth=0.8)
        for column, difference in zip(curves, apart, strict=False):
            for axes, name in zip(panels[:, 2], FORCES, strict=True):
                axes.plot(_since_lowest(column[1]), np.abs(difference[name]), color=column[2], linewidth=1)
        if apart:
            differences = (r"$|\Delta N|/(mg)$", r"$|\Delta F|/(mg)$", r"$|\Delta v|/\sqrt{gR}$")
            for axes, label in zip(panels[:, 2], differences, strict=True):
                _of_differences(axes)
                axes.set_ylabel(label)
            panels[0, 2].set_title("difference from the rigid hoop, same angle, absolute", fontsize=10)
        for axes in panels[2]:
            axes.set_xlabel(r"time since the disk was lowest $t/\sqrt{R/g}$")
        grid[0, 1].set_title("the grey part, enlarged", fontsize=10)
        figure.suptitle(title)
        if len(curves) > 1:
            handles = grid[0, 0].get_legend_handles_labels()
            figure.legend(*handles, loc="outside lower center", ncols=len(curves), title=raised)
        return figure


def of_small_terms(axes: Axes) -> None:
    """The axis of what is drawn of an energy ledger's small terms: eight decades, no more."""
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    axes.set_ylim(max(low, 1e-8 * high), high)
    axes.set_ylabel("the small terms$/(mgR)$")


def _of_differences(axes: Axes, ends: Sequence[np.ndarray] = ()) -> None:
    """The axis of differences: six decades, no more, are what one wants to see; one below the least of the ``ends``."""
    if not any(np.any(np.asarray(line.get_ydata(), dtype=float) > 0) for line in axes.get_lines()):
        return
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    least = min((float(end[0]) for end in ends if end.size and end[0] > 0), default=0.0)
    axes.set_ylim(max(low, 1e-6 * high, 0.1 * least), high)


def _since_lowest(columns: Columns) -> Any:
    """Time since phi = pi (mod 2 pi), or since the start where that is not passed."""
    t, phi = columns["t"], columns["phi"]
    if not t.size:
        return t
    bottom = pi + 2 * pi * np.round((phi.mean() - pi) / (2 * pi))
    passes = np.flatnonzero(np.diff(np.sign(phi - bottom)))
    if not passes.size:
        return t - t[0]
    i = passes[0]
    return t - (t[i] + (t[i + 1] - t[i]) * (bottom - phi[i]) / (phi[i + 1] - phi[i]))


def _around_the_jump(columns: Columns) -> tuple[float, float]:
    """A twelfth of the pulse around the largest jump of F (or, without one, its steepest place)."""
    t, force = _since_lowest(columns), columns["friction_force"]
    if t.size < 3:
        return 0.0, 1.0
    middle = float(t[int(np.argmax(np.abs(np.diff(force))))])
    reach = (t[-1] - t[0]) / 24
    return middle - reach, middle + reach


def _robust_limits(axes: Axes, values: list[np.ndarray], floor: bool = False) -> None:
    """Axis limits from the reference curve and the bulk of the others: one chattering spike must not flatten
    all."""
    ends = []
    for v in values:
        finite = v[np.isfinite(v)]
        if finite.size:
            ends.append((np.quantile(finite, 0.002), np.quantile(finite, 0.998)))
    if ends:
        low, high = min(e[0] for e in ends), max(e[1] for e in ends)
        pad = 0.06 * (high - low or 1.0)
        bottom = 0.0 if floor and low >= -pad else low - pad
        axes.set_ylim(bottom, high + max(pad, 0.06 * (high - bottom)))


def impulses(
    curves: Sequence[Curve], mu: float, apart: Sequence[np.ndarray] = (), raised: str = "foundation"
) -> Figure:
    """The pulse in impulse space: accumulated friction impulse against accumulated normal impulse.

    ``apart`` is how far the friction impulse of each but the last curve is from that at the same normal impulse;
    ``raised`` is what the labels are values of.

    A slope of mu is skidding's opposite, spinning; -mu is skidding; anything flatter is rolling.
    """
    with matplotlib.rc_context(STYLE):
        figure = blank(14.0 if apart else 11.0, 5.0)
        axes, close, *more = figure.subplots(1, 3 if apart else 2, width_ratios=[3, 2, 2.5] if apart else [3, 2])
        reach = max(float(columns["normal_impulse"][-1]) for _, columns, _ in curves if columns["t"].size)
        line = np.array([0.0, reach])
        axes.fill_between(line, -mu * line, mu * line, color="0.95", zorder=0)
        for sign, words in ((1, "spinning: slope $+\\mu$"), (-1, "skidding: slope $-\\mu$")):
            axes.plot(line, sign * mu * line, color="0.5", linewidth=1, linestyle=(0, (5, 3)))
            axes.annotate(
                words,
                (0.62 * reach, sign * mu * 0.62 * reach),
                xytext=(0, 8 * sign),
                textcoords="offset points",
                ha="right",
                va="bottom" if sign > 0 else "top",
                color="0.4",
                fontsize=9,
            )
        for label, columns, colour in curves:
            front: Any = UNDER if colour == RIGID else {}
            axes.plot(columns["normal_impulse"], columns["friction_impulse"], color=colour, label=label, **front)
            if columns["t"].size:
                axes.plot(
                    columns["normal_impulse"][-1],
                    columns["friction_impulse"][-1],
                    "o",
                    color=colour,
                    markersize=4,
                    zorder=6,
                )
        _enlarged_end(close, axes, curves, reach)
        for beside in more:
            for (_, columns, colour), difference in zip(curves, apart, strict=False):
                beside.plot(columns["normal_impulse"], np.abs(difference), color=colour)
            _of_differences(beside, [each[np.isfinite(each)][-1:] for each in map(np.abs, apart)])
            beside.set_xlim(0.75 * reach, 1.02 * reach)
            beside.set_xlabel(r"normal impulse $J_N/(m\sqrt{gR})$")
            beside.set_title("difference of $J_F$ from the rigid hoop, absolute", fontsize=10)
        axes.set_xlim(0, 1.02 * reach)
        axes.set_xlabel(r"normal impulse $J_N/(m\sqrt{gR})$")
        axes.set_ylabel(r"friction impulse $J_F/(m\sqrt{gR})$")
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=len(curves), title=raised)
        return figure


def _enlarged_end(axes: Axes, whole: Axes, curves: Sequence[Curve], reach: float) -> None:
    """The last quarter of the pulse once more, where the curves part."""
    ends = []
    for _, columns, colour in curves:
        x, y = columns["normal_impulse"], columns["friction_impulse"]
        late = x >= 0.75 * reach
        if late.any():
            front: Any = UNDER if colour == RIGID else {}
            axes.plot(x, y, color=colour, **front)
            axes.plot(x[-1], y[-1], "o", color=colour, markersize=5, zorder=6)
            ends.append((y[late].min(), y[late].max()))
    if ends:
        low, high = min(e[0] for e in ends), max(e[1] for e in ends)
        pad = 0.08 * (high - low or 1.0)
        axes.set(xlim=(0.75 * reach, 1.02 * reach), ylim=(low - pad, high + pad))
        whole.indicate_inset_zoom(axes, edgecolor="0.4")
    axes.set_title("the end, enlarged", fontsize=10)
    axes.set_xlabel(r"normal impulse $J_N/(m\sqrt{gR})$")


def energy(columns: Columns, title: str = "") -> Figure | None:
    """The energy ledger through a pulse as stacked areas, and below its small terms on a logarithmic axis.

    None where the solver kept no ledger over time.
    """
    terms = [name for name in OKABE_ITO if name in columns]
    if len(terms) < 3 or columns["t"].size < 2:
        return None
    t = columns["t"] - columns["t"][0]
    with matplotlib.rc_context(STYLE):
        figure = blank(8.0, 6.6)
        stack, small = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
        held = [columns[name] for name in terms]
        stack.stackplot(
            t,
            *held,
            colors=[OKABE_ITO[name] for name in terms],
            labels=[_WORDS[name] for name in terms],
            linewidth=0,
        )
        total = np.sum(held, axis=0)
        stack.plot(t, total, color="black", linewidth=1, label="sum")
        stack.set_ylabel("energy$/(mgR)$")
        stack.set_ylim(min(0.0, float(np.min(held))), 1.08 * float(total.max()))
        stack.set_title(title)
        for name in terms:
            if name not in ("kinetic", "gravity"):
                change = columns[name]
                small.plot(t, np.where(change > 0, change, np.nan), color=OKABE_ITO[name])
        of_small_terms(small)
        small.set_xlabel(r"time since the pulse began $t/\sqrt{R/g}$")
        handles, labels = stack.get_legend_handles_labels()
        figure.legend(handles[::-1], labels[::-1], loc="outside right upper")
        return figure
