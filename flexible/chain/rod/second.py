"""How a section near the weld moves under forces to second order, on the quads of the mesh with Green's strain.

To first order it moves by v_a f_a under loads f, to second by v_ab f_a f_b more. The second-order fields solve
K u_ab = -r(u_a, u_b), r what Green's strain bears of the second order in the linear fields. Only the wall near the weld
is solved for, loaded where the linear ring passes its forces on. Such a load does not turn with the wall, and what that
does besides has faded some walls before it.

A section that the wall bends and shears is no straight line, nor as thick as it was. It stands where a mean of its
points does, seen by itself: across the wall the one on which a shear force does work, a parabola's, along it the plain
one; and it turns as its points turn about their mean.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from meshes import RingMesh

from ...ring.exact import elasticity_of
from ...ring.fem import Ring
from .section import FADING, RodCompliance, radial, transfer

Array = NDArray[np.float64]

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


class SecondOrder(NamedTuple):
    """What a section answers to a force (y1, y2) on it and a moment; symmetric in the two loads that are last.

    Attributes
    ----------
    first : (3, 3) array
        Its displacement (y1, y2) and rotation, by the load.
    second : (3, 3, 3) array
        The same to second order, by two loads.
    rim : (n_rim, 2, 3, 3) array
        Displacement of the rim's nodes to second order.
    moment : (3, 3) array
        By how much the moment about the displaced section is more than the load, by two loads.
    """

    first: Array
    second: Array
    rim: Array
    moment: Array


def second_order(compliance: RodCompliance, theta: float) -> SecondOrder:
    """Answers of the section at ``theta``, loaded by dead forces far behind it; found once."""
    return compliance.ring.once(_answers, compliance, theta)


def _answers(ring: Ring, compliance: RodCompliance, theta: float) -> SecondOrder:
    mesh, wall, whole = ring.mesh, 1 - ring.mesh.inner / ring.mesh.outer, elasticity_of(ring)
    vertex = mesh.rim_theta[::2]
    loaded = float(vertex[vertex > theta + FADING * wall][0])
    near = whole.of(np.flatnonzero(np.abs(mesh.theta[mesh.quad9[:, 8]]) < loaded))
    dofs = np.flatnonzero(np.isin(whole.free, near.dofs))
    stiffness = near.tangent(np.zeros(len(whole.free)))
    solve = splu(stiffness[dofs][:, dofs].tocsc()).solve

    fields = np.zeros((len(whole.free), 3))
    fields[dofs] = compliance.answers[dofs, :3] @ np.linalg.inv(transfer(compliance.radius, theta, compliance.weld).T)
    size = np.abs(fields).max(axis=0)
    fields /= size

    def square(u: Array) -> Array:
        return (near.forces(u) + near.forces(-u)) / 2

    def at_nodes(u: Array) -> Array:
        full = np.zeros(whole.size)
        full[whole.free] = u
        return full[mesh.node_dofs]

    line = Line(mesh, compliance.radius, theta)
    moved = [at_nodes(u) for u in fields.T]
    borne = [at_nodes(stiffness @ u) for u in fields.T]
    first = np.stack([line.mean(u) for u in moved], axis=1)
    second, moment = np.empty((3, 3, 3)), np.empty((3, 3))
    rim = np.empty((len(mesh.rim_theta), 2, 3, 3))
    for a in range(3):
        for b in range(a + 1):
            bent = np.zeros(len(fields))
            bent[dofs] = -solve((square(fields[:, a] + fields[:, b]) - square(fields[:, a] - fields[:, b]))[dofs] / 4)
            second[:, a, b] = second[:, b, a] = line.mean(at_nodes(bent)) + line.turned(moved[a], moved[b])
            rim[..., a, b] = rim[..., b, a] = at_nodes(bent)[mesh.rim_nodes]
            one = _crossed(moved[a] - first[:2, a], borne[b]).sum()
            moment[a, b] = moment[b, a] = (one + _crossed(moved[b] - first[:2, b], borne[a]).sum()) / 2
    both = np.outer(size, size)
    return SecondOrder(first * size, second * both, rim * both, moment * both)


class Line:
    """The points of a section's undeformed line, by those of the mesh.

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
        self.offsets = float(self.across @ z), float(self.along @ z)

    def mean(self, u: Array) -> Array:
        """Displacement (y1, y2) and rotation, to first order, of nodes' displacements."""
        outward, onward = self._parts(u)
        turn = self.turn @ onward
        return self._place(self.across @ outward, self.along @ onward - self.offsets[1] * turn, turn)

    def _parts(self, u: Array) -> Array:
        """Displacement outward and onward of the line's points, (2, n)."""
        here = np.einsum("nki,k->ni", u[self.nodes], self.shape)
        return np.stack([here @ self.outward, here @ self.onward])

    def _place(self, outward: float, onward: float, turn: float) -> Array:
        return np.array([*(outward * self.outward + onward * self.onward), turn])

    def turned(self, one: Array, two: Array) -> Array:
        """What its means are more, seen by the line that turned, than along where it was: by two displacements."""
        total = np.zeros(3)
        for first, second in ((one, two), (two, one)):
            turn = self.turn @ self._parts(first)[1]
            outward, onward = self._parts(second)
            thicker = -turn * (self.turn @ outward)
            shear = self.across @ onward - self.along @ onward
            bow = self.along @ outward - self.across @ outward
            lever = (self.offsets[1] - self.offsets[0] / 2) * (self.turn @ onward)
            total += self._place(turn * (shear + lever), -turn * bow - self.offsets[1] * thicker, thicker)
        return total / 2


def quadratic(x: Array | float) -> Array:
    """The shape functions of three nodes from -1 to 1, (..., 3)."""
    return np.stack([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2], axis=-1)


def _weights(z: Array, density: Callable[[Array], Array]) -> Array:
    """Weights of the nodes for the mean, of a density, of what is quadratic between every other of them."""
    weights = np.zeros_like(z)
    shapes = quadratic(_POINTS).T
    for k in range(1, len(z), 2):
        half = (z[k + 1] - z[k - 1]) / 2
        weights[k - 1 : k + 2] += shapes @ (half * _WEIGHTS * density(z[k] + half * _POINTS))
    return np.asarray(weights / weights.sum())


def _crossed(one: Array, two: Array) -> Array:
    return np.asarray(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
