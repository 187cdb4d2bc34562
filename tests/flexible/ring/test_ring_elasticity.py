"""The ring's stiffness and mass against exact solutions in plane stress and of thin rings.

Exact values: Love, A Treatise on the Mathematical Theory of Elasticity; Timoshenko, Strength of Materials II (pinched
ring); rotating ring (Timoshenko and Goodier, Theory of Elasticity, sec. 32). Those of the annulus come from its Airy
functions, evaluated in many digits.
"""

from math import pi

import numpy as np
import pytest
from free_ring import frequencies, nodal, outer_traction, ring, solve

from flexible.ring.choice import elements_through, halved_at_rim, ring_of
from meshes import nodal_gradient
from rigid import load_scene

# omega_n R0 sqrt(rho/E) of the annulus, n = 2, 3, 4, nu = 0.3
ANNULUS = {1.02: (0.01518385365, 0.04293285531, 0.08228274316), 1.2: (0.1260894549, 0.3479811729, 0.6458273265)}
# u_r E/p on the outer rim under p cos(n theta) there, n = 2, 3, 4
TRACTION = {1.02: (175202.447, 24647.4525, 7014.65993), 1.2: (272.574696, 39.5676100, 11.7771249)}


def order(sizes, errors):
    """Fitted exponent of the error in the size."""
    return np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0]


@pytest.mark.parametrize(("ratio", "around", "through"), [(1.02, 960, 2), (1.2, 240, 6)])
def test_frequencies_of_an_annulus(ratio, around, through):
    """Within 1e-5; both of a pair, cos and sin."""
    found = frequencies(ratio, around, through).reshape(-1, 2)
    assert found == pytest.approx(np.repeat(np.reshape(ANNULUS[ratio], (3, 1)), 2, axis=1), rel=1e-5)


