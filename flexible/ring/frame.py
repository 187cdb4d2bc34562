"""Inertia of the disk and of the ring's modes in a frame that floats on the disk.

The frame's origin is the hoop's centre C, its first axis points to the disk; a material point of the ring is at
``y = Y + u`` with ``u = sum q_i Phi_i`` zero at the weld. Unknowns are V = x_C - phi, h = y_C - R, phi and the modal
amplitudes q; the forces conjugate to them are the horizontal and vertical force and the moment about the point of
the floor under C, in which nothing cancels. Per unit mass the acceleration in the frame's axes is

    A + alpha J y + 2 omega J ydot - omega^2 y + yddot,     J (y1, y2) = (-y2, y1),

with A the acceleration of C plus gravity: Euler, Coriolis and centrifugal terms are kept (R = m = g = 1).
"""

from __future__ import annotations

from math import cos, sin
from typing import Any, NamedTuple

import numpy as np

from rigid import Scene
from rigid.kernel.compile import apart, loop, part


class Body(NamedTuple):
    """The rigid parts of a hoop."""

    offset: float  # distance of the disk from C
    disk_inertia: float  # the disk's moment about its centre
    ring_mass: float
    ring_inertia: float  # the undeformed ring's moment about C


def body_of(scene: Scene) -> Body:
    """The rigid parts of a scene's hoop."""
    hoop = scene.hoop
    offset = (1 - hoop.k) / hoop.r
    inner = 1 - scene.wall
    mass = float(hoop.mass_ratio)
    return Body(offset, (hoop.k / hoop.r) ** 2 / 2, mass, mass * (1 + inner**2) / 2)


class Frame(NamedTuple):
    """The hoop in its frame: rigid parts and modes."""

    body: Body
    modal: Any  # (n, 5) per mode: squared frequency; participation in translation along y1, y2; rotation; stretching
    gyro: Any  # (n, n) Phi_i^T M J Phi_j, antisymmetric


class Instant(NamedTuple):
    """What all forces of an instant share."""

    s: float  # sin phi
    c: float  # cos phi
    w: float  # phidot
    alpha: float  # phiddot
    ax: float  # acceleration of C plus gravity
    ay: float
    r1: float  # derivatives of a rate and of an acceleration by the increment: 1/beta, 1/beta^2
    r2: float


class _Sums(NamedTuple):
    """The ring's first and second moments about C, and their rates."""

    s1: float  # first moment of the displacement along y1, y2; rates
    s2: float
    s1_v: float
    s2_v: float
    s1_a: float
    s2_a: float
    moment: float  # of inertia
    rate: float  # half of that moment's rate
    spin: float  # of the ring's accelerations about C
    turned: Any  # (n,) gyro times amplitudes, their rates and accelerations
    turned_v: Any
    turned_a: Any


@loop
def instant_of(pos: Any, vel: Any, acc: Any, beta: float) -> Instant:
    """Of a frame, (V, h, phi) and rates first in each array; ``beta`` as :func:`inertia` takes it."""
    return Instant(sin(pos[2]), cos(pos[2]), vel[2], acc[2], acc[0] + acc[2], acc[1] + 1.0, 1 / beta, 1 / beta**2)


@loop
def disk_force(body: Any, instant: Instant, force: Any) -> None:
    """Add inertia and gravity of the disk to the forces on the frame; of ``body`` the disk's place and moment."""
    s, c, w, alpha, ax, ay, _, _ = instant
    dx = ax + body.offset * (alpha * c - w * w * s)
    dy = ay - body.offset * (alpha * s + w * w * c)
    force[0] += dx
    force[1] += dy
    force[2] += dx * (1 + body.offset * c) - dy * body.offset * s + body.disk_inertia * alpha


@loop
def disk_tangent(body: Any, instant: Instant, tangent: Any) -> None:
    """Add the derivatives of :func:`disk_force` by the frame."""
    s, c, w, alpha, ax, ay, r1, r2 = instant
    offset = body.offset
    dx = ax + offset * (alpha * c - w * w * s)
    dy = ay - offset * (alpha * s + w * w * c)
    dx_phi = offset * (-alpha * s - w * w * c - 2 * w * s * r1 + c * r2) + r2
    dy_phi = -offset * (alpha * c - w * w * s + 2 * w * c * r1 + s * r2)
    lever = 1 + offset * c
    tangent[0, 0] += r2
    tangent[0, 2] += dx_phi
    tangent[1, 1] += r2
    tangent[1, 2] += dy_phi
    tangent[2, 0] += lever * r2
    tangent[2, 1] -= offset * s * r2
    tangent[2, 2] += dx_phi * lever - dx * offset * s - dy_phi * offset * s - dy * offset * c + body.disk_inertia * r2


