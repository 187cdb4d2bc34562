"""The rim of the chain at the floor: how it follows the sections, gives way, and passes on what it is pushed with.

    u = U(q) + Q S Q^T f,

f the floor's forces on the rim's nodes, S the compliance that the chain lacks and Q the rotation of the ring at each
node. The forces act where the rim then is, so that they turn the ring by their lever Q S Q^T f as well: what the floor
does to the rim arrives at the ring.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import jit, loop, part

from ..contact.newton import FRAME
from .rim import RimNodes, follow, rim_curvature

Array = NDArray[np.float64]


class Facing(NamedTuple):
    """What a chain answers to the floor near which it is.

    Attributes
    ----------
    rim : flexible.contact.points.data.Rim
    nodes : RimNodes
        Of these elements, m of them.
    missing : (2 m, 2 m) array
        Their compliance that the chain lacks.
    """

    rim: Any
    nodes: RimNodes
    missing: Array


class Touch(NamedTuple):
    """How the rim's nodes follow the core's frame and sections, c unknowns, and give way to the floor.

    Attributes
    ----------
    follow : (2 m, c) array
        Derivatives of U.
    turning : (m, c) array
        Of the rotation of the ring there.
    lever : (m, 2) array
        u - U.
    yields : (2 m, 2 m) array
        Q S Q^T.
    """

    follow: Array
    turning: Array
    lever: Array
    yields: Array


@jit
def turned(missing: Any, rows: Any, columns: Any) -> Any:
    """Q S Q^T for rotations of the nodes."""
    result = np.empty(missing.shape)
    cc, sc = np.empty(columns.shape[0]), np.empty(columns.shape[0])
    for j in range(columns.shape[0]):
        cc[j], sc[j] = cos(columns[j]), sin(columns[j])
    for i in range(rows.shape[0]):
        cr, sr = cos(rows[i]), sin(rows[i])
        for j in range(columns.shape[0]):
            a, b = missing[2 * i, 2 * j], missing[2 * i, 2 * j + 1]
            c, d = missing[2 * i + 1, 2 * j], missing[2 * i + 1, 2 * j + 1]
            e, f = cr * a - sr * c, cr * b - sr * d
            g, h = sr * a + cr * c, sr * b + cr * d
            result[2 * i, 2 * j], result[2 * i, 2 * j + 1] = e * cc[j] - f * sc[j], e * sc[j] + f * cc[j]
            result[2 * i + 1, 2 * j], result[2 * i + 1, 2 * j + 1] = g * cc[j] - h * sc[j], g * sc[j] + h * cc[j]
    return result


@part
def kept_by(count: int, part: Any) -> tuple[Any, Any]:
    """Flags of the sections that nodes follow and of the first one, and where each stands in the core.

    Nodes near the weld follow the first and the last section.
    """
    keeps, place = np.zeros(count, np.bool_), np.full(count, -1)
    keeps[1] = True
    for k in range(part.shape[0]):
        if part[k] >= 0:
            for i in range(max(part[k] - 1, 1), min(part[k] + 3, count - 1)):
                keeps[i] = True
        if part[k] <= 0 or part[k] == count - 2:
            keeps[count - 2] = True
    at = FRAME
    for i in range(count):
        if keeps[i]:
            place[i] = at
            at += 3
    return keeps, place


@part
def touch_of(rod: Any, q: Any, facing: Facing, place: Any, size: int, u: Any) -> Touch:
    """The rim at the floor, for sections at ``q`` and nodes at ``u``; ``place`` of the sections in the core."""
    part, xi = facing.nodes.part, facing.nodes.xi
    moved, by, turn = follow(rod, q, facing.nodes)
    m = part.shape[0]
    follows, turning = np.zeros((2 * m, size)), np.zeros((m, size))
    for k in range(m):
        for slot in range(6):
            i = part[k] - 1 + slot
            if slot == 4:
                i = 1
            elif slot == 5:
                i = place.shape[0] - 2
            elif part[k] < 0:
                continue
            if i < 1 or i >= place.shape[0] or place[i] < 0:
                continue
            for a in range(3):
                follows[2 * k, place[i] + a] += by[k, 0, 3 * slot + a]
                follows[2 * k + 1, place[i] + a] += by[k, 1, 3 * slot + a]
            if slot == 1:
                turning[k, place[i] + 2] = 1 - xi[k]
            elif slot == 2:
                turning[k, place[i] + 2] = xi[k]
    lever = np.empty((m, 2))
    for k in range(m):
        lever[k, 0], lever[k, 1] = u[k, 0] - moved[k, 0], u[k, 1] - moved[k, 1]
    return Touch(follows, turning, lever, turned(facing.missing, turn, turn))


@loop
def push(touch: Touch, contact: Any, place: Any, frame: Any, force: Any) -> None:
    """Take the floor's forces from those of frame and sections: on the nodes, and at the lever that they have."""
    m = touch.lever.shape[0]
    for a in range(FRAME):
        frame[a] -= contact.force[a]
    for i in range(place.shape[0]):
        if place[i] < 0:
            continue
        for a in range(3):
            at = place[i] + a
            for k in range(m):
                f1, f2 = contact.nodal[k, 0], contact.nodal[k, 1]
                moment = touch.lever[k, 0] * f2 - touch.lever[k, 1] * f1
                force[i, a] -= touch.follow[2 * k, at] * f1 + touch.follow[2 * k + 1, at] * f2
                force[i, a] -= touch.turning[k, at] * moment


