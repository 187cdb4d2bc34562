"""One hop as a moving picture: the hoop, the rim's height over the floor enlarged, and N over time."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter

from flexible.output.body import lowest, outline

from ..plots.style import OKABE_ITO, RIGID, STYLE, blank
from ..running.files import write_whole
from .figures import Chosen, draw_hoop

FRAMES = 90
PER_SECOND = 18


def film(found: Chosen, path: Path, frames: int = FRAMES) -> Path:
    """Write the hop as an animated GIF, its frames evenly in time; whole or not at all."""
    steps, history = found.steps, found.steps.history
    index = np.array(found.shown)
    t = history.t[index] - history.t[found.first]
    gaps = np.array([lowest(steps.hoop, steps.states[i]) for i in index])
    shown = np.searchsorted(t, np.linspace(t[0], t[-1], frames)).clip(0, len(t) - 1)
    top = max(1.4 * float(gaps.max()), 1e-3)
    with matplotlib.rc_context(STYLE):
        figure = blank(8.0, 4.4)
        whole, column = figure.subplots(1, 2, width_ratios=[1, 1.1])
        axes = column.inset_axes((0, 0.68, 1, 0.32)), column.inset_axes((0, 0, 1, 0.52))
        column.axis("off")

        def draw(frame: int) -> None:
            i = int(shown[frame])
            rim = outline(steps.hoop, steps.states[index[i]])
            x = float(rim[int(np.argmin(rim[:, 1])), 0])
            for panel in (whole, *axes):
                panel.clear()
            draw_hoop(whole, found.case.scene, steps, int(index[i]))
            whole.set_title(f"t = {t[i]:+.3f}", family="monospace")
            wall, force = axes
            wall.plot(rim[:, 0] - x, rim[:, 1], ".-", color=OKABE_ITO["ring_strain"], ms=3)
            wall.axhline(0, color=RIGID, lw=1)
            wall.set(xlim=(-0.3, 0.3), ylim=(-0.1 * top, top), title="the rim over the floor, heights enlarged")
            force.plot(t, history.normal_force[index], color="0.7")
            force.plot(t[: i + 1], history.normal_force[index][: i + 1], color=RIGID)
            force.axvspan(0, history.t[found.last] - history.t[found.first], color="0.94", zorder=0)
            force.set(ylabel="$N/(mg)$", xlabel=r"time since lift-off $t/\sqrt{R/g}$", ylim=(0, None))

        moving = FuncAnimation(figure, draw, frames=frames)
        return write_whole(path, lambda part: moving.save(str(part), writer=PillowWriter(fps=PER_SECOND), dpi=80))
