"""The map of margins: where in the space of scenes the checks come near their bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from rigid import Scene

from ..plots.pulse import STYLE, save
from .run import FLEXIBLE, HOSTILE, RIGID, Finding, Report

_FLOOR = 1e-8  # margins below this are drawn as this
_MASSLESS = 3e-5  # where a hoop without a mass is drawn, below the least that is drawn at random
_BEYOND = matplotlib.colormaps["viridis_r"].with_extremes(over="#D55E00")  # a margin above its bound
Axis = tuple[str, Callable[[Scene], float]]
_RIGID: tuple[Axis, Axis] = (
    ("radius of the disk $k$", lambda scene: scene.hoop.k),
    ("$m_h/m$", lambda scene: max(scene.hoop.mass_ratio, _MASSLESS)),
)
_FLEXIBLE: tuple[Axis, Axis] = (
    ("foundation $\\epsilon_n R^2/(mg)$", lambda scene: scene.contact.stiffness),
    ("bending $EI/(mgR^2)$", lambda scene: scene.ring.bending_stiffness),
)


_TITLES = {RIGID: "rigid", FLEXIBLE: "flexible, within its range", HOSTILE: "flexible, whatever can be typed"}
_PLANES = {RIGID: _RIGID, FLEXIBLE: _FLEXIBLE, HOSTILE: _FLEXIBLE}


def _panel(figure: Figure, axes: matplotlib.axes.Axes, findings: Sequence[Finding], plane: tuple[Axis, Axis]) -> None:
    whole = [f for f in findings if f.margins and not f.cut]
    x, y = ([quantity(f.scene) for f in whole] for _, quantity in plane)
    margin = np.clip([max(f.margins.values()) for f in whole], _FLOOR, 1e2)
    order = np.argsort(margin)
    dots = axes.scatter(
        np.array(x)[order], np.array(y)[order], c=np.log10(margin[order]), cmap=_BEYOND, s=9, vmin=-8, vmax=0
    )
    cut = [f for f in findings if f.cut]
    if cut:
        x, y = ([quantity(f.scene) for f in cut] for _, quantity in plane)
        axes.scatter(x, y, marker="|", c="0.7", s=14, label="cut at the work bound", zorder=1)
    bad = [f for f in findings if f.failed]
    if bad:
        x, y = ([quantity(f.scene) for f in bad] for _, quantity in plane)
        axes.scatter(x, y, marker="o", facecolors="none", edgecolors="#D55E00", s=60, label="failed")
    axes.set(xscale="log", yscale="log", xlabel=plane[0][0], ylabel=plane[1][0])
    if plane is _RIGID:
        _mark_zero(axes)
    if cut or bad:
        axes.legend(loc="upper left", fontsize=8)
    figure.colorbar(dots, ax=axes, label="largest margin of any check, log10: 0 is the bound", extend="max")


def _mark_zero(axes: matplotlib.axes.Axes) -> None:
    """Where the logarithmic axis of the mass ratio says 0, and a line between that and the rest of it."""
    ticks = [10.0**power for power in range(-4, 3)]
    labels = [f"$10^{{{power}}}$" for power in range(-4, 3)]
    axes.set_yticks([_MASSLESS, *ticks], ["0", *labels])
    axes.axhline(5.5e-5, color="0.6", linewidth=0.8, linestyle=(0, (2, 2)))


def margins(report: Report) -> Figure:
    """Every scene as a dot in the plane that matters most to its solver, coloured by its largest margin."""
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(18.0, 5.0), layout="constrained")
        FigureCanvasAgg(figure)
        for axes, name, plane in zip(figure.subplots(1, 3), *zip(*_PLANES.items(), strict=True), strict=True):
            mine = report.of(name)
            if mine:  # of a few scenes a solver may have drawn none, and a logarithmic axis wants some
                _panel(figure, axes, mine, plane)
            else:
                axes.set_axis_off()
            axes.set_title(f"{_TITLES[name]}: {len(mine)} scene{'s' if len(mine) != 1 else ''}")
        return figure


def draw(report: Report, out: Path) -> Path:
    """The map into a folder."""
    return save(margins(report), out / "stress.png")
