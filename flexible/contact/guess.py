"""Where Newton on a stage begins: the rim near the floor is moved to where the contact's forces say something.

Newton's matrix knows where the rim is by its forces alone; see :func:`guess_again`.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from rigid.kernel.compile import loop, part

from .forces import contact_forces
from .foreseen import Foreseen, Moved, moved_by, moved_damper
from .laws.listing import is_smoothed
from .points.data import Before, Bristles, Contact, Damper, Parameters, Resultants, Rim
from .points.detection import least_gap
from .points.rim import element_at, shape_functions, upward, vertex_angle

MOST_CHANGE = 10.0  # of N_el from a stage to the next by which a patch is foreseen from the one before
GUESSES = 4  # three that raise the patch, and one along the floor
ASTRAY = 0.03  # of what smoothed friction reaches, its way from where Newton foresaw it
SEARCHES = 8  # along the floor for where a brush sticks, each as far as its bristles reach to both sides


@loop
def _too_low(pose: Any, u: Any, rim: Rim, law: Parameters, before: Before, damper: Damper, res: Resultants) -> float:
    """How much farther down the rim is than where its patch is about as deep as before the step; 0 where it is well.

    A patch of the depth delta and the length L has N_el = (2/3) eps_n L delta, whatever the rim's curvature, and N_el
    grows like delta^(3/2).
    """
    if res.elastic == 0:
        least = least_gap(before.pose[1], before.pose[2], before.u, rim)
        return least - least_gap(pose[1], pose[2], u, rim) if least < 0 else 0.0
    if damper.relaxation == 0 or damper.elastic_0 <= 0 or abs(res.eta - 1) < 0.1:
        return 0.0
    return 1.5 * res.elastic / (law.eps_n * res.length) * (1 - (damper.elastic_0 / res.elastic) ** (2 / 3))


@loop
def _sticking(bristles: Bristles) -> int:
    """How many points stick."""
    number = 0
    for i in range(bristles.sliding.shape[0]):
        number += abs(bristles.sliding[i]) != 1
    return number


@loop
def shift(u: Any, phi: float, along: float, up: float) -> None:
    """Move all nodes, in the world's axes."""
    s, c = sin(phi), cos(phi)
    for i in range(u.shape[0]):
        u[i, 0] += along * s + up * c
        u[i, 1] += along * c - up * s


