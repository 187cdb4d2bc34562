"""The march in time: adaptive steps, stick and slip of the patch as located events, and the books on energy.

Nothing here knows how a stage is solved: a *model* does (``stage``, ``displacement``, ``energies``), and there is one
for each level of fidelity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, pi
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .contact import (
    BRISTLE_ENERGY,
    BRUSH,
    DRAG,
    ELASTIC,
    ETA,
    FRICTION,
    LENGTH,
    NORMAL,
    NORMAL_ENERGY,
    SLIP,
    STICK,
    STUCK,
)
from .step import BETA, ERROR_WEIGHTS, TAU

Array = NDArray[np.float64]

_QUADRATURE = (2**0.5 / 4, 2**0.5 / 4, BETA)  # of TR-BDF2 over a step


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """An instant of the flexible hoop; ``pos`` is (V, h, phi, q), with V counted anew in every step."""

    t: float
    x_C: float
    pos: Array
    vel: Array
    acc: Array
    mode: int
    window: tuple[int, int]  # first rim element and number of elements
    u: Array
    nodal: Array
    res: Array
    bristles: Array
    flags: NDArray[np.int8]
    slip_velocity: float
    elastic_rate: float = 0.0  # of N_el

    @property
    def normal_force(self) -> float:
        return float(self.res[NORMAL])

    @property
    def friction_force(self) -> float:
        return float(self.res[FRICTION])


class Model(Protocol):
    """What the march needs of a level of fidelity."""

    mu_s: float
    relaxation: float

    def patch_damping(self, state: State) -> float:
        """Damping coefficient of the sticking patch against slip."""

    def stage(
        self,
        old: State,
        mode: int,
        damper: Array,
        pos_pred: Array,
        vel_pred: Array,
        beta: float,
        guess: Array,
        near: tuple[tuple[int, int], Array] | None = None,
    ) -> Any:
        """Solve one stage: (ok, d, acc, matrix, window, u, nodal, res, bristles, flags).

        ``guess`` starts the increment, ``near`` (a window and its displacement) the ring.
        """

    def energies(self, state: State) -> tuple[float, float, float]:
        """Kinetic, gravity, ring strain."""

    def momentum_error(self, state: State, beta: float, matrix: Any, error: Array) -> float:
        """Size, as an impulse, of an error in the velocities after a step that ended with Newton's ``matrix``."""


@dataclass(frozen=True, slots=True)
class Record:
    """One accepted instant, and what was lost and transferred up to it (cumulative)."""

    t: float
    phi: float
    omega: float
    x_C: float
    y_C: float
    slip_velocity: float
    approach_velocity: float
    normal_force: float
    friction_force: float
    patch_length: float
    stick_fraction: float
    kinetic: float
    gravity: float
    ring_strain: float
    contact_spring: float
    normal_impulse: float
    friction_impulse: float
    friction_loss: float
    damping_loss: float
    off_floor: float
    mode: int


@dataclass(slots=True)
class Books:
    """Running totals of a march."""

    normal_impulse: float = 0.0
    friction_impulse: float = 0.0
    friction_loss: float = 0.0
    damping_loss: float = 0.0
    off_floor: float = 0.0


class MarchError(RuntimeError):
    """A step that could not be mended; the sentence says where and why."""


@dataclass(slots=True)
class _Trial:
    state: State
    error: float
    impulses: tuple[float, float]
    friction_work: float
    damped: float
    off_floor: float


