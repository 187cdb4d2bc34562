"""A predicted approach to a limit, and what was observed of it, on logarithmic axes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .style import OKABE_ITO, RIGID, panels_on

Array = NDArray[np.float64]

MARKS = (("o", "white"), ("s", OKABE_ITO["kinetic"]))


class Approach(NamedTuple):
    """How a measure comes to its limit."""

    predicted: tuple[Array, Array]  # stiffness, distance
    seen: Mapping[str, tuple[Array, Array]]  # the same of each solver that looked


def draw(approaches: Mapping[str, Approach], label: str, axes: Any = None) -> NDArray[np.object_]:
    """A panel for each measure by its name, on ``axes`` or in a new figure; ``label`` is of the abscissa."""
    panels = panels_on(axes, len(approaches), (3.7, 4.0))
    for axis, (name, approach) in zip(panels, approaches.items(), strict=True):
        stiffness, away = approach.predicted
        axis.plot(stiffness, np.abs(away), color=RIGID, label="predicted")
        for (solver, (stiffness, away)), (mark, fill) in zip(approach.seen.items(), MARKS, strict=False):
            if stiffness.size:
                look: Any = {"color": OKABE_ITO["kinetic"], "markerfacecolor": fill}
                axis.plot(stiffness, np.abs(away), mark, label=solver, **look)
        axis.set(xscale="log", yscale="log", xlabel=label, title=name)
        axis.legend()
    panels[0].set_ylabel("distance to the limit")
    return panels
