"""Each check of `hoop stress` fails where what it checks is broken, and that check alone is what tells.

The faults are laid into a sound motion, or into the solver that a check asks again; they are of any size that is far
above round-off, and far below what a picture would show.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexible
from rigid import Motion, load_scene, simulate
from studies.stress import checks, cycles
from studies.stress import flexible as elastic
from studies.stress.work import Work

OFF = 1e-5
SCENE = load_scene("paper-3.1").replace(run={"turns": 2})  # rolls, spins, sticks and skids
SHORT = load_scene("paper-3.3-light").replace(
    run={"until": "pulse"},
    ring={"bending_stiffness": 1e3},
    contact={"stiffness": 1e7},
    solve={"rtol": 1e-3, "level": "reduced"},
)


@pytest.fixture(scope="module")
def motion():
    return simulate(SCENE)


@pytest.fixture(scope="module")
def pulse():
    return flexible.simulate(SHORT, history=True)


def broken(margins):
    return {name for name, margin in margins.items() if margin > 1}


def turned(motion: Motion, **columns) -> Motion:
    """The motion with some columns of its states made anew, each from all of them."""

    def sample(t, side):
        states = motion.sample(t, side)
        return replace(states, **{name: column(states) for name, column in columns.items()})

    return replace(motion, sample=sample)


def test_phases_that_do_not_meet_are_found(motion):
    first, second, *rest = motion.phases
    apart = replace(motion, phases=(first, replace(second, phi_start=second.phi_start + OFF), *rest))
    assert broken(checks.listed(motion)) == set()
    assert broken(checks.listed(apart)) == {"angle joined"}
    late = replace(motion, phases=(first, replace(second, t_start=second.t_start + OFF), *rest))
    assert broken(checks.listed(late)) == {"in order"}


def test_a_motion_without_phases_is_one_that_was_not_completed(motion):
    nothing = replace(motion, phases=(), turns=(), pulses=())
    assert broken(checks.listed(nothing)) == {"finite"}
    assert broken(checks.listed(replace(nothing, completed=False))) == set()


@pytest.mark.parametrize("name", ["t_end", "normal_impulse", "friction_loss", "peak_normal_force"])
def test_a_number_of_a_pulse_that_is_none_is_found(motion, name):
    first, *rest = motion.pulses
    lost = replace(motion, pulses=(replace(first, **{name: float("nan")}), *rest))
    assert broken(checks.listed(lost)) == {"finite"}


def test_a_pulse_that_gives_energy_is_found(motion):
    first, *rest = motion.pulses
    assert broken(checks.gained(motion)) == set()
    assert broken(checks.gained(replace(motion, pulses=(*rest, replace(first, friction_loss=-OFF))))) == {
        "gained in a pulse"
    }


@pytest.mark.parametrize(
    ("check", "columns"),
    [
        ("energy", {"energy": lambda s: s.energy + OFF * (s.t > 3)}),  # while it skids its loss would hide it
        ("N >= 0", {"normal_force": lambda s: np.where(s.t == s.t[7], -OFF, s.normal_force)}),
        ("|F| <= mu_s N", {"friction_force": lambda s: 1.2 * s.friction_force}),
        ("above the floor", {"y_C": lambda s: s.y_C - OFF * (s.t == s.t[7])}),
        ("finite", {"slip_velocity": lambda s: np.where(s.t == s.t[7], np.nan, s.slip_velocity)}),
    ],
)
def test_a_state_that_cannot_be_is_found(motion, check, columns):
    assert broken(checks.sampled(motion)) == set()
    assert check in broken(checks.sampled(turned(motion, **columns)))


def again(monkeypatch, module, fault, real=simulate):
    """Have the checks of a module ask a solver that is at fault."""
    monkeypatch.setattr(module, "simulate", lambda scene, **_: fault(scene, real(scene)))


@pytest.mark.parametrize("what", ["turns", "normal_impulse", "friction_impulse"])
@pytest.mark.parametrize(("check", "other"), [("mirrored", checks.mirrored), ("in SI units", checks.in_si)])
def test_a_solver_that_prefers_a_side_or_a_unit_is_found(monkeypatch, motion, check, other, what):
    """It is right for all scenes but the one that is mirrored, or the one in SI units."""

    def fault(scene, found):
        if scene.release != other(SCENE).release or scene.hoop != other(SCENE).hoop:
            return found
        if what == "turns":
            return replace(found, turns=tuple(replace(turn, phi=turn.phi + OFF) for turn in found.turns))
        wrong = (replace(pulse, **{what: getattr(pulse, what) * (1 + OFF)}) for pulse in found.pulses)
        return replace(found, pulses=tuple(wrong))

    assert broken(checks.repeated(motion)) == set()
    again(monkeypatch, checks, fault)
    assert broken(checks.repeated(motion)) == {check}


def test_a_mirrored_friction_impulse_that_does_not_turn_over_is_found(monkeypatch, motion):
    def fault(scene, found):
        if scene.release.phi0 > 0:
            return found
        return replace(found, pulses=tuple(replace(p, friction_impulse=-p.friction_impulse) for p in found.pulses))

    again(monkeypatch, checks, fault)
    assert broken(checks.repeated(motion)) == {"mirrored"}


def test_a_mirrored_motion_with_a_turn_less_is_found(monkeypatch, motion):
    """What has another number of turns has no difference, and is not the same."""

    def fault(scene, found):
        return replace(found, turns=found.turns[:1]) if scene.release.phi0 < 0 else found

    again(monkeypatch, checks, fault)
    assert broken(checks.repeated(motion)) == {"mirrored"}


def test_a_motion_that_restarts_as_another_is_found(monkeypatch, motion):
    assert checks.restarted(motion) <= 1

    def fault(scene, found):
        if scene.release == SCENE.release:
            return found
        return replace(found, turns=tuple(replace(turn, phi=turn.phi + OFF) for turn in found.turns))

    again(monkeypatch, checks, fault)
    assert checks.restarted(motion) > 1


@pytest.mark.parametrize(("kind", "name"), [("roll", "phi"), ("spin", "omega"), ("skid", "slip_velocity")])
def test_a_closed_form_that_is_off_is_found(motion, kind, name):
    """At the end of any phase of that kind alone."""
    late = np.array([p.t_start + 0.99 * (p.t_end - p.t_start) for p in motion.phases if p.kind == kind])
    ends = np.array([p.t_end for p in motion.phases if p.kind == kind])

    def off(states):
        return getattr(states, name) + OFF * ((states.t[..., None] > late) & (states.t[..., None] < ends)).any(axis=-1)

    assert broken(checks.integrated(motion)) == set()
    assert broken(checks.integrated(turned(motion, **{name: off}))) == {"integrated in time"}


def test_a_cycle_that_drifts_is_found(monkeypatch):
    """Each cycle by 1e-10 more than the one before; and a run of them all that ends early, or at another time."""
    monkeypatch.setattr(cycles, "CYCLES", 20)
    scene = cycles.HOOPS["rolling"].replace(run={"turns": 40})
    one = simulate(scene.replace(run={"turns": 2}))
    all_of_them = simulate(scene)

    def drift(**changes):
        """Of each cycle but the first, more and more."""
        count = iter(range(1000))

        def solve(asked):
            if asked.run.turns == 40:
                last = all_of_them.turns[39]
                return replace(all_of_them, turns=[last] * changes.get("turns", 40))
            growth = 1 + changes.get("share", 0.0) * next(count)
            turn = replace(one.turns[1], **{n: getattr(one.turns[1], n) * growth for n in changes.get("names", ())})
            return replace(one, turns=(one.turns[0], turn))

        monkeypatch.setattr(cycles, "simulate", solve)
        return broken(cycles.drift(scene).margins)

    assert drift() == set()
    assert drift(turns=38) == {"all cycles"}
    assert drift(names=["phi"], share=1e-10) == {"angle drifts"}
    assert drift(names=["energy"], share=-1e-10) == {"energy drifts"}
    assert drift(names=["t"], share=1e-10) == {"one run", "period drifts"}


@pytest.mark.parametrize(
    ("check", "columns"),
    [
        ("N >= 0", {"normal_force": -OFF}),
        ("|F| <= mu_s N", {"friction_force": 1.0}),
        ("|F| <= mu_s N", {"friction_force": -1.0}),
        ("in order", {"t": 1.0}),
        ("finite", {"ring_strain": float("nan")}),
    ],
)
def test_a_step_that_cannot_be_is_found(pulse, check, columns):
    """One of them, in the middle: before the disk comes down the force is far below 1."""
    assert broken(elastic._history(pulse)) == set()
    steps = {name: getattr(pulse.history, name).copy() for name in columns}
    for name, value in columns.items():
        steps[name][3] = value
    assert check in broken(elastic._history(replace(pulse, history=replace(pulse.history, **steps))))


@pytest.mark.parametrize(
    ("check", "books"),
    [
        ("residual", {"residual": 0.1}),
        ("residual", {"residual": -0.1}),
        ("numerical loss", {"numerical_loss": 0.1}),
        ("numerical loss", {"numerical_loss": -0.1}),
        ("losses >= 0", {"friction_loss": -0.1}),
        ("losses >= 0", {"damping_loss": -0.1}),
        ("losses >= 0", {"landing_loss": -0.1}),
        ("finite", {"hand_over": float("nan")}),
    ],
)
def test_books_that_cannot_be_are_found(pulse, check, books):
    assert broken(elastic._ledger(pulse)) == set()
    assert broken(elastic._ledger(replace(pulse, ledger=replace(pulse.ledger, **books)))) == {check}


@pytest.mark.parametrize("what", ["normal_impulse", "friction_impulse"])
@pytest.mark.parametrize(
    ("check", "other"),
    [
        ("mirrored", lambda scene, _: checks.mirrored(scene)),
        ("in SI units", lambda scene, _: checks.in_si(scene)),
        ("restarted", lambda _, pulse: elastic._from_the_middle(pulse)),
    ],
)
def test_a_flexible_solver_that_prefers_a_side_or_a_unit_is_found(monkeypatch, pulse, check, other, what):
    """As the rigid one. What it finds otherwise is the run itself, turned and in the units as it should be."""
    at_fault = other(SHORT, pulse)
    assert at_fault is not None

    def right(scene, **_):
        turned_over = -1 if scene.release.phi0 < 0 else 1
        (first,) = pulse.pulses
        unit = scene.impulse_unit
        first = replace(
            first,
            normal_impulse=first.normal_impulse * unit,
            friction_impulse=turned_over * first.friction_impulse * unit,
        )
        return replace(pulse, scene=scene, pulses=(first,))

    def wrong(scene, **_):
        found = right(scene)
        if scene != at_fault:
            return found
        (first,) = found.pulses
        return replace(found, pulses=(replace(first, **{what: getattr(first, what) + 0.1 * scene.impulse_unit}),))

    monkeypatch.setattr(elastic, "simulate", right)
    assert elastic._again(pulse, Work(1000, 60.0)) == pytest.approx(
        {"mirrored": 0, "in SI units": 0, "restarted": 0}, abs=1e-9
    )
    monkeypatch.setattr(elastic, "simulate", wrong)
    assert broken(elastic._again(pulse, Work(1000, 60.0))) == {check}


def test_a_level_that_disagrees_with_all_nodes_is_found(monkeypatch, pulse):
    """By 4 % of the normal impulse, of which the tolerance explains 3 %."""

    def levels(share):
        def solve(scene, **_):
            (first,) = pulse.pulses
            off = 1 + share * (scene.solve.level == "full")
            return replace(pulse, scene=scene, pulses=(replace(first, normal_impulse=first.normal_impulse * off),))

        monkeypatch.setattr(elastic, "simulate", solve)
        return broken(elastic.against_all_nodes(SHORT, Work(1000, 60.0)))

    assert levels(0.0) == set()
    assert levels(0.04) == levels(-0.04) == {"all nodes"}


def test_all_checks_are_made_of_a_motion_whose_angles_meet_to_round_off(monkeypatch, motion, pulse):
    """What is within its bound is no reason to leave the other checks out."""

    def nearly(found):
        first, second, *rest = found.phases
        return replace(found, phases=(first, replace(second, phi_start=second.phi_start * (1 + 1e-15)), *rest))

    monkeypatch.setattr(checks, "simulate", lambda scene: nearly(simulate(scene)))
    assert {"energy", "mirrored", "gained in a pulse"} <= set(checks.rigid_margins(SCENE, False).margins)
    monkeypatch.setattr(elastic, "simulate", lambda scene, **_: nearly(pulse))
    assert {"residual", "N >= 0"} <= set(elastic.flexible_margins(SHORT, False, Work(1000, 60.0)).margins)
