"""The inside of the ring at instants of the march: displacement, velocity, stress and strain energy.

The reduced hoop knows its ring by modes and the rim. Here the same displacement is found at every node,

    u = sum q_i Phi_i + (K^-1 - sum Phi_i Phi_i^T / lambda_i) f,

with f the contact's forces on the rim: on the rim it is what the contact saw, to round-off, but for the dent of a wall
that is not thin (``within`` of :class:`flexible.ring.fem.Ring`), which the mesh spreads over its nodes and the contact
has point by point: on a stiff floor, whose patch is narrower than an element, they are up to twice the patch's depth
apart. The block ``rim`` of fields has the contact's (:mod:`flexible.output.rim`). The levels ``full`` and ``exact``
march with all nodes; for a chain see :mod:`flexible.output.chain_interior`. Many instants are done at once.

Everything is in the disk's frame and in the solver's units, R = m = g = 1; stresses and energy densities are those of
a ring of width R: the scene's ``section_width`` comes in with its units (:mod:`flexible.output.fields`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from meshes import gauss_gradient, nodal_gradient
from meshes.placing import around

from ..models.state import State
from ..ring.fem import Ring
from ..ring.rim.reduction import ReducedRing

Array = NDArray[np.float64]


class Stressed(NamedTuple):
    """What a displacement does to the ring at its nodes, in m g/R^2."""

    stress: Array
    """(n_nodes, 3, n_states) Cauchy's (11, 22, 12)."""
    density: Array
    """(n_nodes, n_states) Strain energy per undeformed volume."""
    along: Array
    """(n_nodes, 2, n_states) Unit vectors in which the circles of the nodes run; of a linear ring those at rest."""


