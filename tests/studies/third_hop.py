"""A roll made for the tests: it hops below a known stiffness, once and as high as that says, and is never run."""

from __future__ import annotations

import os
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Any

from rigid import Motion, Scene, simulate

LIFTS = {"anywhere": 37.0, "pulse": 9.0, "bottom": 2.0}
"""Below which it lifts off after the pulse, within it, and under the disk."""

STOPS = 0.6
"""Below which it stops before anything."""


@dataclass(frozen=True)
class Leap(Motion):
    """A rigid motion with a flight that it never had."""

    told: Any = None

    def to_dict(self) -> dict[str, Any]:
        return {**Motion.to_dict(self), **self.told}


def leap(scene: Scene, *, history: bool = False, progress: object = None) -> Leap:
    """The rigid motion, and flights by the law above; each call leaves a line in the file that COUNTED names."""
    if "COUNTED" in os.environ:
        with Path(os.environ["COUNTED"]).open("a") as file:
            file.write("rolled\n")
    motion = simulate(scene)
    stiffness, down = scene.ring.bending_stiffness, scene.release.phi0
    places = {"anywhere": 4.5, "pulse": 3.6, "bottom": pi}
    flights = [
        {"t": 1.0, "phi": phi, "duration": 0.1, "height": 0.01, "prominence": (LIFTS[where] / stiffness) ** 4,
         "swept": phi - down, "energies": None}
        for where, phi in sorted(places.items(), key=lambda place: place[1])
        if stiffness < 3 * LIFTS[where] and stiffness > STOPS
    ]  # fmt: skip
    done = stiffness > STOPS
    told = {"flights": flights, "completed": done, "swept": 6.0 if done else 0.1, "scales": None, "t_end": motion.t_end}
    return Leap(**{name: getattr(motion, name) for name in Motion.__dataclass_fields__}, told=told)
