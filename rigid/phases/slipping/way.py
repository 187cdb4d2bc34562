"""A panel on the way of the motion: what happens on it, and the state anywhere on it.

Slip velocity, N - 1 and 1 - e c phidot^2 at the nodes follow from phidot and t. The Bernstein coefficients of each row
tell that the way has no event of a kind, or one; what they leave open is ``UNCLEAR``.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import inf
from typing import NamedTuple

from ...kernel.angle import next_angle, trig
from ...kernel.compile import kernel
from ...kernel.layout import (  # fmt: skip
    ANGLE,
    ECC,
    GYR,
    NODES,
    OMEGA,
    ONE_MINUS_E,
    P_OPEN,
    Q_B,
    Q_D,
    Q_F,
    Q_H,
    Q_N1,
    Q_NODE,
    Q_OMEGA,
    Q_SIN,
    Q_SLIP,
    Q_T,
    Q_X,
    ROW,
    SLIP,
    T_END,
    T_FROM,
    T_SINCE,
    TOP,
    WHOLE,
    X_C,
    XDOT,
    T,
)
from ...kernel.spectral import NO_ROOT, UNCLEAR, interpolate, largest, only_root, root_between
from .panel import Panel, place, place_of_bottom
from .step import LIFTS, NOTHING_YET, STOPS, TIME_IS_UP

NOWHERE = 2.0  # where on a way from 0 to 1 nothing is


class Way(NamedTuple):
    """A panel on the way of the motion, and the state where the way begins."""

    panel: Panel
    inward: bool  # from theta = 1 to a turn at 0
    d: float  # sign of phidot
    mu_hat: float
    duration: float  # t from theta = 0 to 1
    whole: float
    time: float
    since: float
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


@kernel
def share(way, theta):
    """The part of the way at theta; ``NOWHERE`` for no root."""
    if theta == NO_ROOT:
        return NOWHERE
    return 1.0 - theta if way.inward else theta


@kernel
def set_out(par, state, mu_hat, panel, whole, inward, d, duration):
    """The way over a panel from the present state."""
    s, _, h, _ = trig(state[ANGLE], state[TOP])
    omega = state[OMEGA]
    return Way(
        panel, inward, d, mu_hat, duration, whole, state[T], state[T_SINCE], state[SLIP], state[XDOT],
        -par[ECC] * s * omega, state[X_C], s, h, omega * (par[ONE_MINUS_E] + par[ECC] * h),
    )  # fmt: skip


@kernel
def foresee(par, way, rows):
    """Rows of the slip velocity and of (N - 1) D on the way; True if 1 - e c phidot^2 may be 0 on it, in a row too."""
    e, one_minus_e, gyr, mu_hat = par[ECC], par[ONE_MINUS_E], par[GYR], way.mu_hat
    first, pace = (way.duration, -1.0) if way.inward else (0.0, 1.0)
    start = way.slip + way.pace + mu_hat * (way.ydot - first)
    by_time, sign = mu_hat * pace, way.d
    for i in range(ROW):
        arm = one_minus_e + e * (rows[Q_H + i] - mu_hat * rows[Q_SIN + i])
        rows[Q_X + i] = sign * rows[Q_OMEGA + i] * arm
        rows[Q_SLIP + i] = start - by_time * rows[Q_T + i] - rows[Q_X + i]
    for i in range(ROW):
        free = 1 - e * (rows[Q_H + i] - 1) * rows[Q_OMEGA + i] * rows[Q_OMEGA + i]
        rows[Q_B + i] = free
        rows[Q_N1 + i] = gyr * free - rows[Q_D + i]
    return max(rows[Q_H], rows[Q_H + NODES]) > 0.98


@kernel
def end_of_run(way, left, rows):
    """theta where the time ``left`` is over; it grows all along."""
    target = way.duration - left if way.inward else left
    for i in range(ROW):
        rows[Q_F + i] = rows[Q_T + i] - target
    i = 0
    while rows[Q_F + i] < 0.0 and i < NODES:
        i += 1
    if i > 0:
        return root_between(rows, Q_F, rows[Q_NODE + i - 1], rows[Q_F + i - 1], rows[Q_NODE + i], rows[Q_F + i])
    if target > 0.0 and rows[Q_F] > 0.0:
        return root_between(rows, Q_F, 0.0, -target, rows[Q_NODE], rows[Q_F])
    return 0.0


@kernel
def look_ahead(par, state, way, rows):
    """The first event on the way and what is passed before it; ``end`` is ``UNCLEAR`` if that cannot be said."""
    unclear = Ahead(UNCLEAR, NOTHING_YET, NOWHERE, NOWHERE)
    free = foresee(par, way, rows)
    if way.slip == 0.0:
        # the root with which a slip starts is left out
        for i in range(ROW):
            rows[Q_SLIP + i] /= rows[Q_NODE + i]
    terms = abs(way.slip) + abs(way.pace) + abs(way.mu_hat) * (abs(way.ydot) + way.duration) + largest(rows, Q_X)
    at = only_root(rows, Q_SLIP, terms)
    if at == UNCLEAR or (rows[Q_SLIP + (NODES if way.inward else 0)] > 0.0) != (way.mu_hat > 0.0):
        return unclear
    end, event = 1.0, NOTHING_YET
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
    was_open = last_sign <= 0.0 if weight < NOWHERE else first_sign > 0.0
    if was_open != (state[P_OPEN] != 0.0):
        return unclear
    if par[T_END] - way.time < way.duration:
        at = end_of_run(way, par[T_END] - way.time, rows)
        if at == UNCLEAR:
            return unclear
        if share(way, at) < end:
            end, event = share(way, at), TIME_IS_UP
    bottom = place_of_bottom(way.panel)
    bottom = NOWHERE if bottom == inf else share(way, bottom)
    return Ahead(end, event, bottom, weight)


@kernel
def arrive_at(par, state, way, part, rows):
    """Put the state where this part of the way has been gone; returns sin phi and 1 + cos phi there."""
    e, panel, mu_hat = par[ECC], way.panel, way.mu_hat
    theta = 1.0 - part if way.inward else part
    t, omega = 0.0, 0.0
    if theta == 1.0:
        s, h = rows[Q_SIN + NODES], rows[Q_H + NODES]
        t, omega = rows[Q_T + NODES], way.d * rows[Q_OMEGA + NODES]
    else:
        s, h = place(panel, theta)
    if 0.0 < theta < 1.0:
        t, omega = interpolate(rows, Q_T, theta), way.d * interpolate(rows, Q_OMEGA, theta)
    dt = way.duration - t if way.inward else t
    state[ANGLE], state[TOP], state[WHOLE] = next_angle(s, h, panel.top, way.whole)
    ydot = -e * s * omega
    state[OMEGA] = omega
    state[T_SINCE] = way.since + dt
    state[T] = state[T_FROM] + state[T_SINCE]
    # xddot_G = -mu^ (1 + yddot_G), integrated twice
    along = way.xdot * dt - mu_hat * (0.5 * dt * dt + e * (h - way.h) - way.ydot * dt)
    state[X_C] = way.x + along - e * (s - way.s)
    change = -mu_hat * (dt + (ydot - way.ydot))
    state[XDOT] = way.xdot + change
    state[SLIP] = way.slip + change - (omega * (par[ONE_MINUS_E] + e * h) - way.pace)
    return s, h


@kernel
def force_on(par, mu_hat, s, h, omega):
    """N over M g at a place of a panel, and a number with the sign of dN/dphi."""
    e = par[ECC]
    c = h - 1
    w = omega * omega
    p = e * s + mu_hat * (par[ONE_MINUS_E] + e * h)
    d, b = par[GYR] + e * s * p, 1 - e * c * w
    db = e * s * w - 2 * e * c * p * b / d
    dd = e * c * p + e * e * s * (c - mu_hat * s)
    return par[GYR] * b / d, db * d - b * dd


@kernel
def force_at(par, way, x, rows):
    """N at a place of the way, and how it grows with that."""
    s, h = place(way.panel, x)
    n, slope = force_on(par, way.mu_hat, s, h, interpolate(rows, Q_OMEGA, x))
    return n, slope if way.panel.length > 0 else -slope


@kernel
def peak_on(par, way, start, stop, rows):
    """The largest N on a part of the way, but for its ends."""
    low, high = (1.0 - stop, 1.0 - start) if way.inward else (start, stop)
    top, best = 0.0, -1
    for i in range(ROW):
        if low <= rows[Q_NODE + i] <= high and rows[Q_N1 + i] > top * rows[Q_D + i]:
            top, best = rows[Q_N1 + i] / rows[Q_D + i], i
    peak, a, z, slope = 0.0, low, high, 0.0
    if best >= 0:
        middle = rows[Q_NODE + best]
        peak, slope = force_on(par, way.mu_hat, rows[Q_SIN + best], rows[Q_H + best], rows[Q_OMEGA + best])
        slope = slope if way.panel.length > 0 else -slope
        if slope > 0.0:
            a, z = middle, min(rows[Q_NODE + best + 1], high) if best < NODES else high
        else:
            a, z = max(rows[Q_NODE + best - 1], low) if best > 0 else low, middle
    if a == z or a == 0.0:  # at a turn N does not peak
        return peak
    slope_a = slope if slope > 0.0 else force_at(par, way, a, rows)[1]
    slope_z = slope if slope < 0.0 else force_at(par, way, z, rows)[1]
    # regula falsi (Anderson and Björck): the peak is flat, so eight digits of its place are sixteen of its height
    if slope_a > 0.0 and slope_z < 0.0:
        for _ in range(12):
            x = (a * slope_z - z * slope_a) / (slope_z - slope_a)
            n, slope = force_at(par, way, x, rows)
            peak = max(peak, n)
            if min(x - a, z - x) < 1e-8 or slope == 0.0:
                break
            if slope > 0.0:
                slope_z *= max(1 - slope / slope_a, 0.0) or 0.5
                a, slope_a = x, slope
            else:
                slope_a *= max(1 - slope / slope_z, 0.0) or 0.5
                z, slope_z = x, slope
    return peak
