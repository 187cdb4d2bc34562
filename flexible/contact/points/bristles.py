"""Bristles: what points in contact carry along the floor, whatever the friction law makes of it.

Each point carries a bristle of stiffness eps_t. It enters the patch unstrained, at the instant of the step at which its
gap, a parabola in time, crosses zero, and then follows its point along the floor.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import jit, loop

from .data import Before, Bristles, Damper, Parameters, PointForces, Resultants, Rim, Slip
from .dent import dent_at, displaced, next_dent
from .entry import Point, entry_of

SHALLOW = 1 / 64  # of the square of the points' distance: a spot of the rim less deep lets go of its bristles


class Carried(NamedTuple):
    """The bristles of all points at hand at the end of a step."""

    stretch: Any  # of each point's bristle
    rate: Any  # its derivative by the point's abscissa,
    by_gap: Any  # by the point's gap and
    by_phi: Any  # by phi, through the instant of entry, and
    by_way: Any  # by the mean way of the patch
    touched: Any  # whether the point has touched the floor in this visit
    sliding: Any  # direction in which friction pushes a sliding point, 0 while it sticks, twice it while it rests
    way: Any  # along the floor since the step began or the point touched, rolling included
    mean: Any  # what the patch as a whole has slipped in that time
    pull: Any  # tangential force on the point when the step began


@loop
def carry(
    carried: Carried, points: Any, before: Before, rim: Rim, dphi: float, damper: Damper, slip: Slip, moved: float
) -> None:
    """Fill in the bristles of ``points``: those kept from the beginning of the step, moved on, and those that entered.

    The way of a point that entered is that of rolling; that of the patch as a whole, ``moved`` without the rolling, a
    parabola in time that ends with the velocity of the stage: a long step then sees the slip at its end and not its
    mean, which would leave the friction of a short patch undamped; and how much farther the dent took it, evenly in
    time. Were that a part of the parabola, friction would be off by as much as the step is long wherever the dent
    changes. A point that enters behind a sliding edge goes on sliding.
    """
    stretch, rate, by_gap, by_phi, by_way, touched, sliding, way, mean, pull = carried
    bristles = before.bristles
    number, flags = bristles.number, bristles.sliding
    ratio, turn = damper.ratio, damper.turning_0 + damper.ratio * dphi
    slip_ending = ratio * (slip.way - slip.way_0)
    patch_ending = slip_ending - (slip.way - moved)
    p, dent = 0, dent_at(before, rim, pi - before.pose[2])
    for i in range(stretch.shape[0]):
        j, move = points.number[i], points.move[i]
        while p < number.shape[0] and number[p] < j:
            p += 1
        if p < number.shape[0] and number[p] == j:
            touched[i] = True
            way[i], mean[i], pull[i] = move + points.rolled[i], slip.way, bristles.pull[p]
            stretch[i] = bristles.stretch[p] + way[i]
            rate[i] = 1.0
            sliding[i] = flags[p]
            continue
        point = Point(points.gap_old[i], points.gap[i], points.psi[i], points.sine[i], points.lifted[i])
        entry = entry_of(point, dphi, turn, ratio)
        rest, psi_in = entry.rest, entry.psi
        if rest >= 0:
            touched[i] = True
            theta_in = pi + psi_in - before.pose[2]
            dent = next_dent(dent, before, rim, theta_in)
            dent_in, slope_in = displaced(dent, theta_in)
            shift = points.shift[i]
            ending = patch_ending + (shift - moved)
            psi = points.psi[i]
            lifted, lifted_in = points.lifted[i] + points.slope[i], entry.lifted + slope_in
            rolled = psi - psi_in - 2 * cos((psi + psi_in) / 2) * sin((psi - psi_in) / 2)
            rolled += points.dented[i] - dent_in
            way[i] = stretch[i] = rolled + rest * (ending - (ending - shift) * rest)
            mean[i] = rest * (slip_ending - (slip_ending - slip.way) * rest)
            rate[i], by_way[i] = rest, rest * (1 - rest) * (ratio - 1)
            by_rest = ending - 2 * (ending - shift) * rest - lifted_in * entry.speed
            by_gap[i] = by_rest * entry.by_gap
            by_phi[i] = by_rest * entry.by_phi + (1 - rate[i]) * lifted - entry.shift * lifted_in
            if flags.shape[0] > 0:
                edge = flags[0] if j < number[0] else flags[-1]
                sliding[i] = edge if abs(edge) == 1 else 0


@jit
def edge_of_patch(g_in: float, g_out: float, inner: float) -> tuple[float, float, float, float]:
    """How far from a point on the floor to the next the patch reaches, 0..1, and its derivatives by the three gaps.

    The gap is the parabola through the points before, at and behind the edge. A straight line would misplace the edge
    by up to an eighth of a cell's share of the patch, in a rhythm with the points, and there the bristles pull most.
    Where the ``inner`` point is less deep than the one at the edge, a patch of two points or one, the parabola is the
    less bent the less deep it is: the second root of that of a single point is somewhere in the next cell still as the
    point leaves the floor, and what lay between would let go all at once.
    """
    bend = (g_out - 2 * g_in + inner) / 2
    share = min(max(inner / g_in, 0.0), 1.0)
    rise = g_out - g_in - share * bend
    slope = sqrt(rise * rise - 4 * share * bend * g_in)
    f = -2 * g_in / (rise + slope)
    over = f * (1 - f) / slope  # derivative by how much the gap is bent
    by_in, by_out, by_inner = -(1 - f) / slope - over * share, over * share / 2 - f / slope, over * share / 2
    if 0 < share < 1:
        by_in -= over * bend * share / g_in
        by_inner += over * bend / g_in
    return f, by_in, by_out, by_inner


@loop
def _deepest(points: Any, i: int) -> int:
    """Of the two points of a cell and their neighbours."""
    gap, last, deepest = points.gap, points.last, i
    if i > 0 and not last[i - 1] and gap[i - 1] < gap[deepest]:
        deepest = i - 1
    if gap[i + 1] < gap[deepest]:
        deepest = i + 1
    if i + 2 < gap.shape[0] and not last[i + 1] and gap[i + 2] < gap[deepest]:
        deepest = i + 2
    return deepest


@loop
def weigh(forces: PointForces, points: Any, carried: Any, spacing: float, curved: bool, sticks: bool) -> None:
    """Fill in the length of patch that belongs to each point, and its derivatives by the gaps of points around it.

    ``curved`` puts the edge on the gap's parabola; a friction that ends with the pressure ends where that does, on a
    straight gap. Where all of the patch ``sticks``, bristles stay stretched up to where points leave. How much of a
    cell lies on the floor is anything where both its points are about to leave, however little they press, and
    bristles stretched by the rest of the patch would hold it there with any force: such a spot lets go of them with
    its depth.
    """
    weight, by = forces.weight, forces.weight_by
    gap = points.gap
    total = gap.shape[0]
    held = SHALLOW * spacing * spacing
    for i in range(total - 1):
        if points.last[i] or (gap[i] >= 0 and gap[i + 1] >= 0):
            continue
        deepest, unit = i, spacing
        if sticks:
            deepest = _deepest(points, i)
            unit *= min(-gap[deepest] / held, 1.0)
        known, known_next = weight[i], weight[i + 1]
        inside, outside = (i, i + 1) if gap[i] < 0 else (i + 1, i)
        way = outside - inside
        inner = inside - way
        if gap[i] < 0 and gap[i + 1] < 0:
            weight[i] += unit / 2
            weight[i + 1] += unit / 2
        else:
            if curved and 0 <= inner < total and not points.last[min(inner, inside)]:
                f, f_in, f_out, f_inner = edge_of_patch(gap[inside], gap[outside], gap[inner])
            else:
                d = gap[outside] - gap[inside]
                f, f_in, f_out, f_inner = -gap[inside] / d, -gap[outside] / d**2, gap[inside] / d**2, 0.0
            if sticks and carried.touched[outside]:  # an edge that points leave: bristles stay stretched up to it
                weight[inside] += unit * (f - f * f / 2)
                weight[outside] += unit * f * f / 2
                by[inside, 2] += unit * (1 - f) * f_in
                by[inside, 2 + way] += unit * (1 - f) * f_out
                by[inside, 2 - way] += unit * (1 - f) * f_inner
                by[outside, 2] += unit * f * f_out
                by[outside, 2 - way] += unit * f * f_in
                by[outside, 2 - 2 * way] += unit * f * f_inner
            else:
                weight[inside] += unit * f / 2
                by[inside, 2] += unit * f_in / 2
                by[inside, 2 + way] += unit * f_out / 2
                by[inside, 2 - way] += unit * f_inner / 2
        if unit < spacing:
            by[i, 2 + deepest - i] += (weight[i] - known) / gap[deepest]
            by[i + 1, 1 + deepest - i] += (weight[i + 1] - known_next) / gap[deepest]


@loop
def keep_touching(keeps: Any, gap: Any) -> None:
    """Mark the points below the floor."""
    for i in range(keeps.shape[0]):
        keeps[i] = gap[i] < 0


@loop
def cling(forces: Any, carried: Any, i: int, eps_t: float) -> float:
    """Traction of a point that sticks; what it answers to its abscissa, gap and phi is written down."""
    weight = forces.weight[i]
    forces.by_abscissa[i] = -eps_t * weight * carried.rate[i]
    forces.by_gap[i, 2] = -eps_t * weight * carried.by_gap[i]
    forces.by_phi[i] = -eps_t * weight * carried.by_phi[i]
    forces.by_way[i] = -eps_t * weight * carried.by_way[i]
    return -eps_t * carried.stretch[i]


@loop
def add_pull(forces: Any, i: int, traction: float) -> None:
    """Add a point's traction on the length of patch that belongs to it."""
    forces.force[i] = forces.weight[i] * traction
    for q in range(5):
        forces.by_gap[i, q] += traction * forces.weight_by[i, q]


