"""Compliant frictional contact of the rim with the floor: pressures on dense material points, two friction laws.

The rim's material points lie ``spacing`` apart in the angle theta, many to an element and many to a patch; each one's
displacement is interpolated on the curved quadratic rim. With ``psi = phi + theta - pi`` its angle from the bottom,
``h`` the height of the hoop's centre above R, and (u_X, u_Y) its displacement in the world's axes,

    gap            g = h + 2 sin^2(psi/2) + u_Y
    floor abscissa x = V + phi - sin(psi) + u_X,       V = x_C - phi,

neither of which subtracts numbers of order one (R = m = g = 1 throughout).

Normal: a Winkler foundation, energy eps_n/2 times the integral of g^2 where g < 0, with g linear between points and the
edge of the patch where that line crosses zero. Forces and stiffness are exact derivatives of that energy.

Tangential: each point carries a bristle of stiffness eps_t. A point enters the patch with its bristle unstrained, at
the instant of the step at which its gap, a parabola in time, crosses zero. ``PATCH``: while the patch sticks, every
bristle follows its point, and while it slides, mu N is shared over the patch like the pressure; which of both is
decided on the resultants, by the caller. ``BRUSH``: each point breaks at mu_s p and slides at mu p by itself.

Damping, if any, is that of the patch as a whole, N = N_el + theta dN_el/dt, and while it sticks
F = F_el - theta k_t v with v the mean slip of the patch: it damps the approach and the slip, and not a material point's
own gap rate, which under rolling would be a rolling resistance.
"""

from __future__ import annotations

from math import ceil, cos, floor, pi, sin, sqrt
from typing import Any

import numpy as np
from numba import njit

STICK, SLIDE_RIGHT, SLIDE_LEFT, BRUSH = 0, 1, -1, 2  # SLIDE_RIGHT: friction pushes the hoop to the right (spinning)

# positions in the array of contact parameters
SPACING, EPS_N, EPS_T, MU_S, MU = range(5)
# positions in the array of resultants
NORMAL, FRICTION, NORMAL_ENERGY, BRISTLE_ENERGY, LENGTH, STUCK, SLIP, LOW, HIGH, OUTSIDE, ELASTIC, ETA, DRAG = range(13)
RESULTANTS = 13

UNDAMPED = np.array([0.0, 0.0, 1.0, 0.0, 0.0])


@njit(cache=True)
def vertex_angle(vertex: Any, element: int) -> float:
    """Angle at which rim element ``element`` begins; elements are counted on round and round."""
    n = vertex.shape[0]
    turn = element // n
    return vertex[element - turn * n] + 2 * pi * turn


@njit(cache=True)
def element_at(vertex: Any, theta: float) -> int:
    """Rim element that holds the material angle ``theta``."""
    n = vertex.shape[0]
    turn = int(floor((theta - vertex[0]) / (2 * pi)))
    rest = theta - 2 * pi * turn
    return int(np.searchsorted(vertex, rest, side="right")) - 1 + turn * n


@njit(cache=True)
def _touching(height: float, psi_start: float, width: float, y0: float, y1: float, y2: float) -> tuple[float, float]:
    """Part [low, high] of an element, in 0..1, where the gap is negative; low > high when there is none."""
    c1, c2 = -3 * y0 + 4 * y1 - y2, 2 * y0 - 4 * y1 + 2 * y2
    base = height + y0
    at_start = base + 2 * sin(psi_start / 2) ** 2
    at_end = base + c1 + c2 + 2 * sin((psi_start + width) / 2) ** 2
    lowest = min(max(-psi_start / width, 0.0), 1.0)
    for _ in range(5):
        slope = width * sin(psi_start + lowest * width) + c1 + 2 * c2 * lowest
        curvature = width**2 * cos(psi_start + lowest * width) + 2 * c2
        if curvature <= 0:
            lowest = 0.0 if at_start < at_end else 1.0
            break
        lowest = min(max(lowest - slope / curvature, 0.0), 1.0)
    bottom = base + c1 * lowest + c2 * lowest**2 + 2 * sin((psi_start + lowest * width) / 2) ** 2
    if min(bottom, at_start, at_end) >= 0:
        return 1.0, 0.0
    edges = np.array([0.0, 1.0])
    curvature = width**2 * cos(psi_start + lowest * width) + 2 * c2
    for side in range(2):
        end_gap = at_start if side == 0 else at_end
        if end_gap < 0 or curvature <= 0:
            continue
        far = float(side)
        s = lowest + (2 * side - 1) * sqrt(max(-2 * bottom, 0.0) / curvature)
        for _ in range(3):
            s = min(max(s, 0.0), 1.0)
            value = base + c1 * s + c2 * s**2 + 2 * sin((psi_start + s * width) / 2) ** 2
            slope = width * sin(psi_start + s * width) + c1 + 2 * c2 * s
            if slope * (far - lowest) <= 0:
                break
            s -= value / slope
        edges[side] = min(max(s, 0.0), 1.0)
    return edges[0], edges[1]


