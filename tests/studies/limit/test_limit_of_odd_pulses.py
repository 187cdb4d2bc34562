"""Pulses that begin in other ways than between two events: with one of them, behind a turn, inside the release."""

from __future__ import annotations

from math import isfinite, pi, radians

import pytest

import flexible
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve, load_scene, simulate
from studies import StudyError, limit_study
from studies.inner.events import START, passage
from studies.inner.separate import separate_from
from studies.limit.compliant import at_foundation, go_through
from studies.limit.damping import damping_map
from studies.limit.prediction import predict
from studies.limit.summary import damping_sentences, failures, other_sentences


def mirrored(scene: Scene) -> Scene:
    release = scene.release
    return scene.replace(release={"phi0": 2 * pi - release.phi0, "omega0": -release.omega0, "slip0": -release.slip0})


@pytest.mark.parametrize(
    ("k", "friction", "phi0", "way"),
    [(0.1288514653360209, (1.1575017687454352, 0.826786977675311), 10, -1),
     pytest.param(
         0.12605168725554625, (0.8581989965296009, 0.6129992832354292), 30, 1, marks=pytest.mark.slow)],
)  # fmt: skip
def test_a_pulse_that_begins_with_an_event(k, friction, phi0, way):
    """N jumps over the weight as the spin ends or turns round: what is gained counts from before that."""
    scene = Scene(Hoop(k, 1.02), Friction(*friction), Release(radians(phi0)), run=Run(until="pulse"))
    scene = scene if way > 0 else mirrored(scene)
    course = passage(scene)
    assert course.events[0].psi == course.edges[0]
    terms, through = predict(scene).terms, go_through(at_foundation(scene, 1e12), fineness=0.02)
    for name in ("normal_impulse", "friction_impulse"):
        term, seen = terms[name], getattr(through, name)
        assert (seen - term.limit) * 1e4 == pytest.approx(term.coefficient, rel=0.02)


def test_a_pulse_behind_a_turn_begins_behind_it():
    hoop, release = Hoop(0.327, 1.02, 1.0), Release(radians(154.826), -0.344, 1.686)
    scene = Scene(hoop, Friction(0.515, 0.368), release, run=Run(until="pulse"))
    term = predict(scene).terms["friction_impulse"]
    seen = go_through(at_foundation(scene, 1e10)).friction_impulse
    assert (seen - term.limit) * 1e10 ** (1 / 3) == pytest.approx(term.coefficient, rel=0.02)


@pytest.mark.parametrize("phi0_deg", [175, 182])
def test_a_pulse_behind_one_that_the_release_cuts_is_not_foreseen(phi0_deg):
    """What events in the one before have done to the state in which the hoop comes to it is of the same order."""
    scene = Scene(Hoop(0.1, 1.02), Friction(0.35, 0.3), Release(radians(phi0_deg), 2.0), run=Run(until="pulse"))
    with pytest.raises(StudyError, match="released inside a pulse"):
        passage(scene)


def test_the_map_of_a_regularised_law_smooths_less_on_a_stiffer_floor():
    scene = load_scene("paper-3.3-massless").replace(contact={"law": "regularised"}, run={"until": "pulse"})
    (spot,) = damping_map(scene, dampings=(1.0,), foundations=(1e12,))
    assert spot.impulse_ratio - spot.limit == pytest.approx(spot.predicted - spot.limit, rel=0.2)


@pytest.mark.slow
def test_little_damping_settles_late_and_a_hoop_that_rolls_has_a_limit_without():
    scene = load_scene("paper-3.3-massless").replace(contact=Contact(damping=0.003), run={"until": "pulse"})
    assert isfinite(separate_from(passage(scene)))
    study = limit_study("paper-3.3-same-density", foundations=())
    assert "no limit seen" not in "".join(other_sentences(study))
    assert not any("without damping" in said for said in damping_sentences(study))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper-3.1", "paper-3.2-k0.25", "paper-3.3-heavier"])
def test_a_smoothed_law_has_a_layer_where_a_slip_starts(name):
    """Nothing jumps there, and |F| = mu N throughout; to the last bit, which no finite V carries."""
    scene = load_scene(name).replace(contact={"law": "regularised"})
    found = limit_study(scene, foundations=())
    starts = [event for event in found.events if event.event.kind == START]
    assert starts
    for start in starts:
        layer = start.layer
        assert abs(start.before[1]) == pytest.approx(scene.friction.mu * start.before[0], rel=1e-12)
        assert layer.friction_force == pytest.approx(start.before[1], rel=1e-6)
        assert layer.normal_force == pytest.approx(start.before[0], rel=1e-6)


