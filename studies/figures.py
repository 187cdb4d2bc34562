"""How things are drawn. Every figure is a matplotlib Figure; nothing here computes physics.

Colours are told apart by every kind of colour vision: the rigid hoop is black, stiffness runs through viridis
(which also grows lighter), and areas take the Okabe-Ito set.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .files import write_whole
from .history import Columns, dimensionless
from .limits import CONFIDENCE, Limit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .stiffness import Rung, StiffnessStudy

Curve = tuple[str, Columns, Any]
"""A curve through a pulse: its label, its time histories, its colour."""

STYLE: Any = {
    "figure.dpi": 110,
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "lines.linewidth": 1.4,
    "savefig.facecolor": "white",
}

RIGID = "black"
_FRONT = {"linewidth": 1.8, "zorder": 5}
OKABE_ITO = {
    "kinetic": "#0072B2",
    "gravity": "#56B4E9",
    "ring_strain": "#009E73",
    "contact_spring": "#F0E442",
    "friction_loss": "#D55E00",
    "damping_loss": "#CC79A7",
    "numerical_loss": "#999999",
}
_WORDS = {
    "kinetic": "kinetic",
    "gravity": "gravity",
    "ring_strain": "strain of the ring",
    "contact_spring": "springs of the contact",
    "friction_loss": "lost to friction",
    "damping_loss": "lost to damping",
    "numerical_loss": "lost to the time integrator",
}


def _figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as PNG, whole or not at all."""
    return write_whole(path, lambda part: figure.savefig(part, format="png", dpi=150))


def colours(count: int) -> list[tuple[float, float, float, float]]:
    """Colours for growing stiffness, dark to light, the yellow end left out as too faint for a line."""
    return [tuple(c) for c in matplotlib.colormaps["viridis"](np.linspace(0.0, 0.88, max(count, 1)))]


def power_of_ten(value: float) -> str:
    """A stiffness as 10^7 or 3.2·10^7."""
    exponent = int(np.floor(np.log10(value) + 1e-9))
    mantissa = value / 10.0**exponent
    return f"$10^{{{exponent}}}$" if abs(mantissa - 1) < 0.02 else f"${mantissa:.2g}\\cdot 10^{{{exponent}}}$"


def pulse(curves: Sequence[Curve], title: str = "") -> Figure:
    """N, F and slip velocity over time through a pulse; beside it the same around the largest jump of F.

    The last curve is the reference, from which that instant is taken.
    """
    names = ("normal_force", "friction_force", "slip_velocity")
    labels = ("normal force $N/(mg)$", "friction force $F/(mg)$", r"slip velocity $v/\sqrt{gR}$")
    with matplotlib.rc_context(STYLE):
        figure = _figure(11.0, 8.0)
        grid = figure.subplots(3, 2, sharex="col", width_ratios=[3, 2])
        low, high = _around_the_jump(curves[-1][1])
        for label, columns, colour in curves:
            t = _since_start(columns)
            style: Any = {"color": colour, "label": label, **(_FRONT if colour == RIGID else {"alpha": 0.9})}
            near = (t >= low) & (t <= high)
            for (whole, close), name in zip(grid, names, strict=True):
                whole.plot(t, columns[name], **style)
                close.plot(t[near], columns[name][near], **style)
        for (whole, close), name, label in zip(grid, names, labels, strict=True):
            _robust_limits(whole, [columns[name] for _, columns, _ in curves], floor=name == "normal_force")
            whole.set_ylabel(label)
            whole.axvspan(low, high, color="0.94", zorder=0)
            close.set_xlim(low, high)
            if name != "normal_force":
                for axes in (whole, close):
                    axes.axhline(0, color="0.6", linewidth=0.8)
        for axes in grid[2]:
            axes.set_xlabel(r"time since the pulse began $t/\sqrt{R/g}$")
        grid[0, 1].set_title("the grey stretch, enlarged", fontsize=10)
        figure.suptitle(title)
        if len(curves) > 1:
            handles = grid[0, 0].get_legend_handles_labels()
            figure.legend(*handles, loc="outside lower center", ncols=len(curves), title="foundation")
        return figure


def _since_start(columns: Columns) -> Any:
    t = columns["t"]
    return t - t[0] if t.size else t


def _around_the_jump(columns: Columns) -> tuple[float, float]:
    """A sixth of the pulse around the largest jump of F (or, without one, its steepest place)."""
    t, force = _since_start(columns), columns["friction_force"]
    if t.size < 3:
        return 0.0, 1.0
    middle = float(t[int(np.argmax(np.abs(np.diff(force))))])
    return middle - t[-1] / 12, middle + t[-1] / 12


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
        axes.set_ylim(0.0 if floor and low >= -pad else low - pad, high + pad)


def impulses(curves: Sequence[Curve], mu: float) -> Figure:
    """The pulse in impulse space: gathered friction impulse against gathered normal impulse.

    A slope of mu is skidding's opposite, spinning; -mu is skidding; anything flatter is rolling.
    """
    with matplotlib.rc_context(STYLE):
        figure = _figure(11.0, 5.0)
        axes, close = figure.subplots(1, 2, width_ratios=[3, 2])
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
            front: Any = _FRONT if colour == RIGID else {}
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
        axes.set_xlim(0, 1.02 * reach)
        axes.set_xlabel(r"normal impulse $J_N/(m\sqrt{gR})$")
        axes.set_ylabel(r"friction impulse $J_F/(m\sqrt{gR})$")
        figure.legend(
            *axes.get_legend_handles_labels(), loc="outside lower center", ncols=len(curves), title="foundation"
        )
        return figure