def _attempt(model: Model, old: State, h: float) -> _Trial | None:
    """One TR-BDF2 step of length ``h``; None if Newton failed."""
    beta = BETA * h
    rho, drag = model.relaxation / beta, model.patch_damping(old) / beta
    pos0, vel0, acc0 = old.pos, old.vel, old.acc
    elastic0 = old.res[ELASTIC]
    elastic_pred = elastic0 + beta * old.elastic_rate
    pos_pred, vel_pred = pos0 + 2 * beta * vel0 + beta**2 * acc0, vel0 + beta * acc0
    damper = np.array([rho, elastic_pred, 1.0, drag, beta * old.slip_velocity, TAU / BETA])
    first = model.stage(old, old.mode, damper, pos_pred, vel_pred, beta, beta**2 * acc0)
    if not first[0]:
        return None
    d, acc_mid, res_mid = first[1], first[2], first[7]
    pos_mid, vel_mid = pos_pred + d, vel_pred + d / beta
    c_mid, c_old = 1 / (TAU * (2 - TAU)), -((1 - TAU) ** 2) / (TAU * (2 - TAU))
    vel_pred = c_mid * vel_mid + c_old * vel0
    pos_pred = c_mid * pos_mid + c_old * pos0 + beta * vel_pred
    elastic_pred = c_mid * res_mid[ELASTIC] + c_old * elastic0
    damper = np.array([rho, elastic_pred, 1.0, drag, c_mid * res_mid[SLIP], 1 / BETA])
    guess = beta**2 * (acc_mid + (acc_mid - acc0) * (1 - TAU) / TAU)
    second = model.stage(old, old.mode, damper, pos_pred, vel_pred, beta, guess, (first[4], first[5]))
    if not second[0]:
        return None
    _, d, acc, matrix, window, u, nodal, res, bristles, flags = second
    pos, vel = pos_pred + d, vel_pred + d / beta
    error = h * (ERROR_WEIGHTS[0] * acc0 + ERROR_WEIGHTS[1] * acc_mid + ERROR_WEIGHTS[2] * acc)
    slip_mid, slip = (r[SLIP] if r[NORMAL] > 0 else p[0] for r, p in ((res_mid, pos_mid), (res, pos)))
    bend = (slip - slip_mid / TAU) / (1 - TAU)
    forces = (old.res, res_mid, res)
    impulses = [h * sum(w * r[i] for w, r in zip(_QUADRATURE, forces, strict=True)) for i in (NORMAL, FRICTION)]
    work, damped = 0.0, 0.0
    for a, b, moved in ((old.res, res_mid, slip_mid), (res_mid, res, slip - slip_mid)):
        work += (a[FRICTION] - a[DRAG] + b[FRICTION] - b[DRAG]) / 2 * moved
        damped -= (a[DRAG] + b[DRAG]) / 2 * moved
        damped += (_eta(a, b) - 1) * (b[NORMAL_ENERGY] - a[NORMAL_ENERGY])
    off = h * sum(w for w, r in zip(_QUADRATURE, forces, strict=True) if r[NORMAL] == 0)
    x_C = old.x_C + pos[0] + (pos[2] - pos0[2])
    pos = pos.copy()
    pos[0] = 0.0
    elastic_rate = float(res[ELASTIC] - elastic_pred) / beta
    state = State(
        old.t + h, x_C, pos, vel, acc, old.mode, window, u, nodal, res, bristles, flags,
        float((slip + bend) / h), elastic_rate,
    )  # fmt: skip
    size = model.momentum_error(state, beta, matrix, error)
    return _Trial(state, size, (impulses[0], impulses[1]), work, damped, off)


def _eta(first: Array, second: Array) -> float:
    """Mean damping factor between two instants, of those in contact."""
    factors = [float(res[ETA]) for res in (first, second) if res[ELASTIC] > 0]
    return sum(factors) / len(factors) if factors else 1.0


def restart(model: Model, state: State, mode: int) -> State:
    """The same instant under another law of friction: accelerations and static displacements jump, nothing else."""
    beta = 1e-7
    damper = np.array([0.0, 0.0, state.res[ETA] if state.res[ELASTIC] > 0 else 1.0, 0.0, 0.0, 1.0])
    ok, d, acc, _, window, u, nodal, res, bristles, flags = model.stage(
        state, mode, damper, state.pos, state.vel, beta, beta**2 * state.acc
    )
    if not ok:
        raise MarchError(f"no forces at t = {state.t:.6g}, phi = {state.pos[2]:.6g}: the patch could not be re-solved.")
    pos = state.pos.copy()
    pos[3:] += d[3:]  # a ring without mass jumps; one with mass stays where it is, but for beta^2 acc
    return replace(
        state, pos=pos, acc=acc, mode=mode, window=window, u=u, nodal=nodal, res=res, bristles=bristles, flags=flags
    )


