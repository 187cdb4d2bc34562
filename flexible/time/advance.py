"""Steps of a march, one after the other: their error, their events, the books on energy, a row for each.

One text for two machines, as :mod:`flexible.time.stages`, whose step it takes at one place alone: compiled code is
that step, and little more.
"""

from __future__ import annotations

from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import jit, loop, part

from ..contact.laws.listing import care, free, sticks, successor
from ..contact.points.data import Parameters
from ..contact.points.rim import turned
from ..models import reduced
from ..models.state import Books, Energies, Record, State
from .control import AFRESH, Pace, longer, shorter
from .course import CAPPED, LACKS, NO_FORCES, PAUSED, REACHED, STALLED, STEP, SWITCH, TRY, UNSOLVED, Advanced, Standing
from .events import (
    HIGH_END,
    MODE_ENDS,
    NO_EVENT,
    NOWHERE,
    TURN,
    Ends,
    Sight,
    is_lost,
    is_open,
    next_event,
    passed,
    told,
    unsolved,
)
from .methods import Table
from .stages import Taken, held, take, take_reduced

SHORTEST = 1e-13  # a step, sqrt(R/g): some hundred of what t can tell apart
SHORT = 1e-11  # the step after an event is no shorter: at foundation 1e14 the patch's own period is 1e-6
MOST_STALLS = 50  # events within a shortest step of each other
SPAN = 25  # steps tried between two looks at what else the machine has to do: 0.1 s at most
COLUMNS = len(Record._fields) + 1  # of a row: a record, and the rotation of the rim at the floor


class Aims(NamedTuple):
    """By what steps are chosen."""

    tolerance: float  # of a step's error
    power: float  # 1/(that of h with which the error falls)
    longest: float
    most: int  # steps, those tried in vain too
    relaxation: float  # of the normal damper, sqrt(R/g)


def tried(model: Any, old: State, h: float, table: Table, damping: Any) -> Taken:
    """A step of a hoop in Python; what its sparse matrices raise is a step that could not be solved."""
    try:
        return take(model, old, h, table, damping)
    except np.linalg.LinAlgError:
        nothing = dict.fromkeys(Taken._fields, 0.0)
        return Taken(**{**nothing, **{name: getattr(old, name, 0.0) for name in nothing}, "ok": False})


def lacks(model: Any, window: Any) -> bool:
    """Whether a step may have failed for want of a part of the rim; hoops in Python make what they lack."""
    return False


def energies_of(model: Any, state: State, of: Energies) -> Energies:
    """See ``energies`` of :class:`flexible.models.state.Model`."""
    energies: Energies = model.energies(state, of)
    return energies


@part
def _in_next_mode(law: Parameters, state: State) -> State:
    """The state in the mode that follows the one that has ended."""
    mode = successor(law, _seen(state, state.mode))
    slip_velocity = state.slip_velocity
    if sticks(law, mode):  # to the last digit, which a step that was cut short may not have
        slip_velocity = 0.0
    return State(
        state.t, state.x_C, state.pos, state.vel, state.acc, mode, state.window, state.u, state.nodal, state.res,
        state.bristles, slip_velocity, state.elastic_rate, state.feet_velocity, state.jerk, state.elastic_bend,
    )  # fmt: skip


@part
def _reached(law: Parameters, old: State, h: float, taken: Any) -> State:
    """The state at the end of a step, in the mode in which a patch that is off the floor comes down."""
    pos, sight = taken.pos, _seen(taken, old.mode)
    x_C = old.x_C + pos[0] + (pos[2] - old.pos[2])
    pos[0] = 0.0
    return State(
        old.t + h, x_C, pos, taken.vel, taken.acc, free(law, sight), taken.window, taken.u, taken.nodal, taken.res,
        taken.bristles, taken.slip_velocity, taken.elastic_rate, taken.feet_velocity, taken.jerk, taken.elastic_bend,
    )  # fmt: skip


