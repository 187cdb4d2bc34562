"""Steps of a march, one after the other: their error, their events, the books on energy, a row for each.

One text for two machines, as :mod:`flexible.time.stages`, whose step it takes at one place alone: compiled code is
that step, and little more.
"""

from __future__ import annotations

from math import inf, isfinite, sqrt
from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import jit, loop, part

from ..contact.laws.listing import breaks, care, free, is_loaded, sticks
from ..contact.points.bristles import drag_of
from ..contact.points.data import EXACTLY, Parameters
from ..contact.points.rim import turned
from ..models import reduced
from ..models.stage import solve_stage
from ..models.state import Books, Energies, Record, State, held, rotation
from .control import AFRESH, SHORT, WIDER, Pace, daring, farther, longer, shorter
from .course import (
    CAPPED,
    LACKS,
    MODE_ENDED,
    NO_FORCES,
    PAUSED,
    REACHED,
    STALLED,
    UNSOLVED,
    Advanced,
    Standing,
)
from .events import (
    HIGH_END,
    MODE_ENDS,
    NO_EVENT,
    NOWHERE,
    TURN,
    Ends,
    Sight,
    chosen,
    is_lost,
    is_open,
    next_event,
    onward,
    passed,
    sight,
    told,
    unsolved,
)
from .methods import Table, Tables
from .stages import Taken, take

SHORTEST = 1e-13  # a step, sqrt(R/g): some hundred of what t can tell apart
MOST_STALLS = 50  # events within a shortest step of each other
CAUGHT = 7  # a slide that the shortest step ends counts for so many
LOOSE = 3.0  # times the root of its tolerance is the most impulse of a step in which a brush may break loose
CALM = 0.5  # of N_el, by which that may change in a step of a patch that is there to stay
RESTS = 1e-8  # a step after which the count begins anew
SPAN = 25  # steps tried between two looks at what else the machine has to do: 0.1 s at most
COLUMNS = len(Record._fields) + 1  # of a row: a record, and the rotation of the rim at the floor


class Aims(NamedTuple):
    """By what steps are chosen."""

    longest: float
    most: int  # steps, those tried in vain too
    relaxation: float  # of the normal damper, sqrt(R/g)
    bears: float = 0.0  # what a patch has to, to tell which way the hoop goes
    alone: bool = False  # a single step, whatever its error and its events


def tried(model: Any, old: State, h: float, table: Table, damping: Any, known_to: float, before: Any) -> Taken:
    """A step of a hoop in Python; what its sparse matrices raise is a step that could not be solved."""
    try:
        return take(model, old, h, table, damping, known_to, before)
    except np.linalg.LinAlgError:
        nothing: dict[str, Any] = {name: getattr(old, name, 0.0) for name in Taken._fields}
        return Taken(**{**nothing, "ok": False})


def lacks(model: Any, window: Any) -> bool:
    """Whether a step may have failed for want of a part of the rim; hoops in Python make what they lack."""
    return False


def energies_of(model: Any, state: State, of: Energies) -> Energies:
    """See ``energies`` of :class:`flexible.models.state.Model`."""
    energies: Energies = model.energies(state, of)
    return energies


@part
def _reached(old: State, h: float, taken: Any, mode: int) -> State:
    """The state at the end of a step."""
    pos = taken.pos
    x_C = old.x_C + pos[0] + (pos[2] - old.pos[2])
    pos[0] = 0.0
    return State(
        old.t + h, x_C, pos, taken.vel, taken.acc, mode, taken.window, taken.u, taken.nodal, taken.res,
        taken.bristles, taken.slip_velocity, taken.elastic_rate, taken.rates, taken.jerk, taken.elastic_bend,
    )  # fmt: skip


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
def write(row: Any, state: State, held: Any, books: Books, turns: int, rotation: float) -> None:
    """A :class:`flexible.models.state.Record` and what stands beside it."""
    pos, res = state.pos, state.res
    values = (
        state.t, pos[2], state.vel[2], state.acc[2], state.x_C, 1 + pos[1], state.slip_velocity, state.vel[1],
        res.normal, res.friction, res.length, res.stuck, held[0], held[1], held[2],
        res.normal_energy + res.bristle_energy, books.normal_impulse, books.friction_impulse, books.friction_loss,
        books.damping_loss, books.numerical_loss, books.off_floor, float(turns), float(state.mode), rotation,
    )  # fmt: skip
    for i in range(len(values)):
        row[i] = values[i]


