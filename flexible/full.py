"""The hoop with every node of its ring free: the reference for the reduced one.

The frame is that of :mod:`flexible.frame`, with the nodal displacement u itself in the place of modal amplitudes and
the consistent mass M in the place of the identity:

    M u'' + K u + a1 M e1 + a2 M e2 + alpha M J (Y + u) + 2 omega M J u' - omega^2 M (Y + u) = contact,

a = A in the disk's axes. M acts alike on both components, so that M J = J M. A massless ring is in static
equilibrium at every stage: the same equations with M = 0.

Newton's matrix is the ring's sparse one, which two stages share, bordered by the frame and by the contact: both
borders are exact in every iteration, so that the ring's may lag behind.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from rigid import Scene

from .contact import ELASTIC, EPS_N, EPS_T, HIGH, LENGTH, LOW, NORMAL, OUTSIDE, SLIP, contact_forces
from .frame import DISK_INERTIA, OFFSET, RING_INERTIA, RING_MASS
from .march import State
from .reduction import body_constants
from .rest import RestingNodes
from .ring import Ring, membrane_stiffness, ring_of
from .touch import POINTS, RimContact

Array = NDArray[np.float64]
Window = tuple[int, int]

_LARGEST_LAG = 1e-3  # of beta times the change of omega since the ring's matrix was factored


class NodalRing:
    """Inertia and elasticity of the free nodes of a scene's ring, R = m = g = 1.

    Attributes
    ----------
    ring : Ring
    stiffness : float
        E b.
    body : (4,) array
        See :mod:`flexible.frame`.
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
        self.body = body_constants(scene)
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
        return float(u @ (self._linear @ u)) / 2

    def round_off(self, u: Array) -> float:
        """Size of the rounding errors in ``elastic``."""
        return 4e-16 * float((abs(self._linear) @ abs(u)).max())


def turned(field: Array) -> Array:
    """J times a vector of free dofs: (y1, y2) -> (-y2, y1)."""
    pairs = field.reshape(-1, 2)
    return np.column_stack([-pairs[:, 1], pairs[:, 0]]).ravel()


@dataclass(frozen=True, slots=True, eq=False)
class Inertia:
    """Forces without the contact's, and their derivatives by an increment (see :func:`flexible.frame.inertia`)."""

    frame: Array  # (3,)
    ring: Array  # (n,)
    frame_by_frame: Array  # (3, 3)
    frame_by_ring: Array  # (3, n)
    ring_by_frame: Array  # (n, 3)


def inertia(ring: NodalRing, pos: Array, vel: Array, acc: Array, beta: float) -> Inertia:
    """Inertial, gravitational and elastic forces of frame and ring; the equations of :func:`flexible.frame.inertia`."""
    body = ring.body
    offset, mass = body[OFFSET], body[RING_MASS]
    s, c = sin(pos[2]), cos(pos[2])
    w, alpha = vel[2], acc[2]
    ax, ay = acc[0] + alpha, acc[1] + 1.0
    r1, r2 = 1 / beta, 1 / beta**2
    u = pos[3:]
    dx = ax + offset * (alpha * c - w * w * s)
    dy = ay - offset * (alpha * s + w * w * c)
    dx_phi = offset * (-alpha * s - w * w * c - 2 * w * s * r1 + c * r2) + r2
    dy_phi = -offset * (alpha * c - w * w * s + 2 * w * c * r1 + s * r2)
    lever = 1 + offset * c
    frame = np.array([dx, dy, dx * lever - dy * offset * s + body[DISK_INERTIA] * alpha])
    by_frame = np.zeros((3, 3))
    by_frame[0, 0] = by_frame[1, 1] = r2
    by_frame[0, 2], by_frame[1, 2] = dx_phi, dy_phi
    by_frame[2, 0], by_frame[2, 1] = lever * r2, -offset * s * r2
    by_frame[2, 2] = dx_phi * lever - (dx + dy_phi) * offset * s - dy * offset * c + body[DISK_INERTIA] * r2
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
    moment = body[RING_INERTIA] + (ring.stretching + spread) @ u
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


class _Factored:
    """The ring's own part of Newton's matrix, factored, and its inverse on the columns of rim windows."""

    def __init__(self, ring: NodalRing, u: Array, w: float, alpha: float, beta: float) -> None:
        matrix = ring.tangent(u)
        if not ring.massless:
            matrix = matrix + ring.mass * (1 / beta**2 - w * w) + ring.gyro * (alpha + 2 * w / beta)
        options = {"SymmetricMode": True}
        self.solve = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options).solve
        self.ring, self.w, self.beta = ring, w, beta
        self._columns: dict[Window, Array] = {}

    def serves(self, w: float, beta: float) -> bool:
        """Whether it still is a good matrix."""
        return self.ring.massless or (beta == self.beta and abs(w - self.w) * beta < _LARGEST_LAG)

    def columns(self, window: Window) -> Array:
        """The inverse's columns for the window's dofs, (n, 2 nodes)."""
        if window not in self._columns:
            dofs = self.ring.dofs(*window)
            unit = np.zeros((self.ring.size, len(dofs)))
            unit[dofs, np.arange(len(dofs))] = 1.0
            self._columns[window] = self.solve(unit)
        return self._columns[window]


