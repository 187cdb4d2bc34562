"""The contact by itself, on a rigid rim: Winkler's patch, Kalker's rolling brush, exact tangents."""

from itertools import pairwise
from math import pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from kinematic import VERTEX, Floor, parameters

from flexible.contact.forces import contact_forces
from flexible.contact.laws.listing import LAWS, care
from flexible.contact.laws.patch import SLIDE_LEFT, SLIDE_RIGHT, STICK
from flexible.contact.points.data import UNDAMPED, Before, Bristles, Rim, no_bristles
from flexible.contact.points.rim import element_at
from rigid.elastic import LAWS as NAMES

EPS = 1e6


def winkler(points):
    """Relative error of N of a patch with ``points`` points against (4/3) eps delta sqrt(2 delta)."""
    depth = 1e-6  # the circle is a parabola to delta/2
    spacing = 2 * sqrt(2 * depth) / points
    # the mean over positions of the grid in the patch, which is by chance at any one
    places = 2.9 + spacing * np.linspace(0, 1, 7, endpoint=False)
    law = parameters("brush", spacing, EPS, EPS)
    found = [Floor(law, depth, phi).result.res.normal for phi in places]
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
    rim = Floor(parameters("brush", 2 * a / 200, EPS, 0.8 * EPS, mu, mu), depth)
    creep = xi * 2 * mu * depth / (0.8 * a)
    found = [rim.move(creep * a / 37, way * a / 37) for _ in range(160)][-37:]
    share = np.mean([res.friction / (mu * res.normal) for res in found])
    exact = 1 - (1 - min(xi, 1)) ** 3
    assert share == pytest.approx(-exact, abs=1e-3)  # the contact point drifts to the right: friction to the left


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("stuck", [0.3, 0.6, 0.9])
def test_steady_rolling_of_a_brush_that_slides_by_less_than_it_holds(stuck, way):
    """F/N = 3 mu_s (b^2 - b^3) + mu (1 - 3 b^2 + 2 b^3), b the share that sticks (:mod:`flexible.contact.laws.brush`).

    A point that has broken loose slides on under mu p. Within 1e-2: the friction jumps where they break, point by point
    of 200.
    """
    mu_s, mu, depth = 0.45, 0.3, 1e-8
    a = sqrt(2 * depth)
    rim = Floor(parameters("brush", 2 * a / 200, EPS, 0.8 * EPS, mu_s, mu), depth)
    creep = 4 * mu_s * depth * (1 - stuck) / (0.8 * 2 * a)
    found = [rim.move(creep * a / 37, way * a / 37) for _ in range(160)][-37:]
    b = stuck
    exact = 3 * mu_s * (b**2 - b**3) + mu * (1 - 3 * b**2 + 2 * b**3)
    assert np.mean([res.friction / res.normal for res in found]) == pytest.approx(-exact, rel=1e-2)


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("points", [12, 48])
def test_steady_rolling_of_a_sticking_patch(points, way):
    """Bristles stretch with their way from the leading edge: F = eps_t gamma (2 a)^2/2, smoothly, and F gamma is lost.

    Eight steps from point to point see no rhythm of the points: the edge is on the gap's parabola, which a circle's is
    but for psi^4 (depth 1e-8), and the last bristle is kept until the next one has left.
    """
    depth, creep = 1e-8, 1e-3
    a = sqrt(2 * depth)
    rim = Floor(parameters("patch", 2 * a / points, EPS, 0.8 * EPS), depth, mode=STICK)
    step = 2 * a / points / 8 * 1.0001
    found = [rim.move(creep * step, way * step) for _ in range(24 * points)]
    friction = np.array([res.friction for res in found])
    exact = -0.8 * EPS * creep * (2 * a) ** 2 / 2
    assert friction[-8 * points :] == pytest.approx(exact, rel=1e-5)
    assert np.ptp(friction[-8 * points :]) < 1e-8 * abs(exact)
    moved, stored = np.array([(res.way, res.bristle_energy) for res in found]).T
    work = (friction[1:] + friction[:-1]) / 2 * moved[1:] + np.array([res.beyond for res in found])[1:]
    lost = -work - np.diff(stored)
    assert lost[-8 * points :].mean() == pytest.approx(-exact * creep * step, rel=2e-5)
    assert lost.min() > -1e-6 * lost.max()


