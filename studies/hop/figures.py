"""The figures of a hop study: the map, one hop's energies, the ring as it leaves the floor."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, floor, inf, pi, sin
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from flexible.models.state import State
from flexible.output.body import lowest, outline, whole
from rigid import Run, Scene

from ..plots.pulse import of_small_terms
from ..plots.style import OKABE_ITO, RIGID, STYLE, blank
from .maps import HEIGHTS, first_digits, in_plain_numbers, map_figure
from .rolling.energies import Roll
from .rolling.roll import roll, spans, steps_of
from .rolling.threshold import SYMBOL, HopCase, Line, Mapped

AROUND = 1.5
"""Of a hop's duration is shown before and after it, and no less than ``LEAST_MARGIN``."""
LEAST_MARGIN = 0.25


class Chosen:
    """A hop that is drawn, rolled once more with its steps kept."""

    def __init__(self, case: HopCase, number: int) -> None:
        self.case, self.hop = case, case.hops[number]
        until = (self.hop["t"] + (1 + AROUND) * self.hop["duration"]) / case.scene.time_unit + LEAST_MARGIN
        last = min(until * case.scene.time_unit, case.scene.run.t_end or inf)
        motion = roll(case.scene.replace(run=Run(t_end=last)), history=True)
        self.steps: Roll = steps_of(motion)
        self.unit = case.scene.time_unit
        self.start = self.hop["t"] / self.unit
        flying = spans(self.steps.history.normal_force == 0)
        t = self.steps.history.t
        self.first, self.last = min(flying, key=lambda span: abs(t[span[0]] - self.start))
        margin = max(AROUND * (t[self.last] - t[self.first]), LEAST_MARGIN)
        shown = np.flatnonzero((t >= t[self.first] - margin) & (t <= t[self.last] + margin))
        self.shown = range(int(shown[0]), int(shown[-1]) + 1)

    @property
    def title(self) -> str:
        """Which hop it is."""
        scene = self.case.scene
        return (
            f"{SYMBOL} = {self.case.bending_stiffness:.3g}, k = {scene.hoop.k:g}, m_h/m = {scene.hoop.mass_ratio:g}: "
            f"lift-off at φ = {degrees(self.hop['phi']):.0f}°"
        )


def chosen(study: Mapped) -> Chosen | None:
    """The highest hop of a first pulse, or of all where none begins there; None without any."""
    best: tuple[bool, float] = (False, 0.0)
    found: tuple[HopCase, int] | None = None
    for line in study.lines:
        window = line.windows.get("pulse")
        for case in (*line.mapped, *line.between):
            for number, hop in enumerate(case.hops):
                inside = window is not None and window.low <= hop["swept"] <= window.high
                if (inside, hop["height"]) > best:
                    best, found = (inside, hop["height"]), (case, number)
    return None if found is None else Chosen(*found)


