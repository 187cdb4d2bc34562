"""What the page of a stiffness study says, and when; what its figures show where curves coincide."""

from __future__ import annotations

import base64
import html
import io
import json
import re
import tomllib
from concurrent.futures import Future
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas
import pytest
from images import pixels

from rigid import load_scene, scene_from_dict, simulate
from studies import Ladder, StudyError, limit_of, stiffness_study
from studies.cli import hoop as cli
from studies.cli.shared.tables import study_tables
from studies.limit.prediction import predict
from studies.machine.processes import WorkerDied
from studies.plots.difference import (
    FORCES,
    at_the_same_angle,
    at_the_same_normal_impulse,
    impulses_along,
    passage_of,
)
from studies.running import history
from studies.running.workers import Here
from studies.stiffness.extrapolation.cases import CONFIDENCE
from studies.stiffness.extrapolation.limits import fitted_series
from studies.stiffness.told import report
from studies.stiffness.told.figures import distances, impulse_space
from studies.stiffness.told.rows import case_cells, case_heading, rigid_cells, side_heading
from studies.stiffness.told.sentences import ladder_sentence, prediction_sentence, verdict

THIRD = "third_solver:softened"
LINE = ("study", "stiffness", "paper-3.3-massless", "--solver", THIRD, "--workers", 1, "--count", 5)


@pytest.fixture(scope="module")
def study():
    return stiffness_study("paper-3.3-massless", solver=THIRD)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    out = tmp_path_factory.mktemp("page")
    assert cli.run([*map(str, LINE), "--damping", "0.5", "--law", "brush", "--out", str(out)]) == 0
    return (out / "report.html").read_text(encoding="utf-8"), out


def test_the_folder_holds_table_figures_and_page(page):
    names = {path.name for path in page[1].iterdir()}
    assert {"study.json", "report.html", "pulse.png", "impulses.png", "distance.png", "study.sqlite"} <= names
    assert not [name for name in names if name.startswith(".part")]


@pytest.mark.parametrize("name", ["pulse", "impulses", "distance"])
def test_a_figure_is_not_blank(page, name):
    image = pixels(page[1] / f"{name}.png")
    assert image.shape[0] > 400
    inked = (image < 230).any(axis=2)
    assert 0.005 < inked.mean() < 0.6


def test_the_page_needs_nothing_but_itself(page):
    text = page[0]
    assert not re.findall(r"""(?:src|href)\s*=\s*["'](?!data:)""", text)
    assert text.count("data:image/svg+xml;base64,") >= 3
    assert "http" not in re.sub(r"data:[^\"]*", "", text)
    for word in ("hoop study stiffness", "numpy", "[hoop]", "J_F/J_N", "numerical error"):
        assert word in text


def test_the_first_sentence_answers_in_words_and_says_what_its_symbols_are(page, study):
    lead = html.unescape(re.search(r'<p class="lead">(.*?)</p>', page[0], re.S)[1])
    for words in (lead, verdict(study)):
        assert re.match(r"(Yes|No|Open): ", words)
        first = words.partition("J_F/J_N")[2]
        assert first.startswith(" (friction impulse over normal impulse")
        assert "friction loss (energy that sliding takes in it)" in words


@pytest.mark.parametrize(("rigid", "word"), [(0.0, "Yes"), (0.5, "No")])
def test_the_verdict_is_that_of_the_intervals(study, rigid, word):
    """A rigid value that is the limit, or half a unit beside it, which is far outside any interval here."""
    limits = {name: replace(limit, rigid=limit.value + rigid) for name, limit in study.limits.items()}
    assert verdict(replace(study, limits=limits)).startswith(f"{word}: ")


@pytest.mark.parametrize(("halves", "word"), [(0.9, "Yes"), (1.15, "Open"), (1.9, "Open"), (2.1, "No")])
def test_one_miss_in_twenty_is_no_answer(study, halves, word):
    """A rigid value beside the interval, which at 95 % it is one time in twenty, is told to be so, and by how much."""
    limits = {name: replace(limit, rigid=limit.value) for name, limit in study.limits.items()}
    loss = limits["friction_loss"]
    limits["friction_loss"] = replace(loss, rigid=loss.value + halves * loss.uncertainty)
    told = verdict(replace(study, limits=limits))
    assert told.startswith(f"{word}: ")
    assert (f"{halves:g} of its half widths off" in told) == (halves > 1)
    assert ("a smaller rtol or more rungs decide" in told) == (word == "Open")


