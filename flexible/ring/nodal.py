"""Inertia and elasticity of the free nodes of the ring in the frame that floats on the disk.

The frame is that of :mod:`flexible.ring.frame`, with the nodal displacement u itself in the place of modal amplitudes
and the consistent mass M in the place of the identity:

    M u'' + K u + a1 M e1 + a2 M e2 + alpha M J (Y + u) + 2 omega M J u' - omega^2 M (Y + u) = contact,

a = A in the disk's axes. M acts alike on both components, so that M J = J M. A massless ring is in static
equilibrium at every stage: the same equations with M = 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from rigid import Scene

from .fem import Ring, membrane_stiffness
from .frame import body_of, disk_force, disk_tangent, instant_of

Array = NDArray[np.float64]


def factored(matrix: sp.csc_matrix, **options: Any) -> Callable[[Array], Array]:
    """What solves with a sparse matrix.

    Raises
    ------
    LinAlgError
        As any other solver does: the matrix is singular.
    """
    try:
        return cast("Callable[[Array], Array]", splu(matrix, **options).solve)
    except RuntimeError as error:
        raise np.linalg.LinAlgError(str(error)) from None


class NodalRing:
    """Inertia and elasticity of the free nodes of a scene's ring, R = m = g = 1.

    Attributes
    ----------
    ring : Ring
    stiffness : float
        E b.
    body : Body
    mass : (n, n) sparse
        Consistent mass of the free dofs.
    along : (2, n) array
        Participation in translation along y1 and y2.
    rotation, stretching : (n,) arrays
        Participation in rotation and in uniform stretching.
    vertex : (n_elements,) array
        Angles at which rim elements begin.
    """

    def __init__(self, scene: Scene, ring: Ring) -> None:
        self.ring = ring
        self.stiffness = membrane_stiffness(scene)
        self.body = body_of(scene)
        ratio = scene.hoop.mass_ratio
        self.massless = ratio == 0
        self.mass: sp.csc_matrix = (ring.free_mass * ratio).tocsc()
        # rows of the whole mass: the welded nodes move with the frame
        rows = ring.mass[ring.free] * ratio
        self.along = np.stack([rows @ ring.translation(0), rows @ ring.translation(1)])
        self.rotation = rows @ ring.turned(ring.position_field)
        self.stretching = rows @ ring.position_field
        n = len(ring.free)
        even = np.arange(0, n, 2)
        turn = sp.csc_matrix((np.r_[-np.ones(n // 2), np.ones(n // 2)], (np.r_[even, even + 1], np.r_[even + 1, even])))
        self.gyro: sp.csc_matrix = (self.mass @ turn).tocsc()
        self.vertex = np.ascontiguousarray(ring.mesh.rim_theta[::2])
        self._linear: sp.csc_matrix = (ring.free_stiffness * self.stiffness).tocsc()
        self._sizes = abs(self._linear)

    @property
    def size(self) -> int:
        """Number of free dofs."""
        return len(self.ring.free)

    def dofs(self, first: int, count: int) -> NDArray[np.int64]:
        """Free dofs of the nodes of rim elements ``first`` to ``first + count - 1``, node by node."""
        nodes = np.arange(2 * first, 2 * (first + count) + 1) % (2 * len(self.vertex))
        return self.ring.rim_dofs.reshape(-1, 2)[nodes].ravel()

    def elastic(self, u: Array) -> Array:
        """Elastic forces of a displacement of the free dofs."""
        return self._linear @ u

    def tangent(self, u: Array) -> sp.csc_matrix:
        """Derivative of ``elastic``."""
        return self._linear

    def strain_energy(self, u: Array) -> float:
        """Of a displacement (n,) of the free dofs, in m g R."""
        return float(u @ (self._linear @ u)) / 2

    def round_off(self, u: Array) -> float:
        """Size of the rounding errors in ``elastic``."""
        return 4e-16 * float((self._sizes @ abs(u)).max())


def turned(field: Array) -> Array:
    """J times a vector of free dofs: (y1, y2) -> (-y2, y1)."""
    pairs = field.reshape(-1, 2)
    return np.column_stack([-pairs[:, 1], pairs[:, 0]]).ravel()


@dataclass(frozen=True, slots=True, eq=False)
class Inertia:
    """Forces without the contact's, and their derivatives by an increment (see :func:`flexible.ring.frame.inertia`)."""

    frame: Array  # (3,)
    ring: Array  # (n,)
    frame_by_frame: Array  # (3, 3)
    frame_by_ring: Array  # (3, n)
    ring_by_frame: Array  # (n, 3)


