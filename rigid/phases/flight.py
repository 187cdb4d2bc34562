"""Off the floor: G falls on a parabola, phidot is constant, and the next touch-down is found without
stepping over it.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import cos, inf, pi, sin, sqrt

from ..kernel.angle import chart, trig
from ..kernel.compile import kernel
from ..kernel.layout import ANGLE, ECC, GAP, OMEGA, ONE_MINUS_E, SLIP, TOP, UN, WHOLE, X_C, XDOT, YDOT, T


@kernel
def height(e, gap, un, omega, s, c, time):
    """Height of the lowest point and its rate after ``time`` of flight."""
    half = 0.5 * omega * time
    sh = sin(half)
    ch = sin(0.5 * pi - half)
    # cos(phi + 2 half) - cos phi and sin(phi + 2 half) without cancellation for short flights
    dc = -2 * sh * (s * ch + c * sh)
    ds = 2 * sh * (c * ch - s * sh)
    ydot = un - e * s * omega
    return gap + ydot * time - 0.5 * time * time - e * dc, un - time + e * omega * ds


@kernel
def lifts(e, omega, s, c):
    """Whether the contact point leaves the floor by itself: e c phidot^2 > 1, (and growing, where it equals
    1 to round-off).
    """
    w = omega * omega
    curve = e * c * w - 1
    if abs(curve) <= 1e-14 * (1 + e * w):
        return s * omega < 0
    return curve > 0


@kernel
def touch_down(e, gap, un, omega, a, top):
    """Time until the contact point is back on the floor; inf never happens under gravity.

    |gap''| <= 1 + e phidot^2 =: B makes gap + gap' dt - B dt^2/2 a lower bound: its zero is a step that
    cannot pass a touch-down. Above 1 + e the disk's side of the hoop cannot reach the floor, so that part of
    the parabola is skipped.
    """
    s, c, _, _ = trig(a, top)
    w = omega * omega
    bound = 1 + e * w
    jolt = e * w * abs(omega)  # no less than |gap'''|
    time = 0.0
    if gap <= 0.0 and un <= 0.0:
        curve = e * c * w - 1
        jerk = -e * s * w * omega
        if curve > 1e-14 * bound:
            # gap'' > 0 for as long, and where it grows for as long as it does: at a lift-off curve itself is round-off
            time = min(1.0, max(curve / jolt, jerk / (e * w * w)))
        elif jerk > 0.0:
            time = min(1.0, jerk / (e * w * w))
        else:
            return 0.0
    y_g = gap + 1 + e * c
    ydot = un - e * s * omega
    for _ in range(2000):
        y, rate = height(e, gap, un, omega, s, c, time)
        clear = y_g + ydot * time - 0.5 * time * time - (1 + e)
        fall = ydot - time
        if clear > 1e-12 * (1.0 + time * time):
            time += (
                (fall + sqrt(fall * fall + 2 * clear))
                if fall > 0
                else 2 * clear / (sqrt(fall * fall + 2 * clear) - fall)
            )
            # the parabola is down at 1 + e
            continue
        if y <= 0.0 and time > 0.0:
            break
        root = sqrt(rate * rate + 2 * bound * max(y, 0.0))
        step = (rate + root) / bound if rate > 0 else 2 * y / (root - rate)
        if y > 0.0:
            # near the top, where the rotation all but carries the hoop, gap'' is far below its bound, and steps by that
            # would be without number: here gap falls by a third of itself at most by each of its derivatives
            safe = (2 * y / jolt) ** (1 / 3) if jolt > 0.0 else inf
            curve = e * w * (c * cos(omega * time) - s * sin(omega * time)) - 1
            if rate < 0.0:
                safe = min(safe, -y / (3 * rate))
            if curve < 0.0:
                safe = min(safe, sqrt(-2 * y / (3 * curve)))
            if safe < inf:
                step = max(step, safe)
        if not step > 4e-16 * time:
            break
        time += step
    return time


@kernel
def fly(par, state, time):
    """Advance a state in flight."""
    e, omega, a, top = par[ECC], state[OMEGA], state[ANGLE], state[TOP]
    s, c, _, _ = trig(a, top)
    gap, rate = height(e, state[GAP], state[UN], omega, s, c, time)
    a, top, whole = chart(a + omega * time, top, state[WHOLE])
    s1, _, h1, _ = trig(a, top)
    state[T] += time
    state[ANGLE], state[TOP], state[WHOLE] = a, top, whole
    state[X_C] += state[XDOT] * time - e * (s1 - s)
    state[YDOT] -= time
    state[SLIP] = state[XDOT] - omega * (par[ONE_MINUS_E] + e * h1)
    state[GAP], state[UN] = gap, rate


@kernel
def settle(par, state, a0, top0, rise):
    """Put the contact point on the floor to the last digit, after a flight from the angle (a0, top0) in which
    the height of G above that of the hoop's centre on the floor changed by ``rise``.

    A fast rotation leaves the angle uncertain by the round-off of omega t, which would make or destroy
    energy: the height of G is known better, so the angle gives way. Heights are counted from the bottom or the
    top, whichever is near: from the centre, a hop of a tiny disk would be lost in them.
    """
    e, omega = par[ECC], state[OMEGA]
    _, _, h0, low0 = trig(a0, top0)
    s, _, h, low = trig(state[ANGLE], state[TOP])
    error = rise - e * (h - h0) if state[TOP] == 0.0 else rise + e * (low - low0)
    # anything larger is no round-off, and no linear correction would mend it
    if abs(error) < 1e-5 * abs(e * s):
        state[ANGLE], state[TOP], state[WHOLE] = chart(state[ANGLE] - error / (e * s), state[TOP], state[WHOLE])
        s1, _, h1, _ = trig(state[ANGLE], state[TOP])
        state[X_C] -= e * (s1 - s)
        state[SLIP] = state[XDOT] - omega * (par[ONE_MINUS_E] + e * h1)
        state[UN] = state[YDOT] + e * s1 * omega
