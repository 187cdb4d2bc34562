"""A ring described by its material and section in SI units: the same ring as by its bending stiffness and mass."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from math import pi

import pytest

from rigid import SceneError, load_scene, scene_from_dict, scene_to_dict

TUBE = {"youngs_modulus": 0.9e9, "density": 950.0, "tube_diameter": 0.02, "tube_wall": 0.0015}
STRIP = {"youngs_modulus": 205e9, "width": 0.02, "height": 0.002}


def table(ring, **hoop):
    scene = {"k": 0.1, "R": 0.45, "m": 0.1, "g": 9.81} | hoop
    return {
        "hoop": {key: value for key, value in scene.items() if value is not None},
        "friction": {"mu_s": 0.4, "mu": 0.3},
        "release": {"phi0_deg": 10},
        "ring": ring,
    }


def test_a_tube_by_hand():
    """I = pi (D^4 - d^4)/64 = 3.7542e-9 m^4, so E I = 3.3788 N m^2 over m g R^2 = 0.198653; area 8.7179e-5 m^2."""
    scene = scene_from_dict(table(TUBE))
    assert scene.ring.bending_stiffness == pytest.approx(3.3788 / 0.198653, rel=1e-4)
    assert scene.hoop.mass_ratio == pytest.approx(950 * 8.7179e-5 * 2 * pi * 0.44 / 0.1, rel=1e-4)
    assert scene.wall == pytest.approx(0.02 / 0.45)


def test_a_strip_by_hand():
    """I = b h^3/12 = 1.3333e-11 m^4; without a density the mass is said as before."""
    scene = scene_from_dict(table(STRIP, mass_ratio=0.7))
    assert scene.ring.bending_stiffness == pytest.approx(205e9 * 0.02 * 0.002**3 / 12 / (0.1 * 9.81 * 0.45**2))
    assert (scene.hoop.mass_ratio, scene.wall) == (0.7, pytest.approx(0.002 / 0.45))


def test_stresses_are_those_of_the_section():
    """A strip is as wide as it is; a tube is strained as a strip 12 I/D^3 = 5.6314 mm wide. No motion knows of it."""
    strip, tube = scene_from_dict(table(STRIP)), scene_from_dict(table(TUBE))
    assert strip.ring.section_width == pytest.approx(0.02 / 0.45)
    assert tube.ring.section_width == pytest.approx(5.6314e-3 / 0.45, rel=1e-4)
    assert scene_from_dict(table({})).ring.section_width is None


def test_a_thin_tube_is_a_hoop_of_its_wall():
    """I -> pi D^3 t/8 and A -> pi D t for a thin wall, to the first order in t/D."""
    thin = scene_from_dict(table(TUBE | {"tube_wall": 1e-6}))
    moment, area = pi * 0.02**3 * 1e-6 / 8, pi * 0.02 * 1e-6
    assert thin.ring.bending_stiffness == pytest.approx(0.9e9 * moment / (0.1 * 9.81 * 0.45**2), rel=3e-4)
    assert thin.hoop.mass_ratio == pytest.approx(950 * area * 2 * pi * 0.44 / 0.1, rel=1e-4)


def test_a_scene_survives_its_file_in_the_other_words():
    scene = scene_from_dict(table(TUBE))
    assert scene_from_dict(scene_to_dict(scene)) == scene


@pytest.mark.parametrize(
    ("ring", "hoop", "says"),
    [
        (TUBE, {"R": None}, "ring.youngs_modulus is in SI units: hoop.R, hoop.m and hoop.g"),
        (TUBE, {"g": None}, "in SI units"),
        (TUBE | {"bending_stiffness": 3.0}, {}, "ring.bending_stiffness and ring.youngs_modulus cannot both"),
        (TUBE | {"thickness": 0.1}, {}, "ring.thickness and ring.youngs_modulus cannot both"),
        (STRIP | {"section_width": 0.3}, {}, "ring.section_width and ring.youngs_modulus cannot both"),
        (TUBE, {"mass_ratio": 0.1}, "hoop.mass_ratio and ring.density cannot both"),
        (TUBE, {"r": 1.02}, "hoop.r = 1.02 is not possible: the ring's section says 1.04651163"),
        (TUBE | {"width": 0.01}, {}, "section is unclear"),
        ({"youngs_modulus": 1e9, "width": 0.01}, {}, "section is unclear"),
        ({"youngs_modulus": 1e9}, {}, "section is unclear"),
        ({"width": 0.01, "height": 0.002}, {}, "ring.youngs_modulus is missing"),
        (TUBE | {"tube_wall": 0.011}, {}, "ring.tube_wall = 0.011 is not possible"),
        (TUBE | {"tube_diameter": 0.5}, {}, "must be less than hoop.R"),
        (TUBE | {"density": -1.0}, {}, "ring.density = -1.0 is not possible"),
        (TUBE | {"density": "light"}, {}, "ring.density = 'light' is not possible"),
        ({"youngs_modulu": 1e9}, {}, "did you mean 'youngs_modulus'?"),
        ({"youngs_modulos": 1e9, "width": 0.01, "height": 0.002}, {}, "did you mean 'youngs_modulus'?"),
        (TUBE | {"tube_wal": 0.002}, {}, "did you mean 'tube_wall'?"),
        (TUBE, {"r": "wide"}, "hoop.r = 'wide' is not possible"),
    ],
)
def test_what_cannot_be_is_one_sentence(ring, hoop, says):
    with pytest.raises(SceneError) as error:
        scene_from_dict(table(ring, **hoop))
    sentence = str(error.value)
    assert says in sentence
    assert sentence.endswith((".", "?"))
    assert "\n" not in sentence


@pytest.mark.parametrize(
    ("name", "bending_stiffness", "mass_ratio"),
    [("hula-hoop", 17, 2.3), ("steel-strip", 5.6, 4.9), ("printed", 0.6, 0.04)],
)
def test_the_things_one_can_hold_are_shipped_in_si(name, bending_stiffness, mass_ratio):
    """Two digits, as by hand from the sections that their files state."""
    scene = load_scene(name)
    assert scene.ring.bending_stiffness == pytest.approx(bending_stiffness, rel=0.05)
    assert scene.hoop.mass_ratio == pytest.approx(mass_ratio, rel=0.05)
    text = (files("rigid.scenes") / f"{name}.toml").read_text(encoding="utf-8")
    assert "Ashby" in text
    assert tomllib.loads(text)["ring"]["youngs_modulus"] > 1e8
