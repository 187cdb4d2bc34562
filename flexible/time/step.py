"""One implicit step of any level, from state to state; and the jump when the law of friction changes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..models import reduced
from ..models.reduced import start_of
from ..models.state import Energies, Model, State
from .methods import ESDIRK3, Method, Table
from .stages import Taken, take, take_reduced

Array = NDArray[np.float64]


def take_compiled(arrays: Any, old: Any, h: float, table: Table, damping: Any) -> Taken:
    """:func:`flexible.time.stages.take` in compiled code, of the arrays that a model has for it."""
    if isinstance(arrays, reduced.Arrays):
        taken: Taken = take_reduced(arrays, old, h, table, damping)
    else:
        from .chain_step import take_chain  # what only soft rings need

        taken = take_chain(arrays, old, h, table, damping)
    return taken


class MarchError(RuntimeError):
    """A step that could not be mended; the sentence says where and why."""


@dataclass(slots=True)
class Step:
    """A step, and its integrals."""

    state: State
    error: float  # of the velocities
    impulses: tuple[float, float]  # normal, friction
    friction_work: float
    damped: float
    numerical: float  # energy of frame and ring that the floor's work does not account for, lost to the integrator
    off_floor: float
    held: Energies | None = None  # by the coordinates at its end


def attempt(model: Model, old: State, h: float, method: Method = ESDIRK3) -> Step | None:
    """One step of length ``h``; None if Newton failed, whatever it failed by."""
    taken = _taken(model, old, h, method)
    if taken is None:
        return None
    pos = taken.pos
    x_C = old.x_C + pos[0] + (pos[2] - old.pos[2])
    pos[0] = 0.0
    state = State(
        old.t + h, float(x_C), pos, taken.vel, taken.acc, old.mode, taken.window, taken.u, taken.nodal, taken.res,
        taken.bristles, float(taken.slip_velocity), float(taken.elastic_rate), float(taken.feet_velocity),
        taken.jerk, float(taken.elastic_bend),
    )  # fmt: skip
    return Step(
        state, taken.error, (float(taken.normal_impulse), float(taken.friction_impulse)), float(taken.friction_work),
        float(taken.damped), float(taken.numerical), float(taken.off_floor), taken.held,
    )  # fmt: skip


def _taken(model: Model, old: State, h: float, method: Method) -> Taken | None:
    """The step by compiled code where the model has arrays for it, otherwise by Python; None where it fails."""
    damping = model.relaxation, model.patch_damping(old)
    while True:
        try:
            if model.arrays is None:
                taken = take(model, old, h, method.table, damping)
            else:
                taken = take_compiled(model.arrays, start_of(old), h, method.table, damping)
        except np.linalg.LinAlgError:
            return None
        if taken.ok:
            return taken if isfinite(taken.error) else None
        if not model.learns(taken.window):
            return None


def restart(model: Model, state: State, mode: int) -> State:
    """The same instant under another law of friction: accelerations and static displacements jump, nothing else."""
    taken = _taken(model, replace(state, mode=mode), 0.0, ESDIRK3)
    if taken is None:
        raise MarchError(f"no forces at t = {state.t:.6g}, phi = {state.pos[2]:.6g}: the patch could not be re-solved")
    pos = state.pos.copy()
    pos[3:] = taken.pos[3:]  # a ring without mass jumps; one with mass stays where it is, but for beta^2 acc
    return replace(
        state, pos=pos, acc=taken.acc, mode=mode, window=taken.window, u=taken.u, nodal=taken.nodal, res=taken.res,
        bristles=taken.bristles, feet_velocity=0.0, jerk=np.zeros_like(pos), elastic_bend=0.0,
    )  # fmt: skip


def advanced(model: Model, state: State, t: float) -> State | None:
    """The state at ``t`` by a single step from ``state``, shorter than the one accepted there; None if it fails."""
    trial = attempt(model, state, t - state.t)
    return None if trial is None else trial.state
