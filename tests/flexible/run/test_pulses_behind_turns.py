"""Which pulses a run has behind its turns: those of the rigid hoop that it tends to, each once and whole."""

from math import pi, radians

import numpy as np
import pytest

import flexible
import rigid
from flexible import rigid_limit
from rigid import Friction, Hoop, Kind, Release, Run, Scene


def both(scene):
    """The pulses of the rigid hoop and of the flexible one."""
    return rigid.simulate(rigid_limit(scene)).pulses, flexible.simulate(scene, states=False).pulses


@pytest.mark.parametrize("run", [Run(t_end=0.5), Run(turns=1), Run(turns=2)])
def test_a_pulse_behind_a_turn_is_not_one_before_it(run):
    """Released at the bottom: out of a pulse that the release cuts, a turn, and back through a whole one.

    To the turn at 0.96 there is but the first. The rest of it and the angle where the next begins are one: whoever
    looks for an angle alone lists a second pulse there, in which N < M g.
    """
    scene = Scene(Hoop(0.1, 1.02, 0.1), Friction(0.5, 0.4), Release(pi, 1.0), run).replace(solve={"resolve": "all"})
    theirs, ours = both(scene)
    assert len(ours) == len(theirs)
    assert [pulse.cut for pulse in ours] == [pulse.cut for pulse in theirs]
    for one, other in zip(ours, theirs, strict=True):
        assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=2e-3)


def test_a_hoop_that_creeps_at_its_turns_has_all_its_pulses():
    """A smoothed friction carries 0.84 of mu N there at a creep of 1.5 v_s, which is a roll of the rigid hoop.

    That one, released with the momentum of the turn, goes on for some 1e-6 before it turns. What creep takes, v_s of
    the slip that rolls at most, is 6 % of J_N in six pulses.
    """
    scene = Scene(Hoop(0.03, 1.02), Friction(1.6, 1.6), Release(radians(175)), Run(turns=6))
    theirs, ours = both(scene.replace(contact={"law": "regularised"}, solve={"resolve": "all"}))
    assert len(theirs) == 6
    assert [pulse.cut for pulse in ours] == [False] * 6
    for one, other in zip(ours, theirs, strict=True):
        assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=0.07)


def test_a_brush_of_which_some_points_stick_may_slide():
    """At the turn between its pulses a third of the patch sticks for an instant, and the hoop slides on at 0.37."""
    hoop, friction = Hoop(0.06644894482112437, 1.0738876150415628), Friction(0.1961314079755514, 0.1765575962613779)
    scene = Scene(hoop, friction, Release(-4.959929335354637), Run(turns=2)).replace(
        ring={"bending_stiffness": 1e8}, contact={"law": "brush", "stiffness": 1e11}, solve={"resolve": "all"}
    )
    theirs, ours = both(scene)
    assert [pulse.cut for pulse in ours] == [False, False]
    for one, other in zip(ours, theirs, strict=True):
        assert one.t_end == pytest.approx(other.t_end, abs=1e-3)
        assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=1e-3)
        assert one.friction_impulse == pytest.approx(other.friction_impulse, rel=1e-3)


@pytest.mark.parametrize("mu", [1.67, 1.983])
def test_a_smoothed_friction_that_rolls_for_ever_is_seen_to(mu):
    """As the rigid hoop, which slips nowhere, and as the same hoop that is flexible in its pulses alone."""
    scene = Scene(Hoop(0.1, 1.02), Friction(mu, mu), Release(2.2), Run(until="rest"))
    assert {phase.kind for phase in rigid.simulate(scene).phases} == {Kind.ROLL}
    scene = scene.replace(contact={"law": "regularised"}, solve={"resolve": "all"})
    motion = flexible.simulate(scene, states=False, most_steps=4000)
    assert motion.ended.startswith("rolls for ever")


@pytest.mark.slow
@pytest.mark.parametrize("lead", [1e-5, 1e-3, 0.1])
@pytest.mark.parametrize("resolve", ["pulses", "all"])
def test_a_run_ends_at_its_time(resolve, lead):
    """Inside a pulse that the flexible hoop leaves later than the rigid one, which is then cut."""
    scene = Scene(Hoop(0.1, 1.02, 0.05), Friction(0.35, 0.3), Release(radians(10)), Run(until="pulse"))
    scene = scene.replace(ring={"bending_stiffness": 60}, contact={"stiffness": 1e8}, solve={"resolve": resolve})
    whole = flexible.simulate(scene, states=False).pulses[0]
    assert whole.t_end > rigid.simulate(scene).pulses[0].t_end + 1e-4
    t_end = whole.t_end - lead
    motion = flexible.simulate(scene.replace(run=Run(t_end=t_end)), states=False)
    assert motion.t_end == pytest.approx(t_end, rel=1e-12)
    assert [pulse.cut for pulse in motion.pulses] == [True]
    assert np.isclose(motion.pulses[0].t_end, t_end, rtol=1e-12)
