"""The event log, what a motion leaves behind: phases, turns and pulses, one record of ``WIDTH`` numbers each."""

# mypy: allow-untyped-defs
from __future__ import annotations

from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    FROM_TOP,
    IMPACT,
    LAST_KIND,
    MODE,
    MOVING,
    MU,
    P_OPEN,
    PHASE_FROM_TOP,
    PHASE_T,
    PHASE_TOP_SIZE,
    RECORDED,
    RECORDS,
    SKID,
    SPIN,
    TOP_SIZE,
    TURN,
    TURN_ENERGY,
    TURNS,
    TURNS_DONE,
    WIDTH,
    XDOT,
    YDOT,
    T,
)
from .pulse import energy, note_energy, note_phase, velocity_of_g

ROOM = 8  # records that one turn of a loop may add


@kernel
def record(state, tag, events):
    """Put the state on the event log."""
    r = int(state[RECORDS]) * WIDTH
    events[r] = tag
    for i in range(MOVING):
        events[r + 1 + i] = state[i]
    for i in range(1 + MOVING, WIDTH):
        events[r + i] = 0.0  # of whatever was in the log before
    state[RECORDS] += 1
    state[RECORDED] += 1


@kernel
def begin(par, state, kind, events):
    """Enter a phase; one that goes on with the same kind is no new phase."""
    state[MODE] = kind
    state[XDOT], state[YDOT] = velocity_of_g(par, state)
    if state[P_OPEN] != 0.0:
        note_phase(state, kind)
    slips = kind in (SKID, SPIN) and par[MU] == 0.0
    if slips:
        note_energy(par, state)
    if state[LAST_KIND] != kind or kind == IMPACT:
        r = int(state[RECORDS]) * WIDTH
        record(state, kind, events)
        if slips:
            events[r + PHASE_FROM_TOP], events[r + PHASE_TOP_SIZE] = state[FROM_TOP], state[TOP_SIZE]
        state[LAST_KIND] = kind
        state[PHASE_T] = state[T]


@kernel
def turn(par, state, events):
    """phidot = 0: note it; True if it was the last one wanted."""
    r = int(state[RECORDS]) * WIDTH
    record(state, TURN, events)
    events[r + TURN_ENERGY] = energy(par, state)
    state[TURNS_DONE] += 1
    return state[TURNS_DONE] >= par[TURNS]
