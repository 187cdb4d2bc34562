"""The geometrically exact ring: St. Venant-Kirchhoff in plane stress, for rings that bend far.

In the disk's frame, with H = grad u, the strain energy is that of E = (H + H^T + H^T H)/2, which is of the size of
the strain itself: no digit is lost to a rigid motion. Inertia and contact are exact at every level already, so that
this ring differs from the linear one by its elastic forces alone.

Forces and tangent are batched products over elements and integration points, summed into a fixed sparse pattern.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import Basis, ElementQuad2

from rigid import Scene

from ..ring.fem import Ring
from ..ring.nodal import NodalRing
from .full import FullHoop

Array = NDArray[np.float64]


class ExactElasticity:
    """Elastic energy, forces and tangent of a ring at E b = 1, in unit outer radius, on all dofs or the free ones.

    Parameters
    ----------
    ring : Ring
    """

    def __init__(self, ring: Ring) -> None:
        basis = Basis(ring.mesh.mesh, ElementQuad2(), intorder=4)
        # (elements, points, 9 nodes, 2 directions)
        self.gradients = np.stack([np.moveaxis(field[0].grad, 0, -1) for field in basis.basis], axis=2)
        self.weights: Array = basis.dx
        nu = ring.poisson
        plane = 1 / (1 - nu**2)
        #: of (E11, E22, 2 E12)
        self.stiffness = plane * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
        nodes = basis.element_dofs.T
        self.dofs = ring.mesh.node_dofs[nodes].reshape(len(nodes), 18)
        self.free, self.size = ring.free, ring.basis.N
        place = np.full(self.size, -1)
        place[ring.free] = np.arange(len(ring.free))
        self._element_free = place[self.dofs]
        rows = np.broadcast_to(self._element_free[:, :, None], (len(nodes), 18, 18)).ravel()
        columns = np.broadcast_to(self._element_free[:, None, :], (len(nodes), 18, 18)).ravel()
        self._kept = (rows >= 0) & (columns >= 0)
        code = columns[self._kept] * len(ring.free) + rows[self._kept]  # ascending: by columns
        entries, self._entry = np.unique(code, return_inverse=True)
        self._rows = (entries % len(ring.free)).astype(np.int32)
        counts = np.bincount(entries // len(ring.free), minlength=len(ring.free))
        self._starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)

    def _strain(self, u: Array) -> tuple[Array, Array]:
        """F and E = (E11, E22, 2 E12) at the integration points of a displacement of the free dofs."""
        full = np.zeros(self.size)
        full[self.free] = u
        nodal = full[self.dofs].reshape(-1, 1, 9, 2)
        h = nodal.swapaxes(-1, -2) @ self.gradients  # H_ij = du_i/dy_j
        square = h.swapaxes(-1, -2) @ h
        e11 = h[..., 0, 0] + square[..., 0, 0] / 2
        e22 = h[..., 1, 1] + square[..., 1, 1] / 2
        e12 = h[..., 0, 1] + h[..., 1, 0] + square[..., 0, 1]
        return h + np.eye(2), np.stack([e11, e22, e12], axis=-1)

    def strain_energy(self, u: Array) -> float:
        strain = self._strain(u)[1]
        return float(((strain @ self.stiffness * strain).sum(-1) * self.weights).sum()) / 2

    def forces(self, u: Array) -> Array:
        """Derivative of the energy, (n_free,)."""
        deformation, strain = self._strain(u)
        stress = strain @ self.stiffness * self.weights[..., None]
        tensor = stress[..., [[0, 2], [2, 1]]]
        # P = F S; the force on a node is P times the gradient of its shape function
        nodal = (self.gradients @ (deformation @ tensor).swapaxes(-1, -2)).sum(axis=1)
        total = np.asarray(np.bincount(self.dofs.ravel(), nodal.ravel(), self.size), dtype=float)
        return total[self.free]

    def tangent(self, u: Array) -> sp.csc_matrix:
        """Second derivative of the energy, (n_free, n_free)."""
        deformation, strain = self._strain(u)
        elements, points = self.weights.shape
        g = self.gradients
        # derivative of E by the nodes: F_i1 g_1, F_i2 g_2, F_i1 g_2 + F_i2 g_1
        first, second = (deformation[..., None, :, j] for j in (0, 1))
        rows = [g[..., 0:1] * first, g[..., 1:2] * second, g[..., 1:2] * first + g[..., 0:1] * second]
        b = np.stack(rows, axis=2).reshape(elements, points, 3, 18)
        weighted = (self.weights[..., None, None] * self.stiffness) @ b
        matrix = b.reshape(elements, -1, 18).swapaxes(1, 2) @ weighted.reshape(elements, -1, 18)
        stress = strain @ self.stiffness * self.weights[..., None]
        tensor = stress[..., [[0, 2], [2, 1]]]
        initial = (g @ tensor @ g.swapaxes(-1, -2)).sum(axis=1)
        matrix[:, 0::2, 0::2] += initial
        matrix[:, 1::2, 1::2] += initial
        data = np.bincount(self._entry, matrix.ravel()[self._kept], len(self._rows))
        return sp.csc_matrix((data, self._rows, self._starts), shape=(len(self.free), len(self.free)))


@lru_cache(maxsize=4)
def _elasticity(ring: Ring) -> ExactElasticity:
    return ExactElasticity(ring)


class ExactRing(NodalRing):
    """Inertia of the free nodes, and their geometrically exact elasticity."""

    def __init__(self, scene: Scene, ring: Ring) -> None:
        super().__init__(scene, ring)
        self.exact = _elasticity(ring)

    def elastic(self, u: Array) -> Array:
        """Elastic forces of a displacement of the free dofs."""
        return self.stiffness * self.exact.forces(u)

    def tangent(self, u: Array) -> sp.csc_matrix:
        """Derivative of ``elastic``."""
        return self.stiffness * self.exact.tangent(u)

    def strain_energy(self, u: Array) -> float:
        """Of the displacement of the free dofs, in m g R."""
        return self.stiffness * self.exact.strain_energy(u)


class ExactHoop(FullHoop):
    """Frame and geometrically exact ring of a scene; everything else as at the level of all nodes."""

    linear = False

    def _make_ring(self, scene: Scene, ring: Ring) -> NodalRing:
        return ExactRing(scene, ring)
