"""The picture of an atlas: what the contact does, and beside it what the pulse transmits, takes and peaks at.

Regions carry the number that their line of the legend has, so that nothing hangs on telling colours apart.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator, MaxNLocator
from scipy.ndimage import distance_transform_edt

from rigid.output.units import without_units

from ..plots.style import STYLE, blank, power_of_ten
from .plane import NO_HOOP, NO_PULSE, SYMBOLS, Plane, Region
from .refine import Map

COLOURS = ("#56B4E9", "#E69F00", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7", "#8C6D46", "#B9D8C2", "#4B3B73")
"""The Okabe-Ito set, then three more; each with its number in the picture."""
REST, NOTHING = "#6E6E6E", "#F2F2F2"
HOPS, JAMS = "////", "xxx"
LEAST_SHARE = 2e-4
"""Share of the area below which a region is told with the others."""
WHOLE = (0.0, 1.0, 0.0, 1.0)
HALO = [withStroke(linewidth=2.6, foreground="white")]


class Drawn(NamedTuple):
    """What a picture is made of."""

    plane: Plane
    found: Map
    regions: tuple[Region, ...]


def picture(atlas: Drawn) -> Figure:
    """The map and its three companions."""
    with matplotlib.rc_context({**STYLE, "axes.grid": False, "axes.spines.top": True, "axes.spines.right": True}):
        figure = blank(12.6, 8.6)
        grid = figure.add_gridspec(3, 2, width_ratios=(2.35, 1), height_ratios=(1, 1, 1))
        main = figure.add_subplot(grid[:, 0])
        phases(atlas, main)
        share, loss, peak = atlas.found.values
        most = max(float(np.nanmax(np.abs(share))), 1e-12) if np.isfinite(share).any() else 1.0
        panels: list[tuple[Any, str, dict[str, Any]]] = [
            (share, r"impulse ratio $J_F/(\mu J_N)$", {"cmap": "PuOr_r", "vmin": -most, "vmax": most}),
            (loss, r"friction loss over $MgR$", {"cmap": "cividis"}),
            (10**peak, r"peak of $N$ over $Mg$", {"cmap": "magma", "norm": "log" if np.isfinite(peak).any() else None}),
        ]
        for row, (values, title, how) in enumerate(panels):
            axes = figure.add_subplot(grid[row, 1])
            drawn = axes.imshow(values, extent=WHOLE, origin="lower", aspect="auto", **how)
            figure.colorbar(drawn, ax=axes, pad=0.02)
            frame(atlas, axes)
            axes.set_title(title, fontsize=10)
            if row < 2:
                axes.set_xticklabels([])
        axes.set_xlabel(symbol(atlas.plane.across.key))
        return figure


def phases(atlas: Drawn, axes: Axes) -> None:
    """The regions in colour and number, hops and jams hatched, the paper's scenes as points."""
    named = [region for region in atlas.regions if region.sequence > 0 and region.share >= LEAST_SHARE][: len(COLOURS)]
    rest = [r for r in atlas.regions if r.sequence > 0 and r not in named]
    squares = atlas.found.squares
    index = np.full(squares.shape, len(named), dtype=np.uint8)
    for number, region in enumerate(named):
        index[squares == region.sequence] = number
    for number, special in enumerate((NO_PULSE, NO_HOOP), 1):
        index[squares == special] = len(named) + number
    palette = [*COLOURS[: len(named)], REST, NOTHING, "white"]
    # the mean of the parts of a square: a boundary is as smooth as they are small
    parts = (np.array([to_rgb(colour) for colour in palette]) * 255).astype(np.uint8)[index]
    half = len(index) // 2
    mean = parts.reshape(half, 2, half, 2, 3).mean(axis=(1, 3)).astype(np.uint8)
    axes.imshow(mean, extent=WHOLE, origin="lower", aspect="auto", interpolation_stage="rgba")
    with matplotlib.rc_context({"hatch.linewidth": 0.5}):
        for marked, hatch in ((atlas.found.hops, HOPS), (atlas.found.jams, JAMS)):
            if marked.any():
                share = np.linspace(0, 1, len(marked))
                axes.contourf(share, share, marked.astype(float), levels=[0.5, 1.5], colors="none", hatches=[hatch])
    for number in range(len(named)):
        label(axes, index == number, number + 1)
    frame(atlas, axes)
    axes.set(xlabel=SYMBOLS[atlas.plane.across.key], ylabel=SYMBOLS[atlas.plane.up.key])
    points(atlas, axes)
    axes.set_title(f"What the contact does in the first pulse\n{fixed(atlas)}", fontsize=10, loc="left")
    axes.legend(
        handles=legend(atlas, named, rest),
        loc="upper center",
        bbox_to_anchor=(0.5, -0.09),
        ncols=2,
        fontsize=8.5,
        title="roll: sticks; spin: slips backward; skid: slips forward; flight: off the floor; impact: lands or jams",
        title_fontsize=8.5,
    )


