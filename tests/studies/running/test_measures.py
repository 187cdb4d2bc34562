"""What is measured on a pulse."""

from __future__ import annotations

import json

import numpy as np
import pytest

from rigid import Friction, Hoop, Kind, Landing, Release, Run, Scene, simulate, simulate_batch
from studies import measures
from studies.running.files import to_json
from studies.running.measures import inside, phase_sequence


@pytest.mark.slow
def test_the_phases_of_a_pulse_are_those_that_a_batch_has():
    """A landing with which a pulse begins is not part of it, whoever tells."""
    rng = np.random.default_rng(5)
    scenes = []
    for _ in range(150):
        mu = rng.uniform(0, 1.2)
        hoop = Hoop(rng.uniform(0.02, 0.95), float(rng.choice([1, 1.1, 1.5])), float(rng.choice([0, 0.1, 1])))
        release = Release(*rng.uniform((-6, -5, -5), (6, 5, 5)))
        landing = Landing(float(rng.choice([0, 0.5])))
        scenes.append(Scene(hoop, Friction(mu * rng.uniform(1, 1.3), mu), release, landing=landing))
    batch = simulate_batch(scenes, turns=2, pulses=3)
    landings = 0
    for i, scene in enumerate(scenes):
        motion = simulate(scene.replace(run=Run(turns=2)))
        for j, pulse in enumerate(motion.pulses[:3]):
            assert phase_sequence(motion, pulse) == [str(kind.value) for kind in batch.phases(i, j)]
            landings += any(p.kind == Kind.IMPACT and p.t_start == pulse.t_start for p in motion.phases)
    assert landings > 5  # enough of them to tell


def test_a_landing_with_which_a_pulse_begins_comes_before_it():
    """As the batch has it, whose kernel writes down the kinds while it runs."""
    hoop, friction = Hoop(0.5204732812939288, 1.5), Friction(1.085, 0.904)
    scene = Scene(hoop, friction, Release(-1.16, -2.97, -2.38), Run(turns=2), Landing(0.0))
    motion, batch = simulate(scene), simulate_batch([scene], turns=2, pulses=4)
    first = motion.pulses[:4]
    assert any(p.kind is Kind.IMPACT and p.t_start == pulse.t_start for pulse in first for p in motion.phases)
    for i, pulse in enumerate(first):
        assert phase_sequence(motion, pulse) == [str(kind.value) for kind in batch.phases(0, i)]


def test_the_phases_of_a_pulse_begin_and_end_with_it():
    """In time and in angle, none overlaps; the motion's own go on beyond both ends, where N is M g and no more."""
    motion = simulate(Scene(Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(phi0_deg=10), run=Run(turns=1)))
    pulse = motion.pulses[0]
    phases = inside(motion, pulse)
    assert len(phases) > 1
    assert max(p.t_end for p in motion.phases) > pulse.t_end
    assert min(p.t_start for p in motion.phases) < pulse.t_start
    starts, ends = ([(getattr(p, f"t_{at}"), getattr(p, f"phi_{at}")) for p in phases] for at in ("start", "end"))
    assert starts == [(pulse.t_start, pulse.phi_start), *ends[:-1]]
    assert ends[-1] == (pulse.t_end, pulse.phi_end)


def test_the_three_restitutions_of_a_pulse_are_told_apart():
    """With friction they differ: Newton's is that of velocities, Poisson's of impulses, the energetic one of works."""
    scene = Scene(Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(phi0_deg=10), run=Run(until="pulse"))
    motion = simulate(scene)
    pulse = motion.pulses[0]
    told = measures(motion, pulse)
    names = ("newton_restitution", "poisson_restitution", "energetic_restitution")
    assert [told[name] for name in names] == [getattr(pulse, name) for name in names]
    assert len({told[name] for name in names}) == 3
    assert told["impulse_ratio_over_mu"] == pytest.approx(told["friction_impulse"] / told["normal_impulse"] / 0.3)
    assert told["duration"] == pulse.t_end - pulse.t_start


def test_the_peak_of_a_jam_is_null_in_json():
    scene = Scene(Hoop(0.0432, 1.52), Friction(0.538, 0.481), Release(phi0_deg=102.6, omega0=3.85, slip0=-2.41))
    motion = simulate(scene.replace(run=Run(until="pulse")))
    told = json.loads(to_json([motion.to_dict(), measures(motion, motion.pulses[0])]))
    assert told[0]["pulses"][0]["peak_normal_force"] is None
    assert told[1]["peak_normal_force"] is None
    assert phase_sequence(motion, motion.pulses[0]) == ["spin", "impact", "roll"]
