"""The flexible hoop at an instant of a rigid motion.

A hoop handed over undeformed would ring. Under the rigid hoop's N, F and accelerations the ring and the patch are
brought to rest in the disk's frame, and their rates are those of the equilibria along the rigid motion. A damped floor
bears a part of N by these rates: its springs are pressed by the rest.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from rigid import Kind, Motion, States
from rigid.output.units import without_units

from ..airborne import LEAST_HOP, rise
from ..contact.laws.law import Rolling
from ..contact.laws.listing import is_smoothed
from ..contact.points.rim import lift, sideways, upward
from ..models.select import Hoop
from ..models.state import State
from ..ring.choice import UNEVEN
from ..ring.fem import membrane_stiffness
from ..time.adaptive import restart
from .balance import balanced
from .equilibrium import equilibrium, undeformed
from .pose import Pose, instants_around, pose_of, poses_at

Array = NDArray[np.float64]

UNEVENLY = (
    1e-5  # R, by which a rim may stand deeper from place to place, over their distance: a rate's error over phidot
)
JUMPS = 0.1  # of N: less than this of it may be the damper's that the springs of a start bear, for an instant
FALLS = 0.5  # of N in the time of its damper: where it falls faster its springs are behind it by more than is known


def _begins_with_a_blow(motion: Motion) -> bool:
    """Whether a rigid hoop is released slipping where Coulomb's law has no forces for it, and friction stops it.

    One that has no more than a hop's energy to lose is one that creeps, as rolling elastic hoops do.
    """
    if not motion.phases or motion.phases[0].kind is not Kind.IMPACT:
        return False
    lost = float(motion.at(0.0, "left").energy - motion.at(0.0).energy)
    return lost > LEAST_HOP * (1 + motion.scene.hoop.mass_ratio) * motion.scene.energy_unit


def hand_over(hoop: Hoop, motion: Motion, t: float, there: States | None = None) -> State:
    """The flexible hoop at time ``t`` of a rigid motion, with the rates of the equilibria around it.

    ``there`` is the motion's state at that time, where it is known. At the release of one that begins with a blow there
    is no equilibrium: the hoop is as it was thrown, and undeformed.
    """
    scene = motion.scene
    if t == 0 and there is None and _begins_with_a_blow(motion):
        return undeformed(hoop, pose_of(without_units(motion.at(0.0, "left"), scene), Kind.IMPACT))
    now = without_units(motion.at(t) if there is None else there, scene)
    pose = pose_of(now, motion.phase_at(t).kind)
    if scene.solve.start == "undeformed" and t == 0:
        return undeformed(hoop, pose)
    state = equilibrium(hoop, pose, float(now.t), float(now.x_C))
    vel, u_rate, rising = _rates(hoop, motion, t, now, state)
    law, bristles, creep = hoop.law, state.bristles, 0.0
    if len(bristles.number) and pose.kind == Kind.ROLL:
        bristles, creep = law.rolled_in(bristles, state.res, Rolling(pose.phi, pose.omega, hoop.relaxation))
    elif len(bristles.number):
        bristles = law.slid_in(bristles, state.res)
    vel[0] = pose.slip_velocity + creep - u_rate - pose.omega * _lift(hoop, state)
    state = state._replace(
        vel=vel, acc=np.zeros_like(vel), bristles=bristles, slip_velocity=pose.slip_velocity + creep
    )  # fmt: skip
    held = pose.kind == Kind.ROLL and len(bristles.number) > 0 and not is_smoothed(law.parameters)
    if hoop.relaxation * abs(rising) > JUMPS * pose.normal_force > 0:
        return _pressed_by_part(hoop, state, pose, rising / pose.normal_force, creep, held)
    return balanced(hoop, state, pose, creep, held) if held else restart(hoop, state, state.mode)


def _places(hoop: Hoop, now: States) -> float:
    """Angle after which a soft thick rim gives way as before, 0 where it does so evenly.

    What its places differ by is no velocity: rates over anything but whole elements would count it as one.
    """
    if hoop.linear:
        return 0.0
    felt = UNEVEN * float(now.normal_force) / (membrane_stiffness(hoop.scene) * hoop.element)
    return float(hoop.element) if felt > UNEVENLY else 0.0


def _rates(hoop: Hoop, motion: Motion, t: float, now: States, state: State) -> tuple[Array, float, float]:
    """Of the equilibria along a rigid motion around ``state``: velocities, (3 + coordinates,) without that of the disk
    along the floor; that of the loaded rim along the floor; and the rate of N.
    """
    vel, u_rate, rising = np.zeros_like(state.pos), 0.0, 0.0
    vel[2] = float(now.omega)
    around = instants_around(motion, t, now, _places(hoop, now)) if vel[2] != 0 else ()
    for nearby, weight in poses_at(motion, around):
        resting = equilibrium(hoop, nearby, near=state)
        rising += weight * nearby.normal_force
        vel[1] += weight * (resting.pos[1] - nearby.height)
        vel[3:] += weight * resting.pos[3:]
        u_rate += weight * _abscissa(hoop, resting, state)
    vel[1] += rise(motion, t, now)
    return vel, u_rate, rising


def _pressed_by_part(hoop: Hoop, state: State, pose: Pose, grows: float, creep: float, held: bool) -> State:
    """``state`` with the springs of its floor pressed by what the dampers leave them of N, which ``grows`` by so many
    times itself in a unit of time: N = N_el + theta dN_el/dt, and N_el goes like N.
    """
    springs = 1 / (1 + max(hoop.relaxation * grows, -FALLS))
    elastic_rate = (1 - springs) * pose.normal_force / hoop.relaxation
    state = state._replace(res=state.res._replace(eta=1 / springs), elastic_rate=elastic_rate)
    found = balanced(hoop, state, pose, creep, held)
    # a parabolic patch is as deep as N_el^(2/3), and was taken to sink as N does
    share, vel = springs ** (2 / 3), found.vel.copy()
    depth = (state.pos[1] - found.pos[1]) / (share - 1)
    vel[1] -= 2 / 3 * depth * (share * elastic_rate / (springs * pose.normal_force) - grows)
    return found._replace(vel=vel)


def _lift(hoop: Hoop, state: State) -> float:
    """Mean height of the undeformed rim over its lowest point, weighted by the load: the rolling slip over phidot."""
    first, count = state.window
    psi = state.pos[2] + hoop.rim_angle(np.arange(2 * first, 2 * (first + count) + 1)) - pi
    load = upward(state.nodal[:, 0], state.nodal[:, 1], sin(state.pos[2]), cos(state.pos[2]))
    total = load.sum()
    return float(load @ lift(psi) / total) if total > 0 else 0.0


def _abscissa(hoop: Hoop, state: State, reference: State) -> float:
    """Mean u_X at ``state`` of the rim nodes under load at ``reference``, weighted by that load."""
    u = hoop.displacement(state, reference.window)
    s, c = sin(reference.pos[2]), cos(reference.pos[2])
    s_now, c_now = sin(state.pos[2]), cos(state.pos[2])
    load = upward(reference.nodal[:, 0], reference.nodal[:, 1], s, c)
    total = load.sum()
    if total == 0:
        return 0.0
    return float(load @ sideways(u[:, 0], u[:, 1], s_now, c_now) / total)
