"""The inside of a chain's ring: the mesh carried along by the sections, and what the contact presses into it.

Between two sections the line of the centres of mass is a cubic with the sections' directions and stretch. A node of the
mesh keeps its place on the normal of that line, but for the wall's getting thinner where it is stretched,

    y = X(theta) + (z - nu (eps_0 z + phi' z^2/(2 a))) n(theta),

and to this comes what a chain lacks under the contact's forces: the mesh's linear answer to them less the chain's,
turned with the ring. A static ring that bends little moves exactly as its mesh does. Near the weld nodes move besides
by the strains of the first and the last part, as on the mesh under loads far away. Left out elsewhere is the warping of
sections, but for the answer to the contact.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..chain.rim import follow
from ..chain.ring import PULLED, inverse_of
from ..chain.rod.corotated import bends_and_stretches, chord
from ..chain.rod.ends import chord_strains
from ..chain.whole import sections
from ..models.chain import ChainHoop
from ..models.state import State
from .recovery import ExactInterior

Array = NDArray[np.float64]

_SMALL = 1e-5  # displacement over R within which the chain is linear to the square of it


class ChainInterior(ExactInterior):
    """Fields of a chain's ring at the nodes of its mesh, with Green's strain.

    Parameters
    ----------
    hoop : ChainHoop
    """

    def __init__(self, hoop: ChainHoop) -> None:
        chain, mesh = hoop.ring, hoop.ring.ring.mesh
        super().__init__(chain.ring, chain.stiffness, hoop.scene.hoop.mass_ratio)
        self.chain, rod = chain, chain.chain.rod
        theta = mesh.theta % (2 * np.pi)
        self._moves = (theta > rod.theta[0]) & (theta < rod.theta[-1])
        theta = theta[self._moves]
        self._part = np.clip(np.searchsorted(rod.theta, theta, side="right") - 1, 0, len(rod.theta) - 2)
        self._width = np.diff(rod.theta)[self._part]
        self._xi = (theta - rod.theta[self._part]) / self._width
        self._radius = 1 - rod.offset
        self._depth = mesh.radius[self._moves] - self._radius
        self._circle = np.column_stack([np.cos(theta), np.sin(theta)])
        self._root = np.zeros((len(self._moves), 2, 6))
        if not chain.shape.slender:
            self._root = self._roots()

    def _roots(self) -> Array:
        """What the nodes near the weld move by the strains of the first and the last part, (n_nodes, 2, 6)."""
        shape, ring = self.chain.shape, self.ring
        theta = ring.mesh.rim_theta
        loaded = [int(np.argmin(np.abs(theta - angle))) for angle in PULLED]
        dofs = np.array([2 * node + way for node in loaded for way in (0, 1)])
        load = np.zeros((len(ring.free), len(dofs)))
        load[ring.rim_dofs[dofs], np.arange(len(dofs))] = 1.0
        answers = shape.inverse @ shape.rim[dofs].T
        still = np.zeros_like(shape.still)
        misfit = np.zeros((len(self._moves), 2, len(dofs)))
        for k, (moved, answer) in enumerate(zip(ring.solve(load).T, answers.T, strict=True)):
            misfit[:, :, k] = ring.expand(moved) - self._way(
                still, np.vstack([[still[0]], answer.reshape(-1, 3), [still[0]]])
            )
        place = shape.rod.place
        first, last = chord_strains(place[0], place[1], 2), chord_strains(place[-2], place[-1], 1)
        root = misfit @ inverse_of(np.concatenate([first @ answers[:3], last @ answers[-3:]]))
        root[np.abs(np.angle(np.exp(1j * ring.mesh.theta))) > shape.compliance.weld] = 0.0
        return np.asarray(root, dtype=float)

    def displacement(self, states: Sequence[State]) -> Array:
        """Displacement of the nodes, (n_nodes, 2, n_states)."""
        return np.stack([self._carried(sections(s.pos))[0] + self._local(s) for s in states], axis=-1)

    def rate(self, states: Sequence[State], before: Sequence[State], after: Sequence[State]) -> Array:
        """Rate of the displacement seen in the disk's frame, see :meth:`Interior.rate`."""
        rates = []
        for now, a, b in zip(states, before, after, strict=True):
            elapsed = b.t - a.t
            change = self._local(b) - self._local(a)
            if self.mass == 0:
                change += self._carried(sections(b.pos))[0] - self._carried(sections(a.pos))[0]
            rate = change / elapsed if elapsed > 0 else 0 * change
            if self.mass > 0:
                rate += self._way(sections(now.pos), sections(now.vel))
            rates.append(rate)
        return np.stack(rates, axis=-1)

    def _way(self, q: Array, by: Array) -> Array:
        """Derivative of the nodes' displacement along a way of the sections."""
        size = _SMALL / max(float(np.abs(by).max()), 1e-300)
        ahead, behind = (self._carried(q + way * size * by)[0] for way in (1, -1))
        return (ahead - behind) / (2 * size)

    def _carried(self, q: Array) -> tuple[Array, Array]:
        """Displacement of the nodes with the sections, (n_nodes, 2), and the rotation of the ring there, (n_nodes,)."""
        rod, a, x, width = self.chain.chain.rod, self._radius, self._xi, self._width
        bend, stretch = bends_and_stretches(rod, q)
        # the line of centres less the circle: displacements, and slopes less those of the circle
        turned = rod.theta + q[:, 2]
        less = 2 * np.sin(q[:, 2] / 2) ** 2
        s, c = np.sin(rod.theta), np.cos(rod.theta)
        slope = np.column_stack([s * less - c * np.sin(q[:, 2]), -c * less - s * np.sin(q[:, 2])])
        slope += stretch[:, None] * np.column_stack([-np.sin(turned), np.cos(turned)])
        slope *= a
        i, j = self._part, self._part + 1
        ends = (q[i, :2], q[j, :2], slope[i], slope[j])
        # the cubics with value and slope of a circle at the sections, less the circle, are no displacement
        values = ((1 - x) ** 2 * (1 + 2 * x), x**2 * (3 - 2 * x), width * x * (1 - x) ** 2, -width * x**2 * (1 - x))
        slopes = (-6 * x * (1 - x) / width, 6 * x * (1 - x) / width, (1 - x) * (1 - 3 * x), x * (3 * x - 2))
        u = sum(v[:, None] * end for v, end in zip(values, ends, strict=True))
        along = sum(v[:, None] * end for v, end in zip(slopes, ends, strict=True))
        tangent = a * np.column_stack([-self._circle[:, 1], self._circle[:, 0]]) + along
        length = np.hypot(*tangent.T)
        normal = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / length[:, None]
        z, nu = self._depth, self.ring.poisson
        kappa = (1 - x) * bend[i] + x * bend[j]
        thinner = nu * ((length / a - 1) * z + kappa * z * z / (2 * a))
        moved = np.zeros((len(self._moves), 2))
        moved[self._moves] = u + z[:, None] * (normal - self._circle) - thinner[:, None] * normal
        turn = np.zeros(len(moved))
        cross = self._circle[:, 0] * normal[:, 1] - self._circle[:, 1] * normal[:, 0]
        turn[self._moves] = np.arctan2(cross, (self._circle * normal).sum(axis=1))
        strains = np.concatenate([chord(rod, q, p)[3:] for p in (0, len(rod.local) - 1)])
        return moved + _turned(self._root @ strains, turn), turn

    def _local(self, state: State) -> Array:
        """What the contact's forces move besides, (n_nodes, 2)."""
        moved = np.zeros((len(self._moves), 2))
        if state.res.normal == 0 or self.chain.shape.slender:
            return moved
        chain, q = self.chain, sections(state.pos)
        number, nodes = chain.window(*state.window)
        back = -follow(chain.chain.rod, q, nodes)[2]
        force = _turned(state.nodal, back).ravel()
        dofs = np.column_stack([2 * number, 2 * number + 1]).ravel()
        load = np.zeros(len(self.ring.free))
        np.add.at(load, self.ring.rim_dofs[dofs], force)
        moved += self.ring.expand(self.ring.solve(load))
        answer = np.zeros_like(q)
        answer[1:-1] = (chain.shape.inverse @ (chain.shape.rim[dofs].T @ force)).reshape(-1, 3)
        moved -= self._way(np.zeros_like(q), answer)
        return _turned(moved / chain.stiffness, self._carried(q)[1])


def _turned(vectors: Array, angle: Array) -> Array:
    """Vectors (n, 2), each turned by its angle."""
    c, s = np.cos(angle), np.sin(angle)
    return np.column_stack([c * vectors[:, 0] - s * vectors[:, 1], s * vectors[:, 0] + c * vectors[:, 1]])
