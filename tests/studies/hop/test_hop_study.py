"""The map of hops and its thresholds, judged on rolls whose thresholds are known by construction; and its rule."""

from __future__ import annotations

import json
from math import inf, pi

import numpy as np
import pytest
from command_line import is_one_sentence
from third_hop import LIFTS

from rigid import Run, SceneError, load_scene, simulate
from studies import HopStudy, StudyError, hop_study
from studies.cli.hop import map_of, parse_over
from studies.hop.maps import place
from studies.hop.rolling.asked import DEFAULT
from studies.hop.rolling.roll import RTOL, from_rest, spans, through_the_pulse
from studies.hop.rolling.rule import DECADE, DURATION_OVER_PERIOD, HEIGHT_OVER_DEPTH, HEIGHT_OVER_SAG, Scales
from studies.hop.rolling.scaling import suddenness
from studies.hop.rolling.threshold import HopCase, Line, Window, bracket, hops_in, windows
from studies.hop.summary import answer, verdict
from studies.running.case import Outcome

SCENE = "paper-3.3-heavier"


@pytest.fixture
def leaping(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("studies.hop.study.SOLVER", "third_hop:leap")


def rolled(bisections: int = 6, *over: str, **settings: object):
    asked = map_of(load_scene(SCENE), ("ring.bending_stiffness=1:1000:10", *over), bisections=bisections)
    return hop_study(asked, **settings)


def test_the_prominence_is_the_least_of_three_ratios():
    scales = Scales(depth=1e-5, sag=1e-2, period=0.5)
    height = max(HEIGHT_OVER_DEPTH * 1e-5, HEIGHT_OVER_SAG * 1e-2)
    duration = DURATION_OVER_PERIOD * 0.5
    assert scales.prominence(height, duration) == pytest.approx(1.0)
    assert scales.prominence(height, 7 * duration) == pytest.approx(1.0)
    assert scales.prominence(3 * height, duration / 4) == pytest.approx(0.25)
    assert scales.prominence(0.0, 1.0) == 0.0
    assert Scales(1e-5, 1e-2, 0.0).prominence(5 * height, 1e-9) == pytest.approx(5.0), "no mass, no period"


def test_spans_are_the_runs_of_true_entries():
    assert spans(np.array([True, False, True, True, False, True])) == [(0, 0), (2, 3), (5, 5)]
    assert spans(np.array([False, False])) == []


def test_a_roll_is_cut_by_time_and_begins_at_rest():
    """The disk of a soft hoop rocks, and each reversal would count as a turn."""
    scene = load_scene(SCENE)
    asked = from_rest(scene)
    assert asked.run.t_end == pytest.approx(simulate(scene).turns[1].t)
    assert asked.solve.resolve == "all"
    with pytest.raises(StudyError, match=r"released at rest.*must be 0\.$"):
        from_rest(scene.replace(release={"omega0": 0.1}))


def test_windows_are_the_rigid_pulse_and_the_disk_over_the_floor():
    """Angles count from the release; mirrored, they are the same."""
    scene = load_scene(SCENE)
    found = windows(scene)
    bottom = found["bottom"]
    assert (bottom.low + bottom.high) / 2 == pytest.approx(pi - scene.release.phi0)
    assert (bottom.high - bottom.low) / 2 == pytest.approx(np.arcsin(0.1 / 0.9))  # the disk as seen from C
    assert found["pulse"].low < bottom.low < bottom.high < found["pulse"].high
    mirrored = windows(scene.replace(release={"phi0": -scene.release.phi0}))
    for name in ("pulse", "bottom"):
        assert (mirrored[name].low, mirrored[name].high) == pytest.approx((found[name].low, found[name].high))


def test_a_run_that_ends_before_its_pulse_says_nothing_of_it():
    scene = load_scene(SCENE)
    (pulse, *_) = [pulse for pulse in simulate(scene).pulses if not pulse.cut]
    for t_end, known in ((0.9 * pulse.t_start, {"anywhere"}), (pulse.t_end, {"anywhere", "pulse", "bottom"})):
        assert set(windows(from_rest(scene.replace(run=Run(t_end=t_end))))) == known


def test_a_roll_that_stopped_decides_only_what_it_has_seen():
    flights = [{"swept": 3.0, "prominence": 2.0}, {"swept": 4.0, "prominence": None}]
    early = {"flights": flights, "completed": False, "swept": 4.2}
    assert hops_in(early, Window(2.5, 3.5)) is True
    assert hops_in(early, Window(2.5, 3.5), least=2.5) is False, "it has gone through"
    assert hops_in(early, Window(3.9, 5.0), least=99) is True, "no period and no sag: above any constant"
    assert hops_in(early, Window(4.1, 5.0)) is None, "it may still hop"
    assert hops_in(early | {"flights": []}, None) is None
    assert hops_in(early | {"flights": [], "completed": True}, None) is False


def test_a_bracket_lies_above_the_stiffest_hop():
    found = bracket({1.0: True, 2.0: False, 4.0: True, 8.0: None, 16.0: False, 32.0: False})
    assert (found.low, found.high, found.open, found.gaps) == (4.0, 16.0, 1, 1)
    assert found.value == pytest.approx(8.0)
    assert bracket({1.0: False, 2.0: False}).value is None
    assert bracket({1.0: True}).high == inf
    assert "not at every softer one" in found.told()
    assert "softer" not in bracket({1.0: True, 16.0: False}).told()


def test_a_roll_through_the_pulse_decides_what_it_has_passed():
    """It ends between the rigid pulse and the turn after it; a hop that is late is not denied."""
    asked = from_rest(load_scene(SCENE))
    short = through_the_pulse(asked)
    motion = simulate(asked)
    assert motion.pulses[0].t_end < short.run.t_end < motion.turns[0].t
    ended = {"flights": [], "completed": True, "swept": 4.2}
    assert hops_in(ended, Window(2.5, 3.5), whole=False) is False
    assert hops_in(ended, Window(3.9, 5.0), whole=False) is None
    assert hops_in(ended, None, whole=False) is None
    assert hops_in(ended, Window(3.9, 5.0)) is False


@pytest.mark.usefixtures("leaping")
def test_only_the_threshold_anywhere_is_closed_in_on_by_whole_rolls():
    line = rolled(4).lines[0]
    above = [case for case in line.between if case.bending_stiffness > 3 * LIFTS["pulse"]]
    below = [case for case in line.between if case.bending_stiffness < LIFTS["anywhere"] / 3]
    assert above
    assert below
    assert all(case.whole for case in above)
    assert not any(case.whole for case in below)
    assert all(case.scene.run.t_end < line.scene.run.t_end for case in below)


@pytest.mark.usefixtures("leaping")
def test_what_still_hops_at_the_stiffest_is_said_as_such(hoop):
    _, out, _ = hoop("study", "hop", SCENE, "--over", "ring.bending_stiffness=20,30", "--workers", 1, "--bisections", 0)
    first = " ".join(out.split()).partition(".")[0]
    assert "leaves the floor: anywhere on its way still at 30, the stiffest that was rolled" in first
    assert "more than" not in first


@pytest.mark.usefixtures("leaping")
@pytest.mark.parametrize(("over", "said"), [("5", "hoop: 1 roll."), ("5,300", "hoop: 2 rolls, and up to 9 more for")])
def test_as_many_rolls_are_announced_as_may_come(hoop, over, said):
    """Of one stiffness there is no bracket to close in on."""
    line = ("study", "hop", SCENE, "--over", f"ring.bending_stiffness={over}", "--workers", 1, "--bisections", 1)
    assert hoop(*line)[2].startswith(said)


@pytest.mark.usefixtures("leaping")
def test_a_shorter_roll_can_be_asked(hoop):
    line = "study", "hop", SCENE, "--over", "ring.bending_stiffness=20,60", "--workers", 1, "--bisections", 0, "--json"
    ends = []
    for more in ((), ("--turns", 1)):
        _, out, _ = hoop(*line, *more)
        ends.append(json.loads(out)["scene"]["run"]["turns"])
    assert ends == [2, 1]


@pytest.mark.usefixtures("leaping")
def test_thresholds_are_found_by_bisection():
    """Six bisections of a third of a decade leave 10^(1/3/64), 3.7 %."""
    study = rolled()
    line = study.lines[0]
    for where, exact in LIFTS.items():
        found = line.threshold(where)
        assert found.low < exact < found.high
        assert found.high / found.low == pytest.approx(10 ** (1 / 3 / 64))
        assert line.holds(where) is True
    for factor in DECADE:  # the made-up prominence falls like the fourth power of the stiffness
        found = line.threshold("pulse", factor)
        assert found.low < LIFTS["pulse"] * factor**-0.25 < found.high


@pytest.mark.usefixtures("leaping")
def test_the_table_has_all_hops_and_the_repr_is_short():
    study = rolled(2)
    frame = study.to_dataframe()
    hops = [hop for case in study.cases for hop in case.hops]
    assert frame["height"].notna().sum() == len(hops)
    assert sorted(frame["height"].dropna()) == sorted(hop["height"] for hop in hops)
    assert set(frame["bending_stiffness"]) == {case.bending_stiffness for case in study.cases}
    assert len(repr(study).splitlines()) <= 6
    assert "<" in study._repr_html_()


@pytest.mark.usefixtures("leaping")
def test_the_table_says_which_roll_is_of_which_value():
    """Of keys without a column of their own it did not."""
    asked = map_of(load_scene(SCENE), ("release.phi0_deg=10,20", "ring.bending_stiffness=1,100"))
    study = hop_study(asked)
    frame = study.to_dataframe()
    assert set(frame["release.phi0_deg"]) == {10, 20}
    assert study.units["release.phi0_deg"] == "°"
    of = {(case["release.phi0_deg"], case["bending_stiffness"]) for case in study.to_dict()["cases"]}
    assert of >= {(10, 1), (10, 100), (20, 1), (20, 100)}


@pytest.mark.usefixtures("leaping")
def test_json_is_the_contract(hoop):
    status, out, err = hoop(
        "study", "hop", SCENE, "--over", "ring.bending_stiffness=0.5:100:5", "--over", "hoop.k=0.1,0.2", "--bisections",
        2, "--workers", 1, "--json",
    )  # fmt: skip
    assert status == 1, "the softest rolls stop early"
    assert err == "hoop: 2 of 22 rolls stopped before their end; the study says why the first did.\n"
    found = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} is not JSON"))
    assert {"cases", "threshold"} <= set(found)
    for case in found["cases"]:
        assert {"bending_stiffness", "k", "mass_ratio", "hops", "chatter", "completed"} <= set(case)
        assert case["rigid"] == {"hops": 0}
        for hop in case["hops"]:
            assert {"t", "phi", "duration", "height", "energy"} <= set(hop)
    assert {case["k"] for case in found["cases"]} == {0.1, 0.2}
    assert found["rtol"] == pytest.approx(RTOL)
    assert found["threshold"]["anywhere"][0]["phi"] is None
    under = found["threshold"]["bottom"][0]["phi"]
    assert under == pytest.approx([pi - np.arcsin(0.1 / 0.9), pi + np.arcsin(0.1 / 0.9)])
    for where, exact in LIFTS.items():
        assert [row["hoop.k"] for row in found["threshold"][where]] == [0.1, 0.2]
        for row in found["threshold"][where]:
            assert row["low"] < exact < row["high"]
            assert set(row["by_rule"]) == {"0.316", "3.16"}


