"""Which interior belongs to a hoop."""

from __future__ import annotations

from ..models.chain import ChainHoop
from ..models.exact import ExactHoop
from ..models.full import FullHoop
from ..models.reduced import ReducedHoop
from .chain_interior import ChainInterior
from .recovery import ExactInterior, Interior, ReducedInterior


def interior_of(hoop: ReducedHoop | FullHoop | ChainHoop) -> Interior:
    """The interior of a hoop of any level."""
    if isinstance(hoop, ChainHoop):
        return ChainInterior(hoop)
    mass = hoop.scene.hoop.mass_ratio
    if isinstance(hoop, ReducedHoop):
        return ReducedInterior(hoop.ring, mass)
    kind = ExactInterior if isinstance(hoop, ExactHoop) else Interior
    return kind(hoop.ring.ring, hoop.ring.stiffness, mass)