def lost(before, res):
    """What a patch loses in a step of a steady roll, in which it has the forces of its beginning again."""
    work = (before.friction + res.friction) / 2 * res.way + res.beyond
    return -work - (res.bristle_energy - before.bristle_energy)


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("turn", [0.3, 0.9, 1.7])
def test_a_sticking_patch_loses_friction_times_creep_in_steps_as_long_as_itself(turn, way):
    """Within two hundredths: of the stretch of a bristle at the edge 48 points know that much."""
    depth, creep, points = 1e-8, 1e-3, 48
    a = sqrt(2 * depth)
    rim = Floor(parameters("patch", 2 * a / points, EPS, 0.8 * EPS), depth, mode=STICK)
    step = 2 * a * turn
    found = [rim.move(creep * step, way * step) for _ in range(12)][-6:]
    friction = -0.8 * EPS * creep * (2 * a) ** 2 / 2
    for before, res in pairwise(found):
        assert lost(before, res) == pytest.approx(-friction * creep * step, rel=2e-2)


def test_bristles_let_go_of_what_they_hold_however_the_rim_moves_beyond_them():
    """A soft wall is held to the floor by its patch, and goes along it behind that by fifty times a stretch.

    The same roll as above, on a rim that was displaced so from the rear half of its patch on when the last step began.
    Bristles stretched by that on their way out would have lost many times as much.
    """
    depth, creep, points = 1e-8, 1e-3, 48
    a = sqrt(2 * depth)
    corner = element_at(VERTEX, pi - 2.9)
    step, phi = a, pi + a / 2 - VERTEX[corner]  # an element begins half of a half-width before the rear edge
    rim = Floor(parameters("patch", 2 * a / points, EPS, 0.8 * EPS), depth, phi - 8 * step, STICK)
    before = [rim.move(creep * step, step) for _ in range(8)][-1]
    assert rim.pose[2] == pytest.approx(phi, abs=1e-14)
    first, flat = corner - 6, np.zeros((27, 2))
    along = np.maximum(np.arange(27) - 12, 0) * 100 * creep * a / (a / 2) * (VERTEX[1] - VERTEX[0]) / 2
    dent = np.outer(along, [np.sin(phi), np.cos(phi)])
    pose, since = rim.pose + np.array([creep * step, 0, step]), Before(rim.pose, dent, rim.bristles, first, dent)
    res = contact_forces(pose, flat, Rim(first, VERTEX), rim.law, STICK, since, UNDAMPED, False).res
    assert res.friction == pytest.approx(before.friction, rel=1e-2)
    assert lost(before, res) == pytest.approx(-res.friction * creep * step, rel=2e-2)


MODES = [("patch", STICK), ("patch", SLIDE_RIGHT), ("patch", SLIDE_LEFT), ("brush", 0), ("regularised", 0)]


@pytest.mark.parametrize(("name", "mode"), MODES)
@pytest.mark.parametrize("damping", [{}, {"relaxation": 2.0, "elastic_0": 0.95, "drag": 1e5, "way_0": 1e-6}])
@pytest.mark.parametrize("halves", [0.0, 0.2, 0.5])
def test_tangent_of_the_contact(name, mode, damping, halves):
    """Against central differences of the forces, 1e-6 of the largest entry; and normal forces from their energy.

    So is the derivative of the way that smoothed friction goes by.
    """
    rng = np.random.default_rng(0)
    # slip velocities of this step are of the size of the scale that smooths the friction
    law = parameters(name, 2e-4, EPS, 0.8 * EPS, 0.35, 0.3, slip_scale=2e-3)
    damper = UNDAMPED._replace(rate=1e3, **damping)
    depth, phi = (1.5 / EPS) ** (2 / 3) / 2, 2.9
    rim = Rim(element_at(VERTEX, pi - phi) - 1, VERTEX)
    flat = np.zeros((9, 2))
    old = np.array([0.0, -depth, phi])
    start = contact_forces(old, flat, rim, law, mode, Before(old, flat, no_bristles()), damper, True)
    bristles = start.bristles._replace(stretch=-1e-6 * rng.random(len(start.bristles.stretch)))
    before = Before(old, flat, bristles, rim.first, 1e-6 * rng.standard_normal(flat.shape), halves)
    x = np.concatenate([[-2e-6, -1.05 * depth, phi + 0.004], 1e-7 * rng.standard_normal(18)])

    def contact(x):
        return contact_forces(x[:3], x[3:].reshape(-1, 2), rim, law, mode, before, damper, True)

    def forces(x):
        found = contact(x)
        return np.concatenate([found.force, found.nodal.ravel()])

    step = 1e-9  # far below a spacing: no point enters or leaves
    columns = [(forces(x + step * e) - forces(x - step * e)) / (2 * step) for e in np.eye(len(x))]
    tangent = contact(x).tangent
    assert np.abs(np.array(columns).T - tangent).max() < 1e-6 * np.abs(tangent).max()
    if name == "regularised":
        ways = [contact(x + step * e).res.way - contact(x - step * e).res.way for e in np.eye(len(x))]
        assert contact(x).way_by == pytest.approx(np.array(ways) / (2 * step), abs=1e-6)  # V's is 1
    if not damping:
        up = np.eye(len(x))[1] * step
        work = (contact(x + up).res.normal_energy - contact(x - up).res.normal_energy) / (2 * step)
        assert -work == pytest.approx(contact(x).res.normal, rel=1e-6)


