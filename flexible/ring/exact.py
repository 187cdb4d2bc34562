"""The geometrically exact ring: St. Venant-Kirchhoff in plane stress, for rings that bend far.

In the disk's frame, with H = grad u, the strain energy is that of E = (H + H^T + H^T H)/2, which is of the size of
the strain itself: no digit is lost to a rigid motion. What the corners of the weld yield besides is the linear ring's
form of the strains, with these strains in it.

Forces and tangent are batched products over elements and integration points, summed into a fixed sparse pattern.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import Basis, ElementQuad2

from .corners import Corners
from .fem import Ring

Array = NDArray[np.float64]


class _Corner(NamedTuple):
    """What a corner of the weld yields besides."""

    elements: NDArray[np.int64]  # (m,)
    dofs: NDArray[np.int64]  # (n,)
    place: NDArray[np.int64]  # (m, 18) of the elements' dofs among these
    form: Array  # (3 points m, 3 points m) of the strains


class _Pattern(NamedTuple):
    """Where what elements and corners add stands in the tangent."""

    kept: NDArray[np.bool_]  # of all their entries
    entry: NDArray[np.int64]  # of those kept
    rows: NDArray[np.int32]
    starts: NDArray[np.int32]  # of columns


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
        self.corners = [self._corner(ring.corners, which) for which in (0, 1)]

    @cached_property
    def _pattern(self) -> _Pattern:
        count, place = len(self.free), np.full(self.size, -1)
        place[self.free] = np.arange(count)
        blocks = [place[self.dofs], *(place[corner.dofs][None] for corner in self.corners)]
        rows = np.concatenate([np.repeat(dofs, dofs.shape[1], axis=1).ravel() for dofs in blocks])
        columns = np.concatenate([np.tile(dofs, dofs.shape[1]).ravel() for dofs in blocks])
        kept = (rows >= 0) & (columns >= 0)
        entries, entry = np.unique(columns[kept] * count + rows[kept], return_inverse=True)  # ascending: by columns
        starts = np.concatenate([[0], np.cumsum(np.bincount(entries // count, minlength=count))])
        return _Pattern(kept, entry, (entries % count).astype(np.int32), starts.astype(np.int32))

    def _corner(self, corners: Corners, which: int) -> _Corner:
        elements, dofs = corners.elements[which], corners.dofs[which]
        order = np.argsort(dofs)
        place = order[np.searchsorted(dofs, self.dofs[elements], sorter=order)]
        still = np.broadcast_to(np.eye(2), (*self.gradients[elements].shape[:2], 2, 2))
        strains = _gathered(_by_nodes(still, self.gradients[elements]), place, len(dofs))
        return _Corner(elements, dofs, place, corners.by_strain(which, strains))

    def of(self, elements: NDArray[np.int64]) -> ExactElasticity:
        """That of some elements alone, ascending, those at the corners among them."""
        some = copy(self)
        some.__dict__.pop("_pattern", None)
        some.gradients, some.weights, some.dofs = self.gradients[elements], self.weights[elements], self.dofs[elements]
        some.corners = [one._replace(elements=np.searchsorted(elements, one.elements)) for one in self.corners]
        return some

    def _strain(self, u: Array) -> tuple[Array, Array]:
        """F and E = (E11, E22, 2 E12) at the integration points of a displacement of the free dofs."""
        full = np.zeros(self.size)
        full[self.free] = u
        nodal = full[self.dofs].reshape(-1, 1, 9, 2)
        h = nodal.swapaxes(-1, -2) @ self.gradients
        square = h.swapaxes(-1, -2) @ h
        e11 = h[..., 0, 0] + square[..., 0, 0] / 2
        e22 = h[..., 1, 1] + square[..., 1, 1] / 2
        e12 = h[..., 0, 1] + h[..., 1, 0] + square[..., 0, 1]
        return h + np.eye(2), np.stack([e11, e22, e12], axis=-1)

    def _stress(self, strain: Array) -> Array:
        """Derivative of the energy by the strain at the points: the stress (S11, S22, S12) times their areas."""
        stress = strain @ self.stiffness * self.weights[..., None]
        for corner in self.corners:
            here = strain[corner.elements]
            stress[corner.elements] += (corner.form @ here.ravel()).reshape(here.shape)
        return np.asarray(stress)

    def strain_energy(self, u: Array) -> float:
        """Of a displacement (n_free,) of the free dofs, at E b = 1."""
        strain = self._strain(u)[1]
        return float((strain * self._stress(strain)).sum()) / 2

    def forces(self, u: Array) -> Array:
        """Derivative of the energy, (n_free,)."""
        deformation, strain = self._strain(u)
        tensor = self._stress(strain)[..., [[0, 2], [2, 1]]]
        # P = F S; the force on a node is P times the gradient of its shape function
        nodal = (self.gradients @ (deformation @ tensor).swapaxes(-1, -2)).sum(axis=1)
        total = np.asarray(np.bincount(self.dofs.ravel(), nodal.ravel(), self.size), dtype=float)
        return total[self.free]

    def tangent(self, u: Array) -> sp.csc_matrix:
        """Second derivative of the energy, (n_free, n_free)."""
        deformation, strain = self._strain(u)
        elements = len(self.weights)
        g = self.gradients
        b = _by_nodes(deformation, g)
        weighted = (self.weights[..., None, None] * self.stiffness) @ b
        matrix = b.reshape(elements, -1, 18).swapaxes(1, 2) @ weighted.reshape(elements, -1, 18)
        tensor = self._stress(strain)[..., [[0, 2], [2, 1]]]
        initial = (g @ tensor @ g.swapaxes(-1, -2)).sum(axis=1)
        matrix[:, 0::2, 0::2] += initial
        matrix[:, 1::2, 1::2] += initial
        parts = [matrix.ravel()]
        for corner in self.corners:
            strains = _gathered(b[corner.elements], corner.place, len(corner.dofs))
            parts.append((strains.T @ corner.form @ strains).ravel())
        kept, entry, rows, starts = self._pattern
        data = np.bincount(entry, np.concatenate(parts)[kept], len(rows))
        return sp.csc_matrix((data, rows, starts), shape=(len(self.free), len(self.free)))


def _by_nodes(deformation: Array, g: Array) -> Array:
    """Derivative of E by the nodes, (elements, points, 3, 18): F_i1 g_1, F_i2 g_2, F_i1 g_2 + F_i2 g_1."""
    first, second = (deformation[..., None, :, j] for j in (0, 1))
    rows = [g[..., 0:1] * first, g[..., 1:2] * second, g[..., 1:2] * first + g[..., 0:1] * second]
    return np.stack(rows, axis=2).reshape(*g.shape[:2], 3, 18)


def _gathered(by_nodes: Array, place: NDArray[np.int64], count: int) -> Array:
    """The same as one matrix, (3 points elements, count), of dofs that are at some places of each element's."""
    elements, points = by_nodes.shape[:2]
    matrix = np.zeros((elements, 3 * points, count))
    rows = np.arange(3 * points)[None, :, None]
    matrix[np.arange(elements)[:, None, None], rows, place[:, None, :]] = by_nodes.reshape(elements, 3 * points, 18)
    return matrix.reshape(-1, count)


def elasticity_of(ring: Ring) -> ExactElasticity:
    """That of a ring, made once."""
    return ring.once(ExactElasticity)
