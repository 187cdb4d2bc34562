"""The finer mesh about an end of the weld: within the ring's own mesh, and its mirror image at the other end."""

from math import pi

import numpy as np
import pytest
from skfem import Basis, ElementQuad2

from meshes import ring_mesh
from meshes.corner import HALVED, corner

RINGS = {
    "of a twentieth": (0.95, 120, 2, pi / 60),
    "thin, of long quads": (0.995, 240, 1, pi / 60),
    "thick, of tall quads": (0.6, 240, 1, pi / 60),
    "with a weld of two quads": (0.9, 121, 2, 0.01),
    "nearly all weld": (0.9, 16, 1, 3.0),
}


@pytest.fixture(params=RINGS)
def ring(request):
    inner, around, through, weld = RINGS[request.param]
    return ring_mesh(inner, 1.0, around, through, weld)


def test_it_lies_within_the_rings_own(ring):
    """Its nodes are where the ring's shape functions say, its area is that of the columns, nothing is turned over."""
    fine = corner(ring)
    points = fine.shapes @ ring.points[fine.nodes]
    inside = Basis(fine.mesh, ElementQuad2(), intorder=6)
    np.testing.assert_allclose(inside.doflocs.T, points, atol=1e-14)
    columns = np.isin(ring.quad9, fine.nodes).all(axis=1)
    whole = Basis(ring.mesh, ElementQuad2(), intorder=6, elements=np.flatnonzero(columns))
    assert inside.dx.sum() == pytest.approx(whole.dx.sum(), rel=1e-12)
    assert inside.mapping.detDF(inside.X).min() > 0


def test_it_has_the_rings_nodes(ring):
    """Each once and at its place; the other end's are their mirror images."""
    fine = corner(ring)
    assert len(np.unique(fine.same)) == len(fine.nodes) == len(np.unique(fine.nodes))
    np.testing.assert_array_equal(fine.shapes[fine.same].toarray(), np.eye(len(fine.nodes)))
    np.testing.assert_array_equal(ring.points[fine.mirrored], ring.points[fine.nodes] * [1, -1])
    here, there = (np.isin(ring.quad9, nodes).all(axis=1) for nodes in (fine.nodes, fine.mirrored))
    assert not (here & there).any()


def test_what_its_neighbours_see_is_bound(ring):
    """The outer rim, the weld and the columns' two ends: where the ring's shape functions are of nodes there alone."""
    fine = corner(ring)
    layers = len(ring.grid)
    places = np.arange(len(fine.nodes)).reshape(layers, -1)
    weld = places[0, np.isin(fine.nodes.reshape(layers, -1)[0], ring.weld_nodes)]
    on = np.zeros(len(fine.bound), dtype=bool)
    for line in (places[-1], places[:, 0], places[:, -1], weld):
        on |= _sum(fine.shapes) == _sum(fine.shapes[:, line])
    np.testing.assert_array_equal(fine.bound, on)


def _sum(shapes):
    return np.asarray(abs(shapes).sum(axis=1)).ravel()


def test_its_quads_shrink_to_the_corner(ring):
    """By halves: the least is 2^-HALVED of the shorter side of the ring's quad there, cut in two."""
    fine = corner(ring)
    corners = fine.mesh.p[:, fine.mesh.t[:4]]
    sides = np.hypot(*(corners - np.roll(corners, 1, axis=1)))
    layers = len(ring.grid) // 2
    shorter = min((ring.outer - ring.inner) / layers, ring.inner * 2 * pi / ring.around)
    at = np.array([np.cos(ring.weld_half_angle), np.sin(ring.weld_half_angle)]) * ring.inner
    nearest = np.argmin(np.hypot(*(corners.mean(axis=1) - at[:, None])))
    assert sides[:, nearest].max() < 1.5 * 2 * 0.5 ** (HALVED + 1) * shorter