def test_an_interval_that_is_too_wide_is_not_for_want_of_rungs(study):
    limits = {name: replace(limit, span=limit.uncertainty / 2) for name, limit in study.limits.items()}
    told = verdict(replace(study, limits=limits))
    assert told.startswith("Open: ")
    assert told.count("wider than all that was measured: a longer ladder or a smaller rtol") == 2
    assert "too few" not in told


def test_a_ladder_of_bending_stiffness_names_its_rungs_by_that():
    found = stiffness_study("paper-3.3-massless", Ladder("bending", 1e2, 1e6, 5), solver=THIRD)
    assert [float(cell) for cell in side_heading(found)[2:]] == pytest.approx(found.ladder.stiffness, rel=1e-2)
    broken = replace(found.rungs[0], outcome=replace(found.rungs[0].outcome, failure="it broke"))
    told = study_tables(replace(found, rungs=(broken, *found.rungs[1:])))
    assert "Bending stiffness 100 failed: it broke" in told


def test_the_page_says_what_restitutions_it_lists(study, tmp_path):
    text = html.unescape(report.stiffness_report(study, {}, "hoop", tmp_path / "page.html").read_text(encoding="utf-8"))
    for row in ("e Newton", "e Poisson", "e energetic"):
        assert row in text
    for word in ("restitutions of the pulse, by the vertical velocity of the mass centre", "Newton's", "Poisson's"):
        assert word in text


def test_captions_speak_of_what_is_drawn(study):
    """Of a line that is foreseen where one is, and of how many cases have a curve where not all have."""
    assert ["black" in report.captions(each)["distance"] for each in (study, foreseen(study))] == [False, True]
    for separate, words in ((1e8, "begins where they are the beginning of a series"), (0.0, "is not foretold here")):
        assert words in report.captions(replace(foreseen(study), separate=separate))["distance"]
    drawn = [dict.fromkeys(("t", "phi"), np.zeros(1))]
    six = [replace(rung, outcome=replace(rung.outcome, histories=tuple(drawn))) for rung in study.rungs[:6]]
    for rungs, told in ((six, True), (six[:5], False)):
        under = report.captions(replace(study, rungs=tuple(rungs)))
        for name in ("pulse", "impulses"):
            assert ("Of the 6 cases 5 are drawn" in under[name]) == told


def test_the_scene_is_shown_as_it_was_run(page):
    told = html.unescape(re.search(r"The scene as it was run</h2>\s*<pre>(.*?)</pre>", page[0], re.S)[1])
    shown = scene_from_dict(tomllib.loads(told))
    assert shown == scene_from_dict(json.loads((page[1] / "study.json").read_text())["scene"])
    assert (shown.contact.damping, shown.contact.law, shown.run.until) == (0.5, "brush", "pulse")


def tables(text):
    """Those of a page, each a list of rows of cells, the heading first."""
    return [
        [
            [html.unescape(cell) for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.S)]
            for row in re.findall(r"<tr[^>]*>(.*?)</tr>", table, re.S)
        ]
        for table in re.findall(r"<table>(.*?)</table>", text, re.S)
    ]


def column(table, heading):
    """The numbers under a heading; NaN where there is none."""
    at = table[0].index(heading)
    return [float("nan" if row[at] == "-" else row[at]) for row in table[1:]]


