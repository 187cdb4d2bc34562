"""Mass of the wall between the weld and the sections beside it.

A ring's mass sits at its sections, half of that of each part beside them, but for that of the first and the last part:
in a thick wall they are a sixth of the ring, for so far reaches what the weld does to the wall. Their wall moves as the
mesh does under forces on the two sections, W times these sections' six coordinates (Guyan's condensation), and its
inertia is that of this motion. Half of it at the section, frequencies of a ring of r = 1.12 were 1 to 2 % off from the
fifth to the fifteenth; so it is 0.1 %.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..rod.ends import MIRROR
from ..rod.section import RodCompliance, transfer
from ..rod.wall import Line, quadratic

Array = NDArray[np.float64]

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


class EndMass(NamedTuple):
    """Integrals over the mass of the wall beside the weld of its motion W, (2, 6), and its places Y, (2,).

    J turns by a right angle, (y1, y2) to (-y2, y1).

    Attributes
    ----------
    mass, gyro : (6, 6) arrays
        Of W'W and of W'JW.
    first : (2, 6) array
        Of W.
    stretching, turning : (6,) arrays
        Of W'Y and of W'JY.
    """

    mass: Array
    gyro: Array
    first: Array
    stretching: Array
    turning: Array


def end_mass(compliance: RodCompliance, theta: float) -> EndMass:
    """That of the wall between the sections at -``theta`` and ``theta``, of a ring of unit mass."""
    ring = compliance.ring
    mesh, radius = ring.mesh, compliance.radius
    away = np.linalg.inv(transfer(radius, theta, compliance.weld)).T
    full = np.zeros((ring.basis.N, 6))
    full[ring.free, :3] = compliance.answers[:, :3] @ away
    full[ring.free, 3:] = compliance.answers[:, 3:] @ (MIRROR @ away @ MIRROR)
    moved = full[mesh.node_dofs]
    lines = Line(mesh, radius, theta), Line(mesh, radius, -theta)
    sections = np.stack([np.concatenate([line.mean(u) for line in lines]) for u in np.moveaxis(moved, 2, 0)], axis=1)
    places, shapes, weights = _points(compliance, theta)
    way = np.einsum("nk,nkac->nac", shapes, moved[places[0]] @ np.linalg.inv(sections))
    y = places[1]
    jy, jway = np.stack([-y[:, 1], y[:, 0]], axis=1), np.stack([-way[:, 1], way[:, 0]], axis=1)

    def over(one: str, two: str, *parts: Array) -> Array:
        return np.asarray(np.einsum(f"n,{one},{two}", weights, *parts))

    return EndMass(
        over("nac", "nad->cd", way, way), over("nac", "nad->cd", way, jway), np.einsum("n,nac->ac", weights, way),
        over("nac", "na->c", way, y), over("nac", "na->c", way, jy),
    )  # fmt: skip


def _points(compliance: RodCompliance, theta: float) -> tuple[tuple[NDArray[np.int64], Array], Array, Array]:
    """Gauss points between -theta and theta: nodes (n, 9) and place, the nodes' shape functions there, and masses."""
    mesh = compliance.ring.mesh
    vertex, radii = mesh.rim_theta[::2], mesh.radius[mesh.grid[:, 0]] / mesh.outer
    first = int(np.searchsorted(vertex, -theta, side="right")) - 1
    behind = int(np.searchsorted(vertex, theta))
    whole = pi * (1 - radii[0] ** 2)
    found = []
    for i in range(first, behind):
        low, high = max(vertex[i], -theta), min(vertex[i + 1], theta)
        at = (low + high) / 2 + (high - low) / 2 * _POINTS
        around = quadratic(2 * (at - vertex[i]) / (vertex[i + 1] - vertex[i]) - 1)
        for k in range(1, len(radii), 2):
            half = (radii[k + 1] - radii[k - 1]) / 2
            rho, through = radii[k] + half * _POINTS, quadratic(_POINTS)
            nodes = mesh.grid[k - 1 : k + 2, 2 * i : 2 * i + 3].ravel()
            shape = np.einsum("pi,qj->pqij", through, around).reshape(9, 9)
            mass = np.outer(half * _WEIGHTS * rho, (high - low) / 2 * _WEIGHTS).ravel() / whole
            place = np.stack([np.outer(rho, np.cos(at)).ravel(), np.outer(rho, np.sin(at)).ravel()], axis=1)
            found.append((np.tile(nodes, (9, 1)), place, shape, mass))
    nodes, place, shapes, mass = (np.concatenate(column) for column in zip(*found, strict=True))
    return (nodes, place), shapes, mass
