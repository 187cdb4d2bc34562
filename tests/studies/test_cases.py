"""A case and its outcome: what determines a result, what its error is, and that nothing is lost where it is kept."""

from __future__ import annotations

import dataclasses
from math import isnan

import numpy as np
import pytest
from third_solver import softened

from flexible import FlexiblePulse
from rigid import Motion, Scene, load_scene
from studies import MEASURES, Measure, Unit
from studies.running.case import FINER, Case, OtherBuild, _pair, run_case
from studies.running.store import Store

SCENE = load_scene("paper-3.1")
TAKEN = 0.125
"""What the steps of :func:`losing` take of the energy, whatever the tolerance."""


@pytest.mark.parametrize("asked", [{"histories": True}, {"cut": True}, {"build": "another"}])
def test_all_that_is_asked_of_a_case_is_in_its_key(asked):
    """A result without histories is none of a case that wants them."""
    case = Case("rigid", SCENE)
    assert dataclasses.replace(case, **asked).key != case.key


def entered(monkeypatch, function):
    """A measure that is there as long as the test."""
    monkeypatch.setitem(MEASURES, "own", Measure("own", "own", Unit.TIME, function))


def test_a_measure_that_was_edited_makes_other_cases(monkeypatch):
    """What it does, where it is, and by which number; not where in a file it stands."""
    bare = Case("rigid", SCENE).key
    keys = []
    for text in (
        "def own(motion, pulse): return pulse.t_start",
        "\n\ndef own(motion, pulse): return pulse.t_start",
        "def own(motion, pulse): return pulse.t_end",
        "def own(motion, pulse): return 2.0 * pulse.t_end",
        "TIMES = 2.0\ndef own(motion, pulse): return TIMES * pulse.t_end",
        "TIMES = 3.0\ndef own(motion, pulse): return TIMES * pulse.t_end",
        "def own(motion, pulse): return inner(pulse)\ndef inner(pulse): return pulse.t_end",
        "def own(motion, pulse): return inner(pulse)\ndef inner(pulse): return pulse.t_start",
        "def own(motion, pulse): return max(x.t_end for x in (pulse,))",
        "def own(motion, pulse): return max(x.t_start for x in (pulse,))",
        "def own(motion, pulse, times=1): return times",
        "def own(motion, pulse, times=2): return times",
    ):
        namespace = {"__name__": "mine"}
        exec(text, namespace)
        entered(monkeypatch, namespace["own"])
        keys.append(Case("rigid", SCENE).key)
    assert keys[0] == keys[1]
    assert len({bare, *keys}) == len(keys)
    monkeypatch.delitem(MEASURES, "own")
    assert Case("rigid", SCENE).key == bare


def test_a_measure_may_count_how_often_it_was_asked(monkeypatch):
    """With a number that only it sets: it is the same measure."""
    namespace = {"__name__": "mine"}
    exec("asked = 0\ndef own(motion, pulse):\n    global asked\n    asked += 1\n    return asked", namespace)
    entered(monkeypatch, namespace["own"])
    case = Case("rigid", SCENE)
    assert not run_case(case).failure
    assert namespace["asked"] > 0
    assert Case("rigid", SCENE).key == case.key
    assert not run_case(case).failure


def test_a_process_without_a_measure_refuses_the_cases_that_have_it(monkeypatch):
    with monkeypatch.context() as here:
        entered(here, lambda motion, pulse: pulse.t_start)
        case = Case("rigid", SCENE)
        assert "own" in run_case(case).pulses[0]
    with pytest.raises(OtherBuild, match=r"\+own:[0-9a-f]{8}: they must agree.*measures entered"):
        run_case(case)


