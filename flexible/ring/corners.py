"""What the wall yields besides at the corners of the weld, where its stress is singular.

The strain energy that quads of size h miss at a corner falls but like h, and it is the mesh's largest error by far. So
the columns of quads to either side of a corner, two of them and up to eight where the wall is thick, are cut finer and
finer toward it (:mod:`meshes.corner`), and the finer nodes are condensed: their equilibrium under what the mesh's own
nodes do. Mesh, rim and inertia stay as they are, and so does the price of a step.

What that changes is a quadratic form of the nodes' displacements, and since no rigid motion feels it, one of the
strains at the quads' Gauss points. So it is taken where a ring turns far, with Green's strains.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector

from meshes import RingMesh
from meshes.corner import Corner, corner

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Corners:
    """Both corners of a ring at E b = 1.

    Attributes
    ----------
    elements : (2, m) array
        Quads of the ring's mesh about either.
    dofs : (2, n) array
        Degrees of freedom of their nodes.
    blocks : (2, n, n) array
        What the corners change in the stiffness: negative semidefinite.
    """

    elements: NDArray[np.int64]
    dofs: NDArray[np.int64]
    blocks: Array

    def stiffness(self, size: int) -> sp.csr_matrix:
        """The same of all degrees of freedom, (size, size)."""
        rows = np.broadcast_to(self.dofs[:, :, None], self.blocks.shape)
        columns = np.broadcast_to(self.dofs[:, None, :], self.blocks.shape)
        return sp.csr_matrix((self.blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))

    def by_strain(self, which: int, strains: Array) -> Array:
        """A root of what ``blocks[which]`` makes of some strains: minus the sum of squares of ``root @ strain``.

        Parameters
        ----------
        which : int
        strains : (k, n) array
            What these are of small displacements of ``dofs[which]``; zero of none but rigid motions.

        Returns
        -------
        (m, k) array
            m is n less what of rigid motions and round-off.
        """
        values, vectors = np.linalg.eigh(self.blocks[which])
        yields = values < -1e-14 * np.abs(values).max()
        roots = np.sqrt(-values[yields])[:, None] * vectors[:, yields].T
        return np.asarray(roots @ np.linalg.pinv(strains, rcond=1e-10))


def corners(ring: RingMesh, stiffness: BilinearForm) -> Corners:
    """Those of a ring whose quads are assembled by ``stiffness``."""
    found = corner(ring)
    block = _condensed(found, stiffness)
    mirror = np.tile([1.0, -1.0], len(found.nodes))
    nodes = np.stack([found.nodes, found.mirrored])
    within = [np.isin(ring.quad9, some).all(axis=1) for some in nodes]
    return Corners(
        elements=np.stack([np.flatnonzero(these) for these in within]),
        dofs=ring.node_dofs[nodes].reshape(2, -1),
        blocks=np.stack([block, block * np.outer(mirror, mirror)]),
    )


def _condensed(fine: Corner, stiffness: BilinearForm) -> Array:
    """Stiffness of the finer elements, as nodes of the ring's mesh feel it, less that of the ring's own, (2 n, 2 n)."""
    matrix = stiffness.assemble(Basis(fine.mesh, ElementVector(ElementQuad2()), intorder=4)).tocsr()
    shapes = sp.kron(fine.shapes, sp.eye(2), format="csr")
    own = np.zeros(len(fine.bound), dtype=bool)
    own[fine.same] = True
    followed = shapes.multiply(np.repeat(own | fine.bound, 2)[:, None]).tocsr()  # others' places are found
    free = np.flatnonzero(np.repeat(~(own | fine.bound), 2))
    pushed = matrix @ followed
    within = matrix[free][:, free].tocsc()
    found = _schur_complement(within, pushed[free].tocsc(), followed.T @ pushed) - shapes.T @ (matrix @ shapes)
    return np.asarray((found + found.T) / 2)


def _schur_complement(within: sp.csc_matrix, beside: sp.csc_matrix, kept: sp.csc_matrix) -> Array:
    """``kept - beside.T inverse(within) beside``: what elimination leaves of ``kept`` when all of ``within`` is gone.

    A column of ``beside`` at a time, solved for and multiplied, takes four times as long where the wall is thick.
    """
    options = {"SymmetricMode": True}
    late = splu(within, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options).perm_c
    order, n = np.argsort(late), len(late)
    one = sp.identity(kept.shape[0])  # what is left is singular without: no rigid motion feels it
    whole = sp.bmat([[within[order][:, order], beside[order]], [beside[order].T, kept + one]], format="csc")
    factor = splu(whole, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options)
    return np.asarray(factor.L[n:, n:].toarray() @ factor.U[n:, n:].toarray() - one.toarray())
