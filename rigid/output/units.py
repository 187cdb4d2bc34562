"""What each quantity is measured in, said where the quantity is defined.

A field of a record names its unit in its type: ``t: Time[float]``, ``phi: Number[float]``, ``energy: Energy[Array]``.
The solvers compute with R = m = g = 1; :func:`in_units` gives a record in the units of a scene and
:func:`without_units` takes them off again. A number whose field does not say its unit is refused, so that none can stay
behind in the solver's.
"""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Callable
from enum import Enum
from functools import cache
from math import sqrt
from operator import mul, truediv
from typing import Annotated, Any, TypeVar, get_args, get_origin, get_type_hints

import numpy as np


class _Scaling(threading.local):
    """Whether this thread writes in other units what a user has given, and has been told about, before."""

    now = False


scaling = _Scaling()


class Measured:
    """What has a hoop of radius R and a disk of mass m under gravity g, of which all units are made."""

    __slots__ = ()
    hoop: Any

    @property
    def dimensionless(self) -> bool:
        """Whether it is in the paper's scaling."""
        return bool(self.hoop.R == self.hoop.m == self.hoop.g == 1)

    @property
    def time_unit(self) -> float:
        """sqrt(R/g)."""
        return sqrt(self.hoop.R / self.hoop.g)

    @property
    def velocity_unit(self) -> float:
        """sqrt(g R)."""
        return sqrt(self.hoop.R * self.hoop.g)

    @property
    def force_unit(self) -> float:
        """m g."""
        return float(self.hoop.m * self.hoop.g)

    @property
    def impulse_unit(self) -> float:
        """m sqrt(g R)."""
        return float(self.hoop.m * self.velocity_unit)

    @property
    def energy_unit(self) -> float:
        """m g R."""
        return float(self.force_unit * self.hoop.R)


class Unit(Enum):
    """The unit of a quantity: its names in the paper's scaling, as text and as a formula, and in SI."""

    NUMBER = "", "", ""
    TIME = "sqrt(R/g)", r"\sqrt{R/g}", "s"
    ANGULAR_VELOCITY = "sqrt(g/R)", r"\sqrt{g/R}", "1/s"
    ANGULAR_ACCELERATION = "g/R", "g/R", "1/s²"
    LENGTH = "R", "R", "m"
    VELOCITY = "sqrt(gR)", r"\sqrt{gR}", "m/s"
    FORCE = "mg", "mg", "N"
    IMPULSE = "m sqrt(gR)", r"m\sqrt{gR}", "N s"
    ENERGY = "mgR", "mgR", "J"

    @property
    def formula(self) -> str:
        """In the paper's scaling, for a label between dollar signs."""
        return self.value[1]

    @property
    def si(self) -> str:
        """In SI units."""
        return self.value[2]

    def label(self, scene: Measured) -> str:
        """What to print behind a number in the units of ``scene``."""
        return self.value[0] if scene.dimensionless else self.si

    def of(self, scene: Measured) -> float:
        """How much it is in a scene; 1 in the paper's scaling."""
        return _SIZES[self](scene)


_SIZES: dict[Unit, Callable[[Measured], float]] = {
    Unit.NUMBER: lambda scene: 1.0,
    Unit.TIME: lambda scene: scene.time_unit,
    Unit.ANGULAR_VELOCITY: lambda scene: 1 / scene.time_unit,
    Unit.ANGULAR_ACCELERATION: lambda scene: 1 / scene.time_unit**2,
    Unit.LENGTH: lambda scene: scene.hoop.R,
    Unit.VELOCITY: lambda scene: scene.velocity_unit,
    Unit.FORCE: lambda scene: scene.force_unit,
    Unit.IMPULSE: lambda scene: scene.impulse_unit,
    Unit.ENERGY: lambda scene: scene.energy_unit,
}

T = TypeVar("T")
Number = Annotated[T, Unit.NUMBER]
"""An angle in radians, a share, a ratio."""
Time = Annotated[T, Unit.TIME]
AngularVelocity = Annotated[T, Unit.ANGULAR_VELOCITY]
AngularAcceleration = Annotated[T, Unit.ANGULAR_ACCELERATION]
Length = Annotated[T, Unit.LENGTH]
Velocity = Annotated[T, Unit.VELOCITY]
Force = Annotated[T, Unit.FORCE]
Impulse = Annotated[T, Unit.IMPULSE]
Energy = Annotated[T, Unit.ENERGY]


@cache
def units_of(record: type[Any]) -> dict[str, Unit]:
    """Units of all the numbers of a record, by field.

    Raises
    ------
    TypeError
        A number, or an array of them, that says no unit.
    """
    units = {}
    for name, hint in _hints(record).items():
        said = [extra for extra in getattr(hint, "__metadata__", ()) if isinstance(extra, Unit)]
        if said:
            units[name] = said[0]
        elif any(np.ndarray in (kind, get_origin(kind)) or kind is float for kind in (hint, *get_args(hint))):
            raise TypeError(f"{record.__name__}.{name} does not say its unit")
    return units


@cache
def _parts(record: type[Any]) -> tuple[str, ...]:
    """Fields that are records themselves, or tuples of them."""
    return tuple(
        name for name, hint in _hints(record).items() if any(map(dataclasses.is_dataclass, (hint, *get_args(hint))))
    )


def _hints(record: type[Any]) -> dict[str, Any]:
    hints = get_type_hints(record, include_extras=True)
    return {field.name: hints[field.name] for field in dataclasses.fields(record)}


def unit_names(scene: Measured, *records: type) -> dict[str, str]:
    """What the numbers of these records are measured in, by field; "1" for angles in radians, shares and ratios."""
    return {name: unit.label(scene) or "1" for record in records for name, unit in units_of(record).items()}


def in_units(record: T, scene: Measured) -> T:
    """A record of the solver's numbers (R = m = g = 1), and the records in it, in the units of a scene."""
    return record if scene.dimensionless else _scaled(record, scene, mul)


def without_units(record: T, scene: Measured) -> T:
    """The same backwards."""
    return record if scene.dimensionless else _scaled(record, scene, truediv)


def _scaled(record: Any, scene: Measured, by: Callable[[Any, float], Any]) -> Any:
    changes: dict[str, Any] = {}
    for name, unit in units_of(type(record)).items():  # type: ignore[arg-type]
        content = getattr(record, name)
        changes[name] = None if content is None else by(content, unit.of(scene))
    for name in _parts(type(record)):  # type: ignore[arg-type]
        content = getattr(record, name)
        if isinstance(content, tuple):
            changes[name] = tuple(_scaled(part, scene, by) for part in content)
        elif content is not None:
            changes[name] = _scaled(content, scene, by)
    scaling.now = True
    try:
        return dataclasses.replace(record, **changes)
    finally:
        scaling.now = False