def _excess(model: Model, state: State) -> float:
    """Positive when the patch can no longer go on as it does."""
    if state.mode == STICK:
        return abs(state.res[FRICTION]) - model.mu_s * state.res[NORMAL] if state.res[NORMAL] > 0 else -1.0
    if state.mode == BRUSH or state.res[NORMAL] == 0 or model.mu_s == 0:
        return -1.0
    return state.mode * state.slip_velocity


def record(model: Model, state: State, books: Books) -> Record:
    """What is kept of an instant."""
    kinetic, gravity, strain = model.energies(state)
    res = state.res
    return Record(
        t=state.t,
        phi=float(state.pos[2]),
        omega=float(state.vel[2]),
        x_C=state.x_C,
        y_C=1 + float(state.pos[1]),
        slip_velocity=state.slip_velocity,
        approach_velocity=float(state.vel[1]),
        normal_force=float(res[NORMAL]),
        friction_force=float(res[FRICTION]),
        patch_length=float(res[LENGTH]),
        stick_fraction=float(res[STUCK]),
        kinetic=kinetic,
        gravity=gravity,
        ring_strain=strain,
        contact_spring=float(res[NORMAL_ENERGY] + res[BRISTLE_ENERGY]),
        normal_impulse=books.normal_impulse,
        friction_impulse=books.friction_impulse,
        friction_loss=books.friction_loss,
        damping_loss=books.damping_loss,
        off_floor=books.off_floor,
        mode=state.mode,
    )


def march(
    model: Model,
    state: State,
    done: Callable[[State], float],
    rtol: float,
    h: float = 1e-4,
    largest_step: float = 0.05,
    max_steps: int = 50_000,
    progress: Callable[[State], None] | None = None,
    keep: Callable[[State], None] | None = None,
) -> tuple[State, list[Record], int, str]:
    """March until ``done(state)`` turns positive; that instant is located.

    ``keep`` is given the state behind every record.

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

    note(state)
    attempts, accepted = 0, 0
    tolerance = 3.0 * rtol**1.5  # second order: the error over a pulse goes as its power 2/3
    while attempts < max_steps:
        attempts += 1
        trial = _attempt(model, state, h)
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
        stored = trial.state.res[BRISTLE_ENERGY] - state.res[BRISTLE_ENERGY]
        books.friction_loss -= trial.friction_work + stored
        books.damping_loss += trial.damped
        books.off_floor += trial.off_floor
        state = trial.state
        note(state)
        if progress is not None:
            progress(state)
        if done(state) >= 0:
            return state, records, attempts, ""
        if event is not None:
            mode = STICK if state.mode != STICK else (1 if state.res[FRICTION] > 0 else -1)
            state = restart(model, state, mode)
            # what the ring and the patch let go of in the jump of the friction force is lost to friction
            before, after = records[-1], record(model, state, books)
            released = before.ring_strain + before.contact_spring - after.ring_strain - after.contact_spring
            books.friction_loss += released
            note(state)
            h = min(h, grown) / 8
        else:
            h = grown
    return state, records, attempts, f"stopped at t = {state.t:.6g} after {max_steps} steps"


def advanced(model: Model, state: State, t: float) -> State | None:
    """The state at ``t`` by a single step from ``state``, shorter than the one accepted there; None if it fails."""
    trial = _attempt(model, state, t - state.t)
    return None if trial is None else trial.state


def _stuck(state: State) -> str:
    return (
        f"stopped at t = {state.t:.6g}, phi = {state.pos[2]:.6g} (N = {state.normal_force:.4g}): "
        "no step however short could be solved"
    )


def _locate(model: Model, old: State, trial: _Trial, watch: Callable[[State], float]) -> tuple[_Trial, int]:
    """The step that ends where ``watch`` turns positive, by the Illinois method on the step's length."""
    low, f_low = 0.0, min(watch(old), 0.0)
    high, f_high, best = trial.state.t - old.t, watch(trial.state), trial
    width, n = high, 0
    side = 0
    while n < 30 and high - low > 1e-10 * width:
        n += 1
        h = high - f_high * (high - low) / (f_high - f_low) if f_high > f_low else (low + high) / 2
        h = min(max(h, low + 0.001 * (high - low)), high - 0.001 * (high - low))
        middle = _attempt(model, old, h)
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


__all__ = ["Books", "MarchError", "Model", "Record", "State", "advanced", "inf", "march", "pi", "record", "restart"]
