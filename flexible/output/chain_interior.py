"""The inside of a chain's ring: the mesh carried along by the sections, and what the contact presses into it.

Between two sections the line of the centres of mass is a cubic. Where a section bears a shear force the line runs on by
an angle gamma besides, the mean of the two parts' there, as a slope of the section alone would be paid for by bends to
and fro in parts that are shorter than the wall. The rotation phi is a cubic too, with the slopes of a spline through
all sections, for a curvature that does not jump where masses sit. A node of the mesh keeps its place on the normal n of
the section but for what the wall does as it is stretched, bent and sheared,

    y = X(theta) + (z - w_e eps - w_b phi') n(theta) + w_s gamma t(theta),

w_e = nu a log(1 + z/a) of a wall that gets thinner by nu times its hoop strain (a eps + z phi')/(a + z), w_b of that
and of the radial stress in a curved bar, w_s Saint-Venant's cubic; w_e and w_b less their mean on which a shear force
does work, as on the rim (:mod:`flexible.chain.rod.surface`).

To this comes what a chain lacks under the contact's forces: the mesh's linear answer to them less the chain's, turned
with the ring. A static ring that bends little moves exactly as its mesh does. Near the weld nodes move besides by the
strains of the first and the last part, as on the mesh under loads far away.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..chain.rim import follow
from ..chain.ring import PULLED, dofs_of, inverse_of
from ..chain.rod.corotated import bends_and_stretches, chord, elastic
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
        self._onward = np.column_stack([-np.sin(rod.theta), np.cos(rod.theta)])
        self._yields = chain.shape.compliance.section[1, 1] / (self._radius * chain.stiffness)
        self._thins, self._warps = _across(self._depth, mesh.inner / mesh.outer, self._radius, self.ring.poisson)
        self._root = np.zeros((len(self._moves), 2, 6))
        if not chain.shape.slender:
            self._root = self._roots()

    def _roots(self) -> Array:
        """What the nodes near the weld move by the strains of the first and the last part, (n_nodes, 2, 6)."""
        shape, ring = self.chain.shape, self.ring
        theta = ring.mesh.rim_theta
        loaded = np.array([int(np.argmin(np.abs(theta - angle))) for angle in PULLED])
        dofs = dofs_of(loaded)
        load = np.zeros((len(ring.free), len(dofs)))
        load[ring.rim_dofs[dofs], np.arange(len(dofs))] = 1.0
        answers = shape.inverse @ shape.rim[dofs_of(shape.at(loaded))].T
        still = np.zeros_like(shape.still)
        misfit = np.zeros((len(self._moves), 2, len(dofs)))
        for k, (moved, answer) in enumerate(zip(ring.solve(load).T, answers.T, strict=True)):
            misfit[:, :, k] = ring.expand(moved) - self._way(
                still, np.vstack([[still[0]], answer.reshape(-1, 3), [still[0]]])
            )
        place = shape.rod.place
        first, last = chord_strains(place[0], place[1], 2), chord_strains(place[-2], place[-1], 1)
        root = misfit @ inverse_of(np.concatenate([first @ answers[:3], last @ answers[-3:]]))
        # as on the rim it passes to nothing, without a step, in the outer half of the stretch that was measured
        grid, begin, end = ring.mesh.grid, ring.mesh.weld_half_angle, shape.compliance.weld
        angle = np.angle(np.exp(1j * ring.mesh.theta[grid[0]]))
        for side in (-1, 1):
            x = np.clip(2 * (side * angle - begin) / (end - begin) - 1, 0, 1)
            there = root[grid[:, np.argmin(np.abs(side * angle - end))]]
            root[grid] -= (x**2 * (3 - 2 * x))[:, None, None] * there[:, None]
        root[grid[:, np.abs(angle) > end + 1e-9]] = 0.0
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
        rod, a, z, circle = self.chain.chain.rod, self._radius, self._depth, self._circle
        shear, stretch = self._shears(q), bends_and_stretches(rod, q)[1]
        bend, free = np.zeros(len(q)), rod.theta[1:-1]
        bend[1:-1] = CubicSpline(free, q[1:-1, 2])(free, 1)
        bend[0], bend[-1] = bend[1], bend[-2]
        # the line of centres less the circle: slopes
        slope = _turned_by(self._onward, q[:, 2] + shear)
        slope += stretch[:, None] * (self._onward + slope)
        # the cubics with value and slope of a circle at the sections, less the circle, are no displacement
        u, along = self._cubic(q[:, :2], a * slope)
        turn, turning = (column[:, 0] for column in self._cubic(q[:, 2:], bend[:, None]))
        onward = np.column_stack([-circle[:, 1], circle[:, 0]])
        longer = np.hypot(*(a * onward + along).T) / a - 1
        slides = (1 - self._xi) * shear[self._part] + self._xi * shear[self._part + 1]
        out = -self._thins[:, 0] * longer - self._thins[:, 1] * turning
        normal = circle + _turned_by(circle, turn)
        moved, whole = np.zeros((len(self._moves), 2)), np.zeros(len(self._moves))
        moved[self._moves] = u + z[:, None] * (normal - circle) + out[:, None] * normal
        moved[self._moves] += (self._warps * slides)[:, None] * np.column_stack([-normal[:, 1], normal[:, 0]])
        whole[self._moves] = turn
        at_weld = np.concatenate([chord(rod, q, p)[3:] for p in (0, len(rod.local) - 1)])
        return moved + _turned(self._root @ at_weld, whole), whole

    def _cubic(self, value: Array, slope: Array) -> tuple[Array, Array]:
        """Cubics with values and slopes at the sections, (n + 2, m) each: at the nodes, and their slopes there."""
        x, width = self._xi[:, None], self._width[:, None]
        i, j = self._part, self._part + 1
        one, two, s, t = value[i], value[j], width * slope[i], width * slope[j]
        at = (1 - x) ** 2 * (1 + 2 * x) * one + x**2 * (3 - 2 * x) * two + x * (1 - x) * ((1 - x) * s - x * t)
        along = 6 * x * (1 - x) * (two - one) + (1 - x) * (1 - 3 * x) * s + x * (3 * x - 2) * t
        return at, along / width

    def _shears(self, q: Array) -> Array:
        """By how much the line of centres turns further than each section, (n + 2,): the shear of the parts there."""
        rod, force = self.chain.chain.rod, np.zeros_like(q)
        elastic(rod, q, force)
        pull = -np.cumsum(force, axis=0)[:-1, :2]  # what each part's end behind is pulled by
        way = np.diff(rod.place + q[:, :2], axis=0)
        shear = self._yields * (way[:, 0] * pull[:, 1] - way[:, 1] * pull[:, 0]) / np.hypot(*way.T)
        before, behind = np.diff(rod.theta)[:-1], np.diff(rod.theta)[1:]
        inner = (behind * shear[:-1] + before * shear[1:]) / (before + behind)
        return np.concatenate([shear[:1], inner, shear[-1:]])

    def _local(self, state: State) -> Array:
        """What the contact's forces move besides, (n_nodes, 2)."""
        moved = np.zeros((len(self._moves), 2))
        if state.res.normal == 0 or self.chain.shape.slender:
            return moved
        chain, q = self.chain, sections(state.pos)
        number, nodes = chain.window(*state.window)
        back = -follow(chain.chain.rod, q, nodes)[2]
        force = _turned(state.nodal, back).ravel()
        shape, load = chain.shape, np.zeros(len(self.ring.free))
        on_rim = np.zeros(2 * len(shape.theta))
        np.add.at(on_rim, dofs_of(number), force)
        load[self.ring.rim_dofs] = shape.to_mesh(on_rim)
        moved += self.ring.expand(self.ring.solve(load))
        answer = np.zeros_like(q)
        answer[1:-1] = (shape.inverse @ (shape.rim.T @ on_rim)).reshape(-1, 3)
        moved -= self._way(np.zeros_like(q), answer)
        return _turned(moved / chain.stiffness, self._carried(q)[1])


