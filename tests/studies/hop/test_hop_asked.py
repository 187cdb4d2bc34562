"""What a hop study can be asked: keys that a roll replaces, units, the order of values, hoops that stand still."""

from __future__ import annotations

import dataclasses
import html
import json
from math import pi

import pytest
from command_line import is_one_sentence

from rigid import Hoop, SceneError, load_scene, scene_to_dict
from studies import HopMap, HopStudy, StudyError
from studies.cli.hop import map_of
from studies.hop.rolling.asked import STIFFNESS, Ask
from studies.hop.rolling.threshold import HopCase, Line, windows
from studies.hop.summary import verdict
from studies.plots.page import toml
from studies.running.case import Outcome

SCENE = load_scene("paper-3.3-heavier")
IN_UNITS = SCENE.replace(hoop=dataclasses.replace(SCENE.hoop, R=0.4, m=0.3, g=9.81))


@pytest.fixture
def leaping(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("studies.hop.study.SOLVER", "third_hop:leap")
    monkeypatch.setattr("studies.hop.figures.chosen", lambda study: None)  # no hop that could be drawn


@pytest.mark.parametrize(
    ("key", "values", "told"),
    [
        ("solve.rtol", (1e-3, 1e-4), "the tolerance is --rtol"),
        ("solve.resolve", ("all", "pulses"), "flexible throughout"),
        ("solve.start", ("equilibrium", "undeformed"), "equilibrium"),
        ("run.t_end", (3.0, 5.0), "--turns"),
        ("run.turns", (1, 2), "--turns"),
        ("run.until", ("pulse", "rest"), "--turns"),
        (STIFFNESS, (1.0, 2.0), "other axis"),
    ],
)
def test_a_key_that_a_roll_replaces_is_no_second_key(key, values, told):
    """Its values would stand in the table beside rolls that knew nothing of them."""
    with pytest.raises(SceneError, match=f"^{key} cannot be varied in a hop study: .*{told}") as refused:
        HopMap(SCENE, (1.0, 10.0), key, values)
    assert is_one_sentence(f"hoop: {refused.value}\n")


@pytest.mark.parametrize(
    ("stiffness", "settings", "told"),
    [
        ((), {}, r"stiffness = \(\)"),
        (10.0, {}, r"stiffness = 10\.0"),
        ((-1.0,), {}, r"ring\.bending_stiffness = -1\.0"),
        ((1.0,), {"second": "hoop.k", "values": ()}, r"values = \(\)"),
        ((1.0,), {"bisections": 1.5}, r"bisections = 1\.5"),
        ((1.0,), {"bisections": -1}, "bisections = -1"),
    ],
)
def test_a_map_that_cannot_be_rolled_is_refused(stiffness, settings, told):
    with pytest.raises(SceneError, match=f"^{told} is not possible: "):
        HopMap(SCENE, stiffness, **settings)


def test_a_map_takes_a_scene_by_its_name():
    assert HopMap("paper-3.3-heavier", (1.0, 10.0)) == HopMap(SCENE, (10.0, 1.0))


def test_what_a_second_key_says_is_what_is_rolled():
    asked = HopMap(SCENE, (1.0, 10.0), "contact.damping", (0.05, 0.3), rtol=2e-3)
    for line, value in enumerate(asked.values):
        scene = asked.scene_of(Ask(line, 10.0, asked.rtol, True))
        assert (scene.contact.damping, scene.ring.bending_stiffness, scene.solve.rtol) == (value, 10.0, 2e-3)


@pytest.mark.parametrize("key", ["hoop.R", "hoop.m", "hoop.g"])
def test_one_unit_alone_is_refused_where_the_scene_has_none(hoop, key):
    """As a file with it is: the other two would be taken for 1 m, 1 kg, 1 m/s²."""
    status, out, err = hoop("study", "hop", "paper-3.3-heavier", "--over", f"{key}=3,4")
    assert (status, out) == (2, "")
    assert f"{key} is in SI units: " in err
    assert is_one_sentence(err)
    assert [getattr(line.hoop, key[-1]) for line in map_of(IN_UNITS, (f"{key}=3,4",)).scenes] == [3.0, 4.0]


def test_a_key_without_its_part_is_said_to_lack_it(hoop):
    status, out, err = hoop("study", "hop", "paper-3.3-heavier", "--over", "foo=1:2:3")
    assert (status, out) == (2, "")
    assert "foo is a part and its key, such as hoop.k" in err
    assert is_one_sentence(err)


def test_values_are_rolled_in_order_and_each_once():
    """Cells of a map lie between neighbours; in another order they would lie over each other."""
    asked = map_of(SCENE, ("hoop.k=0.3,0.1,0.2,0.1", f"{STIFFNESS}=10,1,10"))
    assert asked.values == (0.1, 0.2, 0.3)
    assert asked.stiffness == (1.0, 10.0)
    assert [line.hoop.k for line in asked.scenes] == [0.1, 0.2, 0.3]
    assert asked.count == 6


@pytest.mark.parametrize("phi0", [0.0, pi])
def test_a_hoop_that_stands_still_is_said_to(phi0):
    """The end of its rigid roll, which is at the release, is no one's request."""
    with pytest.raises(StudyError, match=rf": at rest at phi0 = {phi0 * 180 / pi:g}° it stands still\.$"):
        map_of(SCENE.replace(release={"phi0": phi0}), ())


def test_an_angle_that_no_degrees_give_can_be_varied():
    """It stands in radians beside its degrees, of which the map has others."""
    scenes = (SCENE.replace(release={"phi0": pi / 18 + n * 1e-15}) for n in range(1, 100))
    scene = next(scene for scene in scenes if "phi0" in scene_to_dict(scene)["release"])
    assert [line.release.phi0 for line in map_of(scene, ("release.phi0_deg=45,90",)).scenes] == [pi / 4, pi / 2]


def test_an_angle_in_radians_is_told_to_be_given_in_degrees():
    with pytest.raises(SceneError, match=r"^release\.phi0 = 0\.1 is not possible: give phi0_deg; "):
        map_of(SCENE, ("release.phi0=0.1,0.2",))


def test_the_map_in_units_keeps_those_of_the_scene():
    """Only a scene without units is asked for all of them."""
    (line, _) = map_of(IN_UNITS, ("hoop.k=0.1,0.2",)).scenes
    assert line.hoop == Hoop(k=0.1, r=1.02, mass_ratio=0.1, R=0.4, m=0.3, g=9.81)


@pytest.mark.usefixtures("leaping")
def test_what_was_run_is_told_beside_what_was_asked(hoop, tmp_path):
    """The page's scene is that of a roll, and of the others it says what is another; as numbers both are there."""
    line = ("study", "hop", "paper-3.3-heavier", "--over", f"{STIFFNESS}=1:100:3", "--over", "hoop.k=0.2,0.1")
    _, out, _ = hoop(*line, "--rtol", "2e-3", "--bisections", 1, "--workers", 1, "--out", tmp_path / "map")
    assert f"Figures, table and report are in {tmp_path / 'map'};" in " ".join(out.split()), (
        "and no film: no hop is drawn"
    )
    assert json.loads((tmp_path / "map" / "units.json").read_text())["height"] == "R"
    told = json.loads((tmp_path / "map" / "hop.json").read_text())
    assert told["scene"]["run"] == {"turns": 2}
    asked = map_of(SCENE, ("hoop.k=0.1,0.2", f"{STIFFNESS}=1,100"), rtol=2e-3)
    first = scene_to_dict(asked.scene_of(Ask(0, 1.0, 2e-3, True)))
    assert told["as_run"] == first
    page = html.unescape((tmp_path / "map" / "report.html").read_text())
    _, _, shown = page.partition("The scene as it was run")
    assert toml(first) in shown
    said = " ".join(shown.split())
    assert "in each other one ring.bending_stiffness and hoop.k are as in the table" in said
    assert "at a tolerance of 0.002, and at 0.000666667 once more at the ends of thresholds." in said


def rolled(stiffness: float, *flights: dict, completed: bool = True) -> HopCase:
    motion = {"flights": list(flights), "completed": completed, "swept": 6.0, "scales": None, "t_end": 1.0}
    return HopCase(stiffness, SCENE, Outcome("", "", {}, "", motion=motion))


HOP = {"swept": 4.5, "phi": 4.7, "height": 1e-3, "prominence": 2.0}


@pytest.mark.parametrize(
    ("cases", "told"),
    [
        ((rolled(12.0), rolled(100.0)), "at no stiffness from 12 on"),
        ((rolled(12.0, completed=False), rolled(100.0)), "at no stiffness from 100 on, 1 undecided"),
        ((rolled(12.0, HOP), rolled(100.0, HOP)), "still at 100, the stiffest that was rolled"),
        ((rolled(12.0, HOP), rolled(100.0, completed=False)), "still at 12, 1 undecided"),
        ((rolled(12.0, completed=False), rolled(100.0, completed=False)), "undecided"),
        ((rolled(12.0, HOP), rolled(100.0)), "below 34.6 (between 12 and 100)"),
    ],
)
def test_a_map_without_a_threshold_says_so(cases, told):
    """Its bracket's ends are then 0 and infinity, which no hoop was rolled at."""
    study = HopStudy(SCENE, None, (Line(None, SCENE, windows(SCENE), cases),))
    assert [line for line in str(study).splitlines() if "anywhere" in line and line.endswith(f" {told}")]


@pytest.mark.parametrize(
    ("low", "high", "told"),
    [
        (12.0, 100.0, "below 34.6 (between 12 and 100)"),
        (36.99, 37.01, "below 37 (between 36.99 and 37.01)"),
        (36.9999, 37.0001, "below 37 (between 36.9999 and 37.0001)"),
    ],
)
def test_a_threshold_is_told_by_the_ends_of_its_bracket(low, high, told):
    """However wide: from a geometric mean they are not equally far."""
    line = Line(None, SCENE, windows(SCENE), (rolled(low, HOP), rolled(high)))
    (said,) = verdict(HopStudy(SCENE, None, (line,)))
    assert f"anywhere on its way {told}," in said
    assert line.threshold("anywhere").ends == told.partition("between ")[2].rstrip(")").replace("and", "to")
