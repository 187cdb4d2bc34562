"""Slipping by panels: an event is the one root of a row, and where there may be more the panel is shorter.

Slip velocity, N - 1 and 1 - e c phidot^2 at the nodes follow from phidot and t. The Bernstein coefficients of each row
tell that the panel has no event of a kind, or one: what they leave open is asked of a shorter panel, and at last of a
series (:mod:`rigid.phases.slipping.step`).
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import asin, atan, atan2, inf, log, sqrt, tan
from typing import NamedTuple

from ...kernel.angle import chart, trig
from ...kernel.compile import kernel
from ...kernel.layout import (  # fmt: skip
    ANGLE,
    ECC,
    FIRST_PULSE,
    FLIGHT,
    GAP,
    GYR,
    MODE,
    MU,
    NODES,
    OMEGA,
    ONE_MINUS_E,
    P_OPEN,
    P_PEAK,
    PHASE_OVER,
    PULSE_OVER,
    Q_B,
    Q_D,
    Q_F,
    Q_N1,
    Q_NODE,
    Q_OMEGA,
    Q_OMEGA2,
    Q_SLIP,
    Q_T,
    Q_U,
    Q_X,
    ROW,
    SLIP,
    T_END,
    TIME_REACHED,
    TOP,
    TURNS_REACHED,
    UN,
    UNTIL,
    WHOLE,
    X_C,
    XDOT,
    T,
)
from ...kernel.spectral import NO_ROOT, UNCLEAR, interpolate, largest, least_of, only_root, root_between
from ...record.events import turn
from ...record.pulse import cross_bottom, watch
from .panel import CLEAR, Panel, offset, panel_at, place_of_bottom, run_clock, spin_up

GOES_ON, NOT_TAKEN = -2, -3  # beside the reasons for which a phase returns
LONGEST, LONGEST_TOP, SHORTEST = 1.5, 1.0, 0.02  # panels in x; below, a series goes further
TURN = 1.0  # longest panel from a turn
REACH = 2.4  # (rho + 1/rho)/2, rho^-23 = 2e-15: half the sum of the distances from a pole to the ends, over half the panel
ROUGH = 6e-14  # of a row's largest, in its last coefficients: their integral is a tenth of it
TRIES = 4
NEVER = 2.0  # where on a way from 0 to 1 nothing is


class Way(NamedTuple):
    """A panel on the way of the motion, and the state where the way begins."""

    panel: Panel
    inward: bool  # from theta = 1 to a turn at 0
    d: float  # sign of phidot
    mu_hat: float
    duration: float  # t from theta = 0 to 1
    whole: float
    time: float
    slip: float
    xdot: float
    ydot: float
    x: float
    s: float
    h: float
    pace: float  # phidot (1 + e c)


class Ahead(NamedTuple):
    """Where on the way, from 0 to 1, what happens."""

    end: float
    event: int
    bottom: float
    weight: float


ARRIVES, STOPS, LIFTS, TIME_IS_UP = range(4)


@kernel
def share(way, theta):
    """The part of the way at theta; ``NEVER`` for no root."""
    if theta == NO_ROOT:
        return NEVER
    return 1.0 - theta if way.inward else theta


@kernel
def set_out(par, state, mu_hat, panel, whole, inward, d, duration):
    """The way over a panel from the present state."""
    s, _, h, _ = trig(state[ANGLE], state[TOP])
    omega = state[OMEGA]
    return Way(
        panel, inward, d, mu_hat, duration, whole, state[T], state[SLIP], state[XDOT],
        -par[ECC] * s * omega, state[X_C], s, h, omega * (par[ONE_MINUS_E] + par[ECC] * h),
    )  # fmt: skip


@kernel
def foresee(par, way, rows):
    """Rows of the slip velocity and of (N - 1) D on the way; True if 1 - e c phidot^2 may be 0 on it, in a row too."""
    e, one_minus_e, gyr, mu_hat = par[ECC], par[ONE_MINUS_E], par[GYR], way.mu_hat
    up, flat, steep = (2.0, 2.0, 0.0) if way.panel.top != 0.0 else (-2.0, 0.0, 2.0)
    first, pace = (way.duration, -1.0) if way.inward else (0.0, 1.0)
    start = way.slip + way.pace + mu_hat * (way.ydot - first)
    by_time, sign = mu_hat * pace, way.d
    for i in range(ROW):
        q = 1 / (1 + rows[Q_U + i] * rows[Q_U + i])
        w = sign * rows[Q_OMEGA + i]
        arm = one_minus_e + e * ((flat + steep * rows[Q_U + i] * rows[Q_U + i]) * q - mu_hat * up * rows[Q_U + i] * q)
        rows[Q_X + i] = w * arm
        rows[Q_SLIP + i] = start - by_time * rows[Q_T + i] - rows[Q_X + i]
    for i in range(ROW):
        c = (flat + steep * rows[Q_U + i] * rows[Q_U + i]) / (1 + rows[Q_U + i] * rows[Q_U + i]) - 1
        free = 1 - e * c * rows[Q_OMEGA + i] * rows[Q_OMEGA + i]
        rows[Q_B + i] = free
        rows[Q_N1 + i] = gyr * free - rows[Q_D + i]
    return way.panel.top != 0.0 or max(abs(rows[Q_U]), abs(rows[Q_U + NODES])) > 0.99


@kernel
def look_ahead(par, state, way, rows):
    """The first event on the way and what is passed before it; ``end`` is ``UNCLEAR`` if that cannot be said."""
    unclear = Ahead(UNCLEAR, ARRIVES, NEVER, NEVER)
    free = foresee(par, way, rows)
    if way.slip == 0.0:
        # the root with which a slip starts is left out
        for i in range(ROW):
            rows[Q_SLIP + i] /= rows[Q_NODE + i]
    terms = abs(way.slip) + abs(way.pace) + abs(way.mu_hat) * (abs(way.ydot) + way.duration) + largest(rows, Q_X)
    at = only_root(rows, Q_SLIP, terms)
    if at == UNCLEAR or (rows[Q_SLIP + (NODES if way.inward else 0)] > 0.0) != (way.mu_hat > 0.0):
        return unclear
    end, event = 1.0, ARRIVES
    if share(way, at) < end:
        end, event = share(way, at), STOPS
    if free:
        at = only_root(rows, Q_B, 1.0)
        if at == UNCLEAR or (at == NO_ROOT and rows[Q_B] < 0.0):
            return unclear
        if share(way, at) < end:
            end, event = share(way, at), LIFTS
    weight = only_root(rows, Q_N1, largest(rows, Q_N1) + 2 * largest(rows, Q_D))
    if weight == UNCLEAR:
        return unclear
    weight = share(way, weight)
    first_sign = rows[Q_N1 + NODES] if way.inward else rows[Q_N1]
    last_sign = rows[Q_N1] if way.inward else rows[Q_N1 + NODES]
    was_open = last_sign <= 0.0 if weight < NEVER else first_sign > 0.0
    if was_open != (state[P_OPEN] != 0.0):
        return unclear
    left = par[T_END] - way.time
    if left < way.duration:
        target = way.duration - left if way.inward else left
        for i in range(ROW):
            rows[Q_F + i] = rows[Q_T + i] - target
        i = 0
        while rows[Q_F + i] < 0.0 and i < NODES:
            i += 1
        if i == 0:
            at = root_between(rows, Q_F, 0.0, -target, rows[Q_NODE], rows[Q_F]) if rows[Q_F] > 0.0 and target > 0.0 else 0.0
        else:
            at = root_between(rows, Q_F, rows[Q_NODE + i - 1], rows[Q_F + i - 1], rows[Q_NODE + i], rows[Q_F + i])
        if at == UNCLEAR:
            return unclear
        if share(way, at) < end:
            end, event = share(way, at), TIME_IS_UP
    bottom = place_of_bottom(way.panel)
    bottom = NEVER if bottom == inf else share(way, bottom)
    return Ahead(end, event, bottom, weight)


@kernel
def arrive_at(par, state, way, part, rows):
    """Put the state where this part of the way has been gone."""
    e, panel, mu_hat = par[ECC], way.panel, way.mu_hat
    theta = 1.0 - part if way.inward else part
    t, omega = 0.0, 0.0
    if theta == 1.0:
        u, t, omega = rows[Q_U + NODES], rows[Q_T + NODES], way.d * rows[Q_OMEGA + NODES]
    else:
        u = offset(panel, theta)
    if 0.0 < theta < 1.0:
        t, omega = interpolate(rows, Q_T, theta), way.d * interpolate(rows, Q_OMEGA, theta)
    dt = way.duration - t if way.inward else t
    state[ANGLE], state[TOP], state[WHOLE] = chart(2 * atan(u), panel.top, way.whole)
    q = 1 / (1 + u * u)
    s, h = (2 * u * q, 2 * q) if panel.top != 0.0 else (-2 * u * q, 2 * u * u * q)
    ydot = -e * s * omega
    state[OMEGA] = omega
    state[T] = way.time + dt
    # xddot_G = -mu^ (1 + yddot_G), integrated twice
    along = way.xdot * dt - mu_hat * (0.5 * dt * dt + e * (h - way.h) - way.ydot * dt)
    state[X_C] = way.x + along - e * (s - way.s)
    change = -mu_hat * (dt + (ydot - way.ydot))
    state[XDOT] = way.xdot + change
    state[SLIP] = way.slip + change - (omega * (par[ONE_MINUS_E] + e * h) - way.pace)


@kernel
def force_on(par, way, u, omega):
    """N over M g at a place of a panel, and a number with the sign of dN/dphi."""
    e, mu_hat = par[ECC], way.mu_hat
    up, flat, steep = (2.0, 2.0, 0.0) if way.panel.top != 0.0 else (-2.0, 0.0, 2.0)
    q = 1 / (1 + u * u)
    s, h = up * u * q, (flat + steep * u * u) * q
    c = h - 1
    w = omega * omega
    p = e * s + mu_hat * (par[ONE_MINUS_E] + e * h)
    d, b = par[GYR] + e * s * p, 1 - e * c * w
    db = e * s * w - 2 * e * c * p * b / d
    dd = e * c * p + e * e * s * (c - mu_hat * s)
    return par[GYR] * b / d, db * d - b * dd


@kernel
def peak_on(par, way, start, stop, rows):
    """The largest N on a part of the way."""
    low, high = (1.0 - stop, 1.0 - start) if way.inward else (start, stop)
    top, best = 0.0, -1
    for i in range(ROW):
        if low <= rows[Q_NODE + i] <= high and rows[Q_N1 + i] > top * rows[Q_D + i]:
            top, best = rows[Q_N1 + i] / rows[Q_D + i], i
    if best < 0:
        return 0.0
    left = rows[Q_NODE + best - 1] if best > 0 else 0.0
    right = rows[Q_NODE + best + 1] if best < NODES else 1.0
    left, right = max(left, low), min(right, high)
    sign = 1.0 if way.panel.length > 0 else -1.0
    peak, slope = force_on(par, way, rows[Q_U + best], rows[Q_OMEGA + best])
    slope *= sign
    a, slope_a, z, slope_z = rows[Q_NODE + best], slope, right, 0.0
    if slope <= 0.0:
        a, slope_a, z, slope_z = left, 0.0, rows[Q_NODE + best], slope
    other = left if slope <= 0.0 else right
    if other == rows[Q_NODE + best] or other == 0.0:
        return peak
    _, slope = force_on(par, way, offset(way.panel, other), interpolate(rows, Q_OMEGA, other))
    if slope_a == 0.0:
        slope_a = slope * sign
    else:
        slope_z = slope * sign
    # regula falsi (Anderson and Björck): the peak is flat, so eight digits of its place are sixteen of its height
    if slope_a > 0.0 and slope_z < 0.0:
        for _ in range(12):
            x = (a * slope_z - z * slope_a) / (slope_z - slope_a)
            n, slope = force_on(par, way, offset(way.panel, x), interpolate(rows, Q_OMEGA, x))
            peak = max(peak, n)
            slope *= sign
            if min(x - a, z - x) < 1e-8 or slope == 0.0:
                break
            if slope > 0.0:
                slope_z *= max(1 - slope / slope_a, 0.0) or 0.5
                a, slope_a = x, slope
            else:
                slope_a *= max(1 - slope / slope_z, 0.0) or 0.5
                z, slope_z = x, slope
    return peak


@kernel
def go(par, state, way, ahead, rows, events):
    """Go the way to its end or to the first event that ends the phase or the run."""
    here = 0.0
    end = ahead.end
    bottom, weight = ahead.bottom, ahead.weight
    while True:
        there = min(end, bottom, weight)
        if state[P_OPEN] != 0.0:
            state[P_PEAK] = max(state[P_PEAK], peak_on(par, way, here, there, rows))
        arrive_at(par, state, way, there, rows)
        if state[P_OPEN] != 0.0:
            n, _ = force_on(par, way, tan(0.5 * state[ANGLE]) if state[TOP] == way.panel.top else 1e300, state[OMEGA])
            if state[TOP] == way.panel.top:
                state[P_PEAK] = max(state[P_PEAK], n)
        here = there
        if there == end:
            break
        if there == bottom:
            bottom = NEVER
            state[ANGLE] = 0.0
            cross_bottom(state)
        else:
            weight = NEVER
            closed = watch(par, state, 1.0 if state[P_OPEN] != 0.0 else 1.0 + 1e-15, events)
            if closed and par[UNTIL] == FIRST_PULSE:
                return PULSE_OVER
    if ahead.event == STOPS:
        state[SLIP] = 0.0
        return PHASE_OVER
    if ahead.event == LIFTS:
        state[GAP] = 0.0
        state[UN] = 0.0
        state[MODE] = FLIGHT
        return PHASE_OVER
    if ahead.event == TIME_IS_UP:
        state[T] = par[T_END]
        return TIME_REACHED
    return GOES_ON


class Poles(NamedTuple):
    """Zeros of D in the plane of x, as (real, +-imaginary) parts: estimates, exact for a small K."""

    near: float  # two about the bottom
    near_width: float
    near_too: float
    far: float  # the nearer of two others, also in the chart of the top
    far_width: float
    far_top: float
    far_top_width: float


@kernel
def arsinh(x):
    """ln(x + sqrt(1 + x^2))."""
    return log(abs(x) + sqrt(1 + x * x)) * (1.0 if x >= 0.0 else -1.0)


@kernel
def poles_of(par, mu_hat):
    """D (1 + u^2)^2 = K - 2 e mu^ (1 - e) u + (2 K + 4 e^2) u^2 - 2 e mu^ (1 + e) u^3 + K u^4: the first three terms have
    the zeros near the bottom, the last three the others.
    """
    e, one_minus_e, gyr = par[ECC], par[ONE_MINUS_E], par[GYR]
    kappa = min(1.0, sqrt(gyr) / (2 * e))
    middle = 2 * gyr + 4 * e * e
    # the near zeros lie about kappa from 0, in the direction whose cosine is this
    cosine = e * mu_hat * one_minus_e / sqrt(gyr * middle)
    side = 1.0 if mu_hat > 0 else -1.0
    size = abs(cosine)
    if size < 1.0:
        near = near_too = side * arsinh(sqrt(size))
        near_width = asin(sqrt(1 - size))
    else:
        near_width = 0.0
        outer = size + sqrt(size * size - 1)
        near, near_too = side * arsinh(outer), side * arsinh(1 / outer)
    half = e * abs(mu_hat) * (1 + e)
    root = half * half - gyr * middle
    if root >= 0.0:
        far, far_width = middle / (half + sqrt(root)), 0.0
        low = e * abs(mu_hat) * one_minus_e
        for _ in range(2):
            # Newton on all of it: a slip that starts near it wants its place
            rest = gyr + far * (far * (middle + far * (far * gyr - 2 * half)) - 2 * low)
            slope = 2 * (far * (middle + far * (2 * far * gyr - 3 * half)) - low)
            if slope != 0.0:
                far -= rest / slope
    else:
        far, far_width = half / gyr, sqrt(-root) / gyr
    size2 = far * far + far_width * far_width
    far_x, turn = 0.5 * log(4 * size2 / (kappa * kappa)), atan2(far_width, far)
    return Poles(near, near_width, near_too, side * far_x, turn, -side * far / size2, far_width / size2)


@kernel
def clear_of(length, ahead, width):
    """The length of a panel, ``length`` at most, that sees a pole at ``ahead`` +- i ``width`` of its start as 1e-15."""
    if ahead == inf:
        return length
    return min(length, 2 * (REACH * sqrt(ahead * ahead + width * width) - ahead) / (REACH * REACH - 1))


@kernel
def first_length(poles, panel, sign):
    """A panel's length in x for what D does."""
    if panel.top != 0.0:
        return clear_of(LONGEST_TOP, sign * (poles.far_top - panel.start), poles.far_top_width)
    x = log(panel.start)
    length = clear_of(LONGEST, sign * (poles.near - x), poles.near_width)
    length = clear_of(length, sign * (poles.near_too - x), poles.near_width)
    return clear_of(length, sign * (poles.far - x), poles.far_width)