def _turned(vectors: Array, angle: Array) -> Array:
    """Vectors (n, 2), each turned by its angle."""
    c, s = np.cos(angle), np.sin(angle)
    return np.column_stack([c * vectors[:, 0] - s * vectors[:, 1], s * vectors[:, 0] + c * vectors[:, 1]])


def _turned_by(vectors: Array, angle: Array) -> Array:
    """What vectors (n, 2) become longer by as each is turned by its angle."""
    less, s = -2 * np.sin(angle / 2) ** 2, np.sin(angle)
    return np.column_stack([less * vectors[:, 0] - s * vectors[:, 1], s * vectors[:, 0] + less * vectors[:, 1]])


def _across(depth: Array, inner: float, radius: float, poisson: float) -> tuple[Array, Array]:
    """By what points of the wall sink as it is stretched and bent, (n, 2), and shift as it is sheared, (n,)."""
    wall, middle = 1 - inner, (1 + inner) / 2 - radius

    def sinks(z: Array) -> Array:
        stretched, x = poisson * radius * np.log1p(z / radius), z - middle
        pressed = (1 - poisson**2) * x * (wall**2 / 4 - x**2 / 3) / (2 * radius**2)
        return np.column_stack([stretched, poisson * z - stretched + pressed])

    points, weights = np.polynomial.legendre.leggauss(8)
    weights = weights * (1 - points**2)
    mean = weights @ sinks(middle + wall / 2 * points) / weights.sum()
    x = depth - middle
    shifted = (2 + poisson) / (2 * (1 + poisson)) * x * (5 * x**2 / (3 * wall**2) - 1 / 4)
    return sinks(depth) - mean, shifted