@dataclass(frozen=True, slots=True, eq=False)
class NewtonMatrix:
    """Newton's matrix at a solution: the ring's part, the frame's border, the contact's tangent on the window."""

    factored: _Factored
    inertia: Inertia
    contact: Array
    window: Window

    def solve(self, frame: Array, ring: Array) -> tuple[Array, Array]:
        """Increments of frame and ring for a right-hand side."""
        dofs = self.factored.ring.dofs(*self.window)
        t = self.contact
        ring_by_frame = self.inertia.ring_by_frame.copy()
        ring_by_frame[dofs] -= t[3:, :3]
        frame_by_ring = self.inertia.frame_by_ring.copy()
        frame_by_ring[:, dofs] -= t[:3, 3:]
        z = self.factored.solve(np.column_stack([ring, ring_by_frame]))
        base, by_frame = z[:, 0], z[:, 1:]
        # du = base - by_frame dx + columns t_uu w, with w = du on the window
        by_window = self.factored.columns(self.window) @ t[3:, 3:]
        n = len(dofs)
        small = np.empty((3 + n, 3 + n))
        small[:3, :3] = self.inertia.frame_by_frame - t[:3, :3] - frame_by_ring @ by_frame
        small[:3, 3:] = frame_by_ring @ by_window
        small[3:, :3] = by_frame[dofs]
        small[3:, 3:] = np.eye(n) - by_window[dofs]
        known = np.concatenate([frame - frame_by_ring @ base, base[dofs]])
        x = np.linalg.solve(small, known)
        return x[:3], base - by_frame @ x[:3] + by_window @ x[3:]


