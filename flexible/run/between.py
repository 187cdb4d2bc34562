"""``resolve = "pulses"``: rigid between pulses, flexible inside them."""

from __future__ import annotations

from functools import partial
from math import inf, pi

from rigid import Motion, Pulse, Run, Scene

from ..builder import Builder
from ..models.select import Hoop
from ..models.state import State
from ..segment import Segment
from ..start.handover import hand_over
from ..start.pose import one_of
from ..time.adaptive import MarchError
from ..time.advance import SHORTEST
from ..time.course import Stop
from ..time.events import Ends
from .ahead import from_here, from_release, rest_of, slips_no_more, whirls
from .pulses import LONGEST, comes_to, goes_through_turns, lead, over_bottom
from .told import Ending, Progress, pulse_over, run_over, swept

BACK = 0.01  # of the way through a pulse, by which a hoop that turned back is out where it came in
GAINS = 0.01  # share of the energy that rigid hoops may add; what one lacks to go over the top from 10 degrees is 0.008
TO_A_PULSE = Run(until="pulse")
WAITS = 10.0  # sqrt(R/g) that a hoop may take beyond LONGEST times what the rigid one does: a swing takes a few


def through_pulses(scene: Scene, hoop: Hoop, builder: Builder, progress: Progress) -> Ending:
    """Rigid between pulses, flexible inside.

    Of a run to a time the rigid hoop goes on to the end of its pulse, wherever that time is: where the flexible one
    takes over depends on the length of the pulse.
    """
    released, rest = partial(from_release, scene), scene.run
    done = 0  # segments
    whirls_from: float | None = None
    while True:
        motion = released(rest if rest.t_end is None else TO_A_PULSE)
        try:
            lost = builder.lost_to_hand_overs(float(motion.at(0.0, "left").energy))
            _ensure_stands_in(lost, builder.initial or inf, builder.t)
        except MarchError as error:
            return error.stop
        # what a motion that takes over begins in is the rest of the pulse that is just over
        pulse = next((p for p in motion.pulses if p.t_start > 0 or done == 0), None)
        at_rest = scene.run.until == "rest" and slips_no_more(motion)  # what it rolls through is no pulse with a loss
        if not whirls(motion):
            whirls_from = None
        elif whirls_from is None:
            whirls_from = motion.scene.release.phi0
        elif pulse is not None and abs(pulse.phi_start - whirls_from) >= 2 * pi:
            builder.add_rigid(motion, lead(motion, pulse))
            return motion  # once round, as the rigid hoop goes
        if not at_rest and _ends_inside(motion, pulse, rest):
            motion, pulse = _run_through(motion, pulse, released(TO_A_PULSE), done == 0)
        start = inf if pulse is None else lead(motion, pulse, hoop.law.rolls_to)
        if rest.t_end is not None and rest.t_end - start < SHORTEST:
            motion, pulse = released(rest), None
        if pulse is None or at_rest:
            builder.add_rigid(motion, motion.t_end)
            over = scene.run.turns is not None and len(builder.turns) >= scene.run.turns
            return run_over(scene.run) if over else motion
        ends_there = builder.add_rigid(motion, start)
        try:
            state = hand_over(hoop, motion, start, one_of(ends_there, 1))
        except MarchError as error:
            return error.stop
        state = state._replace(t=builder.t, x_C=builder.x_C)
        ends, timed = _ends_of(motion, pulse, start, state)
        run_out = inf if scene.run.t_end is None else scene.run.t_end
        left = 0 if scene.run.turns is None else scene.run.turns - len(builder.turns)
        ends, last = ends._replace(t=min(ends.t, run_out), turns=left), ends.t
        low, high = done / (done + 2), (done + 1) / (done + 3)
        watch = progress.watch(low, high, swept((float(state.pos[2]), pulse.phi_end)))
        state, segment, stop = builder.march(hoop, state, ends, scene.solve.rtol, watch)
        onward = 1.0 if pulse.phi_end > pulse.phi_start else -1.0
        inside = last - state.t >= SHORTEST if timed else onward * (float(state.pos[2]) - pulse.phi_end) < 0
        # one that rocks in the angles of the pulse, for far longer than that takes, does not get out of it
        left_to_run = rest_of(scene.run, builder)
        cut_short = inside and (ends.t - state.t < SHORTEST or left_to_run is None)
        back = inside and not cut_short
        if stop is not None:
            return stop
        _list(builder, segment, motion, pulse, start, back, cut_short)
        done += 1
        if scene.run.until == "pulse" and builder.pulses and over_bottom(pulse) and not builder.pulses[-1].cut:
            return pulse_over(back)
        if left_to_run is None:
            return run_over(scene.run)
        released, rest = partial(from_here, scene, hoop, state), left_to_run


