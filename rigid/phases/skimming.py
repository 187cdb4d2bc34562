"""A point mass in free fall over a massless hoop, which skims under it without a force.

Its height says the angle. A tiny disk has N of the sign of 1 - cos phi phidot^2: where that is 0 the hoop is thrown
off, which ends the motion, for a hoop without inertia turns in flight as it likes.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import asin, inf, sqrt

from ..kernel.angle import trig
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    ANGLE,
    FIRST_PULSE,
    HITS_FLOOR,
    IMPACT,
    LIFTED,
    MODE,
    MU,
    OMEGA,
    PHASE_OVER,
    PULSE_OVER,
    SLIP,
    T_END,
    TIME_REACHED,
    TOP,
    TURNS_REACHED,
    UNTIL,
    WHOLE,
    X_C,
    XDOT,
    T,
)
from ..record.events import turn
from ..record.pulse import watch
from .pointmass import holds

JUST_NOW = 1e-7  # a slip that begins is 0 no sooner again


@kernel
def skim(par, state, events):
    """The point mass in free fall, the massless hoop skimming under it without a force, to the turn or to
    the floor.
    """
    if watch(par, state, 0.0, events) and par[UNTIL] == FIRST_PULSE:
        return PULSE_OVER
    a, top, omega = state[ANGLE], state[TOP], state[OMEGA]
    s, c, h, low = trig(a, top)
    ydot = -s * omega
    # height h + ydot t - t^2/2: to the floor, and to where it is thrown off, cos phi phidot^2 = 1, if it rises so high
    to_floor = ydot + sqrt(ydot * ydot + 2 * h)
    to_lift = inf
    over = ydot * ydot - 2 * low
    if c * omega * omega > 1.0:
        to_lift = 0.0
    elif ydot > 0 and over >= 0.0:
        rise = max(low - 0.5 * (sqrt(over * (over + 4)) - over), 0.0)
        to_lift = 2 * rise / (ydot + sqrt(ydot * ydot - 2 * rise))
    to_turn = ydot if ydot > 0 else inf
    to_stop, to_catch = until_slip_stops(par, state), until_caught(par, state)
    time = min(to_floor, to_lift, to_turn, to_stop, to_catch)
    reason = PHASE_OVER
    if state[T] + time >= par[T_END]:
        time, reason = par[T_END] - state[T], TIME_REACHED
    elif time == to_stop:
        drop(state, time)
        state[SLIP] = 0.0
        return PHASE_OVER
    elif time == to_catch:
        drop(state, time)
        state[MODE] = IMPACT
        return PHASE_OVER
    elif time == to_lift:
        reason = LIFTED
    elif time == to_floor:
        reason = HITS_FLOOR
    drop(state, time)
    if reason == PHASE_OVER:
        state[OMEGA] = 0.0
        if turn(par, state, events):
            return TURNS_REACHED
    elif reason == TIME_REACHED:
        state[T] = par[T_END]
    return reason


@kernel
def until_slip_stops(par, state):
    """Time to where a skimming hoop has no slip and rolls on, infinite without one.

    With tau since the mass is (or was, or would be) highest, at h = H, v = xdot - sgn(s) tau sqrt(h/(2 - h)) and
    h = H - tau^2/2: a quadratic in tau^2.
    """
    s, _c, h, low = trig(state[ANGLE], state[TOP])
    ydot, xdot = -s * state[OMEGA], state[XDOT]
    highest, under = h + 0.5 * ydot * ydot, low - 0.5 * ydot * ydot  # of the floor, and of the top: H and 2 - H
    half = highest - 0.5 * xdot * xdot
    root = half * half - 2 * xdot * xdot * under
    if root < 0.0 or half <= 0.0:
        return inf
    large = half + sqrt(root)
    found = inf
    for z in (large, 2 * xdot * xdot * under / large):
        tau = sqrt(max(z, 0.0))
        time = ydot + (tau if xdot * s > 0.0 else -tau)
        if time <= (JUST_NOW if state[SLIP] == 0.0 else 0.0) or time >= found:
            continue
        then = highest - 0.5 * z
        across = sqrt(max(then * (under + 0.5 * z), 0.0))
        if across > 0.0 and holds(par, across, then, (time - ydot) / across):
            found = time
    return found


@kernel
def until_caught(par, state):
    """Time to where a skimming hoop that comes up is as steep as mu and slips down that slope, infinite if never."""
    s, _c, h, _low = trig(state[ANGLE], state[TOP])
    ydot, mu = -s * state[OMEGA], par[MU]
    steep = 2 / (1 + mu * mu)
    left = ydot * ydot - 2 * (steep - h)
    if mu == 0.0 or ydot <= 0.0 or h >= steep or left < 0.0:
        return inf
    time = ydot - sqrt(left)
    slip = state[XDOT] - (time - ydot) * (1 / mu if s > 0.0 else -1 / mu)
    return time if slip * s < 0.0 else inf


@kernel
def skimming_acceleration(omega, a, top):
    """phiddot of the falling point mass, from d^2(cos phi)/dt^2 = -1; 0, as :func:`drop` has it for phidot, right on
    top and at the floor, where it has no finite value.
    """
    s, c, _, _ = trig(a, top)
    return (1 - c * omega * omega) / s if s != 0.0 else 0.0


@kernel
def drop(state, time):
    """Advance a skimming point mass."""
    a, top, whole, omega = state[ANGLE], state[TOP], state[WHOLE], state[OMEGA]
    s, _c, h, low = trig(a, top)
    xdot = state[XDOT]
    ydot = -s * omega
    fall = ydot * time - 0.5 * time * time
    # the side of the hoop does not change on the way
    right = s > 0 or (s == 0.0 and (omega > 0) == (top != 0.0))
    h1, low1 = max(h + fall, 0.0), max(low - fall, 0.0)
    if h1 <= 1.0:
        offset, top1 = 2 * asin(sqrt(0.5 * h1)), 0.0
    else:
        offset, top1 = 2 * asin(sqrt(0.5 * low1)), 1.0
    # phi in (0, pi) on the right, (pi, 2 pi) on the left of the hoop
    turns = whole
    if top != 0.0 and not right:
        turns = whole - 1.0
    if top1 == 0.0:
        a1, whole1 = (-offset if right else offset), turns
    else:
        a1 = offset if right else -offset
        whole1 = turns if right else turns + 1.0
    s1, _, _, _ = trig(a1, top1)
    v_y = ydot - time
    state[OMEGA] = -v_y / s1 if s1 != 0.0 else 0.0
    state[X_C] += xdot * time - (s1 - s)
    state[SLIP] = xdot - state[OMEGA] * h1
    state[ANGLE], state[TOP], state[WHOLE] = a1, top1, whole1
    state[T] += time
