"""What a figure of the paper is made of: quantities, curves, extents, panels. Plain data; nothing here computes.

Everything is in the paper's scaling: lengths over R, times over sqrt(R/g), forces over m g with m the disk's mass.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from rigid import States

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """Something drawn over something else."""

    name: str
    column: str
    """Name of its column in a CSV file, unit included."""
    label: str
    """Of an axis."""
    of: Callable[[States], Array]


_QUANTITIES = (
    Quantity("t", "t [sqrt(R/g)]", r"time $t/\sqrt{R/g}$", lambda s: s.t),
    Quantity("phi", "phi [rad]", r"angle $\varphi$, rad", lambda s: s.phi),
    Quantity("slip", "slip velocity [sqrt(g R)]", r"slip velocity $v/\sqrt{gR}$", lambda s: s.slip_velocity),
    Quantity("N", "N [m g]", r"normal force $N/(mg)$", lambda s: s.normal_force),
    Quantity("F", "F [m g]", r"friction force $F/(mg)$", lambda s: s.friction_force),
    Quantity("omega", "phidot [sqrt(g/R)]", r"angular velocity $\dot\varphi/\sqrt{g/R}$", lambda s: s.omega),
    Quantity("omega2", "phidot^2 [g/R]", r"$\dot\varphi^2/(g/R)$", lambda s: s.omega**2),
    Quantity("alpha", "phiddot [g/R]", r"angular acceleration $\ddot\varphi/(g/R)$", lambda s: s.alpha),
    Quantity("energy", "energy [m g R]", r"energy $E/(mgR)$", lambda s: s.energy),
)
QUANTITIES = {quantity.name: quantity for quantity in _QUANTITIES}


class Part(StrEnum):
    """Which part of a motion a panel shows."""

    THREE_CYCLES = "release to the end of the third cycle"
    FIRST_PULSE = "the first interaction pulse"
    FIRST_ROTATION = "first clockwise rotation, to phidot = 0"
    NEAR_BOTTOM = "near phi = pi"


TURNS = {Part.THREE_CYCLES: 6, Part.FIRST_PULSE: 1, Part.FIRST_ROTATION: 1, Part.NEAR_BOTTOM: 1}
"""Turns, phidot = 0, up to which a motion must run for each part: a cycle is a clockwise and a counterclockwise
rotation."""


@dataclass(frozen=True)
class Panel:
    """One quantity over another, on linear axes."""

    y: str
    x: str
    part: Part
    reach: float = 0.0
    """Of ``Part.NEAR_BOTTOM``: how far to either side of phi = pi, in radians."""
    tick: float = 0.0
    """Unit in which phi - pi is drawn where phi itself would have too many digits; 0 draws phi."""


@dataclass(frozen=True)
class Curve:
    """A shipped scene, what the legend calls it, and its line."""

    scene: str
    label: str = ""
    style: str = "solid"


@dataclass(frozen=True)
class Figure:
    """A figure of the paper: two panels of the same curves."""

    number: int
    caption: str
    curves: tuple[Curve, ...]
    left: Panel
    right: Panel
    legend: str = ""
    """What tells the curves apart."""

    @property
    def name(self) -> str:
        """Stem of its files."""
        return f"figure-{self.number:02d}"

    @property
    def panels(self) -> dict[str, Panel]:
        """By side."""
        return {"left": self.left, "right": self.right}