@pytest.mark.usefixtures("leaping")
def test_a_study_is_drawn_from_python():
    """Over one key where hops begin, over two the map with the thresholds."""
    one = rolled(0).plot()
    assert one.axes[0].get_ylabel() == "φ at lift-off [°]"
    two = rolled(0, "hoop.k=0.1,0.2").plot()
    assert two.axes[0].get_ylabel() == "radius of the disk over that of the hoop, k"


@pytest.mark.usefixtures("leaping")
def test_a_map_shows_the_rarest_place_of_each_roll():
    """Its hops begin under the disk, at 3.6 in the pulse and at 4.5 behind it, each below its stiffness in LIFTS."""
    for line in rolled(0, "hoop.k=0.1,0.2").lines:
        for case in line.mapped:
            below = [where for where in ("bottom", "pulse", "anywhere") if case.bending_stiffness < LIFTS[where]]
            rarest = next(iter(below), "nowhere")
            assert place(case, line) == {"anywhere": "behind"}.get(rarest, rarest)


def test_a_place_in_a_map_may_be_on_the_way_down_or_unknown():
    line = rolled_by({"completed": True, "flights": [{"swept": 0.5, "prominence": 2.0}]})
    assert place(line.mapped[0], line) == "before"
    line = rolled_by({"completed": False, "flights": []})
    assert place(line.mapped[0], line) is None