def _ends_inside(motion: Motion, pulse: Pulse | None, rest: Run) -> bool:
    """Whether a motion may end inside its pulse: by the last turn, or after a period of rolling for ever. One that does
    not come to the bottom by its last turn lists none.
    """
    return rest.turns is not None if pulse is None else pulse.cut and pulse.t_end == motion.t_end


def _run_through(motion: Motion, pulse: Pulse | None, further: Motion, begins: bool) -> tuple[Motion, Pulse | None]:
    """The same motion run ``further``, and the pulse in which the first one ends; if there is none, both as they are.
    Only one that ``begins`` may begin in its pulse.
    """
    ahead = (p for p in further.pulses if p.t_start < motion.t_end and (p.t_start > 0 or begins))
    whole = next(ahead, None)
    return (motion, pulse) if whole is None else (further, whole)


def _ensure_stands_in(lost: float, energy: float, t: float) -> None:
    """Of a motion that began with ``energy`` and has ``lost`` so much to hand-overs, negative if it was added.

    A soft ring sags, and a rigid one that takes over stands higher at the same velocity; one that so goes over the top
    never turns.

    Raises
    ------
    MarchError
        The rigid hoop is no stand-in between pulses.
    """
    if -lost > GAINS * energy:
        why = (
            ": the rigid hoop, which stands for the flexible one between pulses, would add"
            f" {-100 * lost / energy:.2g} % of the energy; with solve.resolve = 'all' it is flexible throughout"
        )
        raise MarchError(Stop(why, t, by_ring=False))


def _ends_of(motion: Motion, pulse: Pulse, start: float, state: State) -> tuple[Ends, bool]:
    """Where a segment through a pulse of the rigid hoop ends, which begins in a state, ``start`` after the rigid hoop;
    and whether that is an instant.

    A pulse that goes on through a turn ends with the rigid one; any other at its angle or where it came in.
    """
    t_end = state.t + pulse.t_end - start
    if goes_through_turns(motion, pulse):
        return Ends(t=t_end), True
    onward = 1.0 if pulse.phi_end > pulse.phi_start else -1.0
    # a blow that turns the hoop is the start of a pulse that goes back over the way on which the hoop came in
    behind = onward * min(onward * float(state.pos[2]), onward * pulse.phi_start)
    low, high = sorted((behind - BACK * (pulse.phi_end - behind), pulse.phi_end))
    late = state.t + LONGEST * (pulse.t_end - start) + WAITS
    return Ends(late, low, high), False


def _list(
    builder: Builder, segment: Segment, motion: Motion, pulse: Pulse, start: float, back: bool, cut: bool
) -> None:
    """List the pulse that a segment went through, from where it came to it, to where it left it."""
    first = segment.t_start if start == pulse.t_start else comes_to(segment, motion, pulse)
    if first is None and (back or (cut and not segment.turns())):  # it turned back, or the run ended, before the pulse
        return
    leaves = max(segment.crossings(pulse.phi_start), default=segment.t_end) if back else segment.t_end
    measured = segment.pulse(segment.t_start if first is None else first, leaves)
    released = pulse.t_start == 0 and len(builder.marches) == 1
    # what the rigid hoop ran no farther than to its end this one has left
    builder.list_pulse(measured, cut or (pulse.cut and released))