@loop
def as_before(pose: Any, u: Any, rim: Rim, before: Before) -> None:
    """Move each node up or down to where the rim over the same place of the floor was when the step began.

    A soft ring on a stiff foundation lies flat, to a billionth of R, and its patch does not turn with it as it rolls.
    """
    first, vertex, count = rim.first, rim.vertex, (u.shape[0] - 1) // 2
    phi, phi_old = pose[2], before.pose[2]
    s, c, s_old, c_old = sin(phi), cos(phi), sin(phi_old), cos(phi_old)
    start, end = vertex_angle(vertex, first), vertex_angle(vertex, first + count)
    for i in range(u.shape[0]):
        theta = vertex_angle(vertex, first + i // 2)
        if i % 2 == 1:
            theta = (theta + vertex_angle(vertex, first + i // 2 + 1)) / 2
        there = min(max(theta + phi - phi_old, start), end)  # the material that was over that place
        element = min(max(element_at(vertex, there), first), first + count - 1)
        begin = vertex_angle(vertex, element)
        n0, n1, n2 = shape_functions((there - begin) / (vertex_angle(vertex, element + 1) - begin))
        k = 2 * (element - first)
        v1 = n0 * before.u[k, 0] + n1 * before.u[k + 1, 0] + n2 * before.u[k + 2, 0]
        v2 = n0 * before.u[k, 1] + n1 * before.u[k + 1, 1] + n2 * before.u[k + 2, 1]
        up = before.pose[1] - pose[1] + upward(v1, v2, s_old, c_old) - upward(u[i, 0], u[i, 1], s, c)
        u[i, 0] += up * c
        u[i, 1] -= up * s


@loop
def as_deep(height: float, phi: float, u: Any, rim: Rim, start: Any) -> bool:
    """Move the rim up or down so that its patch is as deep as an expected N_el wants, which grows like depth^(3/2).

    ``start`` (:class:`flexible.models.stage.From`) says how deep a patch with another N_el was. Not done, and said so,
    where there was none, or it changes too much.
    """
    deepest, elastic, expected = start.deepest, start.elastic, start.expected
    if elastic <= 0 or deepest >= 0 or not elastic / MOST_CHANGE < expected < elastic * MOST_CHANGE:
        return False
    shift(u, phi, 0.0, deepest * (expected / elastic) ** (2 / 3) - least_gap(height, phi, u, rim))
    return True


@loop
def guess_again(
    pose: Any, u: Any, rim: Rim, law: Parameters, before: Before, damper: Damper, contact: Contact, guesses: int
) -> int:
    """Move the rim ``u`` to where its patch is about as it was; how many guesses are left, -1 if ``contact`` is well.

    A soft ring follows the floor. With a frame that has moved and a rim that has not, the patch is off the floor, and
    the next guess, without its forces, far below it; or so deep that the damper, which multiplies by the stage's rate,
    makes N hundreds of times what it will be. From either Newton takes tens of iterations to come back.

    Along the floor it is the same: bristles break within some 1e-7 R, and where all points slide by the guess, friction
    says nothing of where they would stick, so that Newton goes to and fro between -mu N and mu N without end. A patch
    of which some points stuck is tried where it goes on without a slip.
    """
    if guesses > 1:
        raised = _too_low(pose, u, rim, law, before, damper, contact.res)
        if raised != 0:
            shift(u, pose[2], 0.0, raised)
            return guesses - 1
    slides = contact.res.elastic > 0 and _sticking(contact.bristles) == 0
    if slides and _sticking(before.bristles) > 0:
        shift(u, pose[2], damper.way_0 - contact.res.way, 0.0)
        return 0
    return -1


@loop
def slipping_on(law: Parameters, before: Before, damper: Damper, res: Resultants) -> float:
    """How far along the floor a rim of smoothed friction is from where its patch slips as in the stages before.

    Where it creeps on a ring without inertia the guess slides hundreds of v_s fast, and there friction no longer
    answers to the velocity. 0 where that is not known.
    """
    if not is_smoothed(law) or before.bristles.number.shape[0] == 0 or damper.ratio <= 1:
        return 0.0
    return damper.way_0 * damper.ratio / (damper.ratio - 1) - res.way


@loop
def is_let_go(res: Resultants) -> bool:
    """Whether the damper has let go of a patch whose springs are still pressed, so that the rim is free.

    It stays let go of until its springs come up. A damper that pulls would have Newton begin with thousands of N on it.
    """
    return bool(res.elastic > 0 and res.normal == 0)


@loop
def too_deep(law: Parameters, expected: float, res: Resultants) -> float:
    """How much farther down a patch is than where it carries what is ``expected`` of N_el.

    In a short step the damper makes N of the difference of two N_el: by a depth that is foreseen to a thousandth it may
    pull, and without friction a ring that has no inertia is held along the floor by next to nothing.
    """
    return (res.elastic - expected) / (law.eps_n * res.length) if res.elastic > 0 else 0.0


@loop
def off_its_way(res: Resultants, way: float) -> float:
    """How far along the floor a rim of smoothed friction is from the ``way`` that Newton's step foresaw.

    The mean way of a patch is a product of pressures and moves, and on a floor stiffer than the wall what a step makes
    of it beyond the first order is many times as long as friction is straight. 0 where no way is known, nan, or it is
    near.
    """
    return way - res.way if abs(res.way - way) > ASTRAY * res.reach else 0.0


@part
def on_its_way(pose: Any, u: Any, of: Any, contact: Contact, way: float, asked: bool) -> Contact:
    """Move the rim along the floor by what it is :func:`off_its_way`; for the arguments see :func:`held_again`."""
    by = off_its_way(contact.res, way)
    if by == 0:
        return contact
    rim, law, mode, before, damper = of
    shift(u, pose[2], by, 0.0)
    return contact_forces(pose, u, rim, law, mode, before, damper, asked)


@part
def held_again(pose: Any, u: Any, of: Any, contact: Contact, foreseen: Foreseen, asked: bool) -> Contact:
    """Move the rim along the floor to where half as many points stick as when the step began; the contact there.

    Bristles are looked at under the pressure that the patch is foreseen to carry. In a short step the damper makes most
    of it, and by the guess it is another one: held by a tenth of it, a patch that sticks would be taken for one that
    slides, and be shifted by what that tenth holds.

    Of a patch that slid on by the guess, it is known what it is expected to pull. That falls with the way: from where
    the patch goes on without a slip the rim is moved by what the bristles reach, and by half of what lies between one
    that pulls more and one that pulls less. From there Newton knows what each point does.

    Parameters
    ----------
    pose, u :
        See :func:`flexible.contact.forces.contact_forces`.
    of : tuple
        Rim, law, mode, contact before the step, and damper.
    contact : Contact
        Of the rim as it is.
    foreseen : Foreseen
    asked : bool
        For a tangent.
    """
    rim, law, mode, before, damper = of
    stuck = _sticking(before.bristles)
    if contact.res.elastic == 0 or 2 * _sticking(contact.bristles) >= stuck:
        return contact
    pressed = Moved(moved_by(damper, foreseen, contact.res).elastic, 0.0)
    carrying, carries = moved_damper(damper, pressed), contact
    if pressed.elastic != 0:
        carries = contact_forces(pose, u, rim, law, mode, before, carrying, asked)
    at, low, high = 0.0, -np.inf, np.inf
    for search in range(SEARCHES):
        res = carries.res
        if res.elastic == 0 or 2 * _sticking(carries.bristles) >= stuck:
            break
        step = 2 * law.mu_s * res.normal / (law.eps_t * res.length)
        if res.friction > foreseen.friction:
            low = at
        else:
            high, step = at, -step
        there = damper.way_0 - res.way if search == 0 else at + step
        if not low < there < high:
            there = (low + high) / 2 if np.isfinite(low + high) else at + step
        shift(u, pose[2], there - at, 0.0)
        at = there
        carries = contact_forces(pose, u, rim, law, mode, before, carrying, asked)
    if pressed.elastic == 0:
        return carries
    return contact if at == 0 else contact_forces(pose, u, rim, law, mode, before, damper, asked)
