"""The figures of the limit: the layers at the events, and the predicted approach beside what is observed."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from ..plots.style import OKABE_ITO, RIGID, STYLE, blank, colours, power_of_ten
from .damping import Spot
from .study import EventFound, LimitStudy


def of_limit(study: LimitStudy) -> dict[str, Figure]:
    """All figures by name."""
    drawn = {"approach": approach(study)}
    if any(map(_jumps, study.events)):
        drawn["layers"] = layers(study)
    return drawn


def _jumps(found: EventFound) -> bool:
    """Whether an event has a layer, and forces jump in it; where they do not, it is round-off."""
    return found.layer is not None and not np.allclose(found.before, found.behind, rtol=1e-6, atol=1e-9)


def layers(study: LimitStudy) -> Figure:
    """N, F and V through the layer of each event at which forces jump, over the rigid hoop's before and behind it."""
    with matplotlib.rc_context(STYLE):
        events = [found for found in study.events if _jumps(found)]
        figure = blank(3.6 * max(len(events), 2), 6.4)
        grid = figure.subplots(3, len(events), sharex="col", squeeze=False)
        for column, found in zip(grid.T, events, strict=True):
            layer = found.layer
            assert layer is not None
            show = abs(layer.tau) <= min(layer.tau[-1], 6 * layer.period)
            tau = layer.tau[show]
            rows = (
                (layer.normal_force, found.before[0], found.behind[0], "$N$"),
                (layer.friction_force, found.before[1], found.behind[1], "$F$"),
            )
            for axes, (force, before, behind, symbol) in zip(column, rows, strict=False):
                axes.plot(
                    [min(-0.15 * tau[-1], tau[0]), 0, 0, tau[-1]],
                    [before, before, behind, behind],
                    color=RIGID,
                    lw=2.6,
                    alpha=0.3,
                )
                axes.plot(tau, force[show], color=OKABE_ITO["kinetic"])
                axes.set_ylabel(f"{symbol}$/(Mg)$")
            column[2].plot(tau, layer.slip[show], color=OKABE_ITO["friction_loss"])
            if found.event.behind is None:
                column[2].axhline(found.creep, color=RIGID, lw=2.6, alpha=0.3)
            column[2].set(ylabel=r"$V = v/\epsilon$", xlabel=r"$\tau = (t - t^*)/\epsilon$")
            column[0].set_title(f"{found.event.kind}, {degrees(found.event.phi):.1f}°")
        return figure


def approach(study: LimitStudy) -> Figure:
    """Distance to the limit against the foundation: the prediction as a line, without a fitted number."""
    with matplotlib.rc_context(STYLE):
        figure = blank(11, 4)
        study.plot(axes=figure.subplots(1, 3))
        return figure


def damping_figure(spots: Sequence[Spot]) -> Figure:
    """The distance to the limit over the damping ratio, and beyond the predicted one over what decays in the stick,
    where one ends within the pulse."""
    with matplotlib.rc_context(STYLE):
        sticks = any(np.isfinite(spot.decay) for spot in spots)
        figure = blank(10 if sticks else 5.5, 4.2)
        left, *more = figure.subplots(1, 1 + sticks, squeeze=False)[0]
        foundations = sorted({spot.foundation for spot in spots})
        for foundation, colour in zip(foundations, colours(len(foundations)), strict=True):
            row = sorted((s for s in spots if s.foundation == foundation), key=lambda s: s.damping)
            label = power_of_ten(foundation)
            left.plot([s.damping for s in row], [s.impulse_ratio for s in row], "o-", color=colour, label=label, ms=3.5)
            beyond = [(s.decay, s.impulse_ratio - s.predicted) for s in row if np.isfinite(s.decay)]
            if beyond:
                more[0].plot(*np.array(beyond).T, "o", color=colour, ms=4)
        for limit in {spot.limit for spot in spots}:
            left.axhline(limit, color=RIGID, lw=2.6, alpha=0.3)
        left.set_xscale("symlog", linthresh=0.003)
        left.set(xlabel="damping ratio", ylabel="$J_F/J_N$", xlim=(0, None))
        left.legend(ncols=2, title=r"foundation $\varepsilon_n R^2/(mg)$")
        for right in more:
            right.axhline(0, color=RIGID, lw=2.6, alpha=0.3)
            right.set_xscale("symlog", linthresh=0.3)
            right.set(xlabel=r"$x = \zeta\omega T_{stick}$", ylabel="beyond the predicted distance", xlim=(0, None))
        return figure
