"""The march in time: adaptive steps, stick and slip of the patch as located events, and the books on energy.

Nothing here knows how a stage is solved: a *model* does (``stage``, ``displacement``, ``energies``), and there is one
for each level of fidelity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ..contact.forces import BRISTLE_ENERGY, BRUSH, ELASTIC, FRICTION, NORMAL, SLIDE_LEFT, SLIDE_RIGHT, STICK
from ..models.state import Books, Model, Record, State, record
from .tr_bdf2 import MarchError, Trial, attempt, restart


def _excess(model: Model, state: State) -> float:
    """Positive when the patch can no longer go on as it does."""
    if state.mode == STICK:  # a damper may take all of N while the bristles still pull
        return abs(state.res[FRICTION]) - model.mu_s * state.res[NORMAL] if state.res[ELASTIC] > 0 else -1.0
    if state.mode == BRUSH or state.res[NORMAL] == 0 or model.mu_s == 0:
        return -1.0
    return state.mode * state.slip_velocity


def _free(state: State) -> State:
    """A patch off the floor comes down sliding, the way it moves: one that stuck would break as it touches."""
    if state.mode == BRUSH or state.res[ELASTIC] > 0 or state.slip_velocity == 0:
        return state
    return replace(state, mode=SLIDE_LEFT if state.slip_velocity > 0 else SLIDE_RIGHT)


def march(
    model: Model,
    state: State,
    done: Callable[[State], float],
    rtol: float,
    h: float = 1e-4,
    largest_step: float = 0.05,
    max_steps: int = 50_000,
    progress: Callable[[State], object] | None = None,
    keep: Callable[[State], None] | None = None,
) -> tuple[State, list[Record], int, str]:
    """March until ``done(state)`` turns positive; that instant is located.

    ``progress`` is told every state that was reached, and stops the march by a true answer; ``keep`` is given the state
    behind every record.

    Returns
    -------
    state : State
    records : list of Record
        One per accepted step, events included.
    attempts : int
        Steps tried.
    ended : str
        Empty when ``done`` ended the march, otherwise why it stopped early.
    """
    books = Books()
    records: list[Record] = []

    def note(state: State) -> None:
        records.append(record(model, state, books))
        if keep is not None:
            keep(state)

    state = _free(state)
    note(state)
    attempts, accepted = 0, 0
    tolerance = 3.0 * rtol**1.5  # second order: the error over a pulse goes as its power 2/3
    while attempts < max_steps:
        attempts += 1
        trial = attempt(model, state, h)
        if trial is None:
            h /= 4
            if h < 1e-13:
                return state, records, attempts, _stuck(state)
            continue
        if trial.error > tolerance:
            h *= max(0.2, 0.9 * (tolerance / trial.error) ** (1 / 3))
            if h < 1e-13:
                return state, records, attempts, _stuck(state)
            continue
        grown = min(h * min(3.0, 0.9 * (tolerance / max(trial.error, 1e-300)) ** (1 / 3)), largest_step)
        event: Callable[[State], float] | None = None
        for watch in (lambda s: _excess(model, s), done):
            if watch(trial.state) > 0:
                located = _locate(model, state, trial, watch)
                attempts += located[1]
                if located[0].state.t < trial.state.t or event is None:
                    trial, event = located[0], watch
        accepted += 1
        books.normal_impulse += trial.impulses[0]
        books.friction_impulse += trial.impulses[1]
        stored = float(trial.state.res[BRISTLE_ENERGY] - state.res[BRISTLE_ENERGY])
        books.friction_loss -= trial.friction_work + stored
        books.damping_loss += trial.damped
        books.numerical_loss += trial.numerical
        books.off_floor += trial.off_floor
        state = _free(trial.state)
        note(state)
        asked = progress is not None and progress(state)
        if done(state) >= 0:
            return state, records, attempts, ""
        if asked:
            return state, records, attempts, f"stopped at t = {state.t:.6g}, as asked"
        if event is not None:
            mode = STICK if state.mode != STICK else (1 if state.res[FRICTION] > 0 else -1)
            if mode == STICK:  # to the last digit, which a step that was cut short may not have
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
            h = min(h, grown) / 8
        else:
            h = grown
    return state, records, attempts, f"stopped at t = {state.t:.6g} after {max_steps} steps"


def _stuck(state: State) -> str:
    return (
        f"stopped at t = {state.t:.6g}, phi = {state.pos[2]:.6g} (N = {state.normal_force:.4g}): "
        "no step however short could be solved"
    )


def _locate(model: Model, old: State, trial: Trial, watch: Callable[[State], float]) -> tuple[Trial, int]:
    """The step that ends where ``watch`` turns positive, by the Illinois method on the step's length."""
    low, f_low = 0.0, min(watch(old), 0.0)
    high, f_high, best = trial.state.t - old.t, watch(trial.state), trial
    width, n = high, 0
    side = 0
    while n < 30 and high - low > 1e-10 * width:
        n += 1
        h = high - f_high * (high - low) / (f_high - f_low) if f_high > f_low else (low + high) / 2
        h = min(max(h, low + 0.001 * (high - low)), high - 0.001 * (high - low))
        middle = attempt(model, old, h)
        if middle is None:
            break
        value = watch(middle.state)
        if value >= 0:
            high, f_high, best = h, value, middle
            if side == 1:
                f_low /= 2
            side = 1
        else:
            low, f_low = h, value
            if side == -1:
                f_high /= 2
            side = -1
        if 0 <= value < 1e-9:
            break
    return best, n
