"""The outer rim, which follows the sections of the chain, in compiled code.

Between two sections it is a cubic (Hermite) through the points of the rim that the two sections carry, with
the directions and the stretch of the rim there: C1 all around, at any rotation. Its stretch is that of bending, offset
times dphi/dtheta by three sections, and with it the wall gets thinner; what pull and shear do besides is in ``seen``
(:mod:`flexible.chain.rod.surface`).
"""

from __future__ import annotations

from math import cos, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import jit, loop

from .rod.corotated import chord, outward
from .rod.surface import ONWARD, OUTWARD, SLOPE, STRETCH

Array = NDArray[np.float64]


class RimNodes(NamedTuple):
    """Nodes of the rim, and what they follow; see :func:`rim_point`.

    Attributes
    ----------
    part : (m,) int array
    xi : (m,) array
    root : (m, 2, 6) array
    bow : (m, 2, 2, 3, 3) array
    """

    part: NDArray[np.int64]
    xi: Array
    root: Array
    bow: Array


@loop
def rim_point(rod: Any, q: Any, at: int, xi: float, beside: Any, chords: Any, moved: Any, by: Any) -> float:
    """Displacement of a point of the rim, its derivatives, and the rotation of the ring there.

    Parameters
    ----------
    at : int
        Part of the point; -1 over the weld, where no part moves it.
    xi : float
        Where in the part, 0..1.
    beside : tuple
        What it moves besides by the strains of the first and the last part, of points near the weld: (2, 6); and to
        second order by either part's, second derivatives (2, 2, 3, 3).
    chords : (3, 6) array
        Of the parts around, see :func:`chords_around`.
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
        _follow_part(rod, q, at, xi, chords, moved, by)
        turn = (1 - xi) * q[at, 2] + xi * q[at + 1, 2]
    last = rod.local.shape[0] - 1
    if at < rod.rooted or at > last - rod.rooted:
        _follow_root(rod, q, at, xi, turn, beside, moved, by)
    return turn


@loop
def _follow_root(rod: Any, q: Any, at: int, xi: float, turn: float, beside: Any, moved: Any, by: Any) -> None:
    """Add what a point near the weld moves besides, turned with the ring."""
    root, bow = beside
    c, s = cos(turn), sin(turn)
    add1, add2 = 0.0, 0.0
    for end in range(2):
        t1, t2, now, e, tau_1, tau_2 = chord(rod, q, 0 if end == 0 else rod.local.shape[0] - 1)
        for i in range(3):
            r1, r2 = root[0, 3 * end + i], root[1, 3 * end + i]
            b1 = bow[0, end, i, 0] * e + bow[0, end, i, 1] * tau_1 + bow[0, end, i, 2] * tau_2
            b2 = bow[1, end, i, 0] * e + bow[1, end, i, 1] * tau_1 + bow[1, end, i, 2] * tau_2
            strain = e if i == 0 else (tau_1 if i == 1 else tau_2)
            add1 += (c * (r1 + b1 / 2) - s * (r2 + b2 / 2)) * strain
            add2 += (s * (r1 + b1 / 2) + c * (r2 + b2 / 2)) * strain
            g1, g2 = c * (r1 + b1) - s * (r2 + b2), s * (r1 + b1) + c * (r2 + b2)
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
def _cubic(x: float, width: float) -> tuple[float, float]:
    """Weights of a value and a slope at one end of a cubic over ``width``, of which ``x`` is the share from there."""
    return (1 - x) * (1 - x) * (1 + 2 * x), x * (1 - x) * (1 - x) * width


@loop
def _bent(rod: Any, at: int, x: float, width: float) -> tuple[float, float]:
    """The same of what bending makes of the rim at a section: beside the weld it reaches no farther than behind it."""
    reach = rod.reach if at == 0 or at == rod.local.shape[0] - 1 else 1.0
    return _cubic(min(x / reach, 1.0), reach * width)


@loop
def _follow_part(rod: Any, q: Any, at: int, xi: float, chords: Any, moved: Any, by: Any) -> None:
    """Add what a point moves with the sections around it."""
    width = rod.theta[at + 1] - rod.theta[at]
    for side in range(2):
        i = at + side
        x, reaching = (xi, width) if side == 0 else (1 - xi, -width)
        (value, slope), (thins, stretches) = _cubic(x, reaching), _bent(rod, at, x, reaching)
        c, s = rod.place[i, 0] / (1 - rod.offset), rod.place[i, 1] / (1 - rod.offset)
        half, co_half = sin(q[i, 2] / 2), cos(q[i, 2] / 2)
        less, st = 2 * half * half, 2 * half * co_half
        ct = 1 - less
        out1, out2 = c * ct - s * st, s * ct + c * st  # the section's outward direction now
        bend = bending(rod, q, i)
        stretch, thinner = rod.offset * bend, rod.pinch * bend
        moved[0] += value * (q[i, 0] + rod.offset * (-c * less - s * st)) + slope * (s * less - c * st)
        moved[1] += value * (q[i, 1] + rod.offset * (-s * less + c * st)) + slope * (-c * less - s * st)
        moved[0] -= thins * thinner * out1 + stretches * stretch * out2
        moved[1] -= thins * thinner * out2 - stretches * stretch * out1
        k = 3 + 3 * side
        by[0, k] += value
        by[1, k + 1] += value
        lever, along = value * rod.offset - thins * thinner, slope + stretches * stretch
        by[0, k + 2] += -lever * out2 - along * out1
        by[1, k + 2] += lever * out1 - along * out2
        inward, sideward = thins * rod.pinch, stretches * rod.offset
        for near in range(3):
            weight = rod.curve[i, near]
            by[0, k - 1 + 3 * near] -= weight * (sideward * out2 + inward * out1)
            by[1, k - 1 + 3 * near] += weight * (sideward * out1 - inward * out2)
        _show_strains(rod, at, side, (thins, stretches, out1, out2), chords, moved, by)


@loop
def _show_strains(rod: Any, at: int, side: int, weights: Any, chords: Any, moved: Any, by: Any) -> None:
    """Add what the rim has at a section of the strains of the two parts there."""
    i = at + side
    if i == 0 or i == rod.theta.shape[0] - 1:
        return
    value, slope, out1, out2 = weights
    outward_by, onward_by = 0.0, 0.0
    for behind in range(2):
        seen, k, first = rod.seen[i, behind], side + behind, 3 * (side + behind)
        t1, t2, share = chords[k, 0], chords[k, 1], 1 / chords[k, 2]
        turn1, turn2 = 0.0, 0.0  # by the chord's own turning
        for m in range(3):
            out = value * seen[OUTWARD, m] + slope * seen[SLOPE, m]
            on = value * seen[ONWARD, m] + slope * seen[STRETCH, m]
            outward_by += out * chords[k, 3 + m]
            onward_by += on * chords[k, 3 + m]
            g1, g2 = out * out1 - on * out2, out * out2 + on * out1
            if m == 0:
                w11, w12, w21, w22 = g1 * t1, g1 * t2, g2 * t1, g2 * t2
            else:
                turn1 += g1
                turn2 += g2
                by[0, first + 3 * m - 1] += g1
                by[1, first + 3 * m - 1] += g2
        turn1, turn2 = turn1 * share, turn2 * share
        w11, w12, w21, w22 = w11 + turn1 * t2, w12 - turn1 * t1, w21 + turn2 * t2, w22 - turn2 * t1
        by[0, first] -= w11
        by[0, first + 1] -= w12
        by[1, first] -= w21
        by[1, first + 1] -= w22
        by[0, first + 3] += w11
        by[0, first + 4] += w12
        by[1, first + 3] += w21
        by[1, first + 4] += w22
    moved[0] += outward_by * out1 - onward_by * out2
    moved[1] += outward_by * out2 + onward_by * out1
    by[0, 5 + 3 * side] -= outward_by * out2 + onward_by * out1
    by[1, 5 + 3 * side] += outward_by * out1 - onward_by * out2


@loop
def bending(rod: Any, q: Any, i: int) -> float:
    """dphi/dtheta at a section; none at the weld."""
    if i == 0 or i == rod.theta.shape[0] - 1:
        return 0.0
    return rod.curve[i, 0] * q[i - 1, 2] + rod.curve[i, 1] * q[i, 2] + rod.curve[i, 2] * q[i + 1, 2]


@loop
def rim_curvature(rod: Any, q: Any, at: int, xi: float, f1: float, f2: float, second: Any) -> None:
    """Add second derivatives, (12, 12), of a point's displacement times a force on it, less ``root`` and ``seen``."""
    if at < 0:
        return
    width = rod.theta[at + 1] - rod.theta[at]
    for side in range(2):
        i = at + side
        x, reaching = (xi, width) if side == 0 else (1 - xi, -width)
        (value, slope), (thins, stretches) = _cubic(x, reaching), _bent(rod, at, x, reaching)
        c, s = cos(rod.theta[i] + q[i, 2]), sin(rod.theta[i] + q[i, 2])
        outward, sideward = f1 * c + f2 * s, f2 * c - f1 * s
        k, bend = 5 + 3 * side, bending(rod, q, i)
        second[k, k] -= (value * rod.offset - thins * rod.pinch * bend) * outward
        second[k, k] -= (slope + stretches * rod.offset * bend) * sideward
        across = thins * rod.pinch * sideward + stretches * rod.offset * outward
        for near in range(3):
            second[k, k - 3 + 3 * near] -= across * rod.curve[i, near]
            second[k - 3 + 3 * near, k] -= across * rod.curve[i, near]


