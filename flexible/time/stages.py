"""One implicit step: its stages one after the other, its error, impulses and losses.

One text for two machines: Python runs it on a hoop (:class:`flexible.models.state.Model`), compiled code on the arrays
of one whose stages are compiled too.
"""

from __future__ import annotations

from math import nan
from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import loop, part

from ..contact.points.data import UNKNOWN, Bristles, Damper, Rates, Resultants
from ..contact.stage import Near, Predictor
from ..contact.vectors import largest, plus, times
from ..models.state import held
from .methods import Table
from .rows import advanced, along, store, work


def solved(model: Any, old: Any, mode: int, damper: Damper, predictor: Predictor, near: Any, first: bool) -> Any:
    """See ``stage`` of :class:`flexible.models.state.Model`."""
    return model.stage(old, mode, damper, predictor, near, first)


def floor_forces(model: Any, pos: Any, vel: Any, acc: Any) -> Any:
    """See ``forces`` of :class:`flexible.models.state.Model`."""
    return model.forces(pos, vel, acc)


def momentum_error(model: Any, pos: Any, vel: Any, acc: Any, beta: float, matrix: Any, error: Any) -> Any:
    """See ``error`` of :class:`flexible.models.state.Model`."""
    return model.error(pos, vel, acc, beta, matrix, error)


#: the beta of a step of no length: what it moves, beta^2 acc, must be nothing to the thinnest patch, whose depth as it
#: opens is some 1e-12 R, or N is another one after every event than before it
INSTANT = 1e-15
#: of a landing's first (N - N_el)/N_el times what the springs store: from the touch on N - N_el grows like the root of
#: the depth, and its work is 2/3 of the last times the depth, 5/2 U/N_el
LANDS = 5 / 3
LEFT = 0.05  # of the largest N_el in a step: where there is less of it eta = N/N_el is no polynomial
RENEWED = 1e-3  # share of a patch that may enter in a step whose end tells what the feet of its bristles do


class Taken(NamedTuple):
    """A step that was tried. Of one that could not be solved, only ``ok`` and ``window`` have a meaning."""

    ok: bool
    pos: Any  # at its end
    vel: Any
    acc: Any
    window: Any  # of rim, of the last stage that was tried
    u: Any
    nodal: Any
    res: Resultants
    bristles: Bristles
    slip_velocity: float
    elastic_rate: float
    rates: Rates
    jerk: Any  # rate of acc, 0 after no step
    elastic_bend: float  # rate of elastic_rate
    error: float  # of the velocities
    normal_impulse: float
    friction_impulse: float
    friction_work: float
    damped: float
    numerical: float  # energy of frame and ring that the floor's work does not account for, lost to the integrator
    off_floor: float
    held: Any  # kinetic energy, gravity and strain energy of the coordinates at its end


class _Known(NamedTuple):
    """What is known at the stages of a step, as arrays; ways and rates of the patch count from its beginning."""

    pos: Any  # (stages, n)
    vel: Any
    acc: Any
    force: Any  # of the floor
    normal: Any  # (stages,)
    friction: Any
    drag: Any
    elastic: Any
    elastic_rate: Any
    eta: Any
    stored: Any
    way: Any
    slip_velocity: Any
    feet: Any


@part
def _nothing_known(stages: int, n: int) -> _Known:
    """Room for so many stages."""
    pos, vel, acc, force = np.zeros((stages, n)), np.zeros((stages, n)), np.zeros((stages, n)), np.zeros((stages, n))
    rows = np.zeros((10, stages))
    return _Known(
        pos, vel, acc, force, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8], rows[9]
    )


@loop
def _write_down(known: _Known, i: int, pos: Any, vel: Any, acc: Any, res: Resultants) -> None:
    """A stage that is solved."""
    store(known.pos, i, pos)
    store(known.vel, i, vel)
    store(known.acc, i, acc)
    known.normal[i], known.friction[i], known.drag[i] = res.normal, res.friction, res.damping
    known.elastic[i], known.eta[i], known.stored[i] = res.elastic, res.eta, res.normal_energy


@loop
def _sum(h: float, weights: Any, values: Any, count: int) -> float:
    """``h`` times the first of the values, each with its weight."""
    total = 0.0
    for i in range(count):
        total += weights[i] * values[i]
    return h * total


@part
def _expected(table: Table, acc: Any, i: int, jerk: Any, h: float) -> Any:
    """Accelerations of stage ``i``, by those of the two known ones that are nearest in time, at first by their rate."""
    if i == 1:
        return plus(acc[0], table.c[1] * h, jerk)
    near, next_near, share = table.nearest[i, 0], table.nearest[i, 1], table.share[i]
    return plus(times(1 + share, acc[near]), -share, acc[next_near])


