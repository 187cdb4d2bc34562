"""Nodal gradients: exact for linear fields, second order, right for bending through one element."""

import numpy as np
import pytest

from meshes import gauss_gradient, nodal_gradient, ring_mesh


def test_gradients_of_linear_fields_are_exact():
    """On curved elements too: isoparametric quads contain the linear fields."""
    ring = ring_mesh(0.98, 1.0, 60, 2, 0.1, 3.0)
    for derivative, expected in zip(nodal_gradient(ring), (2.0, -3.0), strict=True):
        field = 2 * ring.points[:, 0] - 3 * ring.points[:, 1]
        np.testing.assert_allclose(derivative @ field, expected, rtol=1e-10)  # round-off over the wall
        np.testing.assert_allclose(derivative @ np.ones(len(field)), 0, atol=1e-10)


@pytest.mark.parametrize("through", [1, 2])
def test_order_around_the_ring(through):
    """The field x^2 y + sin 3x, refined around and through alike: bilinear extrapolation is second order."""
    counts = np.array([24, 48, 96])
    errors = []
    for count in counts:
        ring = ring_mesh(0.7, 1.0, int(count), through * int(count) // 24, 0.3)
        x, y = ring.points.T
        field = x**2 * y + np.sin(3 * x)
        by_y1, by_y2 = nodal_gradient(ring)
        off = np.hypot(by_y1 @ field - (2 * x * y + 3 * np.cos(3 * x)), by_y2 @ field - x**2)
        errors.append(np.sqrt((off**2).mean()))
    order = np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order == pytest.approx(-2, abs=0.05)


def test_bending_strain_through_one_element():
    """Inextensional bending of a thin ring in its n = 2 mode, u_r = cos 2t.

    With u_t = v - z (u_r' - v)/a and v = -sin(2t)/2 the hoop strain on the mid-line is 0 and at the distance
    z from it -z (u_r'' + u_r)/(a (a + z)) = 3 z cos(2t)/(a (a + z)).
    """
    inner, outer = 0.98, 1.0
    ring = ring_mesh(inner, outer, 240)
    a = (inner + outer) / 2
    z, t = ring.radius - a, ring.theta
    radial, v = np.cos(2 * t), -np.sin(2 * t) / 2
    hoop = v - z * (-2 * np.sin(2 * t) - v) / a
    e_r, e_t = np.column_stack([np.cos(t), np.sin(t)]), np.column_stack([-np.sin(t), np.cos(t)])
    u = radial[:, None] * e_r + hoop[:, None] * e_t
    by_y1, by_y2 = nodal_gradient(ring)
    gradient = np.stack([by_y1 @ u, by_y2 @ u], axis=-1)  # [node, component, direction]
    strain = np.einsum("ni,nij,nj->n", e_t, gradient, e_t)
    exact = 3 * z * np.cos(2 * t) / (a * (a + z))
    # the elements see cos 2t with h = 0.026: errors of (2h)^3 or so of the displacement's own gradient, 1
    np.testing.assert_allclose(strain, exact, atol=3e-4)


def test_gauss_points_weigh_the_area_and_see_quadratic_energies_exactly():
    """The areas add up to the annulus, and gradients of linear fields are exact."""
    inner, outer = 0.9, 1.0
    ring = ring_mesh(inner, outer, 120, 2, 0.1, 2.0)
    by_y1, by_y2, area = gauss_gradient(ring)
    assert area.shape == (len(ring.quad9), 9)
    assert area.sum() == pytest.approx(np.pi * (outer**2 - inner**2), rel=1e-7)
    field = 2 * ring.points[:, 0] - 3 * ring.points[:, 1]
    np.testing.assert_allclose(by_y1 @ field, 2, rtol=1e-10)
    np.testing.assert_allclose(by_y2 @ field, -3, rtol=1e-10)
    # Dirichlet energy of x^2 - y^2, |grad|^2 = 4 rho^2, over the annulus: 2 pi (b^4 - a^4)
    x, y = ring.points.T
    energy = ((by_y1 @ (x**2 - y**2)) ** 2 + (by_y2 @ (x**2 - y**2)) ** 2) @ area.ravel()
    assert energy == pytest.approx(2 * np.pi * (outer**4 - inner**4), rel=1e-6)
