"""One TR-BDF2 step of any level, with its error, impulses and losses; and the jump when the law of friction changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ..contact.points.data import Damper, Resultants
from ..models.stage import BETA, ERROR_WEIGHTS, TAU, Predictor
from ..models.state import Model, Stage, State

Array = NDArray[np.float64]

_QUADRATURE = (2**0.5 / 4, 2**0.5 / 4, BETA)  # of TR-BDF2 over a step
_BENT = 1 / (6 * TAU * (1 - TAU))  # integral of one node's parabola times the slope of the next


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
    numerical: float  # energy lost to the integrator's error, as estimated
    off_floor: float


def attempt(model: Model, old: State, h: float) -> Step | None:
    """One TR-BDF2 step of length ``h``; None if Newton failed, whatever it failed by."""
    try:
        trial = _stages(model, old, h)
    except np.linalg.LinAlgError:
        return None
    return trial if trial is not None and isfinite(trial.error) else None


def _stages(model: Model, old: State, h: float) -> Step | None:
    """The two stages of a step, and what is measured of it."""
    beta = BETA * h
    rho, drag = model.relaxation / beta, model.patch_damping(old) / beta
    pos0, vel0, acc0 = old.pos, old.vel, old.acc
    elastic0 = old.res.elastic
    elastic_pred = elastic0 + beta * old.elastic_rate
    pos_pred, vel_pred = pos0 + 2 * beta * vel0 + beta**2 * acc0, vel0 + beta * acc0
    damper = Damper(rho, elastic_pred, 1.0, drag, beta * old.slip_velocity, TAU / BETA, 1 / beta, 0.0)
    first = _solved(model, old, old.mode, damper, Predictor(pos_pred, vel_pred, beta, beta**2 * acc0))
    if not first.ok:
        return None
    acc_mid, res_mid = first.acc, first.res
    pos_mid, vel_mid = pos_pred + first.d, vel_pred + first.d / beta
    c_mid, c_old = 1 / (TAU * (2 - TAU)), -((1 - TAU) ** 2) / (TAU * (2 - TAU))
    vel_pred = c_mid * vel_mid + c_old * vel0
    pos_pred = c_mid * pos_mid + c_old * pos0 + beta * vel_pred
    elastic_pred = c_mid * res_mid.elastic + c_old * elastic0
    damper = Damper(rho, elastic_pred, 1.0, drag, c_mid * res_mid.way, 1 / BETA, 1 / beta, 0.0)
    guess = beta**2 * (acc_mid + (acc_mid - acc0) * (1 - TAU) / TAU)
    second = _solved(model, old, old.mode, damper, Predictor(pos_pred, vel_pred, beta, guess), first)
    if not second.ok:
        return None
    acc, res = second.acc, second.res
    pos, vel = pos_pred + second.d, vel_pred + second.d / beta
    error = h * (ERROR_WEIGHTS[0] * acc0 + ERROR_WEIGHTS[1] * acc_mid + ERROR_WEIGHTS[2] * acc)
    slip_mid, slip = (r.way if r.normal > 0 else p[0] for r, p in ((res_mid, pos_mid), (res, pos)))
    slip_velocity = _ending(float(slip_mid), float(slip), h)
    feet_velocity = _ending(res_mid.feet, res.feet, h)
    forces = (old.res, res_mid, res)
    normal_impulse = h * sum(w * r.normal for w, r in zip(_QUADRATURE, forces, strict=True))
    friction_impulse = h * sum(w * r.friction for w, r in zip(_QUADRATURE, forces, strict=True))
    ways = (0.0, float(slip_mid), float(slip))
    work = res.beyond + _work([r.friction - r.damping for r in forces], ways)
    damped = _damped(forces) - _work([r.damping for r in forces], ways)
    off = h * sum(w for w, r in zip(_QUADRATURE, forces, strict=True) if r.normal == 0)
    x_C = old.x_C + pos[0] + (pos[2] - pos0[2])
    pos = pos.copy()
    pos[0] = 0.0
    elastic_rate = float(res.elastic - elastic_pred) / beta
    state = State(
        old.t + h, x_C, pos, vel, acc, old.mode, second.window, second.u, second.nodal, res, second.bristles,
        slip_velocity, elastic_rate, feet_velocity,
    )  # fmt: skip
    moved = h * (ERROR_WEIGHTS[0] * vel0 + ERROR_WEIGHTS[1] * vel_mid + ERROR_WEIGHTS[2] * vel)
    errors = model.errors(state, beta, second.matrix, error, moved)
    return Step(state, errors.momentum, (normal_impulse, friction_impulse), work, damped, -errors.energy, off)


def _solved(
    model: Model, old: State, mode: int, damper: Damper, predictor: Predictor, near: Stage | None = None
) -> Stage:
    """A stage, not ok whatever fails in it; without numbers to begin with it is not tried: no angle, no rim."""
    if not isfinite(predictor.pos.sum() + predictor.vel.sum() + predictor.guess.sum() + sum(damper)):
        return Stage(False)
    try:
        return model.stage(old, mode, damper, predictor, near)
    except np.linalg.LinAlgError:
        return Stage(False)


def _ending(middle: float, end: float, h: float) -> float:
    """Rate at the end of a step of what is 0 at its beginning, a parabola in time."""
    return (end + (end - middle / TAU) / (1 - TAU)) / h


def _work(force: Sequence[float], way: Sequence[float]) -> float:
    """Work of a force along a way, both the parabolas in time through the three instants of a step; the way from 0.

    Of third order, and exact for a spring however long the step: a force linear in the way does the work of its ends.
    """
    bent = _BENT * ((force[0] - force[2]) * way[1] + (force[1] - force[0]) * way[2])
    return float(bent + (force[0] + force[2]) / 2 * way[2])


def _damped(results: Sequence[Resultants]) -> float:
    """What the normal damper takes, the integral of (eta - 1) over the springs' energy."""
    stored = [r.normal_energy - results[0].normal_energy for r in results]
    if all(r.elastic > 0 for r in results):
        return _work([r.eta - 1 for r in results], stored)
    damped = 0.0
    for i in (1, 2):  # off the floor there is no factor
        factors = [r.eta - 1 for r in results[i - 1 : i + 1] if r.elastic > 0]
        damped += sum(factors) / max(len(factors), 1) * (stored[i] - stored[i - 1])
    return float(damped)


def restart(model: Model, state: State, mode: int) -> State:
    """The same instant under another law of friction: accelerations and static displacements jump, nothing else.

    A stage of no length: what it moves, ``beta^2 acc``, must be nothing to the thinnest patch, whose depth as it opens
    is some 1e-12 R, or N is another one after every event than before it.
    """
    beta = 1e-15
    eta = state.res.eta if state.res.elastic > 0 else 1.0
    damper = Damper(0.0, 0.0, eta, 0.0, 0.0, 1.0, 0.0, state.slip_velocity)
    solved = _solved(model, state, mode, damper, Predictor(state.pos, state.vel, beta, beta**2 * state.acc))
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
