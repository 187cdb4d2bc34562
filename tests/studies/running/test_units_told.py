"""A motion says what each number in it, and each column of its history, is measured in."""

from __future__ import annotations

from math import isnan

import pytest

import flexible
import rigid
from rigid import load_scene
from rigid.scenefile import units_of_keys
from studies import HopStudy, Ladder, hop_study, limit_study, run_sweep, stiffness_study
from studies.cli.hop import map_of
from studies.running import history

SCENE = load_scene("paper-3.3-light").replace(solve={"rtol": 1e-2}, run=rigid.Run(turns=1))
HEAVY = SCENE.replace(hoop={"R": 0.5, "m": 2.0, "g": 9.81})
SIZES = {"s": (0.5 / 9.81) ** 0.5, "N": 2 * 9.81, "J": 2 * 9.81 * 0.5, "m": 0.5}
SIZES |= {"m/s": SIZES["m"] / SIZES["s"], "N s": SIZES["N"] * SIZES["s"], "1/s": 1 / SIZES["s"], "1": 1.0}
SIZES |= {"1/s²": 1 / SIZES["s"] ** 2}


def numbers_of(told) -> dict[str, list[float]]:
    """Numbers of a motion's dictionary by the name of their field, in their order."""
    found: dict[str, list[float]] = {}
    for name in ("phases", "turns", "pulses"):
        for item in told[name]:
            for key, value in item.items():
                if isinstance(value, float):
                    found.setdefault(key, []).append(value)
    for key, value in told.get("energy_ledger", {}).items():
        found.setdefault(key, []).append(value)
    return found


@pytest.mark.parametrize("simulate", [rigid.simulate, flexible.simulate])
def test_each_number_is_in_the_unit_that_is_told(simulate):
    """The same hoop in the paper's scaling and in SI differs by that unit's size, number for number."""
    plain, heavy = simulate(SCENE), simulate(HEAVY)
    units = heavy.units
    one, other = numbers_of(plain.to_dict()), numbers_of(heavy.to_dict())
    assert set(one) == set(other) <= set(units)
    assert {"t", "energy", "t_start", "friction_loss", "normal_impulse", "peak_normal_force"} <= set(one)
    for name, values in one.items():
        size = SIZES[units[name]]
        for value, si in zip(values, other[name], strict=True):
            # what is a small difference of energies has the round-off of these, which are of the order of m g R
            assert (isnan(value) and isnan(si)) or si / size == pytest.approx(value, rel=1e-6, abs=1e-9), name


@pytest.mark.parametrize("simulate", [rigid.simulate, flexible.simulate])
def test_every_column_of_a_history_has_its_unit(simulate):
    motion = simulate(SCENE)
    units = motion.units
    assert set(history.whole(motion)) <= set(units)
    assert (units["t"], units["normal_force"], units["phi"]) == ("sqrt(R/g)", "mg", "1")


def names_of(told) -> set[str]:
    """Names of all numbers, and lists of them, in what JSON prints of a study, its scenes aside."""
    if isinstance(told, list):
        return {name for entry in told for name in names_of(entry)}
    found = set()
    for name, value in told.items() if isinstance(told, dict) else ():
        if name in ("scene", "as_run"):
            continue
        first = value[0] if isinstance(value, list) and value else value
        number = isinstance(first, (int, float)) and not isinstance(first, bool)
        below = set() if number else names_of(value)  # a ratio and an energy are called damping
        found |= {name} if number else {f"energies.{n}" for n in below} if name == "energies" else below
    return found


def same(plain, heavy, units, rel=1e-6) -> None:
    """Records of the same hoop in the paper's scaling and in SI differ by the sizes of the units that are told."""
    for one, other in zip(plain, heavy, strict=True):
        assert set(one) == set(other)
        for name, value in one.items():
            if not isinstance(value, float):
                continue
            si = other[name] / SIZES[units[name]]
            assert (isnan(value) and isnan(si)) or si == pytest.approx(value, rel=rel, abs=1e-9), name


@pytest.mark.slow
def test_a_stiffness_study_tells_its_units():
    plain, heavy = (stiffness_study(scene, Ladder("both", 1e6, 1e7, 2)) for scene in (SCENE, HEAVY))
    same(plain.records(), heavy.records(), heavy.units)
    assert {"value", "peak_normal_force", "seconds"} <= names_of(heavy.to_dict()) <= set(heavy.units)
    assert plain.units["friction_loss"] == "mgR"
    limits = ({n: limit.value for n, limit in found.limits.items()} for found in (plain, heavy))
    same([next(limits)], [next(limits)], heavy.units)


