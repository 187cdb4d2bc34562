"""Two patches at once, and the seam of the mesh at theta = +-pi, under the contact alone."""

from math import pi, sqrt

import numpy as np
import pytest
from kinematic import VERTEX, Floor, parameters

from flexible.contact.forces import contact_forces
from flexible.contact.laws.patch import SLIDE_RIGHT, STICK
from flexible.contact.points.data import UNDAMPED, Before, Rim, no_bristles
from flexible.contact.points.rim import element_at

EPS = 1e6
WIDTH = 2 * pi / 240  # of an element
LAW = parameters("patch", WIDTH / 40, EPS, 0.8 * EPS, 0.35, 0.3)
PHI = pi  # the bottom is at theta = 0, where two elements meet


def forces(lifted, moved=0.0):
    """The contact on four elements about the bottom; ``lifted`` is by how much each of their nine nodes is raised.

    The rim is straightened first: without ``lifted`` all of it lies 1e-5 deep.
    """
    rim = Rim(element_at(VERTEX, pi - PHI) - 2, VERTEX)
    psi = np.arange(-4, 5) * WIDTH / 2
    raised = -2 * np.sin(psi / 2) ** 2 + np.array(lifted, dtype=float)
    u = np.column_stack([-raised, np.zeros(9)]) + moved  # at phi = pi the disk's first axis points down
    pose = np.array([0.0, -1e-5, PHI])
    return contact_forces(pose, u, rim, LAW, SLIDE_RIGHT, Before(pose, u, no_bristles()), UNDAMPED, True)


LEFT = [4e-5, 2e-5, 0, 2e-5, 4e-5, 4e-5, 4e-5, 4e-5, 4e-5]
RIGHT = LEFT[::-1]
BOTH = np.minimum(LEFT, RIGHT)


def test_two_patches_carry_what_each_of_them_carries():
    left, right, both = (forces(lifted).res for lifted in (LEFT, RIGHT, BOTH))
    assert left.normal > 0
    for name in ("normal", "friction", "length"):
        together = getattr(left, name) + getattr(right, name)
        assert getattr(both, name) == pytest.approx(together, rel=1e-12)
    assert both.friction == pytest.approx(0.3 * both.normal, rel=1e-12)
    assert right.normal == pytest.approx(left.normal, rel=1e-12)  # one is the other's mirror image


def test_the_tangent_of_two_patches():
    """Against central differences, 1e-6 of its largest entry; the patches share the frame and a node, no points."""
    start = 1e-8 * np.random.default_rng(3).standard_normal((9, 2))
    tangent = forces(BOTH, start).tangent[3:, 3:]
    step, columns = 1e-10, []
    for i in range(18):
        change = np.zeros(18)
        change[i] = step
        ends = [forces(BOTH, start + s * change.reshape(9, 2)).nodal.ravel() for s in (1, -1)]
        columns.append((ends[0] - ends[1]) / (2 * step))
    assert np.abs(np.array(columns).T - tangent).max() < 1e-6 * np.abs(tangent).max()


@pytest.mark.parametrize("turn", [0.0, 2 * pi])
@pytest.mark.parametrize("way", [1, -1])
def test_a_sticking_patch_rolls_over_the_seam(turn, way):
    """phi = 0 stands on theta = +-pi, where points and elements are counted on: F = eps_t gamma (2 a)^2/2 all along."""
    depth, creep = 1e-8, 1e-3
    a = sqrt(2 * depth)
    law = parameters("patch", 2 * a / 24, EPS, 0.8 * EPS)
    rim = Floor(law, depth, phi=turn - way * 4 * a, mode=STICK)
    step = 2 * a / 24 / 8 * 1.0001
    found = [rim.move(creep * step, way * step) for _ in range(24 * 8 * 4)]
    settled = np.array([[res.normal, res.friction] for res in found])[len(found) // 3 :]
    assert settled[:, 0] == pytest.approx(4 / 3 * EPS * depth * a, rel=5e-3)  # of 24 points
    assert settled[:, 1] == pytest.approx(-0.8 * EPS * creep * (2 * a) ** 2 / 2, rel=1e-5)
