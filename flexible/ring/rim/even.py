"""A ring's rim that is the same on all places of an element; see the head of this room."""

from __future__ import annotations

from functools import cached_property
from math import pi

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rigid import Scene

from ..choice import elements_of_stout, feels_places
from ..fem import COLUMNS, Ring
from ..mirror import Mirror, by_halves, mirror_of
from .curve import curve, finer
from .places import ripple

Array = NDArray[np.float64]

PARTS, MANY, FEW = 4, 480, 2  # of an element; elements around beyond which they are fewer, and how many


def parts_of(scene: Scene, around: int, most: int = PARTS) -> int:
    """Parts into which the elements of a scene's ring are cut, so many of them around; ``most`` of them.

    None of them, 0, where its floor feels no difference between places, or the wall is too thin for an even rim.
    """
    if around < elements_of_stout(scene.wall) or not feels_places(scene, around):
        return 0
    return most if around <= MANY else min(most, FEW)


class EvenRim:
    """The rim of a ring by places finer than its nodes.

    Parameters
    ----------
    ring : Ring
    parts : int
        Into which each element is cut; each has a node at its start and in its middle, n_fine = parts n_rim in all.

    Attributes
    ----------
    theta : (n_fine,) array
        Angles of these nodes.
    curve : (2 n_fine, 2 n_rim) sparse
        Their displacements by those of the mesh's nodes on the rim.
    within : float
        See :attr:`flexible.ring.fem.Ring.within`: here of any wall.
    """

    def __init__(self, ring: Ring, parts: int = PARTS) -> None:
        self.ring = ring
        self.within = ring.between_nodes
        self.parts = parts
        self.theta = finer(ring.mesh.rim_theta, self.parts)
        self.curve = sp.kron(curve(ring.mesh.rim_theta, self.parts), sp.identity(2), format="csr")

    @cached_property
    def mirror(self) -> Mirror:
        """See :attr:`flexible.ring.fem.Ring.mirror`: of the finer nodes."""
        return mirror_of(self.theta)

    @property
    def compliance(self) -> Array:
        """All of :meth:`solve_rim`, not kept."""
        return by_halves(self._pressed, self.mirror, COLUMNS)

    @cached_property
    def _columns(self) -> tuple[Array, NDArray[np.bool_]]:
        n = 2 * len(self.theta)
        return np.empty((n, n), order="F"), np.zeros(-(-n // COLUMNS), np.bool_)

    def solve_rim(self, columns: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
        """The same as :meth:`flexible.ring.fem.Ring.solve_rim` of the finer nodes."""
        compliance, known = self._columns
        for group in np.unique(columns // COLUMNS):
            if not known[group]:
                some = np.arange(COLUMNS * group, min(COLUMNS * (group + 1), len(compliance)))
                compliance[:, some] = self._pressed(some)
                known[group] = True
        return compliance, known

    def _pressed(self, some: NDArray[np.int64]) -> Array:
        """Displacement of all components under unit forces on some, a whole number of nodes."""
        shares = self.curve[some].tocsc()
        loaded = np.unique(shares.nonzero()[1])
        own = self.ring.solve_rim(loaded)[0][:, loaded] @ shares[:, loaded].T
        shares = shares.T.toarray()
        more = self._given - self.ring.given_within
        own -= (more @ shares.reshape(len(shares) // 2, -1)).reshape(shares.shape)
        return np.asarray(self.curve @ own) - self._uneven(some)

    def _uneven(self, some: NDArray[np.int64]) -> Array:
        """What of that hangs on the place on an element."""
        found = np.zeros((len(self.theta), 2, len(some)))
        loaded = some[::2] // 2
        places, reach = 2 * self.parts, (self._ripple[0].shape[1] - 1) // 2
        s, c = np.sin(self.theta), np.cos(self.theta)
        axes = np.array([[c, s], [-s, c]]).transpose(2, 0, 1)
        columns = 2 * np.arange(len(loaded))[:, None] + np.arange(2)
        for away in range(-reach, reach + 1):
            at = (loaded - away) % len(self.theta)
            between = self.theta[at] + (self.theta[loaded] - self.theta[at] + pi) % (2 * pi) / 2 - pi / 2
            on_weld = np.abs((between + pi) % (2 * pi) - pi) < self.ring.mesh.weld_half_angle + 1e-9
            free, held = (table[at % places, away + reach] for table in self._ripple)
            rest = np.where(on_weld[:, None, None], held, free)
            found[at[:, None, None], np.arange(2)[:, None], columns[:, None, :]] += np.einsum(
                "nab,nac,ncd->nbd", axes[at], rest, axes[loaded]
            )
        return found.reshape(-1, len(some))

    @cached_property
    def _ripple(self) -> tuple[Array, Array]:
        return self.ring.once(_ripples, self.parts)

    @cached_property
    def _given(self) -> Array:
        return self.ring.once(_given)


def _given(ring: Ring) -> Array:
    return ring.given(ring.between_nodes)


def _ripples(ring: Ring, parts: int) -> tuple[Array, Array]:
    """Of a free inner rim, and of one that is held."""
    free, held = (ripple(ring, parts, clamped, ring.once(_given)) for clamped in (False, True))
    return free, held
