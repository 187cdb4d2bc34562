"""A rolling phase: from one place of interest to the next, each at a closed-form time.

A pass over the bottom meets, in this order where they exist: slip on the way in, the start of the pulse, the
bottom, the end of the pulse, slip on the way out, and the turn (or the top). Passes without slip repeat for
ever at the same cost each.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import asin, atan, floor, inf, sqrt, tan

from ..kernel.angle import advance_between, trig
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    ANGLE,
    CREEPS,
    FIRST_PULSE,
    MORE,
    MU,
    OMEGA,
    P_OPEN,
    P_PEAK,
    PERIOD,
    PHASE_T,
    PULL,
    PULSE_OVER,
    RECORDS,
    REST,
    RESTS,
    ROLLS,
    ROLLS_ON,
    SLIDES,
    SLIP,
    T_END,
    TIME_REACHED,
    TOP,
    TURNS,
    TURNS_REACHED,
    UNTIL,
    WHIRLS,
    WHOLE,
    WIDTH,
    X_C,
    ZETA,
    T,
)
from ..record.cycle import AT_TURN, comes_round
from ..record.log import ROOM, turn
from ..record.pulse import cross_bottom, watch
from .rolling import (
    angle_at_time,
    ceiling,
    pulse_edge,
    rest_to_ceiling,
    rolling_forces,
    rolling_time,
    slip_edges,
    turning_point,
)  # fmt: skip
from .slipping import S_MINUS, S_PLUS, S_SIN

PHASE_OVER = -1
LISTED_PERIODS = 2000.0  # of a motion that repeats itself for ever; its turns and pulses after that are not listed


@kernel
def half_angle(h):
    """(|offset|, chart) of a height h = 1 + cos phi."""
    if h <= 1.0:
        return 2 * asin(sqrt(0.5 * h)), 0.0
    return 2 * asin(sqrt(max(0.0, 0.5 * (2 - h)))), 1.0


@kernel
def time_at(zeta, g, below, offset, top):
    """Time from the bottom to an angle."""
    _, _, h, low = trig(offset, top)
    return rolling_time(zeta, g, h, low, rest_to_ceiling(g, below, offset, top))


@kernel
def arrive(state, zeta, rest, d, x_start, a0, top0, whole0):
    """phidot and the way rolled at the angle just placed, from G - h = ``rest``."""
    _, _, h, _ = trig(state[ANGLE], state[TOP])
    state[OMEGA] = d * sqrt(2 * max(rest, 0.0) / (zeta + 2 * h))
    state[SLIP] = 0.0
    state[X_C] = x_start + advance_between(a0, top0, whole0, state[ANGLE], state[TOP], state[WHOLE])


@kernel
def place(state, psi_sign, offset, top, bottom):
    """Set the angle at |psi| given as (|offset|, chart), on the side ``psi_sign`` of the bottom number
    ``bottom``.
    """
    if top == 0.0:
        state[ANGLE], state[TOP], state[WHOLE] = psi_sign * offset, 0.0, bottom
    elif psi_sign > 0:
        state[ANGLE], state[TOP], state[WHOLE] = -offset, 1.0, bottom + 1
    else:
        state[ANGLE], state[TOP], state[WHOLE] = offset, 1.0, bottom


@kernel
def roll_on(par, state, time):
    """Advance rolling by ``time``, over any number of turns."""
    zeta, omega, a, top = par[ZETA], state[OMEGA], state[ANGLE], state[TOP]
    s, _, h, low = trig(a, top)
    if (omega == 0.0 and a == 0.0) or time == 0.0:
        return
    g, below = ceiling(zeta, omega, h, low)
    d = 1.0 if (omega > 0 or (omega == 0.0 and s > 0)) else -1.0
    bottom = state[WHOLE]
    if top != 0.0 and (a < 0.0 or (a == 0.0 and d < 0)):
        bottom -= 1.0
    side = a if top == 0.0 else -a
    if a == 0.0:
        side = d if top == 0.0 else -d
    t_turn = rolling_time(zeta, g, min(g, 2.0), max(below, 0.0), max(-below, 0.0))
    since = rolling_time(zeta, g, h, low, 0.5 * omega * omega * (zeta + 2 * h))
    reach = (since if side * d > 0 else -since) + time
    if t_turn < inf:
        passes = floor((reach + t_turn) / (2 * t_turn))
        reach -= 2 * t_turn * passes
        if below <= 0:
            bottom += d * passes
        elif passes % 2 == 1:
            d = -d
    x_start, whole = state[X_C], state[WHOLE]
    offset, chart_now, rest = angle_at_time(zeta, g, below, min(abs(reach), t_turn))
    place(state, d if reach > 0 else -d, offset, chart_now, bottom)
    arrive(state, zeta, rest, d, x_start, a, top, whole)


@kernel
def roll(par, state, work, tape):
    """Roll to the next slip, through as many pulses and turns as come before it."""
    zeta = par[ZETA]
    a, top, omega = state[ANGLE], state[TOP], state[OMEGA]
    s, _, h, low = trig(a, top)
    g, below = ceiling(zeta, omega, h, low)
    if omega == 0.0 and a == 0.0:
        state[PERIOD] = inf
        if par[T_END] < inf:
            state[T] = par[T_END]
            return TIME_REACHED
        return RESTS
    d = 1.0 if (omega > 0 or (omega == 0.0 and s > 0)) else -1.0
    bottom = state[WHOLE]
    if top != 0.0 and (a < 0.0 or (a == 0.0 and d < 0)):
        bottom -= 1.0
    psi_sign = (1.0 if a > 0 else -1.0) if top == 0.0 else (-1.0 if a > 0 else 1.0)
    if a == 0.0:
        psi_sign = d if top == 0.0 else -d
    inner, inner_top, inner_pull, outer, outer_top, outer_pull = slip_edges(
        par, g, below, a, top, work[S_PLUS], work[S_MINUS], work[S_SIN]
    )
    turn_a, turn_top = turning_point(g, below)
    if omega == 0.0:
        turn_a, turn_top = abs(a), top
    t_turn = rolling_time(zeta, g, min(g, 2.0), max(below, 0.0), max(-below, 0.0))
    h_pulse = pulse_edge(zeta, g)
    edge_a, edge_top = half_angle(h_pulse)
    t_edge = rolling_time(zeta, g, h_pulse, 2 - h_pulse, rest_to_ceiling(g, below, edge_a, edge_top))
    cur = psi_sign * d * rolling_time(zeta, g, h, low, 0.5 * omega * omega * (zeta + 2 * h))
    inner_a, t_inner = 0.0, -inf
    if inner >= 0:
        inner_a = 2 * atan(inner)
        t_inner = -time_at(zeta, g, below, inner_a, inner_top)
        if inner == tan(0.5 * abs(a)) and inner_top == top:
            t_inner = min(cur, -cur)
    outer_a, t_outer = 0.0, inf
    if outer >= 0:
        outer_a = 2 * atan(outer)
        t_outer = time_at(zeta, g, below, outer_a, outer_top)
        if outer == tan(0.5 * abs(a)) and outer_top == top:
            t_outer = max(cur, -cur)
    forever = inner < 0 and outer < 0
    stop = inf
    listed = inf
    if forever:
        state[PERIOD] = 2 * t_turn if below <= 0 else 4 * t_turn
        if par[UNTIL] == REST or (par[TURNS] < inf and below <= 0):
            stop = state[T] + state[PERIOD]
        if par[T_END] < inf and state[PERIOD] < inf:
            listed = state[PHASE_T] + LISTED_PERIODS * state[PERIOD]
    x_start = state[X_C]
    a0, top0, whole0 = a, top, state[WHOLE]
    n, _ = rolling_forces(par, omega, a, top)
    inside = h < h_pulse or (h == h_pulse and psi_sign * d < 0)
    if watch(par, state, max(n, 1.0 + 1e-15) if inside else min(n, 1.0), tape) and par[UNTIL] == FIRST_PULSE:
        return PULSE_OVER
    while True:
        # the next place on the way, by its time from the bottom: 0 slip, 1 pulse begins, 2 bottom, 3 pulse
        # ends, 4 slip, 5 turn
        at, where = t_turn, 5
        if outer >= 0 and cur <= t_outer:
            at, where = t_outer, 4
        if cur < t_edge < at:
            at, where = t_edge, 3
        if cur < 0.0:
            at, where = 0.0, 2
            if inner >= 0:
                at, where = t_inner, 0
        if cur < -t_edge and (where == 2 or -t_edge < at):
            at, where = -t_edge, 1
        time = state[T] + max(at - cur, 0.0)
        limit = min(par[T_END], stop)
        if time == inf and limit == inf:
            state[PERIOD] = inf
            return CREEPS
        if time > listed and time < limit:
            roll_on(par, state, par[T_END] - state[T])
            state[T] = par[T_END]
            state[P_OPEN] = 0.0
            return ROLLS_ON
        if time >= limit:
            reach = cur + (limit - state[T])
            offset, otop, rest = angle_at_time(zeta, g, below, abs(reach))
            place(state, (1.0 if reach > 0 else -1.0) * d, offset, otop, bottom)
            state[T] = limit
            arrive(state, zeta, rest, d, x_start, a0, top0, whole0)
            if limit < par[T_END]:
                return WHIRLS if below <= 0 and par[UNTIL] != REST else ROLLS
            return TIME_REACHED
        state[T] = time
        cur = at
        if where == 0 or where == 4:
            if where == 0:
                place(state, -d, inner_a, inner_top, bottom)
                rest = rest_to_ceiling(g, below, inner_a, inner_top)
            else:
                place(state, d, outer_a, outer_top, bottom)
                rest = rest_to_ceiling(g, below, outer_a, outer_top)
            arrive(state, zeta, rest, d, x_start, a0, top0, whole0)
            s, _, _, _ = trig(state[ANGLE], state[TOP])
            state[PULL] = inner_pull if where == 0 else outer_pull
            if s < 0.0:
                state[PULL] = -state[PULL]
            if state[P_OPEN] != 0.0:
                n, _ = rolling_forces(par, state[OMEGA], state[ANGLE], state[TOP])
                state[P_PEAK] = max(state[P_PEAK], n)
            return PHASE_OVER
        if where == 1 or where == 3:
            side = -d if where == 1 else d
            place(state, side, edge_a, edge_top, bottom)
            arrive(state, zeta, rest_to_ceiling(g, below, edge_a, edge_top), d, x_start, a0, top0, whole0)
            if watch(par, state, 1.0 + 1e-15 if where == 1 else 1.0, tape) and par[UNTIL] == FIRST_PULSE:
                return PULSE_OVER
        elif where == 2:
            place(state, d, 0.0, 0.0, bottom)
            arrive(state, zeta, g, d, x_start, a0, top0, whole0)
            n, _ = rolling_forces(par, state[OMEGA], 0.0, 0.0)
            if state[P_OPEN] != 0.0:
                state[P_PEAK] = max(state[P_PEAK], n)
            cross_bottom(state)
        elif below <= 0:
            place(state, d, 0.0, 1.0, bottom)
            arrive(state, zeta, -below, d, x_start, a0, top0, whole0)
            bottom += d
            cur = -t_turn
            if state[RECORDS] * WIDTH + ROOM * WIDTH > len(tape):
                return MORE
        else:
            place(state, d, turn_a, turn_top, bottom)
            arrive(state, zeta, 0.0, d, x_start, a0, top0, whole0)
            d = -d
            cur = -t_turn
            if turn(par, state, tape):
                return TURNS_REACHED
            before = state[X_C]
            again = (par[MU] == 0.0 or (forever and par[TURNS] < inf)) and comes_round(par, state, AT_TURN, tape)
            if again and par[UNTIL] == REST:
                return SLIDES
            x_start += state[X_C] - before
            if state[RECORDS] * WIDTH + ROOM * WIDTH > len(tape):
                return MORE
