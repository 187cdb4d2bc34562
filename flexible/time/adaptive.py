"""The march in time: adaptive steps, stick and slip of the patch as located events, and the books on energy.

Nothing here knows how a stage is solved: a *model* does (``stage``, ``displacement``, ``energies``), and there is one
for each level of fidelity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf
from typing import NamedTuple

from rigid.kernel.interrupts import answer

from ..models.state import Books, Energies, Model, Record, State, record
from .control import AFRESH, Pace, longer, shorter
from .course import Course, Marched
from .events import MODE_ENDS, TURN, Ends, locate, passed, watches
from .methods import ESDIRK3, Method
from .step import MarchError, Step, attempt, restart

SHORTEST = 1e-13  # a step, sqrt(R/g): some hundred of what t can tell apart
SHORT = 1e-11  # the step after an event is no shorter: at foundation 1e14 the patch's own period is 1e-6
MOST_STALLS = 50  # events within a shortest step of each other


def _free(model: Model, state: State) -> State:
    """The state in the mode in which a patch that is off the floor comes down."""
    mode = model.law.free(state)
    return state if mode == state.mode else replace(state, mode=mode)


class Accepted(NamedTuple):
    """An accepted step, and the event at which it ends."""

    trial: Step
    event: int | None
    attempts: int


def _until_event(model: Model, state: State, trial: Step, ends: Ends, method: Method) -> Accepted | None:
    """A step that passes no event: ``trial``, or a shorter one up to its first event; None where none can be solved."""
    event, attempts = None, 0
    for watch in watches(model.law, state, ends):

        def past(step: Step, watch: int = watch) -> float:
            return passed(watch, model.law, ends, state, step.state)

        if past(trial) < 0:
            continue
        before = passed(watch, model.law, ends, state, state)
        located = locate(lambda h: attempt(model, state, h, method), past, trial, before, trial.state.t - state.t)
        attempts += located.attempts
        if located.trial is None:
            return None
        trial, event = located.trial, watch if located.at_event else None
    if event == MODE_ENDS and trial.state.t - state.t < SHORTEST:
        # rates in so short a step are round-off, and so are a damper's forces: the mode ends where it began
        trial = Step(state, 0.0, (0.0, 0.0), 0.0, 0.0, 0.0, 0.0)
    return Accepted(trial, event, attempts)


class Limits(NamedTuple):
    """Between what the steps of a march are chosen."""

    first: float = 1e-4  # length of the first step, sqrt(R/g)
    longest: float = 0.05
    most: int = 50_000  # steps, those tried in vain too
    before: int = 0  # steps tried in marches before this one
    stop: Callable[[], bool] = lambda: False  # asked before every step


LIMITS = Limits()


def march(
    model: Model,
    start: State | Course,
    ends: Ends,
    rtol: float,
    limits: Limits = LIMITS,
    progress: Callable[[State], None] | None = None,
    keep: Callable[[State], None] | None = None,
    method: Method = ESDIRK3,
) -> Marched:
    """March to the first of the ends, which is located.

    ``start`` may be the course of an earlier march. ``progress`` is told every state that was reached; ``keep`` is
    given the state behind every new record.
    """
    course = start if isinstance(start, Course) else Course.beginning(_free(model, start), limits.first)
    state, h, pace, books, records = course.state, course.step, course.pace, course.books, course.behind()
    attempts, turns, stalls = course.attempts, course.turns, course.stalls
    cut = False  # whether a step was made shorter by the end
    stood = course.state, h, pace, attempts, turns, stalls, books  # before the last step that no end made shorter
    behind = course.length

    def note(state: State, held: Energies | None = None) -> None:
        records.append(record(model, state, books, held))
        if keep is not None:
            keep(state)

    def over(ended: str = "") -> Marched:
        return Marched(state, records, attempts, ended, Course(*stood, records, behind))

    if not records:
        note(state)
    if _over(state, ends, turns):
        return over()
    power = 1 / method.estimates
    while attempts < limits.most and not limits.stop():
        answer()
        if h < SHORTEST:
            return over(_stuck(state, "no step however short could be solved"))
        cut = cut or h > ends.t - state.t
        if not cut:
            stood, behind = (state, h, pace, attempts, turns, stalls, books), len(records)
        attempts += 1
        asked = min(h, ends.t - state.t)
        trial = attempt(model, state, asked, method)
        error = inf if trial is None else trial.error / method.tolerance(rtol)
        if trial is None or error > model.law.care(state):
            h = shorter(asked, error / model.law.care(state), power)
            continue
        now = Pace(asked, error / model.law.care(trial.state))
        grown = min(longer(pace, now, power), limits.longest)
        step = _until_event(model, state, trial, ends, method)
        if step is None:
            h, pace = asked / 4, AFRESH
            continue
        trial, event = step.trial, step.event
        attempts += step.attempts
        books = _entered(books, state, trial)
        stalls = stalls + 1 if trial.state.t - state.t < SHORTEST else 0
        turns += event == TURN
        state = _free(model, trial.state)
        note(state, trial.held)
        if progress is not None:
            progress(state)
        if _over(state, ends, turns):
            return over()
        if stalls > MOST_STALLS:
            return over(_stuck(state, "stick and slip follow each other without end"))
        if event == MODE_ENDS:
            try:
                state, released = _in_its_next_mode(model, state, records[-1])
            except MarchError as trouble:
                return over(str(trouble))
            books = books._replace(friction_loss=books.friction_loss + released)
            note(state)
            h, pace = max(min(asked, grown) / 8, SHORT), AFRESH
        else:
            h, pace = grown, now
    if not cut:
        stood, behind = (state, h, pace, attempts, turns, stalls, books), len(records)
    why = f"after {limits.before + attempts} steps" if attempts >= limits.most else "as asked"
    return over(f"stopped at t = {state.t:.6g} {why}")


def _in_its_next_mode(model: Model, state: State, before: Record) -> tuple[State, float]:
    """The state behind the end of its mode, and what ring and patch let go of in the jump of the friction force.

    That is lost to friction.
    """
    mode = model.law.successor(state)
    if model.law.sticks(mode):  # to the last digit, which a step that was cut short may not have
        state = replace(state, slip_velocity=0.0)
    behind = restart(model, state, mode)
    after = record(model, behind, Books())
    return behind, before.ring_strain + before.contact_spring - after.ring_strain - after.contact_spring


def _entered(books: Books, before: State, step: Step) -> Books:
    """The totals with a step."""
    stored = step.state.res.bristle_energy - before.res.bristle_energy
    return Books(
        books.normal_impulse + step.impulses[0],
        books.friction_impulse + step.impulses[1],
        books.friction_loss - (step.friction_work + stored),
        books.damping_loss + step.damped,
        books.numerical_loss + step.numerical,
        books.off_floor + step.off_floor,
    )


def _over(state: State, ends: Ends, turns: int) -> bool:
    """Whether one of the ends is reached."""
    phi = state.pos[2]
    turned = turns >= ends.turns > 0
    return bool(turned or phi <= ends.low or phi >= ends.high or ends.t - state.t < SHORTEST)


def _stuck(state: State, why: str) -> str:
    return f"stopped at t = {state.t:.6g}, phi = {state.pos[2]:.6g} (N = {state.normal_force:.4g}): {why}"
