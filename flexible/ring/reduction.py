"""The ring as the stepper sees it: a few fixed-interface modes, and the rest of its compliance as static.

Craig-Bampton with static correction: ``u = sum q_i Phi_i + S_res f`` on the rim, where ``S_res`` is the static
compliance minus what the modes already hold. A massless ring needs no mode: its static compliance is all of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from .fem import Ring, membrane_stiffness, ring_of
from .frame import Body, Frame

Array = NDArray[np.float64]


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
    vertex : (n_elements,) array
        Angles at which rim elements begin.
    """

    ring: Ring
    stiffness: float
    frame: Frame
    shapes: Array
    rim_shapes: Array
    vertex: Array

    def window(self, first: int, count: int) -> tuple[Array, Array]:
        """Modes and residual compliance of the nodes of rim elements ``first`` to ``first + count - 1``."""
        dofs = self.dofs(first, count)
        block = self.compliance(dofs, dofs)
        return self.rim_shapes[dofs], (block + block.T) / 2

    def compliance(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Array:
        """Residual static compliance: displacement of some rim dofs under unit forces on others."""
        held = (self.rim_shapes[rows] / self.frame.modal[:, 0]) @ self.rim_shapes[columns].T
        return self.ring.rim_block(rows, columns) / self.stiffness - held

    def dofs(self, first: int, count: int) -> NDArray[np.int64]:
        """Rim dofs of a window, counted round and round."""
        nodes = np.arange(2 * first, 2 * (first + count) + 1) % (2 * len(self.vertex))
        return np.column_stack([2 * nodes, 2 * nodes + 1]).ravel()


def body_of(scene: Scene) -> Body:
    """The rigid parts of a scene's hoop."""
    hoop = scene.hoop
    offset = (1 - hoop.k) / hoop.r
    inner = 1 - scene.wall
    mass = float(hoop.mass_ratio)
    return Body(offset, (hoop.k / hoop.r) ** 2 / 2, mass, mass * (1 + inner**2) / 2)


def reduce(scene: Scene, modes: int = 24, ring: Ring | None = None) -> ReducedRing:
    """Reduce the ring of a scene to ``modes`` modes (none if it has no mass) and residual static compliance."""
    ring = ring_of(scene) if ring is None else ring
    stiffness = membrane_stiffness(scene)
    mass = scene.hoop.mass_ratio
    count = modes if mass > 0 else 0
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
    return ReducedRing(
        ring=ring,
        stiffness=stiffness,
        frame=Frame(body_of(scene), np.ascontiguousarray(modal), np.ascontiguousarray(gyro)),
        shapes=shapes,
        rim_shapes=np.ascontiguousarray(shapes[ring.rim_dofs]),
        vertex=np.ascontiguousarray(ring.mesh.rim_theta[::2]),
    )