def rolled_by(motion: dict) -> Line:
    """A line of one roll that did this."""
    scene = load_scene(SCENE)
    outcome = Outcome("", "", {}, "", motion={"swept": 1.0, "scales": None, "t_end": 1.0} | motion)
    return Line(None, scene, windows(scene), (HopCase(5.0, scene, outcome),))


@pytest.mark.usefixtures("leaping")
def test_thresholds_are_told_in_the_time_of_the_pulse_too():
    """omega_1 goes with the root of the stiffness: the products go like the roots of the thresholds."""
    line = rolled(6).lines[0]
    values = {where: line.turning(where) / np.sqrt(line.threshold(where).value) for where in LIFTS}
    assert values["anywhere"] == pytest.approx(values["pulse"])
    assert values["anywhere"] ** -2 == pytest.approx(suddenness(line.scene))
    pulse = simulate(line.scene).pulses[0]
    for where in LIFTS:
        expected = line.threshold(where).value * (pulse.t_end - pulse.t_start) ** 2
        assert line.times_duration(where) == pytest.approx(expected)
    assert rolled(0, "hoop.mass_ratio=0,0.1").lines[0].turning("pulse") is None, "no mass, no vibration"


def test_a_map_goes_on_where_it_was(leaping, tmp_path, monkeypatch):
    counted = tmp_path / "counted"
    monkeypatch.setenv("COUNTED", str(counted))
    first = rolled(2, out=tmp_path / "map")
    rolls = len(counted.read_text().splitlines())
    assert rolls == len(first.cases) + sum(len(line.finer) for line in first.lines)
    again = rolled(2, out=tmp_path / "map")
    assert len(counted.read_text().splitlines()) == rolls, "nothing is rolled twice"
    assert again.to_dict() == first.to_dict()


