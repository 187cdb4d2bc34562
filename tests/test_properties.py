"""What holds for any scene, searched by hypothesis: mirror, units, restart, energy, bounds; and what a file may say."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from strategies import scenes

from rigid import (
    Contact,
    Friction,
    Hoop,
    Kind,
    Landing,
    Release,
    Ring,
    Run,
    Scene,
    Solve,
    scene_from_dict,
    simulate,
    simulate_batch,
)  # fmt: skip
from rigid.elastic import LAWS
from studies.stress import checks

fractions = st.floats(0, 1)

#: comes to the floor forty-five times before it rolls, 2e5 times as far off as it was released
HOPS = Scene(
    Hoop(0.4452907479338424, 1.0),
    Friction(2.9752547144812516, 2.9752547144812516),
    Release(-0.5, -3.567862700171971, -2.0),
    Run(until="pulse"),
    Landing(0.75),
)


@settings(max_examples=80, deadline=None)
@given(scenes())
@example(Scene(Hoop(1e-8, 1.25), Friction(1.25, 1.25), Release(0.0, 1.0), Run(turns=2)))  # a pulse begins with a jam
def test_bounds_energy_and_order(scene):
    """Finite, in order, energy falls, N >= 0, |F| <= mu_s N, above the floor."""
    motion = simulate(scene)
    margins = checks.listed(motion) | checks.gained(motion) | checks.sampled(motion)
    assert {name: margin for name, margin in margins.items() if not margin <= 1} == {}


@settings(max_examples=80, deadline=None)
@given(scenes())
@example(HOPS)
def test_mirrored_rescaled_restarted(scene):
    """The same answer for phi -> -phi, in SI units, and from the middle, up to the motion's own sensitivity."""
    margins = checks.repeated(simulate(scene))
    assert {name: margin for name, margin in margins.items() if not margin <= 1} == {}


@settings(max_examples=30, deadline=None)
@given(scenes(), st.floats(0.1, 10), st.floats(0.1, 10), st.floats(0.1, 10))
def test_any_units(scene, R, m, g):
    """Impulses scale with m sqrt(g R), losses with m g R, times with sqrt(R/g), angles not at all."""
    scene = scene.replace(run={"until": "pulse"})
    plain = simulate(scene)
    assume(plain.pulses and not plain.pulses[0].cut and not checks.flights(plain))
    si = scene.replace(hoop={"R": R, "m": m, "g": g})
    si = si.replace(
        release={"omega0": scene.release.omega0 / si.time_unit, "slip0": scene.release.slip0 * si.velocity_unit}
    )
    units = np.array([si.impulse_unit, si.impulse_unit, si.time_unit, 1.0])

    def row(motion):
        pulse = motion.pulses[0]
        return np.array([pulse.normal_impulse, pulse.friction_impulse, pulse.t_end, pulse.phi_end])

    other = simulate(si)
    allowed = 1e-9 + 1e-13 * (checks.sensitivity(plain) + 1 / scene.hoop.k)
    assert row(other) / units == pytest.approx(row(plain), rel=allowed, abs=allowed)


@settings(max_examples=40, deadline=None)
@given(scenes(), fractions)
def test_restarted_anywhere_on_the_floor(scene, share):
    """A motion restarted at any instant of rolling or slipping goes on with the same energy and force."""
    motion = simulate(scene)
    t = share * motion.t_end
    phase = motion.phase_at(t)
    assume(phase.kind in (Kind.ROLL, Kind.SKID, Kind.SPIN) and phase.t_end - phase.t_start >= 1e-6)
    margin = 1e-3 * (phase.t_end - phase.t_start)
    state = motion.at(min(max(t, phase.t_start + margin), phase.t_end - margin))
    release = Release(float(state.phi), float(state.omega), float(state.slip_velocity))
    again = simulate(scene.replace(release=release)).at(0.0)
    assert float(again.energy) == pytest.approx(float(state.energy), rel=1e-9)
    digits = 1e-6 + 1e-12 / scene.hoop.k
    assert float(again.normal_force) == pytest.approx(float(state.normal_force), rel=digits, abs=1e-9)


@settings(max_examples=20, deadline=None)
@given(st.lists(scenes(), min_size=1, max_size=8))
def test_a_batch_is_its_scenes(many):
    """Many at once give what each gives alone, up to the motion's own sensitivity: the interpreter and the compiler
    round differently, by some 1e-14.
    """
    many = [scene.replace(run={"turns": 2}) for scene in many]
    batch = simulate_batch(many, turns=2)
    for i, scene in enumerate(many):
        motion = simulate(scene)
        mine = np.array([turn.phi for turn in motion.turns])
        found = np.array([phi for phi in batch.turn_phi[i] if np.isfinite(phi)])
        difference = checks.apart(mine, found)
        assert difference <= 1e-9 + 1e-13 / scene.hoop.k or difference <= 1e-12 * checks.sensitivity(motion)


positive = st.floats(1e-6, 1e12)


@settings(max_examples=100, deadline=None)
@given(
    scenes(),
    st.builds(
        Ring, positive, st.floats(-0.9, 0.5), st.one_of(st.none(), st.floats(0.01, 0.5)), st.floats(0.01, 1.5),
        st.one_of(st.none(), positive),
    ),
    st.builds(Contact, st.sampled_from(LAWS), positive, positive, st.floats(0, 3)),
    st.builds(
        Solve, st.sampled_from(["auto", "full"]), st.sampled_from(["pulses", "all"]),
        st.sampled_from(["equilibrium", "undeformed"]), st.floats(1e-8, 0.5), st.integers(24, 4000),
    ),
)  # fmt: skip
def test_a_scene_survives_its_file(scene, ring, contact, solve):
    """Written as TOML and read again it is the same scene; a thickness is for a hoop whose radii say none."""
    ring = ring if scene.hoop.r == 1 else replace(ring, thickness=None)
    scene = scene.replace(ring=ring, contact=contact, solve=solve)
    assert scene_from_dict(tomllib.loads(checks.toml(scene))) == scene
