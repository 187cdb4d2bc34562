"""What a run says of itself."""

from __future__ import annotations

from scenes import HOOP

from flexible import simulate
from flexible.run.told import in_time_of, with_advice
from rigid import load_scene


def test_a_sentence_has_the_times_of_its_scene():
    """The solver's are in sqrt(R/g)."""
    sentence = "stopped at t = 5.1032, phi = 4.1: no step below 1e-12 (E b = 3, t = 1e-05)"
    paper, printed = load_scene("paper-3.1"), load_scene("printed")
    assert in_time_of(paper, sentence) == sentence
    unit = (0.1 / 9.81) ** 0.5
    told = in_time_of(printed, sentence)
    assert (
        told
        == f"stopped at t = {5.1032 * unit:.6g} s, phi = 4.1: no step below 1e-12 (E b = 3, t = {1e-5 * unit:.6g} s)"
    )


def test_a_run_that_is_stopped_says_when_in_its_own_unit():
    scene = load_scene("printed").replace(solve={"rtol": 1e-2})
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


def test_a_stop_that_was_asked_for_gets_no_advice():
    """Of a disk too small for its ring it is told where the run stops by itself."""
    soft = HOOP.replace(hoop={"k": 0.01}, ring={"bending_stiffness": 200.0})
    assert with_advice(soft, "stopped at t = 1 after 5 steps").endswith("well above 1.3/k = 130")
    assert with_advice(soft, "stopped at t = 1 as asked") == "stopped at t = 1 as asked"
    assert simulate(soft, stop=lambda: True).ended.endswith(" as asked")
