"""A motion without loss comes round: what it did in one period it does in all that follow.

Without friction every state determines the next for ever and no energy is lost, so a state that is met again, to
round-off, is met for ever; a hoop that rolls without slip to a turn on each side does so too. The event at which
states are compared is a turn (each second one: there and back) or, of a hoop that whirls round, the end of a pulse.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import floor, inf

from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    A_ANGLE,
    A_EVENT,
    A_KIND,
    A_OMEGA,
    A_PULSES,
    A_RECORDED,
    A_T,
    A_TURNS,
    A_WHOLE,
    A_X,
    A_XDOT,
    ANGLE,
    LAST_KIND,
    OMEGA,
    PHASE_T,
    PULSES_DONE,
    R_COUNT,
    R_PERIOD,
    R_PULSES,
    R_RECORDS,
    R_T,
    R_TURNS,
    R_WAY,
    R_WHOLE,
    RECORDED,
    RECORDS,
    REPEAT,
    T_END,
    T_FROM,
    TURNS,
    TURNS_DONE,
    WHOLE,
    WIDTH,
    X_C,
    XDOT,
    T,
)

NEVER, AT_TURN, AT_PASS, DONE = 0.0, 1.0, 2.0, 3.0  # values of A_EVENT
SAME = 1e-11  # of angle and velocities: a period is integrated to some 1e-13, a loss would be far above
MOST_REPEATS = 1e6


@kernel
def comes_round(par, state, event, events):
    """Whether the motion is where it was a period ago. If so, all whole periods but the last are passed over at once:
    the events gets a REPEAT in their place.
    """
    known = state[A_EVENT]
    if known == DONE or (known == AT_TURN and event == AT_PASS):
        return False
    turns = state[TURNS_DONE] - state[A_TURNS]
    if known == AT_TURN and turns < 2.0:
        return False
    close = abs(state[ANGLE] - state[A_ANGLE]) <= SAME and abs(state[OMEGA] - state[A_OMEGA]) <= SAME * (
        1 + abs(state[OMEGA])
    )
    close = close and abs(state[XDOT] - state[A_XDOT]) <= SAME * (1 + abs(state[XDOT]))
    # a phase begins at a turn, by round-off before or behind it: in its place it comes once in every period
    close = close and state[LAST_KIND] == state[A_KIND]
    round_again = known == event and turns == (2.0 if event == AT_TURN else 0.0) and close
    if round_again:
        repeat(par, state, events)
    if state[A_EVENT] != DONE:
        state[A_EVENT], state[A_KIND] = event, state[LAST_KIND]
        state[A_T], state[A_ANGLE], state[A_WHOLE], state[A_OMEGA], state[A_XDOT], state[A_X] = (
            state[T], state[ANGLE], state[WHOLE], state[OMEGA], state[XDOT], state[X_C],
        )  # fmt: skip
        state[A_TURNS], state[A_PULSES], state[A_RECORDED] = (
            state[TURNS_DONE], state[PULSES_DONE], state[RECORDED],
        )  # fmt: skip
    return round_again


@kernel
def repeat(par, state, events):
    """Go on by as many whole periods as leave one or two turns, or one period and a part, to the end of the run."""
    period, way, whole = state[T] - state[A_T], state[X_C] - state[A_X], state[WHOLE] - state[A_WHOLE]
    turns, pulses = state[TURNS_DONE] - state[A_TURNS], state[PULSES_DONE] - state[A_PULSES]
    count = 0.0
    if par[TURNS] < inf and turns > 0.0:
        count = floor((par[TURNS] - state[TURNS_DONE] - 1) / turns)
    elif par[T_END] < inf and period > 0.0:
        count = floor(min((par[T_END] - state[T]) / period, MOST_REPEATS + 1)) - 1
    if count < 1.0:
        return
    r = int(state[RECORDS]) * WIDTH
    for i in range(WIDTH):
        events[r + i] = 0.0  # of whatever was in the log before
    events[r] = REPEAT
    events[r + R_T], events[r + R_PERIOD], events[r + R_WAY], events[r + R_WHOLE] = state[T], period, way, whole
    events[r + R_COUNT], events[r + R_TURNS], events[r + R_PULSES] = count, turns, pulses
    events[r + R_RECORDS] = state[RECORDED] - state[A_RECORDED]
    state[RECORDS] += 1
    state[T] += count * period
    state[T_FROM] += count * period
    state[PHASE_T] += count * period
    state[X_C] += count * way
    state[WHOLE] += count * whole
    state[TURNS_DONE] += count * turns
    state[PULSES_DONE] += count * pulses
    state[A_EVENT] = DONE
