"""A rolling phase: from one place of interest to the next, each at a closed-form time.

A pass over the bottom meets, in this order where they exist: slip on the way in, the start of the pulse, the
bottom, the end of the pulse, slip on the way out, and the turn (or the top). Passes without slip repeat for
ever at the same cost each.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import floor, inf, sqrt
from typing import NamedTuple

from ...kernel.angle import advance_between, trig
from ...kernel.compile import kernel
from ...kernel.layout import (  # fmt: skip
    ANGLE,
    CREEPS,
    FIRST_PULSE,
    MORE,
    MU,
    OMEGA,
    P_OPEN,
    P_PEAK,
    PERIOD,
    PHASE_OVER,
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
from ...record.cycle import AT_TURN, comes_round
from ...record.events import ROOM, turn
from ...record.pulse import cross_bottom, watch
from .closed_form import ceiling, rolling_forces, rolling_time
from .passes import (  # fmt: skip
    BOTTOM,
    PULSE_BEGINS,
    PULSE_ENDS,
    SLIP_IN,
    SLIP_OUT,
    Place,
    bottom_of,
    direction,
    next_place,
    pass_from,
    place_in,
    put,
    side_of,
)

LISTED_PERIODS = 2000.0  # of a motion that repeats itself for ever; its turns and pulses after that are not listed
MOST_PASSES = 2.0**53  # of the bottom that are counted one by one: what time can tell apart
JUST_INSIDE = 1.0 + 1e-15  # N over M g at the edge of a pulse, on its side


class Origin(NamedTuple):
    """Place of the centre and angle from which the way is counted."""

    x: float
    a: float
    top: float
    whole: float


@kernel
def arrive(zeta, state, side, place, d, bottom, origin):
    """Go to a place: angle, phidot and the way rolled."""
    put(state, side, place, bottom)
    _, _, h, _ = trig(state[ANGLE], state[TOP])
    state[OMEGA] = d * sqrt(2 * max(place.headroom, 0.0) / (zeta + 2 * h))
    state[SLIP] = 0.0
    state[X_C] = origin.x + advance_between(origin.a, origin.top, origin.whole, state[ANGLE], state[TOP], state[WHOLE])


@kernel
def roll_on(par, state, time):
    """Advance rolling by ``time``, over any number of turns."""
    zeta, omega, a, top = par[ZETA], state[OMEGA], state[ANGLE], state[TOP]
    s, _, h, low = trig(a, top)
    if (omega == 0.0 and a == 0.0) or time == 0.0:
        return
    g, below = ceiling(zeta, omega, h, low)
    d = direction(omega, s)
    bottom = bottom_of(a, top, state[WHOLE], d)
    t_turn = rolling_time(zeta, g, min(g, 2.0), max(below, 0.0), max(-below, 0.0))
    since = rolling_time(zeta, g, h, low, 0.5 * omega * omega * (zeta + 2 * h))
    reach = (since if side_of(a, top, d) * d > 0 else -since) + time
    if t_turn < inf:
        passes = floor(min((0.5 * reach + 0.5 * t_turn) / t_turn, MOST_PASSES))
        reach -= 2 * t_turn * passes
        if below <= 0:
            bottom += d * passes
        elif passes % 2 == 1:
            d = -d
    origin = Origin(state[X_C], a, top, state[WHOLE])
    there = place_in(zeta, g, below, min(abs(reach), t_turn))
    arrive(zeta, state, d if reach > 0 else -d, there, d, bottom, origin)


@kernel
def ends_of_rolling(par, state, way, below):
    """Of a motion that rolls for ever, whose period is noted: when enough of it has been seen, and up to when it is
    listed.
    """
    stop = inf
    listed = inf
    if way.lossless:
        state[PERIOD] = 2 * way.far_end.time if below <= 0 else 4 * way.far_end.time
        if par[UNTIL] == REST or (par[TURNS] < inf and below <= 0):
            stop = state[PHASE_T] + state[PERIOD]  # from its start, wherever the log of its records may end
        if par[T_END] < inf and state[PERIOD] < inf:
            listed = state[PHASE_T] + LISTED_PERIODS * state[PERIOD]
    return stop, listed


@kernel
def enter_slip(par, state, pull):
    """The end of rolling: which way F pulls, and N as the peak of a pulse that is open."""
    s, _, _, _ = trig(state[ANGLE], state[TOP])
    state[PULL] = -pull if s < 0.0 else pull
    note_force(par, state)


@kernel
def note_force(par, state):
    """N of rolling as the peak of a pulse that is open."""
    if state[P_OPEN] != 0.0:
        n, _ = rolling_forces(par, state[OMEGA], state[ANGLE], state[TOP])
        state[P_PEAK] = max(state[P_PEAK], n)


@kernel
def roll(par, state, work, events):
    """Roll to the next slip, through as many pulses and turns as come before it."""
    zeta, omega, a, top = par[ZETA], state[OMEGA], state[ANGLE], state[TOP]
    s, _, h, low = trig(a, top)
    if omega == 0.0 and a == 0.0:
        state[PERIOD] = inf
        if par[T_END] < inf:
            state[T] = par[T_END]
            return TIME_REACHED
        return RESTS
    g, below = ceiling(zeta, omega, h, low)
    d = direction(omega, s)
    bottom = bottom_of(a, top, state[WHOLE], d)
    way = pass_from(par, state, g, below, d, work)
    heading = side_of(a, top, d) * d  # -1 towards the bottom, 1 away from it
    now = heading * way.now
    stop, listed = ends_of_rolling(par, state, way, below)
    origin = Origin(state[X_C], a, top, state[WHOLE])
    n, _ = rolling_forces(par, omega, a, top)
    inside = h < way.h_pulse or (h == way.h_pulse and heading < 0)
    if watch(par, state, max(n, JUST_INSIDE) if inside else min(n, 1.0), events) and par[UNTIL] == FIRST_PULSE:
        return PULSE_OVER
    while True:
        there, which = next_place(way, now)
        time = state[T] + max(there - now, 0.0)
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
            reach = now + (limit - state[T])
            state[T] = limit
            place = place_in(zeta, g, below, abs(reach))
            arrive(zeta, state, d if reach > 0 else -d, place, d, bottom, origin)
            note_force(par, state)
            if limit < par[T_END]:
                return WHIRLS if below <= 0 and par[UNTIL] != REST else ROLLS
            return TIME_REACHED
        state[T] = time
        now = there
        if which == SLIP_IN:
            arrive(zeta, state, -d, way.slip_in, d, bottom, origin)
            enter_slip(par, state, way.pull_in)
            return PHASE_OVER
        if which == SLIP_OUT:
            arrive(zeta, state, d, way.slip_out, d, bottom, origin)
            enter_slip(par, state, way.pull_out)
            return PHASE_OVER
        if which == PULSE_BEGINS or which == PULSE_ENDS:
            arrive(zeta, state, -d if which == PULSE_BEGINS else d, way.pulse_edge, d, bottom, origin)
            if watch(par, state, JUST_INSIDE if which == PULSE_BEGINS else 1.0, events) and par[UNTIL] == FIRST_PULSE:
                return PULSE_OVER
        elif which == BOTTOM:
            arrive(zeta, state, d, Place(0.0, 0.0, 0.0, g), d, bottom, origin)
            note_force(par, state)
            cross_bottom(state)
        else:
            arrive(zeta, state, d, way.far_end, d, bottom, origin)
            now = -way.far_end.time
            if below <= 0:
                bottom += d
            else:
                d = -d
                if turn(par, state, events):
                    return TURNS_REACHED
                before = state[X_C]
                again = par[MU] == 0.0 or (way.lossless and par[TURNS] < inf)
                if again and comes_round(par, state, AT_TURN, events) and par[UNTIL] == REST:
                    return SLIDES
                origin = Origin(origin.x + (state[X_C] - before), origin.a, origin.top, origin.whole)
            if state[RECORDS] * WIDTH + ROOM * WIDTH > len(events):
                return MORE
