"""The hoop with every node of its ring free: the reference for the reduced one.

Newton's matrix is the ring's sparse one, which the stages of a step share, bordered by the frame and by the contact:
both borders are exact in every iteration, so that the ring's may lag behind.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, isfinite, nan, sin

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from ..contact.forces import contact_forces
from ..contact.guess import off_its_way, shift, slipping_on
from ..contact.newton import before_bend, goes, round_off
from ..contact.points.data import MOST_ITERATIONS, Damper, Rim, at_start, pulling
from ..contact.points.rim import margin_around
from ..contact.stage import Near, Predictor, Stage
from ..contact.vectors import largest
from ..ring.choice import ring_of
from ..ring.fem import Ring
from ..ring.frame import disk_energies
from ..ring.nodal import Inertia, NodalRing, factored, inertia, turned
from .equilibrium import RestingNodes
from .rim_contact import SLOW, RimContact
from .state import Energies, State

Array = NDArray[np.float64]
Window = tuple[int, int]

_WINDOWS = 8  # of which the columns are kept: a patch that moves on comes to others
_LARGEST_LAG = 1e-3  # of beta times the change of omega since the ring's matrix was factored
_STALE = 0.05  # of a misfit, what a step of Newton leaves off the contact at most with a matrix that is kept


class _Factored:
    """The ring's own part of Newton's matrix, factored, and its inverse on the columns of rim windows."""

    def __init__(self, ring: NodalRing, u: Array, w: float, alpha: float, beta: float) -> None:
        matrix = ring.tangent(u)
        if not ring.massless:
            matrix = matrix + ring.mass * (1 / beta**2 - w * w) + ring.gyro * (alpha + 2 * w / beta)
        options = {"SymmetricMode": True}
        self.solve = factored(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        self.ring, self.w, self.beta = ring, w, beta
        self._columns: dict[Window, Array] = {}

    def serves(self, w: float, beta: float) -> bool:
        """Whether it still is a good matrix."""
        return self.ring.massless or (beta == self.beta and abs(w - self.w) * beta < _LARGEST_LAG)

    def columns(self, window: Window) -> Array:
        """The inverse's columns for the window's dofs, (n, 2 nodes)."""
        if window not in self._columns:
            if len(self._columns) == _WINDOWS:
                del self._columns[next(iter(self._columns))]
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
        dofs, t = self.factored.ring.dofs(*self.window), self.contact
        columns = self.factored.columns(self.window)
        frame_by_ring = self.inertia.frame_by_ring.copy()
        frame_by_ring[:, dofs] -= t[:3, 3:]
        by_frame = columns @ -t[3:, :3]
        if self.factored.ring.massless:
            base = self.factored.solve(ring)
        else:
            z = self.factored.solve(np.column_stack([ring, self.inertia.ring_by_frame]))
            base = z[:, 0]
            by_frame += z[:, 1:]
        # du = base - by_frame dx + columns t_uu w, with w = du on the window
        by_window = columns @ t[3:, 3:]
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
    """Frame and all free nodes of a scene's ring; see :class:`flexible.models.state.Model`.

    ``State.pos`` is (V, h, phi, u) with u the displacement of the free dofs in the order of ``Ring.free``.

    Parameters
    ----------
    points : float, optional
        See :class:`flexible.models.rim_contact.RimContact`.
    through : int
        Least number of elements through the wall, unless the scene says how many.
    """

    def __init__(self, scene: Scene, points: float | None = None, through: int = 1) -> None:
        self.ring = self._make_ring(scene, ring_of(scene, through, self.linear))
        super().__init__(scene, self.ring.vertex, points)
        self._factored: _Factored | None = None
        #: momenta of the slow vibrations, by which steps are chosen, of a rate of the free dofs
        self._slow = np.zeros((0, self.ring.size))
        if not self.ring.massless:
            shapes = self.ring.ring.modes(SLOW)[1]
            self._slow = (self.ring.mass @ shapes).T / np.sqrt(scene.hoop.mass_ratio)

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

    def displacement(self, state: State, window: Window) -> Array:
        """Displacement of the rim nodes of a window."""
        return state.pos[3:][self.ring.dofs(*window)].reshape(-1, 2)

    def stage(
        self,
        old: State,
        mode: int,
        damper: Damper,
        predictor: Predictor,
        near: Near,
        first: bool,
    ) -> Stage:
        """See :class:`flexible.models.state.Model`."""
        if first and not (self.linear and self.ring.massless):
            self._factored = None  # a step depends on nothing but the state from which it goes
        if self.ring.massless:  # no inertia to go by: from where the ring was
            guess = predictor.guess.copy()
            guess[3:] = old.pos[3:] - predictor.pos[3:]
            predictor = predictor._replace(guess=guess)
        expected = predictor.pos + predictor.guess
        low, high = self.reach(expected[2], expected[1], expected[3:][self.ring.ring.rim_dofs])
        if old.res.normal > 0:
            low, high = min(low, old.res.low), max(high, old.res.high)
        margin = margin_around(low, high, self.element)
        for _ in range(4):
            window = self.window(float(expected[2]), low, high, margin)
            solved, outside = self._newton(old, mode, damper, predictor, window, near.known)
            if not outside:
                break
            margin = 2 * margin + self.element
        return solved

    def _newton(
        self, old: State, mode: int, damper: Damper, predictor: Predictor, window: Window, known: float
    ) -> tuple[Stage, bool]:
        """The stage in one window, and whether the patch left it."""
        pos_pred, vel_pred, beta, guess = predictor
        law, dofs = self.law.parameters, self.ring.dofs(*window)
        rim = Rim(window[0], self.vertex)
        before = at_start(old, self.displacement(old, window), predictor.beta)
        d = guess.copy()
        last = np.inf
        way, ok = nan, False
        damper = pulling(damper, True)
        for iteration in range(MOST_ITERATIONS):
            pos = pos_pred + d
            u = pos[3:][dofs].reshape(-1, 2)
            contact = contact_forces(pos[:3], u, rim, law, mode, before, damper, True)
            res = contact.res
            by = off_its_way(res, way) if iteration > 0 else slipping_on(law, before, damper, res)
            if by != 0:  # as in flexible.models.stage
                moved = np.zeros_like(u)
                shift(moved, pos[2], by, 0.0)
                d[3 + dofs] += moved.ravel()
                pos = pos_pred + d
                u = pos[3:][dofs].reshape(-1, 2)
                contact = contact_forces(pos[:3], u, rim, law, mode, before, damper, True)
                res = contact.res
            vel, acc = vel_pred + d / beta, d / beta**2
            own = inertia(self.ring, pos, vel, acc, beta)
            frame, ring = own.frame - contact.force, own.ring.copy()
            ring[dofs] -= contact.nodal.ravel()
            worst = max(largest(frame), largest(ring))
            off = largest(np.delete(ring, dofs))  # the contact's part of the matrix is always new
            if not isfinite(worst):
                return Stage(False), False
            small = known * (1 + abs(res.normal))
            if worst > small:
                scale = (law.eps_n + law.eps_t) * res.length
                small += round_off(contact, pos[1], u, scale, damper) + self.ring.round_off(pos[3:])
                small += 4e-16 * np.abs(acc[3:]).max(initial=0.0) * self.ring.body.ring_mass
            factored = self._factor(pos, vel, acc, beta, iteration > 1 and off > _STALE * last)
            matrix = NewtonMatrix(factored, own, contact.tangent, window)
            if worst <= small and iteration > 0:
                if damper.pulls and res.eta < 0:
                    damper, last = pulling(damper, False), np.inf
                    continue
                ok = True
                break
            update = np.concatenate(matrix.solve(frame, ring))
            if not isfinite(largest(update)):
                return Stage(False), False
            damping = 0.5 if iteration > 3 and worst > last else 1.0
            last = worst
            damping, _, way = before_bend(res, damping, goes(contact.way_by, update, update[3 + dofs]))
            d -= damping * update
        outside = contact.outside
        if self.ring.massless:
            acc[3:] = 0.0
        forces = np.concatenate([own.frame, own.ring])
        found = Stage(ok and not outside, d, acc, forces, matrix, window, u, contact.nodal, res, contact.bristles)
        return found, outside

    def _factor(self, pos: Array, vel: Array, acc: Array, beta: float, anew: bool) -> _Factored:
        if anew or self._factored is None or not self._factored.serves(vel[2], beta):
            self._factored = _Factored(self.ring, pos[3:], vel[2], acc[2], beta)
        return self._factored

    def energies(self, state: State, held: Energies | None = None) -> Energies:
        """Kinetic, gravity (0 with the hoop's centre at the floor), ring strain."""
        return held or self.held(state.pos, state.vel)

    def held(self, pos: Array, vel: Array) -> tuple[float, float, float]:
        """See :class:`flexible.models.state.Model`."""
        ring, body = self.ring, self.ring.body
        mass, u, v = body.ring_mass, pos[3:], vel[3:]
        kinetic, gravity = disk_energies(body, pos, vel)
        if not ring.massless:
            m_u, m_v = ring.mass @ u, ring.mass @ v
            (s1, s1_v), (s2, s2_v) = ((l @ u, l @ v) for l in ring.along)
            s, c, w = sin(pos[2]), cos(pos[2]), vel[2]
            vx, vy = vel[0] + w, vel[1]
            v1, v2 = vx * s + vy * c, vx * c - vy * s
            moment = body.ring_inertia + (2 * ring.stretching + m_u) @ u
            kinetic += mass * (vx * vx + vy * vy) / 2 + v1 * (s1_v - w * s2) + v2 * (s2_v + w * s1)
            kinetic += (moment * w * w + v @ m_v) / 2 + w * (v @ (ring.rotation + turned(m_u)))
            gravity += mass * (1 + pos[1]) + s1 * c - s2 * s
        return float(kinetic), float(gravity), ring.strain_energy(u)

    def forces(self, pos: Array, vel: Array, acc: Array) -> Array:
        """See :class:`flexible.models.state.Model`."""
        own = inertia(self.ring, pos, vel, acc, 1.0)
        return np.concatenate([own.frame, own.ring])

    def error(self, pos: Array, vel: Array, acc: Array, beta: float, matrix: NewtonMatrix, error: Array) -> float:
        """See :class:`flexible.models.state.Model`; of the ring, the slow vibrations: steps do not follow the fast."""
        ring, still = self.ring, np.zeros_like(vel)
        without, with_error = (inertia(ring, pos, still, a, beta) for a in (still, error))
        load = (with_error.frame - without.frame) / beta**2, (with_error.ring - without.ring) / beta**2
        rate = np.concatenate(matrix.solve(*load))
        slow = np.abs(self._slow @ rate[3:]).max(initial=0.0) / (1 + ring.body.ring_mass) ** 0.5
        return float(largest(np.array([rate[0] + rate[2], rate[1], rate[2], slow])))
