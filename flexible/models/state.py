"""An instant of the flexible hoop, what is kept of it, and what a level of fidelity must be able to do."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ..contact.laws.law import Law
from ..contact.points.data import UNKNOWN, Bristles, Damper, Rates, Resultants
from ..contact.stage import Predictor, Stage

Array = NDArray[np.float64]
Energies = tuple[float, float, float]


class State(NamedTuple):
    """An instant of the flexible hoop; ``pos`` is (V, h, phi, q), with V counted anew in every step."""

    t: float
    x_C: float
    pos: Any
    vel: Any
    acc: Any
    mode: int
    window: tuple[int, int]  # first rim element and number of elements
    u: Any
    nodal: Any
    res: Resultants
    bristles: Bristles
    slip_velocity: float
    elastic_rate: float  # of N_el
    rates: Rates
    jerk: Any  # rate of acc, 0 where it is not known
    elastic_bend: float  # rate of elastic_rate

    @property
    def normal_force(self) -> float:
        """N, in m g."""
        return self.res.normal

    @property
    def friction_force(self) -> float:
        """F, in m g, positive to the right."""
        return self.res.friction


class Touching(NamedTuple):
    """What of a :class:`State` is at the floor."""

    window: tuple[int, int]
    u: Any
    nodal: Any
    res: Resultants
    bristles: Bristles


def in_motion(t: float, x_C: float, rows: tuple[Array, Array, Array], mode: int, rim: Touching, slip: float) -> State:
    """A state before any step, whose rates of forces are not known.

    Parameters
    ----------
    t, x_C : float
    rows : (pos, vel, acc)
    mode : int
    rim : Touching
    slip : float
        Velocity of the patch along the floor.
    """
    pos, vel, acc = rows
    return State(
        float(t), float(x_C), pos, vel, acc, mode, rim.window, rim.u, rim.nodal, rim.res, rim.bristles, float(slip),
        elastic_rate=0.0, rates=UNKNOWN, jerk=np.zeros_like(pos), elastic_bend=0.0,
    )  # fmt: skip


class Model(Protocol):
    """What the march needs of a level of fidelity."""

    law: Law
    relaxation: float
    linear: bool  # whether the ring is
    steps: float  # share of the tolerance that its steps may have

    @property
    def arrays(self) -> Any:
        """What compiled code takes of a model whose stages are compiled, otherwise None."""

    @property
    def theta(self) -> Array:
        """(n_rim,) Angles of the rim's nodes."""

    def learns(self, window: tuple[int, int] | None) -> bool:
        """Whether a stage may have failed because ``arrays`` lacked a part of the rim, which they now have."""

    def stage(
        self,
        old: State,
        mode: int,
        damper: Damper,
        predictor: Predictor,
        near: Any,
        first: bool,
    ) -> Stage:
        """Solve one stage, the ``first`` of a step or not: a chain looks for its patch there alone.

        Newton may start from the last stage that was solved, ``near`` (:class:`flexible.contact.stage.Near`).
        Whatever fails in it is a stage that is not ok, or a LinAlgError.
        """

    def energies(self, state: State, held: Energies | None = None) -> Energies:
        """Kinetic, gravity, ring strain; ``held`` is what the coordinates hold of them, where that is known."""

    def held(self, pos: Array, vel: Array) -> Energies:
        """Of these, what the coordinates hold by themselves, the ring's static displacements left out."""

    def forces(self, pos: Array, vel: Array, acc: Array) -> Array:
        """Forces of the floor on all coordinates that go with these accelerations."""

    def error(self, pos: Array, vel: Array, acc: Array, beta: float, matrix: Any, error: Array) -> float:
        """Size of an ``error`` in the velocities after a step whose last matrix of Newton is ``matrix``.

        An impulse over M: a tolerance is the same share of the impulses whatever the mass of the hoop.
        """


def momentum(model: Model, state: State, rates: Array) -> float:
    """Momentum of a state along ``rates`` of its coordinates, (n,): along a unit rate of h it is M times the velocity
    of the mass centre upwards.

    Kinetic energy is a quadratic form of the rates, so this is half a difference of its values: exact, and the same for
    every level of the hoop.
    """

    def energy(vel: Array) -> float:
        return float(model.energies(state._replace(vel=vel))[0])

    return (energy(state.vel + rates) - energy(state.vel - rates)) / 2


def held(model: Any, pos: Any, vel: Any) -> Any:
    """See ``held`` of :class:`Model`."""
    return model.held(pos, vel)


def rotation(model: Any, pos: Any, vel: Any, rolls: bool, creep: float) -> float:
    """phidot of a hoop on the floor that moved as one body, in the shape that it has, with the momentum along phi that
    it has, and along V if it does not roll; if it does V stays the ``creep``.

    The disk vibrates on a soft ring, and so does the rim at the floor: their velocities at an instant are not those of
    the hoop. These momenta are not changed by N. Kinetic energy T is a quadratic form of the rates, so that
    [T(v + e) - T(v - e)]/2 is the momentum of rates v along e.
    """
    rates, momenta = vel.copy(), np.zeros(3)
    for i in (0, 2):
        rates[i] = vel[i] + 1.0
        forth = held(model, pos, rates)[0]
        rates[i] = vel[i] - 1.0
        momenta[i] = (forth - held(model, pos, rates)[0]) / 2
        rates[i] = vel[i]
    for k in range(rates.shape[0]):
        rates[k] = 0.0
    rates[2] = 1.0
    inertia = 2 * held(model, pos, rates)[0]
    rates[0] = 1.0
    both = held(model, pos, rates)[0]
    rates[2] = 0.0
    mass = 2 * held(model, pos, rates)[0]
    shared = both - (mass + inertia) / 2
    if rolls:
        return float((momenta[2] - shared * creep) / inertia)
    return float((momenta[2] - shared / mass * momenta[0]) / (inertia - shared * shared / mass))


class Record(NamedTuple):
    """One accepted instant, and what was lost and transferred up to it (cumulative)."""

    t: float
    phi: float
    omega: float
    alpha: float
    x_C: float
    y_C: float
    slip_velocity: float
    vertical_velocity: float
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
    numerical_loss: float
    off_floor: float
    turns: int
    mode: int


class Books(NamedTuple):
    """Running totals of a march."""

    normal_impulse: float = 0.0
    friction_impulse: float = 0.0
    friction_loss: float = 0.0
    damping_loss: float = 0.0
    numerical_loss: float = 0.0
    off_floor: float = 0.0
