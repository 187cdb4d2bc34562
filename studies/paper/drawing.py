"""A figure drawn from its records, and the same numbers as CSV."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Drawing

from ..plots.style import STYLE
from ..running.files import write_text, write_whole
from ..running.history import rows_to_csv
from .panels import QUANTITIES, Figure, Panel, Part
from .sampling import Line, lines

FORMATS = ("png", "svg")
# as in the paper: black lines told apart by their strokes
LOOK: Any = {**STYLE, "svg.hashsalt": "hoop-pulse", "svg.fonttype": "path", "lines.linewidth": 1.2}


def draw_panel(axes: Any, panel: Panel, curves: Sequence[Line], legend: str = "") -> None:
    """Draw a panel's curves into axes; a legend only where there are several."""
    x_label = QUANTITIES[panel.x].label
    for line in curves:
        x = line.x
        if panel.tick:
            x = (x - math.pi) / panel.tick
            x_label = rf"$\varphi-\pi$, $10^{{{round(math.log10(panel.tick))}}}$ rad"
        axes.plot(x, line.y, color="black", linestyle=line.curve.style, label=line.curve.label or None)
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0, color="0.7", linewidth=0.6, zorder=1)
    axes.set(xlabel=x_label, ylabel=QUANTITIES[panel.y].label)
    axes.margins(x=0)
    if panel.part in (Part.THREE_CYCLES, Part.FIRST_ROTATION):
        axes.set_xlim(left=0)
    if len(curves) > 1:
        axes.legend(title=legend, handlelength=3.2)


def two_panels(title: str) -> Drawing:
    """Two empty axes, at the same places in every figure."""
    drawing = Drawing(figsize=(10.0, 4.2))
    FigureCanvasAgg(drawing)
    drawing.subplots(1, 2)
    drawing.subplots_adjust(left=0.085, right=0.985, bottom=0.13, top=0.9, wspace=0.22)
    drawing.suptitle(title, fontsize="medium", x=0.01, ha="left")
    return drawing


def draw(figure: Figure, left: Sequence[Line], right: Sequence[Line]) -> Drawing:
    """A figure with its two panels."""
    with matplotlib.rc_context(LOOK):
        drawing = two_panels(f"{figure.number}.  {figure.caption}")
        for axes, panel, curves in zip(drawing.axes, figure.panels.values(), (left, right), strict=True):
            draw_panel(axes, panel, curves, figure.legend)
    return drawing


def panel_csv(panel: Panel, curves: Sequence[Line], legend: str = "") -> str:
    """A panel's points as text: the curve where there are several, the phase, abscissa and ordinate to the last bit."""
    several = [legend.replace("$", "").replace("\\", "")] if len(curves) > 1 else []
    header = [*several, "phase", QUANTITIES[panel.x].column, QUANTITIES[panel.y].column]
    rows = (
        [*([line.curve.label] if several else []), phase, x, y]
        for line in curves
        for phase, x, y in zip(line.phase.tolist(), line.x.tolist(), line.y.tolist(), strict=True)
    )
    return rows_to_csv(header, rows)


def save_drawing(drawing: Drawing, out: Path, name: str, formats: Sequence[str]) -> None:
    """Write a drawing in every format asked for."""
    with matplotlib.rc_context(LOOK):
        for suffix in formats:
            # a date would make every file another one
            options: Any = {"format": suffix, "dpi": 160, "metadata": {"Date": None} if suffix == "svg" else None}
            write_whole(out / f"{name}.{suffix}", partial(drawing.savefig, **options))


def write_figure(figure: Figure, out: Path, formats: Sequence[str]) -> None:
    """``figure-NN.png`` or ``.svg``, and ``figure-NN-left.csv`` and ``-right.csv`` beside it."""
    curves = {side: lines(figure, side) for side in figure.panels}
    save_drawing(draw(figure, **curves), out, figure.name, formats)
    for side, panel in figure.panels.items():
        write_text(out / f"{figure.name}-{side}.csv", panel_csv(panel, curves[side], figure.legend))
