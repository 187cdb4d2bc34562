"""Work-precision diagrams: run time against error, both logarithmic, one panel for each scene.

A point is a setting; the line of a solver is its envelope, the least error to be had for the time.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isfinite, log10
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogFormatterSciNotation, NullFormatter

from ...plots.pulse import OKABE_ITO, STYLE, save
from ..race import Result, Row
from ..truth.reference import MASSLESS, SCENES

_MARKERS = "osv^DPX*<>h"
_COLOURS = [colour for name, colour in OKABE_ITO.items() if name != "contact_spring"]
_ACROSS = 4
_FLOOR = 1e-17  # where an error of nothing at all is drawn
_SAME = 0.03  # points no further apart than this share of the axis lie above one another
_LINE = 0.05  # of the height of a panel, from one name to the next


IMPULSES = "error of $J_N$, $J_F$ and the loss, over $J_N$"
RATIO = "error of $J_F/J_N$"
ERRORS = {
    "rigid": "largest error of a turn: of time, angle or energy",
    "soft": "difference of $J_N$, $J_F$ and the loss, over $J_N$",
}
"""Of a benchmark what its errors are of, where it is not ``IMPULSES``; the massless pulse has ``RATIO``."""


def work_precision(rows: Sequence[Row], title: str, error: str = IMPULSES) -> Figure:
    """Error against seconds, medians with the spread of the repeats, and each solver's envelope; ours is black."""
    shown = [row for row in rows if row.seconds and isfinite(row.error)]
    scenes = list(dict.fromkeys(row.scene for row in shown))
    solvers = list(dict.fromkeys(row.solver for row in shown))
    others = [name for name in solvers if not name.startswith("hoop-pulse")]
    with matplotlib.rc_context(STYLE):
        figure, panels = _panels(len(scenes), 4.2)
        for axes, scene in zip(panels, scenes, strict=False):
            for number, name in enumerate(solvers):
                mine = sorted((row for row in shown if (row.scene, row.solver) == (scene, name)), key=lambda r: r.error)
                if not mine:
                    continue
                x = [max(row.error, _FLOOR) for row in mine]
                y = np.array([row.median for row in mine])
                spread = [y - [row.least for row in mine], np.array([max(row.seconds) for row in mine]) - y]
                colour = _COLOURS[others.index(name) % len(_COLOURS)] if name in others else str(0.25 * (number % 3))
                axes.errorbar(
                    x, y, yerr=spread, marker=_MARKERS[number % len(_MARKERS)], linestyle="none", color=colour,
                    label=name, capsize=2, markersize=5,
                )  # fmt: skip
                best = envelope(x, y.tolist())
                axes.plot(*zip(*best, strict=True), color=colour, linewidth=1)
            axes.set(xscale="log", yscale="log", xlabel=RATIO if scene == MASSLESS else error)
            axes.set_title(f"{scene}\n{SCENES[scene]}" if scene in SCENES else scene, fontsize=10)
            _ticks(axes.xaxis)
            axes.tick_params(labelbottom=True)
        for axes, scene in zip(panels, scenes, strict=False):  # all share an axis, which is known by now
            for name in solvers:
                if name not in others:
                    _name_settings(axes, [row for row in shown if (row.scene, row.solver) == (scene, name)])
        _ticks(panels[0].yaxis)
        for axes in panels[::_ACROSS]:
            axes.set_ylabel("seconds")
        _legend(figure, panels)
        figure.suptitle(title)
        return figure


