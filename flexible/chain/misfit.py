"""What frame, sections and the window's nodes lack of equilibrium, and the core of Newton's matrix for them."""

from __future__ import annotations

from typing import Any, NamedTuple

from rigid.kernel.compile import part

from ..contact.newton import FRAME, round_off
from ..contact.vectors import largest
from .touch import add_bending, add_forces, add_rim, astray_of, push


@part
def rounding(chain: Any, contact: Any, pos: Any, acc: Any, u: Any, scale: float, damper: Any) -> float:
    """Size of the rounding errors: of the contact's, of strain and inertia."""
    local = chain.rod.local
    floor = round_off(contact, pos[1], u, scale, damper)
    floor += 4e-16 * largest(local[local.shape[0] // 2]) * largest(pos[FRAME:])
    return floor + 4e-16 * chain.body.ring_mass * largest(acc[FRAME:])


class Misfit(NamedTuple):
    """What frame, sections and the window's nodes lack of equilibrium."""

    frame: Any
    sections: Any
    rest: Any  # of the nodes, flat
    forces: float  # the largest on frame and sections
    nodes: float  # and of the nodes


@part
def misfit(touch: Any, contact: Any, place: Any, own: Any, scale: float) -> Misfit:
    """``own``: forces of inertia, gravity and strain on frame and sections."""
    frame, force = own[0].copy(), own[1].copy()
    push(touch, contact, place, frame, force)
    rest = astray_of(touch, contact.nodal, scale)
    return Misfit(frame, force, rest, max(largest(frame), largest(force[1:-1])), largest(rest))


@part
def close(core: Any, chained: Any, touch: Any, contact: Any, chain: Any, scale: float) -> None:
    """The core of Newton's matrix: what the elimination of the ``chained`` sections left, and the floor."""
    rod, q, nodes, place = chain
    for i in range(chained.shape[0]):
        for k in range(chained.shape[0]):
            core[i, k] = chained[i, k]
    add_forces(core, touch, contact.nodal, contact.tangent, scale)
    add_bending(core, rod, q, nodes, place, contact.nodal)
    add_rim(core, touch, contact.nodal, scale)
