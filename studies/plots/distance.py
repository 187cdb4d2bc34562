"""Distance to a value that a sequence tends to, on logarithmic axes, with the rate that was fitted to it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

WORDS = {
    "impulse_ratio": "impulse ratio $J_F/J_N$",
    "friction_loss": "friction loss$/(mgR)$",
    "normal_impulse": r"normal impulse $J_N/(m\sqrt{gR})$",
}
ROUND_OFF = 1e-13
"""A distance of so little, over m g R and the like, is none."""
COLOURS = ("#0072B2", "#D55E00", "#009E73")


class Distance(NamedTuple):
    """A sequence about the value it tends to."""

    stiffness: Array
    off: Array  # with its sign
    error: Array  # numerical, of each
    rate: float
    rate_interval: tuple[float, float]
    confidence: str
    rate_cases: tuple[int, ...]  # that the rate was fitted to
    series: tuple[Array, Array] | None  # stiffness, signed distance of what was fitted where the powers are known
    predicted: tuple[Array, Array] | None  # stiffness, distance
    label: str  # of the abscissa


def draw(distances: Mapping[str, Distance], axes: Any = None) -> NDArray[np.object_]:
    """A panel for each, beside one another; on ``axes`` or in a new figure."""
    from .style import panels_on

    panels = panels_on(axes, len(distances), (4.8, 5.0))
    for axis, (name, distance), colour in zip(panels, distances.items(), COLOURS, strict=False):
        panel(axis, distance, WORDS.get(name, name), colour)
    panels[0].set_ylabel("distance to the rigid value")
    return panels


def panel(axes: Axes, distance: Distance, words: str, colour: str) -> None:
    """Filled above the value, open below it; numerical errors, fitted rate, and what is predicted without a fit.

    A sequence that is its limit throughout has none of these.
    """
    from .style import RIGID

    s, off, error = distance.stiffness, distance.off, distance.error
    if not np.any(abs(off) > ROUND_OFF):
        axes.text(0.5, 0.5, "the rigid value, to round-off", transform=axes.transAxes, ha="center", color="0.4")
        axes.set(xscale="log", xlim=(s.min(), s.max()), yticks=[], xlabel=distance.label, title=words)
        return
    for side, fill, said in ((off > 0, colour, "above the rigid value"), (off < 0, "white", "below the rigid value")):
        if side.any():
            axes.plot(s[side], abs(off[side]), "o", color=colour, markerfacecolor=fill, zorder=4, label=said)
    axes.plot(s, np.where(error > 0, error, np.nan), "v", color="0.6", markersize=4, label="numerical error")
    if distance.series is None:
        _rate_line(axes, distance, colour)
    else:
        stiffness, fitted = distance.series
        axes.plot(stiffness, abs(fitted), color=colour, linewidth=1, linestyle=(0, (5, 3)), label="fitted series")
    if distance.predicted is not None:
        axes.plot(*distance.predicted, color=RIGID, linewidth=1, label="predicted, leading powers, no fit")
    axes.set(xscale="log", yscale="log", xlabel=distance.label, title=words)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=2, fontsize=8)


def _rate_line(axes: Axes, distance: Distance, colour: str) -> None:
    """The fitted rate through the cases it was fitted to."""
    s, away = distance.stiffness, abs(distance.off)
    used = [i for i in distance.rate_cases if away[i] > 0]
    if len(used) < 2 or not np.isfinite(distance.rate):
        return
    anchor = np.exp(np.mean(np.log(away[used]) + distance.rate * np.log(s[used])))
    line: Any = {"color": colour, "linewidth": 1, "linestyle": (0, (5, 3))}
    axes.plot(s[used], anchor * s[used] ** -distance.rate, label=f"fitted rate {_rate_words(distance)}", **line)


def _rate_words(distance: Distance) -> str:
    low, high = distance.rate_interval
    interval = f" [{low:.3f}, {high:.3f}] at {distance.confidence}" if np.isfinite(high) else ""
    return f"{distance.rate:.3f}{interval}"
