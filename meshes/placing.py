"""From the disk's frame to the world, and from there to the fields that people look at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rigid import Scene

from .ring import RingMesh

Array = NDArray[np.float64]

SEEN = 0.025
"""Radius over R with which a disk is drawn at least: a point mass has to be seen too."""


@dataclass(frozen=True)
class Placement:
    """Where the disk's frame is: angle ``phi`` (clockwise from the top) and the hoop's centre C in the world.

    ``y1`` points to the disk, along (sin phi, cos phi) in the world; ``y2`` is 90 degrees clockwise from it,
    along (cos phi, -sin phi).
    """

    phi: float
    x_C: float
    y_C: float

    @property
    def axes(self) -> Array:
        """(2, 2): the directions of y1 and y2 in the world, one per row."""
        sin, cos = np.sin(self.phi), np.cos(self.phi)
        return np.array([[sin, cos], [cos, -sin]])

    def points(self, y: Array) -> Array:
        """World positions of points ``y`` (n, 2) of the disk's frame."""
        return np.array([self.x_C, self.y_C]) + y @ self.axes

    def vectors(self, u: Array) -> Array:
        """World components of vectors ``u`` (n, 2)."""
        return u @ self.axes

    def velocities(self, y: Array, u: Array, u_rate: Array, velocity_C: ArrayLike, omega: float) -> Array:
        """World velocities of points ``y`` displaced by ``u``, both (n, 2), the frame turning with ``omega``.

        ``u_rate`` is the rate of ``u`` seen in the frame, ``velocity_C`` the world velocity of C.
        """
        first, second = self.axes
        at = y + u
        turning = omega * (at[:, :1] * second - at[:, 1:] * first)
        return np.asarray(velocity_C, dtype=float) + turning + u_rate @ self.axes

    def stress(self, stress: Array) -> Array:
        """World components (xx, yy, xy) of a stress given by its components (11, 22, 12), (n, 3)."""
        (x1, y1), (x2, y2) = self.axes
        of_11, of_22 = (x1 * x1, y1 * y1, x1 * y1), (x2 * x2, y2 * y2, x2 * y2)
        of_12 = (2 * x1 * x2, 2 * y1 * y2, x1 * y2 + x2 * y1)
        return stress @ np.array([of_11, of_22, of_12])


def disk_in(scene: Scene) -> tuple[float, float]:
    """Distance of the disk's centre from the hoop's, and the radius with which it is drawn against the wall; over R.

    The distance is that of the motion: where r = 1, and the wall is the elastic hoop's alone, a disk of k R would lie
    in it, and is drawn with less. One too small to be seen is drawn larger, and farther in.
    """
    inner, distance = 1 - scene.wall, (1 - scene.hoop.k) / scene.hoop.r
    if inner - distance < SEEN:
        return inner - SEEN, SEEN
    return distance, inner - distance


def von_mises(stress: ArrayLike) -> Array:
    """Von Mises stress of plane stress components (11, 22, 12), (n, 3) or of one place (3,); the same in any frame.

    Raises
    ------
    ValueError
        Another shape.
    """
    stress = np.asarray(stress, dtype=float)
    if stress.ndim not in (1, 2) or stress.shape[-1] != 3:
        raise ValueError(f"stress of shape {stress.shape} is not possible: a row is the components 11, 22 and 12.")
    s1, s2, s12 = stress.T
    return np.sqrt(s1**2 - s1 * s2 + s2**2 + 3 * s12**2)


def around(ring: RingMesh) -> Array:
    """(n_nodes, 2) Unit vectors along the circles about the centre on which the nodes lie."""
    return np.column_stack([-np.sin(ring.theta), np.cos(ring.theta)])


def hoop_stress(ring: RingMesh, stress: ArrayLike, along: ArrayLike | None = None) -> Array:
    """Stress along the wall at the nodes, from components (11, 22, 12) in the disk's frame, (n_nodes, 3).

    ``along``, (n_nodes, 2), are the unit vectors in which the circles of the nodes run now; by default, and so of small
    displacements, those of the ring at rest.

    Raises
    ------
    ValueError
        Not one row for each node.
    """
    stress, along = (np.asarray(given, dtype=float) for given in (stress, around(ring) if along is None else along))
    for name, given, columns in (("stress", stress, 3), ("along", along, 2)):
        if given.shape != (len(ring.theta), columns):
            raise ValueError(
                f"{name} of shape {given.shape} is not possible: it has {columns} components for each of "
                f"{len(ring.theta)} nodes."
            )
    a1, a2 = along.T
    s1, s2, s12 = stress.T
    return s1 * a1**2 + s2 * a2**2 + 2 * s12 * a1 * a2


def bending_stress(ring: RingMesh, hoop: ArrayLike) -> Array:
    """What the hoop stress, (n_nodes,), has beyond its mean through the wall (Simpson's rule over the layers of nodes).

    Raises
    ------
    ValueError
        Not one number for each node.
    """
    hoop = np.asarray(hoop, dtype=float)
    if hoop.shape != (len(ring.theta),):
        raise ValueError(
            f"hoop of shape {hoop.shape} is not possible: it has one stress for each of {len(ring.theta)} nodes."
        )
    radii = ring.radius[ring.grid[:, 0]]
    weights = np.zeros(len(radii))
    for share, first in ((1.0, 0), (4.0, 1), (1.0, 2)):
        weights[first : len(radii) - 2 + first : 2] += share * np.diff(radii[::2])
    through = hoop[ring.grid]
    bending = np.empty(np.shape(hoop))
    bending[ring.grid] = through - weights @ through / weights.sum()
    return bending
