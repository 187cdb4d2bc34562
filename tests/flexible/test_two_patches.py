"""Two patches at once, and the seam of the mesh at theta = +-pi, under the contact alone."""

from math import pi, sqrt

import numpy as np
import pytest
from kinematic import VERTEX, Rim

from flexible.contact.detection import element_at
from flexible.contact.forces import (
    FRICTION,
    LENGTH,
    NORMAL,
    SLIDE_RIGHT,
    STICK,
    UNDAMPED,
    contact_forces,
)

EPS = 1e6
WIDTH = 2 * pi / 240  # of an element
LAW = np.array([WIDTH / 40, EPS, 0.8 * EPS, 0.35, 0.3])
PHI = pi  # the bottom is at theta = 0, where two elements meet


def forces(lifted, moved=0.0):
    """The contact on four elements about the bottom; ``lifted`` is by how much each of their nine nodes is raised.

    The rim is straightened first: without ``lifted`` all of it lies 1e-5 deep.
    """
    first = element_at(VERTEX, pi - PHI) - 2
    psi = np.arange(-4, 5) * WIDTH / 2
    raised = -2 * np.sin(psi / 2) ** 2 + np.array(lifted, dtype=float)
    u = np.column_stack([-raised, np.zeros(9)]) + moved  # at phi = pi the disk's first axis points down
    pose = np.array([0.0, -1e-5, PHI])
    return contact_forces(
        pose, u, first, VERTEX, LAW, SLIDE_RIGHT, pose, u, np.empty((0, 3)), np.empty(0, np.int8), UNDAMPED
    )


LEFT = [4e-5, 2e-5, 0, 2e-5, 4e-5, 4e-5, 4e-5, 4e-5, 4e-5]
RIGHT = LEFT[::-1]
BOTH = np.minimum(LEFT, RIGHT)


def test_two_patches_carry_what_each_of_them_carries():
    left, right, both = (forces(lifted)[3] for lifted in (LEFT, RIGHT, BOTH))
    assert left[NORMAL] > 0
    for name in (NORMAL, FRICTION, LENGTH):
        assert both[name] == pytest.approx(left[name] + right[name], rel=1e-12)
    assert both[FRICTION] == pytest.approx(0.3 * both[NORMAL], rel=1e-12)
    assert right[NORMAL] == pytest.approx(left[NORMAL], rel=1e-12)  # one is the other's mirror image


def test_the_tangent_of_two_patches():
    """Against central differences, 1e-6 of its largest entry; the patches share the frame and a node, no points."""
    start = 1e-8 * np.random.default_rng(3).standard_normal((9, 2))
    tangent = forces(BOTH, start)[2][3:, 3:]
    step, columns = 1e-10, []
    for i in range(18):
        change = np.zeros(18)
        change[i] = step
        ends = [forces(BOTH, start + s * change.reshape(9, 2))[1].ravel() for s in (1, -1)]
        columns.append((ends[0] - ends[1]) / (2 * step))
    assert np.abs(np.array(columns).T - tangent).max() < 1e-6 * np.abs(tangent).max()


@pytest.mark.parametrize("turn", [0.0, 2 * pi])
@pytest.mark.parametrize("way", [1, -1])
def test_a_sticking_patch_rolls_over_the_seam(turn, way):
    """phi = 0 stands on theta = +-pi, where points and elements are counted on: F = eps_t gamma (2 a)^2/2 all along."""
    depth, creep = 1e-8, 1e-3
    a = sqrt(2 * depth)
    rim = Rim((2 * a / 24, EPS, 0.8 * EPS, 0.3, 0.3), depth, phi=turn - way * 4 * a, mode=STICK)
    step = 2 * a / 24 / 8 * 1.0001
    found = [rim.move(creep * step, way * step) for _ in range(24 * 8 * 4)]
    settled = np.array([[res[NORMAL], res[FRICTION]] for res in found])[len(found) // 3 :]
    assert settled[:, 0] == pytest.approx(4 / 3 * EPS * depth * a, rel=5e-3)  # of 24 points
    assert settled[:, 1] == pytest.approx(-0.8 * EPS * creep * (2 * a) ** 2 / 2, rel=1e-5)
