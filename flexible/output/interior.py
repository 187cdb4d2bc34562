"""Which interior belongs to a hoop."""

from __future__ import annotations

from ..models.reduced import ReducedHoop
from ..models.select import Hoop
from .recovery import ExactInterior, Interior, ReducedInterior


def interior_of(hoop: Hoop) -> Interior:
    """The interior of a hoop of any level; a level that the hoop has not is not loaded."""
    mass = hoop.scene.hoop.mass_ratio
    if isinstance(hoop, ReducedHoop):
        return ReducedInterior(hoop.ring, mass)
    from ..models.chain import ChainHoop

    if isinstance(hoop, ChainHoop):
        from .chain_interior import ChainInterior

        return ChainInterior(hoop)
    kind = Interior if hoop.linear else ExactInterior
    return kind(hoop.ring.ring, hoop.ring.stiffness, mass)
