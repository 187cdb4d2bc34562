"""A limit study as a picture and as a table."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rigid import Run, load_scene, simulate
from studies import LimitStudy, limit_study
from studies.inner.events import passage
from studies.inner.layers import layer, outer_forces
from studies.limit.compliant import Sight
from studies.limit.damping import Spot
from studies.limit.prediction import predict
from studies.limit.study import OBSERVED, EventFound
from studies.limit.summary import (
    damping_sentences,
    event_sheet,
    limit_sheets,
    map_sheet,
    sight_sheet,
    unlike_sentences,
)

AWAY = 1.05
"""Observed over predicted distance of a solver made up here."""


@pytest.fixture(scope="module")
def study():
    scene = load_scene("paper-3.3-massless").replace(run=Run(until="pulse"))
    prediction = predict(scene)
    sights = []
    for foundation in (1e10, 1e11):
        terms = {name: prediction.terms[name] for name in OBSERVED}
        values = {n: t.limit + AWAY * (float(t.at(foundation ** (-1 / 3))) - t.limit) for n, t in terms.items()}
        sights.append(Sight("rigid ring", foundation, values, {}))
    sights.append(Sight("flexible", 1e12, {}, {}, "it stopped"))
    return LimitStudy(scene, (), prediction, 0.0, tuple(sights), ())


def test_a_panel_for_each_measure_with_the_line_and_what_was_seen(study):
    from matplotlib import pyplot

    panels = study.plot()
    assert [axes.get_title() for axes in panels] == ["$J_F$/$J_N$", r"$J_F$ [$m\sqrt{gR}$]", r"$J_N$ [$m\sqrt{gR}$]"]
    for axes, name in zip(panels, OBSERVED, strict=False):
        line, seen = axes.get_lines()  # nothing of the solver that failed
        foreseen = np.interp(np.log(seen.get_xdata()), np.log(line.get_xdata()), np.log(line.get_ydata()))
        # the line is a power law, straight on these axes; 60 points over five decades
        assert np.log(seen.get_ydata()) - foreseen == pytest.approx(np.log(AWAY), abs=1e-2), name
    (one,) = study.plot("friction_loss")
    assert one.get_title() == "friction loss [$mgR$]"
    with pytest.raises(ValueError, match="2 measures need as many axes, not 1"):
        study.plot("impulse_ratio", "normal_impulse", axes=one)
    pyplot.close("all")


def test_panels_say_their_units(study):
    from matplotlib import pyplot

    si = dataclasses.replace(study, scene=study.scene.replace(hoop={"R": 0.5, "m": 0.3, "g": 9.81}))
    assert [axes.get_title() for axes in si.plot()] == ["$J_F$/$J_N$", "$J_F$ [N s]", "$J_N$ [N s]"]
    pyplot.close("all")


def test_the_table_has_a_row_for_each_measure_of_each_run(study):
    frame = study.to_dataframe()
    assert len(frame) == 3 * len(OBSERVED)
    seen = frame[frame["failure"] == ""]
    assert (seen["distance"] / seen["predicted"]).tolist() == pytest.approx([AWAY] * len(seen), rel=1e-6)
    assert (seen["value"] - seen["limit"]).tolist() == seen["distance"].tolist()
    assert set(frame[frame["failure"] != ""]["solver"]) == {"flexible"}


def test_the_table_has_no_row_of_a_measure_that_was_not_seen(study):
    """A rigid ring on a floor of another law sees no loss: that is no failure; and no run has all columns."""
    blind = [
        dataclasses.replace(s, values={k: v for k, v in s.values.items() if k != OBSERVED[0]}) for s in study.sights
    ]
    frame = dataclasses.replace(study, sights=tuple(blind)).to_dataframe()
    assert not ((frame["measure"] == OBSERVED[0]) & (frame["failure"] == "")).any()
    assert frame[frame["failure"] == ""]["value"].notna().all()
    none = dataclasses.replace(study, sights=()).to_dataframe()
    assert list(none.columns) == list(study.to_dataframe().columns)


def columns_of(sheet) -> dict[str, list[str]]:
    """The cells of a sheet by heading; of headings that stand twice a list behind the other."""
    columns: dict[str, list[str]] = {}
    for column in (*sheet.keys, *sheet.columns):
        columns.setdefault(column.heading.replace("\n", " "), []).extend(column.cells)
    return columns


def test_the_sheet_of_what_was_seen_divides_both_distances_by_one_power(study):
    """Of a solver that is off by 1.05 of what is predicted: at any foundation the coefficient, and 1.05 times that."""
    told = columns_of(sight_sheet(study))
    assert told["observed/ predicted"] == [f"{AWAY:.3f}"] * 2 * len(OBSERVED)
    for i, name in enumerate([*OBSERVED, *OBSERVED]):
        coefficient = study.prediction.terms[name].coefficient
        assert float(told["predicted"][i]) == pytest.approx(coefficient, rel=1e-3)  # four digits
        assert float(told["distance over power"][i]) == pytest.approx(AWAY * coefficient, rel=1e-3)


def seen_off(study, times):
    """The study with a rigid ring at 1e12 whose J_N is off by so many times what is predicted, all else by once."""
    values = {}
    for name in OBSERVED:
        term = study.prediction.terms[name]
        share = times if name == "normal_impulse" else 1.0
        values[name] = term.limit + share * (float(term.at(1e-4)) - term.limit)
    return dataclasses.replace(study, sights=(*study.sights, Sight("rigid ring", 1e12, values, {})))


@pytest.mark.parametrize(
    ("times", "told"),
    [(1.9, None), (0.6, None), (2.5, "2.5"), (0.3, "0.3"), (-1.0, "-1")],
)
def test_it_is_said_where_the_stiffest_pulse_is_not_as_predicted(study, times, told):
    """Not the sign, or less than half or more than twice the size; and whether layers or further terms are why."""
    off = seen_off(study, times)
    said = unlike_sentences(off)
    assert [row["measure"] for row in off.to_dict()["unlike"]] == ["normal_impulse"] * len(said)
    assert said == [each for each in limit_sheets(off) if each in said], "it stands among the sheets"
    if told is None:
        assert said == []
        return
    start = (
        f"At a foundation of 1e+12, the stiffest here, the rigid ring is off in J_N by {told} times what is predicted"
    )
    assert said == [f"{start}: terms behind the first are not small there yet."]
    soft = unlike_sentences(dataclasses.replace(off, separate=1e13))
    assert soft == [f"{start}: its layers are not separate there yet."]
    assert off.to_dict()["unlike"][0]["over_predicted"] == pytest.approx(times, rel=1e-6)
    assert set(off.to_dict()["unlike"][0]) & {"foundation", "over_predicted"} <= set(off.units)


def test_a_softer_pulse_or_one_within_its_error_is_not_said_to_be_unlike(study):
    """What is off at 1e9 is not at 1e11; and a run that knows its error is not held to what is less."""
    off = seen_off(study, 2.5)
    soft = dataclasses.replace(off.sights[-1], foundation=1e9)
    assert unlike_sentences(dataclasses.replace(off, sights=(*study.sights, soft))) == []
    term = study.prediction.terms["normal_impulse"]
    rough = dataclasses.replace(off.sights[-1], errors={"normal_impulse": 2 * abs(float(term.at(1e-4)) - term.limit)})
    assert unlike_sentences(dataclasses.replace(off, sights=(*study.sights, rough))) == []


@pytest.mark.slow
def test_far_from_its_limit_a_strongly_damped_patch_is_said_to_be():
    """Springs behind a damper of 100 take eps theta: of a rigid ring at 1e10 the predicted creep is not there yet."""
    found = limit_study(load_scene("paper-3.3-massless").replace(contact={"damping": 100.0}), foundations=(1e10,))
    (said,) = unlike_sentences(found)
    assert "in J_F/J_N by -" in said
    assert said.endswith("its layers are not separate there yet.")
    assert (
        unlike_sentences(
            limit_study(load_scene("paper-3.3-massless").replace(contact={"damping": 1.0}), foundations=(1e12,))
        )
        == []
    )


def test_the_sheet_of_events_has_the_forces_of_the_rigid_hoop(study):
    """Spin, roll, skid: F = mu N before the first event and -mu N behind the last, the angles those of the phases."""
    way = passage(study.scene)
    events = []
    for event in way.events:
        sides = [outer_forces(way.body, event, behind) for behind in (False, True)]
        events.append(EventFound(event, *sides, layer(way.body, way.contact, event, 0.5), 0.1, 0.0))
    told = columns_of(event_sheet(dataclasses.replace(study, events=tuple(events))))
    phases = [phase for phase in simulate(study.scene).phases if phase.t_start >= way.pulse.t_start]
    assert [float(cell) for cell in told["phi [deg]"]] == pytest.approx(
        [np.degrees(phase.phi_start) for phase in phases[:2]], abs=6e-4
    )
    n_before, n_behind = (float(told[f"{side} [Mg]"][place]) for side, place in (("N before", 0), ("behind", 1)))
    f_before, f_behind = (float(told[f"{side} [Mg]"][place]) for side, place in (("F before", 0), ("behind", 3)))
    mu = study.scene.friction.mu
    assert f_before / n_before == pytest.approx(mu, rel=1e-4)  # five digits
    assert f_behind / n_behind == pytest.approx(-mu, rel=1e-4)


def test_a_map_has_dampings_down_and_foundations_across():
    spots = [Spot(d, f, 1.0, d + f / 1e12, 0.0, 0.0) for f in (1e11, 2e11) for d in (0.1, 0.5, 0.2)]
    told = columns_of(map_sheet(spots))
    assert told["damping"] == ["0.1", "0.2", "0.5"]
    assert [float(cell) for cell in told["1e+11"]] == pytest.approx([0.2, 0.3, 0.6])
    assert [float(cell) for cell in told["2e+11"]] == pytest.approx([0.3, 0.4, 0.7])


@pytest.mark.parametrize(("damping", "word"), [(0.3, "above"), (0.05, "below")])
def test_a_damping_is_said_to_be_on_the_side_of_the_critical_one_on_which_it_is(study, damping, word):
    way = passage(study.scene)
    event = way.events[0]
    history = layer(way.body, way.contact, event, 0.5)
    found = EventFound(event, (1.0, 0.3), (1.0, 0.1), history, 0.1, 0.0)
    scene = study.scene.replace(contact={"damping": damping})
    (said, *_) = damping_sentences(dataclasses.replace(study, scene=scene, events=(found,)))
    assert said.startswith("Below a damping ratio of 0.1 ")
    assert "for the time of the layer: with any damping at all the limit is the same below it" in said  # mu N holds it
    assert said.endswith(f"this scene's {damping} is {word} it.")


@pytest.mark.parametrize("form", [(), ("--json",)])
def test_the_command_leaves_with_1_where_a_case_failed(hoop, study, monkeypatch, form):
    for sights, status in ((study.sights, 1), (study.sights[:-1], 0)):
        told = dataclasses.replace(study, sights=sights)
        monkeypatch.setattr("studies.limit.study.limit_study", lambda *_, told=told, **__: told)
        assert hoop("study", "limit", "paper-3.3-massless", "--workers", 1, *form)[0] == status
