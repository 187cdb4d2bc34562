"""An instant of the flexible hoop, what is kept of it, and what a level of fidelity must be able to do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..contact.laws.law import Law
from ..contact.points.data import Bristles, Damper, Resultants
from .stage import Predictor, Stage

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
        near: tuple[tuple[int, int], Array],
        first: bool,
    ) -> Stage:
        """Solve one stage, the ``first`` of a step or not.

        The rim's nodes start from where they were near by, a window and its displacement, if that is the same window.
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


@dataclass(frozen=True, slots=True)
class Record:
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


@dataclass(slots=True)
class Books:
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
        t=state.t,
        phi=float(state.pos[2]),
        omega=float(state.vel[2]),
        alpha=float(state.acc[2]),
        x_C=state.x_C,
        y_C=1 + float(state.pos[1]),
        slip_velocity=state.slip_velocity,
        approach_velocity=float(state.vel[1]),
        normal_force=res.normal,
        friction_force=res.friction,
        patch_length=res.length,
        stick_fraction=res.stuck,
        kinetic=kinetic,
        gravity=gravity,
        ring_strain=strain,
        contact_spring=res.normal_energy + res.bristle_energy,
        normal_impulse=books.normal_impulse,
        friction_impulse=books.friction_impulse,
        friction_loss=books.friction_loss,
        damping_loss=books.damping_loss,
        numerical_loss=books.numerical_loss,
        off_floor=books.off_floor,
        mode=state.mode,
    )
