"""Scenes made in Python: what a constructor or ``replace`` takes, and one sentence for what it does not."""

from __future__ import annotations

import inspect
import pickle
import warnings
from dataclasses import replace
from math import pi, radians
from pathlib import Path
from typing import get_type_hints

import numpy as np
import pandas
import pytest

from rigid import (
    Contact,
    Friction,
    Hoop,
    Release,
    Ring,
    Run,
    Scene,
    SceneError,
    Solve,
    as_scene,
    load_scene,
    scene_from_dict,
    scene_names,
    scene_to_dict,
    simulate,
    simulate_batch,
)
from rigid.scenefile import scene_text

FILE = {"hoop": {"k": 0.1}, "friction": {"mu_s": 0.35, "mu": 0.3}, "release": {"phi0_deg": 10}}


def said(action, *values, **keys):
    """The sentence with which something is refused."""
    with pytest.raises(SceneError) as found:
        action(*values, **keys)
    return str(found.value)


@pytest.mark.parametrize(
    ("part", "keys", "changed"),
    [
        ("friction", {"mu_k": 0.2}, "mu_k"),
        ("friction", {"mu_d": 0.2}, "mu_d"),
        ("friction", {"mus": 0.2}, "mus"),
        ("hoop", {"massratio": 0.2}, "massratio"),
        ("release", {"phi_0_deg": 0.2}, "phi_0_deg"),
        ("contact", {"dampin": 0.2}, "dampin"),
        ("ring", {"nu": 0.2}, "nu"),
        ("hoop", {"k": True}, "k"),
        ("hoop", {"k": [0.1]}, "k"),
        ("hoop", {"k": "thin"}, "k"),
        ("hoop", {"k": 1.5}, "k"),
        ("release", {"phi0_deg": "ten"}, "phi0_deg"),
        ("ring", {"weld_half_angle_deg": 91}, "weld_half_angle_deg"),
        ("solve", {"rtol": float("nan")}, "rtol"),
        ("contact", {"law": "glue"}, "law"),
    ],
)
def test_the_same_sentence_from_constructor_replace_and_file(part, keys, changed):
    """Whichever way a mistake comes in; of keys that a file has not, the list of known ones may differ."""
    classes = {"hoop": Hoop, "friction": Friction, "release": Release, "ring": Ring, "contact": Contact, "solve": Solve}
    needed = dict(FILE.get(part, {}))
    for key in keys:
        needed.pop(key, None)
    by_file = said(scene_from_dict, {**FILE, part: {**needed, **keys}})
    assert by_file.startswith(f"{part}.{changed} ")
    assert said(classes[part], **needed, **keys) == by_file
    assert said(scene_from_dict(FILE).replace, **{part: keys}) == by_file


@pytest.mark.parametrize(("key", "meant"), [("mu_k", "mu"), ("mu_d", "mu"), ("mu_static", "mu_s"), ("mu_S", "mu_s")])
def test_the_coefficient_that_was_meant(key, meant):
    assert said(Friction, mu_s=0.3, mu=0.2, **{key: 0.1}).endswith(f"did you mean {meant!r}?")


def test_what_is_missing_or_too_much():
    assert said(Hoop) == "hoop.k is missing: a scene needs it."
    assert said(Release) == "release.phi0_deg is missing: a scene needs it."
    assert said(Friction, 0.3) == "friction.mu is missing: a scene needs it."
    assert said(Friction, 0.3, 0.2, 0.1).startswith("[friction] has 2 keys")
    assert said(Scene, Hoop(0.1), Friction(0.3, 0.2)) == "release is missing: a scene needs it."
    assert said(load_scene("paper-3.1").replace, frction={}).endswith("did you mean 'friction'?")
    assert said(Scene, Hoop(0.1), Friction(0.3, 0.2), 0.1) == "release = 0.1 is not possible: it must be a Release."
    assert "hop is not a part of a scene: did you mean 'hoop'?" in said(Scene, hop=Hoop(0.1))


def test_degrees_beside_radians():
    assert Release(phi0_deg=10) == Release(radians(10))
    assert Release(phi0_deg=10).phi0_deg == pytest.approx(10, rel=1e-15)
    assert Ring(weld_half_angle_deg=4).weld_half_angle == radians(4)
    scene = load_scene("paper-3.1").replace(release={"phi0_deg": 20}, ring={"weld_half_angle_deg": 5})
    assert (scene.release.phi0, scene.ring.weld_half_angle) == (radians(20), radians(5))
    assert said(Release, 0.1, phi0_deg=10).startswith("release.phi0_deg = 10 is not possible")
    assert "phi0_deg" in inspect.signature(Release).parameters
    assert replace(Release(phi0_deg=10), omega0=1.0) == Release(radians(10), 1.0)


