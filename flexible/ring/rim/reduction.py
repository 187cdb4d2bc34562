"""The ring as the stepper sees it: a few fixed-interface modes, and the rest of its compliance as static.

Craig-Bampton with static correction: ``u = sum q_i Phi_i + S_res f`` on the rim, where ``S_res`` is the static
compliance minus what the modes already hold, and what is left to the contact (``Ring.within``). A massless ring needs
no mode: its static compliance is all of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid import Scene
from rigid.kernel.compile import jit, loop, part

from ..choice import ring_of
from ..fem import COLUMNS, Ring, membrane_stiffness
from ..frame import Frame, body_of
from .even import EvenRim, parts_of

Array = NDArray[np.float64]


class Rim(NamedTuple):
    """What the rim's displacement is made of, in compiled code."""

    shapes: Any  # (2 n_rim, n) modes
    weighted: Any  # (2 n_rim, n) the same over their squared frequencies
    unit: Any  # (2 n_rim, 2 n_rim) static compliance of the ring for E b = 1, columns as far as known: Ring.solve_rim
    known: Any  # bool, of groups of COLUMNS columns
    stiffness: float  # E b


@part
def window_dofs(elements: int, window: tuple[int, int]) -> Any:
    """Dofs of a window of a rim of so many elements, counted round and round."""
    dofs = np.empty(4 * window[1] + 2, np.int64)
    for k in range(dofs.shape[0]):
        dofs[k] = (4 * window[0] + k) % (4 * elements)
    return dofs


