"""Material points of the rim near the floor: which of them touch, where they are, how they moved since the step began.

Points lie ``spacing`` apart in the material angle theta; point j is at ``theta = j spacing``, counted round and round.
A point's angle from the bottom is ``psi = phi + theta - pi``; its displacement is interpolated on the quadratic rim.
"""

from __future__ import annotations

from math import ceil, cos, floor, pi, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import loop

from .data import Before, Rim
from .dent import NO_ELEMENT, displaced, next_dent, raised, through_dent
from .rim import element_at, gap_at, lift, shape_functions, shape_slopes, sideways, upward, vertex_angle

TURNED_ON = 8  # points to one whose sine and cosine are computed: as many roundings


@loop
def _lowest(height: float, psi_start: float, width: float, y0: float, y1: float, y2: float) -> tuple[float, float]:
    """Where in an element, 0..1, the gap is least, and how large it is there."""
    c1, c2 = -3 * y0 + 4 * y1 - y2, 2 * y0 - 4 * y1 + 2 * y2
    base = height + y0
    at_start = base + lift(psi_start)
    at_end = base + c1 + c2 + lift(psi_start + width)
    lowest = min(max(-psi_start / width, 0.0), 1.0)
    for _ in range(5):
        slope = width * sin(psi_start + lowest * width) + c1 + 2 * c2 * lowest
        curvature = width**2 * cos(psi_start + lowest * width) + 2 * c2
        if curvature <= 0:
            lowest = 0.0 if at_start < at_end else 1.0
            break
        last, lowest = lowest, min(max(lowest - slope / curvature, 0.0), 1.0)
        if lowest == last:  # as a rule at an end of the element
            break
    return lowest, base + c1 * lowest + c2 * lowest**2 + lift(psi_start + lowest * width)


@loop
def _touching(height: float, psi_start: float, width: float, y0: float, y1: float, y2: float) -> tuple[float, float]:
    """Part [low, high] of an element, in 0..1, where the gap is negative; low > high when there is none."""
    c1, c2 = -3 * y0 + 4 * y1 - y2, 2 * y0 - 4 * y1 + 2 * y2
    base = height + y0
    at_start = base + lift(psi_start)
    at_end = base + c1 + c2 + lift(psi_start + width)
    lowest, bottom = _lowest(height, psi_start, width, y0, y1, y2)
    if min(bottom, at_start, at_end) >= 0:
        return 1.0, 0.0
    low, high = 0.0, 1.0
    curvature = width**2 * cos(psi_start + lowest * width) + 2 * c2
    for side in range(2):
        end_gap = at_start if side == 0 else at_end
        if end_gap < 0 or curvature <= 0:
            continue
        far = float(side)
        s = lowest + (2 * side - 1) * sqrt(max(-2 * bottom, 0.0) / curvature)
        for _ in range(3):
            s = min(max(s, 0.0), 1.0)
            value = base + c1 * s + c2 * s**2 + lift(psi_start + s * width)
            slope = width * sin(psi_start + s * width) + c1 + 2 * c2 * s
            if slope * (far - lowest) <= 0:
                break
            s -= value / slope
        s = min(max(s, 0.0), 1.0)
        if side == 0:
            low = s
        else:
            high = s
    return low, high


