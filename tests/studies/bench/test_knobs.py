"""`hoop bench knobs`: what each knob leaves, one at a time."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import flexible
from studies.bench import knobs
from studies.bench.knobs import KNOBS, Budget, Pulse, Setting, budget, pulse_at, pulses
from studies.bench.shown.figures import budget as drawn
from studies.bench.truth.reference import errors

once = cache(pulse_at)  # two tests look at the same budgets
MASSLESS = next(pulse.scene for pulse in pulses(quick=True) if pulse.scene.hoop.mass_ratio == 0)


@pytest.mark.parametrize("pulse", pulses(quick=True), ids=lambda pulse: pulse.name)
def test_the_setting_that_rtol_chooses_is_that_of_a_run(pulse):
    """To the last bit from the undeformed ring; a segment of a pulse begins where ours does, but for rounding."""
    rtol = 1e-3
    found = pulse_at(pulse.scene, Setting.of(pulse.scene, rtol))
    history = flexible.simulate(pulse.scene.replace(solve={"rtol": rtol}), history=True).history
    assert history is not None
    whole = np.array([history.normal_impulse[-1], history.friction_impulse[-1], history.friction_loss[-1]])
    ours = np.array([found.normal_impulse, found.friction_impulse, found.friction_loss])
    assert ours == pytest.approx(whole, rel=1e-9)


@pytest.mark.slow
def test_parts_are_found_one_by_one(monkeypatch):
    """Steps leave most of a pulse without mass; what is finer in all is off by no more than the parts together."""
    monkeypatch.setattr(knobs, "pulse_at", once)
    found = budget(MASSLESS, 1e-3)
    assert set(found.parts) == set(KNOBS) - {"modes"}  # none without mass
    assert 0 < found.all < 1.1 * sum(found.parts.values())  # a triangle, but for what they do to each other
    finer = budget(MASSLESS, 1e-4)
    chosen, tighter = (Setting.of(MASSLESS, rtol) for rtol in (1e-3, 1e-4))
    assert all(finer.parts[knob] < found.parts[knob] for knob in ("points", "steps"))
    assert (tighter.around, tighter.through) == (chosen.around, chosen.through)
    for budgeted in (found, finer):  # shorter steps still leave more than the same elements
        assert max(budgeted.parts, key=lambda knob: budgeted.parts[knob]) == "steps"


def test_coarser_elements_leave_more():
    """Of the order with which they are chosen: half as many leave some ten times as much."""
    scene = next(pulse.scene for pulse in pulses(quick=True) if pulse.scene.hoop.mass_ratio > 0)
    still = Setting.of(scene, 1e-3)

    def on(around: int) -> Setting:
        return Setting(around, still.through, still.modes, still.points, 1e-4)

    fine = pulse_at(scene, on(720))
    few, many = (errors(pulse_at(scene, on(around)), fine)[0] for around in (60, 120))
    assert few > 4 * many


def test_a_knob_that_leaves_too_much_is_told(monkeypatch):
    """By its pulse and tolerance; what did not come to its end is a note in its row."""
    broken = MASSLESS.replace(friction={"mu_s": 0.31})
    monkeypatch.setattr(knobs, "pulse_at", once)
    monkeypatch.setattr(knobs, "pulses", lambda quick: [Pulse("one", MASSLESS)])
    monkeypatch.setattr(knobs, "MOST", 1e-9)
    result = knobs.bench(quick=True)
    assert [claim.holds for claim in result.claims] == [False, False]
    assert [claim.name for claim in result.claims] == [
        f"one, rtol {x}: the largest part, or all, over rtol" for x in ("1e-03", "1e-04")
    ]
    monkeypatch.setattr(knobs, "MOST", 1.0)
    monkeypatch.setattr(knobs, "budget", lambda scene, rtol, done: Budget({"steps": rtol / 2}, all=2 * rtol))
    assert [claim.holds for claim in knobs.bench(quick=True).claims] == [False, False], "all of it counts too"
    monkeypatch.setattr(knobs, "budget", budget)
    drawn(result.rows, result.parts).draw_without_rendering()

    def fails(scene, setting):
        raise RuntimeError("stopped")

    monkeypatch.setattr(knobs, "pulses", lambda quick: [Pulse("broken", broken)])
    monkeypatch.setattr(knobs, "pulse_at", fails)
    result = knobs.bench(quick=True)
    assert [row.note for row in result.rows] == ["stopped", "stopped"]
    assert not result.claims
