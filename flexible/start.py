"""Where a flexible stretch begins: in the quasi-static elastic equilibrium of the rigid motion at that instant.

A hoop handed over undeformed would ring. Under the rigid hoop's N, F and accelerations the ring and the patch are
brought to rest in the disk's frame, and their rates are those of the equilibria along the rigid motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from rigid import Kind, Motion

from .contact import (
    BRUSH,
    EPS_T,
    FRICTION,
    HIGH,
    LOW,
    MU,
    NORMAL,
    RESULTANTS,
    SLIDE_RIGHT,
    SPACING,
    STICK,
    UNDAMPED,
    contact_forces,
)
from .frame import OFFSET
from .march import State, restart
from .reduced import ReducedHoop

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Pose:
    """An instant of the rigid motion in the units of the flexible solver (R = m = g = 1)."""

    phi: float
    omega: float
    slip_velocity: float
    normal_force: float
    friction_force: float
    rolls: bool

    def accelerations(self, hoop: ReducedHoop) -> tuple[float, float]:
        """Horizontal acceleration of C and angular acceleration, from the balance of the rigid hoop."""
        rigid = hoop.scene.hoop
        mass = 1 + rigid.mass_ratio
        s, c = sin(self.phi), cos(self.phi)
        angular = (self.normal_force * rigid.e * s - self.friction_force * (1 + rigid.e * c)) / (rigid.K * mass)
        return self.friction_force / mass - rigid.e * (angular * c - self.omega**2 * s), angular


def pose_at(motion: Motion, t: float) -> Pose:
    """The rigid motion at time ``t``, without its units."""
    scene = motion.scene
    now = motion.at(t)
    kind = next((p.kind for p in motion.phases if p.t_start <= t <= p.t_end), Kind.ROLL)
    return Pose(
        float(now.phi),
        float(now.omega) * scene.time_unit,
        float(now.slip_velocity) / scene.velocity_unit,
        float(now.normal_force) / scene.force_unit,
        float(now.friction_force) / scene.force_unit,
        kind == Kind.ROLL,
    )


def equilibrium(hoop: ReducedHoop, pose: Pose, t: float = 0.0, x_C: float = 0.0) -> State:
    """The ring and the patch at rest in the disk's frame under the forces of a rigid pose."""
    ring = hoop.ring
    n = len(ring.modal)
    s, c = sin(pose.phi), cos(pose.phi)
    a_x, angular = pose.accelerations(hoop)
    square, l1, l2, rotation, stretching = ring.modal.T
    rest = (a_x * s + c) * l1 + (a_x * c - s) * l2 + angular * rotation - pose.omega**2 * stretching
    dynamic = np.diag(square - pose.omega**2) + angular * ring.gyro
    empty, flags = np.empty((0, 2)), np.empty(0, np.int8)
    normal = pose.normal_force
    if normal <= 0:
        q = np.linalg.solve(dynamic, -rest)
        window = hoop.window(pose.phi, 0.0, 0.0, 0.1 * hoop.element)
        u = (hoop._arrays(window)[0] @ q).reshape(-1, 2)
        # just clear of the floor
        height = -min(0.0, float((u[:, 0] * c - u[:, 1] * s).min()))
        pos = np.concatenate([[0.0, height, pose.phi], q])
        zero = np.zeros(3 + n)
        nothing = (np.zeros_like(u), np.zeros(RESULTANTS))
        return State(t, x_C, pos, zero, zero, STICK, window, u, *nothing, empty, flags, pose.slip_velocity)
    law = hoop.law.copy()
    law[MU] = pose.friction_force / normal  # shares any F over the patch like the pressure
    half = (1.5 * normal / law[1]) ** (1 / 3)
    q, height = np.zeros(n), -(half**2) / 2
    u = np.zeros((0, 2))
    for _ in range(60):
        window = hoop.window(pose.phi, -half, half, half + 0.2 * hoop.element)
        shapes, compliance = hoop._arrays(window)
        if len(u) != 2 * window[1] + 1:
            u = np.zeros((2 * window[1] + 1, 2))
        old = np.array([0.0, height, pose.phi])
        force, nodal, tangent, res, bristles, new_flags = contact_forces(
            old, u, window[0], ring.vertex, law, SLIDE_RIGHT, old, u, empty, flags, UNDAMPED
        )
        flat = nodal.ravel()
        residual = np.concatenate(
            [[res[NORMAL] - normal], dynamic @ q + rest - shapes.T @ flat, u.ravel() - shapes @ q - compliance @ flat]
        )
        scale = 1 + abs(tangent[1, 1])
        error = max(
            abs(residual[0]), np.abs(residual[1 : n + 1]).max(initial=0.0), scale * np.abs(residual[n + 1 :]).max()
        )
        if error < 1e-10 * (1 + normal) + 1e-15 * scale * abs(height):
            break
        if res[NORMAL] == 0:
            height -= half**2 / 2 + float(np.maximum(height + u[:, 0] * c - u[:, 1] * s, 0).min())
            continue
        t_uu, t_uh = tangent[3:, 3:], tangent[3:, 1]
        matrix = np.block(
            [
                [tangent[1:2, 1:2], np.zeros((1, n)), tangent[1:2, 3:]],
                [-(shapes.T @ t_uh)[:, None], dynamic, -shapes.T @ t_uu],
                [-(compliance @ t_uh)[:, None], -shapes, np.eye(len(flat)) - compliance @ t_uu],
            ]
        )
        update = np.linalg.solve(matrix, residual)
        height -= update[0]
        q = q - update[1 : n + 1]
        u = u - update[n + 1 :].reshape(-1, 2)
    pos = np.concatenate([[0.0, height, pose.phi], q])
    zero = np.zeros(3 + n)
    return State(t, x_C, pos, zero, zero, STICK, window, u, nodal, res, bristles, new_flags, pose.slip_velocity)


