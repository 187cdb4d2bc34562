"""Where a flexible segment begins: in the quasi-static elastic equilibrium of the rigid motion at that instant.

A hoop handed over undeformed would ring. Under the rigid hoop's N, F and accelerations the ring and the patch are
brought to rest in the disk's frame, and their rates are those of the equilibria along the rigid motion. A damped floor
bears a part of N by these rates: its springs are pressed by the rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from math import ceil, cos, inf, pi, sin, sqrt
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from rigid import Kind, Motion, Side, States
from rigid.output.units import without_units

from .airborne import rise
from .contact.laws.law import Rolling
from .contact.laws.listing import is_smoothed
from .contact.points.data import NOTHING, no_bristles
from .contact.points.rim import lift, sideways, upward
from .models.equilibrium import Patch
from .models.select import Hoop
from .models.state import State, Touching, in_motion
from .settling import settle, settle_free
from .time.adaptive import MarchError, compile_steps, restart
from .time.course import Stop

Array = NDArray[np.float64]

# Time between the equilibria of which rates are made, in the time in which the forces change. Its square is the error
# of the rates; a shorter one sees how the patch's height ripples as point after point comes to bear (measured at a
# foundation of 1e4: rates 35 % off at 1e-3, 0.5 % at 1e-2).
SPAN = 1e-2
#: A parabolic patch of which no point has let go creeps F/(3 mu N) of what lets go all, which so is at most this many
#: times as much as it. Where nearly all do, F all but stands still, and the points of a brush may never carry it.
ALL_SLIP = 3.0
JUMPS = 0.1  # of N: less than this of it may be the damper's that the springs of a start bear, for an instant
FALLS = 0.5  # of N in the time of its damper: where it falls faster its springs are behind it by more than is known


@dataclass(frozen=True, slots=True)
class Pose:
    """An instant of the rigid motion in the units of the flexible solver (R = m = g = 1)."""

    phi: float
    omega: float
    slip_velocity: float
    normal_force: float
    friction_force: float
    kind: Kind
    height: float = 0.0  # of the lowest point over the floor

    def accelerations(self, hoop: Hoop) -> tuple[float, float, float]:
        """Acceleration of C, horizontal and vertical, the latter beyond free fall, and angular acceleration, from the
        balance of the rigid hoop."""
        rigid = hoop.scene.hoop
        mass = 1 + rigid.mass_ratio
        s, c = sin(self.phi), cos(self.phi)
        angular = (self.normal_force * rigid.e * s - self.friction_force * (1 + rigid.e * c)) / (rigid.K * mass)
        up = rigid.e * self.omega**2 * c if self.kind is Kind.FLIGHT else 1.0
        return self.friction_force / mass - rigid.e * (angular * c - self.omega**2 * s), up, angular


def _pose(now: States, kind: Kind) -> Pose:
    forces = float(now.normal_force), float(now.friction_force)
    return Pose(float(now.phi), float(now.omega), float(now.slip_velocity), *forces, kind, max(float(now.y_C) - 1, 0.0))


def _instants_around(motion: Motion, t: float, now: States) -> tuple[tuple[float, Side, float], ...]:
    """Instants (time, side, weight) of the phase at ``t``: the weighted sum of a quantity over them is its rate.

    ``now`` are the motion's states there, without units.

    The forces of the rigid hoop are functions of the angle, by way of zeta + 2 (1 + cos phi), and of 1 + phidot^2: they
    change in the time in which the root of the first or the second one do, k^2 in the pulse of a small disk. Across an
    end of the phase they jump, which is no rate, so there the parabola through three instants leans to one side.
    """
    phase, unit = motion.phase_at(t), motion.scene.time_unit
    omega, alpha = float(now.omega), float(now.alpha)
    width = sqrt(motion.scene.hoop.constants.zeta + 4 * cos(float(now.phi) / 2) ** 2)
    fastest = max(1.0, abs(omega) / width, 2 * abs(omega * alpha) / (1 + omega**2))
    step = min(SPAN * unit / fastest, (phase.t_end - phase.t_start) / 2)
    if not 0 < step < inf:
        return ()
    middle = min(max(t, phase.t_start + step), phase.t_end - step)
    x, rate = (t - middle) / step, unit / step
    around: tuple[tuple[float, Side, float], ...] = (
        (max(middle - step, phase.t_start), "right", (x - 0.5) * rate),
        (middle, "right", -2 * x * rate),
        (min(middle + step, phase.t_end), "left" if middle + step >= phase.t_end else "right", (x + 0.5) * rate),
    )
    return tuple(one for one in around if one[2] != 0)


def one_of(states: States, i: int) -> States:
    """The state at one of several instants."""
    return States(*(getattr(states, field.name)[i] for field in fields(States)))


def _poses(motion: Motion, instants: tuple[tuple[float, Side, float], ...]) -> Iterator[tuple[Pose, float]]:
    """The rigid motion at instants (time, side, weight), and their weights.

    All at once: of a slip every instant is found from its beginning on.
    """
    for side in get_args(Side):
        those = [instant for instant in instants if instant[1] == side]
        if those:
            times = np.array([t for t, _, _ in those])
            states = without_units(motion.at(times, side), motion.scene)
            for i, (t, _, weight) in enumerate(those):
                yield _pose(one_of(states, i), motion.phase_at(t, side).kind), weight


def equilibrium(hoop: Hoop, pose: Pose, t: float = 0.0, x_C: float = 0.0, near: State | None = None) -> State:
    """The ring and the patch at rest in the disk's frame under the forces of a rigid pose; ``near`` may be one like it.

    Raises
    ------
    MarchError
        No equilibrium was found: the ring is too soft to carry these forces.
    """
    s, c = sin(pose.phi), cos(pose.phi)
    a_x, a_y, angular = pose.accelerations(hoop)
    weight = pose.normal_force / (1 + hoop.scene.hoop.mass_ratio)
    lost = f": no equilibrium of the ring was found under N = {weight:.4g} of the weight of disk and hoop"
    zero = np.zeros(3 + hoop.coordinates)
    mode = hoop.law.start(pose.kind)
    try:
        ring = hoop.resting(pose.omega, angular, a_x * s + a_y * c, a_x * c - a_y * s)
    except np.linalg.LinAlgError:
        raise MarchError(Stop(lost, phi=pose.phi, what="no start")) from None
    if pose.normal_force <= 0:
        window = hoop.window(pose.phi, 0.0, 0.0, 0.1 * hoop.element)
        u = settle_free(ring, window)
        if u is None:
            lost = ": no shape of the ring was found that its own inertia leaves at rest as it flies"
            raise MarchError(Stop(lost, phi=pose.phi, what="no start", by_ring=True))
        # just clear of the floor, and as high over that as the rigid hoop is
        height = pose.height - min(0.0, float(upward(u[:, 0], u[:, 1], s, c).min()))
        pos = np.concatenate([[0.0, height, pose.phi], ring.coordinates])
        nothing = (np.zeros_like(u), NOTHING, no_bristles())
        return in_motion(t, x_C, (pos, zero, zero), mode, Touching(window, u, *nothing), pose.slip_velocity)
    patch = Patch(hoop, pose.phi, pose.normal_force, pose.friction_force)
    if near is not None and near.res.normal > 0:
        patch.start_from(near)
    reached = settle(ring, patch)
    if reached < 1:
        lost += f": from no load on, it is lost at {reached * weight:.3g} of it"
        if reached > 0:  # as much stiffer it bends as it does under that share, but for the foundation's part
            lost += f"; a ring {ceil(100 / reached) / 100:g} times as stiff would carry it"
        raise MarchError(Stop(lost, phi=pose.phi, what="no start", by_ring=reached == 0))
    pos = np.concatenate([[0.0, patch.height, pose.phi], ring.coordinates])
    rim = Touching(patch.window, patch.u, patch.nodal, patch.res, patch.bristles)
    return in_motion(t, x_C, (pos, zero, zero), mode, rim, pose.slip_velocity)


def _unstrained(hoop: Hoop, pose: Pose) -> State:
    """The unstrained ring touching the floor with one point, before its accelerations are known."""
    n = hoop.coordinates
    window = hoop.window(pose.phi, 0.0, 0.0, 0.1 * hoop.element)
    u = np.zeros((2 * window[1] + 1, 2))
    pos, vel = np.zeros(3 + n), np.zeros(3 + n)
    pos[2] = pose.phi
    vel[0], vel[2] = pose.slip_velocity, pose.omega
    # whether it will roll is for the friction to say: no phase is known yet
    kind = Kind.FLIGHT if pose.slip_velocity == 0 else Kind.SKID if pose.slip_velocity > 0 else Kind.SPIN
    mode = hoop.law.start(kind)
    rim = Touching(window, u, np.zeros_like(u), NOTHING, no_bristles())
    return in_motion(0.0, 0.0, (pos, vel, np.zeros(3 + n)), mode, rim, pose.slip_velocity)


def undeformed(hoop: Hoop, pose: Pose) -> State:
    """The unstrained ring touching the floor with one point, moving as the rigid hoop does."""
    state = _unstrained(hoop, pose)
    return restart(hoop, state, state.mode)


def compile_ahead(hoop: Hoop) -> None:
    """Have the steps of a hoop's level compiled, see :func:`flexible.time.adaptive.compile_steps`."""
    compile_steps(hoop, _unstrained(hoop, Pose(pi, 1.0, 0.0, 0.0, 0.0, Kind.ROLL)))


