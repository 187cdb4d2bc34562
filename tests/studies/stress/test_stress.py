"""Stability over everything a user can type."""

from __future__ import annotations

import json
import signal
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from rigid import Run, load_scene, scene_from_dict, simulate
from studies.stress import checks, draws, figures, run
from studies.stress.run import Finding, Report
from studies.stress.work import Work


def test_scenes_are_seeded_and_spread():
    first, again = (list(draws.hostile_scenes(256, 3)) for _ in range(2))
    assert first == again
    assert first != list(draws.hostile_scenes(256, 4))
    for quantity, low, high in (
        (lambda s: s.hoop.k, 1e-7, 0.9),
        (lambda s: s.hoop.mass_ratio, 0, 30),
        (lambda s: s.friction.mu, 0.01, 2.5),
        (lambda s: s.contact.stiffness, 1e2, 1e13),
        (lambda s: s.solve.elements, 30, 800),
        (lambda s: s.contact.damping, 0, 1.8),
    ):
        assert min(map(quantity, first)) <= low
        assert max(map(quantity, first)) >= high


def test_flexible_scenes_are_within_the_range_of_the_model():
    """The wall does not give way in the pulse (E I >= 13/k), and the weight sinks in by less than 1e-3 R."""
    scenes = list(draws.flexible_scenes(256, 3))
    assert all(s.ring.bending_stiffness * s.hoop.k >= 13 * (1 - 1e-12) for s in scenes)
    # line contact of a foundation, N = m g: the deepest point (3 N / (4 sqrt(2) eps))^(2/3) of a rigid rim
    assert all((3 / (4 * 2**0.5 * s.contact.stiffness)) ** (2 / 3) < 1e-3 for s in scenes)
    assert {s.contact.law for s in scenes} == {"patch", "brush", "regularised"}
    assert {s.solve.resolve for s in scenes} == {"pulses", "all"}


def test_a_failure_prints_a_scene_that_can_be_run_again():
    scene = next(draws.flexible_scenes(1, 0))
    text = Finding("flexible", 0, scene, "ended", 0.1, {"energy": 3.0}).text()
    assert scene_from_dict(tomllib.loads(text)) == scene
    assert "energy by 3" in text


@pytest.mark.parametrize(("margin", "status"), [(0.5, 0), (3.0, 1)])
def test_stress_ends_with_one_where_a_scene_failed(hoop, monkeypatch, margin, status):
    """A margin is over what is allowed: 1."""
    report = Report(0, [Finding("rigid", 0, next(draws.rigid_scenes(1, 0)), "ended", 0.1, {"energy": margin})])
    monkeypatch.setattr(run, "run_stress", lambda *_: report)
    for form in ((), ("--json",)):
        assert hoop("stress", "--quick", *form)[0] == status


def test_a_map_of_scenes_of_one_kind_is_drawn(tmp_path):
    """Of one scene two solvers draw none: their panels are empty, and no logarithmic axis looks for a number there."""
    scene = next(draws.rigid_scenes(1, 0))
    report = Report(0, [Finding("rigid", 0, scene, "ended", 0.1, {"energy": 0.3})])
    assert figures.draw(report, tmp_path).stat().st_size > 10_000


def test_what_is_wrong_is_found(monkeypatch):
    """A motion that gained energy, lost its order or is not finite does not pass."""
    import dataclasses

    from rigid import load_scene, simulate

    motion = simulate(load_scene("paper-3.1"))
    assert max(checks.sampled(motion).values()) < 1
    turn = dataclasses.replace(motion.turns[1], energy=motion.turns[0].energy + 1e-6)
    wrong = dataclasses.replace(motion, turns=(motion.turns[0], turn))
    assert checks.sampled(wrong)["energy"] > 1
    assert checks.listed(dataclasses.replace(motion, phases=motion.phases[::-1]))["in order"] > 1
    lost = dataclasses.replace(motion.turns[0], t=float("nan"))
    assert checks.listed(dataclasses.replace(motion, turns=(lost,)))["finite"] > 1


@pytest.mark.parametrize("turned", [checks.mirrored, lambda scene: scene])
def test_a_friction_that_no_floor_has_is_found_whichever_way_it_pulls(turned):
    """A first roll, which ends as |F| comes to mu_s N, held against half of that; mirrored F has the other sign."""
    scene = turned(load_scene("paper-3.1"))
    motion = simulate(scene.replace(run=Run(t_end=0.999 * simulate(scene).phases[0].t_end)))
    assert np.ptp(np.sign(motion.at(np.linspace(0.5, 1.0, 20) * motion.t_end).friction_force)) == 0
    assert checks.sampled(motion)["|F| <= mu_s N"] <= 1
    smoother = scene.replace(friction={"mu_s": scene.friction.mu_s / 2, "mu": 0.0})
    assert checks.sampled(replace(motion, scene=smoother))["|F| <= mu_s N"] > 1


