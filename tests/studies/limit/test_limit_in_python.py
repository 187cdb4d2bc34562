"""A limit study as a picture and as a table."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rigid import Run, load_scene
from studies import LimitStudy
from studies.limit.compliant import Sight
from studies.limit.prediction import predict
from studies.limit.study import OBSERVED

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
    assert [axes.get_title() for axes in panels] == ["J_F/J_N", "J_F", "J_N"]
    for axes, name in zip(panels, OBSERVED, strict=False):
        line, seen = axes.get_lines()  # nothing of the solver that failed
        foreseen = np.interp(np.log(seen.get_xdata()), np.log(line.get_xdata()), np.log(line.get_ydata()))
        # the line is a power law, straight on these axes; 60 points over five decades
        assert np.log(seen.get_ydata()) - foreseen == pytest.approx(np.log(AWAY), abs=1e-2), name
    (one,) = study.plot("friction_loss")
    assert one.get_title() == "friction loss"
    with pytest.raises(ValueError, match="2 measures need as many axes, not 1"):
        study.plot("impulse_ratio", "normal_impulse", axes=one)
    pyplot.close("all")


def test_the_table_has_a_row_for_each_measure_of_each_run(study):
    frame = study.to_dataframe()
    assert len(frame) == 3 * len(OBSERVED)
    seen = frame[frame["failure"] == ""]
    assert (seen["distance"] / seen["predicted"]).tolist() == pytest.approx([AWAY] * len(seen), rel=1e-6)
    assert (seen["value"] - seen["limit"]).tolist() == seen["distance"].tolist()
    assert set(frame[frame["failure"] != ""]["solver"]) == {"flexible"}


@pytest.mark.parametrize("form", [(), ("--json",)])
def test_the_command_leaves_with_1_where_a_case_failed(hoop, study, monkeypatch, form):
    for sights, status in ((study.sights, 1), (study.sights[:-1], 0)):
        told = dataclasses.replace(study, sights=sights)
        monkeypatch.setattr("studies.limit.study.limit_study", lambda *_, told=told, **__: told)
        assert hoop("study", "limit", "paper-3.3-massless", "--workers", 1, *form)[0] == status
