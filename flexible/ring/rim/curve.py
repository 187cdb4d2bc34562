"""Points between the nodes of a rim, on a line through all of them that has no kinks where elements meet."""

from __future__ import annotations

from math import pi

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BEFORE, _BEHIND = np.array([1.0, -4, 3]), np.array([-3.0, 4, -1])  # slope of a parabola at its end, and at its start


def lengths(theta: Array) -> Array:
    """Angles that elements take whose nodes are at ``theta``: vertex, middle, vertex, ..., once around."""
    vertex = theta[::2]
    return np.diff(np.append(vertex, vertex[0] + 2 * pi))


def finer(theta: Array, parts: int) -> Array:
    """Angles of the nodes once each element is cut into some, (parts n,)."""
    share = np.arange(2 * parts) / (2 * parts)
    return (theta[::2, None] + lengths(theta)[:, None] * share).ravel()


def curve(theta: Array, parts: int) -> sp.csr_matrix:
    """What nodes of the rim give to those finer ones, (parts n, n).

    Between two vertices it is the quartic that has both displacements, the one of the middle, and at either vertex the
    mean of the slopes that the parabolas before and behind it end with. Of a parabola over three elements it is that
    parabola.
    """
    n, h = len(theta), lengths(theta)
    z = np.arange(2 * parts) / (2 * parts)
    bump = 16 * z**2 * (1 - z) ** 2
    # weights of the nodes from the vertex before the element to the vertex behind it
    slope_at_start, slope_at_end = np.zeros((len(h), 7)), np.zeros((len(h), 7))
    before, behind = (h / np.roll(h, 1))[:, None], (h / np.roll(h, -1))[:, None]
    slope_at_start[:, :3] = before * _BEFORE / 2
    slope_at_start[:, 2:5] += _BEHIND / 2
    slope_at_end[:, 2:5] = _BEFORE / 2
    slope_at_end[:, 4:] += behind * _BEHIND / 2
    start, middle, end = np.eye(7)[2:5]

    def cubic(z: Array) -> Array:
        rise = z**2 * (3 - 2 * z)
        ends = np.multiply.outer(1 - rise, start) + np.multiply.outer(rise, end)
        turns = (
            slope_at_start[:, None] * (z * (1 - z) ** 2)[:, None] - slope_at_end[:, None] * (z**2 * (1 - z))[:, None]
        )
        return np.asarray(ends + turns)

    weights = cubic(z) + bump[:, None] * (middle - cubic(np.array([0.5])))
    nodes = (2 * np.arange(len(h))[:, None, None] + np.arange(-2, 5)) % n
    columns = np.broadcast_to(nodes, weights.shape)
    rows = np.broadcast_to(np.arange(parts * n).reshape(len(h), -1, 1), weights.shape)
    return sp.csr_matrix((weights.ravel(), (rows.ravel(), columns.ravel())), shape=(parts * n, n))
