"""Which pulses a flexible motion has: those that the rigid hoop says lie ahead, each over its angles."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, floor, inf, pi

import numpy as np

from rigid import Kind, Motion, Pulse

from ..builder import Builder
from ..segment import Segment

INSTANTS = 200  # of a rolling that are looked at
LEAD = 0.5  # a flexible segment begins this many pulse lengths before the pulse, to let its start settle
AT_REST = 1e-6  # sqrt(R/g), and an angle, within which two turns are one
STILL_TURNS = 1e-3  # of the way to the farthest turn or pulse: a turn before it is that in which a swing began
BEHIND = 0.1  # of the time from a turn to the pulse, if that is less
LONGEST = 4.0  # times as long as the rigid hoop one may take for a pulse in which it turns
FORWARD, BACKWARD = 1, -1


def lead(motion: Motion, pulse: Pulse, rolls_to: float = 1.0) -> float:
    """When to go over to the flexible hoop: a little before a pulse, and behind the turn from which the hoop comes.

    Before it a hoop that creeps slips sooner than the rigid one, and is flexible from where the first rolling behind
    that turn begins to take more than the share ``rolls_to`` of mu N.
    """
    turned = max((turn.t for turn in motion.turns if turn.t < pulse.t_start), default=0.0)
    behind = turned + BEHIND * (pulse.t_start - turned) if turned > 0 else 0.0
    start = max(0.0, behind, pulse.t_start - LEAD * (pulse.t_end - pulse.t_start))
    if rolls_to >= 1:
        return start
    for roll in (phase for phase in motion.phases if phase.kind is Kind.ROLL and phase.t_end > behind):
        if roll.t_start >= start:
            break
        times = np.linspace(max(roll.t_start, behind), min(roll.t_end, start), INSTANTS)
        states = motion.at(times, "left")
        most = motion.scene.friction.mu * states.normal_force
        (beyond,) = np.nonzero(np.abs(states.friction_force) > rolls_to * most)
        if len(beyond):
            return float(times[max(beyond[0] - 1, 0)])
    return start


def comes_to(segment: Segment, motion: Motion, pulse: Pulse, after: float | None = None) -> float | None:
    """When the hoop comes, ``after`` its beginning or a turn, to the angle at which a pulse of the rigid one begins; to
    a pulse that a landing opens, when it has landed by then.
    """
    enters = segment.crossing(pulse.phi_start, segment.t_start if after is None else after)
    phases = pairwise(motion.phases)
    lands = any(before.kind is Kind.FLIGHT and phase.t_start == pulse.t_start for before, phase in phases)
    return segment.in_the_air(enters) if enters is not None and lands else enters


def goes_through_turns(motion: Motion, pulse: Pulse) -> bool:
    """Whether the hoop turns inside a pulse: then it may pass the angles of its ends more than once."""
    return any(pulse.t_start < turn.t < pulse.t_end - AT_REST for turn in motion.turns)


def over_bottom(pulse: Pulse) -> bool:
    """Whether the disk passes its lowest point, phi = pi (mod 2 pi), in a pulse; one that begins there does not."""
    return _is_over_bottom(pulse.phi_start, pulse.phi_end)


def _is_over_bottom(first: float, last: float) -> bool:
    start, end = (first - pi) / (2 * pi), (last - pi) / (2 * pi)
    return floor(start) < floor(end) or ceil(end) < ceil(start)


def swings(segment: Segment) -> bool:
    """Whether a segment goes over the bottom, and does not merely rock on a soft wall somewhere else."""
    phi = segment["phi"]
    return any(_is_over_bottom(float(phi[0]), float(most)) for most in (phi.min(), phi.max()))


def _turned(swing: Motion) -> list[float]:
    """When the rigid hoop of a swing turns.

    Where that begins the flexible one is turning already: a rigid hoop without its creep may go the other way, or go on
    a little and turn there.
    """
    began = swing.scene.release.phi0
    ways = [abs(turn.phi - began) for turn in swing.turns]
    farthest = max([*ways, *(abs(pulse.phi_end - began) for pulse in swing.pulses)], default=0.0)
    least = max(AT_REST, STILL_TURNS * farthest)
    return [turn.t for turn, way in zip(swing.turns, ways, strict=True) if way > least]


def turns_of(swing: Motion, pulses: list[Pulse], most: int | None) -> int:
    """After how many turns a swing is over: at the first, or at the first behind the pulse that goes on through it."""
    turned = _turned(swing)
    first = turned[0] if turned else inf
    through = max((pulse.t_end for pulse in pulses if pulse.t_start < first), default=0.0)
    passed = sum(t < through - AT_REST for t in turned) + 1
    return passed if most is None else min(passed, most)


def _ways(segment: Segment, swing: Motion, pulse: Pulse) -> tuple[float | None, float | None]:
    """When the hoop comes to a pulse, and when it leaves it at its end."""
    turned = [turn.t for turn in segment.turns()]
    before = sum(t < pulse.t_start for t in _turned(swing))  # so many turns the hoop comes to it
    if len(turned) < before:
        return None, None
    behind_turn = max([segment.t_start, *turned[:before]])
    enters = segment.t_start if pulse.cut else comes_to(segment, swing, pulse, behind_turn)
    if enters is None:
        return None, None
    behind = sum(t < pulse.t_end - AT_REST for t in _turned(swing))  # so many turns the hoop leaves the pulse
    after = max([enters, *turned[:behind]])
    return enters, segment.crossing(pulse.phi_end, after) if len(turned) >= behind else None


def _is_next(swing: Motion, pulse: Pulse) -> bool:
    """Whether the rigid hoop comes to a pulse without a turn on the way."""
    return not any(t < pulse.t_start for t in _turned(swing))


def _thrown_back(segment: Segment, swing: Motion, pulse: Pulse) -> float | None:
    """When a hoop that was over the bottom in a pulse and turned back there is out where it came in, if it is."""
    phi = segment["phi"]
    onward = pulse.phi_end > pulse.phi_start
    out = phi[-1] <= pulse.phi_start if onward else phi[-1] >= pulse.phi_start
    farthest = float(phi.max() if onward else phi.min())
    if not (out and _is_next(swing, pulse) and _is_over_bottom(pulse.phi_start, farthest)):
        return None
    return max(segment.crossings(pulse.phi_start), default=None)


def unfinished(segment: Segment, swing: Motion, pulses: list[Pulse]) -> Pulse | None:
    """The pulse in whose angles the hoop is at the end of a segment, having come to it and not left it at its end.

    A soft wall may turn it there, back and forth. One that stays for too long does not pass it.
    """
    phi = float(segment["phi"][-1])
    for pulse in pulses:
        enters, leaves = _ways(segment, swing, pulse)
        if enters is None or leaves is not None or segment.t_end - enters > LONGEST * (pulse.t_end - pulse.t_start):
            continue
        if _is_next(swing, pulse) and (phi - pulse.phi_start) * (phi - pulse.phi_end) < 0:
            return pulse
    return None


def add_pulses(builder: Builder, segment: Segment, swing: Motion, pulses: list[Pulse], over: bool) -> int:
    """The pulses of a swing, each over its rigid one's angles; where the run is over inside one, the part before, and
    where the hoop turned back in one, until it was out where it came in.

    Returns
    -------
    int
        What the last whole pulse over the bottom was: FORWARD, BACKWARD where the hoop turned back in it; 0 without
        one.
    """
    found = 0
    for pulse in pulses:
        enters, leaves = _ways(segment, swing, pulse)
        if enters is None:
            continue
        out = _thrown_back(segment, swing, pulse) if leaves is None else None
        back, leaves = out is not None, out if leaves is None else leaves
        cut = pulse.cut or leaves is None
        if leaves is None and over:
            leaves = segment.t_end
        if leaves is not None and leaves > enters:
            known = len(builder.pulses)
            builder.list_pulse(segment.pulse(enters, leaves), cut)
            listed = builder.pulses[known:]
            if listed and not listed[0].cut and over_bottom(pulse if back else listed[0]):
                found = BACKWARD if back else FORWARD
    return found