def _enlarged_end(axes: Axes, whole: Axes, curves: Sequence[Curve], reach: float) -> None:
    """The last quarter of the pulse once more, where the curves part."""
    ends = []
    for _, columns, colour in curves:
        late = columns["normal_impulse"] >= 0.75 * reach
        if late.any():
            x, y = columns["normal_impulse"][late], columns["friction_impulse"][late]
            front: Any = _FRONT if colour == RIGID else {}
            axes.plot(x, y, color=colour, **front)
            axes.plot(x[-1], y[-1], "o", color=colour, markersize=5, zorder=6)
            ends.append((y.min(), y.max()))
    if ends:
        low, high = min(e[0] for e in ends), max(e[1] for e in ends)
        pad = 0.08 * (high - low or 1.0)
        axes.set(xlim=(0.75 * reach, 1.02 * reach), ylim=(low - pad, high + pad))
        whole.indicate_inset_zoom(axes, edgecolor="0.4")
    axes.set_title("the end, enlarged", fontsize=10)
    axes.set_xlabel(r"normal impulse $J_N/(m\sqrt{gR})$")


def distances(study: StiffnessStudy) -> Figure:
    """Distance to the rigid value against stiffness, with the fitted rate and each case's numerical error."""
    names = (("impulse_ratio", "impulse ratio $J_F/J_N$"), ("friction_loss", r"friction loss$/(mgR)$"))
    with matplotlib.rc_context(STYLE):
        figure = _figure(9.6, 4.4)
        through = [rung for rung in study.rungs if not rung.outcome.failure]
        s = np.array([rung.stiffness for rung in through])
        for axes, (name, words), colour in zip(figure.subplots(1, 2), names, ("#0072B2", "#D55E00"), strict=True):
            limit = study.limits[name]
            unit = study.scene.energy_unit if name == "friction_loss" else 1.0
            distance = np.abs([rung.measure(name) - limit.rigid for rung in through]) / unit
            error = np.array([rung.error(name) for rung in through]) / unit
            shown = np.where(distance > 0, distance, np.nan)
            axes.errorbar(
                s,
                shown,
                yerr=np.minimum(error, 0.98 * shown),
                fmt="o",
                color=colour,
                markersize=5,
                capsize=2,
                zorder=4,
                label="distance, with its numerical error",
            )
            axes.plot(s, np.where(error > 0, error, np.nan), "v", color="0.6", markersize=4, label="numerical error")
            if np.isfinite(limit.rate):
                use = np.isfinite(shown)
                anchor = np.exp(np.mean(np.log(shown[use][-3:]) + limit.rate * np.log(s[use][-3:])))
                axes.plot(
                    s,
                    anchor * s**-limit.rate,
                    color=colour,
                    linewidth=1,
                    linestyle=(0, (5, 3)),
                    label=_rate_words(limit),
                )
            axes.set(xscale="log", yscale="log", xlabel=study.ladder.label, title=words)
            axes.legend(loc="upper right", fontsize=8)
        figure.axes[0].set_ylabel("distance to the rigid value")
        return figure


def _rate_words(limit: Limit) -> str:
    rate, (low, high) = limit.rate, limit.rate_interval
    interval = f" [{low:.3f}, {high:.3f}] at {CONFIDENCE:.0%}" if np.isfinite(high) else ""
    return f"rate {rate:.3f}{interval}"


def energy(columns: Columns, title: str = "") -> Figure | None:
    """The energy ledger through a pulse as stacked areas, and below its small terms on a logarithmic axis.

    None where the solver kept no ledger over time.
    """
    terms = [name for name in OKABE_ITO if name in columns]
    if len(terms) < 3 or columns["t"].size < 2:
        return None
    t = columns["t"] - columns["t"][0]
    with matplotlib.rc_context(STYLE):
        figure = _figure(8.0, 6.6)
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
        small.set_yscale("log")
        low, high = small.get_ylim()
        small.set_ylim(max(low, 1e-8 * high), high)
        small.set_ylabel("the small terms$/(mgR)$")
        small.set_xlabel(r"time since the pulse began $t/\sqrt{R/g}$")
        handles, labels = stack.get_legend_handles_labels()
        figure.legend(handles[::-1], labels[::-1], loc="outside right upper")
        return figure


def chosen(rungs: Sequence[Rung], most: int = 5) -> list[Rung]:
    """At most so many rungs, evenly over those that came through with histories."""
    through = [rung for rung in rungs if rung.outcome.histories]
    if len(through) <= most:
        return through
    return [through[round(i)] for i in np.linspace(0, len(through) - 1, most)]


def of_study(study: StiffnessStudy) -> dict[str, Figure]:
    """All figures of a stiffness study by name."""
    rungs = chosen(study.rungs)
    through = [dimensionless(rung.outcome.histories[0], study.scene) for rung in rungs]
    curves: list[Curve] = [
        (power_of_ten(rung.contact_stiffness), columns, colour)
        for rung, columns, colour in zip(rungs, through, colours(len(rungs)), strict=True)
    ]
    curves.append(("rigid", dimensionless(study.reference.histories[0], study.scene), RIGID))
    mu = study.scene.friction.mu
    drawn = {
        "pulse": pulse(curves, "Through the first pulse"),
        "impulses": impulses(curves, mu),
        "distance": distances(study),
    }
    if rungs:
        middle = len(rungs) // 2
        words = f"Where the energy is, foundation {power_of_ten(rungs[middle].contact_stiffness)}"
        if (ledger := energy(through[middle], words)) is not None:
            drawn["energy"] = ledger
    return drawn
