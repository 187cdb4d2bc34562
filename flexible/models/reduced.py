"""The reduced hoop as a model for the march: windows of the rim, stages in compiled code."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from ..contact.points.data import Before, Damper, Rim
from ..ring.frame import energies, inertia
from ..ring.reduction import ReducedRing, reduce
from .equilibrium import RestingModes
from .rim_contact import RimContact
from .stage import Predictor, Window, filtered_error, largest, solve_stage
from .state import Stage, State

Array = NDArray[np.float64]


class ReducedHoop(RimContact):
    """Frame, modes and residual static compliance of a scene's hoop."""

    def __init__(self, scene: Scene, modes: int = 24, points: int | None = None, tolerance: float = 1e-9) -> None:
        self.ring: ReducedRing = reduce(scene, modes)
        super().__init__(scene, self.ring.vertex, points, tolerance)
        self._blocks: dict[tuple[int, int], tuple[Array, Array]] = {}

    @property
    def coordinates(self) -> int:
        """Number of coordinates of the ring in ``State.pos``."""
        return len(self.ring.frame.modal)

    def _arrays(self, window: tuple[int, int]) -> tuple[Array, Array]:
        n = len(self.ring.vertex)
        key = (window[0] % n, window[1])
        if key not in self._blocks:
            shapes, compliance = self.ring.window(*key)
            self._blocks[key] = (np.ascontiguousarray(shapes), np.ascontiguousarray(compliance))
        return self._blocks[key]

    def resting(self, omega: float, alpha: float, a1: float, a2: float) -> RestingModes:
        """The ring at rest in a frame with these rates and this acceleration of C, gravity included."""
        square, l1, l2, rotation, stretching = self.ring.frame.modal.T
        dynamic = np.diag(square - omega**2) + alpha * self.ring.frame.gyro
        return RestingModes(dynamic, a1 * l1 + a2 * l2 + alpha * rotation - omega**2 * stretching, self._arrays)

    def displacement(self, state: State, window: tuple[int, int]) -> Array:
        """Displacement of the nodes of another window at a known state."""
        if window == state.window:
            return state.u
        here, there = self.ring.dofs(*window), self.ring.dofs(*state.window)
        moved = self.ring.rim_shapes[here] @ state.pos[3:]
        if state.res.normal > 0:
            moved = moved + self.ring.compliance(here, there) @ state.nodal.ravel()
        return moved.reshape(-1, 2)

    def stage(
        self,
        old: State,
        mode: int,
        damper: Damper,
        predictor: Predictor,
        near: Stage | None = None,
    ) -> Stage:
        """See :class:`flexible.models.state.Model`."""
        expected = predictor.pos + predictor.guess
        low, high = old.res.low, old.res.high
        if old.res.normal == 0:  # a bent rim comes down anywhere
            low, high = self.reach(expected[2], expected[1], self.ring.rim_shapes @ expected[3:])
        margin = 0.3 * (high - low) + 0.1 * self.element
        for _ in range(4):
            window = self.window(float(expected[2]), low, high, margin)
            u_old = self.displacement(old, window)
            shapes, compliance = self._arrays(window)
            u_guess = near.u if near is not None and near.window == window else u_old
            near_floor = Window(Rim(window[0], self.ring.vertex), shapes, compliance)
            before = Before(old.pos[:3], u_old, old.bristles)
            iterations, d, acc, u, matrix, contact = solve_stage(
                self.ring.frame, near_floor, self.law.parameters, mode, before, damper, predictor,
                (u_guess, self.tolerance),
            )  # fmt: skip
            if iterations != -2:
                break
            margin = 2 * margin + self.element
        return Stage(
            iterations >= 0, d, acc, matrix, window, u, contact.nodal, contact.res, contact.bristles,
        )  # fmt: skip

    def energies(self, state: State) -> tuple[float, float, float]:
        """Kinetic, gravity, ring strain (of the modes and of the static part)."""
        kinetic, gravity, strain = self.held(state.pos, state.vel)
        if state.res.normal > 0:
            compliance = self._arrays(state.window)[1]
            force = state.nodal.ravel()
            strain += float(force @ compliance @ force) / 2
        return kinetic, gravity, strain

    def held(self, pos: Array, vel: Array) -> tuple[float, float, float]:
        """See :class:`flexible.models.state.Model`."""
        kinetic, gravity, strain = energies(self.ring.frame, pos, vel)
        return kinetic, gravity, strain

    def forces(self, pos: Array, vel: Array, acc: Array) -> Array:
        """See :class:`flexible.models.state.Model`."""
        force: Array = inertia(self.ring.frame, pos, vel, acc, 1.0)[0]
        return force

    def error(self, state: State, beta: float, matrix: Array, error: Array) -> float:
        """See :class:`flexible.models.state.Model`."""
        frame = self.ring.frame
        rate = filtered_error(frame, state.pos, state.vel, state.acc, beta, matrix, error)
        ringing = np.abs(rate[3:]).max(initial=0.0) / (1 + frame.body.ring_mass) ** 0.5
        return float(largest(np.array([rate[0] + rate[2], rate[1], rate[2], ringing])))
