"""The time of a pulse and the frequencies in it; the stiffness at which the ring's slowest vibration is one of them."""

from __future__ import annotations

from math import cos, exp, pi, radians, sqrt

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.linalg import eigvalsh, null_space

from flexible.ring.choice import ring_of
from rigid import Friction, Hoop, Release, Run, Scene, load_scene, simulate
from studies.hop.rolling.rule import scales_of, slowest_period
from studies.hop.rolling.scaling import LEFT, SYMMETRIC, foreseen, pulse_time, relief, suddenness


def rolling(k: float, mass_ratio: float, phi0: float = 10.0) -> Scene:
    """Friction for a roll without a slip."""
    return Scene(Hoop(k=k, r=1.02, mass_ratio=mass_ratio), Friction(50, 50), Release(radians(phi0)), Run(t_end=12.0))


@pytest.mark.parametrize(("k", "mass_ratio"), [(0.1, 0.1), (0.3, 0.1), (0.1, 0.02)])
def test_the_spectrum_of_a_pulse_falls_with_its_time(k, mass_ratio):
    """N goes like (t - i t*)^(-4/3) at its singularity, so its transform like omega^(1/3) exp(-omega t*).

    By trapezoids over a window that is smooth itself, from omega t* = 4 on, where what the window cuts is below 1 % of
    the transform; there the next power of 1/(omega t*) changes the slope by some per cents.
    """
    scene = rolling(k, mass_ratio)
    motion, width = simulate(scene), pulse_time(scene)
    t = np.linspace(0, 12, 20001)
    bottom = t[np.argmax(motion.at(t).omega)]
    u = np.linspace(-12, 12, 8001) * width
    force = motion.at(bottom + u).normal_force * np.exp(-((u / (5 * width)) ** 4))
    omega = np.linspace(4, 8, 9) / width
    transform = np.abs([trapezoid(force * np.cos(w * u), u) for w in omega])
    slope = np.polyfit(omega * width, np.log(transform / omega ** (1 / 3)), 1)[0]
    assert slope == pytest.approx(-1, abs=0.05)


@pytest.mark.parametrize("phi0", [0.1, 80.0])
def test_the_time_of_a_light_ring_is_pi_zeta_over_8_cos(phi0):
    """phidot^2 = 4 cos(phi0/2)^2/(zeta + psi^2) about the bottom, so t* = pi zeta/(8 cos(phi0/2)), but for zeta^2."""
    scene = rolling(0.1, 0.02, phi0=phi0)
    zeta = scene.hoop.constants.zeta
    assert zeta < 0.1
    assert pulse_time(scene) == pytest.approx(pi * zeta / 8 / cos(radians(phi0) / 2), rel=zeta)


def test_at_the_suddenness_the_slowest_vibration_turns_by_one_radian_in_it():
    scene = rolling(0.1, 0.1)
    sudden = scene.replace(ring={"bending_stiffness": suddenness(scene)})
    assert 2 * pi / slowest_period(sudden) * pulse_time(sudden) == pytest.approx(1.0)
    four = scene.replace(ring={"bending_stiffness": 4 * suddenness(scene)})
    assert slowest_period(four) == pytest.approx(slowest_period(sudden) / sqrt(4))


def test_the_slowest_symmetric_vibration_beside_the_antisymmetric_one():
    """About a weld that is held, by a Fourier series of the thin inextensional ring held at a point, tangential
    v = sum of sines (symmetric) or cosines, radial w = v', energy of w + w''; its error falls like the number of
    terms, 2e-3 for 400, and is extrapolated. The weld of 3 degrees and a wall of 2 % change it by less than 1 %.
    """

    def slowest(stiffness, mass, held):
        """Of diagonal stiffness and mass under homogeneous conditions, each a row of ``held``."""
        scale = 1 / np.sqrt(mass)
        allowed = null_space(held * scale)
        return sqrt(eigvalsh(allowed.T * (stiffness * scale**2) @ allowed)[0])

    def ratio(terms):
        n = np.arange(terms + 1.0)
        bending, inertia = (n * (n**2 - 1)) ** 2, 1 + n**2
        symmetric = slowest(bending[1:], inertia[1:], n[None, 1:])
        inertia[0] = 2  # the mean square of a constant
        return symmetric / slowest(bending, inertia, np.stack([np.ones_like(n), (n**2 - 1) / terms]))

    thin = 2 * ratio(400) - ratio(200)
    (first, second), shapes = ring_of(rolling(0.1, 0.1)).modes(2)
    assert sqrt(second / first) == pytest.approx(thin, rel=0.01)
    ring = ring_of(rolling(0.1, 0.1))
    along = ring.mass[ring.free] @ ring.translation(0)  # the weld lies on the axis of y1
    assert abs(along @ shapes[:, 1]) > 0.5
    assert abs(along @ shapes[:, 0]) < 1e-6  # antisymmetric


