"""The contact by itself, on a rigid rim: Winkler's patch, Kalker's rolling brush, exact tangents."""

from math import pi, sqrt

import numpy as np
import pytest
from kinematic import VERTEX, Rim

from flexible.contact.detection import element_at
from flexible.contact.forces import (
    BEYOND,
    BRISTLE_ENERGY,
    BRUSH,
    FRICTION,
    NORMAL,
    NORMAL_ENERGY,
    SLIDE_LEFT,
    SLIDE_RIGHT,
    SLIP,
    STICK,
    UNDAMPED,
    contact_forces,
)

EPS = 1e6


def winkler(points):
    """Relative error of N of a patch with ``points`` points against (4/3) eps delta sqrt(2 delta)."""
    depth = 1e-6  # the circle is a parabola to delta/2
    spacing = 2 * sqrt(2 * depth) / points
    # the mean over positions of the grid in the patch, which is by chance at any one
    places = 2.9 + spacing * np.linspace(0, 1, 7, endpoint=False)
    found = [Rim((spacing, EPS, EPS, 0.3, 0.3), depth, phi).result[3][NORMAL] for phi in places]
    return np.abs(np.array(found) / (4 / 3 * EPS * depth * sqrt(2 * depth)) - 1).max()


def test_force_of_a_patch_converges_with_its_points():
    """Gap linear between points: the force converges with their distance squared."""
    counts = np.array([8, 16, 32, 64])
    errors = [winkler(int(n)) for n in counts]
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-2, abs=0.2)
    assert errors[-1] < 1e-3


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("xi", [0.1, 0.3, 0.5, 0.8, 1.5])
def test_steady_rolling_of_the_brush(xi, way):
    """F/(mu N) = 1 - (1 - xi)^3, xi = eps_t gamma a/(2 mu p0) < 1, and 1 beyond (Kalker 1990, sec. 1.3.4).

    Within 1e-3: 200 points to the patch leave a few 1e-4 (above), and the rim, which is not flat, a of the creep.
    """
    mu, depth = 0.3, 1e-8
    a = sqrt(2 * depth)
    rim = Rim((2 * a / 200, EPS, 0.8 * EPS, mu, mu), depth, phi=2.9)
    creep = xi * 2 * mu * depth / (0.8 * a)
    found = [rim.move(creep * a / 37, way * a / 37) for _ in range(160)][-37:]
    share = np.mean([res[FRICTION] / (mu * res[NORMAL]) for res in found])
    exact = 1 - (1 - min(xi, 1)) ** 3
    assert share == pytest.approx(-exact, abs=1e-3)  # the contact point drifts to the right: friction to the left


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("points", [12, 48])
def test_steady_rolling_of_a_sticking_patch(points, way):
    """Bristles stretch with their way from the leading edge: F = eps_t gamma (2 a)^2/2, smoothly, and F gamma is lost.

    Eight steps from point to point see no rhythm of the points: the edge is on the gap's parabola, which a circle's is
    but for psi^4 (depth 1e-8), and the last bristle is kept until the next one has left.
    """
    depth, creep = 1e-8, 1e-3
    a = sqrt(2 * depth)
    rim = Rim((2 * a / points, EPS, 0.8 * EPS, 0.3, 0.3), depth, phi=2.9, mode=STICK)
    step = 2 * a / points / 8 * 1.0001
    found = [rim.move(creep * step, way * step) for _ in range(24 * points)]
    friction = np.array([res[FRICTION] for res in found])
    exact = -0.8 * EPS * creep * (2 * a) ** 2 / 2
    assert friction[-8 * points :] == pytest.approx(exact, rel=1e-5)
    assert np.ptp(friction[-8 * points :]) < 1e-8 * abs(exact)
    moved, stored = (np.array([res[i] for res in found]) for i in (SLIP, BRISTLE_ENERGY))
    work = (friction[1:] + friction[:-1]) / 2 * moved[1:] + np.array([res[BEYOND] for res in found])[1:]
    lost = -work - np.diff(stored)
    assert lost[-8 * points :].mean() == pytest.approx(-exact * creep * step, rel=2e-5)
    assert lost.min() > -1e-6 * lost.max()


