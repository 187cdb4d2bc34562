"""The mesh of the ring: an annulus of curved nine-node quadrilaterals, graded toward the weld.

The frame is the disk's: ``y1`` points from the hoop's centre C to the disk, ``y2`` is 90 degrees clockwise
from it as drawn in the world (the sense in which phi grows). In it (y1, y2) is an ordinary Cartesian pair and
a material point is ``y = rho (cos theta, sin theta)``, with the weld centred at ``theta = 0``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite, pi

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementQuad2, ElementVector, FacetBasis, MeshQuad2

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Density = Callable[[Array], Array]

MOST_HALVED = 40  # times, a layer: the least is 1e-12 of it


class MeshError(ValueError):
    """A ring that cannot be meshed as asked: one sentence that says why."""


@dataclass(frozen=True, slots=True)
class Quality:
    """How good a ring mesh is; the errors are relative to the true annulus.

    ``jacobian_ratio`` is the smallest over the largest Jacobian determinant within an element, ``aspect`` the
    longer over the shorter mid-line of an element, both of the worst element; ``smallest_angle`` and ``largest_angle``
    are what elements take around the ring, in radians.
    """

    elements: int
    nodes: int
    jacobian_ratio: float
    aspect: float
    smallest_angle: float
    largest_angle: float
    area_error: float
    outer_length_error: float


@dataclass(frozen=True, eq=False)
class RingMesh:
    """An annulus of curved quadratic quads; all node indices are scikit-fem's own (``mesh.p`` columns).

    Attributes
    ----------
    mesh : skfem.MeshQuad2
        With named boundaries "outer", "inner" and "weld".
    inner, outer : float
        Radii, in any unit of length.
    weld_half_angle : float
        Half the welded arc, in radians.
    points : (n_nodes, 2) array
        Coordinates (y1, y2).
    radius, theta : (n_nodes,) arrays
        Polar coordinates as constructed, theta in [-pi, pi].
    grid : (2 layers + 1, 2 around) array
        Every node by layer of elements from inside out and by angle; row 0 is the inner, row -1 the outer rim.
    quad9 : (n_elements, 9) array
        Node indices in VTK's order of a biquadratic quad: corners, then mid-sides, then the centre.
    node_dofs : (n_nodes, 2) array
        Numbers of the two displacement components in ``vector_basis``.
    rim_nodes, rim_theta : (2 around,) arrays
        Outer nodes and their angles, ascending: vertex, mid, vertex, mid, ...
    outer_nodes, inner_nodes, weld_nodes : arrays
        Nodes of each boundary in the order of theta, mid-sides included.
    outer_facets, inner_facets, weld_facets : arrays
        Facets of each boundary in the order of theta.
    """

    mesh: MeshQuad2
    inner: float
    outer: float
    weld_half_angle: float
    points: Array
    radius: Array
    theta: Array
    grid: Indices
    quad9: Indices
    node_dofs: Indices
    rim_nodes: Indices
    rim_theta: Array
    inner_nodes: Indices
    weld_nodes: Indices
    outer_facets: Indices
    inner_facets: Indices
    weld_facets: Indices

    @property
    def outer_nodes(self) -> Indices:
        """Nodes of the outer boundary, the same as ``rim_nodes``."""
        return self.rim_nodes

    @property
    def around(self) -> int:
        """Number of elements around."""
        return len(self.rim_nodes) // 2

    def vector_basis(self, intorder: int = 4) -> Basis:
        """Basis of the displacement whose dofs ``node_dofs`` numbers.

        The order of integration is always explicit: scikit-fem's default for nine-node quads takes 25 points
        where nine (``intorder=4``) integrate the stiffness of an undistorted element exactly.
        """
        return Basis(self.mesh, ElementVector(ElementQuad2()), intorder=intorder)

    def quality(self) -> Quality:
        """Shape of the elements, and errors of area and outer length against the true annulus."""
        inside = Basis(self.mesh, ElementQuad2(), intorder=6)
        jacobian = inside.mapping.detDF(inside.X)
        rim = FacetBasis(self.mesh, ElementQuad2(), facets=self.outer_facets, intorder=12)
        corner = self.points[self.quad9[:, 4:8]]
        along = np.linalg.norm(corner[:, 2] - corner[:, 0], axis=1)
        across = np.linalg.norm(corner[:, 3] - corner[:, 1], axis=1)
        angles = np.diff(np.append(self.rim_theta[::2], self.rim_theta[0] + 2 * pi))
        area = pi * (self.outer - self.inner) * (self.outer + self.inner)
        return Quality(
            elements=len(self.quad9),
            nodes=len(self.points),
            jacobian_ratio=float((jacobian.min(axis=1) / jacobian.max(axis=1)).min()),
            aspect=float(np.maximum(along / across, across / along).max()),
            smallest_angle=float(angles.min()),
            largest_angle=float(angles.max()),
            area_error=float(inside.dx.sum() / area - 1),
            outer_length_error=float(rim.dx.sum() / (2 * pi * self.outer) - 1),
        )


def ring_mesh(
    inner: float,
    outer: float,
    around: int = 240,
    through: int = 1,
    weld_half_angle: float = 3 * pi / 180,
    grading: float | Density = 1.0,
    halved: int = 0,
) -> RingMesh:
    """Mesh the annulus ``inner <= rho <= outer``, with element boundaries exactly at the ends of the weld.

    Parameters
    ----------
    inner, outer : float
        Radii, 0 < inner < outer, in any unit of length.
    around, through : int
        Elements around (at least 8) and through the wall (at least 1).
    weld_half_angle : float
        Half the welded arc, in radians, between 0 and pi.
    grading : float or callable
        How many times denser the elements are at the weld than opposite to it (1 is uniform up to the fit of
        the weld), or the density of elements itself, a positive vectorised function of |theta| in [0, pi].
    halved : int
        How often the outermost layer of elements is halved, always the half at the outer rim: layers besides
        ``through``.

    Returns
    -------
    RingMesh
        Symmetric about theta = 0 to the bit.

    Raises
    ------
    MeshError
        Radii, counts, weld or grading that make no ring.
    """
    told = (inner, outer, around, through, halved, weld_half_angle)
    if not all(isinstance(value, int | float | np.number) for value in told):
        raise MeshError("no ring can be made: its radii, counts and weld are numbers.")
    if not (isfinite(outer) and 0 < inner < outer):
        raise MeshError(f"a ring with radii {inner!r} and {outer!r} cannot be: 0 < inner < outer is needed.")
    if not (around >= 8 and through >= 1 and around % 1 == through % 1 == 0):
        raise MeshError(f"{around!r} x {through!r} elements make no ring: it takes 8 around and 1 through.")
    if not (0 <= halved <= MOST_HALVED and halved % 1 == 0):
        raise MeshError(f"halved = {halved!r} is not possible: it is a whole number from 0 to {MOST_HALVED}.")
    around, through, halved = int(around), int(through), int(halved)
    if not 0 < weld_half_angle < pi:
        raise MeshError(f"weld_half_angle = {weld_half_angle!r} is not possible: it lies between 0 and pi.")
    vertex_theta = _vertex_angles(around, weld_half_angle, _density(grading, weld_half_angle))
    theta = _with_mids(vertex_theta)
    radii = with_middles(_layers(inner, outer, through, halved))
    sin = np.where(np.abs(theta) == pi, 0.0, np.sin(theta))
    unit = np.stack([np.cos(theta), sin])

    # a grid of layers from inside out, each going round
    node = np.arange(radii.size * theta.size).reshape(radii.size, theta.size)
    closed = np.concatenate([node, node[:, :1]], axis=1)
    mesh, number = quads((radii[None, :, None] * unit[:, None, :]).reshape(2, -1), closed)
    grid = number.reshape(node.shape)
    sides = mesh.t2f.reshape(4, through + halved, around).astype(np.int64)
    outer_facets, inner_facets = sides[1, -1], sides[3, 0]
    welded = np.abs(theta) <= weld_half_angle
    boundaries = {"outer": outer_facets, "inner": inner_facets, "weld": inner_facets[welded[1::2]]}
    radius, angle = np.empty((2, node.size))
    radius[grid] = radii[:, None]
    angle[grid] = theta
    quad9 = np.ascontiguousarray(mesh.dofs.element_dofs.T, dtype=np.int64)
    quad9.flags.writeable = False  # every frame's block has it
    return RingMesh(
        mesh=mesh.with_boundaries(boundaries),
        inner=float(inner),
        outer=float(outer),
        weld_half_angle=float(weld_half_angle),
        points=np.ascontiguousarray(mesh.p.T),
        radius=radius,
        theta=angle,
        grid=grid,
        quad9=quad9,
        node_dofs=2 * np.arange(node.size)[:, None] + np.array([0, 1]),
        rim_nodes=grid[-1].copy(),
        rim_theta=theta,
        inner_nodes=grid[0].copy(),
        weld_nodes=grid[0][welded],
        outer_facets=outer_facets,
        inner_facets=inner_facets,
        weld_facets=boundaries["weld"],
    )


def quads(points: Array, grid: Indices) -> tuple[MeshQuad2, Indices]:
    """Nine-node quads between the layers of a grid of points.

    Parameters
    ----------
    points : (2, n) array
    grid : (2 layers + 1, 2 columns + 1) array
        Numbers of the points, by layer from inside out and by angle.

    Returns
    -------
    mesh : skfem.MeshQuad2
        Element by element round a layer, then the next one.
    number : (n,) array
        Of every point among the mesh's dofs: scikit-fem has numbers of its own.
    """
    low, half, high = slice(0, -1, 2), slice(1, None, 2), slice(2, None, 2)
    # corners counter-clockwise from (inner, theta_i); their four sides; the centre
    places = [(low, low), (high, low), (high, high), (low, high)]
    places += [(half, low), (high, half), (half, high), (low, half), (half, half)]
    elements = np.stack([grid[place].ravel() for place in places])
    mesh = MeshQuad2(np.ascontiguousarray(points), elements)
    number = np.empty(points.shape[1], dtype=np.int64)
    number[elements] = mesh.dofs.element_dofs
    return mesh, number


def _density(grading: float | Density, weld: float) -> Density:
    if callable(grading):
        return grading
    if not (isinstance(grading, int | float | np.number) and isfinite(grading) and grading > 0):
        raise MeshError(f"grading = {grading!r} is not possible: it must be positive.")
    # smooth round the circle, and as wide as a pulse, which sweeps about a radian of rim to either side
    reach = max(1.0, 2 * weld)
    falling = np.exp(-((pi / reach) ** 2) / 2)
    return lambda a: 1 + (grading - 1) * (np.exp(-((a / reach) ** 2) / 2) - falling) / (1 - falling)


def _vertex_angles(around: int, weld: float, density: Density) -> Array:
    """Ascending angles in [-pi, pi) that halve the weld, end it exactly, and mirror at theta = 0."""
    grid = np.concatenate([np.linspace(0, weld, 513), np.linspace(weld, pi, 2049)[1:]])
    value = np.broadcast_to(np.asarray(density(grid), dtype=float), grid.shape)
    if not (np.isfinite(value).all() and (value > 0).all()):
        raise MeshError("the grading is not possible: the density of elements must be positive on [0, pi].")
    count = np.concatenate([[0.0], np.cumsum(np.diff(grid) * (value[1:] + value[:-1]) / 2)])
    inside = max(1, min(round(around / 2 * count[512] / count[-1]), (around - 2) // 2))
    outside = around / 2 - inside  # with an odd number, half of the last element lies beyond theta = pi
    welded = np.interp(np.arange(1, inside) * count[512] / inside, count, grid)
    steps = np.arange(1, int(np.ceil(outside)))
    free = np.interp(count[512] + steps * (count[-1] - count[512]) / outside, count, grid)
    right = np.concatenate([welded, [weld], free])
    start = [] if around % 2 else [-pi]
    return np.concatenate([start, -right[::-1], [0.0], right])


def _layers(inner: float, outer: float, through: int, halved: int) -> Array:
    """Radii between layers of elements, from inside out."""
    even = np.linspace(inner, outer, through + 1)
    return np.concatenate([even[:-1], outer - (outer - even[-2]) * 0.5 ** np.arange(1, halved + 1), [outer]])


def with_middles(lines: Array) -> Array:
    """Lines and what is half way between them."""
    both = np.empty(2 * len(lines) - 1)
    both[::2], both[1::2] = lines, (lines[1:] + lines[:-1]) / 2
    return both


def _with_mids(vertex: Array) -> Array:
    """Vertex and mid-side angles in turn; the last mid-side closes the circle."""
    mids = np.empty_like(vertex)
    mids[:-1] = (vertex[:-1] + vertex[1:]) / 2
    mids[-1] = (vertex[-1] + vertex[0] + 2 * pi) / 2
    if len(vertex) % 2:
        mids[-1] = pi
    return np.column_stack([vertex, mids]).ravel()
