"""Units of quantities: part of their definition, the same way there and back."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
import pytest

import flexible
import rigid
import studies
from rigid import Kind, Phase, Pulse, Scene, States, Turn
from rigid.output.units import Energy, Length, Time, Unit, in_units, units_of, without_units

R, M, G = 0.31, 0.73, 9.81
SCENE = rigid.load_scene("paper-3.1").replace(hoop={"R": R, "m": M, "g": G}, release={"omega0": 0.4, "slip0": -0.2})


@pytest.mark.parametrize(
    ("unit", "value"),
    [
        (Unit.NUMBER, 1), (Unit.TIME, sqrt(R / G)), (Unit.ANGULAR_VELOCITY, sqrt(G / R)),
        (Unit.ANGULAR_ACCELERATION, G / R), (Unit.LENGTH, R), (Unit.VELOCITY, sqrt(G * R)), (Unit.FORCE, M * G),
        (Unit.IMPULSE, M * sqrt(G * R)), (Unit.ENERGY, M * G * R),
    ],
)  # fmt: skip
def test_every_unit_is_made_of_radius_mass_and_gravity(unit: Unit, value: float) -> None:
    assert unit.of(SCENE) == pytest.approx(value, rel=1e-15)  # a product or root in another order
    assert unit.of(SCENE.to_dimensionless()) == 1
    name, symbol = unit.value[0], unit.label(SCENE)
    assert (name == "") == (symbol == "")
    assert unit.label(SCENE.to_dimensionless()) == name


def test_there_and_back() -> None:
    """Two roundings a number: 4 ulp is enough."""
    turn = Turn(1.1, 2.2, -3.3, 4.4)
    there = in_units(turn, SCENE)
    assert there.t == turn.t * sqrt(R / G)
    assert there.phi == turn.phi
    assert there.slip_velocity == pytest.approx(turn.slip_velocity * sqrt(G * R), rel=1e-15)
    assert dataclasses.astuple(without_units(there, SCENE)) == pytest.approx(dataclasses.astuple(turn), rel=1e-15)


@dataclass(frozen=True)
class Outer:
    length: Length[float]
    phases: tuple[Phase, ...]
    last: Turn | None
    energies: Energy[np.ndarray]


def test_records_within_records() -> None:
    phase = Phase(Kind.ROLL, 0.0, 2.0, 0.1, 0.2)
    outer = Outer(1.0, (phase, phase), None, np.array([1.0, 2.0]))
    found = in_units(outer, SCENE)
    assert found.length == R
    assert [p.t_end for p in found.phases] == [2 * sqrt(R / G)] * 2
    assert found.last is None
    np.testing.assert_allclose(found.energies, M * G * R * np.array([1, 2]), rtol=1e-15)


def test_a_forgotten_unit_is_refused() -> None:
    for forgotten in (float, np.ndarray, float | None):
        record = dataclasses.make_dataclass("Record", [("t", Time[float]), ("speed", forgotten)])
        with pytest.raises(TypeError, match=r"Record\.speed does not say its unit"):
            units_of(record)


def records() -> list[type[Any]]:
    """Every record of the packages in which one number says its unit."""
    found: dict[str, type[Any]] = {}
    for package in (rigid, flexible, studies):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if "examples" in module.name or "peers" in module.name:
                continue
            for name, kind in inspect.getmembers(importlib.import_module(module.name), dataclasses.is_dataclass):
                if inspect.isclass(kind) and kind.__module__ == module.name and "[" in says(kind):
                    found[f"{module.name}.{name}"] = kind
    return list(found.values())


def says(record: type[Any]) -> str:
    """The units in its definition."""
    words = [f"{unit}[" for unit in ("Time", "Number", "Length", "Velocity", "Force", "Impulse", "Energy")]
    return " ".join(word for word in words for field in dataclasses.fields(record) if word in str(field.type))


def test_a_record_says_all_units_or_none() -> None:
    listed = records()
    assert {Phase, Turn, Pulse, States, flexible.FlexiblePulse, flexible.History, flexible.Ledger} <= set(listed)
    for record in listed:
        assert units_of(record)


#: what is measured in which unit, by name
MEASURED = {
    Unit.TIME: "t t_start t_end time_off_floor",
    Unit.NUMBER: "phi phi0 phi_start phi_end stick_fraction"
    " newton_restitution poisson_restitution energetic_restitution",
    Unit.ANGULAR_VELOCITY: "omega omega0",
    Unit.ANGULAR_ACCELERATION: "alpha",
    Unit.LENGTH: "x_C y_C patch_length",
    Unit.VELOCITY: "slip_velocity slip0 vertical_velocity",
    Unit.FORCE: "normal_force friction_force peak_normal_force",
    Unit.IMPULSE: "normal_impulse friction_impulse",
    Unit.ENERGY: "energy initial kinetic gravity ring_strain contact_spring ring_energy_peak contact_energy_peak"
    " friction_loss damping_loss landing_loss numerical_loss hand_over residual",
}


@pytest.mark.parametrize(
    "record",
    [Phase, Turn, Pulse, States, rigid.Release, rigid.Run, flexible.FlexiblePulse, flexible.History, flexible.Ledger],
)
def test_a_quantity_has_the_unit_of_what_it_is(record: type[Any]) -> None:
    of = {name: unit for unit, names in MEASURED.items() for name in names.split()}
    assert units_of(record) == {name: of[name] for name in units_of(record)}


def test_a_scene_without_its_units() -> None:
    scene: Scene = SCENE.replace(run={"t_end": 3.0}).to_dimensionless()
    assert scene.dimensionless
    assert scene.release.omega0 == pytest.approx(0.4 * sqrt(R / G), rel=1e-15)
    assert scene.release.slip0 == pytest.approx(-0.2 / sqrt(G * R), rel=1e-15)
    assert scene.run.t_end == pytest.approx(3 / sqrt(R / G), rel=1e-15)
    assert units_of(type(scene.release))["phi0"] is Unit.NUMBER