@kernel
def turn_ahead(par, mu_hat, angle, panel, omega):
    """How far in x the turn is ahead (or was behind, < 0), were the rates of dw/dx = -g - f w constant."""
    s, c, h, low = angle
    e, gyr = par[ECC], par[GYR]
    p = e * s + mu_hat * (par[ONE_MINUS_E] + e * h)
    # dphi/dx, with 1/(1 + u^2) of the chart
    if panel.top != 0.0:
        rate = h
    else:
        rate = 0.5 * panel.kappa * (panel.start + 1 / panel.start) * low
    rate *= 2 * p / (gyr + e * s * p)
    falls, fades = -rate / (omega * abs(omega)), rate * e * c
    if omega < 0.0:
        fades = -fades
    if abs(fades) <= 1e-6 * abs(falls):
        return 1 / falls if falls != 0.0 else inf
    share = fades / falls if falls != 0.0 else inf
    return log(1 + share) / fades if -1.0 < share < inf else inf


@kernel
def starts(par, mu_hat, angle, omega, d):
    """Whether a slip sets in with an acceleration of the right sign, far above the round-off of its terms."""
    s, c, h, _ = angle
    e = par[ECC]
    arm = par[ONE_MINUS_E] + e * h
    b, spin = 1 - e * c * omega * omega, e * s * omega * omega * d
    force = (mu_hat * par[GYR] + arm * (e * s + mu_hat * arm)) * b
    return (spin - force) * mu_hat > 1e-3 * abs(mu_hat) * (abs(spin) + abs(force))