@part
def _restarted(old: State, taken: Any) -> State:
    """The same instant under another law of friction: accelerations and static displacements jump, nothing else."""
    pos = old.pos.copy()
    for i in range(3, pos.shape[0]):  # a ring without mass jumps; one with mass stays, but for beta^2 acc
        pos[i] = taken.pos[i]
    return State(
        old.t, old.x_C, pos, old.vel, taken.acc, old.mode, taken.window, taken.u, taken.nodal, taken.res,
        taken.bristles, old.slip_velocity, old.elastic_rate, 0.0, np.zeros(pos.shape[0]), 0.0,
    )  # fmt: skip


@loop
def _seen(of: Any, mode: int) -> Sight:
    """What of a state or of the end of a step tells of events."""
    return Sight(mode, of.pos[2], of.vel[2], of.res, of.slip_velocity, of.feet_velocity)


@loop
def _entered(books: Books, stored: float, taken: Any) -> Books:
    """The totals with a step, before which the bristles ``stored`` so much energy."""
    return Books(
        books.normal_impulse + taken.normal_impulse,
        books.friction_impulse + taken.friction_impulse,
        books.friction_loss - (taken.friction_work + (taken.res.bristle_energy - stored)),
        books.damping_loss + taken.damped,
        books.numerical_loss + taken.numerical,
        books.off_floor + taken.off_floor,
    )


@loop
def write(row: Any, state: State, held: Any, books: Books, rotation: float) -> None:
    """A :class:`flexible.models.state.Record` and what stands beside it."""
    pos, res = state.pos, state.res
    values = (
        state.t, pos[2], state.vel[2], state.acc[2], state.x_C, 1 + pos[1], state.slip_velocity, state.vel[1],
        res.normal, res.friction, res.length, res.stuck, held[0], held[1], held[2],
        res.normal_energy + res.bristle_energy, books.normal_impulse, books.friction_impulse, books.friction_loss,
        books.damping_loss, books.numerical_loss, books.off_floor, float(state.mode), rotation,
    )  # fmt: skip
    for i in range(len(values)):
        row[i] = values[i]


@loop
def _released(books: Books, energy: float) -> Books:
    """The totals with what ring and patch let go of in a jump of the friction force: that is lost to friction."""
    return Books(
        books.normal_impulse, books.friction_impulse, books.friction_loss + energy, books.damping_loss,
        books.numerical_loss, books.off_floor,
    )  # fmt: skip


@loop
def _pause(due: int, room: bool, more: bool, h: float) -> int:
    """Why nothing more is tried, 0 if it is."""
    if not room:
        return PAUSED
    if due == STEP and not more:
        return CAPPED
    return UNSOLVED if due == STEP and h < SHORTEST else 0


@loop
def _ended(event: int, state: State, ends: Ends, turns: int, stalls: int) -> int:
    """Why the march is over behind a step, 0 if it is not."""
    phi = state.pos[2]
    if turns >= ends.turns > 0 or phi <= ends.low or phi >= ends.high or ends.t - state.t < SHORTEST:
        return REACHED
    return STALLED if stalls > MOST_STALLS else 0


