"""The ring as a chain of parts: a geometrically exact ring of a few hundred unknowns, condensed from the quads.

Each part is a rod with the compliance that :mod:`flexible.chain.rod.section` measured on the mesh, exact for the small
bending within it; :mod:`flexible.chain.rod.corotated` makes it turn and move far. What a rod lacks, the giving way of
the wall right under a load on the rim, is a static compliance: that of the mesh minus that of the undeformed chain, for
rim nodes near each other. The chain's answer to small loads on the rim is therefore that of the mesh to round-off; what
is left is the fourth power of the rotation within a part, the inertia of what is smaller, and strain that is not small.
"""

from __future__ import annotations

from functools import cached_property
from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csr_array

from rigid import Scene

from ..ring.choice import AROUND
from ..ring.fem import Ring, membrane_stiffness
from ..ring.frame import body_of
from ..ring.mirror import positive_part
from ..ring.rim.even import EvenRim, parts_of
from .bordered import no_blocks
from .corner import bow_of_rim
from .mass.ends import EndMass, end_mass
from .mass.inertia import Chain, ChainBody
from .rim import RimNodes, follow
from .rod.corotated import Rod
from .rod.ends import chord_strains
from .rod.parts import FINER, make_rod
from .rod.section import LOADED, is_slender, rod_compliance
from .rod.tangent import elastic_tangent

Array = NDArray[np.float64]

PULLED = (*LOADED, 2.6, -2.6)  # angles of loads far away: of six alone one pair may strain the ends as another does
PARTS = 2  # into which an element of an even rim is cut
PRESSED = 0.4  # walls by which a slender ring yields to p/E: 13/32 beside a beam's middle, along it (1 + nu)/4


def make_body(scene: Scene, rod: Rod) -> ChainBody:
    """What of the hoop moves with the frame; together with the rod's sections it has the ring's mass and inertia."""
    whole = body_of(scene)
    square = (rod.place**2).sum(axis=1)
    return ChainBody(
        whole.offset,
        whole.disk_inertia,
        float(whole.ring_mass - rod.mass.sum()),
        float(-(rod.mass @ rod.place[:, 0])),
        float(whole.ring_inertia - rod.mass @ square - rod.turning.sum()),
        whole.ring_mass,
    )


def dense_stiffness(rod: Rod, q: Array) -> Array:
    """Stiffness of the chain at some displacement, (3 (n + 2), 3 (n + 2))."""
    sections = len(rod.theta)
    blocks = no_blocks(sections)
    elastic_tangent(rod, q, blocks.diagonal, blocks.up, blocks.down)
    matrix = np.zeros((sections, 3, sections, 3))
    i = np.arange(sections)
    matrix[i, :, i, :] = blocks.diagonal
    here, there = i[:-1], np.append(i[1:-1], 1)  # behind the last free section comes the first
    matrix[here, :, there, :] += blocks.up
    matrix[there, :, here, :] += blocks.down
    return matrix.reshape(3 * sections, 3 * sections)


def inverse_of(strains: Array) -> Array:
    """Of the strains at the weld under more loads than there are strains, by least squares."""
    size = np.abs(strains).max(axis=1)
    return np.asarray(np.linalg.pinv(strains / size[:, None]) / size, dtype=float)


def beside_weld(count: int) -> NDArray[np.int64]:
    """Which of so many coordinates are those of the first free section and of the last, (6,)."""
    return np.r_[0:3, count - 3 : count]


def mass_matrix(rod: Rod, ends: EndMass) -> Array:
    """Of the free sections, (3 n, 3 n)."""
    matrix = np.diag(np.column_stack([rod.mass, rod.mass, rod.turning])[1:-1].ravel())
    beside = beside_weld(len(matrix))
    matrix[np.ix_(beside, beside)] += ends.mass
    return matrix


def rim_matrix(rod: Rod, q: Array, nodes: RimNodes) -> tuple[Array, csr_array, Array]:
    """Displacement of nodes of the rim, (m, 2), its derivatives by the free sections, (2 m, 3 n), rotation there, (m,).

    A node follows the four sections around it and those beside the weld.
    """
    moved, by, turn = follow(rod, q, nodes)
    free = 3 * (len(rod.theta) - 2)
    around = 3 * (nodes.part[:, None] - 2) + np.arange(12)  # the first of them is two before the part's
    beside = np.broadcast_to([0, 1, 2, *range(free - 3, free)], (len(moved), 6))
    column = np.repeat(np.concatenate([around, beside], axis=1)[:, None], 2, axis=1)
    row = np.broadcast_to(np.arange(2 * len(moved)).reshape(-1, 2, 1), column.shape)
    known = (column >= 0) & (column < free) & ((nodes.part[:, None, None] >= 0) | (np.arange(18) >= 12))
    place = row[known], column[known]
    return moved, csr_array((by[known], place), shape=(2 * len(moved), free)), turn


