"""The ring mesh: geometry against the true annulus, named boundaries, symmetry, numbering."""

from math import pi

import numpy as np
import pytest
from skfem import Basis, ElementQuad2, FacetBasis

from meshes import MeshError, ring_mesh

INNER, OUTER, WELD = 1 / 1.02, 1.0, 3 * pi / 180

SHAPES = [(240, 1, WELD, 1.0), (241, 2, WELD, 4.0), (24, 1, WELD, 1.0), (9, 1, 0.01, 1.0), (64, 3, 1.2, 0.5)]


@pytest.mark.parametrize(("around", "through", "weld", "grading"), SHAPES)
def test_counts_angles_and_weld(around, through, weld, grading):
    ring = ring_mesh(INNER, OUTER, around, through, weld, grading)
    assert ring.around == around
    assert ring.quad9.shape == (around * through, 9)
    assert len(ring.points) == 2 * around * (2 * through + 1)
    assert len(ring.rim_nodes) == len(ring.inner_nodes) == 2 * around
    assert (np.diff(ring.rim_theta) > 0).all()
    vertices = ring.rim_theta[::2]
    assert weld in vertices  # exactly, not nearly
    assert -weld in vertices
    np.testing.assert_array_equal(ring.weld_nodes, ring.inner_nodes[np.abs(ring.rim_theta) <= weld])
    assert len(ring.weld_nodes) == 2 * len(ring.weld_facets) + 1
    ends = ring.points[ring.weld_nodes[[0, -1]]]
    np.testing.assert_allclose(np.arctan2(ends[:, 1], ends[:, 0]), [-weld, weld], rtol=1e-14)


@pytest.mark.parametrize(("around", "through", "weld", "grading"), SHAPES)
def test_every_node_is_where_its_polar_coordinates_say(around, through, weld, grading):
    ring = ring_mesh(INNER, OUTER, around, through, weld, grading)
    expected = ring.radius[:, None] * np.column_stack([np.cos(ring.theta), np.sin(ring.theta)])
    np.testing.assert_allclose(ring.points, expected, atol=4e-16)  # sin(pi) alone is 1.2e-16
    assert (ring.radius[ring.rim_nodes] == OUTER).all()
    assert (ring.radius[ring.inner_nodes] == INNER).all()
    np.testing.assert_array_equal(ring.theta[ring.rim_nodes], ring.rim_theta)
    np.testing.assert_array_equal(ring.points, ring.mesh.p.T)


@pytest.mark.parametrize("around", [240, 241])
def test_mirror_symmetry_is_exact(around):
    ring = ring_mesh(INNER, OUTER, around, 2, WELD, 3.0)
    mirrored = ring.points * [1, -1]
    order = np.lexsort((ring.points + 0.0).T)  # + 0.0 turns -0 into 0
    np.testing.assert_array_equal(ring.points[order], mirrored[np.lexsort((mirrored + 0.0).T)])


def test_node_dofs_are_those_of_the_vector_basis():
    ring = ring_mesh(INNER, OUTER, 60, 2)
    basis = ring.vector_basis(intorder=4)
    for component in (0, 1):
        np.testing.assert_array_equal(basis.doflocs[:, ring.node_dofs[:, component]].T, ring.points)
    own = np.hstack([basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs]).T
    np.testing.assert_array_equal(own, ring.node_dofs)


@pytest.mark.parametrize("halved", [0, 1, 4])
def test_layers_halved_toward_the_rim(halved):
    """The outermost of two even ones, whose last parts are alike; what is meshed is the same annulus."""
    ring = ring_mesh(0.8, 1.0, 48, 2, WELD, halved=halved)
    thickness = np.diff(ring.radius[ring.grid[::2, 0]])
    expected = [0.1, *(0.1 * 0.5 ** np.arange(1, halved + 1)), 0.1 * 0.5**halved]
    np.testing.assert_allclose(thickness, expected, rtol=1e-13)
    layers = 2 + halved
    assert ring.quad9.shape == (48 * layers, 9)
    corners = ring.radius[ring.grid[::2, 0]]
    np.testing.assert_allclose(ring.radius[ring.grid[1::2, 0]], (corners[1:] + corners[:-1]) / 2, rtol=1e-15)
    even = ring_mesh(0.8, 1.0, 48, 2, WELD)
    assert ring.quality().area_error == pytest.approx(even.quality().area_error, rel=1e-6)
    for facets, radius in ((ring.outer_facets, 1.0), (ring.inner_facets, 0.8)):
        ends = ring.mesh.p[:, ring.mesh.facets[:, facets]]
        np.testing.assert_allclose(np.hypot(*ends), radius, rtol=1e-15)


def test_quad9_is_vtk_order():
    ring = ring_mesh(INNER, OUTER, 60)
    r, a = ring.radius[ring.quad9], ring.theta[ring.quad9][:-1]  # the last element crosses theta = pi
    middle = (INNER + OUTER) / 2
    assert (r == np.array([INNER, OUTER, OUTER, INNER, middle, OUTER, middle, INNER, middle])).all()
    start, stop = a[:, :1], a[:, 2:3]
    np.testing.assert_array_equal(a[:, [0, 1, 4]], np.repeat(start, 3, axis=1))
    np.testing.assert_array_equal(a[:, [2, 3, 6]], np.repeat(stop, 3, axis=1))
    np.testing.assert_array_equal(a[:, [5, 7, 8]], np.repeat((start + stop) / 2, 3, axis=1))


