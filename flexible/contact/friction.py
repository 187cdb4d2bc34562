"""Bristles: the tangential forces of points in contact, by either law of friction.

Each point carries a bristle of stiffness eps_t. It enters the patch unstrained, at the instant of the step at which its
gap, a parabola in time, crosses zero, and then follows its point along the floor. ``STICK``: it does so without a
limit. ``SLIDE``: mu N is shared over the patch like the pressure. ``BRUSH``: a bristle breaks at mu_s p and slides at
mu p.
"""

from __future__ import annotations

from collections import namedtuple
from math import cos, sin, sqrt
from typing import Any

import numpy as np

from rigid.kernel.compile import jit

from .normal import force_by_gaps

STICK, SLIDE_RIGHT, SLIDE_LEFT, BRUSH = 0, 1, -1, 2  # SLIDE_RIGHT: friction pushes the hoop to the right (spinning)

Bristles = namedtuple(
    "Bristles",
    [
        "stretch",  # of each point's bristle
        "rate",  # its derivative by the point's abscissa,
        "by_gap",  # by the point's gap and
        "by_phi",  # by phi, through the instant of entry
        "touched",  # whether the point has touched the floor in this visit
        "sliding",  # direction in which friction pushes a sliding point, 0 while it sticks
        "way",  # along the floor since the step began or the point touched, rolling included
        "mean",  # what the patch as a whole has slipped in that time
        "pull",  # tangential force on the point when the step began
    ],
)

Tractions = namedtuple(
    "Tractions",
    [
        "force",  # tangential force of each point
        "share",  # its derivative by the damping factor eta of the pressures, or by the patch's drag
        "by_abscissa",
        "by_phi",
        "by_gap",  # (n, 5), by the gaps of two points before, the point, two points behind
        "energy",  # of all bristles
        "stuck",  # length of the patch that sticks
        "sliding",  # what the bristles of a sliding patch pull in all, and
        "held",  # what they would pull had their feet stayed where they were when the step began
    ],
)


@jit
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


@jit
def carry(
    points: Any,
    kept: Any,
    flags: Any,
    dphi: float,
    ratio: float,
    start: float,
    slip: float,
    slip_start: float,
    brush: bool,
) -> Any:
    """Bristles of ``points``: those kept from the beginning of the step, moved on, and those that entered since.

    The way of a point that entered is that of rolling, plus a parabola in time that ends with the velocity of the
    stage, ``ratio (move - start)`` over the stage's length: a long step then sees the slip at its end and not its mean,
    which would leave the friction of a short patch undamped. ``slip`` and ``slip_start`` are those of the whole patch.
    """
    total = points.gap.shape[0]
    stretch, rate = np.zeros(total), np.zeros(total)
    by_gap, by_phi = np.zeros(total), np.zeros(total)
    touched, sliding = np.zeros(total, np.bool_), np.zeros(total, np.int8)
    way, mean, pull = np.zeros(total), np.zeros(total), np.zeros(total)
    slip_ending = ratio * (slip - slip_start)
    p = 0
    for i in range(total):
        j, move = points.number[i], points.move[i]
        while p < kept.shape[0] and kept[p, 0] < j:
            p += 1
        if p < kept.shape[0] and kept[p, 0] == j:
            touched[i] = True
            way[i], mean[i], pull[i] = move + points.rolled[i], slip, kept[p, 2]
            stretch[i] = kept[p, 1] + way[i]
            rate[i] = 1.0
            sliding[i] = flags[p]
            continue
        fraction, d_gap, d_sweep = _entry(max(points.gap_old[i], 0.0), points.gap[i], dphi * dphi)
        if fraction >= 0:
            touched[i] = True
            rest = 1 - fraction
            ending = ratio * (move - start)
            psi = points.psi[i]
            psi_in = psi - rest * dphi
            lift, lift_in = 2 * sin(psi / 2) ** 2, 2 * sin(psi_in / 2) ** 2
            rolled = rest * dphi - 2 * cos((psi + psi_in) / 2) * sin(rest * dphi / 2)
            way[i] = stretch[i] = rolled + rest * (ending - (ending - move) * rest)
            mean[i] = rest * (slip_ending - (slip_ending - slip) * rest)
            rate[i] = rest * (ratio - (ratio - 1) * rest)
            by_fraction = -(ending - 2 * (ending - move) * rest) - lift_in * dphi
            by_gap[i] = by_fraction * d_gap
            by_phi[i] = by_fraction * d_sweep * 2 * dphi + (1 - rate[i]) * lift - (1 - rest) * lift_in
            if brush and flags.shape[0] > 0:  # a point that enters behind a sliding edge goes on sliding
                sliding[i] = flags[0] if j < kept[0, 0] else flags[-1]
    return Bristles(stretch, rate, by_gap, by_phi, touched, sliding, way, mean, pull)


@jit
def edge_of_patch(g_in: float, g_out: float, inner: float) -> tuple[float, float, float, float]:
    """How far from a point on the floor to the next the patch reaches, 0..1, and its derivatives by the three gaps.

    The gap is the parabola through the points before, at and behind the edge. A straight line would misplace the edge
    by up to an eighth of a cell's share of the patch, in a rhythm with the points, and there the bristles pull most.
    """
    bend = (g_out - 2 * g_in + inner) / 2
    rise = g_out - g_in - bend
    slope = sqrt(rise * rise - 4 * bend * g_in)
    f = -2 * g_in / (rise + slope)
    return f, -(1 - f) * (1 + f) / slope, -f * (1 + f) / 2 / slope, f * (1 - f) / 2 / slope


