"""The outer rim, which follows the sections of the chain, in compiled code.

Between two sections it is a cubic (Hermite) through the points of the rim that the two sections carry, with
the directions and the stretch of the rim there: C1 all around, at any rotation. Its stretch is that of bending, offset
times dphi/dtheta by three sections, and with it the wall gets thinner.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import jit, loop

from .rod.corotated import chord, outward

Array = NDArray[np.float64]


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


@loop
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
    for a in range(2):
        moved[a] = 0.0
        for i in range(18):
            by[a, i] = 0.0
    turn = 0.0
    if at >= 0:
        _follow_part(rod, q, at, xi, moved, by)
        turn = (1 - xi) * q[at, 2] + xi * q[at + 1, 2]
    last = rod.local.shape[0] - 1
    if at < rod.rooted or at > last - rod.rooted:
        _follow_root(rod, q, at, xi, turn, root, moved, by)
    return turn


@loop
def _follow_root(rod: Any, q: Any, at: int, xi: float, turn: float, root: Any, moved: Any, by: Any) -> None:
    """Add what a point near the weld moves besides, turned with the ring."""
    c, s = cos(turn), sin(turn)
    add1, add2 = 0.0, 0.0
    for end in range(2):
        t1, t2, now, e, tau_1, tau_2 = chord(rod, q, 0 if end == 0 else rod.local.shape[0] - 1)
        for i in range(3):
            r1, r2 = root[0, 3 * end + i], root[1, 3 * end + i]
            g1, g2 = c * r1 - s * r2, s * r1 + c * r2
            strain = e if i == 0 else (tau_1 if i == 1 else tau_2)
            add1 += g1 * strain
            add2 += g2 * strain
            for k in range(3):
                way = outward(t1, t2, now, end, i, k)
                by[0, 12 + 3 * end + k] += g1 * way
                by[1, 12 + 3 * end + k] += g2 * way
    moved[0] += add1
    moved[1] += add2
    if at >= 0:
        by[0, 5] -= (1 - xi) * add2
        by[1, 5] += (1 - xi) * add1
        by[0, 8] -= xi * add2
        by[1, 8] += xi * add1


@loop
def _follow_part(rod: Any, q: Any, at: int, xi: float, moved: Any, by: Any) -> None:
    """Add what a point moves with the sections around it."""
    width = rod.theta[at + 1] - rod.theta[at]
    for side in range(2):
        i = at + side
        x = xi if side == 0 else 1 - xi
        value = (1 - x) * (1 - x) * (1 + 2 * x)
        slope = x * (1 - x) * (1 - x) * (width if side == 0 else -width)
        c, s = rod.place[i, 0] / (1 - rod.offset), rod.place[i, 1] / (1 - rod.offset)
        half, co_half = sin(q[i, 2] / 2), cos(q[i, 2] / 2)
        less, st = 2 * half * half, 2 * half * co_half
        ct = 1 - less
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


@loop
def bending(rod: Any, q: Any, i: int) -> float:
    """dphi/dtheta at a section; none at the weld."""
    if i == 0 or i == rod.theta.shape[0] - 1:
        return 0.0
    return rod.curve[i, 0] * q[i - 1, 2] + rod.curve[i, 1] * q[i, 2] + rod.curve[i, 2] * q[i + 1, 2]


@loop
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
    _follow(rod, q, nodes, moved, by, turn)
    return moved, by, turn


@loop
def _follow(rod: Any, q: Any, nodes: Any, moved: Any, by: Any, turn: Any) -> None:
    for k in range(turn.shape[0]):
        turn[k] = rim_point(rod, q, nodes.part[k], nodes.xi[k], nodes.root[k], moved[k], by[k])