@loop
def _carries(table: Table, known: _Known, i: int, old: Any, h: float, damper: Damper) -> float:
    """N_el expected at stage ``i``, by its rates as :func:`_expected` has the accelerations."""
    rates = known.elastic_rate
    if h <= 0:
        return float(old.res.elastic)
    if i == 1:
        rate = rates[0] + table.c[1] * h * old.elastic_bend
    else:
        near, next_near, share = table.nearest[i, 0], table.nearest[i, 1], table.share[i]
        rate = (1 + share) * rates[near] - share * rates[next_near]
    return float(damper.elastic_0 + table.gamma * h * rate)


@loop
def _widening(old: Any, later: float) -> float:
    """Length of the patch so much later over what it is: like N_el^(1/3), a parabola's.

    A length that lags by a step would let the creep of a damped patch lag by as much.
    """
    if old.res.elastic <= 0:
        return 1.0
    return float(min(max(1 + later * old.elastic_rate / old.res.elastic, 0.1), 10.0) ** (1 / 3))


@loop
def _damped(table: Table, known: _Known) -> float:
    """What the normal damper takes, the integral of (eta - 1) over the springs' energy."""
    stored, touches, most = known.stored, True, 0.0
    for i in range(stored.shape[0]):
        most = max(most, known.elastic[i])
    for i in range(stored.shape[0]):
        touches = touches and known.elastic[i] > LEFT * most
    damped = 0.0
    if touches:
        for i in range(stored.shape[0]):
            for j in range(stored.shape[0]):
                damped += (known.eta[i] - 1) * table.work[i, j] * (stored[j] - stored[0])
        return damped
    for k in range(1, stored.shape[0]):  # eta grows without bound towards a touch, N does not
        before, after = table.order[k - 1], table.order[k]
        springs = known.elastic[before] + known.elastic[after]
        if springs > 0:
            lands = known.elastic[before] == 0
            share = (known.normal[before] + known.normal[after]) / springs - 1
            damped += (LANDS if lands else 1.0) * share * (stored[after] - stored[before])
    return damped


@loop
def _rates(table: Table, known: _Known, h: float, end: int, drag: float, length: float) -> Rates:
    """How the patch changes at the end of a step, which a damper of coefficient ``drag`` would hold if it stuck.

    The rate of N_el is the step's own, others are its stages'. Bristles that enter in a step have slid with it from
    then on alone: what their feet did in it is known where next to none do.
    """
    damped, slip, feet = 0.0, 0.0, nan
    for i in range(known.normal.shape[0]):
        damped += table.end_rate[i] * (known.normal[i] - known.elastic[i])
        slip += table.end_rate[i] * known.slip_velocity[i]
    if abs(known.pos[end, 2] - known.pos[0, 2]) < RENEWED * length:
        feet = _sum(1 / h, table.end_rate, known.feet, known.normal.shape[0])
    elastic = known.elastic_rate[end]
    return Rates(elastic + damped / h, elastic, -drag * slip / h, feet)


@part
def _posed(old: Any, h: float, table: Table, known: _Known, i: int, damping: Any) -> tuple[Predictor, Damper]:
    """What stage ``i`` of a step is to solve."""
    beta, weights = table.gamma * h, table.a[i]
    vel = advanced(old.vel, h, weights, known.acc, i)
    pos = plus(advanced(old.pos, h, weights, known.vel, i), beta, vel)
    elastic = old.res.elastic + _sum(h, weights, known.elastic_rate, i)
    way = _sum(h, weights, known.slip_velocity, i)
    turning = table.c[i] * (h * vel[2] - (pos[2] - old.pos[2]) / table.gamma)
    drag = damping[1] * _widening(old, table.c[i] * h) / beta
    damper = Damper(
        damping[0] / beta, elastic, 1.0, drag, way, table.c[i] / table.gamma, 1 / beta, 0.0, turning, False, 0.0
    )  # fmt: skip
    return Predictor(pos, vel, beta, times(beta**2, _expected(table, known.acc, i, old.jerk, h))), damper


@part
def _at_once(old: Any, known: _Known, drag: float) -> tuple[Predictor, Damper]:
    """The same of a step of no length: rates stay what they are, and so does what a damper of coefficient ``drag``
    holds the patch with."""
    eta = old.res.eta if old.res.elastic > 0 else 1.0
    held = -drag * old.slip_velocity
    damper = Damper(0.0, 0.0, eta, 0.0, 0.0, 1.0, 0.0, old.slip_velocity, 0.0, False, held)
    return Predictor(known.pos[0].copy(), known.vel[0].copy(), INSTANT, times(INSTANT**2, known.acc[0])), damper


