"""The paper's figures 2 to 12, one record each: what its panels show, of which scenes, how far, in which lines.

The captions are in our own words. Friction is .35/.3 and the release at rest from 10 degrees unless a scene says
otherwise; a curve's scene is printed by ``hoop scenes NAME``.
"""

from __future__ import annotations

from .panels import Curve, Figure, Panel, Part

CYCLES, PULSE, ROTATION, BOTTOM = Part.THREE_CYCLES, Part.FIRST_PULSE, Part.FIRST_ROTATION, Part.NEAR_BOTTOM

_K_01 = (Curve("paper-3.1"),)
_K_025 = (Curve("paper-3.2-k0.25"),)
_MASSES = (
    Curve("paper-3.3-massless", "0", "dotted"),
    Curve("paper-3.3-light", "0.01", "dashed"),
    Curve("paper-3.3-heavier", "0.1", "solid"),
)
_ONE_DENSITY = (Curve("paper-3.3-same-density"),)
_TINY = (Curve("paper-3.4-tiny", "0.35/0.3", "dashed"), Curve("paper-3.4-tiny-rough", "0.7/0.6", "solid"))
_FRICTIONS = (
    Curve("paper-3.4-frictionless", "0/0", "solid"),
    Curve("paper-3.4-slippery", "0.09/0.076", "dashed"),
    Curve("paper-3.3-heavier", "0.35/0.3", "dotted"),
    Curve("paper-3.4-rough", "1.2/1", "dashdot"),
)

FIGURE_2 = Figure(
    2,
    "Section 3.1, k = 0.1, massless thin hoop: slip velocity through three cycles and through the first pulse",
    _K_01,
    left=Panel("slip", "t", CYCLES),
    right=Panel("slip", "t", PULSE),
)
FIGURE_3 = Figure(
    3,
    "Section 3.1, k = 0.1: normal force through three cycles and through the first pulse",
    _K_01,
    left=Panel("N", "t", CYCLES),
    right=Panel("N", "t", PULSE),
)
FIGURE_4 = Figure(
    4,
    "Section 3.1, k = 0.1: friction force through three cycles and through the first pulse",
    _K_01,
    left=Panel("F", "t", CYCLES),
    right=Panel("F", "t", PULSE),
)
FIGURE_5 = Figure(
    5,
    "Section 3.1, k = 0.1: angular velocity and angular acceleration through three cycles",
    _K_01,
    left=Panel("omega", "t", CYCLES),
    right=Panel("alpha", "t", CYCLES),
)
FIGURE_6 = Figure(
    6,
    "Section 3.2, k = 0.25: slip velocity of the first clockwise rotation, over angle and time",
    _K_025,
    left=Panel("slip", "phi", ROTATION),
    right=Panel("slip", "t", ROTATION),
)
FIGURE_7 = Figure(
    7,
    "Section 3.2, k = 0.25: normal and friction force of the first clockwise rotation",
    _K_025,
    left=Panel("N", "phi", ROTATION),
    right=Panel("F", "phi", ROTATION),
)
FIGURE_8 = Figure(
    8,
    "Section 3.3, k = 0.1, r = 1.02: slip velocity of the first clockwise rotation, normal force near its bottom",
    _MASSES,
    left=Panel("slip", "phi", ROTATION),
    right=Panel("N", "phi", BOTTOM, reach=0.5),
    legend="$m_h/m$",
)
FIGURE_9 = Figure(
    9,
    "Section 3.3, k = 0.1, r = 1.02, hoop and disk of one density: forces of the first clockwise rotation",
    _ONE_DENSITY,
    left=Panel("N", "phi", ROTATION),
    right=Panel("F", "phi", ROTATION),
)
FIGURE_10 = Figure(
    10,
    "Section 3.4, k = 1e-5: slip velocity of the first clockwise rotation, and within ten disk radii of its bottom",
    _TINY,
    left=Panel("slip", "phi", ROTATION),
    right=Panel("slip", "phi", BOTTOM, reach=1e-4, tick=1e-5),
    legend=r"$\mu_s/\mu$",
)
FIGURE_11 = Figure(
    11,
    "Section 3.4, k = 0.1, r = 1.02, $m_h/m$ = 0.1: forces of the first clockwise rotation",
    _FRICTIONS,
    left=Panel("N", "phi", ROTATION),
    right=Panel("F", "phi", ROTATION),
    legend=r"$\mu_s/\mu$",
)
FIGURE_12 = Figure(
    12,
    "Section 3.4, k = 0.1, r = 1.02, $m_h/m$ = 0.1: squared angular velocity and angular acceleration",
    _FRICTIONS,
    left=Panel("omega2", "phi", ROTATION),
    right=Panel("alpha", "phi", ROTATION),
    legend=r"$\mu_s/\mu$",
)

FIGURES = (
    FIGURE_2, FIGURE_3, FIGURE_4, FIGURE_5, FIGURE_6, FIGURE_7, FIGURE_8, FIGURE_9, FIGURE_10, FIGURE_11, FIGURE_12,
)  # fmt: skip
