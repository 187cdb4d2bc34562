"""The march in time: adaptive steps, stick and slip of the patch as located events, and the books on energy.

Nothing here knows how a stage is solved: a *model* does (``stage``, ``displacement``, ``energies``), and there is one
for each level of fidelity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from ..models.state import Books, Model, Record, State, record
from .events import MODE_ENDS, TURN, Ends, locate, passed, watches
from .methods import ESDIRK3, Method
from .step import MarchError, Step, attempt, restart

SHORTEST = 1e-13  # a step, sqrt(R/g): some hundred of what t can tell apart
AFRESH = 1e-11  # the step after an event is no shorter: at foundation 1e14 the patch's own period is 1e-6
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


LIMITS = Limits()


def march(
    model: Model,
    state: State,
    ends: Ends,
    rtol: float,
    limits: Limits = LIMITS,
    progress: Callable[[State], None] | None = None,
    keep: Callable[[State], None] | None = None,
    method: Method = ESDIRK3,
) -> tuple[State, list[Record], int, str]:
    """March to the first of the ends, which is located.

    ``progress`` is told every state that was reached; ``keep`` is given the state behind every record.

    Returns
    -------
    state : State
    records : list of Record
        One per accepted step, events included.
    attempts : int
        Steps tried.
    ended : str
        Empty when one of the ends was reached, otherwise why the march stopped early.
    """
    books = Books()
    records: list[Record] = []

    def note(state: State) -> None:
        records.append(record(model, state, books))
        if keep is not None:
            keep(state)

    state = _free(model, state)
    note(state)
    attempts, turns, stalls = 0, 0, 0
    if _over(state, ends, turns):
        return state, records, attempts, ""
    power = 1 / method.estimates
    h = limits.first
    while attempts < limits.most:
        if h < SHORTEST:
            return state, records, attempts, _stuck(state, "no step however short could be solved")
        attempts += 1
        asked = min(h, ends.t - state.t)
        trial = attempt(model, state, asked, method)
        tolerance = method.tolerance(rtol) * model.law.care(state)
        if trial is None:
            h = asked / 4
            continue
        if trial.error > tolerance:
            h = asked * max(0.2, 0.9 * (tolerance / trial.error) ** power)
            continue
        grown = min(asked * min(3.0, 0.9 * (tolerance / max(trial.error, 1e-300)) ** power), limits.longest)
        step = _until_event(model, state, trial, ends, method)
        if step is None:
            h = asked / 4
            continue
        trial, event = step.trial, step.event
        attempts += step.attempts
        books.normal_impulse += trial.impulses[0]
        books.friction_impulse += trial.impulses[1]
        stored = trial.state.res.bristle_energy - state.res.bristle_energy
        books.friction_loss -= trial.friction_work + stored
        books.damping_loss += trial.damped
        books.numerical_loss += trial.numerical
        books.off_floor += trial.off_floor
        stalls = stalls + 1 if trial.state.t - state.t < SHORTEST else 0
        turns += event == TURN
        state = _free(model, trial.state)
        note(state)
        if progress is not None:
            progress(state)
        if _over(state, ends, turns):
            return state, records, attempts, ""
        if stalls > MOST_STALLS:
            return state, records, attempts, _stuck(state, "stick and slip follow each other without end")
        if event == MODE_ENDS:
            mode = model.law.successor(state)
            if model.law.sticks(mode):  # to the last digit, which a step that was cut short may not have
                state = replace(state, slip_velocity=0.0)
            try:
                state = restart(model, state, mode)
            except MarchError as error:
                return state, records, attempts, str(error)
            # what the ring and the patch let go of in the jump of the friction force is lost to friction
            before, after = records[-1], record(model, state, books)
            released = before.ring_strain + before.contact_spring - after.ring_strain - after.contact_spring
            books.friction_loss += released
            note(state)
            h = max(min(asked, grown) / 8, AFRESH)
        else:
            h = grown
    return state, records, attempts, f"stopped at t = {state.t:.6g} after {limits.most} steps"


def _over(state: State, ends: Ends, turns: int) -> bool:
    """Whether one of the ends is reached."""
    phi = state.pos[2]
    turned = turns >= ends.turns > 0
    return bool(turned or phi <= ends.low or phi >= ends.high or ends.t - state.t < SHORTEST)


def _stuck(state: State, why: str) -> str:
    return f"stopped at t = {state.t:.6g}, phi = {state.pos[2]:.6g} (N = {state.normal_force:.4g}): {why}"