@pytest.mark.parametrize("mode", [STICK, SLIDE_RIGHT, SLIDE_LEFT, BRUSH])
@pytest.mark.parametrize("damper", [UNDAMPED, (2.0, 0.95, 1.0, 1e5, 1e-6, *UNDAMPED[5:])])
def test_tangent_of_the_contact(mode, damper):
    """Against central differences of the forces, 1e-6 of the largest entry; and normal forces from their energy."""
    rng = np.random.default_rng(0)
    law = np.array([2e-4, EPS, 0.8 * EPS, 0.35, 0.3])
    depth, phi = (1.5 / EPS) ** (2 / 3) / 2, 2.9
    first = element_at(VERTEX, pi - phi) - 1
    flat = np.zeros((9, 2))
    old = np.array([0.0, -depth, phi])
    start = contact_forces(
        old, flat, first, VERTEX, law, mode, old, flat, np.empty((0, 3)), np.empty(0, np.int8), np.array(damper)
    )
    bristles, flags = start[4].copy(), start[5].copy()
    bristles[:, 1] = -1e-6 * rng.random(len(bristles))
    x = np.concatenate([[-2e-6, -1.05 * depth, phi + 0.004], 1e-7 * rng.standard_normal(18)])

    def forces(x):
        result = contact_forces(
            x[:3], x[3:].reshape(-1, 2), first, VERTEX, law, mode, old, flat, bristles, flags, np.array(damper)
        )
        return np.concatenate([result[0], result[1].ravel()]), result[2], result[3]

    step = 1e-9  # far below a spacing: no point enters or leaves
    columns = [(forces(x + step * e)[0] - forces(x - step * e)[0]) / (2 * step) for e in np.eye(len(x))]
    tangent = forces(x)[1]
    assert np.abs(np.array(columns).T - tangent).max() < 1e-6 * np.abs(tangent).max()
    if damper[0] == 0:
        up = np.eye(len(x))[1] * step
        work = (forces(x + up)[2][NORMAL_ENERGY] - forces(x - up)[2][NORMAL_ENERGY]) / (2 * step)
        assert -work == pytest.approx(forces(x)[2][NORMAL], rel=1e-6)


@pytest.mark.parametrize("mode", [STICK, BRUSH])
@pytest.mark.parametrize("way", [1, -1])
def test_tangent_of_points_that_enter(mode, way):
    """A rim that comes down while it rolls and creeps: no point has a bristle yet, each enters at its own instant.

    Friction by itself, whose entries are a thousandth of the normal forces': 1e-5 of its largest, what central
    differences of 1e-9 of forces of 1e-16/1e-9 leave. The instant moves with gap, phi and abscissa.
    """
    law = np.array([2e-4, EPS, 0.8 * EPS, 9.0, 9.0])  # nothing slides
    depth, phi = (1.5 / EPS) ** (2 / 3) / 2, 2.9
    first = element_at(VERTEX, pi - phi) - 1
    flat, none, flags = np.zeros((9, 2)), np.empty((0, 3)), np.empty(0, np.int8)
    old = np.array([0.0, 0.3 * depth, phi])

    def result(x):
        return contact_forces(x[:3], x[3:].reshape(-1, 2), first, VERTEX, law, mode, old, flat, none, flags, UNDAMPED)

    x = np.concatenate([[2e-6, -depth, phi + way * 0.004], 1e-8 * np.sin(np.arange(18))])
    assert result(x)[3][NORMAL] > 0
    assert abs(result(x)[3][FRICTION]) > 1e-3
    assert len(result(x)[4]) > 10
    step = 1e-9
    columns = [(result(x + step * e)[0][0] - result(x - step * e)[0][0]) / (2 * step) for e in np.eye(len(x))]
    friction = result(x)[2][0]
    assert np.abs(columns - friction).max() < 1e-5 * np.abs(friction).max()
    assert np.array(columns[:3]) == pytest.approx(friction[:3], rel=1e-3)  # V, h, phi, whose entry is 1e-5 of V's
