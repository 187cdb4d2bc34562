"""A ring under a dead force on its rim: all nodes of the mesh beside the chain that stands for them."""

import numpy as np
from scipy.sparse.linalg import splu

from flexible.chain.ring import dense_stiffness, rim_matrix
from flexible.chain.rod.corotated import elastic
from flexible.ring.exact import ExactElasticity


def pressed(shape, force, loaded, steps=1):
    """Displacement of the rim's nodes under a force on one of them, put on in steps: of all nodes, and of the chain."""
    ring, known = shape.ring, 1e-9 * np.abs(force).max()
    exact, u, dofs = ExactElasticity(ring), np.zeros(len(ring.free)), ring.rim_dofs.reshape(-1, 2)
    for part in np.arange(1, steps + 1) / steps:
        load = np.zeros(len(u))
        load[dofs[loaded]] = part * force
        for _ in range(8):
            if np.abs(exact.forces(u) - load).max() < known:
                break
            u -= splu(exact.tangent(u)).solve(exact.forces(u) - load)
    q = np.zeros((len(shape.rod.theta), 3))
    for part in np.arange(1, steps + 1) / steps:
        for _ in range(60):  # without what the force's own turning adds to the tangent, a hundredth of it
            forces = np.zeros_like(q)
            elastic(shape.rod, q, forces)
            moved, by, _ = rim_matrix(shape.rod, q, shape.nodes)
            short = forces[1:-1].ravel() - part * by[2 * loaded : 2 * loaded + 2].T @ force
            if np.abs(short).max() < known:
                break
            q[1:-1] -= np.linalg.solve(dense_stiffness(shape.rod, q)[3:-3, 3:-3], short).reshape(-1, 3)
    assert max(np.abs(exact.forces(u) - load).max(), np.abs(short).max()) < 1e3 * known
    return u[dofs], moved
