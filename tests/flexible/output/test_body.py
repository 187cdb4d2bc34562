"""The hoop as a whole: mass centre, spin and shares of the kinetic energy against rigid mechanics; its lowest point."""

from __future__ import annotations

import numpy as np
import pytest

from flexible.contact.points.data import NOTHING, no_bristles
from flexible.models.chain import ChainHoop
from flexible.models.full import FullHoop
from flexible.models.reduced import ReducedHoop
from flexible.models.state import Touching, in_motion
from flexible.output.body import lowest, outline, whole
from flexible.output.interior import interior_of
from meshes import Placement
from rigid import Friction, Hoop, Release, Scene

LEVELS = [ReducedHoop, FullHoop, ChainHoop]


def scene_of(mass_ratio: float) -> Scene:
    scene = Scene(Hoop(k=0.2, r=1.05, mass_ratio=mass_ratio), Friction(0.3, 0.3), Release(0.3))
    return scene.replace(ring={"bending_stiffness": 20.0}, solve={"elements": 48})


def state_of(hoop, phi=2.1, height=0.25, rates=(0.3, -0.7, 1.9)):
    """An undeformed hoop off the floor that moves rigidly: (xdot_C, ydot_C, phidot)."""
    pos, vel = np.zeros((2, 3 + hoop.coordinates))
    pos[1], pos[2] = height, phi
    vel[:3] = rates[0] - rates[2], rates[1], rates[2]
    rim = Touching((0, 0), np.zeros((1, 2)), np.zeros((1, 2)), NOTHING, no_bristles())
    return in_motion(0.0, 0.0, (pos, vel, np.zeros_like(pos)), 0, rim, 0.0)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("mass_ratio", [0.0, 0.4])
def test_a_rigid_motion_has_the_energy_of_its_mass_centre_and_of_its_rotation(level, mass_ratio):
    """G lies e from C towards the disk, and the moment of inertia about it is M K (rigid.scene, (3) and (6)).

    The mesh's area and moments miss the annulus by (element)^4: 48 elements, 1e-6.
    """
    scene = scene_of(mass_ratio)
    hoop = level(scene)
    state = state_of(hoop)
    found = whole(hoop, state)
    e, K, M = scene.hoop.e, scene.hoop.K, 1 + mass_ratio
    phi, omega = 2.1, 1.9
    velocity = (0.3 + omega * e * np.cos(phi), -0.7 - omega * e * np.sin(phi))
    assert found.velocity == pytest.approx(velocity, abs=1e-6)
    assert found.height == pytest.approx(1.25 + e * np.cos(phi), abs=1e-6)
    assert found.spin == pytest.approx(omega, rel=1e-9)
    assert found.translation == pytest.approx(M * (velocity[0] ** 2 + velocity[1] ** 2) / 2, abs=1e-5)
    assert found.rotation == pytest.approx(M * K * omega**2 / 2, abs=1e-5)
    assert abs(found.vibration) < 1e-12 * found.rotation + 1e-13  # round-off of the differences


@pytest.mark.parametrize("level", LEVELS)
def test_what_is_neither_is_never_less_than_nothing(level):
    """The shares add up to the kinetic energy, and of all rigid motions the one taken leaves the least."""
    hoop = level(scene_of(0.4))
    state = state_of(hoop)
    state.vel[3:] = np.random.default_rng(4).normal(size=hoop.coordinates)
    found = whole(hoop, state)
    kinetic = hoop.energies(state)[0]
    assert found.translation + found.rotation + found.vibration == pytest.approx(kinetic, rel=1e-12)
    assert found.vibration > 0
    nearer = state.vel.copy()
    nearer[:3] += 1e-3, 2e-3, -1e-3
    more = whole(hoop, state._replace(vel=nearer))
    assert more.vibration == pytest.approx(found.vibration, rel=1e-9), "a rigid motion more is no vibration"


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("height", [0.25, 0.0, -1e-9])
def test_the_lowest_point_of_a_circle(level, height):
    """The parabola through three of 96 nodes misses a circle's depth by less than (2 pi/96)^4/12 = 1.5e-6."""
    hoop = level(scene_of(0.4))
    state = state_of(hoop, height=height)
    assert lowest(hoop, state) == pytest.approx(height, abs=1.5e-6)
    centre = np.array([0.0, 1 + height])
    assert np.hypot(*(outline(hoop, state) - centre).T) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("phi", [-0.02, 0.02, 2 * np.pi])
def test_the_lowest_point_with_the_disk_on_top(level, phi):
    """There the first of the rim's nodes is as low as the last one."""
    hoop = level(scene_of(0.4))
    assert lowest(hoop, state_of(hoop, phi, height=0.01)) == pytest.approx(0.01, abs=1.5e-6)


@pytest.mark.parametrize("level", [ReducedHoop, FullHoop])
def test_the_outline_is_the_bent_ring_where_the_hoop_is(level):
    """The rim's nodes of the mesh, moved as the interior has it, placed in the world: two ways to one place."""
    hoop = level(scene_of(0.4))
    state = state_of(hoop, phi=2.1, height=0.25)._replace(x_C=3.0)
    state.pos[3:] = 1e-3 * np.random.default_rng(2).normal(size=hoop.coordinates)
    inside = interior_of(hoop)
    mesh = inside.mesh
    moved = mesh.points + inside.displacement([state])[..., 0]
    placed = Placement(2.1, 3.0, 1.25).points(moved[mesh.rim_nodes])
    bent = np.abs(moved - mesh.points).max()
    assert outline(hoop, state) == pytest.approx(placed, abs=1e-9 * bent)


@pytest.mark.parametrize("phi", [0.3, 2.1, 3.0, 5.0])
def test_the_lowest_point_of_a_bent_ring(phi):
    """A chain looks for it around its lowest section: as low as the lowest of all nodes, or lower by their parabola."""
    hoop = ChainHoop(scene_of(0.4))
    state = state_of(hoop, phi)
    shapes = hoop.ring.shape.shapes
    for shape in range(6):
        state.pos[3:] = 0.02 * shapes[:, shape]
        node = outline(hoop, state)[:, 1].min()
        assert node - 3e-3 < lowest(hoop, state) <= node + 1e-12
