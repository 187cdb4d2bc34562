"""What a run says of itself."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scenes import HOOP, flying

from flexible import load_motion, simulate
from flexible.models.reduced import ReducedHoop
from flexible.run.told import in_words
from flexible.time.adaptive import Limits, march
from flexible.time.course import Stop
from flexible.time.events import Ends
from rigid import Run, load_scene
from rigid import simulate as rigid_motion


def test_a_sentence_has_the_times_of_its_scene():
    """The solver's are in sqrt(R/g); they are rounded once, in the unit in which they are told."""
    paper, printed = load_scene("paper-3.1"), load_scene("printed")
    stop = Stop(" (N = 3): no step below 1e-12", 5.10320449, 4.1, by_ring=False)
    assert in_words(stop, paper) == "stopped at t = 5.1032, phi = 4.1 (N = 3): no step below 1e-12"
    unit = (0.1 / 9.81) ** 0.5
    told = in_words(stop, printed)
    assert told == f"stopped at t = {5.10320449 * unit:.6g} s, phi = 4.1 (N = 3): no step below 1e-12"
    assert (
        in_words(Stop(": nothing", phi=1.0, what="no start", by_ring=False), printed) == "no start at phi = 1: nothing"
    )


@pytest.mark.parametrize("resolve", ["pulses", "all"])
def test_a_period_is_in_the_unit_of_its_scene(resolve):
    """In seconds it is sqrt(R/g) times that of the same hoop without units, all twelve digits of it."""
    scene = load_scene("printed").replace(
        hoop={"k": 0.75}, friction={"mu_s": 1.0, "mu": 0.9}, run={"until": "rest"},
        ring={"bending_stiffness": 24000.0}, solve={"resolve": resolve, "rtol": 1e-2},
    )  # fmt: skip
    motion = simulate(scene)
    seconds, numbers = (each.ended.split("; period ") for each in (motion, simulate(scene.to_dimensionless())))
    assert seconds[0] == numbers[0] == "rolls for ever: |F| < mu_s N over the whole swing"
    period, unit = seconds[1].split()
    assert unit == "s"
    assert float(period) == pytest.approx((0.1 / 9.81) ** 0.5 * float(numbers[1]), rel=1e-11)
    assert motion.period == pytest.approx(float(period), rel=1e-11)
    rigid = rigid_motion(scene)  # which swings as so stiff a hoop does, to the patch's share of R
    assert rigid.ended == f"{seconds[0]}; period {rigid.period:.12g} s"
    assert float(period) == pytest.approx(rigid.period, rel=1e-2)


def test_a_run_to_a_time_has_no_period(tmp_path):
    """One to rest has it from its file too."""
    rolls = HOOP.replace(
        hoop={"k": 0.25, "mass_ratio": 1.0}, friction={"mu_s": 1.0, "mu": 1.0}, release={"phi0_deg": 120},
        run={"until": "rest"}, solve={"rtol": 1e-2},
    )  # fmt: skip
    motion = simulate(rolls)
    assert motion.period == pytest.approx(rigid_motion(rolls).period, rel=1e-2)  # the patch's share of R, as above
    motion.save(tmp_path / "rolls.npz")
    assert load_motion(tmp_path / "rolls.npz").period == motion.period
    assert simulate(rolls.replace(run=Run(t_end=motion.t_end + 1))).period is None


def test_a_run_that_is_stopped_says_when_in_its_own_unit():
    scene = load_scene("printed").replace(solve={"rtol": 1e-2, "level": "reduced"})
    asked = iter(range(5))
    motion = simulate(scene, stop=lambda: next(asked, None) is None)
    assert motion.ended.startswith(f"stopped at t = {motion.t_end:.6g} s as asked")


def test_a_run_that_is_out_of_steps_tells_all_that_it_took():
    """Those of its first pulse too, where it ends in the second."""
    scene = HOOP.replace(run={"turns": 2}, solve={"rtol": 1e-2})
    first = simulate(scene.replace(run={"until": "pulse"})).steps
    motion = simulate(scene, most_steps=first + 5)
    assert len(motion.pulses) == 1
    assert motion.ended == f"stopped at t = {motion.t_end:.6g} after {first + 5} steps"


@pytest.mark.parametrize("mass", [0.0, 0.1])
def test_a_run_that_is_out_of_steps_in_the_air_says_what_takes_them(mass):
    hoop = ReducedHoop(HOOP.replace(hoop={"mass_ratio": mass}))
    pos, vel = np.zeros((2, 3 + hoop.coordinates))
    pos[1:3] = 0.5, 2.0
    told = march(hoop, flying(hoop, pos, vel), Ends(t=0.5), 1e-3, Limits(most=3)).stop.told()
    assert ("off the floor, where its ring vibrates: a larger solve.rtol" in told) == (mass > 0)
    assert " after 3 steps" in told


def test_a_stop_that_was_asked_for_gets_no_advice():
    """Of a disk too small for its ring it is told where the run stops by itself."""
    soft = HOOP.replace(hoop={"k": 0.01}, ring={"bending_stiffness": 200.0})
    assert in_words(Stop(" after 5 steps", 1.0), soft).endswith("well above 1.3/k = 130")
    assert in_words(Stop(" as asked", 1.0, by_ring=False), soft) == "stopped at t = 1 as asked"
    assert simulate(soft, stop=lambda: True).ended.endswith(" as asked")


def test_a_motion_that_is_not_started_says_why_and_has_no_states():
    """No ring as soft as this one carries the disk on top of it; the share it does is told in any units."""
    scene = load_scene("printed").replace(ring={"bending_stiffness": 0.05}, solve={"resolve": "all", "elements": 60})
    motion = simulate(scene)
    assert (motion.completed, motion.t_end, motion.phases) == (False, 0.0, ())
    assert motion.ended.startswith("no start at phi = ")
    assert "of the weight of disk and hoop" in motion.ended
    times = float(re.search(r"a ring (\S+) times as stiff would carry it$", motion.ended)[1])
    assert simulate(scene.replace(ring={"bending_stiffness": 0.05 * times}, run={"t_end": 1e-3})).completed


def test_a_stop_behind_an_event_is_as_asked():
    """Wherever it is asked for: where a slip had just ended it was said that no step could be solved."""
    scene = load_scene("paper-3.3-massless").replace(contact={"damping": 0.0}, run={"until": "pulse"})
    whole, ends = simulate(scene), []
    for most in range(1, 13):
        asked = iter(range(most))
        motion = simulate(scene, stop=lambda asked=asked: next(asked, None) is None)
        ends.append(motion.ended)
    assert all(end.endswith(" as asked") for end in ends), ends
    assert simulate(scene, resume=motion) == whole
