"""Which pulses a flexible motion has: those that the rigid hoop says lie ahead, each over its angles."""

from __future__ import annotations

from math import ceil, floor, inf, pi

from rigid import Motion, Pulse

from .builder import Builder
from .segment import Segment

LEAD = 0.5  # a flexible segment begins this many pulse lengths before the pulse, to let its start settle
AT_REST = 1e-6  # sqrt(g/R), phidot at a turn, and sqrt(R/g) within which times of it are one
BEHIND = 0.1  # of the time from a turn to the pulse, if that is less


def lead(motion: Motion, pulse: Pulse) -> float:
    """When to go over to the flexible hoop: a little before a pulse, and behind the turn from which the hoop comes."""
    turned = max((turn.t for turn in motion.turns if turn.t < pulse.t_start), default=0.0)
    behind = turned + BEHIND * (pulse.t_start - turned) if turned > 0 else 0.0
    return max(0.0, behind, pulse.t_start - LEAD * (pulse.t_end - pulse.t_start))


def ends_with_turn(motion: Motion, pulse: Pulse) -> bool:
    """Whether the hoop turns at the very end of a pulse.

    It does at its bottom, where N = M g, and the angle of that end is passed again only by a later pulse.
    """
    return abs(float(motion.at(pulse.t_end).omega)) < AT_REST


def goes_through_turns(motion: Motion, pulse: Pulse) -> bool:
    """Whether the hoop turns inside a pulse: then it may pass the angles of its ends more than once."""
    return any(pulse.t_start < turn.t < pulse.t_end - AT_REST for turn in motion.turns)


def over_bottom(pulse: Pulse) -> bool:
    """Whether the disk passes its lowest point, phi = pi (mod 2 pi), in a pulse; one that begins there does not."""
    start, end = (pulse.phi_start - pi) / (2 * pi), (pulse.phi_end - pi) / (2 * pi)
    return floor(start) < floor(end) or ceil(end) < ceil(start)


def turns_of(swing: Motion, pulses: list[Pulse], most: int | None) -> int:
    """After how many turns a swing is over: at the first, or at the first behind the pulse that goes on through it."""
    first = swing.turns[0].t if swing.turns else inf
    through = max((pulse.t_end for pulse in pulses if pulse.t_start < first), default=0.0)
    passed = sum(turn.t < through - AT_REST for turn in swing.turns) + 1
    return passed if most is None else min(passed, most)


def add_pulses(builder: Builder, segment: Segment, swing: Motion, pulses: list[Pulse], over: bool) -> None:
    """The pulses of a swing, each over its rigid one's angles; where the run is over inside one, the part before."""
    turned = [turn.t for turn in segment.turns()]
    for pulse in pulses:
        enters = segment.t_start if pulse.cut else segment.crossing(pulse.phi_start, segment.t_start)
        if enters is None:
            continue
        behind = sum(turn.t < pulse.t_end - AT_REST for turn in swing.turns)  # so many turns the hoop leaves the pulse
        after = max([enters, *turned[:behind]])
        leaves = segment.crossing(pulse.phi_end, after) if len(turned) >= behind else None
        cut = pulse.cut or leaves is None
        if leaves is None and over:
            leaves = segment.t_end
        if leaves is not None and leaves > enters:
            builder.list_pulse(segment.pulse(enters, leaves), cut)
