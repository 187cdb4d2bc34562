"""The geometrically exact ring: St. Venant-Kirchhoff in plane stress, for rings that bend far.

In the disk's frame, with H = grad u, the strain energy is that of E = (H + H^T + H^T H)/2, which is of the size of
the strain itself: no digit is lost to a rigid motion. What the corners of the weld yield besides is the linear ring's
form of the strains, with these strains in it.

Strains at all integration points, and forces from stresses, are products with one sparse matrix; the tangent is batched
products over elements, summed into a fixed sparse pattern.
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
    root: Array  # (k, m, 3 points) of what it makes of their strains


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
        # (elements, points, 2 directions, 9 nodes)
        self.gradients = np.stack([np.moveaxis(field[0].grad, 0, -1) for field in basis.basis], axis=3)
        self.weights: Array = basis.dx
        nu = ring.poisson
        plane = 1 / (1 - nu**2)
        #: of (E11, E22, 2 E12)
        self.stiffness = plane * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
        nodes = basis.element_dofs.T
        self.nodes, self.node_dofs = nodes, ring.mesh.node_dofs
        self.dofs = self.node_dofs[nodes].swapaxes(1, 2).reshape(len(nodes), 18)  # all along X_1, then all along X_2
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

    @cached_property
    def _gradient(self) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """Derivatives of what nodes have by X_1, then by X_2, (2 elements points, nodes); and the transpose of it."""
        elements, points = self.weights.shape
        values = np.ascontiguousarray(np.moveaxis(self.gradients, 2, 0)).ravel()
        nodes = np.broadcast_to(self.nodes[:, None, :], (2, elements, points, 9)).ravel()
        shape = 2 * elements * points, len(self.node_dofs)
        matrix = sp.csr_matrix((values, nodes, np.arange(0, 9 * shape[0] + 1, 9)), shape=shape)
        return matrix, matrix.T.tocsr()

    def _corner(self, corners: Corners, which: int) -> _Corner:
        elements, dofs = corners.elements[which], corners.dofs[which]
        order = np.argsort(dofs)
        place = order[np.searchsorted(dofs, self.dofs[elements], sorter=order)]
        still = np.broadcast_to(np.eye(2)[:, None, None], (2, *self.gradients[elements].shape[:2], 2))
        by_nodes = _by_nodes(still, self.gradients[elements]).reshape(len(elements), -1, 18)
        strains = np.zeros((*by_nodes.shape[:2], len(dofs)))
        np.put_along_axis(strains, np.broadcast_to(place[:, None, :], by_nodes.shape), by_nodes, axis=-1)
        root = corners.by_strain(which, strains.reshape(-1, len(dofs)))
        return _Corner(elements, dofs, place, root.reshape(len(root), len(elements), -1))

    def of(self, elements: NDArray[np.int64]) -> ExactElasticity:
        """That of some elements alone, ascending, those at the corners among them."""
        some = copy(self)
        for made in ("_pattern", "_gradient"):
            some.__dict__.pop(made, None)
        some.gradients, some.weights = self.gradients[elements], self.weights[elements]
        some.nodes, some.dofs = self.nodes[elements], self.dofs[elements]
        some.corners = [one._replace(elements=np.searchsorted(elements, one.elements)) for one in self.corners]
        return some

    def _strain(self, u: Array) -> tuple[Array, Array]:
        """Columns of F, (2, elements, points, 2), and E = (E11, E22, 2 E12) of a displacement of the free dofs."""
        full = np.zeros(self.size)
        full[self.free] = u
        first, second = columns = (self._gradient[0] @ full[self.node_dofs]).reshape(2, *self.weights.shape, 2)
        strain = np.empty((*self.weights.shape, 3))
        strain[..., 0] = first[..., 0] + (first[..., 0] ** 2 + first[..., 1] ** 2) / 2
        strain[..., 1] = second[..., 1] + (second[..., 0] ** 2 + second[..., 1] ** 2) / 2
        strain[..., 2] = first[..., 1] + second[..., 0] + (first * second).sum(axis=-1)
        first[..., 0] += 1.0
        second[..., 1] += 1.0
        return columns, strain

    def _stress(self, strain: Array) -> Array:
        """Derivative of the energy by the strain at the points: the stress (S11, S22, S12) times their areas."""
        stress = strain @ self.stiffness * self.weights[..., None]
        for corner in self.corners:
            here, root = strain[corner.elements], corner.root.reshape(len(corner.root), -1)
            stress[corner.elements] -= (root.T @ (root @ here.ravel())).reshape(here.shape)
        return np.asarray(stress)

    def strain_energy(self, u: Array) -> float:
        """Of a displacement (n_free,) of the free dofs, at E b = 1."""
        strain = self._strain(u)[1]
        return float((strain * self._stress(strain)).sum()) / 2

    def forces(self, u: Array) -> Array:
        """Derivative of the energy, (n_free,)."""
        (first, second), strain = self._strain(u)
        s11, s22, s12 = np.moveaxis(self._stress(strain), -1, 0)[..., None]
        # P = F S; the force on a node is P times the gradient of its shape function
        columns = np.stack([first * s11 + second * s12, first * s12 + second * s22])
        total = np.empty(self.size)
        total[self.node_dofs] = self._gradient[1] @ columns.reshape(-1, 2)
        return total[self.free]

    def tangent(self, u: Array) -> sp.csc_matrix:
        """Second derivative of the energy, (n_free, n_free)."""
        deformation, strain = self._strain(u)
        b = _by_nodes(deformation, self.gradients)
        matrix = _squares(b, self.stiffness[:, :, None, None] * self.weights)
        s11, s22, s12 = np.moveaxis(self._stress(strain), -1, 0)
        initial = _squares(self.gradients, np.array([[s11, s12], [s12, s22]]))
        matrix[:, :9, :9] += initial
        matrix[:, 9:, 9:] += initial
        parts = [matrix.ravel()]
        for corner in self.corners:
            root = np.zeros((len(corner.dofs), len(corner.root)))
            by_elements = corner.root.swapaxes(0, 1) @ b[corner.elements].reshape(len(corner.elements), -1, 18)
            for place, by_element in zip(corner.place, by_elements, strict=True):
                root[place] += by_element.T
            parts.append(-(root @ root.T).ravel())
        kept, entry, rows, starts = self._pattern
        data = np.bincount(entry, np.concatenate(parts)[kept], len(rows))
        return sp.csc_matrix((data, rows, starts), shape=(len(self.free), len(self.free)))


def _squares(factor: Array, middle: Array) -> Array:
    """Sum of factor^T middle factor over an element's points, (elements, n, n).

    ``factor`` is (elements, points, k, n), ``middle`` (k, k, elements, points).
    """
    elements, _, count, size = factor.shape
    product = np.zeros_like(factor)
    for i in range(count):
        for j in range(count):
            if np.any(middle[i, j]):
                product[:, :, i] += middle[i, j][..., None] * factor[:, :, j]
    of_points = elements, -1, size
    return np.asarray(factor.reshape(of_points).swapaxes(1, 2) @ product.reshape(of_points))


def _by_nodes(deformation: Array, g: Array) -> Array:
    """Derivative of E by the nodes, (elements, points, 3, 18): F_i1 g_1, F_i2 g_2, F_i1 g_2 + F_i2 g_1."""
    first, second = deformation[..., None]
    g1, g2 = g[:, :, 0, None], g[:, :, 1, None]
    by = np.empty((*g.shape[:2], 3, 2, 9))
    np.multiply(g1, first, out=by[:, :, 0])
    np.multiply(g2, second, out=by[:, :, 1])
    np.multiply(g2, first, out=by[:, :, 2])
    by[:, :, 2] += g1 * second
    return by.reshape(*g.shape[:2], 3, 18)


def elasticity_of(ring: Ring) -> ExactElasticity:
    """That of a ring, made once."""
    return ring.once(ExactElasticity)