class Interior:
    """Fields of a ring at its nodes, linear elasticity; states hold the displacement of its free dofs.

    Parameters
    ----------
    ring : Ring
    young : float
        E b in m g/R, which is also E of a ring of width R.
    mass : float
        Of the ring over that of the disk.
    """

    def __init__(self, ring: Ring, young: float, mass: float) -> None:
        self.ring, self.mesh = ring, ring.mesh
        self.young, self.mass = young, mass

    def free(self, states: Sequence[State]) -> Array:
        """Displacement of the free dofs, (n_free, n_states)."""
        return np.stack([state.pos[3:] for state in states], axis=1)

    def _static(self, states: Sequence[State]) -> Array:
        """The part of ``free`` whose rate is not a state of the march."""
        return self.free(states) if self.mass == 0 else np.zeros((len(self.ring.free), len(states)))

    def _dynamic_rate(self, states: Sequence[State]) -> Array | float:
        return np.stack([state.vel[3:] for state in states], axis=1) if self.mass > 0 else 0.0

    def displacement(self, states: Sequence[State]) -> Array:
        """Displacement of the nodes, (n_nodes, 2, n_states)."""
        return self._expanded(self.free(states))

    def dent(self, state: State, given: float) -> Array:
        """Of the displacement of the rim's nodes what they have of ``given`` per pressure of the floor, (n_rim, 2)."""
        spread: Array = self._spread.solve(given * self._on_rim(state))
        return spread

    def _on_rim(self, state: State) -> Array:
        """Forces of the floor on the rim's nodes, (n_rim, 2)."""
        load = np.zeros((len(self.mesh.rim_nodes), 2))
        np.add.at(load, (2 * state.window[0] + np.arange(len(state.nodal))) % len(load), state.nodal)
        return load

    @cached_property
    def _spread(self) -> Any:
        return splu(self.ring.rim_products)

    def strained(self, states: Sequence[State]) -> Array:
        """Displacement of the nodes of which the stress is."""
        return self.displacement(states)

    def rate(self, states: Sequence[State], before: Sequence[State], after: Sequence[State]) -> Array:
        """Rate of the displacement seen in the disk's frame, (n_nodes, 2, n_states).

        That of what has inertia is the march's own; the static part has none there, and takes the difference from
        the state ``before`` to the one ``after``.
        """
        elapsed = np.array([b.t - a.t for a, b in zip(before, after, strict=True)])
        change = self._static(after) - self._static(before)
        rate = np.divide(change, elapsed, out=np.zeros_like(change), where=elapsed > 0)
        return self._expanded(rate + self._dynamic_rate(states))

    def _expanded(self, free: Array) -> Array:
        full = np.zeros((self.ring.basis.N, free.shape[1]))
        full[self.ring.free] = free
        return full[self.mesh.node_dofs]

    @cached_property
    def _at_nodes(self) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        return nodal_gradient(self.mesh)

    @cached_property
    def _at_gauss(self) -> tuple[sp.csr_matrix, sp.csr_matrix, Array]:
        return gauss_gradient(self.mesh)

    def stress(self, u: Array) -> Stressed:
        """Stress and strain energy density at the nodes of displacements as above."""
        gradient = _gradient(*self._at_nodes, u)
        strain = self._strain(gradient)
        stress = self._elastic(strain)
        density = (strain * stress).sum(axis=1) / 2
        return Stressed(self._cauchy(gradient, stress), density, self._along(gradient))

    def element_energy(self, u: Array) -> Array:
        """Strain energy of every element, (n_elements, n_states); the sum is the ledger's ring strain.

        But for what is ``within`` (:class:`flexible.ring.fem.Ring`), which a wall that is not thin has here and not in
        the ledger, some 1 % at r = 1.2 and more without mass on a stiff floor; and of a chain, whose mesh is carried
        along, with mass to 0.2 % from r = 1.007 to 1.1, 0.8 % at 1.2 and 3 % where quads are longer than five walls, as
        at 1.005. Without mass, where the contact is within a wall of the weld, a chain's elements have up to 4 % less
        at r = 1.1 and E I = 10, at r = 1.2 3 % at E I = 35 and 9 % at 10 (flexible/chain/README, section 5), and more
        in thicker walls.
        What the corners of the weld yield besides is shared among their elements in proportion to what these have.
        """
        by_y1, by_y2, area = self._at_gauss
        strain = self._strain(_gradient(by_y1, by_y2, u))
        density = (strain * self._elastic(strain)).sum(axis=1) / 2
        energy = (density.reshape(*area.shape, -1) * area[:, :, None]).sum(axis=1)
        by_element = strain.reshape(*area.shape, *strain.shape[1:])
        for elements, root in self._corners:
            here = by_element[elements].reshape(root.shape[1], -1)
            besides = -self.young / 2 * ((root @ here) ** 2).sum(axis=0)
            whole = energy[elements].sum(axis=0)
            energy[elements] *= 1 + np.divide(besides, whole, out=np.zeros_like(whole), where=whole > 0)
        return energy

    @cached_property
    def _corners(self) -> list[tuple[NDArray[np.int64], Array]]:
        """Elements about either corner of the weld, and the root of what it makes of their strains at Gauss points."""
        corners, (by_y1, by_y2, area) = self.ring.corners, self._at_gauss
        found = []
        for which, (elements, dofs) in enumerate(zip(corners.elements, corners.dofs, strict=True)):
            nodes = dofs[::2] // 2
            points = (area.shape[1] * elements[:, None] + np.arange(area.shape[1])).ravel()
            first, second = (by[points][:, nodes].toarray() for by in (by_y1, by_y2))
            strains = np.zeros((len(points), 3, len(nodes), 2))
            strains[:, 0, :, 0], strains[:, 1, :, 1] = first, second
            strains[:, 2, :, 0], strains[:, 2, :, 1] = second, first
            found.append((elements, corners.by_strain(which, strains.reshape(3 * len(points), -1))))
        return found

    def _elastic(self, strain: Array) -> Array:
        """Plane stress of a strain (11, 22, 2 x 12)."""
        nu = self.ring.poisson
        plane, shear = self.young / (1 - nu**2), self.young / (2 * (1 + nu))
        first, second, slide = strain[:, 0], strain[:, 1], strain[:, 2]
        return np.stack([plane * (first + nu * second), plane * (second + nu * first), shear * slide], axis=1)

    def _strain(self, h: Array) -> Array:
        return np.stack([h[:, 0, 0], h[:, 1, 1], h[:, 0, 1] + h[:, 1, 0]], axis=1)

    def _cauchy(self, h: Array, stress: Array) -> Array:
        return stress

    def _along(self, h: Array) -> Array:
        along: Array = np.broadcast_to(around(self.mesh)[:, :, None], (len(h), 2, h.shape[-1]))
        return along


