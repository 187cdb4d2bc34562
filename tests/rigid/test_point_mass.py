"""A point mass on a hoop without inertia that is set slipping: the limit of ever smaller disks."""

from __future__ import annotations

from math import sin

import numpy as np
import pytest

from rigid import Friction, Hoop, Kind, Release, Run, Scene, simulate

FRICTION = Friction(0.35, 0.3)
#: the angle, phidot and slip velocity of a release, and until when: caught at once, upright, caught on the way up,
#: at rest on the way, slipping down to the floor
SET = {
    "caught": (0.3, 0.0, -1.0, 1.0),
    "upright": (0.0, 0.0, 1.0, 1.0),
    "caught on the way up": (0.65, -0.5, -0.4, 1.0),
    "rolls on": (0.3, 0.0, 1.0, 1.0),
    "rolls on from a rolling spin": (0.3, 0.5, 0.2, 0.7),
    "slips on": (0.9, 0.0, -1.0, 1.0),
}


def run(k, phi0, omega0, slip0, t_end):
    return simulate(Scene(Hoop(k), FRICTION, Release(phi0, omega0, slip0), Run(t_end=t_end)))


@pytest.mark.parametrize("name", SET)
def test_a_point_mass_moves_as_a_tiny_disk(name):
    """What is left of a disk of radius k R goes like k; where it skims, the tiny disk slips with N of that size."""
    point, tiny, small = (run(k, *SET[name]) for k in (0.0, 1e-8, 1e-6))
    times = np.linspace(0.01, 1, 40) * point.t_end
    for key in ("phi", "omega", "x_C", "slip_velocity", "energy"):
        true = getattr(point.at(times), key)
        assert getattr(tiny.at(times), key) == pytest.approx(true, abs=1e-6)
        assert getattr(small.at(times), key) == pytest.approx(true, abs=1e-4)
    grounded = {Kind.SKID: Kind.SKIM, Kind.SPIN: Kind.SKIM}
    long = [grounded.get(p.kind, p.kind) for p in tiny.phases if p.t_end - p.t_start > 1e-6]
    assert [p.kind for p in point.phases if p.t_end > p.t_start] == long


@pytest.mark.parametrize("name", SET)
def test_its_mirror_image_moves_alike(name):
    phi0, omega0, slip0, t_end = SET[name]
    one, other = run(0.0, phi0, omega0, slip0, t_end), run(0.0, -phi0, -omega0, -slip0, t_end)
    assert [p.kind for p in one.phases] == [p.kind for p in other.phases]
    times = np.linspace(0, 1, 30) * one.t_end
    assert one.at(times).phi == pytest.approx(-other.at(times).phi, abs=1e-13)


def test_what_catches_it_takes_the_velocity_along_the_line_to_the_contact():
    """The mass loses the part of its velocity that points along it, v sin(phi/2), and no other."""
    phi0, slip0 = 0.3, -1.0
    motion = run(0.0, phi0, 0.0, slip0, 1.0)
    assert motion.phases[0].kind == Kind.IMPACT
    before, after = (motion.at(0.0, side).energy for side in ("left", "right"))
    lost = (slip0 * sin(phi0 / 2)) ** 2 / 2
    assert motion.at(1.0).energy == pytest.approx(2 * np.cos(phi0 / 2) ** 2 + slip0**2 / 2 - lost, rel=1e-12)
    assert motion.at(0.0, "right").omega == pytest.approx(slip0 / 2, rel=1e-14)
    assert after <= before


@pytest.mark.parametrize("slip0", [1.0, -0.7])
@pytest.mark.parametrize("omega0", [0.0, 0.3, -0.5, 1.0, 1.5, -1.5])
@pytest.mark.parametrize("mu_s", [0.0, 0.3])
def test_right_on_top_of_a_smooth_floor_it_moves_as_a_tiny_disk(mu_s, omega0, slip0):
    """It slides for ever, falls, rolls where its slip has come to 0, or is thrown off: its motion ends where the tiny
    disk's first flight begins."""
    scene = Scene(Hoop(0.0), Friction(mu_s, 0.0), Release(0.0, omega0, slip0), Run(t_end=0.8))
    point, tiny = simulate(scene), simulate(scene.replace(hoop={"k": 1e-8}))
    flights = [p.t_start for p in tiny.phases if p.kind == Kind.FLIGHT]
    assert point.t_end == pytest.approx(flights[0] if flights else 0.8, abs=1e-6)
    if point.t_end:
        times = np.linspace(0.01, 1, 40) * point.t_end
        for key in ("phi", "omega", "x_C", "slip_velocity", "energy"):
            assert getattr(point.at(times), key) == pytest.approx(getattr(tiny.at(times), key), abs=1e-5)
    if omega0 == 0:
        assert np.all(point.at(times).normal_force == 1)


@pytest.mark.parametrize(("phi0", "omega0"), [(-0.6, 1.05), (-0.6, 1.5), (0.6, -1.05), (0.3, 1.2), (-1.2, 1.6)])
def test_it_is_thrown_off_where_a_tiny_disk_is(phi0, omega0):
    """Where cos phi phidot^2 = 1: on the way up, before it is on top, or at once."""
    scene = Scene(Hoop(0.0), Friction(0.0, 0.0), Release(phi0, omega0), Run(t_end=5.0))
    point, tiny = simulate(scene), simulate(scene.replace(hoop={"k": 1e-8}))
    flight = next(p for p in tiny.phases if p.kind == Kind.FLIGHT)
    assert point.t_end == pytest.approx(flight.t_start, abs=1e-6)
    assert point.at(point.t_end).phi == pytest.approx(flight.phi_start, abs=1e-6)
