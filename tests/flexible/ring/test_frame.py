"""The floating frame: tangents, power, momentum in free flight; the same of modes and of all nodes."""

import numpy as np
import pytest
from scenes import HOOP, energy, flying, steps_of

from flexible.models.full import FullHoop
from flexible.models.reduced import ReducedHoop
from flexible.ring.frame import energies, inertia
from flexible.ring.nodal import inertia as nodal_inertia
from flexible.time.adaptive import restart

COARSE = HOOP.replace(solve={"elements": 48})


@pytest.fixture(scope="module")
def reduced():
    return ReducedHoop(COARSE, modes=6)


@pytest.fixture(scope="module")
def full():
    return FullHoop(COARSE)


def motion(n, seed=0):
    """Position, velocity, acceleration with everything in motion."""
    rng = np.random.default_rng(seed)
    pos = 0.1 * rng.standard_normal(n)
    pos[2] = 1.1
    return pos, rng.standard_normal(n), rng.standard_normal(n)


def momentum(hoop, pos, vel):
    """Linear momentum (x, y) and angular momentum, clockwise, about the point under C on the undeformed floor."""
    ring = hoop.ring
    d, disk_inertia, mass, moment = ring.frame.body
    _, l1, l2, rotation, stretching = ring.frame.modal.T
    s, c = np.sin(pos[2]), np.cos(pos[2])
    w, q, v = vel[2], pos[3:], vel[3:]
    vx, vy = vel[0] + w, vel[1]
    v1, v2 = vx * s + vy * c, vx * c - vy * s
    p1 = (1 + mass) * v1 + l1 @ v - w * (l2 @ q)
    p2 = (1 + mass) * v2 + l2 @ v + w * (l1 @ q) + d * w
    about = d * (v2 + d * w) + disk_inertia * w + (l1 @ q) * v2 - (l2 @ q) * v1
    about += w * (moment + 2 * stretching @ q + q @ q) + rotation @ v + v @ (ring.frame.gyro @ q)
    horizontal = p1 * s + p2 * c
    return np.array([horizontal, p1 * c - p2 * s, about + horizontal * (1 + pos[1])])


def test_tangent_of_the_inertia(reduced):
    """Central differences, 1e-6 of the largest entry."""
    ring, beta = reduced.ring, 0.3
    pos, vel, acc = motion(9)

    def force(d):
        return inertia(ring.frame, pos + d, vel + d / beta, acc + d / beta**2, beta)[0]

    tangent = inertia(ring.frame, pos, vel, acc, beta)[1]
    step = 1e-6
    found = np.array([(force(step * e) - force(-step * e)) / (2 * step) for e in np.eye(9)]).T
    assert np.abs(found - tangent).max() < 1e-6 * np.abs(tangent).max()


def test_forces_are_the_rates_of_momentum_and_energy(reduced):
    """d/dt of the momenta, and power = d/dt of the energy, with modes that move as they like.

    The generalised force of phi is the moment about the point of the floor under C: gravity's is taken out.
    """
    ring = reduced.ring
    pos, vel, acc = motion(9)
    force = inertia(ring.frame, pos, vel, acc, 1.0)[0]
    h = 1e-5

    def ahead(e):
        return pos + e * vel + e * e / 2 * acc, vel + e * acc

    rate = (momentum(reduced, *ahead(h)) - momentum(reduced, *ahead(-h))) / (2 * h)
    weight = 1 + ring.frame.body.ring_mass
    assert force[0] == pytest.approx(rate[0], rel=1e-8)
    assert force[1] - weight == pytest.approx(rate[1], rel=1e-8)
    # the point moves with C, h above the undeformed floor's; gravity pulls at the mass centre
    s, c = np.sin(pos[2]), np.cos(pos[2])
    pull = (ring.frame.body.offset + ring.frame.modal[:, 1] @ pos[3:]) * s + ring.frame.modal[:, 2] @ pos[3:] * c
    carried = (vel[0] + vel[2]) * momentum(reduced, pos, vel)[1]
    assert force[2] + pos[1] * force[0] + pull == pytest.approx(rate[2] - carried, rel=1e-7)
    gained = sum(energies(ring.frame, *ahead(h)))
    lost = sum(energies(ring.frame, *ahead(-h)))
    assert force @ vel == pytest.approx((gained - lost) / (2 * h), rel=1e-8)


