"""A state that carries the forces of a rigid pose under its own law of friction."""

from __future__ import annotations

import numpy as np

from ..models.select import Hoop
from ..models.state import State
from ..time.adaptive import MarchError, restart
from .pose import Pose

#: A parabolic patch of which no point has let go creeps F/(3 mu N) of what lets go all, which so is at most this many
#: times as much as it. Where nearly all do, F all but stands still, and the points of a brush may never carry it.
ALL_SLIP = 3.0


def balanced(hoop: Hoop, state: State, pose: Pose, creep: float, held: bool) -> State:
    """``state`` under its own law of friction, with the height at which it carries N of the pose, and if it is ``held``
    to the floor by its bristles the stretch at which it carries F.

    The ring gives way to a friction that is not shared like the pressure, and bristles of a brush have let go at its
    rear, so both come out different at first; a hoop of small inertia would start with the acceleration that the
    difference makes. The ``creep`` of the state goes with the stretch that it keeps up, as far as all points slip.
    Broyden's method.
    """
    wanted = np.array([pose.normal_force, pose.friction_force])
    best, least = restart(hoop, state, state.mode), np.inf
    # bristles that are to pull nothing have no stretch to take more or less of
    by_stretch = 1 / best.res.friction if held and pose.friction_force and best.res.friction else 0.0
    inverse = np.diag([-1 / (hoop.law.parameters.eps_n * best.res.length + 1e-300), by_stretch])  # of their derivatives
    change, step, off = np.zeros(2), np.zeros(2), np.zeros(2)  # of height and share of the stretch
    for _ in range(25):
        pos, vel = state.pos.copy(), state.vel.copy()
        pos[1] += change[0]
        vel[0] += change[1] * creep
        other = state._replace(
            pos=pos, vel=vel, slip_velocity=state.slip_velocity + change[1] * creep,
            bristles=state.bristles._replace(stretch=state.bristles.stretch * (1 + change[1])),
        )  # fmt: skip
        try:
            found = restart(hoop, other, state.mode)
        except MarchError:
            break
        before, off = off, np.array([found.res.normal, found.res.friction if held else wanted[1]]) - wanted
        if np.abs(off).max() < least:
            best, least = found, float(np.abs(off).max())
        if least < 1e-11 * (1 + pose.normal_force):
            break
        gained = off - before
        along = step @ inverse
        if along @ gained != 0:
            inverse += np.outer(step - inverse @ gained, along) / (along @ gained)
        ahead = change - inverse @ off
        ahead[1] = min(max(ahead[1], -1.0), ALL_SLIP - 1)
        step, change = ahead - change, ahead
    return best
