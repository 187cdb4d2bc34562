"""Which level of the hoop a scene gets, and whether the linear ring stayed within its range.

The linear ring neglects rotations of its sections against one. Bending by a force of n times the disk's weight turns
them by about n m g R^2/(E I); what that changes in a pulse goes as 1/(E I) too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from .exact import ExactHoop
from .full import FullHoop
from .march import State
from .reduced import ReducedHoop

Array = NDArray[np.float64]
Hoop = ReducedHoop | FullHoop

#: E I/(m g R^2) below which "auto" takes the exact ring
SOFT = 40.0
#: largest displacement of the rim at the floor, over R, at which the linear ring is still good to about 1 %
FAR = 0.005


def hoop_of(scene: Scene) -> Hoop:
    """The scene's hoop at the level that it asks for; "auto" is reduced unless the ring is soft."""
    level = scene.solve.level
    if level == "auto":
        level = "exact" if scene.ring.bending_stiffness < SOFT else "reduced"
    if level == "reduced":
        return ReducedHoop(scene)
    return ExactHoop(scene) if level == "exact" else FullHoop(scene)


class Range:
    """Follows the rim's displacement at the floor through a motion."""

    def __init__(self, hoop: Hoop) -> None:
        self.linear = not isinstance(hoop, ExactHoop)
        self.furthest = 0.0
        self.phi = 0.0

    def __call__(self, state: State) -> None:
        moved = float(np.abs(state.u).max(initial=0.0))
        if moved > self.furthest:
            self.furthest, self.phi = moved, float(state.pos[2])

    def complaint(self) -> str:
        """A sentence if the linear ring went too far, otherwise empty."""
        if not self.linear or self.furthest <= FAR:
            return ""
        return (
            f"the rim moved by {self.furthest:.2g} R at phi = {self.phi:.4g}, too far for a linear ring:"
            " solve.level = 'exact' does without it"
        )
