"""Two figures more, which the paper does not have: inception of slip over the release, and energy over time."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure as Drawing

from rigid import Hoop, inception_mu_s

from ..running.files import write_text
from ..running.history import rows_to_csv
from .drawing import LOOK, draw_panel, panel_csv, save_drawing, two_panels
from .figures import FIGURE_10, FIGURE_11
from .panels import Panel, Part
from .sampling import line

WIDE: dict[str, Any] = {"color": "0.65", "linewidth": 3.5, "zorder": 1.5}  # shows beneath a line that it all but is
HOOPS: dict[str, tuple[Hoop, dict[str, Any]]] = {
    "point mass": (Hoop(0.0), {"linestyle": "dotted"}),
    "k = 0.1": (Hoop(0.1), {"linestyle": "dashed"}),
    "k = 0.1, r = 1.02, $m_h/m$ = 0.1": (Hoop(0.1, 1.02, 0.1), {"linestyle": "solid"}),
    "k = 0.25": (Hoop(0.25), WIDE),
}
CAPTIONS = {
    "extra-inception": r"smallest $\mu_s$ with which a hoop rolls from rest, (9); on the right near 10 degrees",
    "extra-energy": "energy through the first clockwise rotation, of the hoops of figures 11 and 10",
}


def _write_inception(out: Path, formats: Sequence[str]) -> None:
    name, columns = "extra-inception", ["hoop", "phi0 [deg]", "mu_s"]
    with matplotlib.rc_context(LOOK):
        drawing: Drawing = two_panels(f"Extra.  {CAPTIONS[name]}")
        for axes, side, last, top in zip(drawing.axes, ("left", "right"), (179.5, 20.0), (2.0, 0.2), strict=True):
            angles = np.linspace(0.5, last, 400)
            rows: list[tuple[Any, ...]] = []
            for label, (hoop, style) in HOOPS.items():
                needed = [inception_mu_s(hoop, radians(angle)) for angle in angles]
                axes.plot(angles, needed, **{"color": "black", **style}, label=label)
                rows += [(label.replace("$", ""), *pair) for pair in zip(angles.tolist(), needed, strict=True)]
            axes.set(xlabel=r"$\varphi_0$, degrees", ylabel=r"$\mu_s$ at inception", xlim=(0, last), ylim=(0, top))
            axes.legend(handlelength=3.2)
            write_text(out / f"{name}-{side}.csv", rows_to_csv(columns, rows))
    save_drawing(drawing, out, name, formats)


def _write_energy(out: Path, formats: Sequence[str]) -> None:
    name, panel = "extra-energy", Panel("energy", "t", Part.FIRST_ROTATION)
    with matplotlib.rc_context(LOOK):
        drawing = two_panels(f"Extra.  {CAPTIONS[name]}")
        for axes, side, figure in zip(drawing.axes, ("left", "right"), (FIGURE_11, FIGURE_10), strict=True):
            curves = [line(curve, panel) for curve in figure.curves]
            draw_panel(axes, panel, curves, figure.legend)
            write_text(out / f"{name}-{side}.csv", panel_csv(panel, curves, figure.legend))
    save_drawing(drawing, out, name, formats)


def write_extra(out: Path, formats: Sequence[str]) -> None:
    """Both, with their points as CSV."""
    _write_inception(out, formats)
    _write_energy(out, formats)
