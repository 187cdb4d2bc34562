"""The rigid hoop in Exudyn: a heavy roll on a plane, by penalty, its friction regularised over a small slip velocity.

R = m = g = 1. The roll is a barrel, so that it touches at one point; static friction decays to dynamic over the same
velocity as the regularisation.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from .rigid_pulse import Start, States

BULGE, WIDTH = 0.1, 0.4  # of the barrel


@dataclass(frozen=True)
class Setting:
    """Stiffness and damping of the floor, slip velocity of the regularisation, step."""

    stiffness: float
    damping: float
    velocity: float
    step: float

    def __str__(self) -> str:
        return f"stiffness {self.stiffness:g}, slip {self.velocity:g}, h = {self.step:g}"


SETTINGS = (
    Setting(1e5, 3e2, 1e-3, 1e-3),
    Setting(1e6, 1e3, 1e-3, 1e-4),
    Setting(1e6, 1e3, 1e-4, 1e-4),
)


def roll_turns(
    k: float, mu_s: float, mu: float, phi0: float, turns: int, setting: Setting
) -> list[tuple[float, float, float, float]]:
    """Turns as (t, phi, slip velocity, energy), between steps by straight lines.

    Raises
    ------
    ImportError
        Exudyn is not installed.
    RuntimeError
        It does not get there.
    """
    import exudyn as exu

    system = exu.SystemContainer().AddSystem()
    still = Start(1 - k, k * k / 2, mu_s, mu, phi0, 0.0, 0.0, 1.0, (0.0, pi), 9.5)
    spin, place, speed = _marched(exu, system, still, setting)
    t, omega = spin[:, 0], -spin[:, 1]
    phi = phi0 + np.concatenate([[0.0], np.cumsum((omega[1:] + omega[:-1]) / 2 * np.diff(t))])
    # it trembles before it rolls
    crossings = [i for i in np.flatnonzero(omega[1:] * omega[:-1] < 0) if t[i] > 0.1][:turns]
    if len(crossings) < turns:
        raise RuntimeError(f"{len(crossings)} of {turns} turns were found")
    found = []
    for i in crossings:
        f = omega[i] / (omega[i] - omega[i + 1])
        now, angle, slip, height, rate = (
            float(values[i] + f * (values[i + 1] - values[i]))
            for values in (t, phi, speed[:, 2], place[:, 3], speed[:, 3])
        )
        energy = 0.5 * (slip**2 + rate**2) + height + (1 - k) * float(np.cos(angle))
        found.append((now, angle, slip, energy))
    return found


def pulse(start: Start, setting: Setting) -> States:
    """States of the first pulse.

    Raises
    ------
    ImportError
        Exudyn is not installed.
    """
    import exudyn as exu

    spin, _, speed = _marched(exu, exu.SystemContainer().AddSystem(), start, setting)
    t, omega = spin[:, 0], -spin[:, 1]
    phi = start.phi + np.concatenate([[0.0], np.cumsum((omega[1:] + omega[:-1]) / 2 * np.diff(t))])
    return States(t, phi, omega, speed[:, 2], speed[:, 3])


def _marched(exu: Any, system: Any, start: Start, setting: Setting) -> list[Any]:
    """(steps, 4) angular velocity, position and velocity of the middle, each behind its time."""
    body = _roll(system, start, setting)
    sensors = [_sensor(system, body, kind) for kind in ("AngularVelocity", "Position", "Velocity")]
    system.Assemble()
    system.SolveDynamic(_settings(exu, setting.step, start.duration))
    return [np.asarray(system.GetSensorStoredData(sensor)) for sensor in sensors]


def _roll(system: Any, start: Start, setting: Setting) -> int:
    """The body in the equilibrium of its penetration, rolling along y about its axis x."""
    import exudyn.itemInterface as item
    from exudyn.rigidBodyUtilities import RigidBodyInertia, RotationMatrixX

    centre = np.array([0.0, 0.0, start.e])
    tensor = np.eye(3) * start.gyration + centre @ centre * np.eye(3) - np.outer(centre, centre)
    body: int = system.CreateRigidBody(
        inertia=RigidBodyInertia(mass=1.0, inertiaTensor=tensor, com=centre),
        referencePosition=[0.0, 0.0, 1.0 - start.normal / setting.stiffness],
        referenceRotationMatrix=RotationMatrixX(-start.phi),
        initialVelocity=[0.0, start.slip + start.omega, 0.0],
        initialAngularVelocity=[-start.omega, 0.0, 0.0],
        gravity=[0.0, 0.0, -1.0],
    )
    markers = [system.AddMarker(item.MarkerBodyRigid(bodyNumber=number)) for number in (system.CreateGround(), body)]
    memory = system.AddNode(item.NodeGenericData(initialCoordinates=[0, 0, 0], numberOfDataCoordinates=3))
    system.AddObject(
        item.ObjectContactConvexRoll(
            markerNumbers=markers,
            nodeNumber=memory,
            contactStiffness=setting.stiffness,
            contactDamping=setting.damping,
            dynamicFriction=start.mu,
            staticFrictionOffset=start.mu_s - start.mu,
            viscousFriction=0.0,
            exponentialDecayStatic=setting.velocity,
            frictionProportionalZone=setting.velocity,
            rollLength=WIDTH,
            coefficientsHull=[-BULGE, 0.0, 1.0],
        )
    )
    return body


def _sensor(system: Any, body: int, kind: str) -> Any:
    import exudyn as exu
    import exudyn.itemInterface as item

    variable = getattr(exu.OutputVariableType, kind)
    return system.AddSensor(
        item.SensorBody(bodyNumber=body, outputVariableType=variable, storeInternal=True, writeToFile=False)
    )


def _settings(exu: Any, step: float, t_end: float) -> Any:
    settings = exu.SimulationSettings()
    march = settings.timeIntegration
    march.endTime, march.numberOfSteps = t_end, round(t_end / step)
    march.generalizedAlpha.spectralRadius = 0.8
    march.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    return settings
