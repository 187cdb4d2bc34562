"""What a hop study can be asked: keys that a roll replaces, units, the order of values, hoops that stand still."""

from __future__ import annotations

import dataclasses
from math import pi

import pytest
from command_line import is_one_sentence

from rigid import Hoop, SceneError, load_scene, scene_to_dict
from studies import HopMap, StudyError
from studies.cli.hop import map_of
from studies.hop.rolling.roll import STIFFNESS, Ask

SCENE = load_scene("paper-3.3-heavier")
IN_UNITS = SCENE.replace(hoop=dataclasses.replace(SCENE.hoop, R=0.4, m=0.3, g=9.81))


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
