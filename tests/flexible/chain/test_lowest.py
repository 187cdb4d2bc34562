"""Where the rim of a chain is lowest: what is left out by its sections is nowhere near the floor."""

from math import pi

import numpy as np
import pytest

from flexible.chain.lowest import lowest
from flexible.chain.rim import follow
from flexible.chain.ring import _Shape
from flexible.ring.fem import Ring
from meshes import ring_mesh


@pytest.fixture(scope="module", params=[1.02, 1.18])
def shape(request):
    """Of a thin wall and a thick one, whose rim is far from the centres of its sections."""
    return _Shape(Ring(ring_mesh(1 / request.param, 1.0, 120, 1), 0.3), 60)


def bulging(shape, size, seed):
    """Sections on a ring bent to and fro by ``size``, its walls turning with it."""
    rng = np.random.default_rng(seed)
    theta, q = shape.rod.theta, np.zeros_like(shape.still)
    for n in range(2, 6):
        a = size * rng.standard_normal() / n**2
        out, along, turn = a * np.cos(n * theta), -a * np.sin(n * theta) / n, a * (n - 1 / n) * np.sin(n * theta)
        q[:, 0] += out * np.cos(theta) - along * np.sin(theta)
        q[:, 1] += out * np.sin(theta) + along * np.cos(theta)
        q[:, 2] += turn
    q[[0, -1]] = 0.0
    return q


@pytest.mark.parametrize("size", [0.0, 1e-3, 0.1, 0.6])
@pytest.mark.parametrize("seed", range(4))
def test_it_is_that_of_all_nodes(shape, size, seed):
    """Every node of the rim looked at, from every side, above the floor and pressed into it."""
    q, theta = bulging(shape, size, seed), shape.ring.mesh.rim_theta
    u = follow(shape.rod, q, shape.nodes)[0]
    for phi in np.linspace(0.1, 6.0, 7) + seed:
        psi = (phi - pi + theta + pi) % (2 * pi) - pi
        gap = 2 * np.sin((phi - pi + theta) / 2) ** 2 + u[:, 0] * np.cos(phi) - u[:, 1] * np.sin(phi)
        for depth in (-0.01, 1e-7, 1e-3, 0.02):
            below = psi[gap - gap.min() - depth <= 0]
            found = lowest(shape.rod, q, shape.nodes, theta, phi, -gap.min() - depth)
            wanted = (below.min(), below.max()) if depth > 0 else (psi[gap.argmin()],) * 2
            assert found == pytest.approx(wanted, abs=1e-9)
