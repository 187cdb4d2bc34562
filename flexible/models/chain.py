"""The hoop whose ring is a chain of parts, see :mod:`flexible.chain`: geometrically exact, stages in compiled code."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix, csr_array
from scipy.sparse.linalg import splu

from rigid import Scene

from ..chain.bordered import Factors
from ..chain.ring import ChainRing, beside_weld, dense_stiffness, mass_matrix, rim_matrix
from ..chain.rod.corotated import elastic
from ..chain.stage import Arrays, solved
from ..chain.touch import turned
from ..chain.whole import energies_of, floor_forces, held, momentum_error, moved, reach
from ..contact.points.data import Damper
from ..contact.stage import Near, Predictor, Stage
from ..ring.choice import ring_of
from .rim_contact import SLOW, RimContact
from .state import Energies, State

Array = NDArray[np.float64]
Window = tuple[int, int]

PER_PART = 2  # rim elements to a part
THROUGH = 2  # elements through the wall of the mesh that the chain is condensed from


class ChainHoop(RimContact):
    """Frame and chain of a scene's hoop; see :class:`flexible.models.state.Model`.

    ``State.pos`` is (V, h, phi, then u1, u2 and the rotation of each section in turn).

    Parameters
    ----------
    points : float, optional
        See :class:`flexible.models.rim_contact.RimContact`.
    through : int
        Elements through the wall of the mesh.
    """

    linear = False

    def __init__(self, scene: Scene, points: float | None = None, through: int = THROUGH) -> None:
        ring = ring_of(scene, through, self.linear)
        self.ring = ChainRing(scene, ring, ring.mesh.around // PER_PART)
        super().__init__(scene, self.ring.vertex, points, self.ring.within, ring.mesh.around)
        #: momenta of the slow vibrations, by which steps are chosen, of a rate of the sections
        self._slow = np.zeros((0, self.coordinates))
        if scene.hoop.mass_ratio > 0:
            chain, slow = self.ring.chain, self.ring.shape.shapes[:, :SLOW]
            of_modes = (mass_matrix(chain.rod, chain.ends) @ slow).T / scene.hoop.mass_ratio**0.5
            self._slow = np.ascontiguousarray(of_modes)  # as of a ring without mass: compiled code is of one layout

    @property
    def coordinates(self) -> int:
        """Number of coordinates of the ring in ``State.pos``."""
        return 3 * self.ring.sections

    @cached_property
    def arrays(self) -> Arrays:
        """What the compiled step takes."""
        ring = self.ring
        return Arrays(
            ring.chain, ring.nodes, ring.shape.missing, ring.stiffness, self._slow, self.vertex, self.theta,
            self.element, self.law.parameters, np.zeros(2),
        )  # fmt: skip

    def displacement(self, state: State, window: Window) -> Array:
        """Displacement of the rim nodes of a window."""
        if window == state.window:
            return state.u
        u: Array = moved(self.arrays, state, window)[0]
        return u

    def lowest_in(self, state: State) -> Window:
        """See :class:`flexible.models.rim_contact.RimContact`: nodes follow their sections one by one."""
        low, high = reach(self.arrays, state.pos)
        return self.window(float(state.pos[2]), low, high, self.element)

    def stage(
        self,
        old: State,
        mode: int,
        damper: Damper,
        predictor: Predictor,
        near: Near,
        first: bool,
    ) -> Stage:
        """See :class:`flexible.models.state.Model`."""
        found: Stage = solved(self.arrays, old, mode, damper, predictor, near, first)
        return found

    def energies(self, state: State, held: Energies | None = None) -> Energies:
        """Kinetic, gravity (0 with the hoop's centre at the floor), ring strain."""
        kinetic, gravity, strain = energies_of(self.arrays, state, held or self.held(state.pos, state.vel))
        return kinetic, gravity, strain

    def held(self, pos: Array, vel: Array) -> tuple[float, float, float]:
        """See :class:`flexible.models.state.Model`."""
        kinetic, gravity, strain = held(self.ring.chain, pos, vel)
        return kinetic, gravity, strain

    def forces(self, pos: Array, vel: Array, acc: Array) -> Array:
        """See :class:`flexible.models.state.Model`."""
        force: Array = floor_forces(self.arrays, pos, vel, acc)
        return force

    def error(self, pos: Array, vel: Array, acc: Array, beta: float, matrix: Factors, error: Array) -> float:
        """See :class:`flexible.models.state.Model`."""
        return float(momentum_error(self.arrays, pos, vel, acc, beta, matrix, error))

    def resting(self, omega: float, alpha: float, a1: float, a2: float) -> RestingChain:
        """The ring at rest in a frame with these rates and this acceleration of C, gravity included."""
        return RestingChain(self.ring, omega, alpha, np.array([a1, a2]))


class RestingChain:
    """See :class:`flexible.models.equilibrium.RestingRing`."""

    def __init__(self, ring: ChainRing, omega: float, alpha: float, acceleration: Array) -> None:
        self.ring = ring
        _, rod, ends = ring.chain
        self.coordinates = np.zeros(3 * ring.sections)
        turn = alpha * np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 0]]) - omega**2 * np.diag([1.0, 1, 0])
        y = np.column_stack([rod.place, np.ones(len(rod.mass))])[1:-1]
        weights = np.column_stack([rod.mass, rod.mass, rod.turning])[1:-1]
        load = y @ turn.T + np.array([*acceleration, alpha])
        self.load = (weights * load).ravel()
        self.inertia = np.kron(np.diag(rod.mass[1:-1]), turn)
        beside = beside_weld(len(self.load))
        self.load[beside] += ends.first.T @ acceleration + alpha * ends.turning - omega**2 * ends.stretching
        self.inertia[np.ix_(beside, beside)] += alpha * ends.gyro - omega**2 * ends.mass

    def _padded(self) -> Array:
        return np.concatenate([np.zeros(3), self.coordinates, np.zeros(3)]).reshape(-1, 3)

    def linearise(self, share: float) -> None:
        """See :class:`flexible.models.equilibrium.RestingRing`."""
        q = self._padded()
        matrix = dense_stiffness(self.ring.chain.rod, q)[3:-3, 3:-3] + share * self.inertia
        force = np.zeros_like(q)
        elastic(self.ring.chain.rod, q, force)
        self._solve = splu(csc_matrix(matrix)).solve
        pull = force[1:-1].ravel() + share * (self.inertia @ self.coordinates + self.load)
        self.base = self.coordinates - self._solve(pull)
        self._known: dict[Window, tuple[Array, csr_array, Array]] = {}
        self._answers: dict[int, Array] = {}

    def _inverse(self, coordinates: NDArray[np.int64]) -> Array:
        """Rows and columns of these coordinates of the sections' compliance, each solved for once."""
        missing = [i for i in coordinates.tolist() if i not in self._answers]
        if missing:
            unit = np.zeros((len(self.coordinates), len(missing)), order="F")
            unit[missing, np.arange(len(missing))] = 1.0
            self._answers.update(zip(missing, self._solve(unit).T, strict=True))
        return np.stack([self._answers[i] for i in coordinates.tolist()], axis=1)[coordinates]

    def _window(self, window: Window) -> tuple[Array, csr_array, Array]:
        """Of the nodes: displacement, derivatives by the sections, and compliance."""
        if window not in self._known:
            ring, q = self.ring, self._padded()
            number, nodes = ring.window(*window)
            moved, rows, turn = rim_matrix(ring.chain.rod, q, nodes)
            yields = turned(ring.missing(number, number), turn, turn)
            near = np.unique(rows.indices)
            few = rows[:, near]
            self._known[window] = moved.ravel(), rows, yields + few @ (few @ self._inverse(near).T).T
        return self._known[window]

    def response(self, window: Window) -> tuple[Array, Array]:
        """See :class:`flexible.models.equilibrium.RestingRing`."""
        moved, rows, compliance = self._window(window)
        return moved + rows @ (self.base - self.coordinates), compliance

    def move(self, window: Window, force: Array) -> float:
        """See :class:`flexible.models.equilibrium.RestingRing`."""
        moved = self.base + self._solve(self._window(window)[1].T @ force)
        change = float(np.abs(moved - self.coordinates).max() / max(np.abs(moved).max(), 1e-300))
        self.coordinates = moved
        return change