def advance(
    model: Any, law: Parameters, table: Table, now: Standing, ends: Ends, aims: Aims, rows: Any
) -> Advanced:  # fmt: skip
    """Go on from where a march stands, until it ends or for a while.

    ``rows``, (n, COLUMNS), are filled in with what is recorded, as far as there is room.
    """
    state, h, pace, books, due, cut = now.state, now.step, now.pace, now.books, now.due, now.cut
    attempts, turns, stalls, stored, window = now.attempts, now.turns, now.stalls, now.stored, now.state.window
    written, span, search, event, rotation = 0, now.attempts + SPAN, NOWHERE, NO_EVENT, 0.0
    asked, length, before_it, grown, this = 0.0, 0.0, 0.0, 0.0, AFRESH
    why = _ended(event, state, ends, turns, stalls) if due == STEP else 0
    while why == 0:
        tries = search.length if due == STEP else h if due == TRY else 0.0
        if search.event == NO_EVENT:
            why = _pause(due, written < rows.shape[0] and attempts < span, attempts < aims.most, h)
            if why != 0:
                break
            if due == STEP:
                cut = cut or h > ends.t - state.t
                asked = tries = min(h, ends.t - state.t)
                attempts += 1
        old = _in_next_mode(law, state) if due == SWITCH else state
        taken = tried(model, old, tries, table, (aims.relaxation, aims.relaxation * law.eps_t * old.res.length))
        solved = taken.ok and isfinite(taken.error)
        before, seen = _seen(old, old.mode), _seen(taken, old.mode)
        if not taken.ok and lacks(model, taken.window):
            why, window, attempts = LACKS, taken.window, attempts - (1 if due == STEP else 0)
            break
        if due != STEP:
            if not solved:
                why = NO_FORCES
                break
            rotation = 0.0
            state = _reached(law, old, tries, taken) if due == TRY else _restarted(old, taken)
            books = _entered(books, old.res.bristle_energy, taken) if due == TRY else books
        else:
            if search.event == NO_EVENT:
                error, wanted = taken.error / aims.tolerance if solved else inf, care(law, before)
                if error > wanted:
                    h = shorter(asked, error / wanted, aims.power)
                    continue
                this = Pace(asked, error / care(law, seen))
                grown = min(longer(pace, this, aims.power), aims.longest)
                trial, length, event = taken, asked, NO_EVENT
            elif not solved:
                search = unsolved(search)
            else:
                search = told(search, passed(search.event, law, ends, before, seen))
                if search.high == tries:
                    trial, length = taken, tries
                else:
                    safe, before_it = taken, tries
            if is_lost(search):
                if not search.solved:
                    h, pace, search = asked / 4, AFRESH, NOWHERE
                    continue
                trial, length, event = safe, before_it, NO_EVENT
            elif search.past >= 0 and not is_open(search):
                event = search.event
            while not is_open(search) and search.event < HIGH_END:
                search = next_event(search, law, ends, before, _seen(trial, old.mode), (old.t + length) - old.t)
                if search.past >= 0 and not is_open(search):
                    event = search.event
            if is_open(search):
                continue
            # rates in so short a step are round-off, and so are a damper's forces: the mode ends where it began
            if event != MODE_ENDS or (old.t + length) - old.t >= SHORTEST:
                state = _reached(law, old, length, trial)
                books = _entered(books, old.res.bristle_energy, trial)
            attempts, turns = attempts + search.tries, turns + (1 if event == TURN else 0)
            stalls, h, pace = stalls + 1 if state.t - old.t < SHORTEST else 0, grown, this
            rotation = turned(model.theta, state.window, state.u)
        of, spring = held(model, state.pos, state.vel), state.res.normal_energy + state.res.bristle_energy
        of = energies_of(model, state, of)
        if due == SWITCH:
            books = _released(books, stored - of[2] - spring)
        write(rows[written], state, of, books, rotation)
        stored, written = of[2] + spring, written + 1
        if due == STEP:
            why = _ended(event, state, ends, turns, stalls)
            if event == MODE_ENDS:
                due, h, pace = SWITCH, max(min(asked, grown) / 8, SHORT), AFRESH
            search, event = NOWHERE, NO_EVENT
        else:
            why, due = 0 if due == SWITCH else REACHED, STEP
    there = Standing(state, h, pace, books, attempts, turns, stalls, due, cut, stored)
    return Advanced(there, written, why, window)


#: the same of the arrays of a reduced hoop
advance_reduced = jit(
    advance, tried=take_reduced, held=reduced.held, energies_of=reduced.energies_of, lacks=reduced.lacks
)  # fmt: skip