@pytest.mark.usefixtures("leaping")
def test_the_screen_answers_first(hoop):
    status, out, _ = hoop("study", "hop", SCENE, "--over", "ring.bending_stiffness=1:1000:7", "--workers", 1)
    assert status == 0
    assert out.splitlines()[0].startswith("Yes: released at rest, an elastic hoop whose bending stiffness")
    told = " ".join(out.split())
    assert "A third of the tolerance moves none of these thresholds." in told
    assert "k = 0.1, m_h/m = 0.1: leaves the floor anywhere on its way below" in told
    assert "The rigid hoop never leaves the floor" in " ".join(out.split())


@pytest.mark.usefixtures("leaping")
def test_what_was_not_rolled_far_enough_is_not_denied(hoop):
    """Below STOPS every roll stops before its pulse: only from there on is anything known."""
    _, out, _ = hoop("study", "hop", SCENE, "--over", "ring.bending_stiffness=0.1,0.2,30,200", "--workers", 1,
                     "--bisections", 0)  # fmt: skip
    assert "within its first pulse at no stiffness from 30 on" in " ".join(out.split())


def test_a_threshold_that_a_third_of_the_tolerance_moves_is_told_with_its_doubt():
    """Of 5 that hops and 10 that does not the finer roll at 10 hops: the threshold is more than that."""
    scene = load_scene(SCENE)

    def case(stiffness, hops, rtol=3e-4):
        flights = [{"swept": 4.5, "phi": 4.7, "height": 1e-3, "prominence": 2.0}] if hops else []
        motion = {"flights": flights, "completed": True, "swept": 6.0, "scales": None, "t_end": 1.0}
        return HopCase(stiffness, scene.replace(solve={"rtol": rtol}), Outcome("", "", {}, "", motion=motion))

    mapped, finer = (case(5.0, True), case(10.0, False)), (case(5.0, True, 1e-4), case(10.0, True, 1e-4))
    study = HopStudy(scene, None, (Line(None, scene, windows(scene), mapped, finer=finer),))
    assert "A third of the tolerance moves the only threshold out of its bracket." in answer(study)
    (line,) = verdict(study)
    assert "anywhere on its way below 7.07 (between 5 and 10, more at a third of the tolerance)" in line
    assert "within its first pulse at no stiffness from 5 on" in line
    assert "The stiffest hoop that hops, 5, first does so at φ = 269°." in line