@loop
def _pause(room: bool, more: bool, h: float) -> int:
    """Why no step is tried, 0 if one is."""
    if not room:
        return PAUSED
    if not more:
        return CAPPED
    return UNSOLVED if h < SHORTEST else 0


@loop
def _ended(t: float, phi: float, turns: int, ends: Ends) -> bool:
    """Whether one of the ends is reached."""
    return bool(turns >= ends.turns > 0 or phi <= ends.low or phi >= ends.high or ends.t - t < SHORTEST)


@loop
def _stalled(stalls: int, length: float, slid: bool) -> int:
    """The count of events that lead nowhere, after a step, and whether a slide ended in it."""
    if length < SHORTEST:
        return stalls + 1
    if slid and length < SHORT:
        return stalls + CAUGHT
    return stalls if length < RESTS else 0


@loop
def _is_calm(law: Parameters, state: State, h: float) -> bool:
    """Whether the patch is on the floor for steps to come, and holds."""
    return abs(state.elastic_rate) * h < CALM * state.res.elastic and not is_loaded(law, state)


@loop
def _damping(aims: Aims, law: Parameters, state: State) -> tuple[float, float]:
    """The normal damper's time, and the coefficient of the sticking patch against slip."""
    return aims.relaxation, drag_of(law, state.res.length, aims.relaxation)


@loop
def _error(
    law: Parameters, table: Table, old: State, holds: Any, taken: Any, sights: tuple[Sight, Sight], h: float
) -> float:
    """What counts as the error of a step, over its tolerance.

    Its estimate knows nothing of a patch that breaks loose without an event, nor of what is wrong along the contact in
    a step in which the hoop lands: the floor at its end filters that out. There it is the energy that the step gives,
    and that which is in no book.
    """
    error, (before, now) = taken.error / table.tolerance, sights
    if breaks(law, before, now):
        error = max(error, (h * now.res.normal / (LOOSE * sqrt(table.tolerance))) ** (1 / table.power))
    if old.res.elastic == 0 and taken.res.elastic > 0:
        left = old.res.normal_energy - taken.res.normal_energy + taken.friction_work - taken.damped - taken.numerical
        for i in range(3):
            left += holds[i] - taken.held[i]
        error = max(error, max(-taken.numerical, abs(left)) / table.tolerance)
    return float(error)