def _end_without_a_step(root: Array, theta: Array, begin: float, end: float) -> None:
    """Let what the strains at the weld move of the rim's nodes end at the first section with nothing.

    There the rim of a thick ring passes from where the mesh has it to where the sections have it, which would be a step
    of some thousandths of what the ring gives way by, and many times what a stiff floor does. It passes in the outer
    half of the stretch from the weld to the first section, where what the weld itself does to the wall has faded.
    """
    middle = (begin + end) / 2
    for side in (-1, 1):
        at = np.flatnonzero((side * theta >= middle) & (side * theta <= end + 1e-9))
        at = at[np.argsort(side * theta[at])]
        x = ((side * theta[at] - middle) / (end - middle))[:, None, None]
        root[at] -= x**2 * (3 - 2 * x) * root[at[-1]]
    root[np.abs(theta) > end] = 0.0


class _Shape:
    """What of a chain depends on its shape alone: at E b = 1 and unit mass."""

    def __init__(self, ring: Ring, parts: int, finer: int = 0) -> None:
        mesh = ring.mesh
        self.ring = ring
        self.even = EvenRim(ring, finer) if finer else None
        self.theta = mesh.rim_theta if self.even is None else self.even.theta
        self.compliance = rod_compliance(ring, 2 * (pi - mesh.weld_half_angle) / parts / FINER)
        self.rod = make_rod(self.compliance, ring, parts)
        self.ends = end_mass(self.compliance, float(self.rod.theta[1]))
        theta = self.theta % (2 * pi)
        inside = np.minimum(theta, 2 * pi - theta) > mesh.weld_half_angle + 1e-12
        part = np.clip(np.searchsorted(self.rod.theta, theta, side="right") - 1, 0, parts - 1)
        xi = (theta - self.rod.theta[part]) / np.diff(self.rod.theta)[part]
        self.still = np.zeros((parts + 1, 3))
        root, bow = np.zeros((len(theta), 2, 6)), np.zeros((len(theta), 2, 2, 3, 3))
        self.nodes = RimNodes(np.where(inside, part, -1), np.where(inside, xi, 0.0), root, bow)
        self.slender = is_slender(ring)
        if not self.slender:
            self._complete()

    @cached_property
    def inverse(self) -> Array:
        """Compliance of the sections that are free."""
        inverse = np.linalg.inv(dense_stiffness(self.rod, self.still)[3:-3, 3:-3])
        return np.asarray(inverse, dtype=float)

    def _complete(self) -> None:
        """How the rim near the weld moves with the first and the last part under loads far away, by least squares.

        All else of it the chain has, see :mod:`flexible.chain.rod.surface`.
        """
        theta = (self.theta + pi) % (2 * pi) - pi
        by_sections = rim_matrix(self.rod, self.still, self.nodes)[1]
        loaded = np.array([int(np.argmin(np.abs(self.ring.mesh.rim_theta - angle))) for angle in PULLED])
        pressed = self.from_mesh(self.ring.pressed(dofs_of(loaded)))
        columns = dofs_of(self.at(loaded))
        turned = self.inverse @ by_sections[columns].T
        misfit = (pressed - by_sections @ turned).reshape(len(theta), 2, len(columns))
        first, last = turned[:3], turned[-3:]
        place = self.rod.place
        strains = [chord_strains(place[0], place[1], 2) @ first, chord_strains(place[-2], place[-1], 1) @ last]
        root = misfit @ inverse_of(np.concatenate(strains))
        _end_without_a_step(root, theta, self.ring.mesh.weld_half_angle, self.compliance.weld)
        self.nodes = self.nodes._replace(root=np.ascontiguousarray(root))
        if self.ring.mesh.weld_half_angle > 1 - self.ring.mesh.inner / self.ring.mesh.outer:
            self.nodes = self.nodes._replace(
                bow=bow_of_rim(self.rod, self.compliance, self.nodes, self.from_mesh, theta)
            )

    def at(self, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Which nodes of the rim those of the mesh's are."""
        return nodes if self.even is None else self.even.parts * nodes

    def from_mesh(self, moved: Array) -> Array:
        """Displacement of the rim's nodes, (2 n_rim, .), by that of the mesh's."""
        return moved if self.even is None else np.asarray(self.even.curve @ moved)

    def to_mesh(self, load: Array) -> Array:
        """Forces on the mesh's nodes by those on the rim's, (2 n_rim,)."""
        return load if self.even is None else np.asarray(self.even.curve.T @ load)

    @cached_property
    def rim(self) -> csr_array:
        """Displacement of the rim's nodes by the sections that are free, (2 n_rim, 3 n)."""
        return rim_matrix(self.rod, self.still, self.nodes)[1]

    @cached_property
    def shapes(self) -> Array:
        """Vibrations of the undeformed chain, (3 n, 3 n), the slowest first, orthonormal in the mass."""
        stiffness = dense_stiffness(self.rod, self.still)[3:-3, 3:-3]
        return np.asarray(eigh(stiffness, mass_matrix(self.rod, self.ends), driver="gvd")[1], dtype=float)

    @cached_property
    def missing(self) -> Array:
        """Static displacement of the rim under unit forces on it that the chain lacks, (2 n_rim, 2 n_rim).

        Right over a section the chain gives way a little more than the mesh, for a load on the rim spreads over half a
        wall before it bends the ring. A wall does not push back: the positive part is kept, less what the contact has.
        Long quads in a thin wall are stiffer than it here and softer there, by many times what it is dented: such a one
        is pressed as a beam is.
        """
        if self.slender:
            wall = 1 - self.ring.mesh.inner / self.ring.mesh.outer
            spread = np.linalg.inv(self.ring.rim_products.toarray())
            return np.asarray(PRESSED * wall * np.kron(spread, np.eye(2)), dtype=float)
        held = self.rim @ self.inverse @ self.rim.T
        if self.even is not None:
            own = self.even.compliance
            own -= held
            del held  # each is 120 MB of 480 elements
            return positive_part(own, self.even.mirror)
        return positive_part(
            self.ring.rim_compliance - np.kron(self.ring.given_within, np.eye(2)) - held, self.ring.mirror
        )


def dofs_of(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Components of nodes of the rim, (2 m,)."""
    return (2 * nodes[:, None] + np.arange(2)).ravel()


class ChainRing:
    """The chain of a scene's ring, R = m = g = 1.

    Parameters
    ----------
    scene : Scene
    ring : Ring
    parts : int

    Attributes
    ----------
    chain : Chain
    nodes : RimNodes
        Of the whole rim.
    vertex : (n_elements,) array
        Angles at which rim elements begin: the mesh's, or those of a rim that is even, which are more.
    within : float
        See :class:`flexible.models.rim_contact.RimContact`.
    """

    def __init__(self, scene: Scene, ring: Ring, parts: int) -> None:
        around = ring.mesh.around
        finer = parts_of(scene, around, PARTS) if around >= AROUND else 0  # one element over half the weld is too few
        self.shape = ring.once(_Shape, parts, finer)
        self.ring = ring
        self.stiffness = membrane_stiffness(scene)
        self.within = (self.shape.even or ring).within / self.stiffness
        unit, mass = self.shape.rod, scene.hoop.mass_ratio
        rod = unit._replace(
            local=unit.local * self.stiffness,
            pulled=unit.pulled * self.stiffness,
            softening=unit.softening * self.stiffness,
            across=unit.across * self.stiffness,
            bent=unit.bent * self.stiffness,
            far=unit.far * self.stiffness,
            fading=unit.fading / self.stiffness,
            mass=unit.mass * mass,
            turning=unit.turning * mass,
        )
        ends = EndMass(*(mass * entry for entry in self.shape.ends))
        self.chain = Chain(make_body(scene, rod), rod, ends)
        self.nodes = self.shape.nodes
        self.vertex = np.ascontiguousarray(self.shape.theta[::2])
        self._windows: dict[tuple[int, int], tuple[NDArray[np.int64], RimNodes]] = {}

    @property
    def sections(self) -> int:
        """Number of sections that are free."""
        return len(self.chain.rod.theta) - 2

    def window(self, first: int, count: int) -> tuple[NDArray[np.int64], RimNodes]:
        """Rim nodes of ``count`` elements from ``first`` on: their numbers, and what they follow."""
        key = (first % len(self.vertex), count)
        if key not in self._windows:
            number = np.arange(2 * key[0], 2 * (key[0] + count) + 1) % (2 * len(self.vertex))
            every = self.nodes
            self._windows[key] = (
                number,
                RimNodes(every.part[number], every.xi[number], every.root[number], every.bow[number]),
            )
        return self._windows[key]

    def missing(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Array:
        """Compliance between rim nodes that the chain lacks, (2 rows, 2 columns)."""
        return self.shape.missing[np.ix_(dofs_of(rows), dofs_of(columns))] / self.stiffness


__all__ = ["ChainRing", "dense_stiffness", "make_rod", "rim_matrix"]
