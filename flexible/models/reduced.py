"""The reduced hoop as a model for the march: windows of the rim, stages in compiled code."""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid import Scene
from rigid.kernel.compile import jit, loop, part

from ..contact.guess import is_let_go
from ..contact.laws.listing import is_smoothed, may_end
from ..contact.points.data import Damper, Parameters, at_start
from ..contact.points.data import Rim as NearFloor
from ..contact.points.detection import least_gap
from ..contact.points.rim import below_floor, margin_around, window_around
from ..contact.stage import Near, Predictor, Stage
from ..contact.vectors import largest, plus
from ..ring.frame import Frame, energies, inertia
from ..ring.rim.reduction import ReducedRing, Rim, is_known, reduce, residual, window_dofs
from .equilibrium import RestingRing
from .rim_contact import RimContact
from .stage import FORESEEN, HELD, LET_GO, RAISED, From, Window, filtered_error, solve_stage
from .state import Energies, State

Array = NDArray[np.float64]

FALLS_ON = 1e4  # m g: a step that falls so deep through the floor that the foundation would push more is too long
SNAPS = 1e-8  # a stage's beta, sqrt(R/g), below which a patch may be let go of: longer steps are cut instead


class Arrays(NamedTuple):
    """A reduced hoop in compiled code."""

    frame: Frame
    rim: Rim
    vertex: Any  # (n_elements,) angles at which rim elements begin
    theta: Any  # (n_rim,) angles of rim nodes
    element: float  # mean length of one
    law: Parameters