@loop
def least_gap(height: float, phi: float, u: Any, rim: Rim) -> float:
    """The least gap of a window of rim elements."""
    s, c = sin(phi), cos(phi)
    least = np.inf
    for i in range((u.shape[0] - 1) // 2):
        start = vertex_angle(rim.vertex, rim.first + i)
        width = vertex_angle(rim.vertex, rim.first + i + 1) - start
        k = 2 * i
        y0, y1, y2 = (
            upward(u[k, 0], u[k, 1], s, c),
            upward(u[k + 1, 0], u[k + 1, 1], s, c),
            upward(u[k + 2, 0], u[k + 2, 1], s, c),
        )
        least = min(least, _lowest(height, phi - pi + start, width, y0, y1, y2)[1])
    return least


@loop
def find(pose: Any, u: Any, rim: Rim, spacing: float, ranges: Any) -> tuple[int, int]:
    """Ranges of points that touch or border on a touching one, merged, as rows (first, last).

    Returns
    -------
    ranged, total : int
        How many there are, and how many points are in them.
    """
    height, phi = pose[1], pose[2]
    s, c = sin(phi), cos(phi)
    first, vertex = rim.first, rim.vertex
    n = 0
    for i in range(ranges.shape[0]):
        start = vertex_angle(vertex, first + i)
        width = vertex_angle(vertex, first + i + 1) - start
        k = 2 * i
        y0, y1, y2 = (
            upward(u[k, 0], u[k, 1], s, c),
            upward(u[k + 1, 0], u[k + 1, 1], s, c),
            upward(u[k + 2, 0], u[k + 2, 1], s, c),
        )
        low, high = _touching(height, phi - pi + start, width, y0, y1, y2)
        if low > high:
            continue
        j_low = int(ceil((start + low * width) / spacing)) - 1
        j_high = int(floor((start + high * width) / spacing)) + 1
        # the edges are estimates: the range must begin and end with a point off the floor, or with the element
        first_point, last_point = int(ceil(start / spacing)) - 1, int(floor((start + width) / spacing)) + 1
        for side in range(2):
            j, end, way = (j_low, first_point, -1) if side == 0 else (j_high, last_point, 1)
            while way * (end - j) > 0:
                x = (j * spacing - start) / width
                rise = y0 + x * (-3 * y0 + 4 * y1 - y2 + x * (2 * y0 - 4 * y1 + 2 * y2))
                if gap_at(height, phi - pi + j * spacing, rise) >= 0:
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
    total = 0
    for r in range(n):
        total += ranges[r, 1] - ranges[r, 0] + 1
    return n, total


class Points(NamedTuple):
    """Points that touch, and their neighbours on both sides, as arrays of one length; ascending."""

    number: Any  # of the point
    last: Any  # whether the next point in the list is not its neighbour
    local: Any  # first node of its element in the window
    shape: Any  # (n, 3) interpolation on the element's nodes
    onward: Any  # (n, 3) what of ``carried`` the displacements of these nodes have now
    arm_x: Any  # derivative of the gap by phi
    arm_y: Any  # derivative of the abscissa by phi
    gap: Any  # over the floor, negative in contact
    gap_old: Any  # at the beginning of the step
    move: Any  # along the floor since then, but for
    rolled: Any  # what the rigid circle's rolling alone would move it, psi - sin(psi) now less then
    psi: Any  # angle from the bottom
    sine: Any  # of psi
    lifted: Any  # height of the undeformed circle there over its lowest point
    dented: Any  # sideways displacement of the rim there when the step began: of another point of it
    slope: Any  # its derivative by psi
    carried: Any  # way along that dent, and along the rim as it is now, that stands for the point's in the step,
    bend: Any  # and its derivative by phi, the slope of the dent left out
    shift: Any  # what of ``move`` is not the way through that dent
    then: Any  # gap at this angle from the bottom when the step began: of another point of the rim
    slant: Any  # its derivative by psi


@loop
def place(
    points: Points, ranges: Any, ranged: int, pose: Any, u: Any, rim: Rim, spacing: float, before: Before
) -> bool:  # fmt: skip
    """Fill in the points of so many ranges; whether the window of rim elements is too short for them."""
    number, last, local, shape, onward, arm_x, arm_y, gap, gap_old, move, rolled, angle, sines, lifted = points[:14]
    dents, slope, carried, bend, shift, then, slant = points[14:]
    first, vertex, count = rim.first, rim.vertex, (u.shape[0] - 1) // 2
    old_pose, u_old = before.pose, before.u
    height, phi, phi_old = pose[1], pose[2], old_pose[2]
    s, c, s_old, c_old = sin(phi), cos(phi), sin(phi_old), cos(phi_old)
    dv, dphi = pose[0] - old_pose[0], phi - phi_old
    outside, dent = False, NO_ELEMENT
    # sines and cosines of psi/2 give all others; as they are what a point costs, most are turned on from the last ones
    s_turn, c_turn, s_half, c_half = sin(dphi / 2), cos(dphi / 2), sin(dphi / 4), cos(dphi / 4)
    s_next, c_next, sine, cosine = sin(spacing / 2), cos(spacing / 2), 0.0, 1.0
    rolls = dphi - 2 * s_turn
    m = 0
    for r in range(ranged):
        element = min(max(element_at(vertex, ranges[r, 0] * spacing), first), first + count - 1)
        start, end = vertex_angle(vertex, element), vertex_angle(vertex, element + 1)
        for j in range(ranges[r, 0], ranges[r, 1] + 1):
            theta = j * spacing
            while theta >= end and element < first + count - 1:
                element += 1
                start, end = end, vertex_angle(vertex, element + 1)
            xi = (theta - start) / (end - start)
            outside = outside or xi < -1e-9 or xi > 1 + 1e-9
            k = 2 * (element - first)
            n0, n1, n2 = shape_functions(xi)
            u1 = n0 * u[k, 0] + n1 * u[k + 1, 0] + n2 * u[k + 2, 0]
            u2 = n0 * u[k, 1] + n1 * u[k + 1, 1] + n2 * u[k + 2, 1]
            v1 = n0 * u_old[k, 0] + n1 * u_old[k + 1, 0] + n2 * u_old[k + 2, 0]
            v2 = n0 * u_old[k, 1] + n1 * u_old[k + 1, 1] + n2 * u_old[k + 2, 1]
            ux, uy = sideways(u1, u2, s, c), upward(u1, u2, s, c)
            psi = phi - pi + theta
            if (j - ranges[r, 0]) % TURNED_ON == 0:
                sine, cosine = sin(psi / 2), cos(psi / 2)
            else:
                sine, cosine = sine * c_next + cosine * s_next, cosine * c_next - sine * s_next
            lifted[m], lifted_old = 2 * sine**2, 2 * (sine * c_turn - cosine * s_turn) ** 2
            number[m], local[m] = j, k
            shape[m, 0], shape[m, 1], shape[m, 2] = n0, n1, n2
            gap[m] = height + lifted[m] + uy
            gap_old[m] = old_pose[1] + lifted_old + upward(v1, v2, s_old, c_old)
            angle[m], sines[m] = psi, 2 * sine * cosine
            arm_x[m], arm_y[m] = sines[m] - ux, lifted[m] + uy
            rolled[m] = rolls + 4 * s_turn * (sine * c_half - cosine * s_half) ** 2
            move[m] = dv + ux - sideways(v1, v2, s_old, c_old)
            shift[m] = move[m]
            if before.dent.shape[0] > 0:
                there = theta + dphi
                dent = next_dent(dent, before, rim, there)
                dents[m], slope[m] = displaced(dent, there)
                carried[m], bend[m] = through_dent(dent, before, rim, there, dphi, spacing)
                if before.halves > 0:
                    d0, d1, d2 = shape_slopes(xi, end - start)
                    s1 = d0 * u[k, 0] + d1 * u[k + 1, 0] + d2 * u[k + 2, 0]
                    s2 = d0 * u[k, 1] + d1 * u[k + 1, 1] + d2 * u[k + 2, 1]
                    by_turn = sideways(s1, s2, s, c)
                    more = dphi * by_turn - carried[m]
                    by_turn += dphi * upward(s1, s2, s, c) - bend[m] - slope[m]
                    carried[m] += before.halves * more
                    bend[m] += before.halves * by_turn
                    share = before.halves * dphi
                    onward[m, 0], onward[m, 1], onward[m, 2] = share * d0, share * d1, share * d2
                    high, climb = raised(dent, there)
                    then[m], slant[m] = old_pose[1] + lifted[m] + high, sines[m] + climb
                shift[m] = dv + ux - dents[m]
            m += 1
        last[m - 1] = 1
    return outside