def inertia(ring: NodalRing, pos: Array, vel: Array, acc: Array, beta: float) -> Inertia:
    """Inertial, gravitational and elastic forces of frame and ring; see :func:`flexible.ring.frame.inertia`."""
    body = ring.body
    mass, u = body.ring_mass, pos[3:]
    instant = instant_of(pos, vel, acc, beta)
    s, c, w, alpha, ax, ay, r1, r2 = instant
    frame, by_frame = np.zeros(3), np.zeros((3, 3))
    disk_force(body, instant, frame)
    disk_tangent(body, instant, by_frame)
    by_ring, of_frame = np.zeros((3, len(u))), np.zeros((len(u), 3))
    forces = ring.elastic(u)
    if ring.massless:
        return Inertia(frame, forces, by_frame, by_ring, of_frame)

    v, a = vel[3:], acc[3:]
    l1, l2 = ring.along
    m_u, m_v, m_a = (ring.mass @ np.column_stack([u, v, a])).T
    turn_u, turn_v, turn_a = turned(m_u), turned(m_v), turned(m_a)
    spread, spun = ring.stretching + m_u, ring.rotation + turn_u
    a1, a2 = ax * s + ay * c, ax * c - ay * s
    (s1, s1_v, s1_a), (s2, s2_v, s2_a) = ((l @ u, l @ v, l @ a) for l in (l1, l2))
    moment = body.ring_inertia + (ring.stretching + spread) @ u
    rate = spread @ v
    f1 = mass * a1 - alpha * s2 - 2 * w * s2_v - w * w * s1 + s1_a
    f2 = mass * a2 + alpha * s1 + 2 * w * s1_v - w * w * s2 + s2_a
    fx, fy = f1 * s + f2 * c, f1 * c - f2 * s
    frame += [fx, fy, fx - s2 * a1 + s1 * a2 + alpha * moment + 2 * w * rate + spun @ a]
    for i, (b1, b2) in enumerate(((s * r2, c * r2), (c * r2, -s * r2))):
        gx = mass * (b1 * s + b2 * c)
        by_frame[:, i] += [gx, mass * (b1 * c - b2 * s), gx - s2 * b1 + s1 * b2]
        of_frame[:, i] = b1 * l1 + b2 * l2
    a1_phi, a2_phi = a2 + s * r2, -a1 + c * r2
    f1_phi = mass * a1_phi - s2 * r2 - 2 * s2_v * r1 - 2 * w * s1 * r1
    f2_phi = mass * a2_phi + s1 * r2 + 2 * s1_v * r1 - 2 * w * s2 * r1
    fx_phi, fy_phi = f1_phi * s + f2_phi * c + fy, f1_phi * c - f2_phi * s - fx
    by_frame[:, 2] += [fx_phi, fy_phi, fx_phi - s2 * a1_phi + s1 * a2_phi + moment * r2 + 2 * rate * r1]
    of_frame[:, 2] = a1_phi * l1 + a2_phi * l2 + spun * r2 + 2 * turn_v * r1 - 2 * w * spread * r1
    forces = forces + m_a + a1 * l1 + a2 * l2 + alpha * spun + 2 * w * turn_v - w * w * spread
    f1_u = (r2 - w * w) * l1 - (alpha + 2 * w * r1) * l2
    f2_u = (r2 - w * w) * l2 + (alpha + 2 * w * r1) * l1
    by_ring[0], by_ring[1] = f1_u * s + f2_u * c, f1_u * c - f2_u * s
    by_ring[2] = by_ring[0] - l2 * a1 + l1 * a2 + 2 * alpha * spread + 2 * w * (m_v + spread * r1) + spun * r2 - turn_a
    return Inertia(frame, forces, by_frame, by_ring, of_frame)
