"""``resolve = "all"``: flexible from the release on, swing by swing."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil, floor, pi, sqrt
from typing import NamedTuple

import numpy as np

from rigid import Motion, Pulse, Run, Scene

from ..builder import Builder
from ..models.select import Hoop
from ..models.state import State
from ..segment import Segment
from ..start.handover import hand_over
from ..time.adaptive import MarchError
from ..time.course import Stop
from ..time.events import Ends
from .ahead import from_here, from_release, rest_of, slips_no_more, whirls
from .pulses import BACKWARD, add_pulses, swings, turns_of, unfinished
from .told import Ending, Progress, pulse_over, run_over

SWINGS = 4.0  # of the rigid hoop's
STANDS = 1e-6  # angle about which a hoop that stands may rock; by round-off it does by 1e-15 or so
ROUND_OFF = 37.0  # -log(1e-16): powers of e in which a hoop comes next to the top, and in which it leaves it


class Swing(NamedTuple):
    """A swing that lies ahead."""

    rigid: Motion  # that of the rigid hoop, released from the flexible one's state
    pulses: list[Pulse]  # of it
    run: Run  # how far there is still to go
    until: float  # the time at which to stop


def throughout(scene: Scene, hoop: Hoop, builder: Builder, progress: Progress) -> Ending:
    """Run a scene; each pulse is measured over the rigid hoop's interval.

    A swing ends at a turn where no pulse goes on, or where the disk passes the top. The rigid hoop that says where its
    pulse lies, and whether the run is at rest, is released from the flexible one's state at its beginning. A run is at
    rest behind a swing over the bottom alone, not where a soft hoop rocks beside its release. One that rests from the
    beginning, and is to be run to a time, is marched to that without turns and pulses, which would be of round-off.
    """
    reference = from_release(scene, scene.run)
    # the rates of a start are those of the motion that goes on, wherever the run ends
    onwards = reference if scene.run.t_end is None else from_release(scene, Run(until="pulse"))
    try:
        state = hand_over(hoop, onwards, 0.0)
    except MarchError as error:
        return error.stop
    if reference.t_end == 0 and scene.run.t_end is None and scene.solve.start == "equilibrium":
        builder.add_rigid(reference, 0.0)
        return reference
    run: Run | None = scene.run
    whirled = swung_through = False
    horizon = scene.run.t_end if scene.run.t_end is not None else max(reference.t_end, 1e-3)
    watch = progress.watch(0.0, 1.0, lambda t, phi: t / horizon)
    if run is not None and run.t_end is not None and _stands(reference):
        state, stop = _left_alone(scene, builder, hoop, state, watch)
        if stop is not None:
            return stop
        run = rest_of(scene.run, builder)
    while run is not None:
        ahead = Run(until="rest" if run.until == "rest" else "pulse")
        # whether it slips at the release is said by the scene: all points of a brush may stick in the first instant
        swing = from_here(scene, hoop, state, ahead) if builder.pieces else from_release(scene, ahead)
        if run.until == "rest" and swung_through and slips_no_more(swing):
            return swing
        # a swing that begins at a turn has no rest of a pulse to list, and a pulse that goes on through one is one
        pulses = [p for p in swing.pulses if not p.cut or (p.t_start == 0 and not builder.pieces)]
        began, limit = state.t, builder.t + longest(scene, swing.t_end)
        until = limit if scene.run.t_end is None else scene.run.t_end
        state, segment, stop = _swung(scene, hoop, builder, state, Swing(swing, pulses, run, until), watch)
        run = rest_of(scene.run, builder)
        way = add_pulses(builder, segment, swing, pulses, over=stop is None and run is None)
        if stop is None and state.t == began and run is not None:
            stop = Stop(": a swing of no length", state.t, float(state.pos[2]))
        elif stop is None and scene.run.t_end is None and state.t >= limit:
            stop = Stop(": a rigid hoop would have turned by now, or been over the top", state.t)
        if stop is not None:
            return stop
        if scene.run.until == "pulse" and way:
            return pulse_over(way == BACKWARD)
        swung_through = swings(segment)
        onward = None
        if run is not None and run.turns is not None and not segment.turns():
            onward = from_here(scene, hoop, state, Run(turns=1))
        goes_round = onward is not None and whirls(onward)
        if onward is not None and goes_round and whirled:
            return onward
        whirled = goes_round
    return run_over(scene.run)


def _stands(motion: Motion) -> bool:
    """Whether a rigid hoop does not turn at all: right above or below the contact, at rest or on a smooth floor."""
    ends = motion.at(np.array([0.0, motion.t_end]))
    return len(motion.phases) == 1 and not ends.omega.any() and not ends.alpha.any()


def _left_alone(
    scene: Scene, builder: Builder, hoop: Hoop, state: State, watch: Callable[[float, float], None] | None
) -> tuple[State, Stop | None]:
    """March a hoop whose rigid one stands to the end of the run, or until it has left its place, as one on top does
    from round-off in time: before that it has no turns, and no pulses.
    """
    phi = float(state.pos[2])
    ends = Ends(scene.run.t_end or 0.0, phi - STANDS, phi + STANDS)
    state, _, stop = builder.march(hoop, state, ends, scene.solve.rtol, watch)
    builder.turns.clear()
    return state, stop


def longest(scene: Scene, swing: float) -> float:
    """Time in which a hoop has turned, or been over the top, whose swing the rigid one does in that time.

    Next to the top they come to it and leave it by powers of e, no closer than round-off, but each as close as its own
    energy has it: the flexible one may be there for long where the rigid one is not.
    """
    hoop = scene.hoop
    rate = sqrt(hoop.e / (hoop.K + (1 + hoop.e) ** 2))  # of falling from the top, rolling; a slip falls sooner
    return SWINGS * swing + 2 * ROUND_OFF / rate + 10


def _swung(
    scene: Scene, hoop: Hoop, builder: Builder, state: State, swing: Swing, watch: Callable[[float, float], None] | None
) -> tuple[State, Segment, Stop | None]:
    """March through a swing; on where a soft wall turns the hoop in a pulse that is not over."""
    turns, inside = turns_of(swing.rigid, swing.pulses, swing.run.turns), None
    segment: Segment | None = None
    while True:
        began = state.t
        state, part, stop = builder.march(
            hoop, state, _ends(swing, inside, turns, float(state.pos[2])), scene.solve.rtol, watch
        )
        segment = part if segment is None else segment.then(part)
        over = stop is not None or state.t == began or state.t >= swing.until or rest_of(scene.run, builder) is None
        inside, turns = None if over else unfinished(segment, swing.rigid, swing.pulses), 1
        if inside is None:
            return state, segment, stop


def _ends(swing: Swing, inside: Pulse | None, turns: int, phi: float) -> Ends:
    """Where a march through a swing ends that begins at an angle, ``inside`` a pulse or not: at so many turns or at the
    top; of a run to a pulse, at the end of that, if it lies ahead, for hops may lead to a later one."""
    ends = Ends(swing.until, 2 * pi * (ceil(phi / (2 * pi)) - 1), 2 * pi * (floor(phi / (2 * pi)) + 1), turns)
    if swing.run.until != "pulse":
        return ends
    if inside is not None:
        low, high = sorted((inside.phi_start, inside.phi_end))
        return ends._replace(low=low, high=high)
    if swing.pulses:  # before the first whole pulse there may be the rest of one
        pulse = swing.pulses[-1]
        if phi < pulse.phi_end < ends.high and pulse.phi_end > pulse.phi_start:
            return ends._replace(high=pulse.phi_end)
        if ends.low < pulse.phi_end < phi and pulse.phi_end < pulse.phi_start:
            return ends._replace(low=pulse.phi_end)
    return ends