@loop
def chords_around(rod: Any, q: Any, at: int, chords: Any) -> None:
    """Fill in :func:`flexible.chain.rod.corotated.chord` of a part and of those beside it, as many as there are."""
    for k in range(3):
        if 0 <= at - 1 + k < rod.local.shape[0]:
            found = chord(rod, q, at - 1 + k)
            for j in range(6):
                chords[k, j] = found[j]


@jit
def follow(rod: Any, q: Any, nodes: Any) -> Any:
    """Displacement of rim nodes by the sections, (m, 2), derivatives (m, 2, 18), rotation of the ring there (m,)."""
    m = nodes.part.shape[0]
    moved, by, turn = np.empty((m, 2)), np.empty((m, 2, 18)), np.empty(m)
    _follow(rod, q, nodes, np.empty((3, 6)), moved, by, turn)
    return moved, by, turn


@loop
def _follow(rod: Any, q: Any, nodes: Any, chords: Any, moved: Any, by: Any, turn: Any) -> None:
    for k in range(turn.shape[0]):
        if k == 0 or nodes.part[k] != nodes.part[k - 1]:
            chords_around(rod, q, nodes.part[k], chords)
        beside = nodes.root[k], nodes.bow[k]
        turn[k] = rim_point(rod, q, nodes.part[k], nodes.xi[k], beside, chords, moved[k], by[k])
