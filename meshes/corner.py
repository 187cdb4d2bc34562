"""The columns of a ring's mesh about an end of its weld, cut finer toward the corner where stress is singular.

The finer elements lie within the mesh's own: what the mesh's shape functions can be, theirs can. Lines run through all
columns and layers, halved again and again toward the corner.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log2, pi

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import MeshQuad2

from .ring import RingMesh, quads, with_middles

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

COLUMNS, MOST_COLUMNS = 2, 8  # of elements to either side of the corner, as far as a wall is thick
HALVED = 6  # times, the shorter side of the element at the corner
CUT = 2  # elements between a line and the next half


@dataclass(frozen=True, eq=False)
class Corner:
    """A mesh within the mesh.

    Attributes
    ----------
    mesh : skfem.MeshQuad2
        The finer one.
    nodes : (n,) array
        Nodes of the ring's mesh in these columns, by layer from inside out and by angle.
    mirrored : (n,) array
        The same at the weld's other end, each at the place that is its mirror image in theta = 0.
    shapes : (n_fine, n) sparse
        Shape functions of the ring's mesh at the finer nodes, numbered as ``mesh``'s dofs.
    same : (n,) array
        Finer nodes that are nodes of the ring's mesh.
    bound : (n_fine,) bool array
        Finer nodes that follow the ring's mesh: at the columns next to these, at the outer rim and at the weld.
    """

    mesh: MeshQuad2
    nodes: Indices
    mirrored: Indices
    shapes: sp.csr_matrix
    same: Indices
    bound: NDArray[np.bool_]


def corner(ring: RingMesh) -> Corner:
    """The finer mesh about the end of the weld at ``theta = weld_half_angle``."""
    theta, weld = ring.rim_theta, ring.weld_half_angle
    at = int(np.argmin(np.abs(theta - weld)))
    welded = int((np.abs(theta[::2]) < weld - 1e-12).sum()) + 1  # elements on the weld
    layers = len(ring.grid) // 2
    radii = ring.radius[ring.grid[::2, 0]]
    wide, high = ring.outer * 2 * pi / ring.around, radii[1] - radii[0]
    reach = min(max(COLUMNS, round((ring.outer - ring.inner) / wide)), MOST_COLUMNS)
    inside, outside = (max(1, min(reach, count // 2)) for count in (welded, ring.around - welded))
    across = _halved(high / min(wide, high))
    beside = _halved(wide / min(wide, high))
    angle = with_middles(np.concatenate([-_on(beside, inside)[:0:-1], _on(beside, outside)]) + inside)
    depth = with_middles(_on(across, layers))

    along, through = _quadratic(angle, inside + outside), _quadratic(depth, layers)
    shapes = sp.kron(through, along, format="csr")
    columns = (at + np.arange(-2 * inside, 2 * outside + 1)) % (2 * ring.around)
    nodes = ring.grid[:, columns]
    opposite = int(np.argmin(np.abs(theta + weld)))
    mirrored = ring.grid[:, (opposite - (columns - at)) % (2 * ring.around)]
    grid = np.arange(shapes.shape[0]).reshape(len(depth), len(angle))
    mesh, number = quads((shapes @ ring.points[nodes.ravel()]).T, grid)

    bound = np.zeros(grid.shape, dtype=bool)
    bound[:, [0, -1]] = bound[-1] = True
    bound[0, angle <= inside] = True
    same = np.ix_(_halves(depth), _halves(angle))
    order = np.empty_like(number)
    order[number] = np.arange(len(number))
    return Corner(
        mesh=mesh,
        nodes=nodes.ravel(),
        mirrored=mirrored.ravel(),
        shapes=shapes[order],
        same=number.reshape(grid.shape)[same].ravel(),
        bound=bound.ravel()[order],
    )


def _halved(longer: float) -> Array:
    """Lines from 0 to 1 that come closer toward 0, to a side so many times as long as the shorter one."""
    ends = 0.5 ** np.arange(HALVED + max(0, ceil(log2(longer) - 1e-9)), -1.0, -1.0)
    ends = np.append(0.0, ends)
    cut = np.arange(CUT) / CUT
    return np.append((ends[:-1, None] + np.diff(ends)[:, None] * cut).ravel(), 1.0)


def _on(first: Array, count: int) -> Array:
    """The same with ``count - 1`` elements more, evenly cut."""
    return np.append(first, 1 + np.arange(1, CUT * (count - 1) + 1) / CUT)


def _halves(lines: Array) -> Indices:
    """Which of them are nodes of the coarse elements, at whole and half numbers."""
    return np.flatnonzero(np.abs(2 * lines - np.round(2 * lines)) < 1e-9)


def _quadratic(at: Array, count: int) -> sp.csr_matrix:
    """Quadratic shape functions of ``count`` elements of length 1 in a row, at some places."""
    element = np.minimum(at.astype(np.int64), count - 1)
    x = at - element
    values = np.stack([(2 * x - 1) * (x - 1), 4 * x * (1 - x), x * (2 * x - 1)], axis=1)
    columns = 2 * element[:, None] + np.arange(3)
    rows = np.broadcast_to(np.arange(len(at))[:, None], columns.shape)
    return sp.csr_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=(len(at), 2 * count + 1))
