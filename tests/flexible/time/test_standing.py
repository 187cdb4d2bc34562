"""A rigid ring that stands on its patch, the disk lowest, and moves up and down: bounce and damping in closed form.

With the penetration delta, N = (4/3) eps delta sqrt(2 delta) and the energy (8 sqrt(2)/15) eps delta^(5/2), R = g = 1.
The patches have 96 points, whose force is off by some 1e-3 (test_contact_alone); the ring's E I is 1e9 m g R^2.
"""

from math import pi, sqrt

import numpy as np
import pytest
from scenes import HOOP, flying, steps_of
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from flexible import simulate
from flexible.models.reduced import ReducedHoop
from flexible.models.rim_contact import relaxation_time
from flexible.start.equilibrium import equilibrium
from flexible.start.pose import Pose
from flexible.time.adaptive import restart
from rigid import Kind, load_scene

EPS = 1e6


def hoop_of(mass, damping):
    scene = HOOP.replace(
        hoop={"mass_ratio": mass}, contact={"stiffness": EPS, "damping": damping}, ring={"bending_stiffness": 1e9}
    )
    return ReducedHoop(scene, points=96)


def force(depth):
    return 4 / 3 * EPS * sqrt(2) * depth**1.5


@pytest.mark.parametrize("mass", [0.0, 4.0])
@pytest.mark.parametrize("ratio", [0.05, 0.2])
def test_damping_ratio_by_logarithmic_decrement(mass, ratio):
    """Under M g and with the mass M of disk and hoop: N - M g falls by exp(-2 pi zeta/sqrt(1 - zeta^2)) in a period.

    Kicked by 1 % of the sag: what is not linear is of that size, squared; a step loses (omega h)^4, 1e-7.
    """
    hoop, weight = hoop_of(mass, ratio), 1 + mass
    sag = brentq(lambda d: force(d) - weight, 0, 1)
    period = 2 * pi * sqrt(weight / (1.5 * weight / sag))  # k = dN/ddelta = 3 N/(2 delta)
    state = equilibrium(hoop, Pose(pi, 0.0, 0.0, weight, 0.0, Kind.ROLL))
    state.vel[1] = -0.01 * sag * 2 * pi / period
    _, records, _ = steps_of(hoop, restart(hoop, state, 0), 3.3 * period, period / 300)
    t, normal = np.array([[r.t, r.normal_force - weight] for r in records]).T
    peaks = [i for i in range(1, len(t) - 1) if normal[i - 1] < normal[i] >= normal[i + 1] and normal[i] > 0]
    decrement = np.mean(np.log(normal[peaks[:-1]] / normal[peaks[1:]]))
    assert len(peaks) >= 3
    assert decrement == pytest.approx(2 * pi * ratio / sqrt(1 - ratio**2), rel=0.01)
    assert np.diff(t[peaks]) == pytest.approx(period / sqrt(1 - ratio**2), rel=0.01)


def bounce(damping, speed=0.1):
    """The records of a fall on the floor with a speed, from just above it."""
    hoop = hoop_of(0.0, damping)
    pos, vel = np.array([0.0, 1e-9, pi]), np.array([0.0, -speed, 0.0])
    return steps_of(hoop, restart(hoop, flying(hoop, pos, vel), 0), 0.03, 1e-5)[1]


def test_bounce_of_a_rigid_ring_against_quadrature():
    """Undamped: speed from the energy, largest force where it is 0, time in contact from the integral of 1/speed."""
    speed = 0.1

    def square(depth):
        return speed**2 + 2 * (depth - 8 * sqrt(2) / 15 * EPS * depth**2.5)

    deepest = brentq(square, 1e-6, 1e-2)
    # delta = deepest sin(x): no singularity at the turn
    half = quad(lambda x: deepest * np.cos(x) / sqrt(square(deepest * np.sin(x))), 0, pi / 2 * (1 - 1e-7))[0]
    records = bounce(0.0, speed)
    t, normal = np.array([[r.t, r.normal_force] for r in records]).T
    inside = t[normal > 0]
    assert normal.max() == pytest.approx(force(deepest), rel=3e-3)
    assert inside[-1] - inside[0] == pytest.approx(2 * half, rel=3e-3)  # the step is 1e-3 of it
    assert records[-1].normal_impulse == pytest.approx(2 * speed + 2 * half, rel=3e-3)  # momentum: 2 M v + M g t


def test_damping_loss_of_a_bounce_against_an_integration():
    """delta'' = 1 - N (1 + 1.5 theta delta'/delta), never pulling; the loss is the integral of the damper's power."""
    theta = relaxation_time(hoop_of(0.0, 0.3).scene)

    def rates(t, y):
        depth, speed, _ = y
        elastic = force(max(depth, 0.0))
        damper = max(1.5 * theta * speed * 4 / 3 * EPS * sqrt(2 * max(depth, 0.0)), -elastic)
        return [speed, 1 - elastic - damper, damper * speed]

    def off(t, y):
        return y[0]

    off.terminal, off.direction = True, -1
    exact = solve_ivp(rates, (0, 0.1), [1e-12, 0.1, 0.0], events=off, rtol=1e-10, atol=1e-14).y[:, -1]
    records = bounce(0.3)
    assert records[-1].damping_loss == pytest.approx(exact[2], rel=3e-3)
    assert records[-1].friction_loss == pytest.approx(0, abs=1e-12)
    leaving = next(r for r in records if r.contact_spring == 0 and r.t > 0.002)
    assert leaving.vertical_velocity == pytest.approx(-exact[1], rel=5e-3)


def test_a_patch_that_its_damper_lets_go_of_is_off_the_floor():
    """No force is no contact, whether its springs are still pressed or not: some 70 steps of 1e-5 here."""
    records = bounce(0.3)
    t = np.array([r.t for r in records])
    off = np.array([r.normal_force == 0 for r in records])
    pressed = off & np.array([r.contact_spring > 0 for r in records])
    assert pressed.sum() > 20
    assert records[-1].off_floor == pytest.approx(np.diff(t)[off[1:]].sum(), abs=3e-5)  # its edges lie within steps


@pytest.mark.parametrize("integrator", ["tr-bdf2", "esdirk3", "esdirk4"])
def test_the_time_off_the_floor_is_a_part_of_each_step(integrator):
    """None of those in which the hoop is down, all of those in which it is up, and a part of those between.

    Summed up with weights of which one is negative, a step of esdirk3 in which the hoop lands has -0.16 to 1.16 of it.
    """
    scene = load_scene("paper-3.3-light").replace(
        ring={"bending_stiffness": 60.0},
        contact={"damping": 0.0},
        solve={"integrator": integrator},
        run={"until": "pulse"},
    )
    (pulse,) = (motion := simulate(scene, history=True)).pulses
    segment = next(piece.segment for piece in motion.sample.pieces if piece.segment is not None)
    length, off = np.diff(segment["t"]), np.diff(segment["off_floor"])
    up = segment["normal_force"] == 0
    assert (off >= 0).all()
    assert (off <= length * (1 + 1e-9) + 1e-15).all()
    assert off[up[1:] & up[:-1]] == pytest.approx(length[up[1:] & up[:-1]])
    assert 0 < off.sum() == pytest.approx(pulse.time_off_floor)
    assert ((off > 0) & (off < 0.999 * length)).any()
