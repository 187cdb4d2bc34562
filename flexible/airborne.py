"""Off the floor, where the rigid hoop and the flexible one meet: how high a hoop is there, and how fast it rises."""

from __future__ import annotations

from math import cos, inf, sin

import numpy as np

from rigid import Aloft, Kind, Motion, Scene, States
from rigid.output.units import without_units

from .models.select import Hoop
from .models.state import State, momentum

ON = 1e-3  # sqrt(R/g) over which the height of a flight is compared
LOWEST = 1e-9  # R: height of a hoop that comes down on the floor
LEAST_HOP = 1e-4  # M g R: a hop of less energy than that is over as soon as a rigid hoop takes over


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


def _gyration(scene: Scene) -> float:
    """K of the elastic hoop: of one without thickness the rigid one has all the mass at its rim, and turns as it does
    with more momentum.
    """
    hoop = scene.hoop
    inside = 0.0 if hoop.r > 1 else scene.wall * (2 - scene.wall) / 2
    return hoop.K - inside * hoop.mass_ratio / (1 + hoop.mass_ratio)


def taken_over(hoop: Hoop, state: State) -> tuple[float, float, Aloft]:
    """phidot, slip velocity, and where over the floor, of the rigid hoop that takes over from a flexible one.

    It has that one's momentum: on the floor, where that one touches it or all but does, along phi, and along the floor
    unless it rolls; in flight along all three, its mass centre where that one's is. What energy the other has beyond
    that, of its vibrations, is lost.
    """
    scene, K, units = hoop.scene.hoop, _gyration(hoop.scene), np.eye(len(state.vel))[:3]
    mass, s, c = 1 + scene.mass_ratio, sin(state.pos[2]), cos(state.pos[2])
    along, up, about = (momentum(hoop, state, unit) / mass for unit in units)
    lever, beside = 1 + scene.e * c, scene.e * s
    if state.res.elastic == 0:
        omega = (about - lever * along + beside * up) / K
        rising = up + beside * omega
        height = max(float(hoop.energies(state)[1]) / mass - 1 - scene.e * c, LOWEST)
        if height + rising**2 / 2 >= LEAST_HOP:
            return omega, along - lever * omega, Aloft(height, rising)
    inertia = lever**2 + beside**2 + K
    rolling = about / inertia
    alpha = beside * (1 + rolling**2) / inertia
    normal, friction = 1 - alpha * beside - rolling**2 * (lever - 1), alpha * lever - rolling**2 * beside
    if hoop.law.rolls(state, rolling, abs(friction) / normal if normal > 0 else inf):
        return rolling, 0.0, Aloft()
    omega = (about - lever * along) / (beside**2 + K)
    return omega, along - lever * omega, Aloft()
