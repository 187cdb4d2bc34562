"""Limits without an approach, out of sight, and foundations that cannot be."""

from __future__ import annotations

import pytest
from command_line import is_one_sentence

from rigid import load_scene
from studies import limit_study
from studies.limit.prediction import predict
from studies.limit.summary import damping_sentences, other_sentences, term_sheet, verdict


@pytest.fixture(scope="module")
def frictionless():
    return limit_study("paper-3.4-frictionless", foundations=())


def test_without_friction_there_is_nothing_to_tend_to(frictionless):
    """What is left of differences of energies is no loss, and 0 has no sign."""
    terms = frictionless.prediction.terms
    assert terms["friction_loss"].limit == 0
    assert all(str(c) == "0.0" for term in terms.values() for _, c in term.powers)
    _, approach = term_sheet(frictionless).columns
    assert approach.cells == ["0"] * len(terms)
    assert verdict(frictionless).endswith(" is 0 at any stiffness: there is no friction.")
    said = "; ".join(other_sentences(frictionless))
    assert "like" not in said
    assert "no limit seen" not in said


def test_a_hoop_that_slips_throughout_has_its_ratio_at_any_stiffness():
    """-mu or mu, seen to the last bits: their round-off is no want of a limit."""
    study = limit_study("paper-3.4-slippery", foundations=())
    mu = load_scene("paper-3.4-slippery").friction.mu
    assert f" is {mu:.6g} at any stiffness: " in verdict(study)
    assert "no limit seen" not in "; ".join(other_sentences(study))


@pytest.mark.parametrize("mass_ratio", [0.0, 0.1])
def test_a_hoop_that_spins_throughout_has_a_ratio_that_nothing_changes(mass_ratio):
    """J_N changes, and J_F by mu times that: what rounding leaves of their difference is no coefficient."""
    scene = load_scene("paper-3.3-massless").replace(
        hoop={"k": 0.5, "mass_ratio": mass_ratio}, friction={"mu": 0.1, "mu_s": 0.1}, contact={"law": "regularised"}
    )
    terms = predict(scene).terms
    assert terms["impulse_ratio"].limit == pytest.approx(0.1, rel=1e-14)
    assert terms["normal_impulse"].coefficient > 1e-2
    assert terms["friction_impulse"].coefficient == pytest.approx(0.1 * terms["normal_impulse"].coefficient, rel=1e-9)
    assert terms["impulse_ratio"].coefficient == 0


@pytest.fixture(scope="module")
def tiny():
    """k = 1e-5."""
    return limit_study("paper-3.4-tiny", foundations=())


def test_a_patch_that_comes_nowhere_near_its_limit_has_none_seen(tiny):
    """At any possible foundation its patch slips throughout; of the smoothed law the slip that starts long before the
    pulse leads, and what leaves that out has a first term of v_s itself."""
    told = {other.name: other for other in tiny.others}
    assert told["patch, any damping"].tends
    assert not told["patch, no damping"].tends
    assert told["regularised, any damping"].prediction.terms["impulse_ratio"].exponent == 4 / 5
    alone = predict(load_scene("paper-3.4-tiny").replace(contact={"law": "regularised"}), 1.0)
    assert alone.terms["impulse_ratio"].exponent == 1
    assert "no damping: -0.3000 to -0.3000, no limit seen" in "".join(other_sentences(tiny))


def test_a_limit_that_could_not_be_seen_is_not_said_to_be_missing(tiny):
    """Layers that are separate from 2e23 on, far above all that is tried."""
    assert tiny.separate > 1e20
    (said,) = [each for each in other_sentences(tiny) if each.startswith("patch, no damping")]
    assert said.endswith("no limit seen, nor would one be: up to 1e+12, the largest foundation tried, the layers are "
                         "not separate")  # fmt: skip
    usual = limit_study("paper-3.3-massless", foundations=())
    (said,) = [each for each in other_sentences(usual) if each.startswith("patch, no damping")]
    assert said.endswith("no limit seen")


def test_a_foundation_that_cannot_be_is_refused_before_the_work(hoop, monkeypatch):
    monkeypatch.setattr("studies.limit.study.predict", lambda scene: pytest.fail("this is the work"))
    status, out, err = hoop("study", "limit", "paper-3.3-heavier", "--flexible", "1e12", "--flexible", "1e99")
    assert (status, out) == (2, "")
    assert "contact.stiffness = 1e+99 is not possible" in err
    assert is_one_sentence(err)


def test_without_damping_the_limit_is_that_of_the_least_of_it():
    """A patch that rings breaks its stick for ever: of it no limit is seen, of the least damping the paper's."""
    study = limit_study(load_scene("paper-3.3-massless").replace(contact={"damping": 0.0}), foundations=())
    assert verdict(study).startswith("Made ever stiffer, with the least of damping, the hoop")
    assert "no limit seen" in other_sentences(study)[-1]
    damped = limit_study("paper-3.3-massless", foundations=())
    assert verdict(damped).startswith("Made ever stiffer, the hoop")


def test_it_is_said_where_a_ring_is_softer_than_the_patch():
    """The slip of the heavier hoop ends where its wall bends, that of the massless one over the weld."""
    for name, told in (("paper-3.3-heavier", True), ("paper-3.3-massless", False)):
        found = limit_study(name, foundations=())
        said = [each for each in damping_sentences(found) if each.startswith("All this is of a rigid rim")]
        assert bool(said) == told == (found.stiff > 1e6)
        assert found.to_dict()["stiff"] == found.stiff


def test_smoothed_friction_is_less_than_mu_n_where_it_slips_throughout():
    """mu N v/sqrt(v^2 + v_s^2): it comes to mu as v_s does to 0, and is not mu before."""
    scene = load_scene("paper-3.4-slippery").replace(contact={"law": "regularised", "slip_velocity_scale": 0.1})
    study = limit_study(scene, foundations=(1e10, 1e12))
    mu, seen = scene.friction.mu, [sight.values["impulse_ratio"] for sight in study.sights]
    assert abs(seen[0]) < abs(seen[1]) < mu
    said = verdict(study)
    assert "at any stiffness" not in said
    assert "what is left falls faster" in said


def test_an_undamped_patch_that_rings_on_is_not_said_to_be_as_good():
    """No layer breaks it anew, but it never comes to rest, and breaks out of its stick before the rigid hoop does."""
    scene = load_scene("paper-3.3-massless").replace(
        hoop={"k": 0.15, "r": 1.05}, friction={"mu_s": 0.45, "mu": 0.35}, release={"phi0_deg": 12}
    )
    said = damping_sentences(limit_study(scene, foundations=()))
    assert any("even undamped" in sentence for sentence in said)
    assert any("no limit of J_F/J_N is seen" in sentence for sentence in said)