@kernel
def stride(par, state, mu_hat, poles, rows, events):
    """Slip over the next panel, or to a turn and back over it.

    Returns why the phase or the run is over, ``GOES_ON``, or ``NOT_TAKEN`` with nothing changed: near a turn that is
    not seen yet, near D = 0, at the start of a slip, and where events crowd.
    """
    omega = state[OMEGA]
    if omega == 0.0 or par[MU] == 0.0:
        return NOT_TAKEN
    angle = trig(state[ANGLE], state[TOP])
    s, _, h, _ = angle
    d = par[GYR] + par[ECC] * s * (par[ECC] * s + mu_hat * (par[ONE_MINUS_E] + par[ECC] * h))
    if d < CLEAR * (par[GYR] + par[ECC] * par[ECC] * s * s):
        return NOT_TAKEN
    if state[SLIP] == 0.0 and not starts(par, mu_hat, angle, omega, d):
        return NOT_TAKEN
    u = tan(0.5 * state[ANGLE])
    sign = 1.0 if omega > 0 else -1.0
    d0_w0 = d * omega * omega
    panel = panel_at(par, u, state[TOP], 1.0, False)
    length = first_length(poles, panel, sign)
    turns = turn_ahead(par, mu_hat, angle, panel, omega)
    if 0.0 < turns:
        length = 1.2 * turns if 1.2 * turns < length else min(length, 0.45 * turns)
    else:
        length = clear_of(length, turns, 0.0)
    for _ in range(TRIES):
        if length < SHORTEST:
            return NOT_TAKEN
        panel = panel_at(par, u, state[TOP], sign * length, False)
        rough = spin_up(par, mu_hat, panel, d0_w0, rows)
        if rough == inf:
            length *= 0.4
            continue
        if rough > ROUGH:
            length *= max(0.3, 0.9 * (0.2 * ROUGH / rough) ** (1 / NODES))
            continue
        if least_of(rows, Q_OMEGA2) <= 0.0:
            at = only_root(rows, Q_OMEGA2, 0.0)
            if at < 0.0:
                length *= 0.5
                continue
            code = there_and_back(par, state, mu_hat, panel, at, rows, events) if at * length < TURN else NOT_TAKEN
            if code != NOT_TAKEN:
                return code
            length *= 0.5 * at
            continue
        rough = run_clock(panel, rows)
        if rough > ROUGH:
            length *= max(0.3, 0.9 * (0.2 * ROUGH / rough) ** (1 / NODES))
            continue
        way = set_out(par, state, mu_hat, panel, state[WHOLE], False, sign, rows[Q_T + NODES])
        ahead = look_ahead(par, state, way, rows)
        if ahead.end != UNCLEAR:
            return go(par, state, way, ahead, rows, events)
        length *= 0.5
    return NOT_TAKEN