def test_every_number_stands_under_its_heading(study, tmp_path):
    """The limits, the cases from soft to stiff with the rigid hoop last, and measures, as the study holds them."""
    path = report.stiffness_report(study, {}, "hoop", tmp_path / "page.html")
    limits, cases, side = tables(path.read_text(encoding="utf-8"))
    held = list(study.limits.values())
    assert column(limits, "value") == pytest.approx([limit.value for limit in held], abs=1e-6)
    assert column(limits, "rigid") == pytest.approx([limit.rigid for limit in held], abs=1e-6)
    assert column(limits, "rate") == pytest.approx([limit.rate for limit in held], rel=1e-2, nan_ok=True)
    pulses = [rung.outcome.pulses[0] for rung in study.rungs]
    stiffness = [rung.contact_stiffness for rung in study.rungs]
    assert stiffness == sorted(stiffness)
    assert [float(row[0]) for row in cases[1:-1]] == pytest.approx(stiffness, rel=1e-2)
    assert cases[-1][0] == "rigid"
    every = [*pulses, study.reference.pulses[0]]
    assert [float(row[2]) for row in cases[1:]] == pytest.approx([p["impulse_ratio"] for p in every], abs=1e-5)
    assert [float(row[4]) for row in cases[1:]] == pytest.approx([p["friction_loss"] for p in every], abs=1e-5)
    assert all(len(row) == len(cases[0]) for row in cases)
    assert [cases[0][at].split("\n")[0] for at in (2, 4)] == ["J_F/J_N", "friction loss"]
    rows = {row[0].partition(", ")[0]: row[1:] for row in side[1:]}
    for symbol, name in (("J_N", "normal_impulse"), ("duration", "duration"), ("peak N", "peak_normal_force")):
        told = [study.reference.pulses[0][name], *(pulse[name] for pulse in pulses)]
        assert [float(cell) for cell in rows[symbol]] == pytest.approx(told, rel=1e-4)


def test_a_page_holds_its_pictures_and_says_how_it_was_made(study, tmp_path):
    """Markup in a command is no markup of the page."""
    drawn = {"pulse": tmp_path / "pulse.svg", "energy": tmp_path / "energy.png"}
    for name, file in drawn.items():
        file.write_bytes(name.encode())
    line = "hoop study stiffness 'a <b> & c'"
    text = report.stiffness_report(study, drawn, line, tmp_path / "page.html").read_text(encoding="utf-8")
    assert html.unescape(re.search(r"How this page was made</h2>\s*<pre>(.*?)</pre>", text, re.S)[1]) == line
    assert "<b>" not in text
    found = re.findall(r'<img alt="([^"]*)"\s*src="data:image/([^;]*);base64,([^"]*)"', text)
    kinds = {"pulse": "svg+xml", "energy": "png"}
    assert [(alt, kind, base64.b64decode(data).decode()) for alt, kind, data in found] == [
        (html.escape(report.captions(study)[name], quote=True), kinds[name], name) for name in drawn
    ]


def test_the_numbers_lie_beside_the_page_and_in_it(page):
    text, out = page
    frame = pandas.read_csv(out / "study.csv", dtype=str)  # not every pandas reads numbers to the last bit
    cases = json.loads((out / "study.json").read_text())["cases"]
    assert frame["impulse_ratio"].map(float).tolist() == [case["impulse_ratio"] for case in cases]
    held = re.search(r'download="study.csv" href="data:text/plain;base64,([^"]*)"', text)[1]
    pandas.testing.assert_frame_equal(pandas.read_csv(io.BytesIO(base64.b64decode(held)), dtype=str), frame)
    # no fields: this solver has none, and the page does not name them
    assert "fields.pvd" not in text


def test_a_table_keeps_its_last_column_where_it_is_too_wide(page):
    style = re.search(r"<style>(.*?)</style>", page[0], re.S)[1]
    assert re.search(r"td:last-child \{ position: sticky; right: 0;", style)
    # and there is room for all of it at 1400 px: 86 rem are 1376
    assert "max-width: 86rem" in style


