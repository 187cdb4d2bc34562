"""The march in time: adaptive steps, stick and slip of the patch as located events, and the books on energy.

Nothing here knows how a stage is solved: a *model* does (``stage``, ``displacement``, ``energies``), and there is one
for each level of fidelity. Many steps at a time are taken by compiled code where the model has arrays for it
(:mod:`flexible.time.advance`); between them signals are answered, and what is made in Python is made.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.interrupts import answer

from ..contact.laws.listing import free, may_end, opposite, sticks, successor
from ..contact.points.data import UNKNOWN
from ..models import reduced
from ..models.state import Energies, Model, Record, State
from .advance import COLUMNS, SPAN, Aims, advance, advance_reduced, write
from .control import AFRESH, SHORT
from .course import (
    CAPPED,
    LACKS,
    MODE_ENDED,
    PAUSED,
    REACHED,
    STALLED,
    UNSOLVED,
    Advanced,
    Course,
    Marched,
    Standing,
    Stop,
    beginning,
)
from .events import BEARS, Ends
from .methods import ESDIRK3, Method, Methods, Tables, alike

Array = NDArray[np.float64]


class MarchError(RuntimeError):
    """A step that could not be mended; ``stop`` says where and why."""

    def __init__(self, stop: Stop) -> None:
        super().__init__(stop.told())
        self.stop = stop


class Limits(NamedTuple):
    """Between what the steps of a march are chosen."""

    first: float = 1e-4  # length of the first step, sqrt(R/g)
    longest: float = 0.05
    most: int = 50_000  # steps, those tried in vain too
    before: int = 0  # steps tried in marches before this one
    stop: Callable[[], bool] = lambda: False  # asked every few steps


LIMITS, DEFAULT = Limits(), alike(ESDIRK3)


def machine(model: Model) -> tuple[Callable[..., Advanced], Any]:
    """What takes the steps of a model, and of what: compiled code of its arrays, or Python."""
    if model.arrays is None:
        return advance, model
    if isinstance(model.arrays, reduced.Arrays):
        return advance_reduced, model.arrays
    from .chain_step import advance_chain  # what only soft rings need

    return advance_chain, model.arrays


def compile_steps(model: Model, state: State) -> None:
    """Have a model's steps from a state compiled, or taken from the cache, without one.

    The forces of the floor, which they call by address, are not waited for.
    """
    of: Any
    run: Any
    run, of = machine(model)
    aims = Aims(1.0, 1, model.relaxation)
    run.compile_for(
        of,
        model.law.parameters,
        alike(ESDIRK3).tables(1.0),
        beginning(state, 1.0),
        Ends(t=1.0),
        aims,
        np.empty((1, COLUMNS)),
    )


def _advanced(
    model: Model, tables: Tables, now: Standing, ends: Ends, aims: Aims, rows: Array
) -> tuple[Standing, int, int]:
    """What :func:`flexible.time.advance.advance` comes to; a model that lacked a part of its rim has it then."""
    run, of = machine(model)
    reached = run(of, model.law.parameters, tables, now, ends, aims, rows)
    if reached.why == LACKS:
        model.learns(reached.window)
    return reached.now, reached.written, reached.why


def _alone(model: Model, state: State, h: float, methods: Methods) -> State | None:
    """The state after one step of length ``h``, in the same mode; None if it could not be solved."""
    now, why, row = beginning(state, h), LACKS, np.empty((1, COLUMNS))
    aims, tables = Aims(np.inf, 1, model.relaxation, alone=True), methods.tables(1.0)
    while why == LACKS:
        now, _, why = _advanced(model, tables, now, Ends(), aims, row)
    return now.state if why == REACHED else None


def attempt(model: Model, old: State, h: float, methods: Methods = DEFAULT) -> State | None:
    """The state after one step of length ``h``; None if Newton failed, whatever it failed by."""
    return _alone(model, old, float(h), methods)


def restart(model: Model, state: State, mode: int) -> State:
    """The same instant under another law of friction: accelerations and static displacements jump, nothing else."""
    state = state._replace(mode=mode)
    found = _alone(model, state, 0.0, DEFAULT)
    if found is None:  # where N jumps the damper has a part in it, which is known of steps that have a length
        found = _alone(model, state, SHORT, DEFAULT)
    if found is None:
        raise MarchError(Stop(": the patch could not be re-solved", state.t, float(state.pos[2]), "no forces"))
    pos = state.pos.copy()
    pos[3:] = found.pos[3:]  # a ring without mass jumps; one with mass stays where it is, but for beta^2 acc
    return found._replace(
        t=state.t, x_C=state.x_C, pos=pos, vel=state.vel, slip_velocity=state.slip_velocity,
        elastic_rate=state.elastic_rate, rates=UNKNOWN, jerk=np.zeros_like(pos), elastic_bend=0.0,
    )  # fmt: skip


def _in_mode(model: Model, state: State, mode: int, before: Record) -> tuple[State, Energies, float]:
    """The state in the mode that follows, its energies, and what ring and patch let go of in the jump of the friction
    force: that is lost to friction.
    """
    law = model.law.parameters
    if sticks(law, mode) and state.res.elastic > 0:  # to the last digit, which a step that was cut short may not have
        state = state._replace(slip_velocity=0.0)
    behind = restart(model, state, mode)
    energies, spring = model.energies(behind), behind.res.normal_energy + behind.res.bristle_energy
    return behind, energies, before.ring_strain + before.contact_spring - energies[2] - spring


def _behind(model: Model, state: State, mode: int, why: int, before: Record) -> tuple[State, Energies, float]:
    """The same; where a stick ends and no slide that the friction it had would slow down is balanced, it snaps off.

    See :func:`_instead`: the slide is then under the opposite friction.
    """
    try:
        return _in_mode(model, state, mode, before)
    except MarchError:
        law = model.law.parameters
        other = opposite(law, state) if why == MODE_ENDED and sticks(law, state.mode) else None
        if other is None:
            raise
        return _in_mode(model, state, other, before)


def _instead(model: Model, state: State, why: int) -> int | None:
    """The mode to go on in where a patch can neither stay in its own nor pass to the next; None if there is none.

    Beside the weld of a thick ring the rim gives way under friction as much as under pressure. Where
    mu C_nt > C_nn, of its static compliances, more pressure lifts a sliding spot of a ring without inertia less than
    its friction pulls it down: no N balances it, and the floor catches the spot in an instant, as it does a rigid body
    in Painleve's paradox. It is tried sticking. And where N falls, such a spot that breaks loose is not slowed down by
    the friction that held it, but driven against it: stick and slip follow each other without end. It snaps off, and is
    tried sliding under the opposite one.
    """
    law = model.law.parameters
    if why == UNSOLVED and may_end(law) and not sticks(law, state.mode):
        return successor(law, state)
    return opposite(law, state) if why == STALLED else None


def march(
    model: Model,
    start: State | Course,
    ends: Ends,
    rtol: float,
    limits: Limits = LIMITS,
    progress: Callable[[Array], None] | None = None,
    keep: Callable[[State], None] | None = None,
    methods: Methods | Method = ESDIRK3,
) -> Marched:
    """March to the first of the ends, which is located.

    ``start`` may be the course of an earlier march. ``progress`` is given, every few steps, the rows that they
    wrote (:func:`flexible.time.advance.write`); ``keep`` is given the state behind every new record.
    """
    if isinstance(start, Course):
        now, records = start.now, start.behind()
    else:
        start = start._replace(mode=free(model.law.parameters, start))
        now, records = beginning(start, float(limits.first)), []
    rows = np.empty((SPAN if keep is None else 1, COLUMNS))
    if not records:
        write(rows[0], now.state, model.energies(now.state), now.books, now.turns, 0.0)
        records += _records(rows[:1])
        if keep is not None:
            keep(now.state)
    tables = (alike(methods) if isinstance(methods, Method) else methods).tables(rtol, model.steps)
    bears = 0.0 if records[0].normal_force > 0 else BEARS
    aims = Aims(float(limits.longest), limits.most, model.relaxation, bears)
    ends = Ends(float(ends.t), float(ends.low), float(ends.high), ends.turns)
    why, stood, behind, lost = PAUSED, now, len(records), -np.inf
    stop: Stop | None = None
    while why in (PAUSED, LACKS, MODE_ENDED):
        if not now.cut:
            stood, behind = now, len(records)
        answer()
        if limits.stop():
            why = PAUSED
            break
        now, written, why = _advanced(model, tables, now, ends, aims, rows)
        records += _records(rows[:written])
        if keep is not None and written:
            keep(now.state)
        if progress is not None:
            progress(rows[:written])
        mode = successor(model.law.parameters, now.state) if why == MODE_ENDED else _instead(model, now.state, why)
        if mode is not None and (why == MODE_ENDED or now.state.t > lost):
            try:
                state, energies, released = _behind(model, now.state, mode, why, records[-1])
            except MarchError as trouble:
                stop = trouble.stop if why == MODE_ENDED else None
                break
            books = now.books._replace(friction_loss=now.books.friction_loss + released)
            now = now._replace(state=state, books=books)
            if why != MODE_ENDED:
                lost, now, why = state.t + SHORT, now._replace(step=SHORT, pace=AFRESH, stalls=0), MODE_ENDED
            write(rows[0], state, energies, books, now.turns, 0.0)
            records += _records(rows[:1])
            if keep is not None:
                keep(state)
    if why in (PAUSED, CAPPED) and not now.cut:
        stood, behind = now, len(records)
    if why != REACHED:
        stop = stop or _stop(why, now, limits)
    return Marched(now.state, records, now.attempts, stop, Course(stood, records, behind))


def _records(rows: Array) -> list[Record]:
    return [Record._make([*row[:-3], int(row[-3]), int(row[-2])]) for row in rows.tolist()]


def _stop(why: int, now: Standing, limits: Limits) -> Stop:
    """Why a march stopped early."""
    state = now.state
    if why == CAPPED:
        aloft = ", off the floor, where its ring vibrates: a larger solve.rtol takes longer ones"
        return Stop(
            f" after {limits.before + now.attempts} steps{aloft * (state.normal_force == 0 and len(state.pos) > 3)}",
            state.t,
        )
    if why == PAUSED:
        return Stop(" as asked", state.t, by_ring=False)
    trouble = "no step however short could be solved"
    if why == STALLED:
        trouble = "stick and slip follow each other without end"
    return Stop(f" (N = {state.normal_force:.4g}): {trouble}", state.t, float(state.pos[2]))