def undeformed(hoop: ReducedHoop, pose: Pose, mode: int) -> State:
    """The unstrained ring touching the floor with one point, moving as the rigid hoop does."""
    n = hoop.coordinates
    window = hoop.window(pose.phi, 0.0, 0.0, 0.1 * hoop.element)
    u = np.zeros((2 * window[1] + 1, 2))
    pos, vel = np.zeros(3 + n), np.zeros(3 + n)
    pos[2] = pose.phi
    vel[0], vel[2] = pose.slip_velocity, pose.omega
    empty, flags = np.empty((0, 2)), np.empty(0, np.int8)
    state = State(
        0.0, 0.0, pos, vel, np.zeros(3 + n), mode, window, u, np.zeros_like(u), np.zeros(RESULTANTS), empty, flags,
        pose.slip_velocity,
    )  # fmt: skip
    return restart(hoop, state, mode)


def hand_over(hoop: ReducedHoop, motion: Motion, t: float, law: str) -> State:
    """The flexible hoop at time ``t`` of a rigid motion, with the rates of the equilibria around it."""
    scene = motion.scene
    pose = pose_at(motion, t)
    now = motion.at(t)
    if scene.solve.start == "undeformed" and t == 0:
        slides = BRUSH if law == "brush" else STICK if pose.slip_velocity == 0 else -int(np.sign(pose.slip_velocity))
        return undeformed(hoop, pose, slides)
    state = equilibrium(hoop, pose, t / scene.time_unit, float(now.x_C) / scene.hoop.R)
    vel = np.zeros_like(state.pos)
    vel[2] = pose.omega
    u_rate = 0.0
    span = 1e-4 * scene.time_unit
    before, after = max(t - span, 0.0), min(t + span, motion.t_end)
    elapsed = (after - before) / scene.time_unit
    if pose.omega != 0 and elapsed > 0:
        early, late = (equilibrium(hoop, pose_at(motion, moment)) for moment in (before, after))
        vel[1] = (late.pos[1] - early.pos[1]) / elapsed
        vel[3:] = (late.pos[3:] - early.pos[3:]) / elapsed
        u_rate = (_abscissa(hoop, late, state) - _abscissa(hoop, early, state)) / elapsed
    rolls = pose.rolls
    res = state.res
    normal, friction = res[NORMAL], res[FRICTION]
    bristles = state.bristles
    creep = 0.0
    mode = BRUSH if law == "brush" else (STICK if rolls else int(np.sign(friction)) or STICK)
    if rolls and len(bristles):
        length = res[HIGH] - res[LOW] + hoop.law[SPACING]
        psi = pose.phi - pi + bristles[:, 0] * hoop.law[SPACING]
        eps_t = hoop.law[EPS_T]
        bristles = bristles.copy()
        if pose.omega == 0:
            bristles[:, 1] = -friction / (eps_t * length)
        else:  # steady rolling: stretched in proportion to the way from the leading edge
            way = psi - res[LOW] if pose.omega > 0 else res[HIGH] - psi
            bristles[:, 1] = -friction * way / (eps_t * length**2 / 2)
            creep = -friction * abs(pose.omega) / (eps_t * length**2 / 2)
    vel[0] = pose.slip_velocity + creep - u_rate
    del normal
    flags = np.zeros(len(bristles), np.int8)
    if law == "brush" and not rolls:
        flags[:] = 1 if friction > 0 else -1
    state = State(
        state.t, state.x_C, state.pos, vel, np.zeros_like(vel), mode, state.window, state.u, state.nodal, res,
        bristles, flags, pose.slip_velocity + creep,
    )  # fmt: skip
    return restart(hoop, state, mode)


def _abscissa(hoop: ReducedHoop, state: State, reference: State) -> float:
    """Mean u_X at ``state`` of the rim nodes under load at ``reference``, weighted by that load."""
    u = hoop.displacement(state, reference.window)
    s, c = sin(reference.pos[2]), cos(reference.pos[2])
    s_now, c_now = sin(state.pos[2]), cos(state.pos[2])
    load = reference.nodal[:, 0] * c - reference.nodal[:, 1] * s
    total = load.sum()
    if total == 0:
        return 0.0
    return float(load @ (u[:, 0] * s_now + u[:, 1] * c_now) / total)


__all__ = ["OFFSET", "Pose", "equilibrium", "hand_over", "pose_at"]