@loop
def disk_energies(body: Any, pos: Any, vel: Any) -> tuple[float, float]:
    """Kinetic energy of the disk, and its gravity (0 with the hoop's centre at the floor)."""
    s, c, w = sin(pos[2]), cos(pos[2]), vel[2]
    dx, dy = vel[0] + w + body.offset * w * c, vel[1] - body.offset * w * s
    return (dx * dx + dy * dy + body.disk_inertia * w * w) / 2, 1 + pos[1] + body.offset * c


@part
def _ring_sums(frame: Frame, pos: Any, vel: Any, acc: Any) -> _Sums:
    n = frame.modal.shape[0]
    turned, turned_v, turned_a = np.zeros(n), np.zeros(n), np.zeros(n)
    s1, s2, s1_v, s2_v, s1_a, s2_a, moment, rate, spin = _add_up(frame, pos, vel, acc, (turned, turned_v, turned_a))
    return _Sums(s1, s2, s1_v, s2_v, s1_a, s2_a, moment, rate, spin, turned, turned_v, turned_a)


@loop
def _add_up(frame: Frame, pos: Any, vel: Any, acc: Any, to: Any) -> Any:
    modal, gyro = frame.modal, frame.gyro
    turned, turned_v, turned_a = to
    s1, s2, s1_v, s2_v, s1_a, s2_a = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    moment, rate, spin = frame.body.ring_inertia, 0.0, 0.0
    for i in range(turned.shape[0]):
        q, qv, qa = pos[3 + i], vel[3 + i], acc[3 + i]
        s1 += modal[i, 1] * q
        s2 += modal[i, 2] * q
        s1_v += modal[i, 1] * qv
        s2_v += modal[i, 2] * qv
        s1_a += modal[i, 1] * qa
        s2_a += modal[i, 2] * qa
        moment += (2 * modal[i, 4] + q) * q
        rate += (modal[i, 4] + q) * qv
        spin += modal[i, 3] * qa
        for j in range(turned.shape[0]):
            turned[i] += gyro[i, j] * pos[3 + j]
            turned_v[i] += gyro[i, j] * vel[3 + j]
            turned_a[i] += gyro[i, j] * acc[3 + j]
        spin += qa * turned[i]
    return s1, s2, s1_v, s2_v, s1_a, s2_a, moment, rate, spin


@loop
def _ring_by_pose(frame: Frame, instant: Instant, sums: _Sums, force: Any, tangent: Any) -> None:
    """What the ring adds to the forces on (V, h, phi), and the tangent of these and of the modes' by them."""
    s, c, w, alpha, ax, ay, r1, r2 = instant
    s1, s2, s1_v, s2_v = sums.s1, sums.s2, sums.s1_v, sums.s2_v
    modal, ring_mass = frame.modal, frame.body.ring_mass
    a1, a2 = ax * s + ay * c, ax * c - ay * s
    f1 = ring_mass * a1 - alpha * s2 - 2 * w * s2_v - w * w * s1 + sums.s1_a
    f2 = ring_mass * a2 + alpha * s1 + 2 * w * s1_v - w * w * s2 + sums.s2_a
    fx, fy = f1 * s + f2 * c, f1 * c - f2 * s
    force[0] += fx
    force[1] += fy
    force[2] += fx - s2 * a1 + s1 * a2 + alpha * sums.moment + 2 * w * sums.rate + sums.spin
    # by V, h (through the acceleration of C) and by phi
    for i in range(2):
        a1_i, a2_i = (s, c) if i == 0 else (c, -s)
        a1_i, a2_i = a1_i * r2, a2_i * r2
        tangent[0, i] += ring_mass * (a1_i * s + a2_i * c)
        tangent[1, i] += ring_mass * (a1_i * c - a2_i * s)
        tangent[2, i] += ring_mass * (a1_i * s + a2_i * c) - s2 * a1_i + s1 * a2_i
        for j in range(modal.shape[0]):
            tangent[3 + j, i] += modal[j, 1] * a1_i + modal[j, 2] * a2_i
    a1_phi, a2_phi = a2 + s * r2, -a1 + c * r2
    f1_phi = ring_mass * a1_phi - s2 * r2 - 2 * s2_v * r1 - 2 * w * s1 * r1
    f2_phi = ring_mass * a2_phi + s1 * r2 + 2 * s1_v * r1 - 2 * w * s2 * r1
    fx_phi, fy_phi = f1_phi * s + f2_phi * c + fy, f1_phi * c - f2_phi * s - fx
    tangent[0, 2] += fx_phi
    tangent[1, 2] += fy_phi
    tangent[2, 2] += fx_phi - s2 * a1_phi + s1 * a2_phi + sums.moment * r2 + 2 * sums.rate * r1