def test_ranges_are_read():
    assert parse_over("hoop.k=0.1,0.2") == ("hoop.k", (0.1, 0.2))
    key, values = parse_over("ring.bending_stiffness=1:100:3")
    assert values == pytest.approx((1.0, 10.0, 100.0))
    assert parse_over("hoop.mass_ratio=0:1:3")[1] == (0.0, 0.5, 1.0)
    assert len(map_of(load_scene(SCENE), ()).stiffness) == DEFAULT[2]


@pytest.mark.parametrize(
    ("over", "expected"), [("40,80", (40, 80)), ("40:160:3", (40, 80, 160)), ("24:26:5", (24, 25, 26))]
)
def test_of_keys_that_count_values_are_whole_numbers(over, expected):
    """A ring is cut into 40 elements, not 40.0: ranges give the whole numbers nearest to theirs, each once."""
    asked = map_of(load_scene(SCENE), (f"solve.elements={over}", "ring.bending_stiffness=5,300"))
    assert asked.values == tuple(scene.solve.elements for scene in asked.scenes) == expected
    assert {type(value) for value in asked.values} == {int}


@pytest.mark.parametrize("value", ["40.5", "40,1e400", "nan"])
def test_of_keys_that_count_nothing_else_is_taken(hoop, value):
    status, out, err = hoop("study", "hop", SCENE, "--over", f"solve.elements={value}")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)


@pytest.mark.parametrize(
    "over",
    ["hoop.k", "k=1:2:3", "hoop.k=1:2", "hoop.k=a,b", "hoop.k=0.2:0.1:3", "hoop.k=0.1:0.2:1", "hoop.q=1,2",
     "hoop.k=2,3", "ring.bending_stiffness=-1,2", "hoop.k=nan:1:3"],
)  # fmt: skip
def test_a_range_that_cannot_be_is_one_sentence(hoop, over):
    status, out, err = hoop("study", "hop", SCENE, "--over", over)
    assert (status, out) == (2, "")
    assert is_one_sentence(err)


def test_two_keys_are_enough():
    scene = load_scene(SCENE)
    with pytest.raises(SceneError, match="one key more"):
        map_of(scene, ("hoop.k=0.1,0.2", "friction.mu=0.1,0.2"))
    with pytest.raises(SceneError, match="each once"):
        map_of(scene, ("hoop.k=0.1,0.2", "hoop.k=0.3,0.4"))
