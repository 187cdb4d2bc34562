"""The way of a patch along the floor in a step: that of its points, of which the slip velocity is the rate."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np

from rigid.kernel.compile import loop

from .assembly import X, Y, gather, spread
from .points.data import Before, Parameters, Rim
from .points.normal import press, sum_by_gaps
from .points.rim import gap_at, lift, sideways, upward, vertex_angle
from .room import SCRATCH, WAY, Room, earlier_in, foundation_in, points_in
from .vectors import dot, total


@loop
def way_over_the_floor(pose: Any, u: Any, rim: Rim, before: Before) -> float:
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


@loop
def weigh_slip(room: Room, law: Parameters, elastic: float, halves: float) -> None:
    """Fill in the weights of the points in the mean way of the patch, and the foundation where they are as it was."""
    points, foundation, earlier = points_in(room), foundation_in(room, 0.0, 0.0), earlier_in(room)
    weights, was = room.rows[SCRATCH], 0.0
    if halves > 0:
        press(points.then, points.last, law.eps_n, law.spacing, earlier)
        was = total(earlier.force)
    for i in range(weights.shape[0]):
        weights[i] = foundation.force[i] / elastic
        if was > 0:
            weights[i] += halves * (earlier.force[i] / was - weights[i])


@loop
def differentiate_way(room: Room, elastic: float, s: float, c: float, dphi: float, halves: float) -> None:
    """Fill in the derivative of the mean way, whose weights are known."""
    points, foundation, earlier = points_in(room), foundation_in(room, 0.0, 0.0), earlier_in(room)
    bases, slip_by, weights, by_gap = room.bases, room.unknowns[WAY], room.rows[SCRATCH], room.rows[SCRATCH + 1]
    gather(points, weights, 1.0, room.fives[0], bases[5])
    if halves > 0:
        for i in range(weights.shape[0]):
            for q in range(3):  # along the rim as it is now
                bases[5, 2 + points.local[i] + q] += weights[i] * points.onward[i, q]
    spread(bases[5], X, s, c, slip_by)
    slip_by[2] += dphi * dot(weights, points.sine) + dot(weights, points.bend)
    # through the normal forces, which weigh the mean slip
    was, now, then = total(earlier.force), 0.0, 0.0
    for i in range(weights.shape[0]):
        weights[i] = points.shift[i] + dphi * points.lifted[i] + points.carried[i]
        now += foundation.force[i] * weights[i] / elastic
        then += earlier.force[i] * weights[i]
    share = halves if was > 0 else 0.0
    for i in range(weights.shape[0]):
        weights[i] = (1 - share) * (weights[i] - now) / elastic
    sum_by_gaps(weights, foundation, by_gap)
    gather(points, by_gap, 1.0, room.fives[1], bases[4])
    spread(bases[4], Y, s, c, slip_by)
    if share > 0:
        for i in range(weights.shape[0]):
            weights[i] = share * (weights[i] * elastic / (1 - share) + now - then / was) / was
        sum_by_gaps(weights, earlier, by_gap)
        slip_by[2] += dot(by_gap, points.slant)