def hop_map(study: Mapped) -> Figure:
    """Where each hop begins and how high it goes, over the bending stiffness; one panel to a line, six at most."""
    with matplotlib.rc_context(STYLE):
        count = min(len(study.lines), 6)
        across, down = min(count, 3), -(-count // 3)
        figure = blank(4.2 * across + 1.2, 3.6 * down)
        grid = figure.subplots(down, across, squeeze=False, sharex=True, sharey=True)
        for axes in grid.ravel()[count:]:
            axes.set_visible(False)
        step = -(-len(study.lines) // 6)
        _hops(study, study.lines[::step], grid)
        return figure


def _hops(study: Mapped, lines: Sequence[Line], grid: NDArray[np.object_]) -> None:
    dots = None
    for axes, line in zip(grid.ravel(), lines, strict=False):
        dots = _line(axes, study, line) or dots
    turns = [floor(line.scene.release.phi0 / (2 * pi)) for line in lines]  # the disk stays in that of its release
    low, high = 360 * min(turns), 360 * (max(turns) + 1)
    grid[0, 0].set(ylim=(low, high), yticks=range(low, high + 1, 90))  # of all panels
    for axes in grid[:, 0]:
        axes.set_ylabel("φ at lift-off [°]")
    for axes in grid[-1]:
        axes.set_xlabel(SYMBOL)
    named: dict[str, Any] = {}
    for axes in grid.ravel():
        named |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    grid[0, 0].figure.legend(
        named.values(), named.keys(), loc="outside lower center", ncols=min(len(named), 2 * len(grid[0]))
    )
    if dots is not None:
        grid[0, 0].figure.colorbar(dots, ax=grid, label="height over R", extend="both")


def _line(axes: Axes, study: Mapped, line: Line) -> PathCollection | None:
    cases = (*line.mapped, *line.between)
    R, release = line.scene.hoop.R, line.scene.release.phi0
    down = 1 if sin(release) >= 0 else -1
    points = np.array(
        [(c.bending_stiffness, degrees(hop["phi"]), hop["height"] / R) for c in cases for hop in c.hops]
    ).reshape(-1, 3)
    for where, shade, words in (("pulse", "0.93", "rigid pulse"), ("bottom", "0.82", "contact under the disk")):
        if (window := line.windows.get(where)) is not None:
            low, high = sorted(degrees(release + down * x) for x in (window.low, window.high))
            axes.axhspan(low, high, color=shade, zorder=0, label=words)
    dots = axes.scatter(
        points[:, 0], points[:, 1], c=np.clip(points[:, 2], *HEIGHTS), norm=LogNorm(*HEIGHTS), cmap="viridis_r", s=16,
        zorder=3, edgecolors="0.4", linewidths=0.3,
    )  # fmt: skip
    none = [c.bending_stiffness for c in cases if not c.hops and c.motion["completed"]]
    if none:
        foot = axes.get_xaxis_transform()
        axes.plot(none, np.full(len(none), 0.03), "|", color="0.4", transform=foot, label="no hop")
    stopped = [(c.bending_stiffness, degrees(release + down * c.motion["swept"])) for c in cases
               if not c.motion["completed"]]  # fmt: skip
    if stopped:
        axes.plot(*np.array(stopped).T, "x", color="0.5", markersize=5, label="stopped early")
    hoop = line.scene.hoop
    name = f"k = {hoop.k:.3g}, m_h/m = {hoop.mass_ratio:.3g}"
    if study.second not in (None, "hoop.k", "hoop.mass_ratio"):
        name += f"\n{study.second} = {line.value:.3g}"
    stiffness = [case.bending_stiffness for case in cases]
    axes.set(xscale="log", title=name, xlim=(min(stiffness) / 1.2, max(stiffness) * 1.2))
    in_plain_numbers(axes.xaxis, first_digits(*axes.get_xlim()))
    return dots if len(points) else None


def energies_figure(found: Chosen) -> Figure:
    """What is stored, what vibrates, what is lost, through one hop, once more on a logarithmic axis; below them the
    height of the rim and N."""
    steps, history = found.steps, found.steps.history
    index = np.array(found.shown)
    t = history.t[index] - found.start
    shares = [whole(steps.hoop, steps.states[i]) for i in index]
    lost = history.friction_loss + history.damping_loss
    curves = {
        "ring_strain": ("strain of the ring", history.ring_strain[index]),
        "contact_spring": ("springs of the floor", history.contact_spring[index]),
        "kinetic": ("kinetic energy of vibration", np.array([share.vibration for share in shares])),
        "friction_loss": ("lost to friction and damper", lost[index] - lost[index[0]]),
    }
    with matplotlib.rc_context(STYLE):
        figure = blank(8.0, 9.0)
        stored, small, gap, force = figure.subplots(4, 1, sharex=True, height_ratios=[3, 2, 2, 2])
        for axes in (stored, small, gap, force):
            axes.axvspan(0, found.hop["duration"] / found.unit, color="0.94", zorder=0)
        for name, (words, values) in curves.items():
            stored.plot(t, values, color=OKABE_ITO[name], label=words)
            small.plot(t, np.where(values > 0, values, np.nan), color=OKABE_ITO[name])
        stored.set(ylabel="energy$/(mgR)$", ylim=(0, None), title=found.title)
        stored.legend()
        of_small_terms(small)
        small.set_ylabel("the same,\nlogarithmic")
        gap.plot(t, [lowest(steps.hoop, steps.states[i]) for i in index], color=OKABE_ITO["gravity"])
        gap.set_ylabel("lowest point of\nthe rim over R")
        force.plot(t, history.normal_force[index], color=RIGID)
        force.set(ylabel="$N/(mg)$", xlabel=r"time since lift-off $t/\sqrt{R/g}$", ylim=(0, None))
        return figure


def liftoff_figure(found: Chosen) -> Figure:
    """The ring as it leaves the floor, over the circle it would be undeformed; beside it the wall at the floor."""
    with matplotlib.rc_context(STYLE):
        figure = blank(10.0, 5.2)
        left, right = figure.subplots(1, 2, width_ratios=[1, 1])
        draw_hoop(left, found.case.scene, found.steps, found.first)
        left.set(title="the ring as it leaves the floor", xlabel="x/R", ylabel="y/R")
        figure.suptitle(found.title)  # wider than a panel
        instants = {
            "last step on the floor": (found.first - 1, "0.6"),
            "in the middle of the hop": ((found.first + found.last) // 2, OKABE_ITO["kinetic"]),
            "last step in the air": (found.last, OKABE_ITO["friction_loss"]),
        }
        top = max(3 * found.hop["height"] / found.case.scene.hoop.R, 2e-3)
        shown: list[float] = []
        for words, (i, colour) in instants.items():
            rim = smooth(outline(found.steps.hoop, found.steps.states[i]))
            low = rim[rim[:, 1] < top]
            shown += [float(low[:, 0].min()), float(low[:, 0].max())]
            right.plot(*np.where(rim[:, 1:] < 1.5 * top, rim, np.nan).T, color=colour, label=words)
        right.axhline(0, color=RIGID, lw=1)
        right.set(xlim=(min(shown), max(shown)), ylim=(-0.15 * top, top))
        right.set(title="the rim over the floor, enlarged", xlabel="x/R", ylabel="y/R")
        figure.legend(*right.get_legend_handles_labels(), loc="outside lower right", ncols=3)
        return figure


class Drawn:
    """Ring, disk and floor in a picture."""

    def __init__(self, axes: Axes, scene: Scene, steps: Roll) -> None:
        self.axes, self.hoop = axes, steps.hoop
        self.reach = (1 - scene.hoop.k) / scene.hoop.r
        self.circle = Circle((0, 1), 1.0, fill=False, ec="0.75", ls="--", lw=1)
        self.disk = Circle((0, 1), max(scene.hoop.k / scene.hoop.r, 0.01), color="0.35")
        axes.add_patch(self.circle)
        axes.add_patch(self.disk)
        (self.ring,) = axes.plot([], [], color=OKABE_ITO["ring_strain"], lw=2)
        axes.axhline(0, color=RIGID, lw=1)

    def move(self, state: State) -> None:
        """To where the hoop is in a state."""
        phi, x_C, y_C = float(state.pos[2]), state.x_C, 1 + float(state.pos[1])
        self.circle.center = x_C, y_C
        self.disk.center = x_C + self.reach * np.sin(phi), y_C + self.reach * np.cos(phi)
        self.ring.set_data(*_closed(outline(self.hoop, state)).T)
        self.axes.set(xlim=(x_C - 1.3, x_C + 1.3), ylim=(-0.15, 2.3), aspect="equal")


def draw_hoop(axes: Axes, scene: Scene, steps: Roll, i: int) -> Drawn:
    """Ring, disk and floor at a step."""
    drawn = Drawn(axes, scene, steps)
    drawn.move(steps.states[i])
    return drawn


PARTS = 8  # of a curve's way from one point to the next


def _closed(points: np.ndarray) -> np.ndarray:
    return np.concatenate([points, points[:1]])


def smooth(points: np.ndarray) -> np.ndarray:
    """The curve through a closed ring of points."""
    index = np.arange(len(points) + 1)
    fine: np.ndarray = CubicSpline(index, _closed(points), bc_type="periodic")(
        np.linspace(0, len(points), PARTS * len(points) + 1)
    )
    return fine


def of_hop(study: Mapped, found: Chosen | None) -> dict[str, Figure]:
    """All figures by name."""
    drawn = {"map": map_figure(study), "where": hop_map(study)}
    if found is not None:
        drawn |= {"energies": energies_figure(found), "liftoff": liftoff_figure(found)}
    return {name: figure for name, figure in drawn.items() if figure is not None}


__all__ = ["Chosen", "chosen", "draw_hoop", "of_hop", "smooth"]
