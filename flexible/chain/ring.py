"""The ring as a chain of parts: a geometrically exact ring of a few hundred unknowns, condensed from the quads.

Each part is a rod with the compliance that :mod:`flexible.chain.section` measured on the mesh, exact for the small
bending within it; :mod:`flexible.chain.corotated` makes it turn and move far. What a rod lacks, the giving way of the
wall right under a load on the rim, is a static compliance: that of the mesh minus that of the undeformed chain, for
rim nodes near each other. The chain's answer to small loads on the rim is therefore that of the mesh to round-off; what
is left is the square of the rotation within a part, the inertia of what is smaller than one, and the strain that
is not small (a wall bent to the radius r strains by half a wall over r).
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from .bordered import empty_blocks
from .corotated import Rod, elastic, rim_point
from ..ring.fem import Ring, membrane_stiffness
from ..ring.reduction import body_constants
from .section import LOADED, RodCompliance, mass_radius, radial, rod_compliance
from .inertia import Body

Array = NDArray[np.float64]


def chord_strains(one: Array, two: Array, moves: int) -> Array:
    """(3, 3): (e, tau_1, tau_2) of a part by the coordinates of its section 1 or 2, the other one held."""
    along = two - one
    length = float(np.hypot(*along))
    t1, t2 = along / length
    sign = 2 * moves - 3
    return np.array(
        [
            [sign * t1, sign * t2, 0.0],
            [sign * t2 / length, -sign * t1 / length, 2.0 - moves],
            [sign * t2 / length, -sign * t1 / length, moves - 1.0],
        ]
    )


def in_strains(compliance: Array, by: Array) -> Array:
    """Stiffness in the strains that coordinates make, from the compliance of these coordinates."""
    inverse = np.linalg.inv(by)
    stiffness = inverse.T @ np.linalg.inv(compliance) @ inverse
    return (stiffness + stiffness.T) / 2


def curve_weights(theta: Array) -> Array:
    """Weights of the parabola's slope through three neighbours, (n, 3); zero at the ends."""
    weights = np.zeros((len(theta), 3))
    before, behind = np.diff(theta)[:-1], np.diff(theta)[1:]
    weights[1:-1, 0] = -behind / (before * (before + behind))
    weights[1:-1, 1] = (behind - before) / (before * behind)
    weights[1:-1, 2] = before / (behind * (before + behind))
    return weights


def make_rod(compliance: RodCompliance, ring: Ring, parts: int) -> Rod:
    """The ring between the ends of the weld as a chain at E b = 1 and unit mass of the ring; ``pinch`` is left at 0."""
    inner, weld = ring.mesh.inner / ring.mesh.outer, ring.mesh.weld_half_angle
    theta = np.concatenate([[weld], np.linspace(compliance.weld, 2 * pi - compliance.weld, parts - 1), [2 * pi - weld]])
    a = compliance.radius
    place = a * np.column_stack([np.cos(theta), np.sin(theta)])
    piece = float(theta[2] - theta[1])
    even = in_strains(compliance.piece(piece), chord_strains(a * radial(0.0), a * radial(piece), 2))
    by = np.zeros((6, 6))
    by[:3, :3], by[3:, 3:] = chord_strains(place[0], place[1], 2), chord_strains(place[-2], place[-1], 1)
    ends = in_strains(compliance.ends, by)
    local = np.stack([ends[:3, :3], *[even] * (parts - 2), ends[3:, 3:]])
    mass = np.zeros(parts + 1)
    mass[1:-1] = (theta[2:] - theta[:-2]) / (4 * pi)
    turning = mass * ((1 + inner**2) / 2 - a**2)
    return Rod(theta, place, local, ends[:3, 3:].copy(), mass, turning, curve_weights(theta), 1 - a, 0.0)


def make_body(scene: Scene, rod: Rod) -> Body:
    """What of the hoop moves with the frame; together with the rod's sections it has the ring's mass and inertia."""
    offset, disk, mass, about_c = body_constants(scene)
    square = (rod.place**2).sum(axis=1)
    return Body(
        float(offset),
        float(disk),
        float(mass - rod.mass.sum()),
        float(-(rod.mass @ rod.place[:, 0])),
        float(about_c - rod.mass @ square - rod.turning.sum()),
        float(mass),
    )


def dense_stiffness(rod: Rod, q: Array) -> Array:
    """Stiffness of the chain at some displacement, (3 (n + 2), 3 (n + 2))."""
    sections = len(rod.theta)
    blocks = empty_blocks(sections)
    elastic(rod, q, np.zeros((sections, 3)), blocks.diagonal, blocks.up, blocks.down)
    matrix = np.zeros((sections, 3, sections, 3))
    i = np.arange(sections)
    matrix[i, :, i, :] = blocks.diagonal
    here, there = i[:-1], np.append(i[1:-1], 1)  # behind the last free section comes the first
    matrix[here, :, there, :] += blocks.up
    matrix[there, :, here, :] += blocks.down
    return matrix.reshape(3 * sections, 3 * sections)


def rim_matrix(rod: Rod, q: Array, part: NDArray[np.int64], xi: Array) -> tuple[Array, Array]:
    """Displacement of points of the rim, (m, 2), and its derivatives by the sections, (2 m, 3 (n + 2))."""
    moved, matrix = np.zeros((len(part), 2)), np.zeros((len(part), 2, len(rod.theta) + 2, 3))
    by = np.empty((2, 12))
    for k in range(len(part)):
        rim_point(rod, q, part[k], xi[k], moved[k], by)
        if part[k] >= 0:
            matrix[k, :, part[k] : part[k] + 4] = by.reshape(2, 4, 3)
    return moved, matrix[:, :, 1:-1].reshape(2 * len(part), -1)