def test_named_boundaries_have_the_right_lengths():
    ring = ring_mesh(INNER, OUTER, 240, 1, WELD, 2.0)
    length = {
        name: FacetBasis(ring.mesh, ElementQuad2(), facets=name, intorder=12).dx.sum()
        for name in ("outer", "inner", "weld")
    }
    # isoparametric arcs of 1.5 degrees are off by h^4/1000 or so: 1e-9
    assert length["outer"] == pytest.approx(2 * pi * OUTER, rel=1e-8)
    assert length["inner"] == pytest.approx(2 * pi * INNER, rel=1e-8)
    assert length["weld"] == pytest.approx(2 * WELD * INNER, rel=1e-8)
    np.testing.assert_array_equal(ring.mesh.boundaries["outer"], ring.outer_facets)
    np.testing.assert_array_equal(ring.mesh.boundaries["weld"], ring.weld_facets)


def test_area_and_length_converge_with_the_fourth_order():
    """Mid-nodes on the circle make a quadratic arc, whose area and length are both off by O(h^4)."""
    counts = np.array([12, 24, 48, 96])
    quality = [ring_mesh(0.8, 1.0, int(n), 1, pi / 6).quality() for n in counts]
    area = np.polyfit(np.log(counts), np.log([abs(q.area_error) for q in quality]), 1)[0]
    length = np.polyfit(np.log(counts), np.log([abs(q.outer_length_error) for q in quality]), 1)[0]
    assert area == pytest.approx(-4, abs=0.05)
    assert length == pytest.approx(-4, abs=0.05)


def test_quality_of_the_default_ring():
    quality = ring_mesh(INNER, OUTER).quality()
    assert abs(quality.area_error) < 1e-8
    assert abs(quality.outer_length_error) < 1e-8
    assert quality.jacobian_ratio > INNER / OUTER - 1e-3  # the polar map's own ratio over the wall
    assert quality.aspect < 1.4  # 1.5 degrees of rim against a wall of 0.0196


@pytest.mark.parametrize(("inner", "around"), [(0.5, 240), (0.98, 24)])
def test_aspect_is_that_of_the_mid_lines_whichever_is_the_longer(inner, around):
    """A chord 2 r_m sin(pi/n) against the wall, all elements alike: radially long ones, and long ones around."""
    along, wall = (inner + OUTER) * np.sin(pi / around), OUTER - inner
    quality = ring_mesh(inner, OUTER, around, 1, 6 * pi / around).quality()
    assert quality.aspect == pytest.approx(max(along, wall) / min(along, wall), rel=1e-12)
    assert quality.aspect > 4


def test_the_jacobian_is_told_of_the_worst_element():
    """det J goes with rho: over the thick layer, 0.8 to 0.9, it falls to 8/9, over the next to 18/19 only."""
    quality = ring_mesh(0.8, 1.0, 240, 1, halved=3).quality()
    assert 8 / 9 < quality.jacobian_ratio < 18 / 19


def test_grading_makes_the_elements_at_the_weld_smaller():
    size = {g: ring_mesh(INNER, OUTER, 240, 1, WELD, g).quality() for g in (1.0, 4.0)}
    assert size[1.0].largest_angle / size[1.0].smallest_angle < 1.01
    assert size[4.0].largest_angle / size[4.0].smallest_angle == pytest.approx(4, rel=0.1)


def test_a_users_own_density():
    ring = ring_mesh(INNER, OUTER, 120, 1, WELD, lambda angle: 1 / (0.02 + angle))
    angles = np.diff(ring.rim_theta[::2])
    assert angles.argmin() in (59, 60)  # beside theta = 0
    assert angles[-1] > 20 * angles.min()


@pytest.mark.parametrize(
    "bad",
    [
        {"inner": 1.0, "outer": 1.0},
        {"inner": 0.0, "outer": 1.0},
        {"inner": 0.9, "outer": float("nan")},
        {"inner": 0.9, "outer": 1.0, "around": 4},
        {"inner": 0.9, "outer": 1.0, "around": float("nan")},
        {"inner": 0.9, "outer": 1.0, "around": 24.5},
        {"inner": 0.9, "outer": 1.0, "through": 0},
        {"inner": 0.9, "outer": 1.0, "weld_half_angle": 0.0},
        {"inner": 0.9, "outer": 1.0, "grading": -1.0},
        {"inner": 0.9, "outer": 1.0, "halved": -1},
        {"inner": 0.9, "outer": 1.0, "halved": 41},
        {"inner": 0.9, "outer": 1.0, "grading": lambda a: a - 1},
    ],
)
def test_a_ring_that_cannot_be(bad):
    with pytest.raises(MeshError):
        ring_mesh(**bad)


def test_linear_fields_are_reproduced_on_the_curved_mesh():
    """A linear field lies in the isoparametric space, so its gradient is constant to round-off."""
    ring = ring_mesh(INNER, OUTER, 40, 1, WELD, 2.0)
    basis = Basis(ring.mesh, ElementQuad2(), intorder=4)
    gradient = basis.interpolate(2 * ring.points[:, 0] - 3 * ring.points[:, 1]).grad
    np.testing.assert_allclose(gradient[0], 2, rtol=1e-11)  # round-off over the wall of 0.02
    np.testing.assert_allclose(gradient[1], -3, rtol=1e-11)
