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

from math import cos, pi, sin
from typing import Any

import numpy as np

from rigid.kernel.compile import jit, part

from .assembly import X, Y, add_outer, add_spread, directions, gathered, slip_by_gaps, spread, tangents
from .laws.listing import tractions
from .points.bristles import carry
from .points.data import Before, Bristles, Contact, Damper, Load, Parameters, Resultants, Rim, Slip
from .points.detection import gather
from .points.normal import force_by_gaps, press
from .points.rim import gap_at, lift, sideways, upward, vertex_angle
from .vectors import add, dot, plus, times


@part
def _load(foundation: Any, damper: Damper) -> Load:
    """The normal force as a whole, and what the damper makes of it."""
    elastic = foundation.force.sum()
    eta, eta_rate = damper.eta_0, 0.0
    if elastic > 0 and damper.relaxation > 0:
        eta += damper.relaxation * (1 - damper.elastic_0 / elastic)
        eta_rate = damper.relaxation * damper.elastic_0 / elastic**2
        if eta < 0 and not damper.pulls:
            eta, eta_rate = 0.0, 0.0
    return Load(elastic, eta, eta_rate)


@part
def _way_over_the_floor(pose: Any, u: Any, rim: Rim, before: Before) -> float:
    """Way in the step of the rim's node that comes nearest to the floor, where none touches: with it a patch begins."""
    old, u_old = before.pose, before.u
    s, c, s_old, c_old = sin(pose[2]), cos(pose[2]), sin(old[2]), cos(old[2])
    least, way = np.inf, pose[0] - old[0]
    for i in range(u.shape[0]):
        psi = pose[2] - pi + vertex_angle(rim.vertex, rim.first + i // 2)
        if i % 2 == 1:
            psi = (psi + pose[2] - pi + vertex_angle(rim.vertex, rim.first + i // 2 + 1)) / 2
        gap = gap_at(pose[1], psi, upward(u[i, 0], u[i, 1], s, c))
        if gap < least:
            least = gap
            moved = sideways(u[i, 0], u[i, 1], s, c) - sideways(u_old[i, 0], u_old[i, 1], s_old, c_old)
            way = pose[0] - old[0] + moved + (pose[2] - old[2]) * lift(psi)
    return way


@part
def _nothing(nodes: int, outside: bool, way: float) -> Contact:
    """Off the floor."""
    size = 3 + 2 * nodes
    zero = Resultants(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, way, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, np.inf, 0.0)
    none = Bristles(np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty(0, np.int8))
    return Contact(np.zeros(3), np.zeros((nodes, 2)), np.zeros((size, size)), zero, none, outside)


@part
def _add_shared(points: Any, foundation: Any, forces: Any, shared: Any, elastic: float) -> None:
    """Share a force of the whole patch over its points like the pressure."""
    for i in range(points.gap.shape[0]):
        forces.force[i] += shared.force * (foundation.force[i] / elastic)
    force_by_gaps(forces.by_gap, shared.force / elastic, foundation)


@part
def _add_turning(tangent: Any, force: Any, points: Any, pressed: Any, pulled: Any) -> None:
    """The directions themselves turn with phi: add that to the tangent, for vertical and horizontal point forces."""
    turning = 0.0
    for i in range(points.gap.shape[0]):
        # cos(psi) - u_Y and sin(psi) - u_X
        turning += pressed[i] * (1 - points.arm_y[i]) + pulled[i] * points.arm_x[i]
    tangent[2, 2] += turning
    for row in range(3, force.shape[0], 2):
        tangent[2, row] += force[row + 1]
        tangent[row, 2] += force[row + 1]
        tangent[2, row + 1] -= force[row]
        tangent[row + 1, 2] -= force[row]


@part
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


@part
def _stored(points: Any, carried: Any, pull: Any, keeps: Any) -> Bristles:
    """What of the points outlasts the step."""
    size = keeps.sum()
    number, sliding = np.empty(size, np.int64), np.empty(size, np.int8)
    stretch, held = np.empty(size), np.empty(size)
    n = 0
    for i in range(keeps.shape[0]):
        if keeps[i]:
            number[n], stretch[n], held[n] = points.number[i], carried.stretch[i], pull[i]
            sliding[n] = carried.sliding[i]
            n += 1
    return Bristles(number, stretch, held, sliding)


@part
def _work_of_those_that_left(
    points: Any, before: Before, slip: Slip, moved: float, dphi: float, law: Parameters, stuck: float
) -> float:
    """Work of the bristles now farther off the patch than its neighbours, beyond their force times the mean way.

    They left one after the other, as evenly as the patch's edge went over them: those that stuck with what they pulled
    then, those that slid with nothing.
    """
    bristles = before.bristles
    number, last = bristles.number, bristles.number.shape[0] - 1
    low, high = points.number[0], points.number[-1]
    work = 0.0
    for i in range(number.shape[0]):
        j = number[i]
        if j > high:
            share = (number[last] + 0.5 - j) / (number[last] - high)
        elif j < low:
            share = (j - number[0] + 0.5) / (low - number[0])
        else:
            continue
        psi = before.pose[2] - pi + j * law.spacing
        rolled = share * dphi * lift(psi + share * dphi / 2)
        pull = bristles.pull[i] / 2
        if stuck > 0 and bristles.sliding[i] == 0 and bristles.stretch[i] != 0:
            pull = bristles.pull[i] - law.eps_t * law.spacing * (rolled + share * moved) / 2
        work += pull * (rolled - share * (slip.way - moved))
    return work


@jit
def contact_forces(
    pose: Any, u: Any, rim: Rim, law: Parameters, mode: int, before: Before, damper: Damper
) -> Contact:  # fmt: skip
    """Forces of the floor on the rim, their tangent, and the state of the bristles.

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
    phi = pose[2]
    size = 3 + 2 * nodes
    points, outside = gather(pose, u, rim, law.spacing, before)
    if points.gap.shape[0] == 0:
        return _nothing(nodes, outside, _way_over_the_floor(pose, u, rim, before))

    foundation = press(points.gap, points.last, law.eps_n, law.spacing)
    load = _load(foundation, damper)
    elastic, eta = load.elastic, load.eta
    dphi = phi - before.pose[2]
    moved = 0.0
    if elastic == 0:
        way = _way_over_the_floor(pose, u, rim, before)
    else:
        moved = dot(foundation.force, points.move) / elastic
        way = moved + dphi * dot(foundation.force, points.lifted) / elastic
    slip = Slip(way, damper.way_0, damper.velocity_0 + damper.rate * (way - damper.way_0), damper.rate, damper.drag)
    carried = carry(points, before.bristles, dphi, damper, slip, moved)
    answer = tractions(points, foundation, carried, mode, load, slip, law)
    forces, shared = answer.points, answer.shared
    pull = forces.force.copy()
    if shared.acts:
        _add_shared(points, foundation, forces, shared, elastic)

    along, up = directions(points)
    s, c = sin(phi), cos(phi)
    pushes = spread(gathered(points, foundation.force, up, nodes), Y, s, c)
    force = spread(gathered(points, forces.force, along, nodes), X, s, c)
    add(force, eta, pushes)
    k_yy, k_xy, k_xx = tangents(points, foundation, forces, along, up, nodes)
    tangent = np.zeros((size, size))
    add_spread(tangent, k_yy, Y, Y, s, c, eta)
    add_spread(tangent, k_xy, X, Y, s, c, 1.0)
    add_spread(tangent, k_xx, X, X, s, c, 1.0)
    elastic_by = spread(k_yy[0], Y, s, c)
    # eta and what is shared change with all unknowns at once
    if load.eta_rate != 0:
        add_outer(tangent, load.eta_rate, pushes, elastic_by)
        add_outer(tangent, load.eta_rate, spread(gathered(points, forces.share, along, nodes), X, s, c), elastic_by)
    if shared.acts:
        spreading = spread(gathered(points, times(1 / elastic, foundation.force), along, nodes), X, s, c)
        slip_by = spreading.copy()
        slip_by[2] += dphi * dot(foundation.force, points.sine) / elastic
        ways = plus(points.move, dphi, points.lifted)
        add(slip_by, 1.0, spread(slip_by_gaps(points, ways, foundation, way, elastic, up, nodes), Y, s, c))
        add_outer(tangent, shared.by_way, spreading, slip_by)
        add_outer(tangent, shared.by_elastic - shared.force / elastic, spreading, elastic_by)
    _add_turning(tangent, force, points, times(eta, foundation.force), forces.force)

    low, high = _ends(points)
    stuck = answer.stuck / foundation.length if foundation.length > 0 else 0.0
    beyond = _work_of_those_that_left(points, before, slip, moved, dphi, law, answer.stuck)
    for i in range(pull.shape[0]):
        beyond += (carried.pull[i] + pull[i]) * (carried.way[i] - carried.mean[i]) / 2
    res = Resultants(
        force[1], force[0], foundation.energy, answer.energy, foundation.length, stuck, way, low, high, elastic, eta,
        shared.damping, beyond, -shared.by_way, shared.reach, answer.feet,
    )  # fmt: skip
    bristles = _stored(points, carried, pull, answer.keeps)
    nodal = np.empty((nodes, 2))
    for i in range(nodes):
        nodal[i, 0], nodal[i, 1] = force[3 + 2 * i], force[4 + 2 * i]
    return Contact(force[:3].copy(), nodal, tangent, res, bristles, outside)
