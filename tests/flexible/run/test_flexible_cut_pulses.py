"""A flexible pulse in which the run ends is measured as far as it was run, and marked."""

from __future__ import annotations

from math import isnan

import pytest

import flexible
import rigid

SCENE = rigid.load_scene("paper-3.3-massless").replace(solve={"rtol": 1e-3})


@pytest.mark.parametrize("share", [0.3, 0.7])
def test_cut_by_the_end_of_the_run(share):
    """The rigid hoop over the same time has J_N within a few per cent: the patch shifts events by about its width."""
    whole = rigid.simulate(SCENE.replace(run={"until": "pulse"})).pulses[0]
    t_end = whole.t_start + share * (whole.t_end - whole.t_start)
    motion = flexible.simulate(SCENE.replace(run={"t_end": t_end}))
    assert motion.completed
    assert motion.t_end == pytest.approx(t_end, rel=1e-9)
    (pulse,) = motion.pulses
    assert pulse.cut
    assert isnan(pulse.newton_restitution)
    assert pulse.t_end == motion.t_end
    stiff = rigid.simulate(SCENE.replace(run={"t_end": t_end})).pulses[0]
    assert stiff.cut
    assert pulse.normal_impulse == pytest.approx(stiff.normal_impulse, rel=0.1)


def test_a_whole_pulse_is_not_marked():
    (pulse,) = flexible.simulate(SCENE.replace(run={"until": "pulse"})).pulses
    assert not pulse.cut
    assert not isnan(pulse.newton_restitution)


@pytest.mark.parametrize("resolve", ["pulses", "all"])
@pytest.mark.parametrize("phi0_deg", [175, 182])
def test_a_run_to_a_pulse_goes_on_to_the_first_whole_one(resolve, phi0_deg):
    """What is left of the pulse in which the hoop is released does not end it, be it over the bottom or behind it.

    Events come later or sooner by the half-width of the patch, 1e-3, and so do impulses by a few thousandths.
    """
    scene = SCENE.replace(release={"phi0_deg": phi0_deg, "omega0": 2.0}, run={"until": "pulse"})
    stiff, motion = rigid.simulate(scene), flexible.simulate(scene.replace(solve={"rtol": 1e-3, "resolve": resolve}))
    assert motion.completed
    assert motion.ended == stiff.ended
    assert [pulse.cut for pulse in motion.pulses] == [pulse.cut for pulse in stiff.pulses] == [True, False]
    last, wanted = motion.pulses[-1], stiff.pulses[-1]
    assert motion.t_end == pytest.approx(last.t_end, abs=1e-9)
    assert last.normal_impulse == pytest.approx(wanted.normal_impulse, rel=0.01)
    assert last.friction_impulse == pytest.approx(wanted.friction_impulse, rel=0.01)


#: the last of its slip ends in a pulse, in which the rigid hoop, known to roll for ever, stops after one period
WHIRLING = {
    "hoop": {"k": 0.478, "r": 1.131, "mass_ratio": 0.172}, "friction": {"mu_s": 1.472, "mu": 1.078},
    "release": {"phi0_deg": -159.0, "omega0": 2.554, "slip0": -0.904}, "ring": {"bending_stiffness": 1e5},
    "solve": {"rtol": 1e-3},
}  # fmt: skip


def test_a_pulse_in_which_the_rigid_hoop_has_gone_round_once_is_whole():
    """It was listed as whole where the rigid one stopped, J_N a tenth less; and no run could go on from another."""
    runs = {name: {**WHIRLING, "run": run} for name, run in (("turns", {"turns": 1}), ("time", {"t_end": 12.0}))}
    motions = {name: flexible.simulate(scene) for name, scene in runs.items()}
    one, other = (motion.pulses[1] for motion in motions.values())
    assert not one.cut
    assert (one.t_start, one.t_end, one.normal_impulse) == (other.t_start, other.t_end, other.normal_impulse)
    whole = rigid.simulate(runs["time"]).pulses[1]
    assert one.normal_impulse == pytest.approx(whole.normal_impulse, rel=1e-3)
    on = flexible.simulate({**WHIRLING, "run": {"t_end": 15.0}}, resume=motions["turns"])
    assert on.pulses[1] == one


def test_a_hoop_that_rocks_in_the_angles_of_its_pulse_turns_as_often_as_asked_for():
    """A landing leaves it there: it rocked on for fifteen turns, and the run was given up."""
    rocking = {
        "hoop": {"k": 0.154, "r": 1.0}, "friction": {"mu_s": 0.511, "mu": 0.511},
        "release": {"phi0_deg": 345.94, "omega0": 1.411, "slip0": -0.829}, "ring": {"bending_stiffness": 4900.0},
        "contact": {"stiffness": 3.19e6}, "solve": {"rtol": 1e-3},
    }  # fmt: skip
    motion = flexible.simulate({**rocking, "run": {"turns": 2}})
    assert motion.completed
    assert len(motion.turns) == 2
    assert motion.t_end == pytest.approx(motion.turns[-1].t, rel=1e-9)
    assert [pulse.cut for pulse in motion.pulses] == [False, True]
    resting = flexible.simulate({**rocking, "run": {"until": "rest"}})
    assert resting.ended.startswith("rolls for ever")