@pytest.mark.parametrize("phi0_deg", [10, -10])
def test_an_event_is_where_the_rigid_motion_has_it(phi0_deg):
    """A hoop that rolls left comes to the bottom at phi = -180 degrees."""
    scene = load_scene("paper-3.1").replace(release={"phi0_deg": phi0_deg}, run={"until": "pulse"})
    begins = [phase.phi_start for phase in simulate(scene).phases]
    events = passage(scene).events
    assert events
    for event in events:
        assert min(abs(event.phi - phi) for phi in begins) < 1e-12


@pytest.mark.slow
def test_a_strong_damper_has_its_layers_and_its_runs():
    """A damper that carries all of F, but for A/(theta Omega) of it, some 1e-3, creeps at F/(2 kappa A theta)."""
    study = limit_study(load_scene("paper-3.3-massless").replace(contact={"damping": 1000}), foundations=(1e13,))
    weaker = predict(study.scene.replace(contact={"damping": 200})).terms["impulse_ratio"].coefficient
    assert study.prediction.terms["impulse_ratio"].coefficient == pytest.approx(weaker / 5, rel=5e-3)
    assert all(found.layer is not None for found in study.events)
    assert not failures(study)
    assert study.separate > 1e13  # its springs take eps theta to carry N
    # over eps it is off by the creep and by what its springs still lack, which is of that size
    (row,) = study.to_dict()["observed"]["impulse_ratio"]
    assert abs(row["coefficient"]) < 10 * abs(row["predicted"])


def test_what_takes_too_many_steps_costs_its_rows_alone(monkeypatch):
    """The prediction of a stick that is kept needs no layer: it is there."""
    monkeypatch.setattr("studies.inner.layers.MOST", 10)
    monkeypatch.setattr("studies.limit.compliant._MOST", 10)
    study = limit_study(load_scene("paper-3.3-massless").replace(contact={"damping": 1000}), foundations=(1e13, 1e14))
    assert study.prediction.terms["impulse_ratio"].coefficient
    assert [found.layer for found in study.events] == [None] * len(study.events)
    said = failures(study)
    assert len(said) == len(study.events) + len(study.sights)
    assert [line.split(",")[0] for line in said[-2:]] == ["Foundation 1e+13", "Foundation 1e+14"]
    assert all(line.endswith("it lasts far longer than the fastest in it takes.") for line in said)
    assert "failure" in study.to_dict()["events"][0]


def test_another_law_whose_pulse_is_not_foreseen_is_left_out():
    """The study of a smoothed friction says what the three laws tend to, of which a patch is released in its pulse."""
    scene = Scene(
        Hoop(0.3, 1.02, 0.05), Friction(1.2, 0.3), Release(radians(150), 1.0), contact=Contact(law="regularised")
    )
    with pytest.raises(StudyError):
        predict(scene.replace(contact={"law": "patch", "damping": 0.0}))
    found = limit_study(scene)
    assert found.others
    assert not any("no damping" in other.name for other in found.others)


@pytest.mark.slow
@pytest.mark.parametrize(("mu_s", "rtol"), [(0.35, 5e-7), (0.4, 2e-6), (0.45, 1e-5)])
def test_a_brush_on_a_thin_wall_breaks_loose_as_on_a_rigid_ring(mu_s, rtol):
    """By another model, of another's bristles: 1e-4, what a patch of 5e-3 R leaves of it.

    Were all its points static as soon as they rest, the brush would break loose twenty times over, for a J_N that is 1
    to 5e-3 larger, on a wall however stiff, but for a rigid one (:mod:`flexible.contact.laws.brush`).
    """
    scene = Scene(
        Hoop(0.1, 1.02), Friction(mu_s, 0.3), Release(radians(10)), Run(until="pulse"),
        contact=Contact(law="brush", stiffness=1e8, damping=1.0), ring=Ring(1e4), solve=Solve(rtol=rtol),
    )  # fmt: skip
    rigid, (wall,) = go_through(scene), flexible.simulate(scene).pulses
    assert wall.normal_impulse == pytest.approx(rigid.normal_impulse, rel=1e-4)
    assert wall.friction_impulse == pytest.approx(rigid.friction_impulse, abs=1e-4 * rigid.normal_impulse)