@pytest.mark.parametrize("ratio", [0.01, 1.0, 30.0])
def test_regularised_friction(ratio):
    """F = -mu N v/sqrt(v^2 + v_s^2) to round-off, and every point has its share of N."""
    scale, depth, beta = 1e-3, 1e-6, 1e-3
    floor = Floor(parameters("regularised", 1e-4, EPS, EPS, 0.5, 0.3, scale), depth)
    velocity = ratio * scale
    # sliding without turning: the way of the step is V's alone
    res = floor.move(velocity * beta, 0.0, UNDAMPED._replace(rate=1 / beta))
    assert res.friction == pytest.approx(-0.3 * res.normal * ratio / sqrt(1 + ratio**2), rel=1e-9)
    assert res.bristle_energy == 0
    assert (res.stuck > 0) == (ratio < 1)
    assert floor.bristles.pull == pytest.approx(0)  # of bristles, which there are none of


def test_bristles_of_a_sliding_patch_hold_nothing_of_what_a_damper_adds():
    """Pressed twice as hard by it F is mu N, twice as large, and what the bristles store is that of the springs."""
    law = parameters("patch", 1e-4, EPS, 0.8 * EPS)
    alone, pressed = (
        Floor(law, 1e-6, mode=SLIDE_LEFT).move(1e-5, 0.0, UNDAMPED._replace(eta_0=eta)) for eta in (1.0, 2.0)
    )
    assert (alone.friction, pressed.friction) == pytest.approx((-0.3 * alone.elastic, -0.6 * alone.elastic))
    assert pressed.bristle_energy == pytest.approx(alone.bristle_energy, rel=1e-12)
    assert alone.bristle_energy > 0


def test_steps_before_a_stick_breaks_have_a_tenth_of_their_tolerance():
    """Whichever way it pulls, once it holds more than half of what it can; one that slides has nothing to break."""
    mu_s, normal = 0.4, 2.5

    def cared(law, mode, share):
        res = SimpleNamespace(normal=normal, friction=share * mu_s * normal)
        return care(parameters(law, 1e-3, EPS, EPS, mu_s, 0.3), SimpleNamespace(mode=mode, res=res))

    near, far = (-1.0, -0.51, 0.51, 1.0), (-0.49, 0.0, 0.49)
    assert {cared("patch", STICK, share) for share in near} == {0.1}
    assert {cared("patch", STICK, share) for share in far} == {1.0}
    assert {cared("patch", mode, share) for mode in (SLIDE_LEFT, SLIDE_RIGHT) for share in near} == {1.0}
    assert {cared(law, STICK, share) for law in set(LAWS) - {"patch"} for share in near} == {1.0}


def test_every_law_has_a_name_a_scene_may_hold():
    """The scene's list stands where the laws cannot be imported; and compiled code tells laws apart by their codes."""
    assert tuple(LAWS) == NAMES
    assert len({law.code for law in LAWS.values()}) == len(LAWS)