@jit
def _moved(arrays: Arrays, old: State, window: tuple[int, int]) -> Any:
    """Displacement of the nodes of another window at a known state."""
    if window == old.window:
        return old.u
    elements = arrays.vertex.shape[0]
    here, there = window_dofs(elements, window), window_dofs(elements, old.window)
    moved = np.zeros((here.shape[0] // 2, 2))
    _move(moved, arrays.rim.shapes, here, old.pos, residual(arrays.rim, here, there), old.nodal, old.res.normal)
    return moved


@loop
def _move(moved: Any, shapes: Any, dofs: Any, pos: Any, gives: Any, nodal: Any, normal: float) -> None:
    """Fill in the displacement of some dofs of the rim."""
    for i in range(dofs.shape[0]):
        for k in range(shapes.shape[1]):
            moved[i // 2, i % 2] += shapes[dofs[i], k] * pos[3 + k]
        if normal > 0:
            for j in range(gives.shape[1]):
                moved[i // 2, i % 2] += gives[i, j] * nodal[j // 2, j % 2]


@part
def _near_floor(arrays: Arrays, window: tuple[int, int]) -> Window:
    """What the ring answers in a window."""
    dofs = window_dofs(arrays.vertex.shape[0], window)
    block = residual(arrays.rim, dofs, dofs)
    shapes, compliance = np.empty((dofs.shape[0], arrays.rim.shapes.shape[1])), np.empty(block.shape)
    _cut_out(shapes, compliance, arrays.rim.shapes, block, dofs)
    return Window(NearFloor(window[0], arrays.vertex), shapes, compliance)


@loop
def _cut_out(shapes: Any, compliance: Any, all_shapes: Any, block: Any, dofs: Any) -> None:
    """Fill in modes and symmetric compliance at some dofs of the rim."""
    for i in range(dofs.shape[0]):
        for k in range(shapes.shape[1]):
            shapes[i, k] = all_shapes[dofs[i], k]
        for j in range(dofs.shape[0]):
            compliance[i, j] = (block[i, j] + block[j, i]) / 2


@loop
def _bend(moved: Any, shapes: Any, pos: Any) -> None:
    """Add the modes' displacement of some nodes of the rim."""
    for i in range(moved.shape[0]):
        for k in range(shapes.shape[1]):
            moved[i] += shapes[i, k] * pos[3 + k]


def _solved(
    arrays: Arrays, old: State, mode: int, damper: Damper, predictor: Predictor, near: Near, first: bool
) -> Stage:
    """See :class:`flexible.models.state.Model`; not ok as well where a window's compliance is not known."""
    expected = plus(predictor.pos, 1.0, predictor.guess)
    low, high = old.res.low, old.res.high
    if old.res.normal == 0:  # a bent rim comes down anywhere
        moved = np.zeros(arrays.rim.shapes.shape[0])
        _bend(moved, arrays.rim.shapes, expected)
        low, high = below_floor(arrays.theta, expected[2], expected[1], moved)
    unknown = np.empty((0, 0)), np.empty(0, np.int64)
    found = Stage(False, expected, expected, expected, unknown, old.window, old.u, old.nodal, old.res, old.bristles)
    falls = old.res.normal == 0 and arrays.law.eps_n * (high - low) ** 3 / 12 > FALLS_ON
    if falls or not is_known(arrays.rim, window_dofs(arrays.vertex.shape[0], old.window)):  # of an earlier march
        return found
    margin = margin_around(low, high, arrays.element)
    deepest = least_gap(near.pos[1], near.pos[2], near.u, NearFloor(near.window[0], arrays.vertex))
    for _ in range(4):
        window = window_around(arrays.vertex, expected[2], low, high, margin)
        if not is_known(arrays.rim, window_dofs(arrays.vertex.shape[0], window)):
            return Stage(
                False, expected, expected, expected, found.matrix, window, old.u, old.nodal, old.res, old.bristles
            )  # fmt: skip
        u_old = _moved(arrays, old, window)
        before = at_start(old, u_old, predictor.beta)
        u = near.u if near.window == window else u_old
        facing, guessed = _near_floor(arrays, window), FORESEEN if near.elastic > 0 else RAISED
        # a depth foreseen to a thousandth may make a short step's damper pull: under no pressure no bristle sticks. And
        # a patch that friction drives on snaps off; of laws with modes that is the end of one
        snaps = old.res.normal > 0 and predictor.beta < SNAPS and not may_end(arrays.law)
        smoothed = is_smoothed(arrays.law)
        last = LET_GO if snaps else HELD if smoothed else RAISED
        begins = LET_GO if is_let_go(old.res) else guessed
        free = np.zeros(facing.shapes.shape[0])
        _bend(free, facing.shapes, expected)
        while True:
            at = free.reshape(u_old.shape) if begins == LET_GO else u
            start = From(at, deepest, near.elastic, near.expected, near.known, begins)
            answer = solve_stage(arrays.frame, facing, arrays.law, mode, before, damper, predictor, start)
            if answer.iterations != -1 or begins == last:
                break
            if begins == LET_GO:
                begins = guessed
            else:
                begins += 2 if begins == RAISED and not smoothed else 1
        contact = answer.contact
        found = Stage(
            answer.iterations >= 0, answer.d, answer.acc, answer.forces, answer.matrix, window, answer.u, contact.nodal,
            contact.res, contact.bristles,
        )  # fmt: skip
        if answer.iterations != -2:
            break
        margin = 2 * margin + arrays.element
    return found


solved, solved_in_step = jit(_solved, needs=(solve_stage,)), part(_solved)


@part
def floor_forces(arrays: Arrays, pos: Any, vel: Any, acc: Any) -> Any:
    """Forces of the floor on all coordinates that go with these accelerations."""
    return inertia(arrays.frame, pos, vel, acc, 1.0)[0]


@loop
def held(arrays: Arrays, pos: Any, vel: Any) -> tuple[float, float, float]:
    """What the coordinates hold by themselves, see :class:`flexible.models.state.Model`."""
    return energies(arrays.frame, pos, vel)


@part
def momentum_error(arrays: Arrays, pos: Any, vel: Any, acc: Any, beta: float, matrix: Any, error: Any) -> float:
    """Size of an ``error`` in the velocities, see :class:`flexible.models.state.Model`."""
    rate = filtered_error(arrays.frame, pos, vel, acc, beta, matrix, error)
    ringing = largest(rate[3:]) / (1 + arrays.frame.body.ring_mass) ** 0.5
    return max(largest(rate[1:3]), abs(rate[0] + rate[2]), ringing)


@part
def lacks(arrays: Arrays, window: Any) -> bool:
    """Whether the compliance of a window's nodes is not known."""
    return not is_known(arrays.rim, window_dofs(arrays.vertex.shape[0], window))


@loop
def energies_of(arrays: Arrays, state: State, held: Energies) -> Energies:
    """Kinetic, gravity and strain energy of a state whose coordinates hold so much of them."""
    strain, shapes = held[2], arrays.rim.shapes
    if state.res.normal > 0:
        for i in range(2 * state.u.shape[0]):
            static, dof = state.u[i // 2, i % 2], (4 * state.window[0] + i) % shapes.shape[0]
            for k in range(shapes.shape[1]):
                static -= shapes[dof, k] * state.pos[3 + k]
            strain += state.nodal[i // 2, i % 2] * static / 2
    return held[0], held[1], strain


class RestingModes(RestingRing):
    """Modes and residual static compliance; ``arrays(window)`` gives modes and compliance on a window."""

    def __init__(self, dynamic: Array, load: Array, arrays: Any) -> None:
        self.arrays = arrays
        self.inverse = np.linalg.inv(dynamic)
        self.load = load
        self.base = self.coordinates = np.zeros(len(load))

    def linearise(self, share: float) -> None:
        self.base = -share * (self.inverse @ self.load)

    def response(self, window: tuple[int, int]) -> tuple[Array, Array]:
        shapes, compliance = self.arrays(window)
        return shapes @ self.base, compliance + shapes @ self.inverse @ shapes.T

    def move(self, window: tuple[int, int], force: Array) -> float:
        self.coordinates = self.base + self.inverse @ (self.arrays(window)[0].T @ force)
        return 0.0


class ReducedHoop(RimContact):
    """Frame, modes and residual static compliance of a scene's hoop."""

    def __init__(self, scene: Scene, modes: int | None = None, points: float | None = None) -> None:
        self.ring: ReducedRing = reduce(scene, modes)
        super().__init__(scene, self.ring.vertex, points, self.ring.within, self.ring.ring.mesh.around)
        self._blocks: dict[tuple[int, int], tuple[Array, Array]] = {}

    @cached_property
    def arrays(self) -> Arrays:
        """What the compiled step takes."""
        return Arrays(
            self.ring.frame, self.ring.rim, self.vertex, self.theta, self.element, self.law.parameters,
        )  # fmt: skip

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
        self.learns(state.window)
        self.learns(window)
        return np.asarray(_moved(self.arrays, state, window))

    def learns(self, window: tuple[int, int] | None) -> bool:
        """See :class:`flexible.models.state.Model`."""
        if window is None or is_known(self.arrays.rim, self.ring.dofs(*window)):
            return False
        self.ring.solve_rim(self.ring.dofs(*window))
        return True

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
        found = solved(self.arrays, old, mode, damper, predictor, near, first)
        if not found.ok and self.learns(found.window):
            return self.stage(old, mode, damper, predictor, near, first)
        return found

    def energies(self, state: State, held: Energies | None = None) -> Energies:
        """Kinetic, gravity, ring strain (of the modes and of the static part)."""
        kinetic, gravity, strain = held or self.held(state.pos, state.vel)
        if state.res.normal > 0:
            moved = self._arrays(state.window)[0] @ state.pos[3:]
            strain += float(state.nodal.ravel() @ (state.u.ravel() - moved)) / 2
        return kinetic, gravity, strain

    def held(self, pos: Array, vel: Array) -> tuple[float, float, float]:
        """See :class:`flexible.models.state.Model`."""
        kinetic, gravity, strain = energies(self.ring.frame, pos, vel)
        return float(kinetic), float(gravity), float(strain)

    def forces(self, pos: Array, vel: Array, acc: Array) -> Array:
        """See :class:`flexible.models.state.Model`."""
        force: Array = floor_forces(self.arrays, pos, vel, acc)
        return force

    def error(self, pos: Array, vel: Array, acc: Array, beta: float, matrix: Array, error: Array) -> float:
        """See :class:`flexible.models.state.Model`."""
        return float(momentum_error(self.arrays, pos, vel, acc, beta, matrix, error))
