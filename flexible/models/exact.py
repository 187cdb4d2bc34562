"""The geometrically exact hoop: every node of the ring free, with Green's strain, for rings that bend far.

Inertia and contact are exact at every level already, so that this hoop differs from the linear one by its elastic
forces alone (:mod:`flexible.ring.exact`).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rigid import Scene

from ..ring.exact import elasticity_of
from ..ring.fem import Ring
from ..ring.nodal import NodalRing
from .full import FullHoop

Array = NDArray[np.float64]


class ExactRing(NodalRing):
    """Inertia of the free nodes, and their geometrically exact elasticity."""

    def __init__(self, scene: Scene, ring: Ring) -> None:
        super().__init__(scene, ring)
        self.exact = elasticity_of(ring)

    def elastic(self, u: Array) -> Array:
        """Elastic forces of a displacement of the free dofs."""
        return self.stiffness * self.exact.forces(u)

    def tangent(self, u: Array) -> sp.csc_matrix:
        """Derivative of ``elastic``."""
        return self.stiffness * self.exact.tangent(u)

    def strain_energy(self, u: Array) -> float:
        """Of the displacement of the free dofs, in m g R."""
        return self.stiffness * self.exact.strain_energy(u)


class ExactHoop(FullHoop):
    """Frame and geometrically exact ring of a scene; everything else as at the level of all nodes."""

    linear = False

    def _make_ring(self, scene: Scene, ring: Ring) -> NodalRing:
        return ExactRing(scene, ring)
