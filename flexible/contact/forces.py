"""Compliant frictional contact of the rim with the floor: forces, their exact tangent, the state of the patch.

With ``psi = phi + theta - pi`` a material point's angle from the bottom, ``h`` the height of the hoop's centre above R,
and (u_X, u_Y) the point's displacement in the world's axes,

    gap            g = h + 2 sin^2(psi/2) + u_Y
    floor abscissa x = V + phi - sin(psi) + u_X,       V = x_C - phi,

neither of which subtracts numbers of order one (R = m = g = 1 throughout). Normal forces are those of
:mod:`flexible.contact.normal`, tangential ones those of :mod:`flexible.contact.friction`; for the patch law, whether
the patch sticks or slides is decided on the resultants, by the caller.

Damping, if any, is that of the patch as a whole, N = N_el + theta dN_el/dt, and while it sticks
F = F_el - theta k_t v with v the mean slip of the patch: it damps the approach and the slip, and not a material point's
own gap rate, which under rolling would be a rolling resistance. The slip of a point is all of its motion along the
floor, rolling included: at the rim of a wide patch that alone is phidot psi^2/2.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from rigid.kernel.compile import jit

from .assembly import X, Y, add_outer, add_spread, directions, gathered, slip_by_gaps, spread, tangents
from .detection import element_at, gather, vertex_angle
from .friction import BRUSH, SLIDE_LEFT, SLIDE_RIGHT, STICK, carry, rub
from .normal import force_by_gaps, press

# positions in the array of contact parameters
SPACING, EPS_N, EPS_T, MU_S, MU = range(5)
# positions in the array of resultants: forces, energies, length of the patch and how much of it sticks, mean way along
# the floor in the step, angles psi of its ends, whether it left the window, elastic normal force, damping factor,
# damping drag, the work of the bristles beyond their mean force times the mean way, and how far the feet of the
# bristles of a sliding patch slid in the step
NORMAL, FRICTION, NORMAL_ENERGY, BRISTLE_ENERGY, LENGTH, STUCK, SLIP, LOW, HIGH, OUTSIDE, ELASTIC, ETA, DRAG = range(13)
BEYOND, FEET = 13, 14
RESULTANTS = 15

UNDAMPED = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 1.0])


@jit
def contact_forces(
    pose: Any,
    u: Any,
    first: int,
    vertex: Any,
    law: Any,
    mode: int,
    old_pose: Any,
    u_old: Any,
    bristles: Any,
    flags: Any,
    damper: Any,
) -> Any:
    """Forces of the floor on the rim, their tangent, and the state of the bristles.

    Parameters
    ----------
    pose, old_pose : (3,) arrays
        (V, h, phi) now and at the beginning of the step.
    u, u_old : (2 count + 1, 2) arrays
        Displacement (y1, y2) of the nodes of ``count`` rim elements from element ``first`` on, now and then.
    vertex : (n_elements,) array
        Angles at which the rim's elements begin.
    law : (5,) array
        Spacing, eps_n, eps_t, mu_s, mu.
    mode : int
        STICK, SLIDE_RIGHT or SLIDE_LEFT for the patch law, BRUSH for the brush.
    bristles, flags : (m, 3), (m,) arrays
        Number, stretch and force of each point in contact at the beginning of the step, ascending; sliding or not.
    damper : (6,) array
        (rho, N_0, eta_0, c, x_0, r): pressures are eta times the elastic ones, eta = eta_0 + rho (N_el - N_0)/N_el, at
        least 0; a sticking patch drags with -c (x - x_0), shared like the pressure, x its mean way in the step.
        rho is the damper's relaxation time over the step's beta; N_0, x_0 are what N_el, x were without a rate.
        The slip velocity at the end of the stage is r (x - x_0) over the stage's length.

    Returns
    -------
    force : (3,) array
        Generalised forces on (V, h, phi).
    nodal : (2 count + 1, 2) array
        Forces on the nodes in the disk's axes.
    tangent : (n, n) array
        Derivative of (force, nodal) by (pose, u), n = 3 + 2 (2 count + 1).
    resultants : (RESULTANTS,) array
    new_bristles, new_flags : as ``bristles``, ``flags``
        Points in contact now.
    """
    spacing, eps_n, eps_t = law[SPACING], law[EPS_N], law[EPS_T]
    nodes = u.shape[0]
    phi = pose[2]
    size = 3 + 2 * nodes
    res = np.zeros(RESULTANTS)
    points, outside = gather(pose, u, first, vertex, spacing, old_pose, u_old)
    res[OUTSIDE] = 1.0 if outside else 0.0
    total = points.gap.shape[0]
    if total == 0:
        nothing = np.zeros((size, size))
        return np.zeros(3), np.zeros((nodes, 2)), nothing, res, np.empty((0, 3)), np.empty(0, np.int8)

    foundation = press(points.gap, points.last, eps_n, spacing)
    elastic = foundation.force.sum()
    eta, eta_rate = damper[2], 0.0
    if elastic > 0 and damper[0] > 0:
        eta += damper[0] * (1 - damper[1] / elastic)
        eta_rate = damper[0] * damper[1] / elastic**2
        if eta < 0:
            eta, eta_rate = 0.0, 0.0
    dphi = phi - old_pose[2]
    lift = 2 * np.sin(points.psi / 2) ** 2
    moved, slip = 0.0, 0.0
    if elastic > 0:
        moved = (foundation.force * points.move).sum() / elastic
        slip = moved + dphi * (foundation.force * lift).sum() / elastic
    start = damper[4] - (slip - moved) * (1 - 1 / damper[5])
    carried = carry(points, bristles, flags, dphi, damper[5], start, slip, damper[4], mode == BRUSH)
    tractions = rub(points, foundation, carried, mode, eta, spacing, eps_n, eps_t, law[MU_S], law[MU])

    along, up = directions(points)
    s, c = sin(phi), cos(phi)
    held = tractions.force.copy()
    dragging = mode == STICK and elastic > 0 and damper[3] > 0
    drag = 0.0
    if dragging:  # shared over the patch like the pressure
        drag = -damper[3] * (slip - damper[4])
        for i in range(total):
            before = i - 1 if i > 0 and not points.last[i - 1] else -1
            behind = i + 1 if i + 1 < total and not points.last[i] else -1
            tractions.share[i] = foundation.force[i] / elastic
            tractions.force[i] += drag * tractions.share[i]
            force_by_gaps(tractions.by_gap[i, 1:4], drag / elastic, foundation, before, i, behind)

    pushes = spread(gathered(points, foundation.force, up, nodes), Y, s, c)
    forces = spread(gathered(points, tractions.force, along, nodes), X, s, c) + eta * pushes
    k_yy, k_xy, k_xx = tangents(points, foundation, tractions, along, up, nodes)
    tangent = np.zeros((size, size))
    add_spread(tangent, k_yy, Y, Y, s, c, eta)
    add_spread(tangent, k_xy, X, Y, s, c, 1.0)
    add_spread(tangent, k_xx, X, X, s, c, 1.0)
    if eta_rate != 0 or dragging:  # eta and the drag change with all unknowns at once
        elastic_by = spread(k_yy[0], Y, s, c)
        share_by = eta_rate * elastic_by
        add_outer(tangent, pushes, share_by)
        if dragging:
            slip_by = spread(gathered(points, foundation.force / elastic, along, nodes), X, s, c)
            slip_by[2] += dphi * (foundation.force * np.sin(points.psi)).sum() / elastic
            ways = points.move + dphi * lift
            slip_by += spread(slip_by_gaps(points, ways, foundation, slip, elastic, up, nodes), Y, s, c)
            share_by = -damper[3] * slip_by - drag / elastic * elastic_by
        add_outer(tangent, spread(gathered(points, tractions.share, along, nodes), X, s, c), share_by)

    # the directions themselves turn with phi
    turning = 0.0
    for i in range(total):
        psi = points.psi[i]
        u_x, u_y = sin(psi) - points.arm_x[i], points.arm_y[i] - 2 * sin(psi / 2) ** 2
        turning += eta * foundation.force[i] * (cos(psi) - u_y) + tractions.force[i] * (sin(psi) - u_x)
    tangent[2, 2] += turning
    for i in range(nodes):
        row = 3 + 2 * i
        tangent[2, row] += forces[row + 1]
        tangent[row, 2] += forces[row + 1]
        tangent[2, row + 1] -= forces[row]
        tangent[row + 1, 2] -= forces[row]

    res[NORMAL], res[FRICTION] = forces[1], forces[0]
    res[NORMAL_ENERGY], res[BRISTLE_ENERGY] = foundation.energy, tractions.energy
    res[LENGTH] = foundation.length
    res[STUCK] = tractions.stuck / foundation.length if foundation.length > 0 else 0.0
    res[SLIP], res[ELASTIC], res[ETA], res[DRAG] = slip, elastic, eta, drag
    if (mode == SLIDE_RIGHT or mode == SLIDE_LEFT) and foundation.length > 0:
        res[FEET] = (tractions.sliding - tractions.held) / (eps_t * foundation.length)
    res[BEYOND] = ((carried.pull + held) * (carried.way - carried.mean)).sum() / 2
    active = 0
    for i in range(total):
        if points.gap[i] < 0:
            if active == 0:
                res[LOW] = points.psi[i]
            res[HIGH] = points.psi[i]
            active += 1
    keeps = points.gap < 0
    if mode == STICK:  # a point just past the edge that points leave still bounds the bristles behind it
        for i in range(total):
            if carried.touched[i] and points.gap[i] >= 0:
                before = i > 0 and not points.last[i - 1] and points.gap[i - 1] < 0
                behind = i + 1 < total and not points.last[i] and points.gap[i + 1] < 0
                keeps[i] = before or behind
    kept, kept_flags = np.empty((keeps.sum(), 3)), np.empty(keeps.sum(), np.int8)
    n = 0
    for i in range(total):
        if keeps[i]:
            kept[n, 0], kept[n, 1], kept[n, 2] = points.number[i], carried.stretch[i], held[i]
            kept_flags[n] = carried.sliding[i]
            n += 1
    return forces[:3].copy(), forces[3:].copy().reshape(nodes, 2), tangent, res, kept, kept_flags


__all__ = [
    "BRUSH", "SLIDE_LEFT", "SLIDE_RIGHT", "STICK", "UNDAMPED", "contact_forces", "element_at", "vertex_angle",
]  # fmt: skip
