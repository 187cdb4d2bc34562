"""Elasticity of the ring on its mesh: stiffness, mass, static compliance of the rim, vibration modes, stress.

Everything is computed once for a shape and a Poisson's ratio, at unit membrane stiffness E b = 1, unit mass and
unit outer radius, and rescaled for a scene: displacements by 1/(E b), squared frequencies by E b/m_h.
Plane stress; the weld (a short arc of the inner rim) is clamped to the disk's frame.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from math import ceil, pi
from typing import Any, TypeVar

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from skfem import Basis, BilinearForm
from skfem.helpers import ddot, dot, sym_grad, trace

from meshes import RingMesh
from rigid import Scene

from .corners import corners
from .mirror import Mirror, by_halves, mirror_of

Array = NDArray[np.float64]

COLUMNS = 64  # of the rim's compliance are solved for together
LOT = 24  # of modes that are found together
WITHIN, THIN = 0.05, 2.5  # share of a half-plane's give under the shortest waves of the rim's nodes; see Ring.within


def membrane_stiffness(scene: Scene) -> float:
    """E b of the ring, in m g/R: the section E I = E b h^3/12 with h the wall."""
    return 12 * scene.ring.bending_stiffness / scene.wall**3


T = TypeVar("T")


class Ring:
    """The ring of a scene's shape at unit E b and unit mass, clamped at the weld.

    Parameters
    ----------
    mesh : RingMesh
        In units of the outer radius.
    poisson : float
        Poisson's ratio.

    Attributes
    ----------
    stiffness, mass : (n_dofs, n_dofs) sparse
        Of the free ring's quads, in scikit-fem's numbering.
    corners : Corners
        What the wall yields besides where it is welded.
    free : (n_free,) int array
        Degrees of freedom that the weld leaves.
    """

    def __init__(self, mesh: RingMesh, poisson: float) -> None:
        self._made: dict[Any, Any] = {}
        self.mesh = mesh
        self.poisson = poisson
        self.basis: Basis = mesh.vector_basis(intorder=4)
        lame = poisson / (1 - poisson**2)
        shear = 1 / (2 * (1 + poisson))

        @BilinearForm
        def stiffness(u: Any, v: Any, w: Any) -> Any:
            """Plane stress, E = 1."""
            strain, test = sym_grad(u), sym_grad(v)
            return lame * trace(strain) * trace(test) + 2 * shear * ddot(strain, test)

        @BilinearForm
        def mass(u: Any, v: Any, w: Any) -> Any:
            return dot(u, v)

        self.corners = corners(mesh, stiffness)
        self.stiffness: sp.csr_matrix = stiffness.assemble(self.basis).tocsr()
        self.area = float(self.basis.dx.sum())
        self.mass: sp.csr_matrix = mass.assemble(self.basis).tocsr() / self.area
        clamped = mesh.node_dofs[mesh.weld_nodes].ravel()
        self.free: NDArray[np.int64] = np.setdiff1d(np.arange(self.basis.N), clamped)

    def once(self, make: Callable[..., T], *args: Any) -> T:
        """What ``make`` makes of this ring and the arguments: made once, and kept for as long as the ring is."""
        key = make, *args
        if key not in self._made:
            self._made[key] = make(self, *args)
        made: T = self._made[key]
        return made

    @cached_property
    def _position(self) -> NDArray[np.int64]:
        position = np.full(self.basis.N, -1)
        position[self.free] = np.arange(len(self.free))
        return position

    @cached_property
    def rim_dofs(self) -> NDArray[np.int64]:
        """Positions among the free dofs of the rim's components (y1, y2), node by node; (2 n_rim,)."""
        return self._position[self.mesh.node_dofs[self.mesh.rim_nodes].ravel()]

    @cached_property
    def free_stiffness(self) -> sp.csc_matrix:
        """Stiffness of the clamped ring, its corners in it."""
        matrix = self.stiffness + self.corners.stiffness(self.basis.N)
        return matrix[self.free][:, self.free].tocsc()

    @cached_property
    def free_mass(self) -> sp.csc_matrix:
        """Mass of the clamped ring."""
        return self.mass[self.free][:, self.free].tocsc()

    @cached_property
    def _factor(self) -> Any:
        # symmetric positive definite: no pivoting, minimum degree
        options = {"SymmetricMode": True}
        return splu(self.free_stiffness, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)

    def solve(self, load: Array) -> Array:
        """Static displacement of the free dofs under a load on them, (n_free,) or (n_free, m)."""
        return self._factor.solve(load)

    @cached_property
    def _columns(self) -> tuple[Array, NDArray[np.bool_]]:
        """Compliance of the rim, column by column, and which groups of columns are known."""
        n = len(self.rim_dofs)
        return np.empty((n, n), order="F"), np.zeros(-(-n // COLUMNS), np.bool_)

    def solve_rim(self, columns: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
        """Displacement of all of ``rim_dofs`` under unit forces on some; a motion loads a short arc of the rim.

        Only the columns that are asked for, and their neighbours, are solved for, once.

        Returns
        -------
        compliance : (2 n_rim, 2 n_rim) array
            Those columns of it, but for what is ``within``, and whatever others were asked for before.
        known : array
            Which groups of ``COLUMNS`` columns these are.
        """
        compliance, known = self._columns
        for group in np.unique(columns // COLUMNS):
            if not known[group]:
                some = np.arange(COLUMNS * group, min(COLUMNS * (group + 1), len(compliance)))
                compliance[:, some] = self.pressed(some) - self._by_itself(some)
                known[group] = True
        return compliance, known

    @cached_property
    def mirror(self) -> Mirror:
        """The rim's components and their mirror images."""
        return mirror_of(self.mesh.rim_theta)

    @property
    def rim_compliance(self) -> Array:
        """Displacement of the rim under unit forces on it, (2 n_rim, 2 n_rim), in the order of ``rim_dofs``."""
        compliance = by_halves(self.pressed, self.mirror, COLUMNS)
        return (compliance + compliance.T) / 2

    def pressed(self, columns: NDArray[np.int64]) -> Array:
        """Displacement of the rim under unit forces on some of its components, (2 n_rim, m)."""
        load = np.zeros((len(self.free), len(columns)))
        load[self.rim_dofs[columns], np.arange(len(columns))] = 1.0
        return np.asarray(self.solve(load)[self.rim_dofs])

    @property
    def within(self) -> float:
        """What the wall gives way by under a unit pressure, nodes there or none; R at E b = 1. 0 for a thin wall.

        A half-plane is dented by waves of pressure of length l by l/(pi E b) times themselves. Nodes h apart carry none
        below 2 h, by which elements were sides of a polygon: a share of that. A wall below ``THIN`` h bends, and the
        mesh knows of that.
        """
        mesh = self.mesh
        thick = mesh.outer - mesh.inner > THIN * 2 * pi / len(mesh.rim_nodes)
        return self.between_nodes if thick else 0.0

    @property
    def between_nodes(self) -> float:
        """The same of any wall."""
        return WITHIN * 4 / len(self.mesh.rim_nodes)

    @cached_property
    def given_within(self) -> Array:
        """What is ``within`` of the displacement of a rim's node under unit forces on it and others, (n_rim, n_rim)."""
        return self.given(self.within)

    def given(self, within: float) -> Array:
        """The same of any such share."""
        if within == 0:
            return np.zeros(self.rim_products.shape)
        return np.asarray(splu(self.rim_products).solve(within * np.eye(len(self.mesh.rim_nodes))))

    def _by_itself(self, columns: NDArray[np.int64]) -> Array:
        """The same of the rim's components, under unit forces on some of them."""
        moved = np.zeros((len(self.mesh.rim_nodes), 2, len(columns)))
        for way in (0, 1):
            moved[:, way, columns % 2 == way] = self.given_within[:, columns[columns % 2 == way] // 2]
        return moved.reshape(-1, len(columns))

    @cached_property
    def rim_products(self) -> sp.csc_matrix:
        """Integrals of products of two nodes' shape functions along the outer rim, (n_rim, n_rim), R = 1."""
        theta = self.mesh.rim_theta
        n = len(theta)
        of_element = np.array([[4.0, 2, -1], [2, 16, 2], [-1, 2, 4]]) / 30
        nodes = (np.arange(0, n, 2)[:, None] + np.arange(3)) % n
        products = (theta[nodes[:, 2]] - theta[nodes[:, 0]])[:, None, None] % (2 * pi) * of_element
        rows, columns = np.broadcast_arrays(nodes[:, :, None], nodes[:, None, :])
        return sp.csc_matrix((products.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n))

    def modes(self, count: int) -> tuple[Array, Array]:
        """The lowest ``count`` vibration modes of the clamped ring.

        Returns
        -------
        eigenvalues : (count,) array
            Squared frequencies in E b/m_h.
        shapes : (n_free, count) array
            Orthonormal in the unit mass.
        """
        # in lots: the same modes to the last bit, whatever was asked for before
        lot = LOT * ceil(count / LOT)
        known = self.__dict__.setdefault("_modes", {})
        if lot not in known:
            operator = LinearOperator(self.free_stiffness.shape, self.solve, dtype=float)
            start = np.random.default_rng(1).standard_normal(len(self.free))  # fixed: the same modes in every run
            values, shapes = eigsh(self.free_stiffness, lot, self.free_mass, sigma=0.0, OPinv=operator, v0=start)
            order = np.argsort(values)
            known[lot] = (values[order], shapes[:, order])
        return known[lot][0][:count], known[lot][1][:, :count]

    @cached_property
    def position_field(self) -> Array:
        """Undeformed coordinates as a vector of dofs, (n_dofs,)."""
        field = np.empty(self.basis.N)
        field[self.mesh.node_dofs] = self.mesh.points
        return field

    def turned(self, field: Array) -> Array:
        """A field of dofs turned by a right angle, (y1, y2) -> (-y2, y1); works on columns too."""
        first, second = self.mesh.node_dofs.T
        result = np.empty_like(field)
        result[first], result[second] = -field[second], field[first]
        return result

    def translation(self, component: int) -> Array:
        """Unit translation along y1 (0) or y2 (1) as a vector of dofs."""
        field = np.zeros(self.basis.N)
        field[self.mesh.node_dofs[:, component]] = 1.0
        return field

    def expand(self, displacement: Array) -> Array:
        """Free dofs to nodes: (n_free,) -> (n_nodes, 2), zero at the weld."""
        full = np.zeros(self.basis.N)
        full[self.free] = displacement
        return full[self.mesh.node_dofs]