class FullHoop(RimContact):
    """Frame and all free nodes of a scene's ring; see :class:`flexible.march.Model`.

    ``State.pos`` is (V, h, phi, u) with u the displacement of the free dofs in the order of ``Ring.free``.

    Parameters
    ----------
    points, tolerance :
        See :class:`flexible.touch.RimContact`.
    through : int
        Elements through the wall.
    """

    def __init__(self, scene: Scene, points: int = POINTS, tolerance: float = 1e-9, through: int = 1) -> None:
        self.ring = self._make_ring(scene, ring_of(scene, through))
        super().__init__(scene, self.ring.vertex, points, tolerance)
        self._factored: _Factored | None = None

    def _make_ring(self, scene: Scene, ring: Ring) -> NodalRing:
        return NodalRing(scene, ring)

    @property
    def coordinates(self) -> int:
        """Number of coordinates of the ring in ``State.pos``."""
        return self.ring.size

    def resting(self, omega: float, alpha: float, a1: float, a2: float) -> RestingNodes:
        """The ring at rest in a frame with these rates and this acceleration of C, gravity included."""
        ring = self.ring
        load = a1 * ring.along[0] + a2 * ring.along[1] + alpha * ring.rotation - omega**2 * ring.stretching
        return RestingNodes(ring, ring.gyro * alpha - ring.mass * omega**2, load)

    def nodes(self, state: State) -> Array:
        """Displacement (y1, y2) of every node of the mesh, (n_nodes, 2)."""
        return self.ring.ring.expand(state.pos[3:])

    def displacement(self, state: State, window: Window) -> Array:
        """Displacement of the rim nodes of a window."""
        return state.pos[3:][self.ring.dofs(*window)].reshape(-1, 2)

    def stage(
        self,
        old: State,
        mode: int,
        damper: Array,
        pos_pred: Array,
        vel_pred: Array,
        beta: float,
        guess: Array,
        near: tuple[Window, Array] | None = None,
    ) -> Any:
        """See :class:`flexible.march.Model`."""
        if self.ring.massless:  # no inertia to go by: from where the ring was
            guess = guess.copy()
            guess[3:] = old.pos[3:] - pos_pred[3:]
        low, high = old.res[LOW], old.res[HIGH]
        margin = 0.3 * (high - low) + 0.1 * self.element
        for _ in range(4):
            window = self.window(pos_pred[2] + guess[2], low, high, margin)
            solved, outside = self._newton(old, mode, damper, pos_pred, vel_pred, beta, guess, window)
            if not outside:
                break
            margin = 2 * margin + self.element
        return solved

    def _newton(
        self,
        old: State,
        mode: int,
        damper: Array,
        pos_pred: Array,
        vel_pred: Array,
        beta: float,
        guess: Array,
        window: Window,
    ) -> tuple[Any, bool]:
        """The stage in one window, and whether the patch left it."""
        law, dofs = self.law, self.ring.dofs(*window)
        u_old = self.displacement(old, window)
        d = guess.copy()
        last, lags = np.inf, True
        ok = False
        for iteration in range(25):
            pos, vel, acc = pos_pred + d, vel_pred + d / beta, d / beta**2
            u = pos[3:][dofs].reshape(-1, 2)
            force, nodal, tangent, res, bristles, flags = contact_forces(
                pos[:3], u, window[0], self.vertex, law, mode, old.pos[:3], u_old, old.bristles, old.flags, damper
            )
            own = inertia(self.ring, pos, vel, acc, beta)
            frame, ring = own.frame - force, own.ring.copy()
            ring[dofs] -= nodal.ravel()
            worst = max(np.abs(frame).max(), np.abs(ring).max())
            if not np.isfinite(worst):
                break
            small = self.tolerance * (1 + res[NORMAL])
            if worst > small:
                depth = abs(pos[1]) + np.abs(u).max()
                small += 4e-16 * (law[EPS_N] + law[EPS_T]) * res[LENGTH] * depth + 1e-14 * (damper[0] + 1) * res[ELASTIC]
                small += 1e-15 * damper[3] * (abs(res[SLIP]) + abs(damper[4])) + self.ring.round_off(pos[3:])
                small += 4e-16 * np.abs(vel_pred[3:]).max(initial=0.0) / beta * self.ring.body[RING_MASS]
            factored = self._factor(pos, vel, acc, beta, lags and iteration > 1 and worst > 0.05 * last)
            matrix = NewtonMatrix(factored, own, tangent, window)
            if worst <= small and iteration > 0:
                ok = True
                break
            step_frame, step_ring = matrix.solve(frame, ring)
            damping = 0.5 if iteration > 3 and worst > last else 1.0
            last = worst
            d[:3] -= damping * step_frame
            d[3:] -= damping * step_ring
        outside = bool(res[OUTSIDE] != 0)
        if self.ring.massless:
            acc[3:] = 0.0
        return (ok and not outside, d, acc, matrix, window, u, nodal, res, bristles, flags), outside

    def _factor(self, pos: Array, vel: Array, acc: Array, beta: float, anew: bool) -> _Factored:
        if anew or self._factored is None or not self._factored.serves(vel[2], beta):
            self._factored = _Factored(self.ring, pos[3:], vel[2], acc[2], beta)
        return self._factored

    def energies(self, state: State) -> tuple[float, float, float]:
        """Kinetic, gravity (0 with the hoop's centre at the floor), ring strain."""
        ring, body, pos, vel = self.ring, self.ring.body, state.pos, state.vel
        offset, mass = body[OFFSET], body[RING_MASS]
        s, c = sin(pos[2]), cos(pos[2])
        w, u, v = vel[2], pos[3:], vel[3:]
        vx, vy = vel[0] + w, vel[1]
        dx, dy = vx + offset * w * c, vy - offset * w * s
        kinetic = (dx * dx + dy * dy + body[DISK_INERTIA] * w * w) / 2
        gravity = 1 + pos[1] + offset * c
        if not ring.massless:
            m_u, m_v = ring.mass @ u, ring.mass @ v
            (s1, s1_v), (s2, s2_v) = ((l @ u, l @ v) for l in ring.along)
            v1, v2 = vx * s + vy * c, vx * c - vy * s
            moment = body[RING_INERTIA] + (2 * ring.stretching + m_u) @ u
            kinetic += mass * (vx * vx + vy * vy) / 2 + v1 * (s1_v - w * s2) + v2 * (s2_v + w * s1)
            kinetic += (moment * w * w + v @ m_v) / 2 + w * (v @ (ring.rotation + turned(m_u)))
            gravity += mass * (1 + pos[1]) + s1 * c - s2 * s
        return float(kinetic), float(gravity), ring.strain_energy(u)

    def momentum_error(self, state: State, beta: float, matrix: NewtonMatrix, error: Array) -> float:
        """See :class:`flexible.march.Model`; the ring's part in the norm of its mass."""
        ring, still = self.ring, np.zeros_like(state.vel)
        with_error = inertia(ring, state.pos, still, error, beta)
        without = inertia(ring, state.pos, still, still, beta)
        load = (with_error.frame - without.frame) / beta**2, (with_error.ring - without.ring) / beta**2
        frame, u = matrix.solve(*load)
        return float(max(abs(frame[0] + frame[2]), abs(frame[1]), abs(frame[2]), np.sqrt(max(u @ (ring.mass @ u), 0.0))))