def take(model: Any, old: Any, h: float, table: Table, damping: Any, known_to: float, before: Any) -> Taken:
    """A step of length ``h`` of a model from ``old``; of no length, a single stage that brings forces up to date.

    Parameters
    ----------
    model : flexible.models.state.Model or flexible.models.reduced.Arrays
    old : State
    h : float
    table : Table
    damping : (float, float)
        The normal damper's time, and the coefficient of the sticking patch against slip.
    known_to : float
        Share of 1 + N to which forces are found.
    before : (float, float, float)
        What the coordinates of ``old`` hold, see ``held`` of :class:`flexible.models.state.Model`.
    """
    stages = table.c.shape[0]
    end = stages - 1 if h > 0 else 1
    beta = table.gamma * h if h > 0 else INSTANT
    known = _nothing_known(stages, old.pos.shape[0])
    _write_down(known, 0, old.pos, old.vel, old.acc, old.res)
    known.elastic_rate[0], known.slip_velocity[0] = old.elastic_rate, old.slip_velocity
    window, u, nodal, res, bristles = old.window, old.u, old.nodal, old.res, old.bristles
    ok, error = True, 0.0
    pose, carried = old.pos, old.res.elastic
    for i in range(1, end + 1):
        predictor, damper = _posed(old, h, table, known, i, damping) if h > 0 else _at_once(old, known, damping[1])
        pos, vel = predictor.pos, predictor.vel
        begins = largest(pos) + largest(vel) + largest(predictor.guess) + damper.elastic_0 + damper.way_0
        # without numbers to begin with there is nothing to solve: no angle, no rim
        if not np.isfinite(begins + damper.turning_0 + damper.drag + damper.eta_0 + damper.velocity_0):
            ok = False
            break
        near = Near(window, u, pose, carried, _carries(table, known, i, old, h, damper), known_to)
        found = solved(model, old, old.mode, damper, predictor, near, i == 1)
        window = found.window
        if not found.ok:
            ok = False
            break
        u, nodal, res, bristles = found.u, found.nodal, found.res, found.bristles
        _write_down(known, i, plus(pos, 1.0, found.d), plus(vel, 1 / beta, found.d), found.acc, res)
        store(known.force, i, found.forces)
        pose, carried = known.pos[i], res.elastic
        known.elastic_rate[i] = (res.elastic - damper.elastic_0) / beta
        known.feet[i] = res.feet
        known.way[i], known.slip_velocity[i] = res.way, (res.way - damper.way_0) / beta
        if i == stages - 1 and h > 0:
            off = advanced(np.zeros(pos.shape[0]), h, table.error, known.acc, stages)
            error = momentum_error(model, known.pos[i], known.vel[i], known.acc[i], beta, found.matrix, off)
    jerk = advanced(np.zeros(old.pos.shape[0]), 1 / h, table.trend, known.acc, stages) if h > 0 else times(0.0, old.pos)
    bend = _sum(1 / h, table.trend, known.elastic_rate, stages) if h > 0 else 0.0
    rates = _rates(table, known, h, end, damping[1], res.length) if h > 0 else UNKNOWN
    off_floor = 0.0
    for i in range(stages):
        if known.normal[i] == 0:
            off_floor += h * table.span[i]
    drag_work = work(table.work, known.drag, known.way)
    numerical, after = 0.0, before
    if ok and h > 0:
        store(known.force, 0, floor_forces(model, old.pos, old.vel, old.acc))
        after = held(model, known.pos[end], known.vel[end])
        numerical = before[0] + before[1] + before[2] - (after[0] + after[1] + after[2])
        for i in range(stages):
            for j in range(1, stages):
                numerical += table.work[i, j] * along(known.force[i], known.pos[j], known.pos[0])
    return Taken(
        ok, known.pos[end].copy(), known.vel[end].copy(), known.acc[end].copy(), window, u, nodal, res, bristles,
        known.slip_velocity[end], known.elastic_rate[end], rates, jerk, bend, error,
        _sum(h, table.b, known.normal, stages), _sum(h, table.b, known.friction, stages),
        res.beyond + work(table.work, known.friction, known.way) - drag_work, _damped(table, known) - drag_work,
        numerical, off_floor, after,
    )  # fmt: skip
