"""Pressure and friction along the contact patch, drawn small beside the hoop."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import style
from .shots import Shot

Array = NDArray[np.float64]


def patch_of(shot: Shot) -> tuple[Array, Array, Array | None]:
    """(x from the hoop's centre, pressure, traction) along the touching part of the rim, from left to right.

    Empty off the floor, and for a series without a pressure; the traction is None where only that is missing.
    """
    rim = shot.rim
    if rim is None or "pressure" not in rim.point_data:
        return np.empty(0), np.empty(0), np.empty(0)
    pressure = np.asarray(rim.point_data["pressure"], dtype=float)
    traction = rim.point_data.get("traction")
    touching = pressure > 0
    touching |= np.roll(touching, 1) | np.roll(touching, -1)  # the edges
    x = np.asarray(rim.points[:, 0], dtype=float) - shot.centre[0]
    if "displacement" in rim.point_data:
        x = x + rim.point_data["displacement"][:, 0]
    order = np.flatnonzero(touching)[np.argsort(x[touching], kind="stable")]
    return x[order], pressure[order], None if traction is None else np.asarray(traction[order], dtype=float)


class PatchPlot:
    """Small axes with filled curves of p and, where it is known, of the friction traction, on scales that last over
    the run.

    Parameters
    ----------
    axes : matplotlib axes
        Empty.
    shots : list of Shot
        Spread over the run.
    units : mapping of str
    size : float
        Of the type, in points.
    """

    def __init__(self, axes: Any, shots: list[Shot], units: dict[str, str], size: float) -> None:
        self.axes = axes
        seen = [patch_of(shot) for shot in shots]
        reach = max((float(np.abs(x).max()) for x, _, _ in seen if len(x)), default=1.0)
        high = max((float(p.max()) for _, p, _ in seen if len(p)), default=1.0)
        tractions = [t for _, _, t in seen if t is not None]
        low = min((float(t.min()) for t in tractions if len(t)), default=0.0)
        self.power_x, self.power = (int(np.floor(np.log10(v))) for v in (reach, high))
        axes.set_xlim(-1.08 * reach, 1.08 * reach)
        axes.set_ylim(1.15 * min(low, 0.0) - 0.04 * high, 1.1 * high)
        axes.patch.set_alpha(0)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        for side in ("left", "bottom"):
            axes.spines[side].set_color(style.FAINT)
        axes.tick_params(labelsize=0.85 * size, color=style.FAINT, labelcolor=style.INK, length=2, pad=1.5)
        axes.locator_params(nbins=4)
        axes.xaxis.set_major_formatter(lambda value, _: f"{value / 10.0**self.power_x:g}")
        axes.yaxis.set_major_formatter(lambda value, _: f"{value / 10.0**self.power:g}")
        small: dict[str, Any] = {"fontsize": 0.85 * size, "color": style.INK}
        axes.set_xlabel(f"x − x_C  [{_ten(self.power_x)}{units['length']}]", labelpad=1, **small)
        unit = f"[{_ten(self.power)}{style.unit('pressure', units)}]"
        axes.set_title(f"in the patch  {unit}", loc="left", pad=2 * size, **small)
        where: dict[str, Any] = {"transform": axes.transAxes, "fontsize": 0.85 * size, "va": "bottom"}
        axes.text(0.0, 1.02, "pressure", color=style.NORMAL, **where)
        if tractions:
            axes.text(1.0, 1.02, "friction", color=style.FRICTION, ha="right", **where)
        axes.axhline(0, color=style.FAINT, lw=0.6)
        nothing = np.zeros((1, 2))
        common: dict[str, Any] = {"animated": True, "closed": True, "lw": 0.09 * size}
        from matplotlib.patches import Polygon

        fills = ((style.NORMAL, 3), (style.FRICTION, 4))[: 2 if tractions else 1]
        self._curves = [Polygon(nothing, facecolor=f"{c}55", edgecolor=c, zorder=z, **common) for c, z in fills]
        #: what is drawn anew in every picture
        self.moving: list[Any] = [axes.add_patch(curve) for curve in self._curves]

    def show(self, shot: Shot) -> None:
        """Draw the patch of this shot."""
        x, pressure, traction = patch_of(shot)
        for curve, values in zip(self._curves, (pressure, traction), strict=False):
            if values is None or not len(x):
                curve.set_xy(np.zeros((1, 2)))
                continue
            inside = np.column_stack([x, values])
            curve.set_xy(np.concatenate([[[x[0], 0.0]], inside, [[x[-1], 0.0]]]))


def _ten(power: int) -> str:
    return "" if power == 0 else f"$10^{{{power}}}$ "
