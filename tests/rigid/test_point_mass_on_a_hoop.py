"""A particle on a thin hoop with mass, in closed form: gamma = m/(m + m_h), K = 1 - gamma^2, e = gamma (k = 0, r = 1).

Rolling from the top with u0 = omega0^2 R/g: with x = 1 + gamma cos phi and C = (1 + gamma)(1 + u0) the energy integral
gives phidot^2 = C/x - 1 and N = x - C/2 + C (1 - gamma^2)/(2 x^2) over M g. N is least at x^3 = C (1 - gamma^2), where
it is (3 x - C)/2: it vanishes nowhere on the way iff C^2 < 27 (1 - gamma^2).
"""

from __future__ import annotations

from math import atan, cos, pi, radians, sin, sqrt

import numpy as np
import pytest

from rigid import Friction, Hoop, Kind, Release, Run, Scene, rolling_mu_s, simulate

ROUGH = Friction(1e6, 1e6)


def hoop_of(gamma):
    return Hoop(0.0, 1.0, 1 / gamma - 1)


@pytest.mark.parametrize("gamma", [0.2, 0.5, 0.8])
def test_the_constants_are_exact(gamma):
    hoop = hoop_of(gamma)
    assert (hoop.e, hoop.K) == pytest.approx((gamma, 1 - gamma**2), rel=1e-14)


@pytest.mark.parametrize(("gamma", "u0"), [(0.3, 0.5), (0.7, 0.2), (0.9, 0.1), (0.5, 1.0)])
def test_normal_force_in_closed_form(gamma, u0):
    """One revolution over a rough floor; round-off of forces of a few M g."""
    hoop = hoop_of(gamma)
    motion = simulate(Scene(hoop, ROUGH, Release(0.0, sqrt(u0)), Run(t_end=5.0)))
    assert [phase.kind for phase in motion.phases] == [Kind.ROLL]
    states = motion.at(np.linspace(0, 5, 60))
    x, c = 1 + gamma * np.cos(states.phi), (1 + gamma) * (1 + u0)
    normal = x - c / 2 + c * (1 - gamma**2) / (2 * x**2)
    assert states.normal_force / (hoop.m * (1 + hoop.mass_ratio)) == pytest.approx(normal, abs=1e-11)
    assert states.omega**2 == pytest.approx(c / x - 1, abs=1e-11)


@pytest.mark.parametrize("u0", [0.0, 0.3, 1.0, 1.9])
def test_threshold_of_a_normal_force_that_never_vanishes(u0):
    """gamma = (27 - (1 + u0)^2)/(27 + (1 + u0)^2); from rest a particle of 13 times the hoop's mass."""
    threshold = (27 - (1 + u0) ** 2) / (27 + (1 + u0) ** 2)
    if u0 == 0.0:
        assert 1 / (1 / threshold - 1) == pytest.approx(13, rel=1e-14)
    # from rest it must leave the top: phi0 = 1e-6 changes C by 1e-12
    release = Release(0.0, sqrt(u0)) if u0 else Release(1e-6)
    assert np.isfinite(rolling_mu_s(hoop_of(threshold * (1 - 1e-8)), release))
    assert np.isinf(rolling_mu_s(hoop_of(threshold * (1 + 1e-8)), release))


@pytest.mark.parametrize("gamma", [0.5, 0.8, 0.95])
def test_hop_at_the_instant_of_release(gamma):
    """Thrown over the top so fast that gamma u0 > 1, the hoop leaves the floor at once, rough or smooth."""
    for factor, leaves in ((1 - 1e-9, False), (1 + 1e-9, True)):
        for friction in (ROUGH, Friction(0.0, 0.0)):
            release = Release(0.0, sqrt(factor / gamma))
            first = simulate(Scene(hoop_of(gamma), friction, release, Run(t_end=0.1))).phases[0]
            assert (first.kind == Kind.FLIGHT) == leaves


def test_slip_of_a_small_disk_starts_where_that_of_a_particle_does():
    """Massless hoop, k -> 0: |F|/N -> tan(phi/2), so slip starts at 2 arctan mu_s, up to a term linear in k.

    e = 1 - k and K = k^2/2, so the angle is a power series in k: a tenth of k leaves a tenth of the distance, to O(k).
    """
    exact = 2 * atan(0.35)
    distance = [
        simulate(Scene(Hoop(k), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1))).phases[0].phi_end - exact
        for k in (1e-3, 1e-4, 1e-5)
    ]
    assert distance[0] / distance[1] == pytest.approx(10, rel=2e-2)
    assert distance[1] / distance[2] == pytest.approx(10, rel=2e-3)


@pytest.mark.parametrize("instants", [7, 30_000])  # interpreted, and compiled
def test_a_point_mass_beside_its_turn(instants):
    """sin(phi/2) = S cosh(t/2) + 2 V sinh(t/2) before a turn and after it, at as many instants as are asked for."""
    phi0, omega0 = pi / 2, -0.5623704832474928
    motion = simulate(Scene(Hoop(0.0), Friction(1.2, 1.0), Release(phi0, omega0)))
    rolls = motion.phases[0]
    (turn,) = (turn for turn in motion.turns if turn.t < rolls.t_end)
    assert 0.4 * rolls.t_end < turn.t < 0.6 * rolls.t_end
    states = motion.at(np.linspace(0, rolls.t_end, instants))
    start, rate = sin(phi0 / 2), cos(phi0 / 2) * omega0 / 2
    phi = 2 * np.arcsin(start * np.cosh(states.t / 2) + 2 * rate * np.sinh(states.t / 2))
    assert states.phi == pytest.approx(phi, abs=1e-14)
    omega = (start * np.sinh(states.t / 2) + 2 * rate * np.cosh(states.t / 2)) / np.cos(phi / 2)
    assert states.omega == pytest.approx(omega, abs=1e-14)
    assert np.ptp(states.energy) < 1e-14
