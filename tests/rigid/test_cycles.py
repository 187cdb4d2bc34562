"""A motion without loss is periodic: any number of turns is a multiplication."""

from __future__ import annotations

import pickle
from itertools import pairwise
from math import radians

import numpy as np
import pytest

from rigid import Friction, Hoop, Landing, Release, Run, Scene, load_scene, simulate, simulate_batch

SMOOTH = {
    "from rest": Scene(Hoop(0.1), Friction(0.0, 0.0), Release(radians(10))),
    "sliding along": Scene(Hoop(0.3, 1.1, 0.2), Friction(0.0, 0.0), Release(2.0, 0.3, 0.7)),
    "holding where it can": Scene(Hoop(0.3), Friction(0.4, 0.0), Release(1.0)),
}
ROLLING = load_scene("paper-3.2-k0.75")


@pytest.mark.parametrize("name", SMOOTH)
def test_ten_thousand_turns(name):
    motion = simulate(SMOOTH[name].replace(run={"turns": 10_000}))
    assert motion.completed
    assert len(motion.turns) == 10_000
    assert motion.turns[-1].t == motion.t_end == motion.phases[-1].t_end
    first, last = motion.turns[1], motion.turns[-1]
    # the period is integrated to some 1e-14, and 4999 of them are one product
    period = motion.turns[3].t - motion.turns[1].t
    assert last.t - first.t == pytest.approx(4999 * period, rel=1e-12)
    assert (last.phi, last.energy) == pytest.approx((first.phi, first.energy), rel=1e-11)
    for before, after in pairwise(motion.phases):
        assert before.t_start <= before.t_end == after.t_start
        assert before.kind != after.kind
        assert before.phi_end == after.phi_start


@pytest.mark.parametrize("k", [0.1, 0.3, 0.6])
@pytest.mark.parametrize("turns", [9, 1001])
def test_from_rest_every_swing_is_one_phase_in_the_part_that_comes_again_too(k, turns):
    """G is at rest along the floor, so the slip changes its way with phidot: from turn to turn one phase."""
    scene = Scene(Hoop(k), Friction(0, 0), Release(phi0_deg=10), Run(turns=turns))
    phases = simulate(scene).phases
    assert len(phases) == turns
    for before, after in pairwise(phases):
        assert before.kind != after.kind
        assert before.t_start < before.t_end == after.t_start
    # a batch counts the phase too that begins with the last turn, where round-off has it begin before the turn
    assert simulate_batch([scene], turns=turns).phase_count[0] in (turns, turns + 1)


@pytest.mark.parametrize("name", SMOOTH)
def test_what_is_multiplied_is_what_would_have_been_run(name):
    """40 turns, of which some thirty are passed over, against 40 runs that each take the next step by themselves."""
    scene = SMOOTH[name]
    long = simulate(scene.replace(run={"turns": 41}))
    for turns in (6, 7, 40):
        short = simulate(scene.replace(run={"turns": turns}))
        shared = len(short.turns)
        assert np.array([t.t for t in long.turns[:shared]]) == pytest.approx([t.t for t in short.turns], rel=1e-12)
    # any instant: the state on a circle of its own, x_C advancing with it
    for t in np.linspace(0.6, 0.9, 7) * long.t_end:
        state = long.at(t)
        release = Release(float(state.phi), float(state.omega), float(state.slip_velocity))
        following = next(turn for turn in long.turns if turn.t > t)
        again = simulate(scene.replace(release=release, run={"turns": 1}))
        assert again.turns[0].t + t == pytest.approx(following.t, rel=1e-10)
        assert again.turns[0].phi == pytest.approx(following.phi, abs=1e-9)


def test_x_of_g_keeps_its_velocity_through_all_periods():
    """Nothing pushes G sideways on a smooth floor: x_G is a straight line in time over 2000 turns."""
    scene = SMOOTH["sliding along"]
    motion = simulate(scene.replace(run={"turns": 2000}))
    t = np.linspace(0, motion.t_end, 997)
    states = motion.at(t)
    x = states.x_C + scene.hoop.e * np.sin(states.phi)
    line = x[0] + (x[-1] - x[0]) * t / t[-1]
    assert np.abs(x - line).max() < 1e-11 * np.abs(x).max()
    # conditioning of phidot at the bottom: an instant is known to the round-off of t, some 1e-13 here
    assert np.ptp(states.energy) < 1e-10


