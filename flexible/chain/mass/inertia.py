"""Inertia of the disk and of the ring's sections in the frame that floats on the disk.

The frame and its unknowns are those of :mod:`flexible.ring.frame`. The ring's mass sits at its sections, at their
centres of mass y = Y + u, where it turns as well; that of the weld belongs to the frame, and that of the wall beside it
moves with the first and the last section (:mod:`flexible.chain.mass.beside`).
Per unit mass the force on a section is

    A + alpha J y + 2 omega J u' - omega^2 y + u'',        and the moment alpha + phi'' about its centre,

so that inertia is linear in the sections' rates, however far they turn.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any, NamedTuple

from rigid.kernel.compile import loop

from ...ring.frame import Instant, disk_energies, disk_force, disk_tangent, instant_of
from ..rod.corotated import Rod
from .beside import add_derivatives, add_inertia, moving
from .ends import EndMass


class ChainBody(NamedTuple):
    """What moves with the frame.

    Attributes
    ----------
    offset, disk_inertia : float
        Of the disk's centre from C; about itself (m = 1).
    weld_mass, weld_moment, weld_inertia : float
        Of the ring at the weld and beside it: mass, first moment along y1 and moment of inertia about C, undeformed.
    ring_mass : float
        All of the ring.
    """

    offset: float
    disk_inertia: float
    weld_mass: float
    weld_moment: float
    weld_inertia: float
    ring_mass: float


class Chain(NamedTuple):
    """All that moves: frame and sections."""

    body: ChainBody
    rod: Rod
    ends: EndMass


@loop
def inertia(chain: Any, pose: Any, rates: Any, changes: Any, frame: Any, force: Any) -> None:
    """Add inertial forces and gravity.

    Parameters
    ----------
    chain : Chain
    pose, rates, changes : tuples
        (V, h, phi) and (n + 2, 3) of the sections; their velocities and accelerations.
    frame, force : (3,), (n + 2, 3) arrays
        Generalised forces on the frame, forces and moment on the sections.
    """
    body, rod, ends = chain
    (pos, q), (vel, qv), (acc, qa) = pose, rates, changes
    instant = instant_of(pos, vel, acc, 1.0)
    disk_force(body, instant, frame)
    if body.ring_mass == 0:
        return
    s, c, w, alpha, ax, ay, _, _ = instant
    a1, a2 = ax * s + ay * c, ax * c - ay * s
    f1 = body.weld_mass * a1 - w * w * body.weld_moment
    f2 = body.weld_mass * a2 + alpha * body.weld_moment
    moment = body.weld_moment * a2 + body.weld_inertia * alpha
    more = add_inertia(ends, (a1, a2, alpha), w, (q, qv, qa), force)
    f1, f2, moment = f1 + more[0], f2 + more[1], moment + more[2]
    mass, turning, place = rod.mass, rod.turning, rod.place
    for i in range(1, mass.shape[0] - 1):
        m = mass[i]
        y1, y2 = place[i, 0] + q[i, 0], place[i, 1] + q[i, 1]
        p1 = m * (a1 - alpha * y2 - 2 * w * qv[i, 1] - w * w * y1 + qa[i, 0])
        p2 = m * (a2 + alpha * y1 + 2 * w * qv[i, 0] - w * w * y2 + qa[i, 1])
        p3 = turning[i] * (alpha + qa[i, 2])
        force[i, 0] += p1
        force[i, 1] += p2
        force[i, 2] += p3
        f1 += p1
        f2 += p2
        moment += y1 * p2 - y2 * p1 + p3
    fx = f1 * s + f2 * c
    frame[0] += fx
    frame[1] += f1 * c - f2 * s
    frame[2] += fx + moment


@loop
def inertia_tangent(chain: Any, pose: Any, rates: Any, changes: Any, beta: float, blocks: Any) -> None:
    """Add the derivatives of :func:`inertia` by an increment, see :func:`flexible.ring.frame.inertia`.

    Parameters
    ----------
    chain, pose, rates, changes :
        See :func:`inertia`.
    beta : float
    blocks : Blocks
        Of which diagonal, columns, rows and corner are added to.
    """
    body, rod, ends = chain
    (pos, q), (vel, qv), (acc, qa) = pose, rates, changes
    instant = instant_of(pos, vel, acc, beta)
    disk_tangent(body, instant, blocks.corner)
    if body.ring_mass == 0:
        return
    s, c, w, alpha, ax, ay, r1, r2 = instant
    a1, a2 = ax * s + ay * c, ax * c - ay * s
    a1_phi, a2_phi = a2 + s * r2, -a1 + c * r2
    # force along y1, y2 of the whole ring, and derivatives by phi; then by V and h, with their accelerations alone
    f1 = body.weld_mass * a1 - w * w * body.weld_moment
    f2 = body.weld_mass * a2 + alpha * body.weld_moment
    f1_phi = body.weld_mass * a1_phi - 2 * w * r1 * body.weld_moment
    f2_phi = body.weld_mass * a2_phi + r2 * body.weld_moment
    moment_phi = body.weld_moment * a2_phi + body.weld_inertia * r2
    more = add_derivatives(ends, (a1, a2, alpha, a1_phi, a2_phi), (s, c, w), (r1, r2), (q, qv, qa), blocks)
    f1, f2, f1_phi, f2_phi = f1 + more[0], f2 + more[1], f1_phi + more[2], f2_phi + more[3]
    moment_phi, sum1, sum2 = moment_phi + more[4], body.weld_moment + more[5], more[6]
    own, across = r2 - w * w, alpha + 2 * w * r1
    diagonal, columns, rows = blocks.diagonal, blocks.columns, blocks.rows
    mass, turning, place = rod.mass, rod.turning, rod.place
    for i in range(1, mass.shape[0] - 1):
        m, j = mass[i], turning[i]
        y1, y2 = place[i, 0] + q[i, 0], place[i, 1] + q[i, 1]
        v1, v2 = qv[i, 0], qv[i, 1]
        p1 = m * (a1 - alpha * y2 - 2 * w * v2 - w * w * y1 + qa[i, 0])
        p2 = m * (a2 + alpha * y1 + 2 * w * v1 - w * w * y2 + qa[i, 1])
        p1_phi = m * (a1_phi - r2 * y2 - 2 * r1 * v2 - 2 * w * r1 * y1)
        p2_phi = m * (a2_phi + r2 * y1 + 2 * r1 * v1 - 2 * w * r1 * y2)
        f1 += p1
        f2 += p2
        f1_phi += p1_phi
        f2_phi += p2_phi
        moment_phi += y1 * p2_phi - y2 * p1_phi + j * r2
        sum1 += m * y1
        sum2 += m * y2
        diagonal[i, 0, 0] += m * own
        diagonal[i, 1, 1] += m * own
        diagonal[i, 0, 1] -= m * across
        diagonal[i, 1, 0] += m * across
        diagonal[i, 2, 2] += j * r2
        columns[i, 0, 0] += m * s * r2
        columns[i, 1, 0] += m * c * r2
        columns[i, 0, 1] += m * c * r2
        columns[i, 1, 1] -= m * s * r2
        columns[i, 0, 2] += p1_phi
        columns[i, 1, 2] += p2_phi
        columns[i, 2, 2] += j * r2
        # by u1: (p1, p2) change by m (own, across), by u2: by m (-across, own)
        gx = m * (own * s + across * c)
        rows[i, 0, 0] += gx
        rows[i, 0, 1] += m * (own * c - across * s)
        rows[i, 0, 2] += gx + m * (y1 * across - y2 * own) + p2
        gx = m * (own * c - across * s)
        rows[i, 1, 0] += gx
        rows[i, 1, 1] -= m * (across * c + own * s)
        rows[i, 1, 2] += gx + m * (y1 * own + y2 * across) - p1
        rows[i, 2, 2] += j * r2
    corner = blocks.corner
    for k in range(2):
        b1, b2 = (s * r2, c * r2) if k == 0 else (c * r2, -s * r2)
        gx = body.ring_mass * (b1 * s + b2 * c)
        corner[0, k] += gx
        corner[1, k] += body.ring_mass * (b1 * c - b2 * s)
        corner[2, k] += gx + sum1 * b2 - sum2 * b1
    fx_phi = f1_phi * s + f2_phi * c + f1 * c - f2 * s
    corner[0, 2] += fx_phi
    corner[1, 2] += f1_phi * c - f2_phi * s - f1 * s - f2 * c
    corner[2, 2] += fx_phi + moment_phi


@loop
def energies(chain: Any, pos: Any, q: Any, vel: Any, qv: Any) -> tuple[float, float]:
    """Kinetic energy and gravity (0 with the hoop's centre at the floor)."""
    body, rod, ends = chain
    kinetic, gravity = disk_energies(body, pos, vel)
    if body.ring_mass == 0:
        return kinetic, gravity
    s, c, w = sin(pos[2]), cos(pos[2]), vel[2]
    vx, vy, height = vel[0] + w, vel[1], 1 + pos[1]
    c1, c2 = vx * s + vy * c, vx * c - vy * s
    kinetic += body.weld_mass * (vx * vx + vy * vy) / 2 + body.weld_moment * c2 * w + body.weld_inertia * w * w / 2
    more, sum1, sum2 = moving(ends, c1, c2, w, q, qv)
    kinetic += more
    gravity += body.weld_mass * height + (body.weld_moment + sum1) * c - sum2 * s
    for i in range(1, rod.mass.shape[0] - 1):
        y1, y2 = rod.place[i, 0] + q[i, 0], rod.place[i, 1] + q[i, 1]
        v1, v2 = c1 + qv[i, 0] - w * y2, c2 + qv[i, 1] + w * y1
        spin = w + qv[i, 2]
        kinetic += (rod.mass[i] * (v1 * v1 + v2 * v2) + rod.turning[i] * spin * spin) / 2
        gravity += rod.mass[i] * (height + y1 * c - y2 * s)
    return kinetic, gravity


@loop
def momenta(chain: Any, pos: Any, q: Any, error: Any, qe: Any, frame: Any, force: Any) -> None:
    """Mass matrix times a rate: (3,), (n + 2, 3), filled in; rates of the frame are those of (V, h, phi)."""
    body, rod, ends = chain
    s, c = sin(pos[2]), cos(pos[2])
    ax, ay, alpha = error[0] + error[2], error[1], error[2]
    frame[0], frame[1], frame[2] = 0.0, 0.0, 0.0
    disk_force(body, Instant(s, c, 0.0, alpha, ax, ay, 0.0, 0.0), frame)
    for i in range(force.shape[0]):
        for a in range(3):
            force[i, a] = 0.0
    if body.ring_mass == 0:
        return
    a1, a2 = ax * s + ay * c, ax * c - ay * s
    f1, f2 = body.weld_mass * a1, body.weld_mass * a2 + alpha * body.weld_moment
    moment = body.weld_moment * a2 + body.weld_inertia * alpha
    for i in range(1, rod.mass.shape[0] - 1):
        y1, y2 = rod.place[i, 0] + q[i, 0], rod.place[i, 1] + q[i, 1]
        force[i, 0] = rod.mass[i] * (a1 - alpha * y2 + qe[i, 0])
        force[i, 1] = rod.mass[i] * (a2 + alpha * y1 + qe[i, 1])
        force[i, 2] = rod.turning[i] * (alpha + qe[i, 2])
        f1 += force[i, 0]
        f2 += force[i, 1]
        moment += y1 * force[i, 1] - y2 * force[i, 0] + force[i, 2]
    more = add_inertia(ends, (a1, a2, alpha), 0.0, (q, q, qe), force)
    f1, f2, moment = f1 + more[0], f2 + more[1], moment + more[2]
    frame[0] += f1 * s + f2 * c
    frame[1] += f1 * c - f2 * s
    frame[2] += f1 * s + f2 * c + moment
