"""Elasticity and rim of a chain of rod parts that turn and move far, in compiled code.

A *section* of the ring is rigid: it moves by (u1, u2) and turns by phi, all relative to the disk's frame. A *part*
between two sections is elastic. What deforms it is seen from its chord: the chord's elongation e and the angles that
its two sections make with it. In these three the part is linear, since each of many parts bends little; everything
else, however large the rotation, is geometry (corotational formulation, Crisfield 1990). Elongation and angles are made
from displacements, so that nothing cancels:

    e = (2 D.d + d.d)/(l' + l),   alpha = atan2(D x d, l^2 + D.d),   tau = phi - alpha,      d = u_2 - u_1.

The outer rim between two sections is a cubic (Hermite) through the points of the rim that the two sections carry, with
the directions and the stretch of the rim there: C1 all around, at any rotation. Its stretch is that of bending, offset
times dphi/dtheta by three sections, and with it the wall gets thinner.
"""

from __future__ import annotations

from math import atan2, cos, sin, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import jit

Array = NDArray[np.float64]


class Rod(NamedTuple):
    """A ring cut into n + 1 parts by n sections; the first and the last section, 0 and n + 1, are welded to the disk.

    Attributes
    ----------
    theta : (n + 2,) array
        Angle of each section, ascending from one end of the weld round to the other.
    place : (n + 2, 2) array
        Its centre of mass, undeformed.
    local : (n + 1, 3, 3) array
        Stiffness of each part in (e, tau_1, tau_2).
    across : (3, 3) array
        Of the first part by the last one, through the wall over the weld.
    mass, turning : (n + 2,) arrays
        Mass of each section, and its moment of inertia about its centre of mass.
    curve : (n + 2, 3) array
        Weights that make dphi/dtheta at a section of phi of the one before, itself, the one behind.
    offset : float
        Of the rim from the centres of mass.
    pinch : float
        What the rim sinks where the ring bends by dphi/dtheta = 1, for a wall that is stretched gets thinner.
    """

    theta: Array
    place: Array
    local: Array
    across: Array
    mass: Array
    turning: Array
    curve: Array
    offset: float
    pinch: float


class RimNodes(NamedTuple):
    """Nodes of the rim, and what they follow; see :func:`rim_point`.

    Attributes
    ----------
    part : (m,) int array
    xi : (m,) array
    root : (m, 2, 6) array
    """

    part: NDArray[np.int64]
    xi: Array
    root: Array


@jit
def _chord(rod: Any, q: Any, p: int) -> Any:
    """Direction and length of a part's chord, and the three strains of the part."""
    a1, a2 = rod.place[p + 1, 0] - rod.place[p, 0], rod.place[p + 1, 1] - rod.place[p, 1]
    d1, d2 = q[p + 1, 0] - q[p, 0], q[p + 1, 1] - q[p, 1]
    dot, square = a1 * d1 + a2 * d2, a1 * a1 + a2 * a2
    x1, x2 = a1 + d1, a2 + d2
    now = sqrt(x1 * x1 + x2 * x2)
    alpha = atan2(a1 * d2 - a2 * d1, square + dot)
    longer = (2 * dot + d1 * d1 + d2 * d2) / (now + sqrt(square))
    return x1 / now, x2 / now, now, np.array([longer, q[p, 2] - alpha, q[p + 1, 2] - alpha])


@jit
def _strained(local: Any, strain: Any, stress: Any) -> None:
    """Add the stress of a strain."""
    for i in range(3):
        for j in range(3):
            stress[i] += local[i, j] * strain[j]


@jit
def _directions(t1: float, t2: float, now: float, by: Any) -> None:
    """Derivatives (3, 6) of the strains of a part by the coordinates of its sections."""
    by[:] = 0.0
    by[0, 0], by[0, 1], by[0, 3], by[0, 4] = -t1, -t2, t1, t2
    for i in (1, 2):
        by[i, 0], by[i, 1], by[i, 3], by[i, 4] = -t2 / now, t1 / now, t2 / now, -t1 / now
    by[1, 2] = by[2, 5] = 1.0