def legend(atlas: Drawn, named: list[Region], rest: list[Region]) -> list[Artist]:
    """What colours, hatches and points mean."""
    thin: dict[str, Any] = {"edgecolor": "black", "linewidth": 0.4}
    entries: list[Artist] = [
        Patch(facecolor=COLOURS[n], label=f"{n + 1}  {r.phases}  ({r.share:.1%})", **thin) for n, r in enumerate(named)
    ]
    if rest:
        area = sum(region.share for region in rest)
        said = f"{area:.2%}" if area >= 1e-4 else "less than 0.01%"
        plural = "s" if len(rest) > 1 else ""
        entries.append(Patch(facecolor=REST, label=f"{len(rest)} more sequence{plural} ({said})"))
    if any(region.sequence == NO_PULSE for region in atlas.regions):
        entries.append(Patch(facecolor=NOTHING, label="no pulse", **thin))
    if atlas.found.hops.any():
        entries.append(Patch(facecolor="white", hatch=HOPS, label="hops before its end", **thin))
    if atlas.found.jams.any():
        entries.append(Patch(facecolor="white", hatch=JAMS, label="jams before its end", **thin))
    if atlas.plane.scenes_of_the_paper():
        point: dict[str, Any] = {"ls": "", "marker": "o", "color": "white", "markeredgecolor": "black"}
        entries.append(Line2D([], [], label="the paper's scenes", **point))
    return entries


def label(axes: Axes, mask: Any, text: int) -> None:
    """The number of a region where it is widest, inside the map."""
    step = 4
    room = distance_transform_edt(np.pad(mask[::step, ::step], 1))[1:-1, 1:-1]
    i, j = np.unravel_index(int(np.argmax(room)), room.shape)
    if room[i, j] < 0.012 * len(room):
        return
    digit = 0.011  # half its width
    x, y = (
        float(np.clip((p * step + step / 2) / len(mask), half, 1 - half))
        for p, half in ((j, digit * len(str(text))), (i, 2 * digit))
    )
    axes.text(x, y, str(text), ha="center", va="center", fontsize=11, weight="bold", path_effects=HALO)


def points(atlas: Drawn, axes: Axes) -> None:
    """The paper's scenes; those in one place share a label, neighbours have theirs above and below."""
    places: dict[tuple[float, float], list[str]] = {}
    for name, x, y in atlas.plane.scenes_of_the_paper():
        across, up = atlas.plane.across.share(np.array(x)), atlas.plane.up.share(np.array(y))
        places.setdefault((float(across), float(up)), []).append(name)
    for number, ((x, y), names) in enumerate(sorted(places.items())):
        axes.plot(x, y, "o", color="white", markeredgecolor="black", markersize=7, clip_on=False, zorder=5)
        text = "\n".join(names)
        lower = bool(number % 2) and y > 0.1
        axes.annotate(
            text, (x, y), (6, -6 if lower else 6), textcoords="offset points", fontsize=8, zorder=6, path_effects=HALO,
            va="top" if lower else "bottom", ha="right" if x > 0.85 else "left",
        )  # fmt: skip


def frame(atlas: Drawn, axes: Axes) -> None:
    """Ticks at round values: the panels are drawn over the shares of the way."""
    axes.set(xlim=(0, 1), ylim=(0, 1))
    for axis, set_ticks in ((atlas.plane.across, axes.set_xticks), (atlas.plane.up, axes.set_yticks)):
        locator = LogLocator(subs=(1.0,)) if axis.logarithmic else MaxNLocator(6, steps=[1, 2, 5, 10])
        ticks = np.array([tick for tick in locator.tick_values(axis.low, axis.high) if axis.low <= tick <= axis.high])
        set_ticks(axis.share(ticks), [power_of_ten(tick) if axis.logarithmic else f"{tick:.4g}" for tick in ticks])


def fixed(atlas: Drawn) -> str:
    """What the map does not vary."""
    scene, keys = atlas.plane.scene, atlas.plane.keys
    hoop, friction, release = scene.hoop, scene.friction, without_units(scene.release, scene)
    said = [
        ("hoop.k", f"$k = {hoop.k:g}$"),
        ("hoop.r", f"$r = {hoop.r:g}$"),
        ("hoop.mass_ratio", f"$m_h/m = {hoop.mass_ratio:g}$"),
        ("release.phi0_deg", rf"from $\varphi_0 = {release.phi0_deg:.4g}°$"),
        ("release.omega0", rf"$\omega_0 = {release.omega0:.4g}\,\sqrt{{g/R}}$" if release.omega0 else ""),
        ("release.slip0", rf"$v_0 = {release.slip0:.4g}\,\sqrt{{gR}}$" if release.slip0 else ""),
    ]
    told = [text for key, text in said if text and key not in keys and not text.endswith("= 0$")]
    varied = {"friction.mu", "friction.mu_s"} & set(keys)
    if not varied:
        told.append(rf"$\mu_s = {friction.mu_s:g}$, $\mu = {friction.mu:g}$")
    elif varied == {"friction.mu_s"} and friction.mu == 0 < friction.mu_s:
        told.append(r"$\mu = 0$")
    elif len(varied) == 1:
        told.append(rf"$\mu_s/\mu = {friction.mu_s / friction.mu if friction.mu else 1.0:.4g}$")
    if scene.landing.restitution:
        told.append(rf"restitution ${scene.landing.restitution:g}$")
    return ", ".join(told)


def symbol(key: str) -> str:
    """The symbol of a quantity, with its unit."""
    said = SYMBOLS[key]
    return said[said.index("$") :] if "$" in said else said
