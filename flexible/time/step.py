"""One implicit step of any level, from state to state; and the jump when the law of friction changes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ..contact.points.data import Damper
from ..models.reduced import start_of
from ..models.stage import Predictor, Stage
from ..models.state import Model, State
from .methods import ESDIRK3, Method
from .stages import Taken, take, take_compiled

Array = NDArray[np.float64]


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


def attempt(model: Model, old: State, h: float, method: Method = ESDIRK3) -> Step | None:
    """One step of length ``h``; None if Newton failed, whatever it failed by."""
    try:
        taken = _taken(model, old, h, method)
        while not taken.ok and model.learns(taken.window):
            taken = _taken(model, old, h, method)
    except np.linalg.LinAlgError:
        return None
    if not taken.ok or not isfinite(taken.error):
        return None
    pos = taken.pos
    x_C = old.x_C + pos[0] + (pos[2] - old.pos[2])
    pos[0] = 0.0
    state = State(
        old.t + h, float(x_C), pos, taken.vel, taken.acc, old.mode, taken.window, taken.u, taken.nodal, taken.res,
        taken.bristles, float(taken.slip_velocity), float(taken.elastic_rate), float(taken.feet_velocity),
    )  # fmt: skip
    return Step(
        state, taken.error, (float(taken.normal_impulse), float(taken.friction_impulse)), float(taken.friction_work),
        float(taken.damped), float(taken.numerical), float(taken.off_floor),
    )  # fmt: skip


def _taken(model: Model, old: State, h: float, method: Method) -> Taken:
    """The step by compiled code where the model has arrays for it, otherwise by Python."""
    damping = model.relaxation, model.patch_damping(old)
    if model.arrays is None:
        return take(model, old, h, method.table, damping)
    return take_compiled(model.arrays, start_of(old), h, method.table, damping)


def restart(model: Model, state: State, mode: int) -> State:
    """The same instant under another law of friction: accelerations and static displacements jump, nothing else.

    A stage of no length: what it moves, ``beta^2 acc``, must be nothing to the thinnest patch, whose depth as it opens
    is some 1e-12 R, or N is another one after every event than before it.
    """
    beta = 1e-15
    eta = state.res.eta if state.res.elastic > 0 else 1.0
    damper = Damper(0.0, 0.0, eta, 0.0, 0.0, 1.0, 0.0, state.slip_velocity)
    predictor, failed = Predictor(state.pos, state.vel, beta, beta**2 * state.acc), Stage(False)
    try:  # without numbers to begin with there is nothing to solve: no angle, no rim
        known = isfinite(state.pos.sum() + state.vel.sum() + predictor.guess.sum() + sum(damper))
        near = state.window, state.u
        solved = model.stage(state, mode, damper, predictor, near, True) if known else failed
    except np.linalg.LinAlgError:
        solved = failed
    if not solved.ok:
        raise MarchError(f"no forces at t = {state.t:.6g}, phi = {state.pos[2]:.6g}: the patch could not be re-solved")
    pos = state.pos.copy()
    pos[3:] += solved.d[3:]  # a ring without mass jumps; one with mass stays where it is, but for beta^2 acc
    return replace(
        state, pos=pos, acc=solved.acc, mode=mode, window=solved.window, u=solved.u, nodal=solved.nodal,
        res=solved.res, bristles=solved.bristles, feet_velocity=0.0,
    )  # fmt: skip


def advanced(model: Model, state: State, t: float) -> State | None:
    """The state at ``t`` by a single step from ``state``, shorter than the one accepted there; None if it fails."""
    trial = attempt(model, state, t - state.t)
    return None if trial is None else trial.state