def test_a_run_to_a_time_comes_round_too():
    """A whirl on a smooth floor, and a swing: to a time of thousands of periods, pulses at equal intervals."""
    for scene in (Scene(Hoop(0.5), Friction(0, 0), Release(0.1, 1.0)), SMOOTH["sliding along"]):
        motion = simulate(scene.replace(run={"t_end": 2e4}))
        assert motion.completed
        assert motion.t_end == 2e4
        starts = np.array([pulse.t_start for pulse in motion.pulses])
        assert len(starts) > 2000
        gaps = np.diff(starts)
        assert np.ptp(gaps[1::2]) < 1e-10
        assert float(np.ptp(motion.at(np.linspace(0, 2e4, 50)).energy)) < 1e-9


@pytest.mark.parametrize("turns", [9_999, 10_000, 300_000])
def test_rolling_for_ever_lists_any_number_of_turns(turns):
    motion = simulate(ROLLING.replace(run={"turns": turns}))
    assert motion.completed
    assert len(motion.turns) == turns
    assert len(motion.pulses) == turns
    assert len(motion.phases) == 1
    assert motion.turns[-1].t == pytest.approx(turns * motion.period / 2, rel=1e-12)
    assert float(motion.at(motion.turns[-3].t).omega) == pytest.approx(0, abs=1e-9)


def test_a_period_is_in_the_time_of_its_scene():
    """From a turn to the next but one, in seconds."""
    motion = simulate(ROLLING.replace(hoop={"R": 0.3, "m": 2.0, "g": 9.81}, run={"turns": 4}))
    assert motion.period == pytest.approx(motion.turns[3].t - motion.turns[1].t, rel=1e-12)
    assert motion.period == pytest.approx(simulate(ROLLING).period * (0.3 / 9.81) ** 0.5, rel=1e-12)


def test_lists_that_repeat_are_sequences():
    motion = simulate(SMOOTH["from rest"].replace(run={"turns": 50}))
    turns = motion.turns
    assert turns[:3] == tuple(turns)[:3]
    assert turns[-1] == tuple(turns)[-1]
    assert next(reversed(turns)) == turns[-1]
    assert turns[10] in turns
    with pytest.raises(IndexError):
        turns[50]
    assert pickle.loads(pickle.dumps(motion)) == motion
    assert len(motion.to_dict()["turns"]) == 50


def test_a_batch_comes_round_too():
    scenes = [*SMOOTH.values(), ROLLING]
    batch = simulate_batch(scenes, turns=10_000)
    for i, scene in enumerate(scenes):
        motion = simulate(scene.replace(run={"turns": 10_000}))
        assert batch.turn_count[i] == 10_000
        assert batch.pulse_count[i] == len(motion.pulses)
        assert batch.turn_t[i] == pytest.approx([turn.t for turn in motion.turns], rel=1e-12)
        assert batch.turn_phi[i] == pytest.approx([turn.phi for turn in motion.turns], rel=1e-12)


def test_the_pulses_of_a_whirl_are_a_round_further_each_time():
    """Of a batch as of one motion."""
    scene = Scene(Hoop(0.5), Friction(0, 0), Release(0.1, 1.0))
    batch = simulate_batch([scene], t_end=300.0, pulses=200)
    count = int(batch.pulse_count[0])
    assert count > 50
    for name in ("phi_start", "phi_stop"):
        assert np.diff(getattr(batch, name)[0, :count]) == pytest.approx(2 * np.pi, abs=1e-11)
    motion = simulate(scene.replace(run={"t_end": 300.0}))
    assert batch.phi_start[0, :count] == pytest.approx([pulse.phi_start for pulse in motion.pulses], abs=1e-10)


def test_hops_that_lose_energy_do_not_come_round():
    scene = Scene(Hoop(0.3), Friction(0, 0), Release(0.0, 3.0), Run(turns=2), Landing(0.5))
    motion = simulate(scene)
    energies = [turn.energy for turn in motion.turns]
    assert motion.at(0.0).energy > max(energies, default=0.0)


def test_a_batch_refuses_a_run_that_cannot_be_and_always_says_why_it_ended():
    from rigid import SceneError

    for run in ({"until": "x"}, {"turns": 0}, {"turns": 2, "t_end": 1.0}, {"t_end": -1.0}):
        with pytest.raises(SceneError, match="is not possible"):
            simulate_batch([ROLLING], **run)
        with pytest.raises(SceneError, match="is not possible"):
            Run(**run)
    # more slips and turns than the work of one motion allows
    batch = simulate_batch([SMOOTH["from rest"]], t_end=1e9)
    assert batch.ended(0) == "the work bound is reached"
