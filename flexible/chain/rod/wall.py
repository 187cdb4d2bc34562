"""The wall beside the weld on the quads of the mesh, with Green's strain, and where a section of it stands.

It is loaded by dead forces far behind a section, where the linear ring passes its forces on. Such a load does not turn
with the wall, and what that does besides has faded some walls before it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from meshes import RingMesh

from ...ring.exact import elasticity_of
from ...ring.fem import Ring
from .section import FADING, RodCompliance, radial, transfer

Array = NDArray[np.float64]

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


class Wall:
    """The wall from the weld to some walls behind a section, whose forces are polynomials of its displacement.

    Displacements are of all free dofs of the ring, those away from this wall zero.

    Parameters
    ----------
    ring : Ring
    compliance : RodCompliance
        Of that ring.
    theta : float
        Angle of the section.

    Attributes
    ----------
    fields : (n_free, 3) array
        Displacement to first order under a force (y1, y2) and a moment on the section.
    line : Line
        The section.
    """

    def __init__(self, ring: Ring, compliance: RodCompliance, theta: float) -> None:
        mesh = ring.mesh
        self._whole, self._nodes = elasticity_of(ring), mesh.node_dofs
        vertex = mesh.rim_theta[::2]
        loaded = float(vertex[vertex > theta + FADING * (1 - mesh.inner / mesh.outer)][0])
        self._near = self._whole.of(np.flatnonzero(np.abs(mesh.theta[mesh.quad9[:, 8]]) < loaded))
        self._dofs = np.flatnonzero(np.isin(self._whole.free, self._near.dofs))
        self._stiffness = self._near.tangent(np.zeros(len(self._whole.free)))
        self._factors = splu(self._stiffness[self._dofs][:, self._dofs].tocsc())
        self.fields = np.zeros((len(self._whole.free), 3))
        loads = np.linalg.inv(transfer(compliance.radius, theta, compliance.weld).T)
        self.fields[self._dofs] = compliance.answers[self._dofs, :3] @ loads
        self.line = Line(mesh, compliance.radius, theta)

    def at_nodes(self, u: Array) -> Array:
        """(n_nodes, 2) of what is given at the free dofs."""
        full = np.zeros(self._whole.size)
        full[self._whole.free] = u
        return np.asarray(full[self._nodes])

    def linear(self, u: Array) -> Array:
        """Forces of first order."""
        return np.asarray(self._stiffness @ u)

    def square(self, one: Array, two: Array) -> Array:
        """Forces of second order, by two displacements."""

        def even(u: Array) -> Array:
            return np.asarray(self._near.forces(u) + self._near.forces(-u))

        return (even(one + two) - even(one - two)) / 8

    def cube(self, u: Array) -> Array:
        """Forces of third order, all that are left."""
        return np.asarray((self._near.forces(u) - self._near.forces(-u)) / 2 - self.linear(u))

    @cached_property
    def second(self) -> Array:
        """(n_free, 3, 3): displacement to second order under two of the loads that make the fields."""
        size = np.abs(self.fields).max(axis=0)
        one, bent = self.fields / size, np.empty((len(self.fields), 3, 3))
        for a in range(3):
            for b in range(a + 1):
                both = -size[a] * size[b] * self.under(self.square(one[:, a], one[:, b]))
                bent[:, a, b] = bent[:, b, a] = both
        return bent

    def under(self, load: Array) -> Array:
        """Displacement to first order under forces."""
        u = np.zeros(len(load))
        u[self._dofs] = self._factors.solve(load[self._dofs])
        return u


def wall_beside(compliance: RodCompliance, theta: float) -> Wall:
    """The wall beside the weld of a ring, with the section at ``theta``; made once."""
    return compliance.ring.once(Wall, compliance, theta)


class Line:
    """The points of a section's undeformed line, by those of the mesh.

    A section that the wall bends and shears is no straight line, nor as thick as it was. It stands where a mean of its
    points does, seen by itself: across the wall the one on which a shear force does work, a parabola's, along it the
    plain one; and it turns as its points turn about their mean.

    Parameters
    ----------
    mesh : RingMesh
    radius : float
        Of the centres of mass.
    theta : float
        Angle of the section, from -pi to pi.
    """

    def __init__(self, mesh: RingMesh, radius: float, theta: float) -> None:
        vertex = mesh.rim_theta[::2]
        i = int(np.searchsorted(vertex, theta, side="right")) - 1
        low, high = vertex[i], vertex[(i + 1) % len(vertex)]
        x = 2 * (theta - low) / (high - low) - 1
        self.nodes = mesh.grid[:, 2 * i + np.arange(3)]
        self.shape = quadratic(x)
        self.outward = radial(theta)
        self.onward = np.array([-self.outward[1], self.outward[0]])
        z = mesh.radius[mesh.grid[:, 0]] / mesh.outer - radius
        middle, half = (z[0] + z[-1]) / 2, (z[-1] - z[0]) / 2
        self.along = _weights(z, np.ones_like)
        self.across = _weights(z, lambda at: 1 - ((at - middle) / half) ** 2)
        lever = self.along * (z - self.along @ z)
        self.turn = lever / (lever @ z)
        self.height = z
        self.offsets = float(self.across @ z), float(self.along @ z)

    def mean(self, u: Array) -> Array:
        """Displacement (y1, y2) and rotation, to first order, of nodes' displacements."""
        outward, onward = self._parts(u)
        turn = self.turn @ onward
        across, along = self.across @ outward, self.along @ onward - self.offsets[1] * turn
        return np.array([*(across * self.outward + along * self.onward), turn])

    def place(self, u: Array) -> Array:
        """Displacement (y1, y2) and rotation, however far nodes are displaced."""
        outward, onward = self._parts(u)
        outward = outward + self.height
        angle = np.arctan2(self.turn @ onward, self.turn @ outward)
        c, s = np.cos(angle), np.sin(angle)
        across = self.across @ (c * outward + s * onward) - self.offsets[0]
        along = self.along @ (c * onward - s * outward)
        turned = c * self.outward + s * self.onward, c * self.onward - s * self.outward
        return np.array([*(across * turned[0] + along * turned[1]), angle])

    def _parts(self, u: Array) -> Array:
        """Displacement outward and onward of the line's points, (2, n)."""
        here = np.einsum("nki,k->ni", u[self.nodes], self.shape)
        return np.stack([here @ self.outward, here @ self.onward])


def quadratic(x: Array | float) -> Array:
    """The shape functions of three nodes from -1 to 1, (..., 3)."""
    return np.stack([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2], axis=-1)


def crossed(one: Array, two: Array) -> Array:
    """Moments of forces ``two`` by arms ``one``, (...)."""
    return np.asarray(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])


def _weights(z: Array, density: Callable[[Array], Array]) -> Array:
    """Weights of the nodes for the mean, of a density, of what is quadratic between every other of them."""
    weights = np.zeros_like(z)
    shapes = quadratic(_POINTS).T
    for k in range(1, len(z), 2):
        half = (z[k + 1] - z[k - 1]) / 2
        weights[k - 1 : k + 2] += shapes @ (half * _WEIGHTS * density(z[k] + half * _POINTS))
    return np.asarray(weights / weights.sum())