@njit(cache=True)
def _candidates(height: float, phi: float, y: Any, first: int, count: int, vertex: Any, spacing: float) -> Any:
    """Ranges of points that touch or border on a touching one, merged; rows (first, last)."""
    ranges = np.empty((count, 2), np.int64)
    n = 0
    for i in range(count):
        start = vertex_angle(vertex, first + i)
        width = vertex_angle(vertex, first + i + 1) - start
        low, high = _touching(height, phi - pi + start, width, y[2 * i], y[2 * i + 1], y[2 * i + 2])
        if low > high:
            continue
        j_low = int(ceil((start + low * width) / spacing)) - 1
        j_high = int(floor((start + high * width) / spacing)) + 1
        # the edges are estimates: the range must begin and end with a point off the floor, or with the element
        first_point, last_point = int(ceil(start / spacing)) - 1, int(floor((start + width) / spacing)) + 1
        for j, end in ((j_low, first_point), (j_high, last_point)):
            way = -1 if end == first_point else 1
            while way * (end - j) > 0:
                s = (j * spacing - start) / width
                bend = -3 * y[2 * i] + 4 * y[2 * i + 1] - y[2 * i + 2]
                rise = y[2 * i] + s * (bend + s * (2 * y[2 * i] - 4 * y[2 * i + 1] + 2 * y[2 * i + 2]))
                if height + rise + 2 * sin((phi - pi + j * spacing) / 2) ** 2 >= 0:
                    break
                j += way
            if way < 0:
                j_low = j
            else:
                j_high = j
        if n > 0 and j_low <= ranges[n - 1, 1] + 1:
            ranges[n - 1, 1] = max(j_high, ranges[n - 1, 1])
        else:
            ranges[n, 0], ranges[n, 1] = j_low, j_high
            n += 1
    return ranges[:n]


@njit(cache=True)
def _cell(ga: float, gb: float, unit: float, out: Any) -> None:
    """Energy of one cell with gap from ``ga`` to ``gb``, its gradient and second derivatives.

    ``out``: energy, -d/da, -d/db, aa, ab, bb; ``unit`` is eps_n times the spacing.
    """
    if ga < 0 and gb < 0:
        out[0] = unit * (ga * ga + ga * gb + gb * gb) / 6
        out[1] = -unit * (2 * ga + gb) / 6
        out[2] = -unit * (2 * gb + ga) / 6
        out[3] = out[5] = unit / 3
        out[4] = unit / 6
    elif ga < 0:
        q = ga / (gb - ga)
        out[0] = -unit * ga * ga * q / 6
        out[1] = unit * ga * (3 * q + q * q) / 6
        out[2] = -unit * ga * q * q / 6
        out[3] = -unit * (6 * q + 6 * q * q + 2 * q**3) / 6
        out[4] = unit * (3 * q * q + 2 * q**3) / 6
        out[5] = -unit * 2 * q**3 / 6
    elif gb < 0:
        _cell(gb, ga, unit, out)
        out[1], out[2] = out[2], out[1]
        out[3], out[5] = out[5], out[3]
    else:
        out[:] = 0.0


@njit(cache=True)
def _entry(g_old: float, g_new: float, sweep: float) -> tuple[float, float, float]:
    """Fraction of the step at which a point touched, and its derivatives by the new gap and by ``sweep``.

    The gap is the parabola from ``g_old`` > 0 to ``g_new`` with second derivative ``sweep`` = dphi^2 in the
    fraction; a negative fraction says that the point never touched.
    """
    a = sweep / 2
    b = g_new - g_old - a
    disc = b * b - 4 * a * g_old
    if disc <= 0 or b >= 0:
        return -1.0, 0.0, 0.0
    root = sqrt(disc)
    fraction = 2 * g_old / (root - b)
    if fraction >= 1:
        return -1.0, 0.0, 0.0
    return fraction, fraction / root, -fraction * (1 - fraction) / 2 / root


