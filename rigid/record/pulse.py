"""Inside a pulse: the stretch around a bottom crossing in which N > M g, and its measures.

Everything follows from the states at both ends: the impulses are those of the momentum of G, the friction
loss is the lost energy. A pulse in which the run begins or ends is listed as far as the run saw it, and marked as
cut: one that lacks its bottom too, if the disk was on its way from it (release) or to it (end) below the hoop's
centre. What is split at the bottom, its restitution, is then unknown. It is 0 where nothing was compressed before.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import nan, sqrt

from ..kernel.angle import trig
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    ANGLE,
    ECC,
    FROM_TOP,
    GAP,
    GYR,
    IMPACT,
    LAST_KIND,
    MU,
    OMEGA,
    ONE_MINUS_E,
    P_ANGLE,
    P_CROSSED,
    P_CUT,
    P_ENERGY,
    P_H,
    P_OPEN,
    P_PEAK,
    P_SEQUENCE,
    P_T,
    P_T_BOTTOM,
    P_TOP,
    P_WHOLE,
    P_XDOT,
    P_YDOT,
    PHASE_T,
    PULSE,
    PULSE_CUT,
    PULSE_SEQUENCE,
    PULSES_DONE,
    RECORDED,
    RECORDS,
    SEQUENCE_BASE,
    SLIP,
    TOP,
    TOP_SIZE,
    UN,
    WHOLE,
    WIDTH,
    XDOT,
    YDOT,
    T,
)

MOST_PHASES = float(SEQUENCE_BASE) ** 15  # of a pulse, in the digits that a float holds: what follows is not listed
OPENED_AT_BOTTOM = 1e-7  # of J_N, compression of a pulse that opens at the bottom, at a turn: a root of round-off
EDGE = 1e-12  # of N over M g: round-off at the edge of a pulse
NO_LOSS = 1e-14  # of an energy: round-off of the difference of two that are equal
ALIKE = 1e-10  # of an energy: what a landing takes is more, round-off less
JUST_OPEN = 1e-6  # sqrt(R/g): a pulse that the release at a touch opens begins at it
SAME_PLACE = 1e-12  # of phi: what a way there and back leaves
TOUCH = 1e-10  # of phi and of its rate squared, at a turn at the bottom: what many swings add up of round-off


@kernel
def velocity_of_g(par, state):
    """(xdot_G, ydot_G): while the hoop rolls, that of the rotation; on the floor, nothing but it upwards."""
    if state[UN] != 0.0 or state[GAP] != 0.0:
        return state[XDOT], state[YDOT]
    s, _, h, _ = trig(state[ANGLE], state[TOP])
    omega = state[OMEGA]
    along = state[XDOT] if state[SLIP] != 0.0 else omega * (par[ONE_MINUS_E] + par[ECC] * h)
    return along, -par[ECC] * s * omega


@kernel
def released(par, state):
    """Give G the velocity that belongs to the rotation and to the velocity of the contact point."""
    s, _, h, _ = trig(state[ANGLE], state[TOP])
    state[XDOT] = state[SLIP] + state[OMEGA] * (par[ONE_MINUS_E] + par[ECC] * h)
    state[YDOT] = state[UN] - par[ECC] * s * state[OMEGA]


@kernel
def energy(par, state):
    """Kinetic and potential energy over M g R, 0 when G is at floor level."""
    x, y = velocity_of_g(par, state)
    _, _, h, _ = trig(state[ANGLE], state[TOP])
    height = state[GAP] + par[ONE_MINUS_E] + par[ECC] * h
    return 0.5 * (x * x + y * y + par[GYR] * state[OMEGA] * state[OMEGA]) + height


@kernel
def note_energy(par, state):
    """Of a slip on a smooth floor that begins: the energy, 0 at rest on top, to as many digits as any slip before has
    known it. What begins near the top knows more of them than the whole energy has.
    """
    s, _, _, low = trig(state[ANGLE], state[TOP])
    moving = 0.5 * state[OMEGA] * state[OMEGA] * (par[GYR] + par[ECC] * s * par[ECC] * s)
    now, size, known = moving - par[ECC] * low, max(moving, par[ECC] * low), state[TOP_SIZE]
    if known == 0.0 or size < known or abs(now - state[FROM_TOP]) > ALIKE * size:
        state[FROM_TOP], state[TOP_SIZE] = now, size


@kernel
def watch(par, state, normal_force, events):
    """Open or close the pulse at the present state, N being the force from here on; True if one was closed
    that ends a run to the first whole pulse.
    """
    if normal_force > 1.0:
        if state[P_OPEN] == 0.0:
            open_pulse(par, state)
            # at its very edge a pulse that begins with the run is a whole one
            if state[T] == 0.0 and normal_force > 1.0 + EDGE:
                state[P_CUT] = 1.0
        state[P_PEAK] = max(state[P_PEAK], normal_force)
        return False
    if at_touch(par, state):
        cross_bottom(state)
        return False
    return close_pulse(par, state, events)


@kernel
def at_touch(par, state):
    """Whether the hoop turns right at the bottom, as one that was set slipping there does in every swing: N comes down
    to M g there and goes up again, and by round-off below it. The disk comes to the bottom in one pulse.
    """
    if par[MU] == 0.0 or state[SLIP] == 0.0 or state[T] - state[P_T] <= JUST_OPEN:
        return False
    return state[TOP] == 0.0 and abs(state[ANGLE]) <= TOUCH and state[OMEGA] * state[OMEGA] <= TOUCH


@kernel
def open_pulse(par, state):
    """Note the state at the start of a stretch with N > M g."""
    _, _, h, _ = trig(state[ANGLE], state[TOP])
    state[P_OPEN], state[P_CROSSED], state[P_CUT], state[P_PEAK] = 1.0, 0.0, 0.0, 0.0
    state[P_T], state[P_ANGLE], state[P_TOP], state[P_WHOLE] = (
        state[T],
        state[ANGLE],
        state[TOP],
        state[WHOLE],
    )
    state[P_XDOT], state[P_YDOT] = velocity_of_g(par, state)
    state[P_H] = h
    state[P_SEQUENCE] = state[LAST_KIND]
    state[P_ENERGY] = energy(par, state)


@kernel
def note_phase(state, kind):
    """The pulse goes on in a phase of another kind; a phase that lasted no time, and is no impact, was none."""
    last = state[P_SEQUENCE] % SEQUENCE_BASE
    if state[T] == state[PHASE_T] and last != IMPACT:
        state[P_SEQUENCE] = (state[P_SEQUENCE] - last) / SEQUENCE_BASE
        last = state[P_SEQUENCE] % SEQUENCE_BASE
    if last != kind and state[P_SEQUENCE] < MOST_PHASES:
        state[P_SEQUENCE] = state[P_SEQUENCE] * SEQUENCE_BASE + kind


@kernel
def cross_bottom(state):
    """The disk passes its lowest point."""
    if state[P_OPEN] != 0.0 and state[P_CROSSED] == 0.0:
        state[P_CROSSED] = 1.0
        state[P_T_BOTTOM] = state[T]


@kernel
def arrive_at_bottom(state):
    """At the end of a way: the disk is at its lowest point, and goes on, where only round-off lies between; whether
    this way or the next has the bottom in it is round-off too.
    """
    if state[TOP] == 0.0 and abs(state[ANGLE]) <= SAME_PLACE and state[OMEGA] != 0.0:
        state[ANGLE] = 0.0
        cross_bottom(state)


@kernel
def close_pulse(par, state, events):
    """End the stretch; a pulse over the bottom is then in the event log and counted. True if it was a whole one."""
    if state[P_OPEN] == 0.0:
        return False
    state[P_OPEN] = 0.0
    if state[P_CROSSED] == 0.0:
        if is_remainder(state):
            write_pulse(par, state, events)
        return False
    write_pulse(par, state, events)
    state[PULSES_DONE] += 1
    return state[P_CUT] == 0.0


@kernel
def is_remainder(state):
    """Whether the stretch is what is left of a pulse: of a hoop released below its centre, on the way up."""
    rising = state[TOP] != 0.0 or state[P_ANGLE] * (state[ANGLE] - state[P_ANGLE]) >= 0.0
    return state[P_CUT] != 0.0 and state[P_TOP] == 0.0 and rising


@kernel
def cut_pulse(par, state, events):
    """At the end of a run: put the pulse in which it ends into the event log."""
    falling = state[TOP] == 0.0 and state[ANGLE] * state[OMEGA] < 0.0
    if state[P_OPEN] != 0.0 and (state[P_CROSSED] != 0.0 or falling or is_remainder(state)):
        state[P_CUT] = 1.0
        write_pulse(par, state, events)
    state[P_OPEN] = 0.0


@kernel
def write_pulse(par, state, events):
    """The measures of the stretch that ends here."""
    x, y = velocity_of_g(par, state)
    _, _, h, _ = trig(state[ANGLE], state[TOP])
    e, y0 = par[ECC], state[P_YDOT]
    normal = y - y0 + (state[T] - state[P_T])
    r = int(state[RECORDS]) * WIDTH
    events[r] = PULSE
    events[r + 1], events[r + 2], events[r + 3], events[r + 4] = (
        state[P_T],
        state[P_ANGLE],
        state[P_TOP],
        state[P_WHOLE],
    )
    events[r + 5], events[r + 6], events[r + 7], events[r + 8] = state[T], state[ANGLE], state[TOP], state[WHOLE]
    events[r + 9] = normal
    events[r + 10] = x - state[P_XDOT]
    lost = state[P_ENERGY] - energy(par, state)
    events[r + 11] = lost if lost > NO_LOSS * state[P_ENERGY] else 0.0
    events[r + 12] = state[P_PEAK]
    compression = -y0 + (state[P_T_BOTTOM] - state[P_T])
    events[r + 13] = events[r + 14] = events[r + 15] = nan if state[P_CUT] != 0.0 else 0.0
    if state[P_CUT] == 0.0 and compression > OPENED_AT_BOTTOM * normal:
        work_in = -0.5 * y0 * y0 - e * state[P_H]
        work_out = 0.5 * y * y + e * h
        events[r + 13] = -y / y0 if y0 != 0 else 0.0
        events[r + 14] = (normal - compression) / compression
        events[r + 15] = sqrt(work_out / -work_in) if work_in < 0 else 0.0
    events[r + PULSE_CUT] = state[P_CUT]
    events[r + PULSE_SEQUENCE] = state[P_SEQUENCE]
    last = state[P_SEQUENCE] % SEQUENCE_BASE
    if state[T] == state[PHASE_T] and last != IMPACT and state[P_SEQUENCE] > last:
        # N falls below the weight where the phase changes: the next one is not of the pulse
        events[r + PULSE_SEQUENCE] = (state[P_SEQUENCE] - last) / SEQUENCE_BASE
    state[RECORDS] += 1
    state[RECORDED] += 1
