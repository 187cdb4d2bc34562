"""The hoop at rest in the disk's frame: ring and patch in equilibrium under given forces of the floor.

Any level's ring answers the same question: displacement of a window of rim nodes = offset + compliance x forces on
them, exactly for a linear ring, near its present shape for the exact one, which is then moved and asked again.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from ..contact.forces import contact_forces
from ..contact.laws.listing import sharing
from ..contact.points.data import NOTHING, UNDAMPED, Before, Parameters, Rim, no_bristles
from ..contact.points.normal import half_width
from ..contact.points.rim import gap_at, upward
from ..contact.vectors import largest
from ..ring.nodal import factored
from .state import State

Array = NDArray[np.float64]
Window = tuple[int, int]


class RestingRing(Protocol):
    """A ring at rest under the inertia of the frame's motion and forces on its rim."""

    coordinates: Array

    def linearise(self, share: float) -> None:
        """Take ``share`` of the inertia and the present shape to ask from."""

    def response(self, window: Window) -> tuple[Array, Array]:
        """Offset (2 nodes,) and compliance (2 nodes, 2 nodes)."""

    def move(self, window: Window, force: Array) -> float:
        """Take the shape under rim forces; the largest change of a coordinate, relative to the largest."""


class RestingNodes(RestingRing):
    """All free nodes of a :class:`flexible.ring.nodal.NodalRing`.

    Parameters
    ----------
    inertia : sparse
        What the motion of the frame adds to the stiffness.
    load : (n,) array
        Its force on the undeformed ring.
    """

    def __init__(self, ring: Any, inertia: sp.csc_matrix, load: Array) -> None:
        self.ring, self.inertia, self.load = ring, inertia, load
        self.coordinates = np.zeros(ring.size)
        self.noise = 3e-11 / (1 - ring.ring.mesh.inner) ** 2  # a wall stretches h^-2 times as hard as it bends

    def linearise(self, share: float) -> None:
        u = self.coordinates
        matrix = (self.ring.tangent(u) + share * self.inertia).tocsc()
        self._solve = factored(matrix)
        self.base = u - self._solve(self.ring.elastic(u) + share * (self.inertia @ u + self.load))
        self._columns: dict[Window, Array] = {}

    def _answer(self, window: Window) -> Array:
        if window not in self._columns:
            dofs = self.ring.dofs(*window)
            unit = np.zeros((self.ring.size, len(dofs)))
            unit[dofs, np.arange(len(dofs))] = 1.0
            self._columns[window] = self._solve(unit)
        return self._columns[window]

    def response(self, window: Window) -> tuple[Array, Array]:
        dofs = self.ring.dofs(*window)
        return self.base[dofs], self._answer(window)[dofs]

    def move(self, window: Window, force: Array) -> float:
        moved = self.base + self._answer(window) @ force
        change, self.coordinates = largest(moved - self.coordinates) / max(largest(moved), 1e-300), moved
        return change if change > self.noise else 0.0


