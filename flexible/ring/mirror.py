"""The ring is its own mirror image about the line through C and weld: half of what its rim answers is enough.

A matrix over the rim's components that is its own mirror image falls into two halves of half its size, of what is
symmetric about that line and of what is not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import eigh

Array = NDArray[np.float64]


class Mirror(NamedTuple):
    """Components of the rim and their mirror images.

    Attributes
    ----------
    image : (2 n_rim,) int array
        Of components (y1, y2), node by node.
    sign : (2 n_rim,) array
        y2 turns round.
    """

    image: NDArray[np.int64]
    sign: Array


def mirror_of(theta: Array) -> Mirror:
    """Of a rim whose nodes go round once by ascending angles: their images go round the other way."""
    first = int(np.argmin(np.abs(np.exp(1j * theta) - np.exp(-1j * theta[0]))))
    image = (first - np.arange(len(theta))) % len(theta)
    return Mirror((2 * image[:, None] + np.arange(2)).ravel(), np.tile([1.0, -1.0], len(theta)))


def half_of(mirror: Mirror) -> NDArray[np.int64]:
    """Components of one node of each pair, and of those that are their own image."""
    every = np.arange(len(mirror.image))
    return every[every <= mirror.image]


def by_halves(solve: Callable[[NDArray[np.int64]], Array], mirror: Mirror, lot: int) -> Array:
    """All columns of a matrix that is its own mirror image, of which ``solve`` gives some, a lot at a time."""
    half = half_of(mirror)
    columns = [solve(some) for some in np.split(half, range(lot, len(half), lot))]
    return mirrored(np.concatenate(columns, axis=1), half, mirror)


def mirrored(columns: Array, half: NDArray[np.int64], mirror: Mirror) -> Array:
    """All columns of a matrix that is its own mirror image, from those of ``half``."""
    whole = np.empty((len(columns), len(columns)), order="F")
    whole[:, mirror.image[half]] = mirror.sign[:, None] * columns[mirror.image] * mirror.sign[half]
    whole[:, half] = columns
    return whole


def positive_part(matrix: Array, mirror: Mirror) -> Array:
    """Of a symmetric matrix that is its own mirror image, what its positive eigenvalues make."""
    part = np.zeros(matrix.shape)  # by rows, whatever the order of what is given: the steps are compiled for that
    for basis in _bases(mirror):
        own = basis.T @ (basis.T @ matrix.T).T
        own = (own + own.T) / 2  # a compliance that was solved for by columns is symmetric to rounding errors alone
        values, vectors = eigh(own, driver="evr", subset_by_value=(-np.inf, 0.0))  # few beside those that are kept
        part += basis @ (basis @ (own - (vectors * values) @ vectors.T)).T
    return part


def _bases(mirror: Mirror) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Orthonormal fields that are symmetric, and those that are not; (2 n_rim, .) each."""
    count = len(mirror.image)
    one = half_of(mirror)
    alone = mirror.image[one] == one
    bases = []
    for way in (1.0, -1.0):
        kept = one[~alone | (way * mirror.sign[one] > 0)]
        other, column = mirror.image[kept], np.arange(len(kept))
        size = np.where(other == kept, 0.5, 0.5**0.5)
        rows, values = np.concatenate([kept, other]), np.concatenate([size, way * mirror.sign[kept] * size])
        bases.append(sp.csr_matrix((values, (rows, np.tile(column, 2))), shape=(count, len(kept))))
    return bases[0], bases[1]
