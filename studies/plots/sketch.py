"""The hoop with its angles, signs and names, as it stands at the top of the README.

python -m studies.plots.sketch        leaves hoop.svg here
"""

from __future__ import annotations

from math import cos, pi, radians, sin
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Annulus, Arc, Circle, Polygon

from .style import OKABE_ITO, STYLE, blank, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PHI = radians(128)
INNER, DISK = 0.93, 0.2  # over R; a wall and a disk that can be seen
NORMAL, FRICTION, SLIP = (OKABE_ITO[name] for name in ("kinetic", "friction_loss", "ring_strain"))


def sketch() -> Figure:
    """Hoop, disk and floor; on the right what its contact can do."""
    with matplotlib.rc_context(STYLE | {"axes.grid": False, "font.size": 12}):
        figure = blank(10.0, 4.6)
        axes = figure.subplots()
        axes.set(xlim=(-1.75, 4.5), ylim=(-0.62, 2.35), aspect="equal")
        axes.set_axis_off()
        _hoop(axes)
        _forces(axes)
        for row, (name, words, slip, friction) in enumerate(CONTACTS):
            _contact(axes, 2.75, 1.72 - 0.62 * row, name, words, slip, friction)
        return figure


CONTACTS = (
    ("roll", "$v = 0$,  $|F| \\leq \\mu_s N$", 0, 0),
    ("spin", "$v < 0$,  $F = +\\mu N$", -1, 1),
    ("skid", "$v > 0$,  $F = -\\mu N$", 1, -1),
)
"""What the contact does, with the signs of slip velocity and friction."""


def _hoop(axes: Axes) -> None:
    """Floor, ring and disk, their radii, and the angle."""
    axes.add_patch(Polygon([(-1.6, 0), (1.75, 0), (1.75, -0.09), (-1.6, -0.09)], color="0.88"))
    axes.plot([-1.6, 1.75], [0, 0], color="0.35", lw=1.2)
    axes.add_patch(Annulus((0, 1), 1.0, 1 - INNER, facecolor="#c9d8c9", edgecolor="0.35", lw=1))
    reach = INNER - DISK
    middle = np.array([reach * sin(PHI), 1 + reach * cos(PHI)])
    axes.add_patch(Circle(tuple(middle), DISK, facecolor="0.42", edgecolor="0.25"))
    axes.annotate("disk, mass $m$,\nradius $k$ of the\ninner one", (middle[0] + 0.1, middle[1] + 0.13), (1.16, 0.82),
                  arrowprops={"arrowstyle": "-", "color": "0.5", "lw": 0.8}, va="center", fontsize=11)  # fmt: skip
    wall = np.array([cos(2.25), sin(2.25)]) * (1 + INNER) / 2 + [0, 1]
    axes.annotate("ring, mass $m_h$,\n$r$ = outer over\ninner radius", tuple(wall), (-1.72, 2.1),
                  arrowprops={"arrowstyle": "-", "color": "0.5", "lw": 0.8}, va="center", fontsize=11)  # fmt: skip
    axes.plot([0, 0], [1, 1.72], color="0.5", lw=1, ls=(0, (5, 3)))
    axes.plot([0, middle[0]], [1, middle[1]], color="0.5", lw=1, ls=(0, (5, 3)))
    axes.plot([0], [1], "o", color="0.2", ms=4)
    axes.text(-0.09, 1.0, "$C$", ha="right", va="center")
    angles = np.linspace(pi / 2, pi / 2 - PHI, 60)
    axes.add_patch(Arc((0, 1), 0.84, 0.84, theta1=np.degrees(angles[-1]), theta2=90, color="0.2", lw=1.3))
    end, before = (0.42 * np.array([cos(a), sin(a)]) + [0, 1] for a in (angles[-1], angles[-7]))
    axes.annotate("", tuple(end), tuple(before), arrowprops=_arrow("0.2", 1.3))
    axes.text(0.47, 1.24, "$\\varphi$", fontsize=15)
    far = np.array([cos(radians(205)), 1 + sin(radians(205))])
    axes.annotate("", tuple(far), (0, 1), arrowprops=_arrow("0.5", 1))
    axes.text(-0.5, 0.86, "$R$", color="0.35", ha="center", va="bottom")
    axes.annotate("", (0.75, 2.2), (0.2, 2.2), arrowprops=_arrow("0.35", 1.2))
    axes.text(0.8, 2.2, "$x_C$", va="center", color="0.25")


def _forces(axes: Axes) -> None:
    """What acts on the hoop, in its positive sense."""
    weight = np.array([(INNER - DISK) * sin(PHI), 1 + (INNER - DISK) * cos(PHI)])
    axes.annotate("", (weight[0], weight[1] - 0.42), tuple(weight), arrowprops=_arrow("0.15", 1.6))
    axes.text(weight[0] + 0.05, weight[1] - 0.4, "$mg$", va="center", color="0.15")
    axes.annotate("", (0, 0.62), (0, 0), arrowprops=_arrow(NORMAL, 2.2))
    axes.text(-0.06, 0.55, "$N$", color=NORMAL, ha="right")
    axes.annotate("", (0.5, -0.02), (0, -0.02), arrowprops=_arrow(FRICTION, 2.2))
    axes.text(0.53, -0.2, "$F$", color=FRICTION, ha="center")
    axes.annotate("", (-0.02, -0.42), (-0.42, -0.42), arrowprops=_arrow(SLIP, 2.2))
    axes.text(0.04, -0.43, "$v = \\dot x_C - R\\dot\\varphi$, slip velocity of the rim", color=SLIP, va="center",
              fontsize=11)  # fmt: skip
    axes.text(-1.6, -0.22, "floor: foundation, $\\mu_s$, $\\mu$", fontsize=11, va="center")


def _contact(axes: Axes, x: float, y: float, name: str, words: str, slip: int, friction: int) -> None:
    """One thing that the contact can do, drawn small: an arc of the rim on the floor, friction and slip."""
    arc = np.linspace(-2.0, -1.14, 30)
    axes.plot(x + 0.55 * np.cos(arc), y + 0.55 + 0.55 * np.sin(arc), color="0.35", lw=2.4)
    axes.plot([x - 0.4, x + 0.4], [y, y], color="0.35", lw=1)
    axes.text(x + 0.62, y + 0.13, name, fontweight="bold", va="center")
    axes.text(x + 0.62, y - 0.08, words, va="center", fontsize=11)
    for sign, colour, down in ((friction, FRICTION, -0.05), (slip, SLIP, -0.15)):
        if sign:
            axes.annotate("", (x + 0.3 * sign, y + down), (x - 0.02 * sign, y + down), arrowprops=_arrow(colour, 2))


def _arrow(colour: str, width: float) -> dict[str, Any]:
    return {"arrowstyle": "-|>", "color": colour, "lw": width, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 12}


if __name__ == "__main__":
    save(sketch(), Path("hoop.svg"))
