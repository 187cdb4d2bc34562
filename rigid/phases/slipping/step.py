"""One step of a slip by series in tau, cut at its first event: a root of the step's own polynomials."""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import inf, sqrt

from ...kernel.angle import next_angle, trig
from ...kernel.compile import kernel
from ...kernel.layout import (  # fmt: skip
    ANGLE,
    ECC,
    GYR,
    MODE,
    MU,
    MU_S,
    OMEGA,
    ONE_MINUS_E,
    ORDER,
    P_OPEN,
    S_B,
    S_D,
    S_H,
    S_N1,
    S_OMEGA,
    S_SIN,
    S_SLIP,
    S_T,
    S_YDOT,
    SKID,
    SLIP,
    SLIP_SCALE,
    T_END,
    T_FROM,
    T_SINCE,
    TOP,
    WHOLE,
    X_C,
    XDOT,
    T,
)
from ...kernel.polynomial import first_crossing, value, value_and_slope
from .series import series

NEAR_TOP = (
    0.1  # energy from the top, over M g R, of a hoop that is held to it; of others phidot has the digits it needs
)
TINY = 1e-12  # K of a disk that whips past the top at 1/k, where the energy has no digit of its rotation
A_TENTH = 0.1
UPRIGHT = 1e-13  # sin phi
LAST_DIGITS = 1e-15  # of terms, in a difference of them
GRAZE = 1e-11  # of the velocity of G: beyond 0 the slip goes by no more where it touches that, by round-off

# what a step is cut at
NOTHING_YET, STOPS, LIFTS, TIME_IS_UP, TURNS_BACK, AT_BOTTOM, AT_WEIGHT, GRAZES = range(8)


@kernel
def peak_force(gyr, work, length):
    """Largest N = K b/D over a step."""
    b, d = work[S_B], work[S_D]
    top = 0.0
    x0, slope0 = 0.0, 0.0
    for k in range(3):
        x = 0.5 * length * k
        y, dy = b[0], b[1]
        z, dz = d[0], d[1]
        if k > 0:
            y, dy = value_and_slope(b, ORDER, x)
            z, dz = value_and_slope(d, ORDER, x)
        top = max(top, gyr * y / z)
        slope = dy * z - y * dz
        if k == 0 and slope == 0.0:
            # from a turn, where N changes like the square of tau: its sign is that of a little later
            (y, dy), (z, dz) = value_and_slope(b, ORDER, 1e-3 * length), value_and_slope(d, ORDER, 1e-3 * length)
            slope = dy * z - y * dz
        if k > 0 and slope0 > 0 and slope < 0:
            low, high = x0, x
            slope_low, slope_high = slope0, slope
            middle = low
            # regula falsi (Illinois): the peak is flat, so eight digits of its place are sixteen of its
            # height
            for _ in range(40):
                middle = (low * slope_high - high * slope_low) / (slope_high - slope_low)
                y, dy = value_and_slope(b, ORDER, middle)
                z, dz = value_and_slope(d, ORDER, middle)
                slope_m = dy * z - y * dz
                if slope_m > 0:
                    low, slope_low = middle, slope_m
                    slope_high *= 0.5
                else:
                    high, slope_high = middle, slope_m
                    slope_low *= 0.5
                if high - low < 1e-9 * length or slope_m == 0.0:
                    break
            top = max(top, gyr * y / z)
        x0, slope0 = x, slope
    return top


@kernel
def carry(par, state, mu_hat, work, x):
    """Advance the state along the series by x <= the step's length."""
    e = par[ECC]
    s0, h0, ydot, xdot = work[S_SIN][0], work[S_H][0], work[S_YDOT][0], state[XDOT]
    dt = value(work[S_T], ORDER, x)
    s1, h1, omega = value(work[S_SIN], ORDER, x), value(work[S_H], ORDER, x), value(work[S_OMEGA], ORDER, x)
    a, top, whole = next_angle(s1, h1, state[TOP], state[WHOLE])
    # xddot_G = -mu^ (1 + yddot_G), integrated twice
    along = xdot * dt - mu_hat * (0.5 * dt * dt + e * (h1 - h0) - ydot * dt)
    state[X_C] += along - e * (s1 - s0)
    state[T_SINCE] += dt
    state[T] = state[T_FROM] + state[T_SINCE]
    state[ANGLE], state[TOP], state[WHOLE] = a, top, whole
    state[XDOT] -= mu_hat * (dt + (-e * s1 * omega - ydot))
    state[OMEGA] = omega
    state[SLIP] = value(work[S_SLIP], ORDER, x)


@kernel
def is_upright(s, omega):
    """Whether the disk is right above or below the contact, where a slip of 0 gets its sign a moment later."""
    return abs(s) <= min(UPRIGHT, 1e-4 * abs(omega))


@kernel
def is_steady(par, state):
    """Whether nothing acts on a slip: the disk at rest right above or below the contact, on a smooth floor."""
    return par[MU] == 0.0 and state[OMEGA] == 0.0 and state[ANGLE] == 0.0


@kernel
def carry_steadily(state, time):
    """Advance such a slip."""
    state[X_C] += state[XDOT] * time
    state[T] += time


@kernel
def keep_energy(par, state, from_top, size):
    """On a smooth floor: phidot as the energy has it, but towards a turn, where it is a difference. What steps add up
    to grows near the top without bound, and it hangs on the last digits how the hoop goes on from there.
    """
    if par[MU] != 0.0 or size == 0.0 or size > NEAR_TOP or par[GYR] < TINY or state[OMEGA] == 0.0:
        return
    s, _, h, low = trig(state[ANGLE], state[TOP])
    moving = from_top + par[ECC] * low
    if moving > A_TENTH * max(size, par[ECC] * low):
        omega = sqrt(2 * moving / (par[GYR] + par[ECC] * s * par[ECC] * s))
        omega = omega if state[OMEGA] > 0.0 else -omega
        if state[SLIP] != 0.0:
            state[SLIP] -= (omega - state[OMEGA]) * (par[ONE_MINUS_E] + par[ECC] * h)
        state[OMEGA] = omega


