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
    """N, F and slip velocity over time through a pulse, one line for each ``(label, columns, colour)``."""
    with matplotlib.rc_context(STYLE):
        figure = _figure(8.0, 8.2)
        rows = figure.subplots(3, 1, sharex=True)
        for label, columns, colour in curves:
            t = columns["t"] - columns["t"][0] if columns["t"].size else columns["t"]
            style: Any = {
                "color": colour,
                "label": label,
                **({"linewidth": 1.8, "zorder": 5} if colour == RIGID else {"alpha": 0.9}),
            }
            for axes, name in zip(rows, ("normal_force", "friction_force", "slip_velocity"), strict=True):
                axes.plot(t, columns[name], **style)
        _robust_limits(rows[0], [columns["normal_force"] for _, columns, _ in curves], floor=True)
        _robust_limits(rows[1], [columns["friction_force"] for _, columns, _ in curves])
        _robust_limits(rows[2], [columns["slip_velocity"] for _, columns, _ in curves])
        rows[0].set_ylabel("normal force $N/(mg)$")
        rows[1].set_ylabel("friction force $F/(mg)$")
        rows[2].set_ylabel(r"slip velocity $v/\sqrt{gR}$")
        rows[2].set_xlabel(r"time since the pulse began $t/\sqrt{R/g}$")
        for axes in rows[1:]:
            axes.axhline(0, color="0.6", linewidth=0.8)
        figure.suptitle(title)
        if len(curves) > 1:
            figure.legend(*rows[0].get_legend_handles_labels(), loc="outside right upper", title="foundation")
        return figure


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
        figure = _figure(7.6, 5.2)
        axes = figure.subplots()
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
            front: Any = {"linewidth": 1.8, "zorder": 5} if colour == RIGID else {}
            axes.plot(
                columns["normal_impulse"], columns["friction_impulse"], color=colour, label=label, **front
            )
            if columns["t"].size:
                axes.plot(
                    columns["normal_impulse"][-1],
                    columns["friction_impulse"][-1],
                    "o",
                    color=colour,
                    markersize=4,
                    zorder=6,
                )
        axes.set_xlim(0, 1.02 * reach)
        axes.set_xlabel(r"normal impulse $J_N/(m\sqrt{gR})$")
        axes.set_ylabel(r"friction impulse $J_F/(m\sqrt{gR})$")
        figure.legend(loc="outside right upper", title="foundation")
        return figure


def distances(study: StiffnessStudy) -> Figure:
    """Distance to the rigid value against stiffness, with the fitted rate and each case's numerical error."""
    names = (("impulse_ratio", "impulse ratio $J_F/J_N$"), ("friction_loss", r"friction loss$/(mgR)$"))
    with matplotlib.rc_context(STYLE):
        figure = _figure(9.6, 4.4)
        through = [rung for rung in study.rungs if not rung.outcome.failure]
        s = np.array([rung.stiffness for rung in through])
        for axes, (name, words), colour in zip(
            figure.subplots(1, 2), names, ("#0072B2", "#D55E00"), strict=True
        ):
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
            axes.plot(
                s, np.where(error > 0, error, np.nan), "v", color="0.6", markersize=4, label="numerical error"
            )
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