@loop
def drag_of(parameters: Parameters, length: float, relaxation: float) -> float:
    """Force of the damper of a sticking patch over its slip velocity: it slows bristles as it slows the pressure."""
    return relaxation * parameters.eps_t * length


def rolled_in(
    bristles: Bristles, parameters: Parameters, res: Resultants, phi: float, omega: float, drag: float = 0.0
) -> tuple[Bristles, float]:
    """Bristles of a patch that has long been rolling under its friction, and the creep velocity that keeps them so.

    They are stretched in proportion to the way from the leading edge, to just past the trailing one; alike at rest.
    What a damper drags with, ``drag`` times the creep, they need not pull.
    """
    length = res.high - res.low + parameters.spacing
    eps_t = parameters.eps_t
    if omega == 0:
        return bristles._replace(stretch=np.full(len(bristles.stretch), -res.friction / (eps_t * length))), 0.0
    at = len(bristles.number) if omega > 0 else 0
    past = bristles.number[-1] + 1 if omega > 0 else bristles.number[0] - 1
    number = np.insert(bristles.number, at, past)
    pull = np.insert(bristles.pull, at, 0.0)
    psi = phi - pi + number * parameters.spacing
    way = psi - res.low if omega > 0 else res.high - psi
    creep = -res.friction / (eps_t * length**2 / 2 / abs(omega) + drag)
    stretch = creep * way / abs(omega)
    return Bristles(number, stretch, pull, np.zeros(len(number), np.int8)), creep
