"""The energy ledger as it is printed, and what is said of it."""

import re
from dataclasses import replace
from math import sqrt

import pytest

import flexible
from rigid import load_scene
from studies.cli.shared.account import account, remarks

SCENE = load_scene("paper-3.3-massless").replace(run={"until": "pulse"}, solve={"rtol": 1e-3})


@pytest.fixture(scope="module")
def chattering():
    """Undamped: it hops thirteen times behind the stick, down to rtol = 1e-6; at 1e-3 long steps may damp that."""
    return flexible.simulate(SCENE.replace(contact={"damping": 0.0}, solve={"rtol": 3e-4}))


def test_the_printed_column_adds_up_to_its_first_line(chattering):
    names, shown = zip(*account(chattering), strict=True)
    assert names[0] == "initial"
    decimals = {len(text.partition(".")[2]) for text in shown}
    assert len(decimals) == 1
    values = [float(text) for text in shown]
    # half a digit for every line
    assert values[0] == pytest.approx(sum(values[1:]), abs=len(values) / 2 * 10 ** -decimals.pop())
    assert values[0] == pytest.approx(chattering.ledger.initial, rel=1e-6)


def test_an_account_in_joules_has_as_many_digits():
    """Seven of the largest entry."""
    si = SCENE.replace(hoop={"R": 0.3, "m": 2e-3, "g": 9.81})
    motion = flexible.simulate(si)
    assert float(dict(account(motion))["initial"]) == pytest.approx(motion.ledger.initial, rel=1e-6)
    assert motion.ledger.initial < 10 * si.energy_unit < 0.1


def test_chatter_is_told_and_that_damping_ends_it(chattering):
    hops = sum(phase.kind.value == "flight" for phase in chattering.pulses[0].phases)
    assert hops > 3
    (sentence,) = [text for text in remarks(chattering) if "chatter" in text]
    assert f"{hops} of their {len(chattering.pulses[0].phases)} phases" in sentence
    assert "contact.damping" in sentence
    period = re.search(r"vibration, (\S+) sqrt\(R/g\);", sentence)
    si = flexible.simulate(chattering.scene.replace(hoop={"R": 0.3, "m": 2e-3, "g": 9.81}))
    (sentence,) = [text for text in remarks(si) if "chatter" in text]
    seconds = re.search(r"vibration, (\S+) s;", sentence)
    # both are told to three digits
    assert float(seconds[1]) == pytest.approx(float(period[1]) * sqrt(0.3 / 9.81), rel=1e-2)
    assert not any("chatter" in text for text in remarks(flexible.simulate(SCENE)))


def test_a_hand_over_is_flagged_where_it_is_large():
    """On a soft floor the sag alone is more than a thousandth of the energy."""
    for foundation, flagged in ((1e5, True), (1e10, False)):
        scene = SCENE.replace(contact={"stiffness": foundation}, ring={"bending_stiffness": 1e5})
        motion = flexible.simulate(scene)
        assert (abs(motion.ledger.hand_over) > 1e-3 * motion.ledger.initial) == flagged
        (told,) = [text for text in remarks(motion) if text.startswith("Hand over:")]
        assert ("of the energy" in told) == flagged


@pytest.mark.slow
def test_what_the_steps_took_is_told_where_they_do_not_follow():
    """A wall that lands leaves waves of bending of all frequencies; one that rolls leaves none."""
    soft = SCENE.replace(
        hoop={"mass_ratio": 0.05}, ring={"bending_stiffness": 1.0}, contact={"stiffness": 1e8, "damping": 0.0}
    )
    for scene, told in (
        (soft.replace(solve={"rtol": 1e-4}), True),
        (soft.replace(ring={"bending_stiffness": 1e4}), False),
    ):
        motion = flexible.simulate(scene)
        assert any(phase.kind.value == "flight" for phase in motion.pulses[0].phases) == told
        (sentence,) = [text for text in remarks(motion) if "Numerical loss" in text] or [""]
        assert bool(sentence) == told
        if told:
            share = float(re.search(r"took (\S+) of the energy", sentence)[1])
            # to two digits
            assert share * motion.ledger.initial == pytest.approx(abs(motion.ledger.numerical_loss), rel=0.06)


@pytest.mark.parametrize(("share", "told"), [(3.0, True), (-3.0, True), (0.5, False)])
def test_energy_in_no_book_is_told(chattering, share, told):
    """Over rtol times the energy, of a motion with one pulse."""
    ledger = chattering.ledger
    left = share * chattering.scene.solve.rtol * ledger.initial
    motion = replace(chattering, ledger=replace(ledger, residual=left))
    sentences = [text for text in remarks(motion) if text.startswith("Residual:")]
    assert len(sentences) == told
    if told:
        part = float(re.search(r"Residual: (\S+) of the energy", sentences[0])[1])
        assert part == pytest.approx(abs(left) / ledger.initial, rel=0.06)  # two digits
