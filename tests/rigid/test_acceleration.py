"""phiddot of a rigid motion: against the balance of moments, against phidot, and on both sides of every event."""

from __future__ import annotations

from itertools import pairwise
from math import radians

import numpy as np
import pytest
from hypothesis import example, given, settings
from strategies import scenes

from rigid import Friction, Hoop, Kind, Release, Run, Scene, load_scene, scene_names, simulate

PAPER = [name for name in scene_names() if name.startswith("paper")]


def moments(motion, states):
    """phiddot from the forces: N and F about the mass centre, over its moment of inertia."""
    hoop = motion.scene.hoop
    turning = states.normal_force * hoop.e * np.sin(states.phi) - states.friction_force * (
        1 + hoop.e * np.cos(states.phi)
    )
    return turning / (hoop.K * (1 + hoop.mass_ratio))


@settings(max_examples=40, deadline=None)
@given(scenes())
@example(Scene(Hoop(1 / 64, 2.0), Friction(1.0, 1.0), Release(1.625, 4.0)))  # goes round two thousand times
@example(Scene(Hoop(0.001, 1.5), Friction(1.0, 1.0), Release(0.0, 1.0), Run(turns=2)))  # ends as it lands, N = 1e-6
def test_balance_of_moments(scene):
    """In every phase of any scene; the two moments may cancel to round-off over the inertia, and so may N of what it
    is made of, the weight and the centrifugal force of the disk."""
    motion = simulate(scene)
    hoop = scene.hoop
    if hoop.K > 1e-100:  # a point mass has no inertia about itself: tested below
        states = motion.at(np.linspace(0, motion.t_end, 60))
        inertia = hoop.K * (1 + hoop.mass_ratio)
        terms = (np.abs(states.normal_force) * hoop.e + np.abs(states.friction_force) * 2) / inertia
        # the angle itself is rounded, and sin phi with it: a hoop that goes round has gone thousands of radians
        rounded = 1e-12 + 4 * np.spacing(np.abs(states.phi))
        cancelled = 4 * np.spacing(1 + states.omega**2) / inertia
        assert (np.abs(states.alpha - moments(motion, states)) <= rounded * (1 + terms) + cancelled).all()


@pytest.mark.parametrize("name", [*PAPER, "flight"])
def test_slope_of_phidot(name):
    """Differences of phidot over 1e-4 of each phase, by Richardson's rule: 1e-8 of its scale and round-off."""
    if name == "flight":
        scene = Scene(Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(0.5, 3.0), Run(t_end=6.0))
    else:
        scene = load_scene(name)
    motion = simulate(scene)
    if name == "flight":
        assert Kind.FLIGHT in {phase.kind for phase in motion.phases}
    for phase in motion.phases:
        length = phase.t_end - phase.t_start
        if length < 1e-6:
            continue
        t = phase.t_start + length * np.array([0.2, 0.5, 0.8])
        h = 1e-4 * length
        omega = [motion.at(t + shift * h).omega for shift in (-1, -0.5, 0.5, 1)]
        slope = (8 * (omega[2] - omega[1]) - (omega[3] - omega[0])) / (6 * h)
        scale = np.abs(motion.at(phase.t_start + length * np.linspace(0.01, 0.99, 99)).omega).max()
        assert motion.at(t).alpha == pytest.approx(slope, rel=1e-5, abs=1e-9 * (1 + scale) / length)


@pytest.mark.parametrize("R", [1.0, 0.137])
def test_both_sides_of_an_event(R):
    """Forces and phiddot jump where phases meet; each side has those of its own phase, in SI units too."""
    scene = load_scene("paper-3.1").replace(hoop={"R": R, "m": 0.7 if R != 1 else 1.0, "g": 9.81 if R != 1 else 1.0})
    motion = simulate(scene.replace(run={"turns": 6}))
    mu, mu_s = scene.friction.mu, scene.friction.mu_s
    seen = set()
    for before, after in pairwise(motion.phases):
        t = after.t_start
        left, right = motion.at(t, "left"), motion.at(t)
        assert (motion.phase_at(t, "left"), motion.phase_at(t)) == (before, after)
        assert float(left.omega) == pytest.approx(float(right.omega), rel=1e-9)
        assert float(left.slip_velocity) == pytest.approx(0, abs=1e-9 * scene.velocity_unit)
        for state, phase in ((left, before), (right, after)):
            ratio = float(state.friction_force / state.normal_force)
            if phase.kind == Kind.ROLL:
                assert abs(ratio) <= mu_s * (1 + 1e-9)
            else:
                assert ratio == pytest.approx(mu if phase.kind == Kind.SPIN else -mu, rel=1e-12)
        if before.kind == Kind.ROLL:  # rolls up to where friction can hold no more
            assert abs(float(left.friction_force / left.normal_force)) == pytest.approx(mu_s, rel=1e-8)
        assert abs(float(left.alpha - right.alpha)) > 1e-3 * abs(float(right.alpha))
        seen.add((before.kind, after.kind))
    assert {(Kind.ROLL, Kind.SPIN), (Kind.SPIN, Kind.ROLL), (Kind.ROLL, Kind.SKID)} <= seen


def test_ends_have_no_other_side():
    motion = simulate(load_scene("paper-3.2-k0.25"))
    for t in (0.0, motion.t_end):
        assert float(motion.at(t, "left").alpha) == pytest.approx(float(motion.at(t).alpha), rel=1e-12)


def test_a_point_mass():
    """Rolling, S = sin(phi/2) obeys S'' = S/4, so phiddot cos(phi/2)/2 = S (1 + phidot^2)/4; skimming it falls."""
    scene = load_scene("paper-point-mass")
    motion = simulate(scene)
    roll, skim = motion.phases[:2]
    assert (roll.kind, skim.kind) == (Kind.ROLL, Kind.SKIM)
    states = motion.at(np.linspace(0, roll.t_end, 20), "left")
    sine, cosine = np.sin(states.phi / 2), np.cos(states.phi / 2)
    assert states.alpha * cosine / 2 - sine * states.omega**2 / 4 == pytest.approx(sine / 4, rel=1e-12)
    states = motion.at(np.linspace(skim.t_start, skim.t_start + 0.9 * (skim.t_end - skim.t_start), 20))
    fall = -np.sin(states.phi) * states.alpha - np.cos(states.phi) * states.omega**2
    assert fall == pytest.approx(-1.0, rel=1e-9)


def test_units():
    """phiddot is in radians over the square of the unit of time."""
    scene = Scene(Hoop(0.1, R=0.3, g=9.81), Friction(0.35, 0.3), Release(radians(10)))
    plain = simulate(scene.replace(hoop={"R": 1.0, "g": 1.0}))
    si = simulate(scene)
    t = np.linspace(0, plain.t_end, 30)[1:-1]
    assert si.at(t * scene.time_unit).alpha == pytest.approx(plain.at(t).alpha / scene.time_unit**2, rel=1e-6)