@pytest.mark.parametrize("phi0", [10, 45.0, -12.5, 370])
def test_degrees_given_for_radians_are_questioned(phi0):
    with pytest.warns(UserWarning, match=rf"did you mean phi0_deg = {phi0}\?"):
        Release(phi0)


def test_the_question_points_at_the_line_that_gave_them():
    for give in (Release, lambda phi0: load_scene("paper-3.1").replace(release={"phi0": phi0})):
        with pytest.warns(UserWarning, match="did you mean") as said:
            give(10.0)
        assert said[0].filename == __file__


@pytest.mark.parametrize("phi0", [0.17, 3.0, 2 * pi, 4.5 * pi, -7 * pi / 3])
def test_an_angle_is_not_questioned(phi0):
    """Within a turn, or where a motion may have got to."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Release(phi0)
        scene_from_dict({**FILE, "release": {"phi0_deg": 370}})


def test_numbers_of_numpy_are_numbers():
    hoop = Hoop(np.float64(0.5), r=np.array(1.25), mass_ratio=np.int64(1))
    assert hoop == Hoop(0.5, 1.25, 1)
    assert {type(value) for value in (hoop.k, hoop.r, hoop.mass_ratio)} <= {int, float}
    assert Run(turns=np.int32(3)) == Run(turns=3)


def test_every_scene_survives_pickling_and_its_dict():
    for name in scene_names():
        scene = load_scene(name)
        assert pickle.loads(pickle.dumps(scene)) == scene == scene_from_dict(scene_to_dict(scene)) == scene.replace()


def test_a_solver_takes_a_name_a_path_a_dict_or_a_scene(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text("[hoop]\nk = 0.1\n[friction]\nmu_s = 0.35\nmu = 0.3\n[release]\nphi0_deg = 10\n", "utf-8")
    motions = [simulate(source) for source in ("paper-3.1", file, str(file), FILE, load_scene("paper-3.1"))]
    assert all(motion == motions[0] for motion in motions)
    batch = simulate_batch(["paper-3.1", file, FILE])
    assert (batch.t_end == batch.t_end[0]).all()
    assert as_scene("paper-3.1") is not None
    assert said(simulate, 3).endswith("it must be a Scene, a name, the path of a file, or a dict.")
    assert "paper-3.1" in said(simulate, "paper3.1")
    assert said(simulate, {"hoop": {"k": 0.1}}).endswith("is missing: a scene needs it.")


def test_a_value_that_is_no_number_is_shown_in_a_line():
    """A mesh in the place of a stiffness was printed whole, hundreds of lines of it."""
    with pytest.raises(SceneError) as refused:
        Ring(bending_stiffness=list(range(1000)))
    assert len(str(refused.value)) < 150
    assert "\n" not in str(refused.value)


def test_a_wall_is_said_once():
    """With r > 1 the radii say it; a thickness beside them was not looked at."""
    thick = Ring(thickness=0.1)
    assert Scene(Hoop(0.1), Friction(0.3, 0.2), Release(0.1), ring=thick).wall == 0.1
    words = said(Scene, Hoop(0.1, r=1.02), Friction(0.3, 0.2), Release(0.1), ring=thick)
    assert words.startswith("ring.thickness = 0.1 is not possible: hoop.r = 1.02 says how thick the wall is")


@pytest.mark.parametrize(
    "given", [{"R": 0.5}, {"R": 1.0}, {"g": 9.81}, {"R": 0.5, "m": 2}, {"R": 1, "m": 1}, {"m": 3, "g": 9.81}]
)
def test_si_units_are_all_or_none(given):
    """R = 0.5 alone was half a metre under a gravity of 1 m/s^2: times 3 times as long as anybody's. So is R = 1."""
    words = said(scene_from_dict, {**FILE, "hoop": {"k": 0.1, **given}})
    first, missing = next(iter(given)), next(key for key in ("R", "m", "g") if key not in given)
    assert words.startswith(f"hoop.{first} is in SI units: ")
    assert f"hoop.{missing}" in words
    assert scene_from_dict({**FILE, "hoop": {"k": 0.1, "R": 1.0, "m": 1, "g": 1}}).dimensionless


