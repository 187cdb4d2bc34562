"""How figures look: their frame, their colours, and how they are written to a file.

Colours are told apart by every kind of colour vision: the rigid hoop is black, stiffness runs through viridis
(which also grows lighter), and areas take the Okabe-Ito set.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import matplotlib
import numpy as np
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray

from ..running.files import write_whole

STYLE: Any = {
    "figure.dpi": 110,
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "lines.linewidth": 1.4,
    "savefig.facecolor": "white",
}

AnyCanvas = TypeVar("AnyCanvas", bound=FigureCanvasBase)

RIGID = "black"
UNDER: Any = {"linewidth": 3.2, "zorder": 1.8}
"""How the rigid hoop's line is drawn: wide, and under those of the flexible one."""

OKABE_ITO = {
    "kinetic": "#0072B2",
    "gravity": "#56B4E9",
    "ring_strain": "#009E73",
    "contact_spring": "#E69F00",
    "friction_loss": "#D55E00",
    "damping_loss": "#CC79A7",
    "numerical_loss": "#999999",
}


def blank(width: float, height: float) -> Figure:
    """An empty figure of a size in inches."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def panels_on(axes: Any, count: int, size: tuple[float, float]) -> NDArray[np.object_]:
    """Panels beside one another, on the ``axes`` given or, of this size each, in a new figure.

    Raises
    ------
    ValueError
        Another number of axes than of panels.
    """
    if axes is None:
        from matplotlib import pyplot

        whole = (count * size[0], size[1])
        axes = pyplot.subplots(1, count, squeeze=False, figsize=whole, layout="constrained")[1]
    panels = np.atleast_1d(axes).ravel()
    if len(panels) != count:
        raise ValueError(f"{count} measures need as many axes, not {len(panels)}.")
    return panels


def save(figure: Figure, path: Path) -> Path:
    """Write a figure, as PNG or SVG by its suffix, whole or not at all; the same figure is the same file.

    The canvases print themselves: ``savefig`` draws everything once more beforehand, to no avail but that of a bounding
    box that is not asked for here.
    """
    _only_decades(figure)
    if path.suffix == ".svg":
        from matplotlib.backends.backend_svg import FigureCanvasSVG

        with matplotlib.rc_context({"svg.hashsalt": path.stem}), _on(FigureCanvasSVG(figure), 72) as canvas:
            return write_whole(path, lambda part: canvas.print_svg(part, metadata={"Date": None}))
    with _on(FigureCanvasAgg(figure), 150) as canvas:
        return write_whole(path, canvas.print_png)


MANY = 1e4
"""Ends of a logarithmic axis over one another from which on it has ticks at powers of ten alone: those between lie
close to one another, and took as long to draw as all that the axis is for."""


def _only_decades(figure: Figure) -> None:
    for axes in figure.axes:
        for axis, ends in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
            if axis.get_scale() == "log" and max(ends) > MANY * min(ends):
                axis.set_minor_locator(NullLocator())


@contextmanager
def _on(canvas: AnyCanvas, dpi: float) -> Iterator[AnyCanvas]:
    """A canvas with its figure at a resolution, which it has for as long as that."""
    figure = canvas.figure
    before, figure.dpi = figure.dpi, dpi
    try:
        yield canvas
    finally:
        figure.dpi = before


def save_both(figure: Figure, path: Path) -> Path:
    """Write a figure as PNG and, for a page, as SVG beside it, whose path is returned."""
    save(figure, path.with_suffix(".png"))
    figure.set_layout_engine("none")  # everything has its place, which took as long to find as to draw it
    return save(figure, path.with_suffix(".svg"))


def colours(count: int) -> list[tuple[float, float, float, float]]:
    """Colours for growing stiffness, dark to light, the yellow end left out as too faint for a line."""
    return [tuple(c) for c in matplotlib.colormaps["viridis"](np.linspace(0.0, 0.88, max(count, 1)))]


def power_of_ten(value: float) -> str:
    """A stiffness as 10^7 or 3.2·10^7."""
    exponent = int(np.floor(np.log10(value) + 1e-9))
    mantissa = value / 10.0**exponent
    return f"$10^{{{exponent}}}$" if abs(mantissa - 1) < 0.02 else f"${mantissa:.2g}\\cdot 10^{{{exponent}}}$"
