"""When in a step a point of the rim touched the floor, and where."""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import NamedTuple

from rigid.kernel.compile import loop

from .rim import lift

MOST_STEPS = 64  # steps of Newton and halves to an entry; three as a rule
ENTERS = 1e-9  # of a step: Newton's last change to the instant of an entry, whose error is then its square


class Point(NamedTuple):
    """A point that may have touched: numbers, since to hand over arrays costs more than all that is done with them."""

    gap_old: float
    gap: float
    psi: float
    sine: float
    lifted: float


class Entry(NamedTuple):
    """When a point touched, and where."""

    rest: float  # fraction of the step since then, negative where it never touched
    psi: float  # angle from the bottom at which it did
    lifted: float  # height of the undeformed circle there over its lowest point
    by_gap: float  # derivatives of the fraction by the new gap and by phi
    by_phi: float
    speed: float  # of the angle against the fraction
    shift: float  # derivative of that angle by phi, the fraction fixed


@loop
def entry_of(point: Point, dphi: float, turn: float, ratio: float) -> Entry:
    """When a point that was off the floor when the step began touched.

    Its angle is the parabola in time that ends with ``turn`` a step: over a step in which the whole patch is renewed a
    constant rate would misplace all entries by as much as phidot changes, and the creep with them. What of the gap is
    not the circle's is linear in time.
    """
    never = Entry(-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    g_old, g_new, psi, lifted = max(point.gap_old, 0.0), point.gap, point.psi, point.lifted
    a = dphi * dphi / 2
    b = g_new - g_old - a
    disc = b * b - 4 * a * g_old
    if disc <= 0 or b >= 0:
        return never
    s = 1 - 2 * g_old / (sqrt(disc) - b)
    if s <= 0:
        return never
    bend = turn - dphi
    own = g_old - g_new - (lift(psi - dphi) - lifted)
    low, high, step = 0.0, 1.0, 1.0
    for _ in range(MOST_STEPS):
        angle = psi - turn * s + bend * s * s
        speed = -turn + 2 * bend * s
        half, other = sin(angle / 2), cos(angle / 2)
        slope = 2 * half * other * speed + own
        if abs(step) < ENTERS:
            break
        gap = g_new + (2 * half * half - lifted) + own * s
        if gap < 0 and s < 1:  # the step began above the floor, by whatever rounding makes of that
            low = s
        else:
            high = s
        ahead = s - gap / slope if slope > 0 else -1.0
        if not low <= ahead <= high:  # where phidot turns round, the first guess may be far from the parabola's touch
            if low == 0 and g_new >= 0:
                return never
            ahead = (low + high) / 2
        step, s = s - ahead, ahead
    if slope <= 0:
        return never
    shift = 1 - ratio * s + (ratio - 1) * s * s
    by_phi = -(2 * half * other * shift - (1 - s) * point.sine) / slope
    return Entry(s, angle, 2 * half * half, -(1 - s) / slope, by_phi, speed, shift)
