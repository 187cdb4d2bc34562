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

import rigid
from rigid import Motion, Scene, SceneLike
from rigid.allowed import require_whole
from rigid.kernel.interrupts import between_calls

from ..builder import Builder
from ..models.select import Range, hoop_of
from ..motion import FlexibleMotion
from ..ring.possible import ensure_possible
from ..time.course import Stop
from .between import through_pulses
from .throughout import throughout
from .told import Progress, Report, in_words, period_told


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
        Called with the fraction done, 0 to 1, as far as it can be foreseen; with 1 at the end of a run that came to it.
    most_steps : int, optional
        Of all flexible segments together, after which the motion ends incomplete; by default 50 000 in each. An event
        that is being located is located first, which may take some tens of steps more.
    resume : FlexibleMotion, optional
        An earlier motion of the same scene, however it ended, from which to go on, as far as ``scene.run`` says: it
        becomes what it would have been without a stop, to the last bit.
    stop : callable, optional
        Asked every few steps, not while a start is solved; where it says so the motion ends, incomplete.

    Returns
    -------
    FlexibleMotion
        In the units of the scene.

    Raises
    ------
    SceneError
        No such scene, one that cannot be, or one of which there is no flexible hoop (:func:`flexible.ensure_possible`).
    ValueError
        ``most_steps`` that is no whole number from 1 on; a motion to resume that is of another scene, or whose states
        are asked for and were not kept.
    """
    if most_steps is not None:
        most_steps = require_whole("most_steps", most_steps, 1, 10**9)
    scene = rigid.as_scene(scene)
    ensure_possible(scene)
    inner = scene.to_dimensionless()
    hoop = hoop_of(inner)
    earlier = None if resume is None else _resumable(resume, scene, history and states)
    builder = Builder(inner, Range(hoop), history and states, most_steps, stop, earlier)
    run = through_pulses if scene.solve.resolve == "pulses" else throughout
    ending = run(inner, hoop, builder, Progress(progress))
    ended, complaint = in_words(ending, scene), builder.range.complaint()
    completed = ending.completed if isinstance(ending, Motion) else not isinstance(ending, Stop)
    if progress is not None and completed:
        progress(1.0)
    ended = f"{ended}; {complaint}" if complaint else ended
    return builder.motion(scene, ended, completed, history, period_told(ending))


def _resumable(earlier: FlexibleMotion, scene: Scene, states: bool) -> FlexibleMotion:
    """A motion that a run of a scene can go on from."""
    if not isinstance(earlier, FlexibleMotion):
        raise ValueError(f"The motion to resume is none of the flexible hoop, but {type(earlier).__name__}.")
    if replace(earlier.scene, run=scene.run) != scene:
        raise ValueError("The motion to resume is of another scene: all but how far to run must be the same.")
    if states and earlier.marches and not earlier.kept:
        raise ValueError("The motion to resume did not keep its states: simulate(scene, history=True) does.")
    return earlier