def advance(
    model: Any, law: Parameters, tables: Tables, now: Standing, ends: Ends, aims: Aims, rows: Any
) -> Advanced:  # fmt: skip
    """Go on from where a march stands, until it ends or for a while.

    ``rows``, (n, COLUMNS), are filled in with what is recorded, as far as there is room.
    """
    state, h, pace, books, attempts, turns, way, stalls, cut = now
    written, span, window, search, event, why = 0, attempts + SPAN, state.window, NOWHERE, NO_EVENT, 0
    asked, tries, grown, this, leap, wider, holds = h, h, h, pace, 0.0, WIDER, held(model, state.pos, state.vel)
    if _ended(state.t, state.pos[2], turns, ends):
        why = REACHED
    while why == 0:
        if search.event == NO_EVENT:
            if not aims.alone:
                why = _pause(written < rows.shape[0] and (attempts < span or leap > 0), attempts < aims.most, h)
            # a spot of a soft rim that its bristles hold to the floor may snap off it, and forces jump: there the state
            # has no neighbour, to which a step however short would lead, but one beyond
            if why == UNSOLVED:
                leap, wider = farther(leap, wider)
                h, why = leap, 0 if leap > 0 else UNSOLVED
            if why != 0:
                break
            cut = cut or h > ends.t - state.t
            asked = tries = min(h, ends.t - state.t)
            attempts += 1
        # the forces of an instant by itself, and those by which it is found, are known as well as they can be
        known_to = EXACTLY if aims.alone or search.event != NO_EVENT else law.known
        table = tables.calm if _is_calm(law, state, asked) else tables.lively
        taken = tried(model, state, tries, table, _damping(aims, law, state), known_to, holds)
        solved, lacking = taken.ok and isfinite(taken.error), not taken.ok and lacks(model, taken.window)
        if lacking or (aims.alone and not solved):
            why, window, attempts = LACKS if lacking else NO_FORCES, taken.window, attempts - 1
            break
        before, seen = sight(model, law, state, state, way), sight(model, law, taken, state, way)
        length = (state.t + tries) - state.t
        if search.event == NO_EVENT:
            error = _error(law, table, state, holds, taken, (before, seen), asked) if solved else inf
            wanted = care(law, before) * daring(leap, wider, table.tolerance)
            alike = not sticks(law, state.mode) or seen.res.friction * state.res.friction > 0
            if leap > 0 and error <= wanted and alike and passed(MODE_ENDS, law, ends, way, before, seen) >= 0:
                why, h, pace, stalls = MODE_ENDED if stalls < MOST_STALLS else STALLED, SHORT, AFRESH, stalls + 1
                break
            if error > wanted:
                h = shorter(asked, error / wanted, table.power) if leap == 0 else 0.0
                pace = pace if solved else AFRESH  # a step is not short for its error where longer ones are not solved
                continue
            this = Pace(asked, error / care(law, seen))
            grown = min(longer(pace, this, table.power), aims.longest)
        elif is_open(search):
            search = told(search, passed(search.event, law, ends, way, before, seen)) if solved else unsolved(search)
        if search.event != NO_EVENT and not is_open(search):
            if chosen(search) != tries and chosen(search) > 0:  # not the last one that was tried
                tries = chosen(search)
                continue
            if not solved:
                h, pace, search = asked / 4, AFRESH, NOWHERE
                continue
            event = NO_EVENT if is_lost(search) else search.event
        if leap > 0 and passed(TURN, law, ends, way, before, seen) >= 0:
            event = TURN  # inside a leap nothing can be found: what happens there happens at its end
        while not (is_open(search) or aims.alone or leap > 0) and search.event < HIGH_END:
            search = next_event(search, law, ends, way, before, seen, length)
            if search.past >= 0 and not is_open(search):
                event = search.event
        if is_open(search):
            tries = search.length
            continue
        # rates in so short a step are round-off, and so are a damper's forces: the mode ends where it began
        if event != MODE_ENDS or length >= SHORTEST:
            books = _entered(books, state.res.bristle_energy, taken)
            holds, state = taken.held, _reached(state, tries, taken, state.mode if aims.alone else free(law, seen))
        (way, turns), energies = onward(way, turns, event, before, seen, aims.bears), energies_of(model, state, holds)
        write(rows[written], state, energies, books, turns, turned(model.theta, state.window, state.u))
        attempts, written = attempts + search.tries, written + 1
        stalls, h, pace = _stalled(stalls, length, event == MODE_ENDS and not sticks(law, state.mode)), grown, this
        if aims.alone or _ended(state.t, state.pos[2], turns, ends):
            why = REACHED
        elif stalls > MOST_STALLS:
            why = STALLED
        elif event == MODE_ENDS:
            why, h, pace = MODE_ENDED, max(min(asked, grown) / 8, SHORT), AFRESH
        search, event, leap, wider = NOWHERE, NO_EVENT, 0.0, WIDER
    return Advanced(Standing(state, h, pace, books, attempts, turns, way, stalls, cut), written, why, window)


#: the same of the arrays of a reduced hoop
sight_reduced = part(sight, module=__name__, rotation=part(rotation, module=__name__, held=reduced.held))
take_reduced = part(
    take, module=__name__, solved=reduced.solved_in_step, held=reduced.held, floor_forces=reduced.floor_forces,
    momentum_error=reduced.momentum_error,
)  # fmt: skip
advance_reduced = jit(
    advance, needs=(solve_stage,), tried=take_reduced, held=reduced.held,
    energies_of=reduced.energies_of, lacks=reduced.lacks, sight=sight_reduced,
)  # fmt: skip
