"""A particle of mass m on a thin hoop of mass m_h, in closed form: gamma = m/(m + m_h), k = 0, r = 1.

Thrown over the top with u0 = omega0^2 R/g it rolls; with x = 1 + gamma cos phi and C = (1 + gamma)(1 + u0)

    phidot^2 = C/x - 1,    N/(M g) = x - C/2 + C (1 - gamma^2)/(2 x^2).

N is least where x^3 = C (1 - gamma^2), so it vanishes nowhere iff C^2 < 27 (1 - gamma^2).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import asinh, atan, degrees, inf, isinf, sqrt

import numpy as np

from rigid import Friction, Hoop, Kind, Release, Run, Scene, load_scene, rolling_mu_s, simulate

from .row import Row

ROUGH = Friction(1e6, 1e6)
DERIVED = "derived, studies.validate.point_mass"
ROUND_OFF = "round-off of forces of a few M g over a revolution"


def hoop_of(gamma: float) -> Hoop:
    """A thin hoop with a particle that has the share ``gamma`` of all mass."""
    return Hoop(0.0, 1.0, 1 / gamma - 1)


def rows() -> Iterator[Row]:
    """Forces, thresholds, hop and slip."""
    yield from _forces()
    yield from _massless()
    yield from _thresholds()
    yield from _hops()
    yield from _slips()


def _forces() -> Iterator[Row]:
    for gamma, u0 in ((0.3, 0.5), (0.7, 0.2), (0.9, 0.1)):
        hoop = hoop_of(gamma)
        states = simulate(Scene(hoop, ROUGH, Release(0.0, sqrt(u0)), Run(t_end=5.0))).at(np.linspace(0, 5, 60))
        x, c = 1 + gamma * np.cos(states.phi), (1 + gamma) * (1 + u0)
        normal = x - c / 2 + c * (1 - gamma**2) / (2 * x**2)
        found = states.normal_force / (1 + hoop.mass_ratio)
        worst = int(np.argmax(np.abs(found - normal)))
        what = f"N/(M g) where it is furthest off in a revolution, gamma = {gamma}, u0 = {u0}"
        yield Row(DERIVED, what, float(normal[worst]), float(found[worst]), 1e-11, ROUND_OFF)


def _massless() -> Iterator[Row]:
    """Without a hoop's mass: thrown from the top N/(m g) = cos phi - u0, from rest 2 cos^2(phi/2) - cos^2(phi0/2)."""
    thrown = simulate(Scene(Hoop(0.0), ROUGH, Release(0.0, 0.3), Run(t_end=3.0)))
    state = thrown.at(3.0)
    value = float(np.cos(state.phi)) - 0.09
    yield Row(DERIVED, "N/(m g) without a hoop's mass, u0 = 0.09", value, float(state.normal_force), 1e-12, "round-off")
    released = simulate(load_scene("paper-point-mass"))
    state = released.at(0.9 * released.phases[0].t_end)
    value = float(2 * np.cos(state.phi / 2) ** 2 - np.cos(released.scene.release.phi0 / 2) ** 2)
    what = "N/(m g) of a point mass, nine tenths of its rolling"
    yield Row("Lubarda 2009, sec. 2.3", what, value, float(state.normal_force), 1e-12, "round-off")


def _thresholds() -> Iterator[Row]:
    """Particle over hoop up to which N vanishes nowhere on the way."""
    for u0, said in ((0.0, "from rest"), (0.3, "u0 = 0.3"), (1.0, "u0 = 1")):
        gamma = (27 - (1 + u0) ** 2) / (27 + (1 + u0) ** 2)
        release = Release(0.0, sqrt(u0)) if u0 else Release(1e-6)

        def lifts(ratio: float, release: Release = release) -> bool:
            return isinf(rolling_mu_s(Hoop(0.0, 1.0, 1 / ratio), release))

        value = gamma / (1 - gamma)
        why = "bisected to 1e-9; from rest it leaves 1e-6 off the top, which is 1e-12 of the energy"
        found = _switch(lifts, 0.5 * value, 2 * value)
        yield Row(DERIVED, f"m/m_h above which N vanishes, {said}", value, found, 1e-8, why)


def _hops() -> Iterator[Row]:
    """Thrown so fast that the hoop leaves the floor at once: gamma u0 = 1."""
    for gamma in (0.5, 0.8):

        def leaves(u0: float, gamma: float = gamma) -> bool:
            scene = Scene(hoop_of(gamma), ROUGH, Release(0.0, sqrt(u0)), Run(t_end=0.1))
            return simulate(scene).phases[0].kind == Kind.FLIGHT

        what = f"omega0^2 R/g above which it hops at release, gamma = {gamma}"
        yield Row(DERIVED, what, 1 / gamma, _switch(leaves, 0.5 / gamma, 2 / gamma), 1e-8, "bisected to 1e-9")


def _slips() -> Iterator[Row]:
    """Without a hoop's mass |F|/N = tan(phi/2), whatever the velocity."""
    for mu_s in (0.2, 0.35, 0.7):
        motion = simulate(Scene(Hoop(0.0), Friction(mu_s, mu_s), Release(0.0, 0.3), Run(t_end=10.0)))
        what = f"angle where a particle on a massless hoop slips, in degrees, mu_s = {mu_s}"
        found = degrees(motion.phases[0].phi_end)
        yield Row(DERIVED, what, degrees(2 * atan(mu_s)), found, 1e-9, "round-off of an angle of 100 degrees")
    motion = simulate(load_scene("paper-point-mass"))
    phi0, end = motion.scene.release.phi0, 2 * atan(0.35)
    # sin(phi/2) = sin(phi0/2) cosh(t/2)
    ratio = np.sin(end / 2) / np.sin(phi0 / 2)
    value = 2 * asinh(sqrt(ratio**2 - 1))
    yield Row(
        "Lubarda 2009, sec. 2.3", "time from 10 degrees to the slip at 2 arctan 0.35", value, motion.phases[0].t_end,
        1e-12, "round-off",
    )  # fmt: skip


def _switch(holds: Callable[[float], bool], low: float, high: float) -> float:
    """Where something begins to hold, by bisection; infinite if it does not between the bounds."""
    if holds(low) or not holds(high):
        return inf
    while high - low > 1e-9 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return (low + high) / 2