class _Shape:
    """What of a chain depends on its shape alone: at E b = 1 and unit mass."""

    def __init__(self, ring: Ring, parts: int) -> None:
        mesh = ring.mesh
        self.ring = ring
        self.compliance = rod_compliance(ring, 2 * (pi - mesh.weld_half_angle) / parts)
        self.rod = make_rod(self.compliance, ring, parts)
        theta = mesh.rim_theta % (2 * pi)
        inside = np.abs(mesh.rim_theta) > mesh.weld_half_angle
        part = np.clip(np.searchsorted(self.rod.theta, theta, side="right") - 1, 0, parts - 1)
        self.part = np.where(inside, part, -1)
        self.xi = np.where(inside, (theta - self.rod.theta[part]) / np.diff(self.rod.theta)[part], 0.0)

        self.still = np.zeros((parts + 1, 3))
        self.rod = self.rod._replace(pinch=self._pinch())

    @cached_property
    def inverse(self) -> Array:
        """Compliance of the sections that are free."""
        return np.linalg.inv(dense_stiffness(self.rod, self.still)[3:-3, 3:-3])

    @cached_property
    def rim(self) -> Array:
        """Displacement of the rim's nodes by the sections that are free, (2 n_rim, 3 n)."""
        return self._rim(np.arange(len(self.part)))

    def _rim(self, nodes: NDArray[np.int64]) -> Array:
        return rim_matrix(self.rod, self.still, self.part[nodes], self.xi[nodes])[1][:, 3:-3]

    def _pinch(self) -> float:
        """What the mesh's rim sinks more than the chain's, far from the load, per bending there; by least squares."""
        theta = self.ring.mesh.rim_theta
        loaded = np.array([int(np.argmin(np.abs(theta - angle))) for angle in LOADED])
        clear = np.flatnonzero((np.abs(theta) > LOADED[0] / 4) & (np.abs(theta) < LOADED[0] * 0.8))
        turned = self.inverse @ self._rim(loaded).T
        columns = (2 * loaded[:, None] + np.arange(2)).ravel()
        rows = (2 * clear[:, None] + np.arange(2)).ravel()
        misfit = (self.ring.rim_block(rows, columns) - self._rim(clear) @ turned).reshape(len(clear), 2, -1)
        outward = np.stack([np.cos(theta[clear]), np.sin(theta[clear])], axis=1)
        sunk = -np.einsum("ni,nim->nm", outward, misfit)
        bend = np.gradient(turned.reshape(-1, 3, turned.shape[1])[:, 2], self.rod.theta[1:-1], axis=0)
        at = theta[clear] % (2 * pi)
        there = np.stack([np.interp(at, self.rod.theta[1:-1], column) for column in bend.T], axis=1)
        return float((sunk * there).sum() / (there * there).sum())

    def modes(self, count: int) -> Array:
        """The slowest vibrations of the undeformed chain, (3 n, count), orthonormal in the mass."""
        weight = np.column_stack([self.rod.mass, self.rod.mass, self.rod.turning])[1:-1].ravel() ** -0.5
        matrix = weight[:, None] * dense_stiffness(self.rod, self.still)[3:-3, 3:-3] * weight
        return weight[:, None] * np.linalg.eigh(matrix)[1][:, :count]

    def compliance_of(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Array:
        """Static displacement of some rim dofs under unit forces on others that the chain lacks."""
        chain = self.rim[rows] @ self.inverse @ self.rim[columns].T
        return self.ring.rim_block(rows, columns) - chain


@lru_cache(maxsize=8)
def _shape(ring: Ring, parts: int) -> _Shape:
    return _Shape(ring, parts)


class ChainRing:
    """The chain of a scene's ring, R = m = g = 1.

    Parameters
    ----------
    scene : Scene
    ring : Ring
    parts : int

    Attributes
    ----------
    rod : Rod
    body : Body
    part, xi : (n_rim,) arrays
        Part of each rim node (-1 over the weld), and where in it.
    vertex : (n_elements,) array
        Angles at which rim elements begin.
    """

    def __init__(self, scene: Scene, ring: Ring, parts: int) -> None:
        self.shape = _shape(ring, parts)
        self.ring = ring
        self.stiffness = membrane_stiffness(scene)
        unit, mass = self.shape.rod, scene.hoop.mass_ratio
        self.rod = unit._replace(
            local=unit.local * self.stiffness,
            across=unit.across * self.stiffness,
            mass=unit.mass * mass,
            turning=unit.turning * mass,
        )
        self.body = make_body(scene, self.rod)
        self.part, self.xi = self.shape.part, self.shape.xi
        self.vertex = np.ascontiguousarray(ring.mesh.rim_theta[::2])

    @property
    def sections(self) -> int:
        """Number of sections that are free."""
        return len(self.rod.theta) - 2

    def nodes(self, first: int, count: int) -> NDArray[np.int64]:
        """Rim nodes of ``count`` elements from ``first`` on."""
        return np.arange(2 * first, 2 * (first + count) + 1) % (2 * len(self.vertex))

    def missing(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Array:
        """Compliance between rim nodes that the chain lacks, (2 rows, 2 columns)."""
        rows, columns = (np.column_stack([2 * nodes, 2 * nodes + 1]).ravel() for nodes in (rows, columns))
        return self.shape.compliance_of(rows, columns) / self.stiffness


__all__ = ["ChainRing", "dense_stiffness", "make_rod", "mass_radius", "rim_matrix"]
