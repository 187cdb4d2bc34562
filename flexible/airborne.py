"""Off the floor, where the rigid hoop and the flexible one meet: how high a hoop is there, and how fast it rises."""

from __future__ import annotations

from math import cos, sin

import numpy as np

from rigid import Aloft, Kind, Motion, States
from rigid.output.units import without_units

from .models.select import Hoop
from .models.state import State, momentum

ON = 1e-3  # sqrt(R/g) over which the height of a flight is compared
LOWEST = 1e-9  # R: height of a hoop that comes down on the floor
LEAST = 1e-4  # M g R: a hop of less energy than that is over as soon as a rigid hoop takes over


def rise(motion: Motion, told: float, now: States) -> float:
    """Velocity upward of a rigid hoop's centre at a time in the scene's unit, at which its state without units is
    ``now``: in flight that of the mass centre, which falls freely, and its own about that.
    """
    phase, e = motion.phase_at(told), motion.scene.hoop.e
    if phase.kind is not Kind.FLIGHT:
        return 0.0
    on = min(ON * motion.scene.time_unit, (phase.t_end - phase.t_start) / 2)
    then = without_units(motion.at(told + on if told + on <= phase.t_end else told - on), motion.scene)
    dt, dy = float(then.t - now.t), float(then.y_C - now.y_C + e * (np.cos(then.phi) - np.cos(now.phi)))
    return dy / dt + dt / 2 + e * float(np.sin(now.phi) * now.omega)


def turning(hoop: Hoop, state: State, slip: float) -> float:
    """phidot of the rigid hoop that takes over on the floor: with it the rotation has the momentum that it had.

    The disk vibrates on a soft ring with mass, so that its own phidot at an instant is not that of the hoop. With V the
    way of the contact point, the momentum along phi is M [(1 + e c)(V' + (1 + e c) phidot) + (e^2 s^2 + K) phidot].
    """
    scene = hoop.scene.hoop
    s, lever = sin(state.pos[2]), 1 + scene.e * cos(state.pos[2])
    about = momentum(hoop, state, np.eye(len(state.vel))[2]) / (1 + scene.mass_ratio)
    return (about - lever * slip) / (lever**2 + (scene.e * s) ** 2 + scene.K)


def taken_over(hoop: Hoop, state: State) -> tuple[float, Aloft]:
    """Slip velocity, and where over the floor, of the rigid hoop that takes over from a flexible one.

    In flight its mass centre is where that one's is and moves as it does. On the floor, where that one touches it or
    all but does, it moves along the floor alone: what energy the other has beyond that is lost.
    """
    on_the_floor = float(hoop.law.handed_back(state)), Aloft()
    if state.res.elastic > 0:
        return on_the_floor
    scene = hoop.scene.hoop
    mass, s, c, omega = 1 + scene.mass_ratio, sin(state.pos[2]), cos(state.pos[2]), float(state.vel[2])
    along, up = np.eye(len(state.vel))[:2]
    rising = momentum(hoop, state, up) / mass + scene.e * s * omega
    height = max(float(hoop.energies(state)[1]) / mass - 1 - scene.e * c, LOWEST)
    if height + rising**2 / 2 < LEAST:
        return on_the_floor
    slip = momentum(hoop, state, along) / mass - omega * (1 + scene.e * c)
    return slip, Aloft(height, rising)