@kernel
def there_and_back(par, state, mu_hat, panel, at, rows, events):
    """To the turn at ``at`` on a panel, and back to where the way began, if nothing ends the phase before."""
    u, w = offset(panel, at), state[OMEGA] * state[OMEGA]
    back = panel_at(par, u, panel.top, -panel.length * at, True)
    if spin_up(par, mu_hat, back, 0.0, rows) > ROUGH or least_of(rows, Q_OMEGA2) <= 0.0:
        return NOT_TAKEN
    if abs(rows[Q_OMEGA2 + NODES] - w) > 1e-11 * w or run_clock(back, rows) > ROUGH:
        return NOT_TAKEN
    d = 1.0 if state[OMEGA] > 0 else -1.0
    way = set_out(par, state, mu_hat, back, state[WHOLE], True, d, rows[Q_T + NODES])
    ahead = look_ahead(par, state, way, rows)
    if ahead.end == UNCLEAR:
        return NOT_TAKEN
    code = go(par, state, way, ahead, rows, events)
    if code != GOES_ON:
        return code
    if turn(par, state, events):
        return TURNS_REACHED
    whole = way.whole  # that of the panel's chart: the turn may lie beyond it
    way = set_out(par, state, mu_hat, back, whole, False, -d, rows[Q_T + NODES])
    ahead = look_ahead(par, state, way, rows)
    if ahead.end == UNCLEAR:
        return GOES_ON
    return go(par, state, way, ahead, rows, events)