def test_what_is_foreseen_is_where_the_amplitude_is_the_least_normal_force():
    """By the rigid hoop's own forces, sampled over its run, and the ring's own frequencies (within what a wall of 2 %
    and a weld of 3 degrees change of the thin ring's ratio, 1 %, twice that in the stiffness)."""
    scene = Scene(Hoop(k=0.1, r=1.02, mass_ratio=0.1), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1))
    motion = simulate(scene)
    t = np.linspace(0, motion.t_end, 200001)
    states = motion.at(t)
    behind = states.normal_force[(states.phi > motion.pulses[0].phi_end) & (t > motion.pulses[0].t_end)]
    fall, wait = relief(scene)
    assert fall == pytest.approx(states.normal_force.max() / behind.min(), rel=1e-3)
    least, bottom = t[states.normal_force == behind.min()][0], np.interp(pi, states.phi, t)  # up to the turn phi grows
    assert wait == pytest.approx(least - bottom, abs=2e-3)
    at = scene.replace(ring={"bending_stiffness": foreseen(scene)})
    vibration = SYMMETRIC * 2 * pi / slowest_period(at) * pulse_time(at)
    assert exp(LEFT - vibration) * states.normal_force.max() == pytest.approx(behind.min(), rel=1e-3)
    (first, second), _ = ring_of(at).modes(2)
    assert sqrt(second / first) == pytest.approx(SYMMETRIC, rel=0.01)
    assert foreseen(scene.replace(hoop={"mass_ratio": 0.0})) is None


@pytest.mark.parametrize("phi0", [-10.0, 350.0, 370.0])
def test_a_release_is_its_mirror_image_and_turns_that_are_over_do_not_count(phi0):
    assert relief(rolling(0.1, 0.1, phi0)) == pytest.approx(relief(rolling(0.1, 0.1, 10.0)), rel=1e-6)


def test_a_damped_vibration_is_foreseen_less_by_the_time_it_has_to_fall():
    """An oscillator that a roll's N drives, q'' + 2 ratio w q' + w^2 q = N, by quadrature: what is left of it a
    time behind the bottom falls with the ratio like exp(-ratio w wait), and so does the stiffness foreseen.

    w t* = 6, the ratio 0.02: the next power of the ratio is 0.02 w t*, a tenth of what the fall is.
    """
    scene = rolling(0.1, 0.1)
    motion, ratio, wait = simulate(scene), 0.02, 1.0
    t = np.linspace(0, 12, 20001)
    bottom = t[np.argmax(motion.at(t).omega)]
    w = 6 / pulse_time(scene)
    u = np.linspace(-40 / w, wait, 80001)
    force = motion.at(bottom + u).normal_force * (0.5 - 0.5 * np.tanh((np.abs(u) - 0.7) / 0.05))

    def amplitude(damped: float) -> float:
        kernel = np.exp((-damped * w - 1j * w * sqrt(1 - damped**2)) * (wait - u))
        return float(abs(trapezoid(force * kernel, u)))

    assert np.log(amplitude(ratio) / amplitude(0.0)) == pytest.approx(-ratio * w * wait, rel=0.15)
    slips = scene.replace(friction={"mu_s": 0.35, "mu": 0.3})
    (_, wait), time = relief(slips), pulse_time(slips)
    assert foreseen(slips, ratio) == pytest.approx(foreseen(slips) / (1 + ratio * wait / time) ** 2)


def test_a_ring_without_mass_has_no_vibration_to_leave():
    assert suddenness(rolling(0.1, 0.0)) == 0.0


@pytest.mark.parametrize("mass_ratio", [0.0, 5.0])
def test_the_depth_that_flights_are_measured_by_is_that_under_disk_and_hoop(mass_ratio):
    """Winkler: N = 4/3 eps delta sqrt(2 delta)."""
    scene = load_scene("paper-3.3-heavier").replace(hoop={"mass_ratio": mass_ratio}, contact={"stiffness": 1e6})
    depth = scales_of(scene, 0.0).depth
    assert 4 / 3 * 1e6 * depth * (2 * depth) ** 0.5 == pytest.approx(1 + mass_ratio)
