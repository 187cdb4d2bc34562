"""Compliant frictional contact of the rim with the floor: forces, their exact tangent, the state of the patch.

With ``psi = phi + theta - pi`` a material point's angle from the bottom, ``h`` the height of the hoop's centre above R,
and (u_X, u_Y) the point's displacement in the world's axes,

    gap            g = h + 2 sin^2(psi/2) + u_Y
    floor abscissa x = V + phi - sin(psi) + u_X,       V = x_C - phi,

neither of which subtracts numbers of order one (R = m = g = 1 throughout). Normal forces are those of
:mod:`flexible.contact.points.normal`, tangential ones those of a law in :mod:`flexible.contact.laws`, in the mode that
the caller asks for.

Damping, if any, is that of the patch as a whole, N = N_el + theta dN_el/dt, and while a patch sticks
F = F_el - theta k_t v with v the mean slip of the patch: it damps the approach and the slip, and not a material point's
own gap rate, which under rolling would be a rolling resistance. The slip of a point is all of its motion along the
floor, rolling included: at the rim of a wide patch that alone is phidot psi^2/2.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from rigid.kernel.compile import apart, loop

from .assembly import X, Y, add_outer, add_spread, direct, gather, share_out, spread, tangents
from .laws.listing import tractions
from .points.bristles import carry
from .points.data import (
    NOTHING,
    UNDAMPED,
    Before,
    Bristles,
    Contact,
    Damper,
    Load,
    Parameters,
    Resultants,
    Rim,
    Slip,
)
from .points.detection import find, place
from .points.leaving import all_stick, those_that_bear, work_of_those_let_go, work_of_those_that_left
from .points.normal import force_by_gaps, press
from .room import (
    ENTERED,
    PULL,
    SCRATCH,
    SHARING,
    SPREADING,
    WAY,
    Room,
    carried_in,
    forces_in,
    foundation_in,
    keep,
    points_in,
    room_for,
)
from .vectors import add, dot, largest, total
from .way import differentiate_way, way_over_the_floor, weigh_slip


@loop
def _load(foundation: Any, damper: Damper) -> Load:
    """The normal force as a whole, and what the damper makes of it."""
    elastic = total(foundation.force)
    eta, eta_rate = damper.eta_0, 0.0
    if elastic > 0 and damper.relaxation > 0:
        eta += damper.relaxation * (1 - damper.elastic_0 / elastic)
        eta_rate = damper.relaxation * damper.elastic_0 / elastic**2
        if eta < 0 and not damper.pulls:
            eta, eta_rate = 0.0, 0.0
    return Load(elastic, eta, eta_rate)


@loop
def _add_shared(points: Any, foundation: Any, forces: Any, shared: Any, elastic: float) -> None:
    """Share a force of the whole patch over its points like the pressure."""
    for i in range(points.gap.shape[0]):
        forces.force[i] += shared.force * (foundation.force[i] / elastic)
    force_by_gaps(forces.by_gap, shared.force / elastic, foundation)


@loop
def _add_turning(tangent: Any, force: Any, points: Any, eta: float, pressed: Any, pulled: Any) -> None:
    """The directions themselves turn with phi: add that to the tangent, for vertical and horizontal point forces."""
    turning = 0.0
    for i in range(points.gap.shape[0]):
        # cos(psi) - u_Y and sin(psi) - u_X
        turning += eta * pressed[i] * (1 - points.arm_y[i]) + pulled[i] * points.arm_x[i]
    tangent[2, 2] += turning
    for row in range(3, force.shape[0], 2):
        tangent[2, row] += force[row + 1]
        tangent[row, 2] += force[row + 1]
        tangent[2, row + 1] -= force[row]
        tangent[row + 1, 2] -= force[row]


@loop
def _ends(points: Any) -> tuple[float, float]:
    """Angles psi of the first and the last point that touch, 0 if none does."""
    low, high, active = 0.0, 0.0, 0
    for i in range(points.gap.shape[0]):
        if points.gap[i] < 0:
            if active == 0:
                low = points.psi[i]
            high = points.psi[i]
            active += 1
    return low, high


@loop
def _differentiate(room: Room, shared: Any, load: Load, s: float, c: float, dphi: float, halves: float) -> None:
    """Fill in the tangent of forces that are known."""
    points, foundation, forces, tangent = points_in(room), foundation_in(room, 0.0, 0.0), forces_in(room), room.tangent
    along, up, bases, unknowns, by_bases = room.fives[0], room.fives[1], room.bases, room.unknowns, room.by_bases
    pushes, force, elastic_by, sharing, spreading, slip_by = (
        unknowns[0], unknowns[1], unknowns[2], unknowns[SHARING], unknowns[SPREADING], unknowns[WAY],
    )  # fmt: skip
    tangents(points, foundation, forces, along, up, by_bases, room.block)
    add_spread(tangent, by_bases[0], Y, Y, s, c, load.eta)
    add_spread(tangent, by_bases[1], X, Y, s, c, 1.0)
    add_spread(tangent, by_bases[2], X, X, s, c, 1.0)
    spread(by_bases[0, 0], Y, s, c, elastic_by)
    # eta and what is shared change with all unknowns at once
    if load.eta_rate != 0:
        gather(points, forces.share, 1.0, along, bases[2])
        spread(bases[2], X, s, c, sharing)
        add_outer(tangent, load.eta_rate, pushes, elastic_by)
        add_outer(tangent, load.eta_rate, sharing, elastic_by)
        add(sharing, 1.0, pushes)  # all that goes like eta
    entered = load.elastic > 0 and largest(forces.by_way) > 0
    if shared.acts or entered:
        differentiate_way(room, load.elastic, s, c, dphi, halves)
    if entered:
        gather(points, forces.by_way, 1.0, along, bases[6])
        spread(bases[6], X, s, c, unknowns[ENTERED])
        add_outer(tangent, 1.0, unknowns[ENTERED], slip_by)
    if shared.acts:
        gather(points, foundation.force, 1 / load.elastic, along, bases[3])
        spread(bases[3], X, s, c, spreading)
        add_outer(tangent, shared.by_way, spreading, slip_by)
        add_outer(tangent, shared.by_elastic - shared.force / load.elastic, spreading, elastic_by)
    _add_turning(tangent, force, points, load.eta, foundation.force, forces.force)


@loop
def _touch(
    pose: Any, u: Any, rim: Rim, law: Parameters, mode: int, before: Before, damper: Damper, room: Room
) -> tuple[Resultants, bool, int]:  # fmt: skip
    """Forces of points that touch, into the room; the patch as a whole, :class:`Contact.outside`, bristles kept."""
    phi = pose[2]
    points, forces, carried = points_in(room), forces_in(room), carried_in(room)
    outside = place(points, room.ranges, room.ranged, pose, u, rim, law.spacing, before)
    energy, length = press(points.gap, points.last, law.eps_n, law.spacing, foundation_in(room, 0.0, 0.0))
    foundation = foundation_in(room, energy, length)
    load = _load(foundation, damper)
    elastic, eta = load.elastic, load.eta
    dphi, moved = phi - before.pose[2], 0.0
    if elastic == 0:
        way = way_over_the_floor(pose, u, rim, before)
    else:
        weigh_slip(room, law, elastic, before.halves)
        weights = room.rows[SCRATCH]
        moved = dot(weights, points.shift)
        way = moved + dphi * dot(weights, points.lifted) + dot(weights, points.carried)
    velocity = damper.velocity_0 + damper.rate * (way - damper.way_0)
    slip = Slip(way, damper.way_0, velocity, damper.rate, damper.drag, damper.held)
    carry(carried, points, before, rim, dphi, damper, slip, moved)
    answer = tractions(forces, points, foundation, carried, mode, load, slip, law)
    shared, pull = answer.shared, room.rows[PULL]
    for i in range(pull.shape[0]):
        pull[i] = forces.force[i]
    if shared.acts:
        _add_shared(points, foundation, forces, shared, elastic)

    direct(points, room.fives[0], room.fives[1])
    s, c = sin(phi), cos(phi)
    pushes, force = room.unknowns[0], room.unknowns[1]
    gather(points, foundation.force, 1.0, room.fives[1], room.bases[0])
    spread(room.bases[0], Y, s, c, pushes)
    gather(points, forces.force, 1.0, room.fives[0], room.bases[1])
    spread(room.bases[1], X, s, c, force)
    add(force, eta, pushes)
    if room.tangent.shape[0] > 0:
        _differentiate(room, shared, load, s, c, dphi, before.halves)

    low, high = _ends(points)
    stuck = min(answer.stuck / length, 1.0) if length > 0 else 0.0  # of weights that miss the length by 1e-4
    beyond, kept, first, last = 0.0, 0, 0, pull.shape[0] - 1
    if not answer.like_pressure:
        if all_stick(forces.weight, carried.sliding):
            first, last = those_that_bear(forces.weight)
            spring = law.eps_t * law.spacing
            beyond = work_of_those_let_go(
                points, (first, last), pull, carried, before.bristles, slip, damper.ratio, spring
            )
        else:
            beyond = work_of_those_that_left(points, before, rim, slip, moved, dphi, law, answer.stuck)
    for i in range(pull.shape[0]):
        if not answer.like_pressure and first <= i <= last:
            beyond += (carried.pull[i] + pull[i]) * (carried.way[i] - carried.mean[i]) / 2
        kept += 1 if forces.keeps[i] != 0 else 0
    res = Resultants(
        force[1], force[0], energy, answer.energy, length, stuck, way, low, high, elastic, eta, shared.damping, beyond,
        -shared.by_way, shared.reach, answer.feet,
    )  # fmt: skip
    return res, outside, kept


def example() -> tuple[tuple[Any, ...], Contact]:
    """Arguments and a result, of the types that compiled code has."""
    count, number, row, table = np.empty(0, np.int64), 0, np.empty(0), np.empty((0, 2))
    bristles = Bristles(count, row, row, np.empty(0, np.int8))
    law = Parameters(number, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    contact = Contact(row, table, table, NOTHING, bristles, False, row, row, row)
    before = Before(row, table, bristles, number, table, 0.0)
    return (row, table, Rim(number, row), law, number, before, UNDAMPED, False), contact


@apart(example, needs=(tractions,))
def contact_forces(
    pose: Any, u: Any, rim: Rim, law: Parameters, mode: int, before: Before, damper: Damper, differentiates: bool
) -> Contact:  # fmt: skip
    """Forces of the floor on the rim, their tangent if it ``differentiates``, and the state of the bristles.

    Parameters
    ----------
    pose : (3,) array
        (V, h, phi) now.
    u : (2 count + 1, 2) array
        Displacement (y1, y2) of the nodes of ``count`` rim elements from element ``rim.first`` on.
    rim : Rim
    law : Parameters
    mode : int
        Of the law.
    before : Before
        The contact at the beginning of the step.
    damper : Damper
    """
    nodes = u.shape[0]
    ranges = np.empty(((nodes - 1) // 2, 2), np.int64)
    ranged, count = find(pose, u, rim, law.spacing, ranges)
    room = room_for(count, nodes, ranges, ranged, differentiates)
    frame, nodal = np.empty(3), np.empty((nodes, 2))
    if count > 0:
        res, outside, kept = _touch(pose, u, rim, law, mode, before, damper, room)
    else:
        way = way_over_the_floor(pose, u, rim, before)
        res = Resultants(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, way, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, np.inf, 0.0)
        outside, kept = False, 0
    bristles = Bristles(np.empty(kept, np.int64), np.empty(kept), np.empty(kept), np.empty(kept, np.int8))
    keep(room, bristles)
    share_out(room.unknowns[1], frame, nodal)
    unknowns = room.unknowns
    return Contact(
        frame, nodal, room.tangent, res, bristles, outside, unknowns[SHARING], unknowns[SPREADING], unknowns[WAY]
    )  # fmt: skip