def test_keys_of_files_are_said_to_be_that():
    """A constructor and ``replace`` know no section: a ring that is made has numbers without units."""
    scene = scene_from_dict(FILE)
    for change in ({"ring": {"youngs_modulus": 2e9}}, {"ring": {"density": 1e3}}, {"hoop": {"point_mass": True}}):
        ((part, keys),) = change.items()
        words = said(lambda change=change: scene.replace(**change))
        assert words.startswith(f"{part}.{next(iter(keys))} is a key of files and dicts alone: ")


def test_no_table_is_guessed_from_a_word_that_is_far_from_all():
    assert said(scene_from_dict, {**FILE, "description": {}}).endswith("solve.")
    assert said(scene_from_dict, {**FILE, "contacts": {}}).endswith("did you mean 'contact'?")


def test_a_file_may_begin_with_an_editors_mark(tmp_path):
    """U+FEFF, as an editor on Windows puts it before UTF-8."""
    (tmp_path / "own.toml").write_text(scene_text("paper-3.1"), encoding="utf-8-sig")
    assert load_scene(tmp_path / "own.toml") == load_scene("paper-3.1")


@pytest.mark.parametrize(
    ("part", "key", "values"),
    [
        (Contact, "stiffness", (1e-309, 1e-13)),
        (Contact, "tangential_ratio", (1e-300, 1e300)),
        (Ring, "bending_stiffness", (1e-320, 1e-300, 1e300)),
        (Ring, "weld_half_angle_deg", (1e-320,)),
        (Hoop, "mass_ratio", (1e-320, 1e300)),
    ],
)
def test_what_no_float_has_the_inverse_or_square_of_is_refused(part, key, values):
    others = {"k": 0.1} if part is Hoop else {}
    for value in values:
        assert f".{key} = " in said(part, **others, **{key: value})


def test_a_hoop_has_no_mass_or_one_of_which_a_batch_says_the_same():
    assert Hoop(0.1).mass_ratio == 0
    batch = {"k": 0.1, "mu_s": 0.35, "mu": 0.3, "phi0": 0.2, "mass_ratio": [0.0, 1e-320]}
    assert "scene 1 of the batch: hoop.mass_ratio = " in said(simulate_batch, batch)


@pytest.mark.parametrize("one", ["paper-3.1", load_scene("paper-3.1")])
def test_one_scene_is_no_batch(one):
    assert "is one scene: a batch takes a list of them" in said(simulate_batch, one)


@pytest.mark.parametrize("k", [np.full((7, 3), 0.1), np.full(7, 0.1)])
def test_arrays_that_are_no_list_of_scenes_are_refused(k):
    one = {"k": k, "mu_s": [0.35, 0.35], "mu": 0.3, "phi0": 0.2}
    assert "do not broadcast to (n,)" in said(simulate_batch, one)


def test_numbers_are_one_scene():
    assert len(simulate_batch({"k": 0.1, "mu_s": 0.35, "mu": 0.3, "phi0": 0.2})) == 1


@pytest.mark.parametrize(("change", "told"), [
    ({"k": ["a", "b"]}, "k = ['a', 'b'] is not possible"),
    ({"k": 1j}, "k = 1j is not possible"),
    ({"mu": [[0.1, 0.2], [0.3]]}, "mu = [[0.1, 0.2], [0.3]] is not possible"),
    ({"phi0_deg": 10}, "angles in radians"),
])  # fmt: skip
def test_what_is_no_number_is_no_batch(change, told):
    assert told in said(simulate_batch, {"k": [0.1, 0.2], "mu_s": 0.35, "mu": 0.3, "phi0": 0.2} | change)


@pytest.mark.parametrize("wrong", [{"pulses": -1}, {"pulses": 1.5}, {"workers": 0}, {"workers": "a"}])
def test_how_many_pulses_and_workers_are_whole_numbers(wrong):
    with pytest.raises(SceneError, match="must be a whole number"):
        simulate_batch(["paper-3.1"], **wrong)


def test_a_name_is_a_shipped_scene_whatever_lies_about(tmp_path, monkeypatch):
    """`hoop rigid paper-3.1 > paper-3.1` has an empty file of that name before it reads the scene."""
    monkeypatch.chdir(tmp_path)
    Path("paper-3.1").write_text("")
    assert load_scene("paper-3.1").hoop.k == 0.1
    for path in ("./paper-3.1", Path("paper-3.1"), tmp_path / "paper-3.1"):
        with pytest.raises(SceneError, match="is missing"):
            load_scene(path)