@pytest.mark.slow
def test_the_page_comes_when_all_that_it_names_is_there(hoop, tmp_path, monkeypatch):
    """Fields that cannot be written are told; the page is whole without them, and an older one is gone meanwhile."""
    import studies.cli.shared.output as output
    from studies.plots import page as pages

    seen = []
    (tmp_path / "report.html").write_text("old")
    (tmp_path / "command.txt").write_text("hoop study stiffness paper-3.3-massless")  # an earlier run of the same

    def fails(*_: object) -> None:
        seen.append((tmp_path / "report.html").exists())
        raise StudyError("fields.pvd cannot be used: the disk is full.")

    monkeypatch.setattr(output, "write_first_pulse", fails)
    whole = pages.write_text
    monkeypatch.setattr(pages, "write_text", lambda path, text: (seen.append(sorted(
        entry.name for entry in tmp_path.iterdir())), whole(path, text))[1])  # fmt: skip
    short = ("study", "stiffness", "paper-3.3-massless", "--count", 3, "--low", 1e7, "--high", 1e8, "--workers", 1)
    status, out, err = hoop(*short, "--out", tmp_path)
    assert status == 2
    assert "the disk is full" in err
    assert "Limit for infinite stiffness" in out  # nothing else is lost
    assert seen[0] is False
    assert {"study.csv", "study.json", "pulse.svg", "distance.svg", "pulse.png"} <= set(seen[1])
    assert "fields.pvd" not in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_a_star_stands_beside_the_error_that_is_too_large(study):
    rung = study.rungs[-1]
    away = abs(rung.measure("friction_loss") - study.limits["friction_loss"].rigid)
    error = {**rung.outcome.numerical_error[0], "friction_loss": 0.2 * away}
    outcome = replace(rung.outcome, resolved=False, numerical_error=(error,))
    cells = case_cells(study, replace(rung, outcome=outcome))
    assert [i for i, cell in enumerate(cells) if "*" in cell] == [5]  # foundation, bending, ratio, ±, loss, ±
    assert not any("*" in cell for cell in case_cells(study, rung))


def test_a_curve_differs_from_itself_by_nothing_whatever_the_clock():
    motion = simulate(load_scene("paper-3.3-massless").replace(run={"until": "pulse"}))
    columns = history.through(motion, motion.pulses[0])
    late = {**columns, "t": columns["t"] + 0.1}
    for each in (columns, late):
        apart = at_the_same_angle(each, passage_of(motion, motion.pulses[0]))
        # an angle is found to round-off, over which a force changes by its slope: some 1e5 times as much
        jumps = np.r_[False, np.diff(columns["t"]) < 1e-9] | np.r_[np.diff(columns["t"]) < 1e-9, False]
        for name in FORCES:
            off = np.abs(apart[name][1:-1][~jumps[1:-1]])
            assert np.nanmax(off) <= 1e-8 * np.ptp(columns[name]), name
    along = impulses_along(motion, motion.pulses[0])
    # both are differences of momentum, of round-off, at the same instants
    assert np.nanmax(np.abs(at_the_same_normal_impulse(columns, along))) < 1e-12


def test_a_force_that_is_larger_by_a_known_part_differs_by_that():
    motion = simulate(load_scene("paper-3.3-massless").replace(run={"until": "pulse"}))
    columns = history.through(motion, motion.pulses[0])
    larger = {**columns, "normal_force": 1.01 * columns["normal_force"]}
    apart = at_the_same_angle(larger, passage_of(motion, motion.pulses[0]))
    smooth = slice(1, int(np.argmax(columns["normal_force"])))  # before any jump
    assert apart["normal_force"][smooth] == pytest.approx(0.01 * columns["normal_force"][smooth], rel=1e-5)


def test_the_histories_of_a_pulse_end_where_its_measures_do():
    """Both impulses through the pulse are the solver's own integrals at its end; the curves cover all of it."""
    from studies.running.solvers import solver

    motion = solver("flexible")(load_scene("paper-3.3-massless").replace(run={"until": "pulse"}), history=True)
    pulse = motion.pulses[0]
    columns = history.through(motion, pulse)
    assert (columns["t"][0], columns["t"][-1]) == (pulse.t_start, pulse.t_end)
    assert columns["normal_impulse"][-1] == pytest.approx(pulse.normal_impulse, rel=1e-12)
    assert columns["friction_impulse"][-1] == pytest.approx(pulse.friction_impulse, rel=1e-12)
    # while it spins, F = mu N: the correction keeps the curve on the cone
    spinning = columns["t"] < pulse.phases[0].t_end
    ratio = columns["friction_impulse"][spinning][5:] / columns["normal_impulse"][spinning][5:]
    assert ratio == pytest.approx(motion.scene.friction.mu, rel=1e-3)