@part
def astray_of(touch: Touch, nodal: Any, scale: float) -> Any:
    """How far the nodes are from where their forces bring them, u - U - Q S Q^T f, (2 m,)."""
    m = nodal.shape[0]
    rest = np.empty(2 * m)
    for i in range(2 * m):
        value = touch.lever[i // 2, i % 2]
        for k in range(m):
            value -= touch.yields[i, 2 * k] * nodal[k, 0] + touch.yields[i, 2 * k + 1] * nodal[k, 1]
        rest[i] = scale * value
    return rest


@loop
def _take_products(core: Any, by: Any, tangent: Any) -> None:
    """Take ``by``, (c, 2 m), times the derivatives of the nodes' forces by frame and nodes."""
    nodal, inner = by.shape[1], core.shape[0] - by.shape[1]
    for k in range(nodal):
        acts = False
        for j in range(tangent.shape[1]):
            acts = acts or tangent[FRAME + k, j] != 0
        if not acts:  # most nodes of a wide window are off the floor
            continue
        for i in range(by.shape[0]):
            weight = by[i, k]
            if weight == 0:  # most sections move but a few of the nodes
                continue
            for j in range(FRAME):
                core[i, j] -= weight * tangent[FRAME + k, j]
            for j in range(nodal):
                core[i, inner + j] -= weight * tangent[FRAME + k, FRAME + j]


@part
def add_forces(core: Any, touch: Touch, nodal: Any, tangent: Any, scale: float) -> None:
    """Derivatives of what :func:`push` and :func:`astray_of` take, through the floor's forces and their levers."""
    m = nodal.shape[0]
    inner = core.shape[0] - 2 * m
    acting = np.empty((core.shape[0], 2 * m))
    for k in range(m):
        for a in range(inner):
            acting[a, 2 * k] = touch.follow[2 * k, a] - touch.lever[k, 1] * touch.turning[k, a]
            acting[a, 2 * k + 1] = touch.follow[2 * k + 1, a] + touch.lever[k, 0] * touch.turning[k, a]
    for i in range(2 * m):
        for k in range(2 * m):
            acting[inner + i, k] = scale * touch.yields[i, k]
    for i in range(FRAME):
        for j in range(FRAME):
            core[i, j] -= tangent[i, j]
        for j in range(2 * m):
            core[i, inner + j] -= tangent[i, FRAME + j]
    _take_products(core, acting, tangent)
    for k in range(m):
        f1, f2 = nodal[k, 0], nodal[k, 1]
        for a in range(inner):
            turn = touch.turning[k, a]
            if turn != 0:
                core[a, inner + 2 * k] -= turn * f2
                core[a, inner + 2 * k + 1] += turn * f1
                for b in range(inner):
                    core[a, b] += turn * (f2 * touch.follow[2 * k, b] - f1 * touch.follow[2 * k + 1, b])


@part
def add_bending(core: Any, rod: Any, q: Any, nodes: Any, place: Any, nodal: Any) -> None:
    """Derivatives of what the nodes' ways pull at the sections under constant forces."""
    second = np.zeros((12, 12))
    for k in range(nodal.shape[0]):
        part = nodes.part[k]
        if part < 0 or (nodal[k, 0] == 0 and nodal[k, 1] == 0):
            continue
        second[:] = 0.0
        rim_curvature(rod, q, part, nodes.xi[k], nodal[k, 0], nodal[k, 1], second)
        for i in range(4):
            for j in range(4):
                one, two = part - 1 + i, part - 1 + j
                if min(one, two) < 1 or max(one, two) >= place.shape[0] or place[one] < 0 or place[two] < 0:
                    continue
                core[place[one] + 2, place[two] + 2] -= second[3 * i + 2, 3 * j + 2]


@part
def add_rim(core: Any, touch: Touch, nodal: Any, scale: float) -> None:
    """Derivatives of :func:`astray_of` under constant forces."""
    m = nodal.shape[0]
    inner = core.shape[0] - 2 * m
    pulled = touch.yields
    by_turn = np.empty((2 * m, m))
    for i in range(2 * m):
        core[inner + i, inner + i] += scale
        for k in range(m):
            by_turn[i, k] = pulled[i, 2 * k + 1] * nodal[k, 0] - pulled[i, 2 * k] * nodal[k, 1]
    for k in range(m):
        by_turn[2 * k, k] += touch.lever[k, 1]
        by_turn[2 * k + 1, k] -= touch.lever[k, 0]
    for i in range(2 * m):
        for a in range(FRAME, inner):
            core[inner + i, a] -= scale * touch.follow[i, a]
    for k in range(m):
        for a in range(FRAME, inner):
            turn = scale * touch.turning[k, a]
            if turn != 0:
                for i in range(2 * m):
                    core[inner + i, a] += by_turn[i, k] * turn
