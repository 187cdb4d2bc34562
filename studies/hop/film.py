"""One hop as a moving picture: the hoop, the rim's height over the floor enlarged, and N over time."""

from __future__ import annotations

from math import sqrt
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from flexible.output.body import lowest, outline

from ..plots.style import OKABE_ITO, RIGID, STYLE
from ..running.files import write_whole
from .figures import Chosen, draw_hoop, smooth

FRAMES = 72
PER_SECOND = 15


def film(found: Chosen, path: Path) -> Path:
    """Write the hop as an animated GIF, its frames evenly in time; whole or not at all."""
    steps, history = found.steps, found.steps.history
    index = np.array(found.shown)
    t = history.t[index] - history.t[found.first]
    gaps = np.array([lowest(steps.hoop, steps.states[i]) for i in index])
    shown = np.searchsorted(t, np.linspace(t[0], t[-1], FRAMES)).clip(0, len(t) - 1)
    top = max(2.5 * float(gaps.max()), 1e-3)
    half = min(sqrt(2 * top), 0.5)  # of a circle that height is reached there
    with matplotlib.rc_context(STYLE | {"font.size": 11}):
        figure = Figure(figsize=(7.2, 4.2))
        FigureCanvasAgg(figure)
        whole = figure.add_axes((0.06, 0.09, 0.4, 0.82))
        wall, force = figure.add_axes((0.56, 0.66, 0.42, 0.25)), figure.add_axes((0.56, 0.12, 0.42, 0.38))
        drawn = draw_hoop(whole, found.case.scene, steps, int(index[0]))
        (near,) = wall.plot([], [], color=OKABE_ITO["ring_strain"])
        wall.axhline(0, color=RIGID, lw=1)
        wall.set(xlim=(-half, half), ylim=(-0.1 * top, top), title="rim over the floor, enlarged")
        force.plot(t, history.normal_force[index], color="0.7")
        (passed,) = force.plot([], [], color=RIGID)
        force.axvspan(0, history.t[found.last] - history.t[found.first], color="0.94", zorder=0)
        force.set(ylabel="$N/(mg)$", xlabel=r"time since lift-off $t/\sqrt{R/g}$", ylim=(0, None))

        def draw(frame: int) -> None:
            i = int(shown[frame])
            state = steps.states[index[i]]
            drawn.move(state)
            rim = smooth(outline(steps.hoop, state))
            near.set_data(rim[:, 0] - rim[int(np.argmin(rim[:, 1])), 0], rim[:, 1])
            passed.set_data(t[: i + 1], history.normal_force[index][: i + 1])
            whole.set_title(f"t = {t[i]:+.3f}", family="monospace")

        moving = FuncAnimation(figure, draw, frames=FRAMES)
        return write_whole(path, lambda part: moving.save(str(part), writer=PillowWriter(fps=PER_SECOND), dpi=110))
