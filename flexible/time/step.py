"""One implicit step of any level, its error, impulses and losses; and the jump when the law of friction changes."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ..contact.points.data import Damper, Resultants
from ..models.stage import Predictor
from ..models.state import Model, Stage, State
from .methods import ESDIRK3, Method

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


@dataclass(slots=True)
class _Stages:
    """What is known at the stages of a step; ways and rates of the patch count from the beginning of the step."""

    pos: list[Array]
    vel: list[Array]
    acc: list[Array]
    res: list[Resultants]
    elastic_rate: list[float]
    slip_velocity: list[float]
    way: list[float] = field(default_factory=lambda: [0.0])
    feet: list[float] = field(default_factory=lambda: [0.0])


def attempt(model: Model, old: State, h: float, method: Method = ESDIRK3) -> Step | None:
    """One step of length ``h``; None if Newton failed, whatever it failed by."""
    try:
        trial = _step(model, old, h, method)
    except np.linalg.LinAlgError:
        return None
    return trial if trial is not None and isfinite(trial.error) else None


def _step(model: Model, old: State, h: float, method: Method) -> Step | None:
    """The stages of a step one after the other, and what is measured of it."""
    beta = method.gamma * h
    relaxation = model.relaxation / beta
    known = _Stages([old.pos], [old.vel], [old.acc], [old.res], [old.elastic_rate], [old.slip_velocity])
    last: Stage | None = None
    for i in range(1, len(method.c)):
        weights = h * method.a[i, :i]
        vel = old.vel + _sum(weights, known.acc)
        pos = old.pos + _sum(weights, known.vel) + beta * vel
        elastic = old.res.elastic + float(weights @ known.elastic_rate)
        way = float(weights @ known.slip_velocity)
        turning = method.c[i] * (h * vel[2] - (pos[2] - old.pos[2]) / method.gamma)
        ratio = method.c[i] / method.gamma
        drag = model.patch_damping(old) * _widening(old, method.c[i] * h) / beta
        damper = Damper(relaxation, elastic, 1.0, drag, way, ratio, 1 / beta, 0.0, float(turning))
        guess = beta**2 * _expected(method, known.acc)
        last = _solved(model, old, old.mode, damper, Predictor(pos, vel, beta, guess), last)
        if not last.ok:
            return None
        res = last.res
        known.pos.append(pos + last.d)
        known.vel.append(vel + last.d / beta)
        known.acc.append(last.acc)
        known.res.append(res)
        known.elastic_rate.append(float(res.elastic - elastic) / beta)
        known.way.append(float(res.way))
        known.slip_velocity.append((known.way[-1] - way) / beta)
        known.feet.append(res.feet)
    assert last is not None
    return _measured(model, old, h, method, known, last)


def _widening(old: State, later: float) -> float:
    """Length of the patch so much later over what it is: like N_el^(1/3), a parabola's.

    A length that lags by a step would let the creep of a damped patch lag by as much.
    """
    if old.res.elastic <= 0:
        return 1.0
    return float(np.clip(1 + later * old.elastic_rate / old.res.elastic, 0.1, 10.0) ** (1 / 3))


def _measured(model: Model, old: State, h: float, method: Method, known: _Stages, last: Stage) -> Step:
    """The end of a step whose stages are known, its error and its integrals."""
    res, pos = known.res[-1], known.pos[-1].copy()
    x_C = old.x_C + pos[0] + (pos[2] - old.pos[2])
    pos[0] = 0.0
    state = State(
        old.t + h, float(x_C), pos, known.vel[-1], known.acc[-1], old.mode, last.window, last.u, last.nodal, res,
        last.bristles, known.slip_velocity[-1], known.elastic_rate[-1], float(method.end_rate @ known.feet) / h,
    )  # fmt: skip
    error = model.error(state, method.gamma * h, last.matrix, h * _sum(method.error, known.acc))
    weights = h * method.b
    impulses = (
        sum(w * r.normal for w, r in zip(weights, known.res, strict=True)),
        sum(w * r.friction for w, r in zip(weights, known.res, strict=True)),
    )
    way = method.work @ known.way
    friction = float(sum((r.friction - r.damping) * x for r, x in zip(known.res, way, strict=True)))
    drag = float(sum(r.damping * x for r, x in zip(known.res, way, strict=True)))
    forces = np.array([model.forces(*at) for at in zip(known.pos, known.vel, known.acc, strict=True)])
    moved = np.array(known.pos) - old.pos
    work = float((forces * (method.work @ moved)).sum())
    gained = sum(model.held(known.pos[-1], known.vel[-1])) - sum(model.held(old.pos, old.vel))
    off = sum(w for w, r in zip(weights, known.res, strict=True) if r.normal == 0)
    return Step(
        state, error, (float(impulses[0]), float(impulses[1])), res.beyond + friction, _damped(method, known) - drag,
        work - gained, float(off),
    )  # fmt: skip


def _sum(weights: Array, values: list[Array]) -> Array:
    """Of arrays, each with its weight."""
    total = weights[0] * values[0]
    for weight, value in zip(weights[1:], values[1:], strict=True):
        total += weight * value
    return total


def _expected(method: Method, acc: list[Array]) -> Array:
    """Accelerations of the next stage, by those of the two known ones that are nearest in time."""
    if len(acc) == 1:
        return acc[0]
    c = method.c[: len(acc)]
    near, next_near = np.argsort(np.abs(c - method.c[len(acc)]), kind="stable")[:2]
    share = (method.c[len(acc)] - c[near]) / (c[near] - c[next_near])
    return acc[near] + share * (acc[near] - acc[next_near])


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


def _damped(method: Method, known: _Stages) -> float:
    """What the normal damper takes, the integral of (eta - 1) over the springs' energy."""
    results = known.res
    stored = np.array([r.normal_energy - results[0].normal_energy for r in results])
    if all(r.elastic > 0 for r in results):
        return float(np.array([r.eta - 1 for r in results]) @ method.work @ stored)
    damped = 0.0
    order = np.argsort(method.c)
    for before, after in pairwise(order):  # off the floor there is no factor
        factors = [results[i].eta - 1 for i in (before, after) if results[i].elastic > 0]
        damped += sum(factors) / max(len(factors), 1) * (stored[after] - stored[before])
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