@njit(cache=True)
def _scatter(k_bb: Any, k_ab: Any, k_aa: Any, block: Any, first: int) -> None:
    """Add an element's products to the tangents, and clear them."""
    for q in range(5):
        row = q if q < 2 else first + q
        for w in range(5):
            column = w if w < 2 else first + w
            k_bb[row, column] += block[0, q, w]
            k_ab[row, column] += block[1, q, w]
            k_aa[row, column] += block[2, q, w]
    block[:] = 0.0


@njit(cache=True)
def _add_normal(row: Any, factor: float, diagonal: Any, coupling: Any, before: int, here: int, behind: int) -> None:
    """Derivatives of ``factor`` times the normal force of a point by the gaps around it."""
    row[1] -= factor * diagonal[here]
    if before >= 0:
        row[0] -= factor * coupling[before]
    if behind >= 0:
        row[2] -= factor * coupling[here]


@njit(cache=True)
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
    bristles, flags : (m, 2), (m,) arrays
        Number and stretch of each point in contact at the beginning of the step, ascending; sliding or not.
    damper : (5,) array
        (rho, N_0, eta_0, c, x_0): pressures are eta times the elastic ones, eta = eta_0 + rho (N_el - N_0)/N_el, at
        least 0; a sticking patch drags with -c (x - x_0), shared like the pressure, x its mean move in the step.
        rho is the damper's relaxation time over the step's beta; N_0, x_0 are what N_el, x were without a rate.

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
    spacing, eps_n, eps_t, mu_s, mu = law[SPACING], law[EPS_N], law[EPS_T], law[MU_S], law[MU]
    nodes = u.shape[0]
    count = (nodes - 1) // 2
    height, phi = pose[1], pose[2]
    s, c = sin(phi), cos(phi)
    s_old, c_old = sin(old_pose[2]), cos(old_pose[2])
    dv, dphi = pose[0] - old_pose[0], phi - old_pose[2]
    res = np.zeros(RESULTANTS)
    force = np.zeros(3)
    nodal = np.zeros((nodes, 2))
    size = 3 + 2 * nodes
    tangent = np.zeros((size, size))

    y = np.empty(nodes)
    for i in range(nodes):
        y[i] = u[i, 0] * c - u[i, 1] * s
    ranges = _candidates(height, phi, y, first, count, vertex, spacing)
    total = 0
    for r in range(ranges.shape[0]):
        total += ranges[r, 1] - ranges[r, 0] + 1
    if total == 0:
        return force, nodal, tangent, res, np.empty((0, 2)), np.empty(0, np.int8)

    number = np.empty(total, np.int64)
    breaks = np.zeros(total, np.bool_)  # the next point is not the neighbour
    local = np.empty(total, np.int64)  # first node of the point's element
    shape = np.empty((total, 3))
    arm_x, arm_y = np.empty(total), np.empty(total)  # derivatives of gap and abscissa by phi
    gap, move, stretch, stretch_rate = np.empty(total), np.empty(total), np.empty(total), np.empty(total)
    by_gap, by_phi = np.zeros(total), np.zeros(total)  # stretch also depends on the instant of entry
    entered = np.zeros(total, np.int8)  # 0 not yet, 1 has touched
    sliding = np.zeros(total, np.int8)

    m, p = 0, 0
    element = first
    for r in range(ranges.shape[0]):
        for j in range(ranges[r, 0], ranges[r, 1] + 1):
            theta = j * spacing
            element = min(max(element_at(vertex, theta), first), first + count - 1)
            start = vertex_angle(vertex, element)
            xi = (theta - start) / (vertex_angle(vertex, element + 1) - start)
            if xi < -1e-9 or xi > 1 + 1e-9:
                res[OUTSIDE] = 1.0
            k = 2 * (element - first)
            n0, n1, n2 = (1 - xi) * (1 - 2 * xi), 4 * xi * (1 - xi), xi * (2 * xi - 1)
            u1 = n0 * u[k, 0] + n1 * u[k + 1, 0] + n2 * u[k + 2, 0]
            u2 = n0 * u[k, 1] + n1 * u[k + 1, 1] + n2 * u[k + 2, 1]
            v1 = n0 * u_old[k, 0] + n1 * u_old[k + 1, 0] + n2 * u_old[k + 2, 0]
            v2 = n0 * u_old[k, 1] + n1 * u_old[k + 1, 1] + n2 * u_old[k + 2, 1]
            ux, uy = u1 * s + u2 * c, u1 * c - u2 * s
            psi = phi - pi + theta
            psi_old = old_pose[2] - pi + theta
            raised = 2 * sin(psi / 2) ** 2
            number[m], local[m] = j, k
            shape[m, 0], shape[m, 1], shape[m, 2] = n0, n1, n2
            gap[m] = height + raised + uy
            arm_x[m], arm_y[m] = sin(psi) - ux, raised + uy
            move[m] = dv + dphi - 2 * cos((psi + psi_old) / 2) * sin(dphi / 2) + ux - (v1 * s_old + v2 * c_old)
            stretch[m], stretch_rate[m] = 0.0, 0.0
            while p < bristles.shape[0] and bristles[p, 0] < j:
                p += 1
            if p < bristles.shape[0] and bristles[p, 0] == j:
                entered[m] = 1
                stretch[m] = bristles[p, 1] + move[m]
                stretch_rate[m] = 1.0
                sliding[m] = flags[p]
            else:
                gap_old = old_pose[1] + 2 * sin(psi_old / 2) ** 2 + v1 * c_old - v2 * s_old
                fraction, d_gap, d_sweep = _entry(max(gap_old, 0.0), gap[m], dphi * dphi)
                if fraction >= 0:
                    entered[m] = 1
                    stretch[m] = (1 - fraction) * move[m]
                    stretch_rate[m] = 1 - fraction
                    by_gap[m] = -move[m] * d_gap
                    by_phi[m] = -move[m] * d_sweep * 2 * dphi
                    # a point that enters behind a sliding edge goes on sliding
                    if flags.shape[0] > 0 and mode == BRUSH:
                        near = 0 if j < bristles[0, 0] else flags.shape[0] - 1
                        sliding[m] = flags[near]
            m += 1
        breaks[m - 1] = True

    normal, weight = np.zeros(total), np.zeros(total)
    diagonal, coupling = np.zeros(total), np.zeros(total)
    weight_by = np.zeros((total, 3))  # by the gaps of the point before, the point, the point behind
    out = np.empty(6)
    for i in range(total - 1):
        if breaks[i]:
            continue
        ga, gb = gap[i], gap[i + 1]
        if ga >= 0 and gb >= 0:
            continue
        _cell(ga, gb, eps_n * spacing, out)
        res[NORMAL_ENERGY] += out[0]
        normal[i] += out[1]
        normal[i + 1] += out[2]
        diagonal[i] += out[3]
        coupling[i] = out[4]
        diagonal[i + 1] += out[5]
        if ga < 0 and gb < 0:
            weight[i] += spacing / 2
            weight[i + 1] += spacing / 2
            res[LENGTH] += spacing
        else:
            i_in, i_out = (i, i + 1) if ga < 0 else (i + 1, i)
            d = gap[i_out] - gap[i_in]
            f = -gap[i_in] / d
            f_in, f_out = -gap[i_out] / d**2, gap[i_in] / d**2
            res[LENGTH] += spacing * f
            side = 2 if i_out > i_in else 0
            if mode != BRUSH and entered[i_out] == 1:  # an edge that points leave: bristles stay stretched up to it
                weight[i_in] += spacing * (f - f * f / 2)
                weight[i_out] += spacing * f * f / 2
                weight_by[i_in, 1] += spacing * (1 - f) * f_in
                weight_by[i_in, side] += spacing * (1 - f) * f_out
                weight_by[i_out, 1] += spacing * f * f_out
                weight_by[i_out, 2 - side] += spacing * f * f_in
            else:
                weight[i_in] += spacing * f / 2
                weight_by[i_in, 1] += spacing * f_in / 2
                weight_by[i_in, side] += spacing * f_out / 2

    elastic = normal.sum()
    eta, eta_rate = damper[2], 0.0
    if elastic > 0 and damper[0] > 0:
        eta += damper[0] * (1 - damper[1] / elastic)
        eta_rate = damper[0] * damper[1] / elastic**2
        if eta < 0:
            eta, eta_rate = 0.0, 0.0
    res[ELASTIC], res[ETA] = elastic, eta
    # what is proportional to eta (normal, and tangential while points slide) or to the drag, per unit of it:
    # of V or h, of phi, and of the nodes in the world's axes
    normal_share, share = np.zeros(2), np.zeros(2)
    world_share = np.zeros((nodes, 2))

    # scalar tangents: rows and columns (V or h, phi, nodes); B belongs to the gap, A to the abscissa
    k_bb = np.zeros((2 + nodes, 2 + nodes))
    k_ab = np.zeros((2 + nodes, 2 + nodes))
    k_aa = np.zeros((2 + nodes, 2 + nodes))
    world = np.zeros((nodes, 2))
    block = np.zeros((3, 5, 5))
    normal_row, gap_row = np.empty(5), np.empty(5)
    element_rows = 0
    active = 0
    geometric = 0.0
    rows = np.empty((total, 5), np.int64)
    b_of, a_of = np.empty((total, 5)), np.empty((total, 5))
    for i in range(total):
        rows[i, 0], rows[i, 1] = 0, 1
        b_of[i, 0] = a_of[i, 0] = 1.0
        b_of[i, 1], a_of[i, 1] = arm_x[i], arm_y[i]
        for q in range(3):
            rows[i, 2 + q] = 2 + local[i] + q
            b_of[i, 2 + q] = a_of[i, 2 + q] = shape[i, q]
    traction_of, share_of = np.zeros(total), np.zeros(total)
    on_a, on_phi = np.zeros(total), np.zeros(total)  # derivative of the traction by this point's abscissa and by phi
    on_gap = np.zeros((total, 3))  # and by the gaps of the point before, the point, the point behind
    for i in range(total):
        before = i - 1 if i > 0 and not breaks[i - 1] else -1
        behind = i + 1 if i + 1 < total and not breaks[i] else -1
        if mode == SLIDE_RIGHT or mode == SLIDE_LEFT:
            share_of[i] = mode * mu * normal[i]
            traction_of[i] = eta * share_of[i]
            _add_normal(on_gap[i], eta * mode * mu, diagonal, coupling, before, i, behind)
            stretch[i] = eta * mode * mu * eps_n * min(gap[i], 0.0) / eps_t
            res[BRISTLE_ENERGY] += weight[i] * eps_t * stretch[i] ** 2 / 2
        elif weight[i] != 0:
            slides = False
            if mode == BRUSH:
                bound = (mu if sliding[i] != 0 else mu_s) * -eta * eps_n * gap[i]
                slides = abs(eps_t * stretch[i]) > bound
            if slides:
                sign = 1 if stretch[i] < 0 else -1
                traction = -sign * mu * eta * eps_n * gap[i]
                stretch[i] = -traction / eps_t
                sliding[i] = sign
                share_of[i] = -weight[i] * sign * mu * eps_n * gap[i]
                on_gap[i, 1] = -weight[i] * sign * mu * eta * eps_n
            else:
                traction = -eps_t * stretch[i]
                sliding[i] = 0
                on_a[i] = -eps_t * weight[i] * stretch_rate[i]
                on_gap[i, 1] = -eps_t * weight[i] * by_gap[i]
                on_phi[i] = -eps_t * weight[i] * by_phi[i]
                res[STUCK] += weight[i]
            traction_of[i] = weight[i] * traction
            for q in range(3):
                on_gap[i, q] += traction * weight_by[i, q]
            res[BRISTLE_ENERGY] += weight[i] * traction**2 / (2 * eps_t)
    drag = 0.0
    dragging = mode == STICK and elastic > 0 and damper[3] > 0
    by_slip_a, by_slip_b = np.zeros(2 + nodes), np.zeros(2 + nodes)
    if dragging:
        slip = (normal * move).sum() / elastic
        drag = -damper[3] * (slip - damper[4])
        res[DRAG] = drag
        around = np.zeros(3)
        for i in range(total):
            before = i - 1 if i > 0 and not breaks[i - 1] else -1
            behind = i + 1 if i + 1 < total and not breaks[i] else -1
            around[:] = 0.0
            _add_normal(around, (move[i] - slip) / elastic, diagonal, coupling, before, i, behind)
            for w in range(5):
                by_slip_a[rows[i, w]] += normal[i] / elastic * a_of[i, w]
                by_slip_b[rows[i, w]] += around[1] * b_of[i, w]
                if before >= 0:
                    by_slip_b[rows[before, w]] += around[0] * b_of[before, w]
                if behind >= 0:
                    by_slip_b[rows[behind, w]] += around[2] * b_of[behind, w]
        for i in range(total):
            before = i - 1 if i > 0 and not breaks[i - 1] else -1
            behind = i + 1 if i + 1 < total and not breaks[i] else -1
            share_of[i] = normal[i] / elastic
            traction_of[i] += drag * share_of[i]
            _add_normal(on_gap[i], drag / elastic, diagonal, coupling, before, i, behind)

    for i in range(total):
        tau, tau_share = traction_of[i], share_of[i]
        if normal[i] == 0 and tau == 0:
            continue
        before = i - 1 if i > 0 and not breaks[i - 1] else -1
        behind = i + 1 if i + 1 < total and not breaks[i] else -1
        pushed = eta * normal[i]
        res[NORMAL] += pushed
        res[FRICTION] += tau
        res[SLIP] += normal[i] * move[i]
        force[0] += tau
        force[1] += pushed
        force[2] += pushed * arm_x[i] + tau * arm_y[i]
        normal_share[0] += normal[i]
        normal_share[1] += normal[i] * arm_x[i]
        share[0] += tau_share
        share[1] += tau_share * arm_y[i]
        psi = phi - pi + number[i] * spacing
        turning = sin(psi) - arm_x[i]  # u_X
        lifting = arm_y[i] - 2 * sin(psi / 2) ** 2  # u_Y
        geometric += pushed * (cos(psi) - lifting) + tau * (sin(psi) - turning)
        for q in range(3):
            world[local[i] + q, 0] += tau * shape[i, q]
            world[local[i] + q, 1] += pushed * shape[i, q]
            world_share[local[i] + q, 0] += tau_share * shape[i, q]
            world_share[local[i] + q, 1] += normal[i] * shape[i, q]
        # the rows of an element share a basis: its products are gathered in place and added when it is left
        if local[i] != element_rows:
            _scatter(k_bb, k_ab, k_aa, block, element_rows)
            element_rows = local[i]
        for w in range(5):
            normal_row[w] = -diagonal[i] * b_of[i, w]
            gap_row[w] = on_gap[i, 1] * b_of[i, w]
        for side in range(2):
            near = before if side == 0 else behind
            if near < 0:
                continue
            spring = coupling[min(i, near)]
            traction_rate = on_gap[i, 2 * side]
            if local[near] == local[i]:
                for w in range(5):
                    normal_row[w] -= spring * b_of[near, w]
                    gap_row[w] += traction_rate * b_of[near, w]
            else:
                for q in range(5):
                    for w in range(5):
                        k_bb[rows[i, q], rows[near, w]] -= spring * b_of[i, q] * b_of[near, w]
                        k_ab[rows[i, q], rows[near, w]] += traction_rate * a_of[i, q] * b_of[near, w]
        for q in range(5):
            b_q, a_q = b_of[i, q], a_of[i, q]
            for w in range(5):
                block[0, q, w] += b_q * normal_row[w]
                block[1, q, w] += a_q * gap_row[w]
        if on_a[i] != 0 or on_phi[i] != 0:
            for q in range(5):
                a_q = a_of[i, q]
                block[2, q, 1] += a_q * on_phi[i]
                for w in range(5):
                    block[2, q, w] += a_q * on_a[i] * a_of[i, w]
        if gap[i] < 0:
            if active == 0:
                res[LOW] = psi
            res[HIGH] = psi
            active += 1

    _scatter(k_bb, k_ab, k_aa, block, element_rows)

    # k_bb is still that of the elastic pressures; its first row is the derivative of N_el
    by_elastic = np.zeros(size)
    by_elastic[1], by_elastic[2] = k_bb[0, 0], k_bb[0, 1]
    for i in range(nodes):
        by_elastic[3 + 2 * i], by_elastic[4 + 2 * i] = c * k_bb[0, 2 + i], -s * k_bb[0, 2 + i]
    k_bb *= eta

    # from (abscissa, gap) to (V, h, phi, nodes in the disk's axes)
    tangent[0, 0] = k_aa[0, 0]
    tangent[0, 1] = k_ab[0, 0]
    tangent[1, 1] = k_bb[0, 0]
    tangent[0, 2] = k_aa[0, 1] + k_ab[0, 1]
    tangent[2, 0] = k_aa[1, 0]
    tangent[1, 2] = k_bb[0, 1]
    tangent[2, 1] = k_bb[1, 0] + k_ab[1, 0]
    tangent[2, 2] = k_aa[1, 1] + k_ab[1, 1] + k_bb[1, 1] + geometric
    for i in range(nodes):
        fx, fy = world[i, 0], world[i, 1]
        nodal[i, 0], nodal[i, 1] = s * fx + c * fy, c * fx - s * fy
        row = 3 + 2 * i
        tangent[0, row] = s * k_aa[0, 2 + i] + c * k_ab[0, 2 + i]
        tangent[0, row + 1] = c * k_aa[0, 2 + i] - s * k_ab[0, 2 + i]
        tangent[1, row] = c * k_bb[0, 2 + i]
        tangent[1, row + 1] = -s * k_bb[0, 2 + i]
        along_x = k_aa[1, 2 + i]
        along_y = k_ab[1, 2 + i] + k_bb[1, 2 + i]
        tangent[2, row] = s * along_x + c * along_y + nodal[i, 1]
        tangent[2, row + 1] = c * along_x - s * along_y - nodal[i, 0]
        x_by_v, x_by_h, x_by_phi = k_aa[2 + i, 0], k_ab[2 + i, 0], k_aa[2 + i, 1] + k_ab[2 + i, 1]
        y_by_h, y_by_phi = k_bb[2 + i, 0], k_bb[2 + i, 1]
        tangent[row, 0] = s * x_by_v
        tangent[row + 1, 0] = c * x_by_v
        tangent[row, 1] = s * x_by_h + c * y_by_h
        tangent[row + 1, 1] = c * x_by_h - s * y_by_h
        tangent[row, 2] = s * x_by_phi + c * y_by_phi + nodal[i, 1]
        tangent[row + 1, 2] = c * x_by_phi - s * y_by_phi - nodal[i, 0]
        for j in range(nodes):
            xx, xy, yy = k_aa[2 + i, 2 + j], k_ab[2 + i, 2 + j], k_bb[2 + i, 2 + j]
            column = 3 + 2 * j
            tangent[row, column] = s * (s * xx + c * xy) + c * c * yy
            tangent[row, column + 1] = s * (c * xx - s * xy) - c * s * yy
            tangent[row + 1, column] = c * (s * xx + c * xy) - s * c * yy
            tangent[row + 1, column + 1] = c * (c * xx - s * xy) + s * s * yy

    if eta_rate != 0 or dragging:
        # eta and the drag change with all unknowns at once
        by_drag = np.zeros(size)
        if dragging:
            rate = -damper[3]
            by_drag[0], by_drag[1] = rate * by_slip_a[0], rate * by_slip_b[0]
            by_drag[2] = rate * (by_slip_a[1] + by_slip_b[1])
            for i in range(nodes):
                along_x, along_y = by_slip_a[2 + i], by_slip_b[2 + i]
                by_drag[3 + 2 * i] = rate * (s * along_x + c * along_y)
                by_drag[4 + 2 * i] = rate * (c * along_x - s * along_y)
            by_drag -= drag / elastic * by_elastic
        for j in range(size):
            n_change = eta_rate * by_elastic[j]
            t_change = by_drag[j] if dragging else n_change
            tangent[0, j] += share[0] * t_change
            tangent[1, j] += normal_share[0] * n_change
            tangent[2, j] += normal_share[1] * n_change + share[1] * t_change
            for i in range(nodes):
                fx, fy = world_share[i, 0] * t_change, world_share[i, 1] * n_change
                tangent[3 + 2 * i, j] += s * fx + c * fy
                tangent[4 + 2 * i, j] += c * fx - s * fy

    if elastic > 0:
        res[SLIP] /= elastic
    if res[LENGTH] > 0:
        res[STUCK] /= res[LENGTH]
    kept, kept_flags = np.empty((active, 2)), np.empty(active, np.int8)
    n = 0
    for i in range(total):
        if gap[i] < 0:
            kept[n, 0], kept[n, 1], kept_flags[n] = number[i], stretch[i], sliding[i]
            n += 1
    return force, nodal, tangent, res, kept, kept_flags
