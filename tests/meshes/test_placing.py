"""From the disk's frame to the world, against hand-made and exact fields; and the choice of frames."""

from math import pi

import numpy as np
import pytest

from meshes import Placement, bending_stress, frame_times, hoop_stress, ring_mesh, von_mises

rng = np.random.default_rng(7)


@pytest.mark.parametrize(
    ("phi", "y1", "y2"),
    [
        (0.0, (0, 1), (1, 0)),  # disk at the top; clockwise from up is right
        (pi / 2, (1, 0), (0, -1)),
        (pi, (0, -1), (-1, 0)),
        (3 * pi / 2, (-1, 0), (0, 1)),
    ],
)
def test_the_frame_points_to_the_disk_and_clockwise(phi, y1, y2):
    place = Placement(phi, 5.0, 1.0)
    np.testing.assert_allclose(place.axes, [y1, y2], atol=1e-15)
    np.testing.assert_allclose(place.points(np.eye(2)), np.add([5.0, 1.0], [y1, y2]), atol=1e-15)


def test_velocity_is_the_rate_of_the_position():
    """Central difference of a motion that turns, moves and deforms; its error is O(step^2) = 1e-10."""
    y, u0, rate = rng.normal(size=(3, 20, 2))

    def position(t):
        return Placement(0.3 + 1.7 * t, 2.0 * t, 1.0 - 0.4 * t).points(y + u0 + t * rate)

    place = Placement(0.3, 0.0, 1.0)
    step = 1e-5
    numerical = (position(step) - position(-step)) / (2 * step)
    np.testing.assert_allclose(place.velocities(y, u0, rate, (2.0, -0.4), 1.7), numerical, atol=1e-8)


def test_stress_turns_like_a_tensor():
    """Tractions n . sigma are vectors: they turn with the frame whatever n is."""
    place = Placement(0.8, 0.0, 0.0)
    s = rng.normal(size=(1, 3))
    w = place.stress(s)[0]
    local = np.array([[s[0, 0], s[0, 2]], [s[0, 2], s[0, 1]]])
    world = np.array([[w[0], w[2]], [w[2], w[1]]])
    for normal in np.eye(2):
        expected = place.vectors((local @ normal)[None])[0]
        np.testing.assert_allclose(world @ place.vectors(normal[None])[0], expected, atol=1e-15)
    assert von_mises(s)[0] == pytest.approx(von_mises(place.stress(s))[0], rel=1e-14)


def test_von_mises_of_known_states():
    """Uniaxial s: s. Pure shear s: sqrt(3) s. Equibiaxial plane stress s: s."""
    states = np.array([[2.0, 0, 0], [0, 0, 2.0], [2.0, 2.0, 0]])
    np.testing.assert_allclose(von_mises(states), [2.0, 2 * 3**0.5, 2.0], rtol=1e-15)


@pytest.mark.parametrize("halved", [0, 3])
def test_bending_of_a_linear_stress_through_the_wall(halved):
    """sigma_theta = 3 + 5 (rho - mid) has the mean 3 and the bending 5 (rho - mid), to round-off."""
    ring = ring_mesh(0.9, 1.0, 24, 2, halved=halved)
    expected = 5 * (ring.radius - 0.95)
    sin, cos = np.sin(ring.theta), np.cos(ring.theta)
    hoop = 3 + expected
    stress = np.column_stack([hoop * sin**2, hoop * cos**2, -hoop * sin * cos])
    np.testing.assert_allclose(hoop_stress(ring, stress), hoop, rtol=1e-14)
    np.testing.assert_allclose(bending_stress(ring, hoop_stress(ring, stress)), expected, atol=1e-14)


@pytest.mark.parametrize("halved", [0, 3])
def test_the_mean_through_the_wall_is_an_integral(halved):
    """sigma_theta = (rho - mid)^2 + 4 (rho - mid)^3 has the mean h^2/12 over a wall h, by Simpson exactly."""
    ring = ring_mesh(0.7, 1.0, 24, 2, halved=halved)
    off = ring.radius - 0.85
    hoop = off**2 + 4 * off**3
    np.testing.assert_allclose(bending_stress(ring, hoop), hoop - 0.3**2 / 12, atol=1e-15)
    whole = np.arange(hoop.size)  # of integers, as a test of one's own may have it
    np.testing.assert_array_equal(bending_stress(ring, whole), bending_stress(ring, whole.astype(float)))


def test_the_grid_orders_every_node():
    ring = ring_mesh(0.9, 1.0, 24, 2)
    np.testing.assert_array_equal(np.sort(ring.grid.ravel()), np.arange(len(ring.points)))
    np.testing.assert_array_equal(ring.grid[-1], ring.rim_nodes)
    np.testing.assert_array_equal(ring.grid[0], ring.inner_nodes)
    assert (ring.theta[ring.grid] == ring.rim_theta).all()
    assert (np.diff(ring.radius[ring.grid], axis=0) > 0).all()


def test_frames_are_even_without_a_force_and_dense_where_it_changes():
    np.testing.assert_array_equal(frame_times(1.0, 2.0, 5), np.linspace(1, 2, 5))
    t = np.linspace(0, 1, 1001)
    force = np.where(np.abs(t - 0.7) < 0.01, 30.0, 1.0)  # a short pulse
    times = frame_times(0.0, 1.0, 201, t, force)
    assert (np.diff(times) > 0).all()
    assert times[0] == 0
    assert times[-1] == 1
    assert np.diff(times).max() <= 2 / 200 * (1 + 1e-12)  # half the frames are evenly spaced
    assert ((times > 0.68) & (times < 0.72)).sum() >= 100  # the other half is here
    np.testing.assert_array_equal(frame_times(0, 1, 5, t, 0 * t), np.linspace(0, 1, 5))
    unsorted, unknown = ([1.0, 0.5, 0.0], [1.0, 5.0, 0.0]), ([0.0, 1.0], [1.0, np.nan])
    for bad in ((0, 1, 1), (1, 1, 5), (0, np.inf, 5), (0, 1, np.nan), (0, 1, 5, *unsorted), (0, 1, 5, *unknown)):
        with pytest.raises(ValueError, match="cannot be chosen"):
            frame_times(*bad)


def test_frames_follow_how_far_the_force_goes_and_not_for_how_long():
    """Two rises of one height, one nine times as steep: each gets half of the frames that follow the force."""
    t, force = np.array([0.0, 0.1, 1.0]), np.array([0.0, 1.0, 2.0])
    times = frame_times(0.0, 1.0, 1001, t, force, share=0.8)
    assert (times < 0.1).mean() == pytest.approx(0.2 * 0.1 + 0.8 / 2, abs=2e-3)  # a frame more or less at either end
