"""Which level of the hoop a scene gets, and whether the linear ring stayed within its range.

The linear ring neglects rotations of its sections against one. Bending by a force of n times the disk's weight turns
them by about n m g R^2/(E I); what that changes in a pulse grows with it.
"""

from __future__ import annotations

import logging
from functools import cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rigid import Scene, SceneError

from ..ring.choice import ring_of
from ..ring.fem import Ring
from .reduced import ReducedHoop

if TYPE_CHECKING:
    from .chain import ChainHoop
    from .full import FullHoop

Array = NDArray[np.float64]
Hoop: TypeAlias = "ReducedHoop | FullHoop | ChainHoop"

#: E I/(m g R^2) below which "auto" takes the chain, exact for large rotations. In a pulse that begins undeformed at
#: phi = 2.9 with phidot = 4 (k = 0.1, r = 1.02, m_h/m = 0.1; E I/(m g R^2) = 0.63 for E b R/(m g) = 1e6) linear and
#: exact part in the normal impulse by 0.14 % at 63, 0.3 % at 31, 1 % at 13, 2.4 % at 6; in the friction impulse by 1e-4
#: of the normal one at 63, 6e-3 at 13; in the friction loss, small itself, by 0.6 % at 630, 1.4 % at 126, 2.6 % at 31.
SOFT = 40.0
#: rotation of the rim at the floor up to which the linear ring's normal impulse is good to about 1 %, there
FAR = 0.0075


def level_of(scene: Scene) -> str:
    """The level that a scene without units asks for: "auto" is reduced unless the ring is soft, and then a chain."""
    if scene.solve.level == "auto":
        return "reduced" if scene.ring.bending_stiffness >= SOFT else "chain"
    return str(scene.solve.level)


def ring_for(scene: Scene) -> Ring:
    """The quads on which a scene without units stands, without the hoop."""
    level = level_of(scene)
    if level == "chain":
        from .chain import THROUGH

        return ring_of(scene, THROUGH, linear=False)
    return ring_of(scene, linear=level != "exact")


@cache
def _tell_of_all_nodes() -> None:
    """Once in a process."""
    logging.getLogger("hoop-pulse").warning(
        "hoop: the ring is too thick for a chain of rods: all its nodes are moved, which takes minutes for seconds."
    )


def hoop_of(scene: Scene) -> Hoop:
    """The scene's hoop at that level; of a ring that is no rod and was left to choose, all nodes.

    A level is loaded when the first scene asks for it.
    """
    level = level_of(scene)
    if level == "reduced":
        return ReducedHoop(scene)
    if level == "chain":
        from .chain import ChainHoop

        try:
            return ChainHoop(scene)
        except SceneError:
            if scene.solve.level == "chain":
                raise
            level = "exact"
            _tell_of_all_nodes()
    if level == "exact":
        from .exact import ExactHoop

        return ExactHoop(scene)
    from .full import FullHoop

    return FullHoop(scene)


class Range:
    """Follows the rotation of the rim at the floor through a motion."""

    def __init__(self, hoop: Hoop) -> None:
        self.linear = hoop.linear
        #: time, rotation and angle phi of every instant at which it had turned further than before
        self.records: list[tuple[float, float, float]] = []

    @property
    def furthest(self) -> float:
        """The largest rotation."""
        return self.records[-1][1] if self.records else 0.0

    def __call__(self, t: Array, turned: Array, phi: Array) -> None:
        """Of the next instants: times, rotations (:func:`flexible.contact.points.rim.turned`) and angles."""
        if not self.linear or not turned.max(initial=0.0) > self.furthest:
            return
        for now in zip(t.tolist(), turned.tolist(), phi.tolist(), strict=True):
            if now[1] > self.furthest:
                self.records.append(now)

    def complaint(self) -> str:
        """A sentence if the linear ring went too far, otherwise empty."""
        if self.furthest <= FAR:
            return ""
        _, furthest, phi = self.records[-1]
        return (
            f"the rim at the floor turned by {furthest:.2g} rad at phi = {phi:.4g} rad, too far for a linear ring"
            " (solve.level = 'chain', or of a wall too thick for one 'exact', has no such limit)"
        )