def foreseen(study):
    """The study with what theory says of its scene, which the third solver does not do."""
    return replace(study, prediction=predict(study.scene.replace(run={"until": "pulse"})))


def test_distances_are_drawn_in_units_of_their_own(study):
    """A hoop of 0.3 m and 2 kg: m g R = 5.886 J and m sqrt(g R) = 3.43 N s are what its distances are multiples of."""
    scene = study.scene.replace(hoop={"R": 0.3, "m": 2.0, "g": 9.81})
    si = foreseen(stiffness_study(scene, Ladder("both", 1e8, 1e13, 6), solver=THIRD))
    foundation = [rung.contact_stiffness for rung in si.rungs]
    for name, unit in (("impulse_ratio", 1.0), ("friction_loss", 5.886), ("normal_impulse", 2 * 2.943**0.5)):
        drawn, limit = si.distance(name), si.limits[name]
        assert drawn.stiffness == pytest.approx(foundation)
        away = np.array([rung.measure(name) for rung in si.rungs]) - limit.rigid
        assert drawn.off * unit == pytest.approx(away, rel=1e-9)
        assert drawn.error * unit == pytest.approx([rung.error(name) for rung in si.rungs], rel=1e-9)
        assert drawn.predicted[0][[0, -1]] == pytest.approx(drawn.stiffness[[0, -1]])
        term = si.prediction.terms[name]
        assert drawn.predicted[1] * unit == pytest.approx(
            np.abs(term.at(drawn.predicted[0] ** (-1 / 3)) - term.limit), rel=1e-9
        )


def test_a_coefficient_is_of_the_cases_for_which_theory_holds(study):
    """Those from the foundation on at which the events are separate, and no other."""
    known = foreseen(study)
    least = known.rungs[3].contact_stiffness
    held = replace(known, separate=least).coefficient("impulse_ratio")
    assert held == replace(known, rungs=known.rungs[3:]).coefficient("impulse_ratio")
    assert held != known.coefficient("impulse_ratio")
    assert known.expected("impulse_ratio", least) > 0
    assert replace(known, separate=1.01 * least).expected("impulse_ratio", least) == 0


def test_cases_that_do_what_no_rigid_rim_does_are_told_where_the_ring_is_the_softer(study):
    """Of two that leave the floor one has a ring that is stiffer than its patch."""
    known = foreseen(study)
    phases = [["spin", "roll", "skid", "flight"] if i in (1, 4) else known.reference.phases[0] for i in range(9)]
    rungs = tuple(
        replace(rung, outcome=replace(rung.outcome, phases=(told, *rung.outcome.phases[1:])))
        for rung, told in zip(known.rungs, phases, strict=True)
    )
    stiff = replace(known, rungs=rungs, stiff=known.rungs[3].contact_stiffness)
    assert stiff.otherwise == [rungs[1]]
    assert "and at 1 of these cases the contact does something else" in prediction_sentence(stiff)
    assert stiff.to_dict()["prediction"]["stiff"] == stiff.stiff
    for quiet in (replace(stiff, stiff=0.0), replace(known, stiff=np.inf)):
        assert not quiet.otherwise
        assert "does something else" not in prediction_sentence(quiet)


def test_a_record_has_both_stiffnesses_under_their_names(study):
    for record, rung in zip(study.records(), study.rungs, strict=True):
        scene = scene_from_dict(rung.outcome.scene)
        assert record["bending_stiffness"] == scene.ring.bending_stiffness
        assert record["contact_stiffness"] == scene.contact.stiffness
        assert record["impulse_ratio"] == rung.outcome.pulses[0]["impulse_ratio"]