@jit
def _weights(points: Any, bristles: Any, spacing: float, mode: int) -> tuple[Any, Any]:
    """Length of patch that belongs to each point, and its derivatives by the gaps of (n, 5) points around it."""
    brush, sticks = mode == BRUSH, mode == STICK
    gap = points.gap
    total = gap.shape[0]
    weight, by = np.zeros(total), np.zeros((total, 5))
    for i in range(total - 1):
        if points.last[i] or (gap[i] >= 0 and gap[i + 1] >= 0):
            continue
        if gap[i] < 0 and gap[i + 1] < 0:
            weight[i] += spacing / 2
            weight[i + 1] += spacing / 2
            continue
        inside, outside = (i, i + 1) if gap[i] < 0 else (i + 1, i)
        way = outside - inside
        inner = inside - way
        # a brush pulls nothing at its edges, and is held to the pressure, which ends on a straight gap
        if not brush and 0 <= inner < total and not points.last[min(inner, inside)]:
            f, f_in, f_out, f_inner = edge_of_patch(gap[inside], gap[outside], gap[inner])
        else:
            d = gap[outside] - gap[inside]
            f, f_in, f_out, f_inner = -gap[inside] / d, -gap[outside] / d**2, gap[inside] / d**2, 0.0
        if sticks and bristles.touched[outside]:  # an edge that points leave: bristles stay stretched up to it
            weight[inside] += spacing * (f - f * f / 2)
            weight[outside] += spacing * f * f / 2
            by[inside, 2] += spacing * (1 - f) * f_in
            by[inside, 2 + way] += spacing * (1 - f) * f_out
            by[inside, 2 - way] += spacing * (1 - f) * f_inner
            by[outside, 2] += spacing * f * f_out
            by[outside, 2 - way] += spacing * f * f_in
            by[outside, 2 - 2 * way] += spacing * f * f_inner
        else:
            weight[inside] += spacing * f / 2
            by[inside, 2] += spacing * f_in / 2
            by[inside, 2 + way] += spacing * f_out / 2
            by[inside, 2 - way] += spacing * f_inner / 2
    return weight, by


@jit
def rub(
    points: Any, foundation: Any, bristles: Any, mode: int, eta: float, spacing: float, eps_n: float, eps_t: float,
    mu_s: float, mu: float,
) -> Any:  # fmt: skip
    """Tangential forces; stretches and directions of ``bristles`` are brought up to date in place."""
    total = points.gap.shape[0]
    stretch, sliding = bristles.stretch, bristles.sliding
    weight, weight_by = _weights(points, bristles, spacing, mode)
    # friction that slides is shared like the foundation's forces; bristles that take it over pull as much in all
    lumped = -eps_n * (weight * np.minimum(points.gap, 0.0)).sum()
    even = foundation.force.sum() / lumped if lumped > 0 else 1.0
    force, share = np.zeros(total), np.zeros(total)
    by_abscissa, by_phi, by_gap = np.zeros(total), np.zeros(total), np.zeros((total, 5))
    energy, stuck, held, pulled = 0.0, 0.0, 0.0, 0.0
    for i in range(total):
        pressure = -eps_n * min(points.gap[i], 0.0)
        if mode == SLIDE_RIGHT or mode == SLIDE_LEFT:
            before = i - 1 if i > 0 and not points.last[i - 1] else -1
            behind = i + 1 if i + 1 < total and not points.last[i] else -1
            share[i] = mode * mu * foundation.force[i]
            force[i] = eta * share[i]
            force_by_gaps(by_gap[i, 1:4], eta * mode * mu, foundation, before, i, behind)
            held -= weight[i] * eps_t * stretch[i]
            # what a damper adds to the pressure is no spring: bristles that held it would give it back when they stick
            stretch[i] = -min(eta, 1.0) * even * mode * mu * pressure / eps_t
            pulled -= weight[i] * eps_t * stretch[i]
            energy += weight[i] * eps_t * stretch[i] ** 2 / 2
        elif weight[i] != 0:
            limit = (mu if sliding[i] != 0 else mu_s) * eta * pressure
            if mode == BRUSH and abs(eps_t * stretch[i]) > limit:
                sliding[i] = 1 if stretch[i] < 0 else -1
                share[i] = weight[i] * sliding[i] * mu * pressure
                traction = sliding[i] * mu * eta * pressure
                stretch[i] = -traction / eps_t
                by_gap[i, 2] = -weight[i] * sliding[i] * mu * eta * eps_n
            else:
                sliding[i] = 0
                traction = -eps_t * stretch[i]
                by_abscissa[i] = -eps_t * weight[i] * bristles.rate[i]
                by_gap[i, 2] = -eps_t * weight[i] * bristles.by_gap[i]
                by_phi[i] = -eps_t * weight[i] * bristles.by_phi[i]
                stuck += weight[i]
            force[i] = weight[i] * traction
            for q in range(5):
                by_gap[i, q] += traction * weight_by[i, q]
            energy += weight[i] * traction**2 / (2 * eps_t)
    return Tractions(force, share, by_abscissa, by_phi, by_gap, energy, stuck, pulled, held)
