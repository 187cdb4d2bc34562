"""An instant of the flexible hoop, what is kept of it, and what a level of fidelity must be able to do."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ..contact.laws.law import Law
from ..contact.points.data import Bristles, Damper, Resultants
from ..contact.stage import Predictor, Stage

Array = NDArray[np.float64]
Energies = tuple[float, float, float]


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
    res: Resultants
    bristles: Bristles
    slip_velocity: float
    elastic_rate: float = 0.0  # of N_el
    feet_velocity: float = 0.0  # of the feet of a sliding patch's bristles, along the floor
    jerk: Array = field(default_factory=lambda: np.zeros(0))  # rate of acc, of no size where it is not known
    elastic_bend: float = 0.0  # rate of elastic_rate

    def __post_init__(self) -> None:
        if not self.jerk.size:
            object.__setattr__(self, "jerk", np.zeros_like(self.pos))

    @property
    def normal_force(self) -> float:
        return self.res.normal

    @property
    def friction_force(self) -> float:
        return self.res.friction


class Model(Protocol):
    """What the march needs of a level of fidelity."""

    law: Law
    relaxation: float

    @property
    def arrays(self) -> Any:
        """What the compiled step takes of a model whose stages are compiled code, otherwise None."""

    def learns(self, window: tuple[int, int] | None) -> bool:
        """Whether a stage may have failed because ``arrays`` lacked a part of the rim, which they now have."""

    def patch_damping(self, state: State) -> float:
        """Damping coefficient of the sticking patch against slip."""

    def stage(
        self,
        old: State,
        mode: int,
        damper: Damper,
        predictor: Predictor,
        near: Any,
        first: bool,
    ) -> Stage:
        """Solve one stage, the ``first`` of a step or not.

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


class Record(NamedTuple):
    """One accepted instant, and what was lost and transferred up to it (cumulative)."""

    t: float
    phi: float
    omega: float
    alpha: float
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
    numerical_loss: float
    off_floor: float
    mode: int


class Books(NamedTuple):
    """Running totals of a march."""

    normal_impulse: float = 0.0
    friction_impulse: float = 0.0
    friction_loss: float = 0.0
    damping_loss: float = 0.0
    numerical_loss: float = 0.0
    off_floor: float = 0.0


def record(model: Model, state: State, books: Books, held: Energies | None = None) -> Record:
    """What is kept of an instant; ``held`` as in :meth:`Model.energies`."""
    kinetic, gravity, strain = model.energies(state, held)
    res = state.res
    return Record(
        state.t, float(state.pos[2]), float(state.vel[2]), float(state.acc[2]), state.x_C, 1 + float(state.pos[1]),
        state.slip_velocity, float(state.vel[1]), res.normal, res.friction, res.length, res.stuck,
        kinetic, gravity, strain, res.normal_energy + res.bristle_energy, *books, state.mode,
    )  # fmt: skip