def test_what_is_said_to_be_observed_and_to_lie_outside_is(study):
    """The third solver is not what theory foresees: both numbers are told, and which is which."""
    known = foreseen(study)
    told = prediction_sentence(known)
    seen = known.coefficient("impulse_ratio")
    assert seen.observed != pytest.approx(seen.predicted, rel=1e-2)
    assert f"{seen.observed:.4g} ± {seen.uncertainty:.2g} observed, {seen.predicted:.4g} predicted" in told
    other = replace(study.limits["normal_impulse"], value=2.0, uncertainty=0.25, rigid=3.0, span=9.0)
    said = verdict(replace(study, limits={**study.limits, "normal_impulse": other}))
    assert "J_N (normal impulse) tends to 2.000000 ± 0.25" in said
    assert "3.000000, outside that interval by 0.75" in said
    row = dict(zip(rigid_cells_heads(study), rigid_cells(study), strict=True))
    pulse = study.reference.pulses[0]
    assert float(row["J_F/J_N"]) == pytest.approx(pulse["impulse_ratio"], abs=6e-6)
    assert float(row["J_N"]) == pytest.approx(pulse["normal_impulse"], rel=1e-4)


def rigid_cells_heads(study) -> list[str]:
    """The headings of the ladder's table without their units; the two errors apart."""
    heads = [head.partition("\n")[0] for head in case_heading(study)]
    return [f"{heads[i - 1]} ±" if head == "±" else head for i, head in enumerate(heads)]


def test_the_line_of_a_fitted_series_goes_through_its_cases():
    """Cases of y = L - s^-1/3 + 40 s^-2/3, whose distance changes its sign on the way: no power of s goes through."""
    s = np.geomspace(1e4, 1e10, 9)
    y = 0.17 - 1e-2 * (s**-0.3333333 - 40 * s**-0.6666667)
    assert len(set(np.sign(y - 0.17))) == 2
    error = np.full(s.size, 1e-9)
    limit = limit_of(s, y, 0.17, error, (1 / 3, 2 / 3))
    along, fitted = fitted_series(limit, s, y, error, points=9)
    assert along == pytest.approx(s)
    # no further than the errors that the cases are said to have, at the level of the intervals
    assert CONFIDENCE == 0.95
    assert np.all(np.abs(fitted - y) <= 8 * error)
    assert fitted_series(limit_of(s, y, 0.17, error), s, y, error) is None


def test_without_friction_there_is_no_impulse_space_and_no_distance_to_draw():
    """J_F/J_N and the loss are 0 at any stiffness: a sentence in the panel, and no axis of round-off."""
    scene = load_scene("paper-3.3-massless").replace(friction={"mu_s": 0, "mu": 0}, solve={"rtol": 1e-3})
    found = stiffness_study(scene, Ladder("both", 1e7, 1e9, 4))
    assert impulse_space(found) is None
    for axes in distances(found).axes:
        assert [text.get_text() for text in axes.texts] == ["the rigid value, to round-off"]
        assert not axes.lines
    assert "at any stiffness" in prediction_sentence(found)


def test_a_figure_whose_process_died_is_drawn_all_the_same(hoop, tmp_path, monkeypatch):
    def die(function, *arguments):
        future = Future()
        future.set_exception(WorkerDied("its worker process died"))
        return future

    drawn = []
    monkeypatch.setattr(Here, "beside", staticmethod(die))
    monkeypatch.setattr(report, "write_figure", lambda found, name, out: drawn.append(name))
    status, _, stderr = hoop(*LINE, "--out", tmp_path)
    assert (status, stderr) == (0, "")
    assert drawn == list(report.CAPTIONS)
    assert (tmp_path / "report.html").is_file()


@pytest.mark.parametrize(("law", "along"), [("patch", "both"), ("regularised", "both"), ("regularised", "bending")])
def test_what_a_law_ties_to_the_foundation_is_told(law, along):
    scene = load_scene("paper-3.3-massless").replace(contact={"law": law})
    ladder = Ladder(along).around(scene)
    said = ladder_sentence(SimpleNamespace(scene=scene, ladder=ladder))
    velocities = [rung.contact.slip_velocity_scale for rung in ladder.rungs(scene)]
    if law == "regularised" and along == "both":
        assert f"slip_velocity_scale goes with it, from {velocities[0]:.3g} to {velocities[-1]:.3g}; " in said
    else:
        assert "goes with it" not in said
        assert len(set(velocities)) == 1