def test_a_limit_study_tells_its_units():
    """Of measures those of the scene; its events are in R, g and the total mass whatever the scene is in."""
    plain, heavy = (limit_study(scene, foundations=(1e10,)) for scene in (SCENE, HEAVY))
    units = heavy.units
    limits = ({name: term.limit for name, term in found.prediction.terms.items()} for found in (plain, heavy))
    same([next(limits)], [next(limits)], units)
    assert units["value"] == "that of the measure"
    assert set(heavy.to_dataframe().select_dtypes("number")) <= set(units)
    assert names_of(heavy.to_dict()) <= set(units)
    for one, other in zip(plain.events, heavy.events, strict=True):
        numbers = {name: value for name, value in one.to_dict().items() if isinstance(value, (float, list))}
        assert set(numbers) <= set(units)
        for name, value in numbers.items():
            assert other.to_dict()[name] == pytest.approx(value, rel=1e-6, abs=1e-9), name
            assert units[name] == plain.units[name]


@pytest.mark.slow
def test_a_hop_study_tells_its_units():
    def study(**hoop: float) -> HopStudy:
        scene = SCENE.replace(hoop={"mass_ratio": 0.1, **hoop}, solve={"elements": 120})
        return hop_study(map_of(scene, ("ring.bending_stiffness=5",), bisections=0, rtol=1e-2))

    plain, heavy = study(), study(R=0.5, m=2.0, g=9.81)
    (one,), (other,) = ([case.to_dict() for case in found.cases] for found in (plain, heavy))
    assert one["hops"]
    first, second = (told["hops"][0] for told in (one, other))
    same([first], [second], heavy.units, rel=1e-3)
    energies = {name.removeprefix("energies."): unit for name, unit in heavy.units.items()}
    same([first["energies"]], [second["energies"]], energies, rel=1e-3)
    assert (energies["damping"], heavy.units["damping"]) == ("J", "1")
    same([one["scales"]], [other["scales"]], heavy.units)
    assert set(heavy.to_dataframe().select_dtypes("number")) | names_of(heavy.to_dict()) <= set(heavy.units)
    assert (heavy.units["height"], heavy.units["energy"], heavy.units["mu"]) == ("m", "J", "1")


def test_a_sweep_tells_its_units():
    """SI where any of its scenes is: of R = m = g = 1 the numbers are those in metres too."""
    lists = {
        "hoop": {"k": 0.1}, "friction": {"mu_s": 0.35, "mu": 0.3}, "release": {"phi0_deg": [10.0, 20.0]},
        "sweep": {"solvers": ["rigid"]},
    }  # fmt: skip
    plain = run_sweep(lists)
    heavy = run_sweep({**lists, "hoop": {"k": 0.1, "R": 0.5, "m": 2.0, "g": 9.81}})
    assert heavy.units["release.phi0_deg"] == "°"
    same(plain.records(), heavy.records(), {**heavy.units, "release.phi0_deg": "1"})
    assert plain.units["duration"] == "sqrt(R/g)"
    assert run_sweep({**lists, "hoop": {"k": 0.1, "R": [1.0, 0.5], "m": 1.0, "g": 1.0}}).units == {
        "hoop.R": "m",
        **heavy.units,
    }


def test_keys_that_vary_have_their_units():
    """Those of a scene's file, in SI where the scene is; a word has none."""
    varied = {
        "hoop": {"k": 0.1, "R": 0.5, "m": 2.0, "g": [9.81, 1.62]}, "friction": {"mu_s": 0.35, "mu": [0.3, 0.2]},
        "release": {"phi0_deg": 10.0, "omega0": [0.0, 0.1], "slip0": [0.0, 0.1]}, "run": {"t_end": [1.0, 2.0]},
        "contact": {"law": ["patch", "brush"]}, "sweep": {"solvers": ["rigid"]},
    }  # fmt: skip
    heavy = run_sweep(varied)
    wanted = {"hoop.g": "m/s²", "friction.mu": "1", "release.omega0": "1/s", "release.slip0": "m/s", "run.t_end": "s"}
    assert {key: heavy.units.get(key) for key in wanted} == wanted
    assert "contact.law" not in heavy.units
    columns = {name for name, value in heavy.records()[0].items() if not isinstance(value, str)}
    assert columns <= set(heavy.units)
    plain = run_sweep({**varied, "hoop": {"k": 0.1}})
    wanted = {"release.omega0": "sqrt(g/R)", "release.slip0": "sqrt(gR)", "run.t_end": "sqrt(R/g)"}
    assert {key: plain.units.get(key) for key in wanted} == wanted
    section = units_of_keys(["ring.youngs_modulus", "ring.density", "ring.tube_wall", "ring.poisson"], HEAVY)
    assert list(section.values()) == ["Pa", "kg/m³", "m", "1"]
