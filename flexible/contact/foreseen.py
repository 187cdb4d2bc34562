"""What Newton on a stage foresees the patch to carry, and the forces of the floor that go with it.

A damper multiplies the elastic forces by eta = 1 + relaxation (N_el - N_el0)/N_el, and pulls a sticking patch back with
``drag`` times what it slips. In a short step both numbers are so large that N and F are all but given, and N_el and the
slip answer to them by some 1e-4 of themselves. Where a soft ring lies flat on the floor they are known from each shape
of the rim far less well than that, and Newton's next matrix would be made of forces a thousand times too large.

So N and F are unknowns of their own, as a pressure is in a body that cannot be compressed: Newton foresees them, and
its matrix is made where the patch carries what was foreseen. For that ``elastic_0`` and ``held`` are moved, and a step
moves them back: the forces that it is to balance are those of the stage's own damper as they follow from the moved
one's and their derivatives. (Its own as they are would say of bristles that they slide, where all the patch lacks is
the pressure to hold them. For the same reason the derivatives are not differences: a bristle that breaks between two
pressures lets go of a share of mu_s - mu, which over a small difference of pressures is no derivative.)
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import loop, part

from .newton import FRAME
from .points.data import Contact, Damper, Resultants

NEAR = 0.1  # of 1 + N: nearer to what is foreseen than that the patch is taken as it is


class Foreseen(NamedTuple):
    """What the patch is expected to carry."""

    normal: float  # 0 where nothing is known
    friction: float


class Moved(NamedTuple):
    """A damper under which the patch carries what was foreseen."""

    elastic: float  # how far ``elastic_0`` of the stage's own is moved
    held: float  # and what its drag holds the patch with


@loop
def moved_by(damper: Damper, foreseen: Foreseen, res: Resultants) -> Moved:
    """How a damper is to be moved so that the patch carries what was foreseen; not at all where it is near enough."""
    elastic, held = 0.0, 0.0
    if res.elastic == 0:
        return Moved(elastic, held)
    near = NEAR * (1 + abs(foreseen.normal))
    linear = damper.pulls or (res.eta > 0 and foreseen.normal > 0)
    if foreseen.normal != 0 and damper.relaxation > 0 and linear and abs(res.normal - foreseen.normal) > near:
        elastic = (res.normal - foreseen.normal) / damper.relaxation
    # a friction that is no drag has an end
    if res.steepness > 0 and res.reach == np.inf and abs(res.friction - foreseen.friction) > near:
        held = foreseen.friction - res.friction
    return Moved(elastic, held)


@loop
def moved_damper(damper: Damper, moved: Moved) -> Damper:
    """The damper itself, moved."""
    return Damper(
        damper.relaxation, damper.elastic_0 + moved.elastic, damper.eta_0, damper.drag, damper.way_0, damper.ratio,
        damper.rate, damper.velocity_0, damper.turning_0, damper.pulls, damper.held + moved.held,
    )  # fmt: skip


@part
def moved_back(contact: Contact, damper: Damper, moved: Moved) -> Contact:
    """The same contact with the move of its damper taken back, as the derivatives of its forces have it."""
    force, nodal = contact.force.copy(), contact.nodal.copy()
    eta = damper.relaxation * moved.elastic / contact.res.elastic
    by_eta, by_held = contact.by_eta, contact.by_held
    for i in range(force.shape[0]):
        force[i] += eta * by_eta[i] - moved.held * by_held[i]
    for i in range(nodal.shape[0]):
        for a in range(2):
            k = FRAME + 2 * i + a
            nodal[i, a] += eta * by_eta[k] - moved.held * by_held[k]
    return Contact(
        force, nodal, contact.tangent, contact.res, contact.bristles, contact.outside, by_eta, by_held,
        contact.way_by,
    )  # fmt: skip


@loop
def foresee(damper: Damper, moved: Moved, contact: Any, update: Any, update_u: Any) -> Foreseen:
    """What the patch will carry after a step of Newton, which takes the damper's move back as well."""
    res, tangent = contact.res, contact.tangent
    normal, friction = -damper.relaxation * moved.elastic, moved.held
    for i in range(FRAME + update_u.shape[0]):
        change = update[i] if i < FRAME else update_u[i - FRAME]
        normal += tangent[1, i] * change
        friction += tangent[0, i] * change
    return Foreseen(res.normal - normal, res.friction - friction) if res.elastic > 0 else Foreseen(0.0, 0.0)


@loop
def between(start: Foreseen, end: Foreseen, share: float) -> Foreseen:
    """What it will carry after a share of the step from one to the other."""
    return Foreseen(
        start.normal + share * (end.normal - start.normal), start.friction + share * (end.friction - start.friction)
    )
