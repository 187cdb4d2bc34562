"""The inside of the ring at instants of the march: displacement, velocity, stress and strain energy.

The march knows the ring by its modes and its rim. Here the same displacement is found at every node,

    u = sum q_i Phi_i + (K^-1 - sum Phi_i Phi_i^T / lambda_i) f,

with f the contact's forces on the rim: on the rim it is what the contact saw, to round-off. Many instants are done
at once. Everything is in the disk's frame and in the solver's units, R = m = g = 1; stresses and energy densities
are those of a ring of width R, for the width is no part of a scene.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from meshes.gradient import gauss_gradient, nodal_gradient

from .march import State
from .reduced import ReducedHoop

Array = NDArray[np.float64]


class Interior:
    """Fields of a hoop's ring at its nodes.

    Parameters
    ----------
    hoop : ReducedHoop
        The model that marched.
    """

    def __init__(self, hoop: ReducedHoop) -> None:
        self.hoop = hoop
        self.ring = hoop.ring.ring
        self.mesh = self.ring.mesh
        #: E b, which is also E for a ring of width R
        self.young = hoop.ring.stiffness
        self.poisson = self.ring.poisson

    @cached_property
    def _modes(self) -> tuple[Array, Array]:
        """lambda_i/(E b) and Phi_i on the free dofs, orthonormal in the unit mass."""
        rim = self.hoop.ring.rim_shapes
        squares, shapes = self.ring.modes(rim.shape[1])
        # the eigensolver may have run again since, for more modes, and returned some with the other sign
        same = np.einsum("ij,ij->j", shapes[self.ring.rim_dofs], rim)
        return squares, shapes * np.where(same < 0, -1.0, 1.0)

    def displacement(self, states: Sequence[State]) -> Array:
        """Displacement of the nodes, (n_nodes, 2, n_states)."""
        static = self._static(states)
        count = self.hoop.ring.rim_shapes.shape[1]
        if count:
            amplitudes = np.stack([state.pos[3:] for state in states], axis=1)
            static += self._modes[1] @ amplitudes / np.sqrt(self.hoop.scene.hoop.mass_ratio)
        return self._expanded(static)

    def rate(self, states: Sequence[State], before: Sequence[State], after: Sequence[State]) -> Array:
        """Rate of the displacement seen in the disk's frame, (n_nodes, 2, n_states).

        That of the modes is the march's own; the static part has none there, and takes the difference from the
        state ``before`` to the one ``after``.
        """
        elapsed = np.array([b.t - a.t for a, b in zip(before, after, strict=True)])
        change = self._static(after) - self._static(before)
        rate = np.divide(change, elapsed, out=np.zeros_like(change), where=elapsed > 0)
        if self.hoop.ring.rim_shapes.shape[1]:
            rates = np.stack([state.vel[3:] for state in states], axis=1)
            rate += self._modes[1] @ rates / np.sqrt(self.hoop.scene.hoop.mass_ratio)
        return self._expanded(rate)

    def _static(self, states: Sequence[State]) -> Array:
        """The static part on the free dofs, (n_free, n_states)."""
        load = np.zeros((len(self.ring.free), len(states)))
        for column, state in zip(load.T, states, strict=True):
            if len(state.nodal):
                np.add.at(column, self.ring.rim_dofs[self.hoop.ring.dofs(*state.window)], state.nodal.ravel())
        moved = self.ring.solve(load)
        if self.hoop.ring.rim_shapes.shape[1]:
            squares, shapes = self._modes
            moved -= shapes @ ((shapes.T @ load) / squares[:, None])
        return moved / self.young

    def _expanded(self, free: Array) -> Array:
        full = np.zeros((self.ring.basis.N, free.shape[1]))
        full[self.ring.free] = free
        return full[self.mesh.node_dofs]

    @cached_property
    def _at_nodes(self) -> tuple[Array, Array]:
        return nodal_gradient(self.mesh)

    @cached_property
    def _at_gauss(self) -> tuple[Array, Array, Array]:
        return gauss_gradient(self.mesh)

    def strain(self, u: Array) -> Array:
        """(11, 22, 2 x 12) at the nodes, (n_nodes, 3, n_states), of displacements as above."""
        return _strain(*self._at_nodes, u)

    def stress(self, strain: Array) -> Array:
        """Plane stress (11, 22, 12) of a strain, in m g/R^2."""
        plane = self.young / (1 - self.poisson**2)
        shear = self.young / (2 * (1 + self.poisson))
        first, second, slide = strain[:, 0], strain[:, 1], strain[:, 2]
        return np.stack(
            [plane * (first + self.poisson * second), plane * (second + self.poisson * first), shear * slide],
            axis=1,
        )

    def element_energy(self, u: Array) -> Array:
        """Strain energy of every element, (n_elements, n_states); the sum is the ledger's ring strain."""
        by_y1, by_y2, area = self._at_gauss
        strain = _strain(by_y1, by_y2, u)
        density = (strain * self.stress(strain)).sum(axis=1) / 2
        return (density.reshape(*area.shape, -1) * area[:, :, None]).sum(axis=1)


def _strain(by_y1: Array, by_y2: Array, u: Array) -> Array:
    flat = u.reshape(len(u), -1)
    d1, d2 = ((by @ flat).reshape(-1, *u.shape[1:]) for by in (by_y1, by_y2))
    return np.stack([d1[:, 0], d2[:, 1], d2[:, 0] + d1[:, 1]], axis=1)
