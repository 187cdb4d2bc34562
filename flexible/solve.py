"""A scene through the flexible hoop: simulate(scene) -> FlexibleMotion.

``resolve = "pulses"`` runs the rigid closed form between pulses and the flexible hoop only inside them: each
flexible segment begins a little before the rigid hoop's pulse, in quasi-static equilibrium, and ends with it. The
rigid hoop is always the one that the contact law tends to (:mod:`flexible.contact.laws`).
``resolve = "all"`` is flexible from the release on, swing by swing.

A run to rest ends where the rigid hoop, released from the flexible one's state, would slip no more: it rolls for ever
with |F| < mu_s N, or the floor is smooth; or a hundred slips more would take less than a ten-thousandth of its energy.
The rigid solver asks the same of itself, and as there a run to a number of turns ends where there is none to wait
for: where the rigid hoop would roll over the top for ever, once it has done so once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

import numpy as np

import rigid
from rigid import Kind, Motion, Pulse, Release, Run, Scene, SceneLike
from rigid.kernel.interrupts import between_calls
from rigid.phases.choice import LEAST_LOSS, SLIPS

from .builder import Builder
from .contact.laws.listing import rigid_limit
from .handover import ensure_stands_in, hand_over, one_of
from .models.select import Hoop as FlexibleHoop
from .models.select import Range, hoop_of
from .models.state import State
from .motion import FlexibleMotion
from .pulses import BACKWARD, add_pulses, ends_with_turn, goes_through_turns, lead, over_bottom, rest_of, swings, swung
from .ring.possible import ensure_possible
from .segment import Segment
from .time.adaptive import MarchError
from .time.advance import SHORTEST
from .time.events import Ends
from .told import Progress, Report, in_time_of, last_turn, swept, with_advice

BACK = 0.01  # of the way through a segment, by which a hoop that turned back is out where it came in
WAITS = 10.0  # sqrt(R/g) that a hoop may take for it, beyond four pulse lengths: a swing takes a few


@between_calls()
def simulate(
    scene: SceneLike,
    *,
    history: bool = False,
    states: bool = True,
    progress: Report | None = None,
    most_steps: int | None = None,
    resume: FlexibleMotion | None = None,
    stop: Callable[[], bool] | None = None,
) -> FlexibleMotion:
    """Move the flexible hoop through a scene.

    Parameters
    ----------
    scene : Scene, str, path or dict
        Or what says which: as :func:`rigid.simulate` takes it.
    history, states : bool
        Keep every step, as ``motion.history``, and (or not, quicker) the ring's states, of which fields are made.
    progress : callable, optional
        Called with the fraction done, 0 to 1.
    most_steps : int, optional
        Of all flexible segments together, after which the motion ends incomplete; by default 50 000 in each.
    resume : FlexibleMotion, optional
        An earlier motion of the same scene, however it ended, from which to go on, as far as ``scene.run`` says: it
        becomes what it would have been without a stop, to the last bit.
    stop : callable, optional
        Asked every few steps; where it says so the motion ends, incomplete.

    Returns
    -------
    FlexibleMotion
        In the units of the scene.

    Raises
    ------
    SceneError
        No such scene, one that cannot be, or one of which there is no flexible hoop (:func:`flexible.ensure_possible`).
    ValueError
        A motion to resume that is of another scene, or whose states are asked for and were not kept.
    """
    scene = rigid.as_scene(scene)
    ensure_possible(scene)
    inner = scene.to_dimensionless()
    hoop = hoop_of(inner)
    builder = Builder(inner)
    builder.range = Range(hoop)
    builder.kept = [] if history and states else None
    builder.most_steps, builder.stop = most_steps, stop
    builder.earlier = None if resume is None else _resumable(resume, scene, history and states)
    run = _through_pulses if scene.solve.resolve == "pulses" else _throughout
    ended = run(inner, hoop, builder, Progress(progress))
    complaint = builder.range.complaint()
    return builder.motion(scene, in_time_of(scene, f"{ended}; {complaint}" if complaint else ended), history)


def _resumable(earlier: FlexibleMotion, scene: Scene, states: bool) -> FlexibleMotion:
    """A motion that a run of a scene can go on from."""
    if not isinstance(earlier, FlexibleMotion):
        raise ValueError(f"The motion to resume is none of the flexible hoop, but {type(earlier).__name__}.")
    if replace(earlier.scene, run=scene.run) != scene:
        raise ValueError("The motion to resume is of another scene: all but how far to run must be the same.")
    if states and earlier.marches and not earlier.kept:
        raise ValueError("The motion to resume did not keep its states: simulate(scene, history=True) does.")
    return earlier


def _through_pulses(scene: Scene, hoop: FlexibleHoop, builder: Builder, progress: Progress) -> str:
    """Rigid between pulses, flexible inside."""
    current = scene
    done, fresh = 0, True  # segments, and whether a pulse that begins at once is one of its own
    whirled = False
    while True:
        motion = rigid.simulate(rigid_limit(current))
        try:
            lost = builder.lost_to_hand_overs(float(motion.at(0.0).energy))
            ensure_stands_in(lost, builder.initial or inf, builder.t)
        except MarchError as error:
            builder.completed = False
            return str(error)
        # what a motion that takes over begins in is the rest of the pulse that is just over
        pulse = next((p for p in motion.pulses if p.t_start > 0 or fresh), None)
        at_rest = scene.run.until == "rest" and _slips_no_more(motion)  # what it rolls through is no pulse with a loss
        whirls = _whirls(motion)
        if whirls and whirled:  # for a revolution at least, as the rigid hoop does
            return motion.ended
        whirled = whirls
        if pulse is None or at_rest:
            builder.add_rigid(motion, motion.t_end)
            builder.completed = motion.completed
            over = scene.run.turns is not None and len(builder.turns) >= scene.run.turns
            return last_turn(scene.run.turns or 0) if over else motion.ended
        start = lead(motion, pulse)
        ends_there = builder.add_rigid(motion, start)
        try:
            state = hand_over(hoop, motion, start, one_of(ends_there, 1))
        except MarchError as error:
            builder.completed = False
            return with_advice(scene, str(error))
        state = state._replace(t=builder.t, x_C=builder.x_C)
        ends, timed = _ends_of(motion, pulse, start, state)
        low, high = done / (done + 2), (done + 1) / (done + 3)
        watch = progress.watch(low, high, swept((float(state.pos[2]), pulse.phi_end)))
        state, segment, trouble = builder.march(hoop, state, ends, scene.solve.rtol, watch)
        at_turn = 0 < ends.turns <= len(segment.turns())
        onward = 1.0 if pulse.phi_end > pulse.phi_start else -1.0
        back = not (timed or at_turn) and onward * (float(state.pos[2]) - pulse.phi_end) < 0
        if not trouble and back and ends.t - state.t < SHORTEST:
            trouble = f"stopped at t = {state.t:.6g}, phi = {state.pos[2]:.6g}: the hoop does not get out of the pulse"
        if trouble:
            builder.completed = False
            return with_advice(scene, trouble)
        _list(builder, segment, pulse, start, back)
        done, fresh = done + 1, at_turn
        if scene.run.until == "pulse" and builder.pulses and over_bottom(pulse):
            return "the first pulse is over" + (": the hoop turned back in it" if back else "")
        rest = rest_of(scene.run, builder)
        if rest is None:
            return "the time to run is over" if scene.run.turns is None else last_turn(scene.run.turns)
        current = _from_here(scene, hoop, state, rest)


def _ends_of(motion: Motion, pulse: Pulse, start: float, state: State) -> tuple[Ends, bool]:
    """Where a segment through a pulse of the rigid hoop ends, which begins in a state, ``start`` after the rigid hoop;
    and whether that is an instant.

    A pulse that the end of the run cuts, or that goes on through a turn, ends with the rigid one; any other at its
    angle or where it came in.
    """
    run_ends = pulse.cut and motion.scene.run.t_end is not None and pulse.t_end == motion.t_end
    t_end = state.t + pulse.t_end - start
    if run_ends or goes_through_turns(motion, pulse):
        return Ends(t=t_end), True
    phi = float(state.pos[2])
    low, high = sorted((phi - BACK * (pulse.phi_end - phi), pulse.phi_end))
    late = t_end + 3 * (pulse.t_end - start) + WAITS
    return Ends(late, low, high, 1 if ends_with_turn(motion, pulse) else 0), False


def _list(builder: Builder, segment: Segment, pulse: Pulse, start: float, back: bool) -> None:
    """List the pulse that a segment went through, from where it came to it, to where it left it."""
    first = segment.t_start if start == pulse.t_start else segment.crossing(pulse.phi_start, segment.t_start)
    if first is None and back:  # it turned back before it came to the pulse
        return
    leaves = max(segment.crossings(pulse.phi_start), default=segment.t_end) if back else segment.t_end
    measured = segment.pulse(segment.t_start if first is None else first, leaves)
    # a pulse that begins at once is cut by the release alone, not where the one before it ended with a turn
    builder.list_pulse(measured, pulse.cut and (pulse.t_start > 0 or len(builder.marches) == 1))


def _from_here(scene: Scene, hoop: FlexibleHoop, state: State, run: Run) -> Scene:
    """The scene whose rigid hoop takes over from a flexible one."""
    release = Release(float(state.pos[2]), float(state.vel[2]), float(hoop.law.handed_back(state)))
    return replace(scene, release=release, run=run)


def _slips_no_more(motion: Motion) -> bool:
    """Whether a run to rest is over where this rigid motion begins."""
    slips = [phase.t_end for phase in motion.phases if phase.kind != Kind.ROLL]
    if not slips or motion.scene.friction.mu == 0:
        return True
    if len(slips) < SLIPS:
        return False
    before, after = motion.at(np.array([0.0, slips[int(SLIPS) - 1]])).energy
    return bool(before - after <= LEAST_LOSS * after)


def _whirls(motion: Motion) -> bool:
    """Whether a run to turns has none to wait for: this rigid motion has none, and slips no more."""
    waits = motion.scene.run.turns is not None
    return waits and motion.period is not None and not motion.turns and _slips_no_more(motion)


def _throughout(scene: Scene, hoop: FlexibleHoop, builder: Builder, progress: Progress) -> str:
    """Flexible from the release on, swing by swing; each pulse is measured over the rigid hoop's interval.

    A swing ends where phidot = 0 and no pulse goes on, or the disk passes the top. The rigid hoop that says where its
    pulse lies, and whether the run is at rest, is released from the flexible one's state at its beginning. A run is at
    rest behind a swing over the bottom alone, not where a soft hoop rocks beside its release.
    """
    reference = rigid.simulate(rigid_limit(scene))
    try:
        state = hand_over(hoop, reference, 0.0)
    except MarchError as error:
        builder.completed = False
        return with_advice(scene, str(error))
    if reference.t_end == 0 and scene.run.t_end is None and scene.solve.start == "equilibrium":
        builder.add_rigid(reference, 0.0)
        return reference.ended
    run: Run | None = scene.run
    whirled = swung_through = False
    horizon = scene.run.t_end if scene.run.t_end is not None else max(reference.t_end, 1e-3)
    watch = progress.watch(0.0, 1.0, lambda t, phi: t / horizon)
    while run is not None:
        here = _from_here(scene, hoop, state, Run(until="rest" if run.until == "rest" else "pulse"))
        swing = rigid.simulate(rigid_limit(here))
        if run.until == "rest" and swung_through and _slips_no_more(swing):
            return swing.ended
        # a swing that begins at a turn has no rest of a pulse to list, and a pulse that goes on through one is one
        pulses = [p for p in swing.pulses if not p.cut or (p.t_start == 0 and not builder.pieces)]
        began, limit = state.t, builder.t + 4 * swing.t_end + 10
        until = limit if scene.run.t_end is None else scene.run.t_end
        state, segment, trouble = swung(scene, hoop, builder, (state, swing, pulses, run, until), watch)
        over = add_pulses(builder, segment, swing, pulses, over=not trouble and rest_of(scene.run, builder) is None)
        if not trouble and state.t == began and rest_of(scene.run, builder) is not None:
            trouble = f"stopped at t = {state.t:.6g}, phi = {state.pos[2]:.6g}: a swing of no length"
        elif not trouble and scene.run.t_end is None and state.t >= limit:
            trouble = f"stopped at t = {state.t:.6g}: the rigid hoop swings that far in a quarter of this time"
        if trouble:
            builder.completed = False
            return with_advice(scene, trouble)
        if run.until == "pulse" and over:
            return "the first pulse is over" + (": the hoop turned back in it" if over == BACKWARD else "")
        run = rest_of(scene.run, builder)
        swung_through = swings(segment)
        onward = None
        if run is not None and run.turns is not None and not segment.turns():
            onward = rigid.simulate(rigid_limit(_from_here(scene, hoop, state, Run(turns=1))))
        whirls = onward is not None and _whirls(onward)
        if onward is not None and whirls and whirled:
            return onward.ended
        whirled = whirls
    return "the time to run is over" if scene.run.turns is None else last_turn(scene.run.turns)