def hand_over(hoop: Hoop, motion: Motion, t: float, there: States | None = None) -> State:
    """The flexible hoop at time ``t`` of a rigid motion, with the rates of the equilibria around it.

    ``there`` is the motion's state at that time, where it is known.
    """
    scene = motion.scene
    now = without_units(motion.at(t) if there is None else there, scene)
    pose = _pose(now, motion.phase_at(t).kind)
    if scene.solve.start == "undeformed" and t == 0:
        return undeformed(hoop, pose)
    state = equilibrium(hoop, pose, float(now.t), float(now.x_C))
    vel = np.zeros_like(state.pos)
    vel[2] = pose.omega
    u_rate = 0.0
    around = _instants_around(motion, t, now) if pose.omega != 0 else ()
    rising = 0.0
    for nearby, weight in _poses(motion, around):
        resting = equilibrium(hoop, nearby, near=state)
        rising += weight * nearby.normal_force
        vel[1] += weight * (resting.pos[1] - nearby.height)
        vel[3:] += weight * resting.pos[3:]
        u_rate += weight * _abscissa(hoop, resting, state)
    vel[1] += rise(motion, t, now)
    law, res, bristles, creep = hoop.law, state.res, state.bristles, 0.0
    if len(bristles.number) and pose.kind == Kind.ROLL:
        bristles, creep = law.rolled_in(bristles, res, Rolling(pose.phi, pose.omega, hoop.relaxation))
    elif len(bristles.number):
        bristles = law.slid_in(bristles, res)
    vel[0] = pose.slip_velocity + creep - u_rate - pose.omega * _lift(hoop, state)
    state = state._replace(
        vel=vel, acc=np.zeros_like(vel), bristles=bristles, slip_velocity=pose.slip_velocity + creep
    )  # fmt: skip
    held = pose.kind == Kind.ROLL and len(bristles.number) > 0 and not is_smoothed(law.parameters)
    grows, springs = 0.0, 1.0
    if hoop.relaxation * abs(rising) > JUMPS * pose.normal_force > 0:  # N = N_el + theta dN_el/dt: N_el goes like N
        grows = rising / pose.normal_force
        springs = 1 / (1 + max(hoop.relaxation * grows, -FALLS))
        res = res._replace(eta=1 / springs)
        state = state._replace(res=res, elastic_rate=(1 - springs) * pose.normal_force / hoop.relaxation)
    if not held and grows == 0:
        return restart(hoop, state, state.mode)
    found = _balanced(hoop, state, pose, creep, held)
    if grows == 0:
        return found
    # a parabolic patch is as deep as N_el^(2/3), and was taken to sink as N does
    share, vel = springs ** (2 / 3), found.vel.copy()
    depth = (state.pos[1] - found.pos[1]) / (share - 1)
    vel[1] -= 2 / 3 * depth * (share * state.elastic_rate / (springs * pose.normal_force) - grows)
    return found._replace(vel=vel)


def _balanced(hoop: Hoop, state: State, pose: Pose, creep: float, held: bool) -> State:
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
