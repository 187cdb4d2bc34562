"""The map of a hop study: where hoops hop over bending stiffness and a second key, where first, and how high."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil, degrees, floor
from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from numpy.typing import NDArray

from ..plots.style import RIGID, STYLE, blank
from .rolling.scaling import duration
from .rolling.threshold import SYMBOL, HopCase, Line, Mapped

Array = NDArray[np.float64]

HEIGHTS = (1e-4, 1e-1)
"""Of a hop over R, between which colours run."""

TIMES_DURATION = 12.0
"""E I tau^2 that is drawn, see :mod:`.rolling.scaling`: thresholds anywhere have it within a factor of 1.7."""

PLACES = {
    "bottom": ("at φ = π, the contact under the disk", "#D55E00"),
    "pulse": ("elsewhere in its first pulse", "#E69F00"),
    "behind": ("behind the pulse only", "#56B4E9"),
    "before": ("on its way down only", "#B9D8C2"),
    "nowhere": ("nowhere", "#F2F2F2"),
}
"""Where a hoop hops, the rarest place first, in words and in a colour."""

NAMES = {"hoop.k": "radius of the disk over that of the hoop, k", "hoop.mass_ratio": "mass of the ring over the disk's"}

THRESHOLDS = {
    "anywhere": ("threshold anywhere", "o", RIGID),
    "pulse": ("threshold in the first pulse", "s", "white"),
    "bottom": ("threshold at φ = π", "^", "white"),
}
"""How each threshold is told from the others: its words, its marker and what fills that."""

HALO = [withStroke(linewidth=3.0, foreground="white")]


def place(case: HopCase, line: Line) -> str | None:
    """Where a roll hops, the rarest place of all its hops; None where it stopped before it was seen to hop."""
    if not case.hops:
        return "nowhere" if case.motion["completed"] else None
    swept = [hop["swept"] for hop in case.hops]
    for where in ("bottom", "pulse"):
        window = line.windows.get(where)
        if window is not None and any(window.low <= angle <= window.high for angle in swept):
            return where
    window = line.windows.get("pulse")
    return "before" if window is not None and all(angle < window.low for angle in swept) else "behind"


def map_figure(study: Mapped) -> Figure | None:
    """The map with its thresholds; beside it where the first hop begins and how high the highest goes."""
    if study.second is None:
        return None
    with matplotlib.rc_context({**STYLE, "axes.grid": False, "axes.spines.top": True, "axes.spines.right": True}):
        figure = blank(12.6, 6.2)
        grid = figure.add_gridspec(2, 2, width_ratios=(2.1, 1))
        _places(study, figure.add_subplot(grid[:, 0]))
        first = _over(study, lambda case: degrees(case.hops[0]["phi"]) if case.hops else np.nan)
        height = _over(study, lambda case: (case.height or np.nan) / case.scene.hoop.R)
        panels: list[tuple[Array, str, dict[str, Any]]] = [
            (first, "φ at the first lift-off [°]", {"cmap": "viridis"}),
            (height.clip(*HEIGHTS), "height of the highest hop over R", {"cmap": "magma_r", "norm": LogNorm(*HEIGHTS)}),
        ]
        for row, (values, title, how) in enumerate(panels):
            axes = figure.add_subplot(grid[row, 1])
            painted = axes.pcolormesh(*_edges(study), values, rasterized=True, **how)
            bar: dict[str, Any] = {"ticks": FixedLocator(angle_ticks(values))} if row == 0 else {"extend": "both"}
            figure.colorbar(painted, ax=axes, **bar)
            axes.set_title(title, fontsize=10)
            _scales(study, axes, room=6)
            if row == 1:
                axes.set_xlabel(SYMBOL)
        return figure


def _places(study: Mapped, axes: Axes) -> None:
    order = list(PLACES)
    found = np.array([[_index(place(case, line), order) for case in line.mapped] for line in study.lines])
    colours, norm = [colour for _, colour in PLACES.values()], BoundaryNorm(np.arange(len(order) + 1) - 0.5, len(order))
    axes.pcolormesh(*_edges(study), found, cmap=ListedColormap(colours), norm=norm, rasterized=True)
    keys: list[Artist] = [
        Patch(facecolor=colour, edgecolor="0.6", label=f"hops {words}")
        for index, (words, colour) in enumerate(PLACES.values())
        if (found == index).any()
    ]
    keys += _lines(study, axes)
    lines, rolls = found.shape
    if (found[lines // 2 :, rolls // 2 :] == order.index("nowhere")).all():  # room enough over the map
        axes.legend(handles=keys, loc="upper right", frameon=True, framealpha=1.0)
    else:
        axes.figure.legend(handles=keys, loc="outside lower center", ncols=3)
    hoop, start = study.scene.hoop, degrees(study.scene.release.phi0)
    fixed = {"hoop.k": f"k = {hoop.k:g}", "hoop.mass_ratio": f"m_h/m = {hoop.mass_ratio:g}"}
    told = ", ".join(words for key, words in fixed.items() if key != study.second)
    where = "" if study.second == "release.phi0_deg" else f" at {start:.0f}°"
    axes.set_title(f"Where an elastic hoop hops: {told}, released at rest{where}", loc="left", fontsize=11)
    axes.set(xlabel=f"bending stiffness {SYMBOL}", ylabel=NAMES.get(study.second or "", study.second))
    _scales(study, axes)


def _lines(study: Mapped, axes: Axes) -> list[Artist]:
    """Thresholds, and what they may be compared with."""
    values = np.array([line.value for line in study.lines], dtype=float)
    keys: list[Artist] = []
    stopped = [(c.bending_stiffness, line.value) for line in study.lines for c in line.mapped
               if not c.motion["completed"]]  # fmt: skip
    if stopped:
        keys += axes.plot(*np.array(stopped).T, "x", color="0.25", ms=5, label="stopped before its end")
    for where, (words, marker, fill) in THRESHOLDS.items():
        known = [line.threshold(where).value if where in line.windows else None for line in study.lines]
        if all(value is None for value in known):
            continue
        solid: Any = {"color": RIGID, "lw": 1.6, "marker": marker, "mfc": fill, "ms": 5, "path_effects": HALO}
        at = [np.nan if value is None else value for value in known]  # a gap where there is none
        keys += axes.plot(at, values, label=words, **solid)
    durations = np.array([duration(line.scene) or np.nan for line in study.lines])
    label = f"{TIMES_DURATION:g}/τ², τ the time of the rigid pulse"
    keys += axes.plot(TIMES_DURATION / durations**2, values, "--", color=RIGID, lw=1.3, label=label, path_effects=HALO)
    if study.second == "hoop.k":
        label = "1.3/k: the wall gives way"
        keys += axes.plot(1.3 / values, values, ":", color=RIGID, lw=1.6, label=label, path_effects=HALO)
    return keys


def _index(where: str | None, order: list[str]) -> float:
    return np.nan if where is None else order.index(where)


def _over(study: Mapped, value: Callable[[HopCase], float]) -> Array:
    """A value of every roll of the map, softest first, a row to a line."""
    return np.array([[value(case) for case in line.mapped] for line in study.lines], dtype=float)


def _even(values: Array) -> bool:
    """Whether an axis of these values is logarithmic."""
    return bool(values.min() > 0 and values.max() > 3 * values.min())


def _edges(study: Mapped) -> tuple[Array, Array]:
    """Of the cells about the values, half way between neighbours as the axes show them."""
    stiffness = np.array([case.bending_stiffness for case in study.lines[0].mapped])
    return _between(stiffness, True), _between(np.array([line.value for line in study.lines], dtype=float))


def _between(values: Array, logarithmic: bool | None = None) -> Array:
    even = _even(values) if logarithmic is None else logarithmic
    at = np.log(values) if even else values
    half = np.diff(at) / 2 if len(at) > 1 else np.array([0.1 * max(abs(at[0]), 1.0)])
    edges = np.concatenate([[at[0] - half[0]], at[:-1] + half[: len(at) - 1], [at[-1] + half[-1]]])
    return np.exp(edges) if even else edges


def _scales(study: Mapped, axes: Axes, room: int = 12) -> None:
    """Limits, and ticks at plain numbers, of which a panel has ``room`` for so many side by side."""
    x, y = _edges(study)
    values = np.array([line.value for line in study.lines], dtype=float)
    axes.set(xscale="log", yscale="log" if _even(values) else "linear", xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    in_plain_numbers(axes.xaxis, first_digits(x[0], x[-1], room))
    if _even(values):
        in_plain_numbers(axes.yaxis, (1, 2, 3, 5))
    elif len(values) <= 6:
        axes.set_yticks(values)


def first_digits(low: float, high: float, room: int = 12) -> tuple[int, ...]:
    """First digits of the ticks between two numbers: more where there would be but one, or none."""
    choices: tuple[tuple[int, ...], ...] = ((1, 3), (1, 2, 3, 5), tuple(range(1, 10)), tuple(range(10, 100)))
    if 2 * np.log10(high / low) >= room:
        return (1,)
    counts = [sum(low <= m * 10.0**n <= high for n in range(-12, 13) for m in digits) for digits in choices]
    return next((digits for digits, count in zip(choices, counts, strict=True) if count >= 2), choices[-1])


def angle_ticks(values: Array) -> list[float]:
    """Ticks among angles in degrees: multiples of 45 where there are two, else of what is round."""
    if not np.isfinite(values).any():
        return []
    low, high = np.nanmin(values), np.nanmax(values)
    steps = (45.0, 15.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)
    ticks = [[step * n for n in range(ceil(low / step), floor(high / step) + 1)] for step in steps]
    return next((found for found in ticks if len(found) >= 2), [float(low)])


def in_plain_numbers(axis: Axis, digits: tuple[int, ...] = (1, 3)) -> None:
    """Ticks of a logarithmic axis: 1, 3, 10, 30, ..."""
    axis.set_major_locator(FixedLocator([m * 10.0**n for n in range(-12, 13) for m in digits]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())