def test_a_name_that_is_too_long_names_no_scene():
    assert "cannot be read: File name too long" in said(simulate, "x" * 300)


def test_what_is_masked_is_no_number():
    """numpy's masked value would be 0: a hoop without mass."""
    with pytest.raises(SceneError, match="mass_ratio"):
        Hoop(0.5, r=1.25, mass_ratio=np.ma.array([0.5], mask=[True])[0])


def test_how_many_may_be_a_number_of_numpys():
    batch = simulate_batch(["paper-3.1"], pulses=np.int64(1), workers=np.int32(1))
    assert batch.impulse_ratio.tolist() == simulate_batch(["paper-3.1"], pulses=1).impulse_ratio.tolist()


def test_a_table_of_pandas_is_a_batch():
    quantities = {"k": [0.1, 0.2], "mu_s": 0.35, "mu": 0.3, "phi0": 0.2}
    a, b = (simulate_batch(scenes) for scenes in (quantities, pandas.DataFrame(quantities)))
    assert a.impulse_ratio.tolist() == b.impulse_ratio.tolist()
    for nothing in (None, 3):
        assert "is no batch" in said(simulate_batch, nothing)


@pytest.mark.parametrize("stiffness", [0.0, 1e17, 1e40])
def test_a_foundation_stiffer_than_gaps_are_known_is_refused(stiffness):
    assert said(Contact, stiffness=stiffness).startswith(f"contact.stiffness = {stiffness!r} is not possible")


@pytest.mark.parametrize("degrees", [7, 10, 29, 35, 57, 114, 229.1])
def test_an_angle_is_written_as_it_was_typed(degrees):
    """And not with the last digits of two conversions; radians alone do not stand in the file."""
    scene = scene_from_dict({**FILE, "release": {"phi0_deg": degrees}})
    assert scene_to_dict(scene)["release"]["phi0_deg"] == degrees
    assert "phi0" not in scene_to_dict(scene)["release"]


def test_any_angle_survives_its_dict_to_the_last_bit():
    """Also one that is not that of a float in degrees, of which there are some among these."""
    beside = 0
    for phi0 in np.random.default_rng(1).uniform(0.01, 2 * pi, 200).tolist():
        data = scene_to_dict(Scene(Hoop(0.1), Friction(0.35, 0.3), Release(phi0)))
        assert scene_from_dict(data).release.phi0 == phi0
        beside += "phi0" in data["release"]
    assert 0 < beside < 200


def test_radians_that_are_not_those_of_the_degrees_beside_them_are_refused():
    release = {"phi0_deg": 10.0, "phi0": radians(10) * (1 + 1e-9)}
    assert "it must be phi0_deg in radians" in said(scene_from_dict, {**FILE, "release": release})


@pytest.mark.parametrize(("key", "value"), [("k", 0.1), ("mass_ratio", 0.1), ("r", 1.02)])
def test_a_point_mass_has_no_radius_and_its_hoop_no_mass_and_no_wall(key, value):
    hoop = {"point_mass": True, key: value}
    assert f"hoop.{key} = {value} is not possible: with point_mass" in said(scene_from_dict, {**FILE, "hoop": hoop})


def test_a_number_is_not_asked_for_as_a_word():
    """A yes where a number is asked for is told so, and one in place of a word is too: of every key of a scene."""
    parts = get_type_hints(Scene)
    asked = {f"{part}.{field}": kind for part, of in parts.items() for field, kind in get_type_hints(of).items()}
    for key, kind in asked.items():
        part, _, field = key.partition(".")
        sentence = said(scene_from_dict(FILE).replace, **{part: {field: True}})
        assert sentence.startswith(f"{key} = True is not possible: ")
        assert ("word" in sentence) == (kind in (str, str | None)), sentence


@pytest.mark.parametrize("rtol", [1e-12, 9e-9])
def test_a_tolerance_below_which_steps_do_not_end_is_refused(rtol):
    assert "between 1e-08 and 0.5" in said(Solve, rtol=rtol)
    assert Solve(rtol=1e-8).rtol == 1e-8


def test_a_key_that_stands_for_itself_is_told_its_table():
    """Of a key that has no table before it: which one that is."""
    scene = {"hoop": {"k": 0.1}, "k": 0.1}
    assert said(simulate, scene) == "k is not a part of a scene: it is a key of [hoop]."
    assert said(simulate, {"zzz": 1}).startswith("zzz is not a part of a scene: known are hoop, ")
