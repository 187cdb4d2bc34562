"""Gradients of nodal fields: what strains, stresses and energies are made from.

At the nodes: within an element the gradient is taken at the 2 x 2 Gauss points, where that of a nine-node quad is most
accurate, and carried on to the nodes bilinearly; a node takes the mean over its elements.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from .ring import RingMesh

Array = NDArray[np.float64]

# of the nodes in VTK's order, on the reference square [-1, 1]^2
_NODES = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]], dtype=float)
_GAUSS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / np.sqrt(3)


def nodal_gradient(ring: RingMesh) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Sparse matrices that turn nodal values into their derivatives by y1 and by y2 at the nodes.

    Returns
    -------
    by_y1, by_y2 : (n_nodes, n_nodes) sparse
        ``by_y1 @ f`` for ``f`` (n_nodes,) or (n_nodes, m).
    """
    quad9, count = ring.quad9, len(ring.points)
    at_gauss, _ = _gradients(ring, _GAUSS)
    at_nodes = np.einsum("mg,egni->emni", _extrapolation(), at_gauss)
    share = 1.0 / np.bincount(quad9.ravel(), minlength=count)
    weighted = at_nodes * share[quad9][:, :, None, None]
    rows = np.broadcast_to(quad9[:, :, None], weighted.shape[:3]).ravel()
    columns = np.broadcast_to(quad9[:, None, :], weighted.shape[:3]).ravel()
    by_y1, by_y2 = (sp.csr_matrix((weighted[..., i].ravel(), (rows, columns)), shape=(count, count)) for i in (0, 1))
    return by_y1, by_y2


def gauss_gradient(ring: RingMesh) -> tuple[sp.csr_matrix, sp.csr_matrix, Array]:
    """The same at the 3 x 3 Gauss points of every element, with the area that belongs to each point.

    Nine points integrate the energy of a nine-node quad as the stiffness does.

    Returns
    -------
    by_y1, by_y2 : (9 n_elements, n_nodes) sparse
    area : (n_elements, 9) array
    """
    line, weight = np.polynomial.legendre.leggauss(3)
    at = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    gradients, jacobian = _gradients(ring, at)
    rows = np.repeat(np.arange(gradients[..., 0, 0].size), 9)
    columns = np.broadcast_to(ring.quad9[:, None, :], gradients.shape[:3]).ravel()
    shape = (gradients[..., 0, 0].size, len(ring.points))
    by_y1, by_y2 = (sp.csr_matrix((gradients[..., i].ravel(), (rows, columns)), shape=shape) for i in (0, 1))
    return by_y1, by_y2, np.outer(weight, weight).ravel() * np.abs(np.linalg.det(jacobian))


def _gradients(ring: RingMesh, at: Array) -> tuple[Array, Array]:
    """Gradients (elements, points, 9 nodes, 2) of the shape functions at reference points, and Jacobians."""
    local = _derivatives(at)  # (points, 9 nodes, 2 directions)
    jacobian = np.einsum("eni,gnj->egij", ring.points[ring.quad9], local)
    return np.einsum("gnj,egji->egni", local, np.linalg.inv(jacobian)), jacobian


def _derivatives(at: Array) -> Array:
    """Derivatives of the nine biquadratic shape functions at reference points, (points, 9, 2)."""

    def line(x: Array, node: Array) -> tuple[Array, Array]:
        x, node = x[:, None], node[None, :]
        value = np.where(node == 0, 1 - x**2, x * (x + node) / 2)
        slope = np.where(node == 0, -2 * x, x + node / 2)
        return value, slope

    (first, first_slope), (second, second_slope) = (line(at[:, i], _NODES[:, i]) for i in (0, 1))
    return np.stack([first_slope * second, first * second_slope], axis=-1)


def _extrapolation() -> Array:
    """(9, 4): from values at the Gauss points to the nodes, by the bilinear function through them."""
    signs = np.sign(_GAUSS)
    x = _NODES * np.sqrt(3)
    return (1 + x[:, None, 0] * signs[None, :, 0]) * (1 + x[:, None, 1] * signs[None, :, 1]) / 4
