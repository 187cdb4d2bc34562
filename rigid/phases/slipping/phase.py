"""A slipping phase: panels over phi, and where phi is no measure of the way a series in tau.

That is close to a jam, where N grows while phi stands still, at a start on a tie, where events crowd, and without
friction. When D has fallen to round-off the configuration is frozen: the rest of the slip is an impact
(:mod:`rigid.phases.impact`).

Events: the slip stops, lift-off (1 - e c phidot^2 = 0), a turn, the bottom, N = M g, and the end of the run.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import inf

from ...kernel.angle import trig
from ...kernel.compile import kernel
from ...kernel.layout import (  # fmt: skip
    ANGLE,
    AT_EDGE,
    FIRST_PULSE,
    FLIGHT,
    FROM_TOP,
    GAP,
    GYR,
    HELD,
    IMPACT,
    LOSSLESS_TURNS,
    MODE,
    MORE,
    MU,
    OMEGA,
    ORDER,
    P_KNOWN,
    P_OPEN,
    P_PEAK,
    PHASE_OVER,
    PULSE_OVER,
    RECORDS,
    REST,
    S_D,
    S_OMEGA,
    S_P,
    SKID,
    SLIDES,
    SLIP,
    SLIP_SCALE,
    STEPS,
    T_END,
    T_FROM,
    T_SINCE,
    TIME_REACHED,
    TOP,
    TOP_SIZE,
    TURNS,
    TURNS_REACHED,
    UN,
    UNTIL,
    WHIRLED,
    WIDTH,
    WORK_BOUND,
    XDOT,
    T,
)
from ...kernel.polynomial import value
from ...record.cycle import AT_PASS, AT_TURN, comes_round
from ...record.events import ROOM, turn
from ...record.pulse import at_touch, cross_bottom, watch
from .poles import poles_of
from .series import JAM, normal_force
from .step import (  # fmt: skip
    AT_BOTTOM,
    AT_WEIGHT,
    GRAZES,
    LIFTS,
    STOPS,
    TIME_IS_UP,
    TURNS_BACK,
    carry,
    carry_steadily,
    is_steady,
    keep_energy,
    next_event,
    peak_force,
    slip_now,
    step,
)
from .stride import GOES_ON, NOT_TAKEN, stride


@kernel
def slide_steadily(par, state):
    """The slip on which nothing acts, to the end of the run if it has one."""
    if par[T_END] == inf:
        return SLIDES
    carry_steadily(state, par[T_END] - state[T])
    state[T] = par[T_END]
    return TIME_REACHED


@kernel
def over_edge(par, state, events):
    """Over the edge of a pulse: why the run ends there, ``PHASE_OVER`` if it does not."""
    if watch(par, state, 1.0 if state[P_OPEN] != 0.0 else 1.0 + 1e-15, events):
        if par[UNTIL] == FIRST_PULSE:
            return PULSE_OVER
        on_a_smooth_floor = par[MU] == 0.0 and par[TURNS] == inf
        if on_a_smooth_floor and comes_round(par, state, AT_PASS, events) and par[UNTIL] == REST:
            return SLIDES
    return PHASE_OVER


@kernel
def cut_short(state, events):
    """Whether the log or the allowance of steps ends here, and why: ``PHASE_OVER`` if it does not."""
    if state[RECORDS] * WIDTH + ROOM * WIDTH > len(events):
        return MORE
    return WORK_BOUND if state[STEPS] <= 0.0 else PHASE_OVER


@kernel
def set_sliding(par, state, mu_hat, events):
    """Begin a slip: why the run ends there, ``PHASE_OVER`` if it does not."""
    state[T_FROM], state[T_SINCE] = state[T], 0.0
    state[AT_EDGE], state[P_KNOWN] = 0.0, inf
    state[LOSSLESS_TURNS], state[WHIRLED], state[SLIP_SCALE] = 0.0, 0.0, 0.0
    steady = is_steady(par, state)
    n = 1.0 if steady else normal_force(par, mu_hat, state[OMEGA], state[ANGLE], state[TOP])
    if watch(par, state, n, events) and par[UNTIL] == FIRST_PULSE:
        return PULSE_OVER
    return slide_steadily(par, state) if steady else PHASE_OVER


@kernel
def slide(par, state, work, rows, events):
    """Slip until the contact point rests or lifts, or the run is over; one that is held goes on where it was."""
    mu_hat = par[MU] if state[MODE] == SKID else -par[MU]
    gyr = par[GYR]
    if state[HELD] == 0.0:
        code = set_sliding(par, state, mu_hat, events)
        if code != PHASE_OVER:
            return code
    poles = poles_of(par, mu_hat)
    state[HELD] = 0.0
    at_edge, p_known = state[AT_EDGE] != 0.0, state[P_KNOWN]
    while True:
        code = cut_short(state, events)
        if code != PHASE_OVER:
            # the log ends at the same records in every run, the allowance of interpreted steps anywhere
            state[HELD] = 1.0 if code == WORK_BOUND else 0.0
            state[AT_EDGE], state[P_KNOWN] = 1.0 if at_edge else 0.0, p_known
            return code
        state[STEPS] -= 1.0
        keep_energy(par, state, state[FROM_TOP], state[TOP_SIZE])
        slip_now(par, state, trig(state[ANGLE], state[TOP])[2])
        code = stride(par, state, mu_hat, poles, rows, events)
        if code == GOES_ON:
            at_edge, p_known = False, inf
            continue
        if code != NOT_TAKEN:
            return code
        length = step(par, state, mu_hat, p_known, work)
        if work[S_D][0] <= JAM * gyr:
            state[MODE] = IMPACT
            return PHASE_OVER
        turning = work[S_OMEGA][0] != 0.0
        length, event = next_event(par, state, work, length, at_edge)
        at_edge = False
        if state[P_OPEN] != 0.0:
            state[P_PEAK] = max(state[P_PEAK], peak_force(gyr, work, length))
        p_known = value(work[S_P], ORDER, length)
        if length > 0.0:
            carry(par, state, mu_hat, work, length)
        if event in (STOPS, GRAZES):
            state[SLIP] = 0.0
        # without friction the slip stops where the hoop turns, to the last digit
        at_rest = par[MU] == 0.0 and state[XDOT] == 0.0
        if event == TURNS_BACK or (turning and (state[OMEGA] == 0.0 or (at_rest and event == STOPS))):
            state[OMEGA] = 0.0
            if at_rest:
                state[SLIP], event = 0.0, STOPS
            if at_touch(par, state):
                cross_bottom(state)
            state[LOSSLESS_TURNS] += 1.0
            state[WHIRLED] = 0.0
            if turn(par, state, events):
                return TURNS_REACHED
            if par[MU] == 0.0 and comes_round(par, state, AT_TURN, events) and par[UNTIL] == REST:
                return SLIDES
        if event == STOPS:
            return PHASE_OVER
        if event == LIFTS:
            state[GAP] = 0.0
            state[UN] = 0.0
            state[MODE] = FLIGHT
            return PHASE_OVER
        if event == TIME_IS_UP:
            state[T] = par[T_END]
            return TIME_REACHED
        if event == AT_BOTTOM:
            state[ANGLE] = 0.0
            state[LOSSLESS_TURNS] += 0.5
            state[WHIRLED] += 1.0
            cross_bottom(state)
        elif event == AT_WEIGHT:
            at_edge = True
            code = over_edge(par, state, events)
            if code != PHASE_OVER:
                return code
        if par[MU] == 0.0 and par[UNTIL] == REST and state[LOSSLESS_TURNS] >= 3.0:
            return SLIDES
        if par[MU] == 0.0 and state[WHIRLED] >= 3.0 and par[TURNS] < inf:
            return SLIDES  # round and round: there is no turn to wait for
