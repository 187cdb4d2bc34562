"""From the solver's numbers, R = m = g = 1, to the units of a scene."""

from __future__ import annotations

import dataclasses
from dataclasses import replace
from typing import Any

from rigid import Run, Scene

_DIMENSIONS = {
    "t": "time_unit", "t_start": "time_unit", "t_end": "time_unit", "time_off_floor": "time_unit",
    "x_C": "length_unit", "y_C": "length_unit", "patch_length": "length_unit",
    "slip_velocity": "velocity_unit", "approach_velocity": "velocity_unit",
    "normal_force": "force_unit", "friction_force": "force_unit", "peak_normal_force": "force_unit",
    "normal_impulse": "impulse_unit", "friction_impulse": "impulse_unit",
}  # fmt: skip
_ENERGIES = {
    "energy", "initial", "kinetic", "gravity", "ring_strain", "contact_spring", "friction_loss", "damping_loss",
    "landing_loss", "hand_over", "numerical_loss", "residual", "ring_energy_peak", "contact_energy_peak",
}  # fmt: skip


def with_units(value: Any, scene: Scene) -> Any:
    """A dataclass of the solver's numbers with every field in the units of the scene."""
    changes: dict[str, Any] = {}
    for field in dataclasses.fields(value):
        content = getattr(value, field.name)
        if field.name in _DIMENSIONS:
            changes[field.name] = content * _unit(scene, _DIMENSIONS[field.name])
        elif field.name in _ENERGIES:
            changes[field.name] = content * scene.energy_unit
        elif field.name == "omega":
            changes[field.name] = content / scene.time_unit
        elif field.name == "alpha":
            changes[field.name] = content / scene.time_unit**2
        elif field.name == "phases":
            changes[field.name] = tuple(with_units(phase, scene) for phase in content)
    return replace(value, **changes)


def _unit(scene: Scene, name: str) -> float:
    return scene.hoop.R if name == "length_unit" else getattr(scene, name)


def dimensionless(scene: Scene) -> Scene:
    """The same scene in the paper's scaling, R = m = g = 1."""
    release, run = scene.release, scene.run
    return scene.replace(
        hoop={"R": 1.0, "m": 1.0, "g": 1.0},
        release={
            "omega0": release.omega0 * scene.time_unit,
            "slip0": release.slip0 / scene.velocity_unit,
        },
        run=run if run.t_end is None else Run(t_end=run.t_end / scene.time_unit),
    )