@loop
def _ring_by_modes(
    frame: Frame, instant: Instant, sums: _Sums, pos: Any, vel: Any, acc: Any, force: Any, tangent: Any
) -> None:
    """Forces on the modes, and the tangent of all forces by the modes and of theirs by phi."""
    s, c, w, alpha, ax, ay, r1, r2 = instant
    a1, a2 = ax * s + ay * c, ax * c - ay * s
    a1_phi, a2_phi = a2 + s * r2, -a1 + c * r2
    gyro, n = frame.gyro, frame.modal.shape[0]
    for i in range(n):
        square, l1, l2 = frame.modal[i, 0], frame.modal[i, 1], frame.modal[i, 2]
        rotation, stretching = frame.modal[i, 3], frame.modal[i, 4]
        q, qv, qa = pos[3 + i], vel[3 + i], acc[3 + i]
        turned = rotation + sums.turned[i]
        force[3 + i] = (
            qa + square * q + a1 * l1 + a2 * l2 + alpha * turned + 2 * w * sums.turned_v[i] - w * w * (stretching + q)
        )
        tangent[3 + i, 2] = (
            a1_phi * l1 + a2_phi * l2 + turned * r2 + 2 * sums.turned_v[i] * r1 - 2 * w * (stretching + q) * r1
        )
        f1_q = -alpha * l2 - 2 * w * l2 * r1 - w * w * l1 + l1 * r2
        f2_q = alpha * l1 + 2 * w * l1 * r1 - w * w * l2 + l2 * r2
        tangent[0, 3 + i] = f1_q * s + f2_q * c
        tangent[1, 3 + i] = f1_q * c - f2_q * s
        tangent[2, 3 + i] = (
            tangent[0, 3 + i]
            - l2 * a1
            + l1 * a2
            + alpha * 2 * (stretching + q)
            + 2 * w * (qv + (stretching + q) * r1)
            + turned * r2
            - sums.turned_a[i]
        )
        for j in range(n):
            tangent[3 + i, 3 + j] = gyro[i, j] * (alpha + 2 * w * r1)
        tangent[3 + i, 3 + i] += r2 + square - w * w


def example() -> tuple[tuple[Any, ...], Any]:
    """Arguments and a result, of the types that compiled code has."""
    row, table = np.empty(0), np.empty((0, 0))
    return (Frame(Body(0.0, 0.0, 0.0, 0.0), table, table), row, row, row, 0.0), (row, table)


@apart(example)
def inertia(frame: Frame, pos: Any, vel: Any, acc: Any, beta: float) -> Any:
    """Inertial, gravitational and elastic forces, and their tangent.

    Parameters
    ----------
    frame : Frame
    pos, vel, acc : (3 + n,) arrays
        (V, h, phi, q) and rates.
    beta : float
        The step's: position changes by d come with velocity changes d/beta and acceleration changes d/beta^2.

    Returns
    -------
    force : (3 + n,) array
    tangent : (3 + n, 3 + n) array
        Derivative of ``force`` by d.
    """
    n = frame.modal.shape[0]
    force, tangent = np.zeros(3 + n), np.zeros((3 + n, 3 + n))
    instant = instant_of(pos, vel, acc, beta)
    disk_force(frame.body, instant, force)
    disk_tangent(frame.body, instant, tangent)
    if frame.body.ring_mass > 0:
        sums = _ring_sums(frame, pos, vel, acc)
        _ring_by_pose(frame, instant, sums, force, tangent)
        _ring_by_modes(frame, instant, sums, pos, vel, acc, force, tangent)
    return force, tangent


@loop
def energies(frame: Frame, pos: Any, vel: Any) -> tuple[float, float, float]:
    """Kinetic energy, gravity (0 with the hoop's centre at the floor) and strain energy of the modes."""
    body, modal, gyro = frame.body, frame.modal, frame.gyro
    n = modal.shape[0]
    kinetic, gravity = disk_energies(body, pos, vel)
    strain = 0.0
    if body.ring_mass > 0:
        s, c, w = sin(pos[2]), cos(pos[2]), vel[2]
        vx, vy = vel[0] + w, vel[1]
        v1, v2 = vx * s + vy * c, vx * c - vy * s
        s1, s2, s1_v, s2_v = 0.0, 0.0, 0.0, 0.0
        moment, spin, own = body.ring_inertia, 0.0, 0.0
        for i in range(n):
            q, qv = pos[3 + i], vel[3 + i]
            s1 += modal[i, 1] * q
            s2 += modal[i, 2] * q
            s1_v += modal[i, 1] * qv
            s2_v += modal[i, 2] * qv
            moment += (2 * modal[i, 4] + q) * q
            turned = 0.0
            for j in range(n):
                turned += gyro[i, j] * pos[3 + j]
            spin += qv * (modal[i, 3] + turned)
            own += qv * qv
            strain += modal[i, 0] * q * q / 2
        kinetic += body.ring_mass * (vx * vx + vy * vy) / 2
        kinetic += v1 * (s1_v - w * s2) + v2 * (s2_v + w * s1)
        kinetic += (moment * w * w + own) / 2 + w * spin
        gravity += body.ring_mass * (1 + pos[1]) + s1 * c - s2 * s
    return kinetic, gravity, strain