def test_a_crash_and_a_run_without_end_are_told():
    scene = next(draws.rigid_scenes(1, 0))

    def crash(*_: object) -> checks.Checked:
        raise ZeroDivisionError("by zero")

    def endless(_: object, work: Work, __: int) -> checks.Checked:
        return checks.Checked({}, f"stopped at t = 1.5e-3 after {work.steps} steps", False, True)

    def deaf(_: object, work: Work, __: int) -> checks.Checked:
        while True:
            work()

    crashed = run._find(run.FLEXIBLE, 0, scene, Work(100, 60.0), crash)
    assert crashed.failed
    assert "ZeroDivisionError" in crashed.text()
    cut = run._find(run.FLEXIBLE, 1, scene, Work(100, 60.0), endless)
    lost = run._find(run.FLEXIBLE, 2, scene, Work(100, 0.01), deaf)
    stuck = Finding("flexible", 3, scene, "stopped at t = 1e-5: no step", 0.1, {}, completed=False)
    fine = Finding("flexible", 4, scene, "the first whole pulse is over", 0.1, {"energy": 0.5})
    report = Report(0, [crashed, cut, lost, stuck, fine])
    assert report.failures == [crashed]
    assert report.completed("flexible") == 1 / 5
    assert report.completed("rigid") is None
    assert "rigid: none drawn" in report.text()
    assert report.reasons("flexible")["cut at the work bound"] == [1, 2]
    assert report.reasons("flexible")["stopped at t = #: no step"] == [3]
    assert "2 not: cut at the work bound (1, 2)" in report.text()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timer of processor time on this system")
def test_a_run_that_tells_nothing_is_bounded_too():
    """A march without a step told nothing, and took all of an afternoon."""
    scene = next(draws.rigid_scenes(1, 0))

    def mute(*_: object) -> checks.Checked:
        while True:
            pass

    found = run._find(run.FLEXIBLE, 0, scene, Work(100, 0.05), mute)
    assert found.cut
    assert not found.failed


@pytest.mark.slow
def test_a_few_of_each_kind(hoop, tmp_path):
    """36 scenes and the cycles, through processes, report and figure: none crashes, none breaks an invariant."""
    status, out, err = hoop("stress", "--quick", "--scenes", 36, "--json", "--out", tmp_path)
    found = json.loads(out)
    assert found["failures"] == []
    assert (status, err) == (0, "")
    assert found["margins"]["rigid"]["energy"]["scenes"] == 30
    assert set(found["completed"]) == set(run.KINDS)
    assert found["margins"]["cycles"]["angle drifts"]["scenes"] >= 3
    assert (tmp_path / "stress.png").stat().st_size > 10_000


@pytest.mark.slow
def test_quick_stress(hoop, tmp_path):
    """Rigid and flexible scenes and a thousand cycles: none crashes, none hangs, none breaks an invariant."""
    status, out, err = hoop("stress", "--quick", "--json", "--out", tmp_path)
    found = json.loads(out)
    assert found["failures"] == []
    assert (status, err) == (0, "")
    assert found["margins"]["rigid"]["energy"]["scenes"] >= 500
    assert found["margins"]["cycles"]["angle drifts"]["scenes"] >= 3
    # each of the flexible scenes that count was run to its end, and is held to its bounds
    assert found["completed"]["flexible"] >= run.ENOUGH
    assert found["margins"]["flexible"]["residual"]["scenes"] >= run.ENOUGH * run.QUICK.flexible
    assert found["margins"]["flexible"]["mirrored"]["scenes"] >= 0.5 * run.ENOUGH * run.QUICK.flexible
    told = sum(len(scenes) for scenes in found["not_completed"]["flexible"].values())
    assert told == round((1 - found["completed"]["flexible"]) * run.QUICK.flexible)
    assert (tmp_path / "stress.png").stat().st_size > 10_000


@pytest.mark.slow
def test_another_sequence():
    """With the bounds on steps of the whole stress test, and its comparison with all nodes on a sample."""
    report = run.run_stress(scenes=90, seed=1)
    assert not report.failures, report.text()
    share = report.completed(run.FLEXIBLE)
    assert share is not None
    assert share >= run.ENOUGH, report.text()
