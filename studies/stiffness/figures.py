"""The figures of a stiffness study: its pulse at several stiffnesses, and how far it is from the rigid one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..plots.pulse import Curve, energy, impulses, pulse
from ..plots.style import RIGID, STYLE, blank, colours, power_of_ten
from ..running.history import dimensionless
from .limits import CONFIDENCE, Limit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .study import Rung, StiffnessStudy

Array = NDArray[np.float64]


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


def chosen(rungs: Sequence[Rung], most: int = 5) -> list[Rung]:
    """At most so many rungs, evenly over those that came through with histories."""
    through = [rung for rung in rungs if rung.outcome.histories]
    if len(through) <= most:
        return through
    return [through[round(i)] for i in np.linspace(0, len(through) - 1, most)]


def distances(study: StiffnessStudy) -> Figure:
    """Distance to the rigid value against stiffness, with the fitted rate and each case's numerical error."""
    names = (("impulse_ratio", "impulse ratio $J_F/J_N$"), ("friction_loss", r"friction loss$/(mgR)$"))
    with matplotlib.rc_context(STYLE):
        figure = blank(9.6, 4.4)
        through = [rung for rung in study.rungs if not rung.outcome.failure]
        s = np.array([rung.stiffness for rung in through])
        for axes, (name, words), colour in zip(figure.subplots(1, 2), names, ("#0072B2", "#D55E00"), strict=True):
            limit = study.limits[name]
            unit = study.scene.energy_unit if name == "friction_loss" else 1.0
            off = np.array([rung.measure(name) - limit.rigid for rung in through]) / unit
            error = np.array([rung.error(name) for rung in through]) / unit
            for side, fill, said in ((off > 0, colour, "above the rigid value"), (off < 0, "white", "below it")):
                if side.any():
                    axes.plot(s[side], abs(off[side]), "o", color=colour, markerfacecolor=fill, zorder=4, label=said)
            axes.plot(s, np.where(error > 0, error, np.nan), "v", color="0.6", markersize=4, label="numerical error")
            _rate_line(axes, s, abs(off), limit, colour)
            softest = max(through[0].contact_stiffness, study.separate)
            if study.prediction is not None and study.prediction.complete and softest < through[-1].contact_stiffness:
                foundation = np.geomspace(softest, through[-1].contact_stiffness, 60)
                term = study.prediction.terms[name]
                foreseen = abs(term.at(foundation ** (-1 / 3)) - term.limit) / unit
                x = foundation * s[0] / through[0].contact_stiffness
                axes.plot(x, foreseen, color=RIGID, linewidth=1, label="predicted, no fit")
            axes.set(xscale="log", yscale="log", xlabel=study.ladder.label, title=words)
            axes.legend(loc="best", fontsize=8)
        figure.axes[0].set_ylabel("distance to the rigid value")
        return figure


def _rate_line(axes: Axes, s: Array, distance: Array, limit: Limit, colour: str) -> None:
    """The fitted rate through the cases it was fitted to."""
    used = [i for i in limit.rate_cases if distance[i] > 0]
    if len(used) < 2 or not np.isfinite(limit.rate):
        return
    anchor = np.exp(np.mean(np.log(distance[used]) + limit.rate * np.log(s[used])))
    line: Any = {"color": colour, "linewidth": 1, "linestyle": (0, (5, 3))}
    axes.plot(s[used], anchor * s[used] ** -limit.rate, label=_rate_words(limit), **line)


def _rate_words(limit: Limit) -> str:
    rate, (low, high) = limit.rate, limit.rate_interval
    interval = f" [{low:.3f}, {high:.3f}] at {CONFIDENCE:.0%}" if np.isfinite(high) else ""
    return f"rate {rate:.3f}{interval}"