@kernel
def slip_now(par, state, h):
    """The slip velocity: carried along, or anew from phidot and the velocity of G where that has more digits.

    Past the bottom of a tiny hoop it was as large as phidot ~ 1/k, and has kept the round-off of that size.
    """
    turning = state[OMEGA] * (par[ONE_MINUS_E] + par[ECC] * h)
    terms = abs(turning) + abs(state[XDOT])
    if terms < 0.1 * state[SLIP_SCALE]:
        state[SLIP], state[SLIP_SCALE] = state[XDOT] - turning, terms
    state[SLIP_SCALE] = max(state[SLIP_SCALE], abs(state[SLIP]))
    return state[SLIP]


@kernel
def step(par, state, mu_hat, p_known, work):
    """The series of the next step, and how far it is good."""
    angle = trig(state[ANGLE], state[TOP])
    slip = slip_now(par, state, angle[2])
    length = series(par, mu_hat, angle, state[OMEGA], slip, p_known, work)
    b, v, om = work[S_B], work[S_SLIP], work[S_OMEGA]
    if v[0] == 0.0:
        # a slip that starts with mu_s = mu starts with no acceleration either, up to the round-off of its
        # terms; b and D, differences themselves, have that of theirs, which is all where N is next to nothing
        gyr, es, mu, w = par[GYR], par[ECC] * abs(work[S_SIN][0]), par[MU], om[0] * om[0]
        arm = par[ONE_MINUS_E] + par[ECC] * work[S_H][0]
        terms = (gyr + es + mu * arm) * abs(b[0]) + es * w * work[S_D][0]
        within = (mu * gyr + arm * (es + mu * arm)) * (1 + par[ECC] * w) + es * w * (gyr + es * (es + mu * arm))
        stands = mu == 0.0 and is_upright(work[S_SIN][0], om[0])  # a sign that is known is kept
        if stands or (mu > 0.0 and abs(v[1]) <= 1e-13 * terms + LAST_DIGITS * within):
            v[1] = 0.0
    if abs(b[0]) <= 1e-14 * (1 + par[ECC] * om[0] * om[0]):
        b[0] = 0.0
    return length


@kernel
def after_touch(par, state, slip, x, sign):
    """Where a slip that comes to 0 at ``x`` is on its old side again, if it only touches 0; -1 if it does not.

    A hoop released with the disk right above or below the contact, without slip, on a smooth floor comes back to that
    in every period: the slip is least there, 0 and of round-off of either sign. It goes on, in the same phase.
    """
    if par[MU_S] != 0.0:
        return -1.0  # at rest, the contact point may be held
    at, slope = value_and_slope(slip, ORDER, x)
    bend = 0.0
    for n in range(ORDER, 1, -1):
        bend = bend * x + n * (n - 1) * slip[n]
    at, slope, bend = -sign * at, -sign * slope, sign * bend  # beyond 0, how fast, and how that is turned back
    if bend <= 0.0 or at + 0.5 * max(slope, 0.0) ** 2 / bend > GRAZE * abs(state[XDOT]):
        return -1.0
    return x + (slope + sqrt(max(slope * slope + 2 * bend * at, 0.0))) / bend


@kernel
def end_of_slip(par, state, work, length, sign):
    """(how far, event): where the slip stops, or touches 0, or the contact point lifts off; ``NOTHING_YET`` if none."""
    event = NOTHING_YET
    x = first_crossing(work[S_SLIP], ORDER, length, sign)
    if x >= 0:
        back = after_touch(par, state, work[S_SLIP], x, sign)
        if back < 0.0:
            length, event = x, STOPS
        elif back < length:
            length, event = back, GRAZES
    x = first_crossing(work[S_B], ORDER, length, 1.0)
    # where b = 0 it goes on by e s omega^3 D: on a way that comes down from the top b is below 0 by round-off alone
    if x >= 0 and value(work[S_SIN], ORDER, x) * value(work[S_OMEGA], ORDER, x) < 0:
        length, event = x, LIFTS
    return length, event


@kernel
def next_event(par, state, work, length, at_edge):
    """(how far, event): the first thing that happens within a step of the length ``length``."""
    om, n1, tt = work[S_OMEGA], work[S_N1], work[S_T]
    length, event = end_of_slip(par, state, work, length, 1.0 if state[MODE] == SKID else -1.0)
    left = par[T_END] - state[T]
    if left < inf and left < value(tt, ORDER, length):
        tt[0] = -left
        x = first_crossing(tt, ORDER, length, -1.0)
        tt[0] = 0.0
        if x >= 0:
            length, event = x, TIME_IS_UP
    heading = om[0] if om[0] != 0.0 else om[1]
    x = first_crossing(om, ORDER, length, 1.0 if heading > 0 else -1.0)
    if x > 0:
        length, event = x, TURNS_BACK
    if state[TOP] == 0.0:
        a = state[ANGLE]
        # sin phi has the sign of -a
        side = a if a != 0.0 else heading
        x = first_crossing(work[S_SIN], ORDER, length, -1.0 if side > 0 else 1.0)
        if x > 0:
            length, event = x, AT_BOTTOM
    if at_edge:
        n1[0] = 0.0
    x = first_crossing(n1, ORDER, length, 1.0 if state[P_OPEN] != 0.0 else -1.0)
    if x > 0 or (x == 0.0 and not at_edge):
        length, event = x, AT_WEIGHT
    return length, event