class Patch:
    """The patch of a hoop at rest at the angle ``phi`` that carries N and F.

    Attributes
    ----------
    height : float
        h, the hoop's centre above R.
    window : (int, int)
    u : (nodes, 2) array
    nodal, res, bristles :
        See :class:`flexible.contact.points.data.Contact`.
    """

    def __init__(self, hoop: Any, phi: float, normal: float, friction: float) -> None:
        self.hoop, self.phi, self.normal = hoop, phi, normal
        self.law, self.mode = sharing(hoop.law.parameters, friction / normal)
        self.half = half_width(normal, self.law.eps_n)
        self.low, self.high = -self.half, self.half
        self.height = -(self.half**2) / 2
        self.window: Window = (0, 0)
        self.u: Array = np.zeros((1, 2))
        self.nodal: Array = np.zeros((1, 2))
        self.res, self.bristles = NOTHING, no_bristles()
        self.ahead = 0.0  # along the rim, of where its forces stand

    def roll(self, angle: float) -> None:
        """Take the patch to be so much farther along the rim."""
        self.low, self.high, self.ahead = self.low + angle, self.high + angle, angle

    def start_from(self, state: State) -> None:
        """Begin with the patch of a state like the one that is looked for."""
        spacing = self.law.spacing
        self.low, self.high = state.res.low - spacing, state.res.high + spacing
        self.height, self.window = float(state.pos[1]), state.window
        self.u, self.nodal, self.res = state.u, state.nodal, state.res

    def lie_on(self, law: Parameters, softness: float) -> None:
        """Take the foundation of ``law``, so many times softer: a patch that is longer and deeper."""
        self.law = law._replace(
            eps_n=law.eps_n / softness, eps_t=law.eps_t / softness, spacing=law.spacing * softness ** (1 / 3)
        )
        before, self.half = self.half, half_width(self.normal, self.law.eps_n)
        self.height += (before**2 - self.half**2) / 2
        self.low, self.high = min(self.low, -self.half), max(self.high, self.half)

    def solve(self, ring: RestingRing, share: float) -> bool:
        """Newton on height and rim for ``share`` of the forces; whether it converged."""
        wanted = share * self.normal
        margin, lost, last = self.half + self.hoop.element, False, np.inf
        for iteration in range(60):
            window = self.hoop.window(self.phi, self.low, self.high, margin)
            if 2 * window[1] > len(self.hoop.vertex):
                return False
            if lost and self.res.normal > 0:
                angle, lost = self._lowest(window, ring, wanted), False
                if abs(angle) > max(2 * self.half, self.hoop.element):  # it touches elsewhere than where it is pressed
                    self.roll(angle)
                    margin = self.half + self.hoop.element
                    window = self.hoop.window(self.phi, self.low, self.high, margin)
            if window != self.window or iteration == 0:
                self._foresee(window, ring, wanted)
            offset, compliance = ring.response(window)
            pose = np.array([0.0, self.height, self.phi])
            rim, before = Rim(window[0], self.hoop.vertex), Before(pose, self.u, no_bristles())
            contact = contact_forces(pose, self.u, rim, self.law, self.mode, before, UNDAMPED, True)
            force, tangent = contact.force, contact.tangent
            self.nodal, self.res, self.bristles = contact.nodal, contact.res, contact.bristles
            if contact.outside:
                margin, lost = 2 * margin + self.hoop.element, True
                continue
            flat = self.nodal.ravel()
            misfit = self.u.ravel() - offset - compliance @ flat
            # what a misfit of the rim makes of the force: patch and ring in series
            scale = 1 + abs(tangent[1, 1]) / (1 + abs(tangent[1, 1]) * np.abs(compliance).max())
            error = max(largest(force[1:2] - wanted), scale * largest(misfit))
            if not np.isfinite(error):
                return False
            floor = 1e-15 * (1 + abs(tangent[1, 1])) * (abs(self.height) + np.abs(self.u).max())
            if error < 1e-10 * (1 + wanted) + floor:
                self.low, self.high = self.res.low - self.law.spacing, self.res.high + self.law.spacing
                return True
            if self.res.normal == 0:
                self._stand(offset)
                continue
            height, moved = self._step(contact.tangent, compliance, force[1] - wanted, misfit, scale)
            damping = 0.5 if iteration > 5 and error > last else 1.0
            last = error
            self.height -= damping * height
            self.u = self.u - damping * moved.reshape(-1, 2)
        return False

    @staticmethod
    def _step(tangent: Array, compliance: Array, excess: float, misfit: Array, scale: float) -> tuple[float, Array]:
        """Newton's for height and rim: what touches is solved for, and the rest of the window follows."""
        by_height, by_rim = tangent[3:, 1], tangent[3:, 3:]
        touching = np.flatnonzero(by_rim.any(axis=0) | by_rim.any(axis=1) | (by_height != 0))
        answer = compliance[:, touching] @ by_rim[np.ix_(touching, touching)]
        rise = compliance[:, touching] @ by_height[touching]
        n = len(touching)
        matrix = np.empty((1 + n, 1 + n))
        matrix[0, 0], matrix[0, 1:] = tangent[1, 1], tangent[1, 3:][touching]
        matrix[1:, 0] = -scale * rise[touching]
        matrix[1:, 1:] = scale * (np.eye(n) - answer[touching])
        step = np.linalg.solve(matrix, np.concatenate([[excess], scale * misfit[touching]]))
        return float(step[0]), misfit + rise * step[0] + answer @ step[1:]

    def _foresee(self, window: Window, ring: RestingRing, wanted: float) -> None:
        """Where Newton starts in a window: the forces found so far, scaled to the wanted N, as deep as before."""
        offset, compliance = ring.response(window)
        up = [np.cos(self.phi), -np.sin(self.phi)]
        before, loads, gaps = self._angles(self.window) + self.ahead, self.nodal @ up, self._gaps(self.window, self.u)
        self.window, self.ahead = window, 0.0
        if self.res.normal > 0:
            angles = self._angles(window)
            before += 2 * np.pi * np.round((angles.mean() - before.mean()) / (2 * np.pi))
            force = np.column_stack([np.interp(angles, before, one, 0.0, 0.0) for one in self.nodal.T])
            load = force @ up
            if load.sum() > 0:
                self.u = (offset + compliance @ force.ravel() * (wanted / load.sum())).reshape(-1, 2)
                self.height += loads @ gaps / loads.sum() - load @ self._gaps(window, self.u) / load.sum()
                return
        self._stand(offset)

    def _stand(self, offset: Array) -> None:
        """Take the shape that the ring has without forces, as deep as the wanted one asks for."""
        self.u = offset.reshape(-1, 2).copy()
        self.height = -self._gaps(self.window, self.u).min() - self.half**2 / 2

    def _lowest(self, window: Window, ring: RestingRing, wanted: float) -> float:
        """How far along the rim its nearest node is that the wanted forces, put there, make lowest; 0 if none is."""
        up = np.array([np.cos(self.phi), -np.sin(self.phi)])
        loads, force = self.nodal @ up, self.nodal.sum(axis=0)
        here = loads @ self._angles(self.window) / loads.sum()
        offset, compliance = ring.response(window)
        moved = np.einsum("a,iajb,b->ij", up, compliance.reshape(len(offset) // 2, 2, -1, 2), force)
        gaps = self._gaps(window, offset.reshape(-1, 2))[:, None] + moved * (wanted / loads.sum())
        slope = np.diagonal(gaps, -1)[1:] - np.diagonal(gaps, 1)[:-1]  # of the rim at each node that is pressed
        lowest = np.flatnonzero(slope[:-1] * slope[1:] < 0)
        if len(lowest) == 0:
            return 0.0
        ways = self._angles(window)[1 + lowest] - here
        ways -= 2 * np.pi * np.round(ways / (2 * np.pi))
        return float(ways[np.abs(ways).argmin()])

    def _angles(self, window: Window) -> Array:
        """Of a window's nodes."""
        angles: Array = self.hoop.rim_angle(np.arange(2 * window[0], 2 * sum(window) + 1))
        return angles

    def _gaps(self, window: Window, u: Array) -> Array:
        """Heights of a window's nodes above where the undeformed rim would touch, at h = 0."""
        up = upward(u[:, 0], u[:, 1], np.sin(self.phi), np.cos(self.phi))
        return np.asarray(gap_at(0.0, self.phi + self._angles(window) - np.pi, up))