def verbose(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """Fails in many lines."""
    raise ArithmeticError("no step\n  could be\tfound")


def test_why_there_is_no_result_is_one_line():
    assert run_case(Case("test_cases:verbose", SCENE)).failure == "ArithmeticError: no step could be found"


def test_a_case_that_wants_histories_is_run_again_where_there_are_none(tmp_path):
    from studies.running.runs import run_cases
    from studies.running.workers import Here

    for histories in (False, True):
        (found,) = run_cases([Case("rigid", SCENE, histories=histories)], Here(), tmp_path)
        assert len(found.histories) == (len(found.pulses) if histories else 0)
    assert len(found.pulses) > 0


def test_a_measure_that_there_is_not_comes_back_as_none(tmp_path):
    """Without friction there is no J_F/(mu J_N): NaN, which JSON has not, and no number."""
    smooth = SCENE.replace(friction={"mu_s": 0.0, "mu": 0.0})
    outcome = run_case(Case("rigid", smooth))
    store = Store(tmp_path)
    store.add(outcome)
    back = store.get(outcome.key)
    assert outcome.pulses
    for mine, theirs in zip(outcome.pulses, back.pulses, strict=True):
        assert isnan(mine["impulse_ratio_over_mu"])
        np.testing.assert_array_equal(list(theirs.values()), list(mine.values()))


def test_what_is_the_rigid_value_in_any_run_is_resolved_by_the_first():
    """A hoop that nothing brakes slides: J_F = 0 at any tolerance, and there is no distance to be a tenth of."""
    scene = load_scene("paper-3.3-massless").replace(friction={"mu_s": 0, "mu": 0}, run={"until": "pulse"})
    outcome = run_case(Case("flexible", scene, against=(("impulse_ratio", 0.0, 0.0), ("friction_loss", 0.0, 0.0))))
    assert outcome.resolved
    assert outcome.rtol == scene.solve.rtol / FINER
    assert outcome.numerical_error[0]["friction_loss"] > 0, "an error there is"


def test_the_error_of_a_pair_is_its_change_to_a_quarter_of_the_tolerance():
    """The third solver's J_F is off by the tolerance: three quarters of that are between the two runs, and a quarter
    is left."""
    rtol = 1e-3
    case = Case("third_solver:softened", SCENE, against=(("friction_impulse", 0.0, 0.0),))
    found, _ = _pair(case, rtol)
    assert found["rtol"] == rtol / 4
    assert found["numerical_error"][0]["friction_impulse"] == pytest.approx(0.75 * rtol, rel=1e-9)


def losing(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The third solver's motion, of which the steps themselves have taken ``TAKEN``."""
    motion = softened(scene)
    nothing = {"time_off_floor": 0.0, "ring_energy_peak": 0.0, "contact_energy_peak": 0.0, "damping_loss": 0.0}
    pulses = tuple(
        FlexiblePulse(**vars_of(pulse), **nothing, numerical_loss=TAKEN, phases=()) for pulse in motion.pulses
    )
    return dataclasses.replace(motion, pulses=pulses)


def vars_of(pulse: object) -> dict[str, object]:
    """A record's fields as they are."""
    return {field.name: getattr(pulse, field.name) for field in dataclasses.fields(pulse)}


@pytest.mark.parametrize("taken", [TAKEN, -TAKEN])
def test_energy_that_the_steps_took_friction_may_have_had(monkeypatch, taken):
    """The error of the friction loss is no less, however well two runs agree."""
    monkeypatch.setattr(f"{__name__}.TAKEN", taken)
    outcome = run_case(Case(f"{__name__}:losing", SCENE, against=(("friction_loss", 0.0, 10.0),)))
    assert not outcome.failure
    assert outcome.numerical_error[0]["impulse_ratio"] < 1e-3
    assert outcome.numerical_error[0]["friction_loss"] >= abs(taken)


#: by the tolerance, of a J_F of 0.5: pairs that agree to 1e-6 and 1e-4, around values that are 1e-2 apart
LUCKY = {1e-3: 0.5, 2.5e-4: 0.5 + 1e-6, 1.25e-4: 0.51, 1.25e-4 / 4: 0.51 + 1e-4}


def lucky(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The third solver's motion with a friction impulse by luck."""
    motion = softened(scene)
    known = min(LUCKY, key=lambda rtol: abs(rtol / scene.solve.rtol - 1))
    pulses = tuple(dataclasses.replace(pulse, friction_impulse=LUCKY[known]) for pulse in motion.pulses)
    return dataclasses.replace(motion, pulses=pulses)


def test_pairs_that_agree_by_luck_are_held_against_each_other():
    """Each of them to its own error; what is then between them is the error of the finer one."""
    case = Case(f"{__name__}:lucky", SCENE, against=(("friction_impulse", 0.0, 0.0),))
    first, _ = _pair(case, 1e-3)
    assert first["numerical_error"][0]["friction_impulse"] == pytest.approx(1e-6, rel=1e-6)
    second, excess = _pair(case, 1.25e-4, before=first)
    assert second["numerical_error"][0]["friction_impulse"] == pytest.approx(1e-2 + 1e-4 - 2e-6, rel=1e-6)
    alone, less = _pair(case, 1.25e-4)
    assert alone["numerical_error"][0]["friction_impulse"] == pytest.approx(1e-4, rel=1e-6)
    assert excess > 50 * less