def _name_settings(axes: Any, rows: Sequence[Row]) -> None:
    """Settings beside their points where these lie above one another, and so no tolerance tells them apart.

    Names keep off one another; one that is moved for that has a line to its point.
    """
    axes.get_ylim()  # which settles the limits
    placed = axes.transScale + axes.transLimits  # to shares of the axes
    points = {id(row): placed.transform((max(row.error, _FLOOR), row.median)) for row in rows}
    across = [x for x, _ in points.values()]
    if len(rows) < 2 or max(across) - min(across) > _SAME:
        return
    rows = sorted(rows, key=lambda row: row.median)
    heights = _apart([float(points[id(row)][1]) for row in rows], _LINE)
    for row, height in zip(rows, heights, strict=True):
        x, y = points[id(row)]
        line = {"arrowstyle": "-", "linewidth": 0.5, "color": "0.6"} if abs(height - y) > 1e-9 else None
        axes.annotate(
            ", ".join(filter(None, [row.setting, row.note])), (x, y), (x + _SAME, height), xycoords="axes fraction",
            va="center", fontsize=8, arrowprops=line, path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip


def _apart(heights: Sequence[float], least: float) -> list[float]:
    """Ascending heights with so much between them at least, moved no more than that needs and as much up as down."""
    groups: list[list[float]] = []
    for height in heights:
        groups.append([height])
        while len(groups) > 1 and _evenly(groups[-1], least)[0] - _evenly(groups[-2], least)[-1] < least:
            groups[-2:] = [groups[-2] + groups[-1]]
    return [height for group in groups for height in _evenly(group, least)]


def _evenly(group: Sequence[float], least: float) -> list[float]:
    middle, count = sum(group) / len(group), len(group)
    return [middle + least * (number - (count - 1) / 2) for number in range(count)]


def _panels(scenes: int, size: float) -> tuple[Figure, Any]:
    """A figure with a panel of so many inches for each scene, on the same axes, and room for a legend beside them."""
    across = min(max(scenes, 1), _ACROSS)
    down = max(-(-scenes // across), 1)
    figure = Figure(figsize=(size * across + 1.6, size * down), layout="constrained")
    FigureCanvasAgg(figure)
    panels = np.atleast_1d(figure.subplots(down, across, sharex=down > 1, sharey=True)).ravel()
    for axes in panels[max(scenes, 1) :]:
        axes.set_axis_off()
    return figure, panels


def _legend(figure: Figure, panels: Iterable[Any]) -> None:
    """What is drawn in any of the panels, once, beside them."""
    handles: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    figure.legend(list(handles.values()), list(handles), loc="outside right upper")


def envelope(errors: Sequence[float], seconds: Sequence[float]) -> list[tuple[float, float]]:
    """(error, seconds) of the settings that no other one beats in both, fastest first."""
    best: list[tuple[float, float]] = []
    for time, error in sorted(zip(seconds, errors, strict=True)):
        if not best or error < best[-1][0]:
            best.append((error, time))
    return best


def _ticks(axis: Any) -> None:
    """Two numbers at least on a logarithmic axis: over less than two decades those between the powers of ten too."""
    low, high = axis.get_view_interval()
    within = log10(high / low) < 2
    axis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(2, 1)) if within else NullFormatter())


def cost(rows: Sequence[Row], exponents: dict[str, float]) -> Figure:
    """Cost against size, one panel for each thing that grows, with the fitted exponent."""
    grown = {
        scene: [row for row in rows if row.scene == scene and "size" in row.more and row.seconds] for scene in exponents
    }
    across = min(3, len(grown))
    down = -(-len(grown) // across)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(3.6 * across, 3.0 * down), layout="constrained")
        FigureCanvasAgg(figure)
        panels = np.atleast_1d(figure.subplots(down, across)).ravel()
        for axes, (scene, mine) in zip(panels, grown.items(), strict=False):
            x, y = [row.more["size"] for row in mine], np.array([row.median for row in mine])
            spread = [y - [row.least for row in mine], np.array([max(row.seconds) for row in mine]) - y]
            axes.errorbar(x, y, yerr=spread, marker="o", color="black", capsize=2)
            axes.set(xscale="log", yscale="log", xlabel=scene, ylabel="seconds")
            axes.set_ylim(y.min() / 3, y.max() * 3)
            axes.xaxis.set_minor_formatter(NullFormatter())
            if max(x) < 100 * min(x):  # the sizes themselves: numbers between powers of ten would lie on one another
                axes.set_xticks(x, [f"{size:g}" for size in x])
            _ticks(axes.yaxis)
            axes.set_title(f"exponent {exponents[scene]:.2f}", fontsize=10)
        for axes in panels[len(grown) :]:
            axes.set_axis_off()
        return figure


def budget(rows: Sequence[Row], parts: Sequence[str]) -> Figure:
    """The parts of the error and all of it against the tolerance, one panel for each scene."""
    shown = [row for row in rows if isfinite(row.error)]
    scenes = list(dict.fromkeys(row.scene for row in shown))
    with matplotlib.rc_context(STYLE):
        figure, panels = _panels(len(scenes), 3.4)
        for axes, scene in zip(panels, scenes, strict=False):
            mine = sorted((row for row in shown if row.scene == scene), key=lambda row: row.more["rtol"])
            rtol = [row.more["rtol"] for row in mine]
            axes.plot(rtol, rtol, color="0.7", linestyle="--", label="rtol")
            for number, part in enumerate(parts):
                y = [max(row.more[part], _FLOOR) if part in row.more else np.nan for row in mine]
                if not np.isnan(y).all():
                    axes.plot(rtol, y, marker=_MARKERS[number], color=_COLOURS[number], markersize=5, label=part)
            axes.plot(rtol, [row.error for row in mine], color="black", linewidth=2, label="all", zorder=1)
            axes.set(xscale="log", yscale="log", xlabel="rtol")
            axes.set_title(scene, fontsize=10)
            axes.tick_params(labelbottom=True)
        for axes in panels[::_ACROSS]:
            axes.set_ylabel("error over J_N")
        _legend(figure, panels)
        return figure


def by_wall(rows: Sequence[Row]) -> Figure:
    """What a mesh leaves over the wall, one panel for each, a line for each ring; dashed what is assumed of 240."""
    rows = [row for row in rows if isfinite(row.error)]
    kinds = list(dict.fromkeys(row.setting.rpartition(", ")[2] for row in rows))
    rings = list(dict.fromkeys(row.scene.partition(", ")[2] for row in rows))
    with matplotlib.rc_context(STYLE):
        figure, panels = _panels(len(kinds), 4.6)
        for axes, kind in zip(panels, kinds, strict=False):
            for number, ring in enumerate(rings):
                mine = [row for row in rows if row.setting.endswith(kind) and row.scene.partition(", ")[2] == ring]
                wall, colour = [row.more["wall"] for row in mine], _COLOURS[number]
                axes.plot(wall, [row.error for row in mine], marker=_MARKERS[number], color=colour, label=ring)
                if kind == kinds[0] and "damped" not in ring:
                    axes.plot(wall, [row.more["assumed"] for row in mine], color=colour, linestyle="--", linewidth=1)
            axes.set(xscale="log", yscale="log", xlabel="wall over R")
            axes.set_title(f"{kind} elements", fontsize=10)
            axes.tick_params(labelbottom=True)
        panels[0].set_ylabel("error over J_N")
        _legend(figure, panels)
        return figure


def draw(what: str, result: Result, out: Path) -> list[Path]:
    """All figures of a benchmark into a folder."""
    if what == "scaling":
        return [save(cost(result.rows, result.exponents), out / "bench-scaling.png")]
    if what == "mesh":
        return [save(by_wall(result.rows), out / "bench-mesh.png")]
    if result.parts:
        return [save(budget(result.rows, result.parts), out / f"bench-{what}.png")]
    against = "difference from all nodes" if what == "soft" else "error"
    figure = work_precision(result.rows, f"{what}: run time against {against}", ERRORS.get(what, IMPULSES))
    return [save(figure, out / f"bench-{what}.png")]
