"""What a batch keeps of the event log: counts, and the first turns and pulses of each scene as rows of arrays."""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import pi
from typing import NamedTuple

from numpy import float64
from numpy.typing import NDArray

from ..kernel.angle import angle_of
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    IMPACT,
    PULSE,
    PULSE_CUT,
    PULSE_SEQUENCE,
    R_COUNT,
    R_PERIOD,
    R_PULSES,
    R_RECORDS,
    R_TURNS,
    R_WHOLE,
    RECORDS,
    REPEAT,
    TURN,
    TURN_ENERGY,
    WIDTH,
)

CODE, T_STOP, PHASE_COUNT, TURN_COUNT, PULSE_COUNT, HOP_COUNT, JAM_COUNT = range(7)  # columns of ``Rows.ends``
END_VALUES = 7
TURN_VALUES = 4  # t, phi, slip velocity, energy
PULSE_VALUES = 13  # t, phi at both ends; J_N, J_F, loss, peak; three restitutions; whether it is cut; its phases


class Rows(NamedTuple):
    """How each of n scenes ended, (n, 7), its turns, (n, turns, 4), and its pulses, (n, pulses, 13)."""

    ends: NDArray[float64]
    turns: NDArray[float64]
    pulses: NDArray[float64]


class Repetition(NamedTuple):
    """How often something comes again, and how much later and further round each time."""

    times: float
    period: float
    angle: float


@kernel
def gather(state, events, scene, rows):
    """Read the event log: what it counts into ``ends``, the first turns and pulses of the scene into their arrays."""
    ends, turns, pulses = rows.ends, rows.turns, rows.pulses
    for record in range(int(state[RECORDS])):
        r = record * WIDTH
        n_turns, n_pulses = int(ends[scene, TURN_COUNT]), int(ends[scene, PULSE_COUNT])
        if events[r] == TURN:
            if n_turns < turns.shape[1]:
                turns[scene, n_turns, 0] = events[r + 1]
                turns[scene, n_turns, 1] = angle_of(events[r + 2], events[r + 3], events[r + 4])
                turns[scene, n_turns, 2] = events[r + 6]
                turns[scene, n_turns, 3] = events[r + TURN_ENERGY]
            ends[scene, TURN_COUNT] += 1
        elif events[r] == PULSE:
            if n_pulses < pulses.shape[1]:
                pulses[scene, n_pulses, 0] = events[r + 1]
                pulses[scene, n_pulses, 1] = events[r + 5]
                pulses[scene, n_pulses, 2] = angle_of(events[r + 2], events[r + 3], events[r + 4])
                pulses[scene, n_pulses, 3] = angle_of(events[r + 6], events[r + 7], events[r + 8])
                for i in range(7):
                    pulses[scene, n_pulses, 4 + i] = events[r + 9 + i]
                pulses[scene, n_pulses, 11] = events[r + PULSE_CUT]
                pulses[scene, n_pulses, 12] = events[r + PULSE_SEQUENCE]
            ends[scene, PULSE_COUNT] += 1
        elif events[r] == REPEAT:
            count = events[r + R_COUNT]
            more = Repetition(count, events[r + R_PERIOD], events[r + R_WHOLE] * 2 * pi)
            again(turns, scene, n_turns, int(events[r + R_TURNS]), more, 1)
            again(pulses, scene, n_pulses, int(events[r + R_PULSES]), more, 2)
            ends[scene, TURN_COUNT] += count * events[r + R_TURNS]
            ends[scene, PULSE_COUNT] += count * events[r + R_PULSES]
            ends[scene, PHASE_COUNT] += count * (events[r + R_RECORDS] - events[r + R_TURNS] - events[r + R_PULSES])
        else:
            ends[scene, PHASE_COUNT] += 1
            if events[r] == IMPACT:
                ends[scene, JAM_COUNT] += 1  # a landing too, until the hops are known


@kernel
def again(rows, scene, done, length, more, pairs):
    """The last ``length`` of the ``done`` rows again, as often as ``more`` says and there is room; the first ``pairs``
    columns are times, as many after them angles.
    """
    if length < 1 or done > rows.shape[1]:
        return
    for place in range(done, min(rows.shape[1], done + int(more.times) * length)):
        times, source = (place - done) // length + 1, done - length + (place - done) % length
        for i in range(rows.shape[2]):
            rows[scene, place, i] = rows[scene, source, i]
        for i in range(pairs):
            rows[scene, place, i] += times * more.period
            rows[scene, place, pairs + i] += times * more.angle
