"""What half of a ring says of all of it."""

import numpy as np
import pytest

from flexible.ring.choice import ring_of
from flexible.ring.mirror import half_of, mirror_of, mirrored, positive_part
from rigid import Friction, Hoop, Release, Scene, Solve


def rim(elements):
    hoop = Hoop(k=0.1, r=1.2, mass_ratio=0.1)
    return ring_of(Scene(hoop, Friction(0.35, 0.3), Release(1.0), solve=Solve(elements=elements)))


@pytest.mark.parametrize("elements", [60, 61])
def test_images_are_on_the_other_side_of_the_weld(elements):
    """Of an even number of elements a vertex is at -pi, of an odd one the middle of an element: its own image too."""
    theta = rim(elements).mesh.rim_theta
    image, sign = mirror_of(theta)
    points = np.column_stack([np.cos(theta), np.sin(theta)]).ravel()
    assert points[image] == pytest.approx(sign * points, abs=1e-15)
    assert (image[image] == np.arange(len(image))).all()
    half = half_of(mirror_of(theta))
    assert len(half) == len(theta) + 2, "two nodes are their own images"
    assert set(half) | set(image[half]) == set(range(len(image)))


@pytest.mark.parametrize("elements", [60, 61])
def test_half_of_the_compliance_is_all_of_it(elements):
    """Solved for column by column: to rounding errors, which the ring's condition number, some 1e7, makes 1e-9."""
    ring = rim(elements)
    solved = ring.pressed(np.arange(len(ring.rim_dofs)))
    half, rounding = half_of(ring.mirror), 1e-8 * np.abs(solved).max()
    assert np.abs(ring.rim_compliance - solved).max() < rounding
    assert np.abs(mirrored(solved[:, half], half, ring.mirror) - solved).max() < rounding
    some = np.arange(64, 128)  # what the contact has by itself is taken from what is solved for lazily
    own = np.kron(ring.given_within, np.eye(2))[:, some]
    assert ring.within > 0
    assert ring.solve_rim(some)[0][:, some] == pytest.approx(solved[:, some] - own, abs=1e-12 * np.abs(solved).max())


@pytest.mark.parametrize("elements", [12, 13])
def test_the_positive_part_by_halves(elements):
    """Of any matrix that is its own mirror image, as its eigenvalues have it."""
    mirror = mirror_of(rim(24 + elements % 2).mesh.rim_theta)
    count = len(mirror.image)
    some = np.random.default_rng(1).standard_normal((count, count))
    some = some + some.T
    own = (some + mirror.sign[:, None] * some[np.ix_(mirror.image, mirror.image)] * mirror.sign) / 2
    values, vectors = np.linalg.eigh(own)
    assert (values < -1).any()
    assert (values > 1).any()
    stated = (vectors * np.maximum(values, 0)) @ vectors.T
    # a hundred sums of some rounding errors of the largest eigenvalue
    assert np.abs(positive_part(own, mirror) - stated).max() < 1e-13 * np.abs(values).max()
