"""Slipping by panels: the next one, its length found by trying, and the events on it.

What a panel leaves open is asked of a shorter one, and at last of a series (:mod:`rigid.phases.slipping.step`). A turn
is the root of phidot^2 on a panel; from there the panel is laid anew, and gone to the turn and back.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import inf, tan

from ...kernel.angle import trig
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
    Q_OMEGA2,
    Q_T,
    SLIP,
    T_END,
    TIME_REACHED,
    TOP,
    TURNS_REACHED,
    UN,
    UNTIL,
    WHOLE,
    T,
)
from ...kernel.spectral import UNCLEAR, least_of, only_root
from ...record.events import turn
from ...record.pulse import arrive_at_bottom, at_touch, cross_bottom, watch
from .panel import CLEAR, offset, panel_at, run_clock, spin_up
from .poles import clear_of, first_length, starts, turn_ahead
from .step import LIFTS, STOPS, TIME_IS_UP
from .way import NOWHERE, arrive_at, force_on, look_ahead, peak_on, set_out

GOES_ON, NOT_TAKEN = -2, -3  # beside the reasons for which a phase returns
SHORTEST = 0.02  # panel in x; below, a series goes further
LONGEST_FROM_TURN = 2.0  # in x
ROUGH = 6e-14  # of a row's mean, in its last two coefficients: their integral is a fiftieth of it
TRIES = 4


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
        s, h = arrive_at(par, state, way, there, rows)
        if state[P_OPEN] != 0.0:
            n, _ = force_on(par, way.mu_hat, s, h, state[OMEGA])
            state[P_PEAK] = max(state[P_PEAK], n)
        here = there
        if there == end:
            arrive_at_bottom(state)
            break
        if there == bottom:
            bottom = NOWHERE
            state[ANGLE] = 0.0
            cross_bottom(state)
        else:
            weight = NOWHERE
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


@kernel
def stride(par, state, mu_hat, poles, rows, events):
    """Slip over the next panel, or to a turn and back over it.

    Returns why the phase or the run is over, ``GOES_ON``, or ``NOT_TAKEN`` with nothing changed: at a turn, near D = 0,
    at the start of a slip on a tie, where events crowd, and without friction (whose own rules are those of a series).
    """
    omega = state[OMEGA]
    if omega * omega == 0.0 or par[MU] == 0.0:  # the square of a rate of 1e-162 is no number
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
    if turns > 0.0:
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
            if at * length < LONGEST_FROM_TURN:
                code = there_and_back(par, state, mu_hat, panel, at, rows, events)
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
    if at_touch(par, state):
        cross_bottom(state)
    if turn(par, state, events):
        return TURNS_REACHED
    whole = way.whole  # that of the panel's chart: the turn may lie beyond it
    way = set_out(par, state, mu_hat, back, whole, False, -d, rows[Q_T + NODES])
    ahead = look_ahead(par, state, way, rows)
    if ahead.end == UNCLEAR:
        return GOES_ON
    return go(par, state, way, ahead, rows, events)