@pytest.mark.parametrize("soft", [False, True])
def test_all_nodes_have_the_same_inertia_as_modes(reduced, full, soft):
    """Modal forces are Phi^T of the nodal ones, and so are the tangents, for a motion in the modes' span.

    Where the ring's elasticity is next to nothing the smallest of the inertial forces count.
    """
    if soft:
        slack = COARSE.replace(ring={"bending_stiffness": 1e-6})
        reduced, full = ReducedHoop(slack, modes=6), FullHoop(slack)
    ring = reduced.ring
    shapes = ring.ring.modes(6)[1] / np.sqrt(COARSE.hoop.mass_ratio)
    pos, vel, acc = motion(9)
    beta = 0.3
    lifted = [np.concatenate([x[:3], shapes @ x[3:]]) for x in (pos, vel, acc)]
    found = nodal_inertia(full.ring, *lifted, beta)
    force, tangent = inertia(ring.frame, pos, vel, acc, beta)
    scale = np.abs(force).max()
    assert np.abs(found.frame - force[:3]).max() < 1e-9 * scale
    assert np.abs(shapes.T @ found.ring - force[3:]).max() < 1e-9 * scale
    size = np.abs(tangent).max()
    assert np.abs(found.frame_by_frame - tangent[:3, :3]).max() < 1e-9 * size
    assert np.abs(found.frame_by_ring @ shapes - tangent[:3, 3:]).max() < 1e-9 * size
    assert np.abs(shapes.T @ found.ring_by_frame - tangent[3:, :3]).max() < 1e-9 * size


def drift(step, hoop):
    """Free flight with the ring vibrating in its lowest mode: drift of momenta (about the origin) and energy."""
    n = 3 + hoop.coordinates
    pos, vel = np.zeros(n), np.zeros(n)
    pos[:3], vel[:3] = (0.0, 5.0, 2.9), (0.3, 0.2, 4.0)
    vel[3] = 0.05
    start = restart(hoop, flying(hoop, pos, vel), 0)
    _, records, states = steps_of(hoop, start, 0.2, step)
    mass = 1 + hoop.ring.frame.body.ring_mass
    rows = []
    for state in states:
        p = momentum(hoop, state.pos, state.vel)
        # about the origin of the floor, less gravity's impulses (the mass centre moves with p_x/mass)
        s, c = np.sin(state.pos[2]), np.cos(state.pos[2])
        centre = mass * state.x_C + hoop.ring.frame.body.offset * s
        centre += hoop.ring.frame.modal[:, 1] @ state.pos[3:] * s + hoop.ring.frame.modal[:, 2] @ state.pos[3:] * c
        rows.append([p[0], p[1] + mass * state.t, p[2] - state.x_C * p[1], centre])
    rows = np.array(rows)
    t = np.array([state.t for state in states])
    rows[:, 2] -= rows[0, 3] * t + rows[0, 0] * t**2 / 2
    return np.append(np.abs(rows[-1, :3] - rows[0, :3]), abs(energy(records[-1]) - energy(records[0])))


def test_free_flight(reduced):
    """Momentum, angular momentum and energy drift with the integrator's order, two, from small numbers.

    They are kept to the integrator's error, not to round-off: the unknowns are positions in a turning frame.
    """
    steps = np.array([2e-4, 1e-4, 5e-5])
    found = np.array([drift(h, reduced) for h in steps])
    assert found[-1].max() < 1e-5
    for column in found.T:
        assert np.polyfit(np.log(steps), np.log(column), 1)[0] > 1.7