def test_frequencies_converge_with_the_elements():
    """Eigenvalues of quadratic elements converge with h^4; the elements are refined in both directions."""
    counts = np.array([24, 48, 96])
    errors = [frequencies(1.2, int(n), int(n) // 24)[0] / ANNULUS[1.2][0] - 1 for n in counts]
    assert order(1 / counts, errors) == pytest.approx(4, abs=0.3)


@pytest.mark.parametrize(("ratio", "around", "through"), [(1.02, 720, 3), (1.2, 320, 8)])
def test_compliance_to_traction(ratio, around, through):
    """Within 1e-5, by the work of the traction: that is the harmonic's own part of u_r."""
    free = ring(ratio, around, through)
    loads = [outer_traction(free, harmonic) for harmonic in (2, 3, 4)]
    found = [load @ solve(free, load) / (pi * free.mesh.outer) for load in loads]
    assert found == pytest.approx(TRACTION[ratio], rel=1e-5)


def test_compliance_converges_with_the_elements():
    """With h^4, twice the order of quadratic elements in energy."""
    counts = np.array([30, 60, 120])
    errors = []
    for n in counts:
        free = ring(1.2, int(n), int(n) // 30)
        load = outer_traction(free, 2)
        errors.append(load @ solve(free, load) / (pi * free.mesh.outer) / TRACTION[1.2][0] - 1)
    assert order(1 / counts, errors) == pytest.approx(4, abs=0.3)


@pytest.mark.parametrize("ratio", [1.02, 1.05, 1.2, *(pytest.param(r, marks=pytest.mark.slow) for r in (1.5, 2.0))])
def test_a_wall_has_as_many_elements_as_it_needs(ratio):
    """Slow frequencies and compliances within 0.1 %, of the exact ones where they are known and of a finer mesh."""

    def measured(around, through):
        free = ring(ratio, around, through)
        loads = [outer_traction(free, harmonic) for harmonic in (2, 3, 4)]
        compliances = [load @ solve(free, load) / (pi * free.mesh.outer) for load in loads]
        return frequencies(ratio, around, through)[::2], compliances

    exact = (ANNULUS[ratio], TRACTION[ratio]) if ratio in ANNULUS else measured(240, 8)
    for found, value in zip(measured(240, elements_through(1 - 1 / ratio)), exact, strict=True):
        assert found == pytest.approx(value, rel=1e-3)


def test_a_scene_may_say_how_many_elements_go_through():
    thick = load_scene("paper-3.3-light").replace(hoop={"r": 1.2}, solve={"elements": 48})
    for through, said in ((elements_through(1 - 1 / 1.2), {}), (2, {"through": 2})):
        layers = through + halved_at_rim(1 - 1 / 1.2, 48, through)
        assert len(ring_of(thick.replace(solve=said)).mesh.grid) == 2 * layers + 1


def closing(wall):
    """Closing of the pinched diameter and opening of the one across, in P a^3/(E I), of a ring of wall h/a."""
    free = ring((1 + wall / 2) / (1 - wall / 2), 480, 2)
    a, thickness = free.mesh.outer / (1 + wall / 2), free.mesh.outer - free.mesh.inner
    theta = free.mesh.rim_theta
    nodes = [free.mesh.rim_nodes[np.argmin(np.abs(np.cos(theta - angle) - 1))] for angle in (0, pi, pi / 2, -pi / 2)]
    load = np.zeros(free.basis.N)
    load[free.mesh.node_dofs[nodes[0], 0]], load[free.mesh.node_dofs[nodes[1], 0]] = -1.0, 1.0
    u = nodal(free, solve(free, load))
    scale = thickness**3 / 12 / a**3
    return (u[nodes[1], 0] - u[nodes[0], 0]) * scale, (u[nodes[2], 1] - u[nodes[3], 1]) * scale


def test_pinched_thin_ring():
    """Closes by (pi/4 - 2/pi) P a^3/(E I), opens across by (2/pi - 1/2): thin-ring theory neglects (h/a)^2.

    The indentation under a point load is (h/a)^3 of the bending.
    """
    exact = np.array([pi / 4 - 2 / pi, 2 / pi - 1 / 2])
    walls = np.array([0.08, 0.04, 0.02])
    errors = np.array([closing(wall) for wall in walls]) / exact - 1
    assert np.abs(errors[-1]).max() < 10 * walls[-1] ** 2
    assert order(walls, errors[:, 0]) == pytest.approx(2, abs=0.2)


def test_frequencies_of_a_thin_ring():
    """omega_n^2 = E I n^2 (n^2-1)^2/(rho A a^4 (n^2+1)) for h/a -> 0, with an error of (n h/a)^2."""
    n = np.array([2, 3, 4])
    for wall in (0.02, 0.01):
        ratio = (1 + wall / 2) / (1 - wall / 2)
        a, thickness = 1 / (1 - wall / 2), ratio - 1
        thin = np.sqrt(thickness**2 / 12 * n**2 * (n**2 - 1) ** 2 / (a**4 * (n**2 + 1)))
        errors = frequencies(ratio, 480)[::2] / thin - 1
        assert (np.abs(errors) < (n * wall) ** 2).all()


def hoop_stress_error(around, through):
    """Largest error of sigma_theta of the rotating ring a = 1, b = 1.2, relative to the largest stress."""
    free = ring(1.2, around, through)
    spin = 0.7
    u = nodal(free, solve(free, spin**2 * (free.mass * free.area) @ free.position_field))
    by_1, by_2 = nodal_gradient(free.mesh)
    strain = np.array([by_1 @ u[:, 0], by_2 @ u[:, 1], by_2 @ u[:, 0] + by_1 @ u[:, 1]])
    nu = free.poisson
    s11, s22 = (strain[0] + nu * strain[1]) / (1 - nu**2), (strain[1] + nu * strain[0]) / (1 - nu**2)
    s12 = strain[2] / (2 * (1 + nu))
    c, s = np.cos(free.mesh.theta), np.sin(free.mesh.theta)
    found = s11 * s**2 + s22 * c**2 - 2 * s12 * s * c
    a, b, x = 1.0, 1.2, free.mesh.radius
    exact = spin**2 * (3 + nu) / 8 * (a**2 + b**2 + (a * b / x) ** 2 - (1 + 3 * nu) / (3 + nu) * x**2)
    return np.abs(found - exact).max() / exact.max()


def test_rotating_ring():
    """Lame's hoop stress, with the order of stresses at Gauss points, h^2."""
    counts = np.array([48, 96, 192])
    errors = [hoop_stress_error(int(n), int(n) // 24) for n in counts]
    assert errors[-1] < 3e-4
    assert order(1 / counts, errors) == pytest.approx(2, abs=0.3)


def test_products_along_the_rim_integrate_what_its_elements_hold():
    """1, the circle's 2 pi; a wave's square, pi: what quadratic shapes of length d leave falls as (n d)^4/180, 1e-6."""
    made = ring(1.02, 240, 1)
    theta = made.mesh.rim_theta
    ones, wave = np.ones(len(theta)), np.cos(3 * theta)
    assert ones @ made.rim_products @ ones == pytest.approx(2 * pi, rel=1e-12)
    assert wave @ made.rim_products @ wave == pytest.approx(pi, rel=1e-6)
    assert ones @ made.rim_products @ wave == pytest.approx(0, abs=1e-9)