@jit
def _stiffen(t1: float, t2: float, now: float, stress: Any, local: Any, by: Any, tangent: Any) -> None:
    """Second derivatives (6, 6) of a part's energy."""
    for k in range(6):
        for m in range(6):
            tangent[m, k] = 0.0
        for i in range(3):
            value = local[i, 0] * by[0, k] + local[i, 1] * by[1, k] + local[i, 2] * by[2, k]
            for m in range(6):
                tangent[m, k] += by[i, m] * value
    pull, turn = stress[0] / now, (stress[1] + stress[2]) / (now * now)
    g11 = pull * t2 * t2 - 2 * turn * t1 * t2
    g12 = -pull * t1 * t2 + turn * (t1 * t1 - t2 * t2)
    g22 = pull * t1 * t1 + 2 * turn * t1 * t2
    for a in (0, 3):
        for b in (0, 3):
            sign = 1.0 if a == b else -1.0
            tangent[a, b] += sign * g11
            tangent[a, b + 1] += sign * g12
            tangent[a + 1, b] += sign * g12
            tangent[a + 1, b + 1] += sign * g22


@jit
def elastic(rod: Any, q: Any, force: Any, diagonal: Any, up: Any, down: Any) -> float:
    """Strain energy of the chain; its forces and its tangent are added.

    Parameters
    ----------
    rod : Rod
    q : (n + 2, 3) array
        Displacement and rotation of all sections; those of the weld are zero.
    force : (n + 2, 3) array
    diagonal : (n + 2, 3, 3) array
    up, down : (n + 1, 3, 3) arrays
        Derivatives of the forces on section i by i + 1, and on i + 1 by i; those behind n are on n by 1, and on 1 by n.
    """
    energy = 0.0
    last = rod.local.shape[0] - 1
    by, tangent = np.empty((3, 6)), np.empty((6, 6))
    for p in range(last + 1):
        t1, t2, now, strain = _chord(rod, q, p)
        stress = np.zeros(3)
        _strained(rod.local[p], strain, stress)
        if p == 0:
            _strained(rod.across, _chord(rod, q, last)[3], stress)
        elif p == last:
            _strained(rod.across.T, _chord(rod, q, 0)[3], stress)
        _directions(t1, t2, now, by)
        _stiffen(t1, t2, now, stress, rod.local[p], by, tangent)
        for i in range(3):
            energy += strain[i] * stress[i] / 2
            for k in range(3):
                force[p, k] += by[i, k] * stress[i]
                force[p + 1, k] += by[i, 3 + k] * stress[i]
        for i in range(3):
            for j in range(3):
                diagonal[p, i, j] += tangent[i, j]
                diagonal[p + 1, i, j] += tangent[3 + i, 3 + j]
                if 0 < p < last:
                    up[p, i, j] += tangent[i, 3 + j]
                    down[p, i, j] += tangent[3 + i, j]
    _add_across(rod, q, up[last], down[last])
    return energy


@jit
def _add_across(rod: Any, q: Any, up: Any, down: Any) -> None:
    """What the last section feels of the first, and the first of the last."""
    last = rod.local.shape[0] - 1
    first, final = np.empty((3, 6)), np.empty((3, 6))
    t1, t2, now, _ = _chord(rod, q, 0)
    _directions(t1, t2, now, first)
    t1, t2, now, _ = _chord(rod, q, last)
    _directions(t1, t2, now, final)
    for i in range(3):
        for j in range(3):
            for a in range(3):
                for b in range(3):
                    value = first[i, 3 + a] * rod.across[i, j] * final[j, b]
                    down[a, b] += value
                    up[b, a] += value


@jit
def rim_point(rod: Any, q: Any, at: int, xi: float, root: Any, moved: Any, by: Any) -> float:
    """Displacement of a point of the rim, its derivatives, and the rotation of the ring there.

    Parameters
    ----------
    at : int
        Part of the point; -1 over the weld, where no part moves it.
    xi : float
        Where in the part, 0..1.
    root : (2, 6) array
        What it moves besides by the strains of the first and the last part; of points near the weld.
    moved : (2,) array
    by : (2, 18) array
        By the coordinates of the sections at - 1 to at + 2, then of the first and the last free one; both filled in.
    """
    moved[:] = 0.0
    by[:] = 0.0
    turn = 0.0
    if at >= 0:
        _follow_part(rod, q, at, xi, moved, by)
        turn = (1 - xi) * q[at, 2] + xi * q[at + 1, 2]
    last = rod.local.shape[0] - 1
    if at <= 0 or at == last:
        _follow_root(rod, q, at, xi, turn, root, moved, by)
    return turn


