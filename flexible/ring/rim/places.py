"""What the rim's compliance owes to the place on an element where it is loaded.

A ring's mesh that goes on evenly is the same from element to element, not within one. In the axes of radius and
circumference its stiffness is a sum over waves from element to element (Bloch), each with a matrix as large as one
column of quads. From that compliance, between any two places, the mean over all places the same way apart is taken; no
ring that is turned under its mesh would have the rest.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..fem import Ring
from .curve import curve

Array = NDArray[np.float64]

REACH = 4  # elements between two places, beyond which the rest is taken for none


def ripple(ring: Ring, parts: int, clamped: bool, given: Array) -> Array:
    """That rest for E b = 1, of places in ``parts`` of elements.

    Parameters
    ----------
    ring : Ring
    parts : int
        Of an element, each with a node at its start and in its middle.
    clamped : bool
        Whether the inner rim is held, as on the weld, or free.
    given : (n_rim, n_rim) array
        What is left out of it, see :meth:`flexible.ring.fem.Ring.given`.

    Returns
    -------
    (2 parts, 4 REACH parts + 1, 2, 2) array
        Displacement (outward, onward) at each place on an element under unit forces (outward, onward) so many places
        away, from REACH elements before it to as many behind it.
    """
    compliance = _of_elements(ring, clamped, given)
    around, places, reach = len(compliance), 2 * parts, 2 * REACH * parts
    even = np.arange(64.0)
    weights = curve(2 * np.pi * even / len(even), parts)[places * 16 : places * 17].toarray()
    weights = weights.reshape(places, -1, 2)[:, 15:19]  # from the element before on
    between = {
        j: sum(
            np.einsum(
                "pu,uavb,qv->pqab", weights[:, a], compliance[(a - b - j) % around].reshape(2, 2, 2, 2), weights[:, b]
            )
            for a in range(4)
            for b in range(4)
        )
        for j in range(-REACH, REACH + 1)
    }
    found = np.empty((places, 2 * reach + 1, 2, 2))
    for place in range(places):
        for away in range(-reach, reach + 1):
            element, other = divmod(place + away, places)
            found[place, away + reach] = between[element][place, other]
    return _tapered(found - found.mean(axis=0), places)


def _tapered(found: Array, places: int) -> Array:
    """With less and less in the last element."""
    reach = found.shape[1] // 2
    away = np.abs(np.arange(-reach, reach + 1))
    return np.asarray(found * np.minimum(1.0, (reach - away) / places)[:, None, None])


def _of_elements(ring: Ring, clamped: bool, given: Array) -> Array:
    """Displacement of the rim's two nodes of an element under unit forces on those of one so many before it, (m, 4, 4).

    Nodes in turn, outward and onward.
    """
    before, own, behind = _blocks(ring)
    rows = len(ring.mesh.grid)
    inner = np.tile(np.arange(2 * rows) < 2, 2)
    held = inner if clamped else np.zeros(len(inner), bool)
    rim = np.cumsum(~held)[np.tile(np.arange(2 * rows) >= 2 * rows - 2, 2)] - 1
    around = ring.mesh.around
    turn = np.exp(2j * np.pi * np.arange(around // 2 + 1) / around)[:, None, None]
    waves = (before / turn + own + behind * turn)[:, ~held][:, :, ~held]
    answers = np.empty((len(waves), 4, 4), complex)
    rigid = 0 if clamped else 2  # waves in which a free ring moves as it is
    for k in range(rigid):
        values, vectors = np.linalg.eigh((waves[k] + waves[k].conj().T) / 2)
        vectors = vectors[:, values > 1e-9 * values[-1]]
        values = values[values > 1e-9 * values[-1]]
        answers[k] = ((vectors / values) @ vectors.conj().T)[rim][:, rim]
    answers[rigid:] = np.linalg.solve(waves[rigid:], np.eye(waves.shape[1])[:, rim])[:, rim]
    found = np.fft.irfft(answers, around, axis=0)
    middle = around // 4
    for j in range(-2 * REACH, 2 * REACH + 1):
        beside = np.arange(2 * (middle + j), 2 * (middle + j) + 2) % len(given)
        found[j % around] -= np.kron(given[beside, 2 * middle : 2 * middle + 2], np.eye(2))
    return found


def _blocks(ring: Ring) -> tuple[Array, Array, Array]:
    """Stiffness of one element's first two columns of nodes with those before, their own, and those behind.

    Away from weld and corners; in the axes of radius and circumference, of nodes from inside out.
    """
    grid, mesh = ring.mesh.grid, ring.mesh
    of = 2 * (mesh.around // 4)

    def columns(j: int) -> tuple[NDArray[np.int64], Array]:
        nodes = grid[:, [of + 2 * j, of + 2 * j + 1]].T.ravel()
        s, c = np.sin(mesh.theta[nodes]), np.cos(mesh.theta[nodes])
        axes = np.zeros((2 * len(nodes), 2 * len(nodes)))
        one, two = 2 * np.arange(len(nodes)), 2 * np.arange(len(nodes)) + 1
        axes[one, one], axes[one, two], axes[two, one], axes[two, two] = c, s, -s, c
        return mesh.node_dofs[nodes].ravel(), axes

    here, own = columns(0)
    rows = own @ ring.stiffness[here]
    first, second, third = (rows[:, dofs] @ axes.T for dofs, axes in map(columns, (-1, 0, 1)))
    return np.asarray(first), np.asarray(second), np.asarray(third)