class ReducedInterior(Interior):
    """The same of the reduced hoop, whose ring is known by modes and by the forces on the rim."""

    def __init__(self, reduced: ReducedRing, mass: float) -> None:
        super().__init__(reduced.ring, reduced.stiffness, mass)
        self.reduced = reduced

    def free(self, states: Sequence[State]) -> Array:
        """Displacement of the free dofs, (n_free, n_states)."""
        moved = self._static(states)
        if self.mass > 0:
            moved += self.reduced.shapes @ super().free(states)
        return moved

    def strained(self, states: Sequence[State]) -> Array:
        """With what the left-out modes yield, statically, to weight and to the frame's motion.

        Per unit mass that is -(A + alpha J Y - omega^2 Y). The contact, and so ``displacement``, does without:
        the rim it moves by next to nothing, but it has 1 to 2 % of the stress of a ring that weighs more than its disk,
        and most of that of one that spins fast.
        """
        moved = self.displacement(states)
        if self.mass == 0:
            return moved
        phi, omega = np.array([(state.pos[2], state.vel[2]) for state in states]).T
        along, up, alpha = np.array([state.acc[:3] for state in states]).T
        s, c, ax, ay = np.sin(phi), np.cos(phi), along + alpha, up + 1
        accelerated = np.stack([ax * s + ay * c, ax * c - ay * s, alpha, -(omega**2)])
        return moved + self._expanded(self._yielding @ accelerated)

    @cached_property
    def _yielding(self) -> Array:
        """What the left-out modes yield to unit accelerations along y1, y2, J Y and Y; (n_free, 4)."""
        ring, shapes = self.ring, self.reduced.shapes
        fields = [ring.translation(0), ring.translation(1), ring.turned(ring.position_field), ring.position_field]
        load = -self.mass * (ring.mass @ np.column_stack(fields))[ring.free]
        moved: Array = ring.solve(load) / self.young
        return moved - shapes @ ((shapes.T @ load) / self.reduced.frame.modal[:, :1])

    def _on_rim(self, state: State) -> Array:
        return self.reduced.on_mesh(state.window, state.nodal).reshape(-1, 2)

    def _static(self, states: Sequence[State]) -> Array:
        load = np.zeros((len(self.ring.free), len(states)))
        for column, state in zip(load.T, states, strict=True):
            column[self.ring.rim_dofs] = self._on_rim(state).ravel()
        moved: Array = self.ring.solve(load)
        if self.mass > 0:
            shapes = self.reduced.shapes
            return moved / self.young - shapes @ ((shapes.T @ load) / self.reduced.frame.modal[:, :1])
        return moved / self.young

    def _dynamic_rate(self, states: Sequence[State]) -> Array | float:
        rates = super()._dynamic_rate(states)
        return self.reduced.shapes @ rates if self.mass > 0 else rates


class ExactInterior(Interior):
    """The same of the geometrically exact ring: Green's strain, and Cauchy's stress F S F^T / det F."""

    def _strain(self, h: Array) -> Array:
        square = np.einsum("nkis,nkjs->nijs", h, h)
        return super()._strain(h) + super()._strain(square) / 2

    def _cauchy(self, h: Array, stress: Array) -> Array:
        f = h + np.eye(2)[None, :, :, None]
        tensor = stress[:, [[0, 2], [2, 1]]]
        turned = np.einsum("niks,nkls,njls->nijs", f, tensor, f)
        turned /= (f[:, 0, 0] * f[:, 1, 1] - f[:, 0, 1] * f[:, 1, 0])[:, None, None]
        return np.stack([turned[:, 0, 0], turned[:, 1, 1], turned[:, 0, 1]], axis=1)

    def _along(self, h: Array) -> Array:
        at_rest = super()._along(h)
        line = at_rest + np.einsum("nijs,njs->nis", h, at_rest)
        along: Array = line / np.linalg.norm(line, axis=1, keepdims=True)
        return along


def _gradient(by_y1: sp.csr_matrix, by_y2: sp.csr_matrix, u: Array) -> Array:
    """H_ij = du_i/dy_j, (n, 2, 2, n_states)."""
    flat = u.reshape(len(u), -1)
    return np.stack([(by @ flat).reshape(-1, *u.shape[1:]) for by in (by_y1, by_y2)], axis=2)