@jit
def _follow_root(rod: Any, q: Any, at: int, xi: float, turn: float, root: Any, moved: Any, by: Any) -> None:
    """Add what a point near the weld moves besides, turned with the ring."""
    c, s = cos(turn), sin(turn)
    ways = np.empty((3, 6))
    add1, add2 = 0.0, 0.0
    for end in range(2):
        t1, t2, now, strain = _chord(rod, q, 0 if end == 0 else rod.local.shape[0] - 1)
        _directions(t1, t2, now, ways)
        for i in range(3):
            r1, r2 = root[0, 3 * end + i], root[1, 3 * end + i]
            g1, g2 = c * r1 - s * r2, s * r1 + c * r2
            add1 += g1 * strain[i]
            add2 += g2 * strain[i]
            for k in range(3):
                way = ways[i, 3 + k] if end == 0 else ways[i, k]
                by[0, 12 + 3 * end + k] += g1 * way
                by[1, 12 + 3 * end + k] += g2 * way
    moved[0] += add1
    moved[1] += add2
    if at >= 0:
        by[0, 5] -= (1 - xi) * add2
        by[1, 5] += (1 - xi) * add1
        by[0, 8] -= xi * add2
        by[1, 8] += xi * add1


@jit
def _follow_part(rod: Any, q: Any, at: int, xi: float, moved: Any, by: Any) -> None:
    """Add what a point moves with the sections around it."""
    width = rod.theta[at + 1] - rod.theta[at]
    for side in range(2):
        i = at + side
        x = xi if side == 0 else 1 - xi
        value = (1 - x) * (1 - x) * (1 + 2 * x)
        slope = x * (1 - x) * (1 - x) * (width if side == 0 else -width)
        c, s = cos(rod.theta[i]), sin(rod.theta[i])
        turn = q[i, 2]
        ct, st, less = cos(turn), sin(turn), 2 * sin(turn / 2) ** 2
        out1, out2 = c * ct - s * st, s * ct + c * st  # the section's outward direction now
        bend = bending(rod, q, i)
        stretch, thinner = rod.offset * bend, rod.pinch * bend
        moved[0] += value * (q[i, 0] + rod.offset * (-c * less - s * st) - thinner * out1) + slope * (
            s * less - c * st - stretch * out2
        )
        moved[1] += value * (q[i, 1] + rod.offset * (-s * less + c * st) - thinner * out2) + slope * (
            -c * less - s * st + stretch * out1
        )
        k = 3 + 3 * side
        by[0, k] += value
        by[1, k + 1] += value
        lever, along = value * (rod.offset - thinner), slope * (1 + stretch)
        by[0, k + 2] += -lever * out2 - along * out1
        by[1, k + 2] += lever * out1 - along * out2
        inward, sideward = value * rod.pinch, slope * rod.offset
        for near in range(3):
            weight = rod.curve[i, near]
            by[0, k - 1 + 3 * near] -= weight * (sideward * out2 + inward * out1)
            by[1, k - 1 + 3 * near] += weight * (sideward * out1 - inward * out2)


@jit
def bending(rod: Any, q: Any, i: int) -> float:
    """dphi/dtheta at a section; none at the weld."""
    if i == 0 or i == rod.theta.shape[0] - 1:
        return 0.0
    return rod.curve[i, 0] * q[i - 1, 2] + rod.curve[i, 1] * q[i, 2] + rod.curve[i, 2] * q[i + 1, 2]


@jit
def rim_curvature(rod: Any, q: Any, at: int, xi: float, f1: float, f2: float, second: Any) -> None:
    """Add second derivatives, (12, 12), of a point's displacement times a force on it, ``root`` left out."""
    if at < 0:
        return
    width = rod.theta[at + 1] - rod.theta[at]
    for side in range(2):
        i = at + side
        x = xi if side == 0 else 1 - xi
        value = (1 - x) * (1 - x) * (1 + 2 * x)
        slope = x * (1 - x) * (1 - x) * (width if side == 0 else -width)
        c, s = cos(rod.theta[i] + q[i, 2]), sin(rod.theta[i] + q[i, 2])
        outward, sideward = f1 * c + f2 * s, f2 * c - f1 * s
        k, bend = 5 + 3 * side, bending(rod, q, i)
        second[k, k] -= value * (rod.offset - rod.pinch * bend) * outward + slope * (1 + rod.offset * bend) * sideward
        across = value * rod.pinch * sideward + slope * rod.offset * outward
        for near in range(3):
            second[k, k - 3 + 3 * near] -= across * rod.curve[i, near]
            second[k - 3 + 3 * near, k] -= across * rod.curve[i, near]


@jit
def follow(rod: Any, q: Any, nodes: Any) -> Any:
    """Displacement of rim nodes by the sections, (m, 2), derivatives (m, 2, 18), rotation of the ring there (m,)."""
    m = nodes.part.shape[0]
    moved, by, turn = np.empty((m, 2)), np.empty((m, 2, 18)), np.empty(m)
    for k in range(m):
        turn[k] = rim_point(rod, q, nodes.part[k], nodes.xi[k], nodes.root[k], moved[k], by[k])
    return moved, by, turn
