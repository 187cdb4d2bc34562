"""A ring that nothing holds, for tests against exact solutions."""

import numpy as np
from scipy.sparse.linalg import eigsh, splu
from skfem import ElementQuad2, ElementVector, FacetBasis, LinearForm

from flexible.ring.fem import Ring
from meshes import ring_mesh


def ring(ratio, around, through=1, poisson=0.3):
    """Inner radius 1, outer radius ``ratio``, E b = 1 and unit density (``Ring`` has unit mass)."""
    return Ring(ring_mesh(1.0, ratio, around, through), poisson)


def frequencies(ratio, around, through=1, count=9):
    """The lowest nonzero angular frequencies at E = rho = 1; those of an annulus come in pairs."""
    free = ring(ratio, around, through)
    density = free.mass * free.area
    squares = eigsh(free.stiffness.tocsc(), count, density.tocsc(), sigma=-1e-3, return_eigenvectors=False)
    return np.sqrt(np.sort(squares)[3:])


def solve(free, load):
    """Static displacement under a self-equilibrated load, up to a rigid motion.

    Three dofs are held, as statics allows: both of one node, and the tangential one of the node opposite.
    """
    theta = free.mesh.rim_theta
    here, there = (free.mesh.rim_nodes[np.argmax(np.cos(theta - angle))] for angle in (0.0, np.pi))
    held = [*free.mesh.node_dofs[here], free.mesh.node_dofs[there, 1]]
    kept = np.setdiff1d(np.arange(free.basis.N), held)
    u = np.zeros(free.basis.N)
    options = {"SymmetricMode": True}
    matrix = free.stiffness[kept][:, kept].tocsc()
    u[kept] = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options).solve(load[kept])
    return u


def outer_traction(free, order):
    """Load vector of the outward traction cos(order theta) on the outer rim."""

    @LinearForm
    def traction(v, w):
        radius = np.hypot(*w.x)
        cosine = np.cos(order * np.arctan2(w.x[1], w.x[0]))
        return cosine * (v[0] * w.x[0] + v[1] * w.x[1]) / radius

    element = ElementVector(ElementQuad2())
    return traction.assemble(FacetBasis(free.mesh.mesh, element, facets=free.mesh.outer_facets, intorder=8))


def nodal(free, field):
    """Dofs to nodes, (n_nodes, 2)."""
    return field[free.mesh.node_dofs]


__all__ = ["frequencies", "nodal", "outer_traction", "ring", "solve"]