@pytest.mark.parametrize("name", ["patch", "brush"])
@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("dent", [0.0, 1e-6])
@pytest.mark.parametrize("ratio", [1.0, 4.0])
def test_tangent_of_points_that_enter(name, way, dent, ratio):
    """A rim that comes down while it rolls and creeps: no point has a bristle yet, each enters at its own instant.

    Friction by itself, whose entries are a thousandth of the normal forces': 1e-5 of its largest, what central
    differences of 1e-9 of forces of 1e-16/1e-9 leave. The instant moves with gap, phi and abscissa, and in a stage
    that is longer than its rates are known by (``ratio``) each bristle with the way of the patch as a whole.
    """
    law = parameters(name, 2e-4, EPS, 0.8 * EPS, 9.0, 9.0)  # nothing slides
    depth, phi = (1.5 / EPS) ** (2 / 3) / 2, 2.9
    rim, flat = Rim(element_at(VERTEX, pi - phi) - 1, VERTEX), np.zeros((9, 2))
    dented = dent * np.sin(1 + np.arange(18)).reshape(9, 2)
    before = Before(np.array([0.0, 0.3 * depth, phi]), flat, no_bristles(), rim.first, dented)

    damper = UNDAMPED._replace(ratio=ratio, turning_0=-(ratio - 1) * way * 0.004, way_0=(1 - 1 / ratio) * 2e-6)

    def contact(x):
        return contact_forces(
            x[:3], x[3:].reshape(-1, 2), rim, law, STICK, before, damper, True
        )  # the brush's only mode

    x = np.concatenate([[2e-6, -depth, phi + way * 0.004], 1e-8 * np.sin(np.arange(18))])
    found = contact(x)
    assert found.res.normal > 0
    assert abs(found.res.friction) > 1e-3
    assert len(found.bristles.number) > 10
    step = 1e-9
    columns = [(contact(x + step * e).force[0] - contact(x - step * e).force[0]) / (2 * step) for e in np.eye(len(x))]
    friction = found.tangent[0]
    assert np.abs(columns - friction).max() < 1e-5 * np.abs(friction).max()
    assert np.array(columns[:3]) == pytest.approx(friction[:3], rel=1e-3)  # V, h, phi, whose entry is 1e-5 of V's


SPOT = 2e-4  # distance of the points


def spot(depth, tilt=0.0, stretch=1e-4):
    """A patch that sticks, of two points on both sides of the lowest one, on bristles stretched from elsewhere.

    The two are ``depth`` deep, and one ``tilt`` deeper than the other. Answers the contact by pose and nodes.
    """
    law = parameters("patch", SPOT, EPS, EPS)
    phi = pi - 500.5 * SPOT + tilt / SPOT
    rim, flat = Rim(element_at(VERTEX, pi - phi) - 2, VERTEX), np.zeros((11, 2))
    pose = np.array([0.0, -depth - 2 * np.sin(SPOT / 4) ** 2, phi])
    number = np.arange(498, 504)
    held = Bristles(number, np.full(6, stretch), np.zeros(6), np.zeros(6, np.int8))
    before = Before(pose, flat, held)

    def contact(x):
        return contact_forces(x[:3], x[3:].reshape(-1, 2), rim, law, STICK, before, UNDAMPED, True)

    return contact, np.concatenate([pose, flat.ravel()])


@pytest.mark.parametrize("tilt", [0.0, 0.9, -0.9, 1.1, -3.0])
def test_a_spot_that_leaves_the_floor_lets_go_of_its_bristles(tilt):
    """What share of the cell between two points lies on the floor is anything where both are about to leave: whatever
    it is, their pull goes like their depth."""
    pulls = []
    for depth in (1e-6 * SPOT**2, 1e-4 * SPOT**2):
        contact, x = spot(depth, tilt * depth)
        res = contact(x).res
        assert res.normal > 0
        pulls.append(abs(res.friction) / (EPS * 1e-4 * SPOT))  # over that of a cell that sticks
    assert 0 < pulls[0] < 1e-3
    assert pulls[1] / pulls[0] == pytest.approx(100, rel=0.1)


@pytest.mark.parametrize(("depth", "tilt"), [(0.004, 0.001), (0.008, -0.006), (0.002, 0.003)])
def test_tangent_of_a_spot_that_leaves(depth, tilt):
    """Against central differences, 1e-5 of the largest entry."""
    contact, x = spot(depth * SPOT**2, tilt * SPOT**2)
    step, columns = 1e-14, []
    for e in np.eye(len(x)):
        one, other = (contact(x + s * step * e) for s in (1, -1))
        columns.append((one.nodal.ravel() - other.nodal.ravel()) / (2 * step))
    tangent = contact(x).tangent[3:]
    assert np.abs(np.array(columns).T - tangent).max() < 1e-5 * np.abs(tangent).max()
