"""Friction that falls over a distance of slip: which rigid hoop it becomes, by how long that is."""

from math import sqrt

import pytest

from flexible.contact.laws.brush import effective_mu_s
from rigid import load_scene, simulate
from studies.examples.slip_weakening import carried, half_width, limit, ratio, stretch_at_break

SCENE = load_scene("paper-3.3-massless")
MU_S, MU = SCENE.friction.mu_s, SCENE.friction.mu


@pytest.mark.parametrize(("mu_s", "mu"), [(0.35, 0.3), (0.6, 0.3), (0.4, 0.4)])
def test_what_a_rolling_patch_carries_is_the_brushs_at_once_and_mu_s_over_a_long_way(mu_s, mu):
    """The first in closed form, by sums of 2000 points and 600 creeps to 3e-4; the second but for 1/distance."""
    assert carried(0.0, mu_s, mu) == pytest.approx(effective_mu_s(mu_s, mu), rel=5e-4)
    assert carried(1000.0, mu_s, mu) == pytest.approx(mu_s, rel=3e-3)
    between = [carried(distance, mu_s, mu) for distance in (0.0, 0.3, 3.0, 30.0)]
    assert between == sorted(between)


def of_rigid(mu_s, mu=MU):
    return simulate(SCENE.replace(friction={"mu_s": mu_s, "mu": mu})).pulses[0].impulse_ratio


def test_a_law_of_one_coefficient_has_the_rigid_hoop_of_it():
    """Two runs that meet where the hoop sticks are one: but for where the pulse ends, at N = M g, to round-off."""
    assert limit(SCENE, 0.0) == pytest.approx(of_rigid(carried(0.0, MU_S, MU)), rel=1e-9)
    assert limit(SCENE, 1e5) == pytest.approx(of_rigid(MU_S), rel=1e-3)


@pytest.mark.slow
def test_the_limit_is_by_the_distance_beside_bristle_and_patch():
    """Each law comes nearer to its own limit with every decade, and is nearer to it than to any other's at 1e11."""
    distances = {
        "at once": lambda eps: 0.0,
        "bristle": lambda eps: stretch_at_break(SCENE, eps),
        "ten bristles": lambda eps: 10 * stretch_at_break(SCENE, eps),
        "between bristle and patch": lambda eps: sqrt(stretch_at_break(SCENE, eps) * half_width(eps)) / 3,
        "fixed": lambda eps: 1e-4,
    }
    limits = {
        "at once": of_rigid(effective_mu_s(MU_S, MU)),
        "bristle": limit(SCENE, 1.0),
        "ten bristles": limit(SCENE, 10.0),
        "between bristle and patch": of_rigid(MU_S),
        "fixed": of_rigid(MU_S, MU_S),
    }
    for name, distance in distances.items():
        found = [ratio(SCENE, eps, distance(eps)) for eps in (1e8, 1e9, 1e10, 1e11)]
        off = [abs(each - limits[name]) for each in found]
        assert off == sorted(off, reverse=True), name
        assert name == min(limits, key=lambda other: abs(limits[other] - found[-1]))