@loop
def is_known(rim: Rim, columns: Any) -> bool:
    """Whether the compliance is known in these columns."""
    known = True
    for k in range(columns.shape[0]):
        known = known and rim.known[columns[k] // COLUMNS]
    return bool(known)


@jit
def residual(rim: Rim, rows: Any, columns: Any) -> Any:
    """Static compliance but for what the modes hold of it, in columns that are known."""
    block = np.zeros((rows.shape[0], columns.shape[0]))
    _fill_residual(rim, rows, columns, block, np.empty((rim.shapes.shape[1], columns.shape[0])))
    return block


@loop
def _fill_residual(rim: Rim, rows: Any, columns: Any, block: Any, shapes: Any) -> None:
    """Fill in the block, of zeros, and modes at the columns, in rows of which compiled code takes several at once."""
    for k in range(shapes.shape[0]):
        for j in range(columns.shape[0]):
            shapes[k, j] = rim.shapes[columns[j], k]
    for i in range(rows.shape[0]):
        held, unit, weighted = block[i], rim.unit[rows[i]], rim.weighted[rows[i]]
        for k in range(shapes.shape[0]):
            weight, shape = weighted[k], shapes[k]
            for j in range(columns.shape[0]):
                held[j] += weight * shape[j]
        for j in range(columns.shape[0]):
            held[j] = unit[columns[j]] / rim.stiffness - held[j]


@dataclass(frozen=True, eq=False)
class ReducedRing:
    """Arrays of the reduced ring of a scene, R = m = g = 1.

    Attributes
    ----------
    frame : Frame
        Rigid parts and modes.
    shapes : (n_free, n) array
        Modes on the free dofs: those that are integrated, and therefore those that are drawn.
    rim_shapes : (2 n_rim, n) array
        The same on the rim, two components per node.
    theta : (n_rim,) array
        Angles of the rim's nodes: those of the mesh, or of a rim that is ``even``, which are more.
    even : EvenRim or None
        That rim, where a floor is stiff enough to know the places on an element from each other.
    """

    ring: Ring
    stiffness: float
    frame: Frame
    shapes: Array
    rim_shapes: Array
    theta: Array
    even: EvenRim | None = None

    @cached_property
    def vertex(self) -> Array:
        """Angles at which rim elements begin, (n_elements,)."""
        return np.ascontiguousarray(self.theta[::2])

    @property
    def within(self) -> float:
        """See :class:`flexible.models.rim_contact.RimContact`: the static compliance lacks it."""
        return (self.even or self.ring).within / self.stiffness

    def solve_rim(self, columns: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
        """See :meth:`flexible.ring.fem.Ring.solve_rim`."""
        return (self.even or self.ring).solve_rim(columns)

    def on_mesh(self, window: tuple[int, int], nodal: Array) -> Array:
        """Forces on the mesh's nodes of the rim by those on the contact's in a window, (2 n_rim,)."""
        load = np.zeros(2 * len(self.theta))
        np.add.at(load, self.dofs(*window), nodal.ravel())
        return load if self.even is None else np.asarray(self.even.curve.T @ load)

    @cached_property
    def rim(self) -> Rim:
        """The rim for compiled code; what it knows of the compliance grows."""
        weighted = np.ascontiguousarray(self.rim_shapes / self.frame.modal[:, 0])
        return Rim(self.rim_shapes, weighted, *self.solve_rim(np.empty(0, np.int64)), self.stiffness)

    def window(self, first: int, count: int) -> tuple[Array, Array]:
        """Modes and residual compliance of the nodes of rim elements ``first`` to ``first + count - 1``."""
        dofs = self.dofs(first, count)
        block = self.compliance(dofs, dofs)
        return self.rim_shapes[dofs], (block + block.T) / 2

    def compliance(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Array:
        """Residual static compliance: displacement of some rim dofs under unit forces on others."""
        self.solve_rim(columns)
        block: Array = residual(self.rim, rows, columns)
        return block

    def dofs(self, first: int, count: int) -> NDArray[np.int64]:
        """Rim dofs of a window, counted round and round."""
        dofs: NDArray[np.int64] = window_dofs(len(self.vertex), (first, count))
        return dofs


LEAST_MODES, MODES = 6, 30  # modes at any rtol, and at the rtol
FINE = 1e-5
WALL, WIDER = 0.02, 1 / 6  # wall over R from which on there are more, and like which power of it
ORDER = 10 / 3  # with which what the left-out modes would do falls with their number


def modes_for(rtol: float, wall: float) -> int:
    """Modes by which the ring is as accurate as a tolerance asks for; its wall over R."""
    return max(LEAST_MODES, ceil(MODES * max(1.0, wall / WALL) ** WIDER * (FINE / rtol) ** (1 / ORDER)))


def reduce(scene: Scene, modes: int | None = None) -> ReducedRing:
    """Reduce the ring of a scene to its modes (none if it has no mass) and residual static compliance.

    As many ``modes`` as its tolerance asks for, unless their number is given.
    """
    ring = ring_of(scene)
    stiffness = membrane_stiffness(scene)
    mass = scene.hoop.mass_ratio
    count = 0 if mass == 0 else modes_for(scene.solve.rtol, scene.wall) if modes is None else modes
    if count:
        squares, shapes = ring.modes(count)
        full = np.zeros((ring.basis.N, count))
        full[ring.free] = shapes
        weighted = ring.mass @ full
        root = np.sqrt(mass)
        modal = np.column_stack(
            [
                squares * stiffness / mass,
                root * (weighted.T @ ring.translation(0)),
                root * (weighted.T @ ring.translation(1)),
                root * (weighted.T @ ring.turned(ring.position_field)),
                root * (weighted.T @ ring.position_field),
            ]
        )
        gyro = weighted.T @ ring.turned(full)
        gyro = (gyro - gyro.T) / 2
        shapes = shapes / root
    else:
        modal, gyro, shapes = np.zeros((0, 5)), np.zeros((0, 0)), np.zeros((len(ring.free), 0))
    parts = parts_of(scene, ring.mesh.around)
    # one for each hoop: a compliance that a whole roll has filled takes hundreds of megabytes
    even = EvenRim(ring, parts) if parts else None
    rim_shapes = shapes[ring.rim_dofs]
    return ReducedRing(
        ring=ring,
        stiffness=stiffness,
        frame=Frame(body_of(scene), np.ascontiguousarray(modal), np.ascontiguousarray(gyro)),
        shapes=shapes,
        rim_shapes=np.ascontiguousarray(rim_shapes if even is None else even.curve @ rim_shapes),
        theta=ring.mesh.rim_theta if even is None else even.theta,
        even=even,
    )
