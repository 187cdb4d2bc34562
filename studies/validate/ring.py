"""The elastic ring: thin-ring theory, exact plane stress of an annulus, and the elastica of a soft one.

Inner radius 1, E b = 1, unit density. Exact values of the annulus come from its Airy functions (Timoshenko and Goodier,
Theory of Elasticity); the pinched and the clamped ring are Castigliano's. The elastica is a hoop without mass that
stands on the floor under its disk: two opposite forces m g pinch it.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, radians, sin, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh, splu
from skfem import ElementQuad2, ElementVector, FacetBasis, LinearForm

from flexible.models.select import hoop_of
from flexible.ring.fem import Ring
from flexible.start.equilibrium import equilibrium
from flexible.start.pose import Pose
from meshes import ring_mesh
from rigid import Contact, Friction, Hoop, Kind, Release, Scene
from rigid import Ring as Elastic

from .row import Row

Array = NDArray[np.float64]

PLANE_STRESS = "plane stress of an annulus, by its Airy functions (Timoshenko and Goodier, Theory of Elasticity)"
FREQUENCIES = {1.02: (0.01518385365, 0.04293285531, 0.08228274316), 1.2: (0.1260894549, 0.3479811729, 0.6458273265)}
COMPLIANCES = {1.02: (175202.447, 24647.4525, 7014.65993), 1.2: (272.574696, 39.5676100, 11.7771249)}
CLAMPED = {30: 3.68e-2, 90: 0.35032, 180: 0.148778}
ORDERS = (2, 3, 4)
STIFFNESSES = (2.0, 0.4)
"""E I/(m g R^2) of a hoop that its disk pinches by a thirteenth and by half of its radius; below 0.36 the rim under it
leaves the floor in the middle, and the load is no longer one."""


def rows() -> Iterator[Row]:
    """Frequencies, compliances, pinched and clamped ring."""
    for ratio, around, through in ((1.02, 720, 3), (1.2, 320, 8)):
        free = Ring(ring_mesh(1.0, ratio, around, through), 0.3)
        why = f"{around} x {through} quadratic elements: error ~ h^4"
        for order, exact, found in zip(ORDERS, FREQUENCIES[ratio], _frequencies(free), strict=True):
            yield Row(
                PLANE_STRESS,
                f"omega_{order} R0 sqrt(rho/E) of an annulus, r = {ratio}",
                exact,
                found,
                1e-5 * exact,
                why,
            )
        for order, exact in zip(ORDERS, COMPLIANCES[ratio], strict=True):
            load = _traction(free, order)
            found = float(load @ _held(free, load)) / (pi * free.mesh.outer)
            yield Row(PLANE_STRESS, f"u_r E/p under p cos({order} theta), r = {ratio}", exact, found, 1e-5 * exact, why)
    yield from _thin()
    yield from _elastica()


def _frequencies(free: Ring) -> list[float]:
    """Of the lowest three pairs of bending modes."""
    density = free.mass * free.area
    squares = eigsh(free.stiffness.tocsc(), 9, density.tocsc(), sigma=-1e-3, return_eigenvectors=False)
    return [float(value) for value in np.sqrt(np.sort(squares)[3:])[::2]]


def _traction(free: Ring, order: int) -> Array:
    """Load vector of the outward traction cos(order theta) on the outer rim."""

    @LinearForm
    def traction(v, w):  # type: ignore[no-untyped-def]
        cosine = np.cos(order * np.arctan2(w.x[1], w.x[0]))
        return cosine * (v[0] * w.x[0] + v[1] * w.x[1]) / np.hypot(*w.x)

    element = ElementVector(ElementQuad2())
    facets = FacetBasis(free.mesh.mesh, element, facets=free.mesh.outer_facets, intorder=8)
    return np.asarray(traction.assemble(facets))


def _held(free: Ring, load: Array) -> Array:
    """Displacement under a load in equilibrium, three dofs held as statics allows."""
    theta = free.mesh.rim_theta
    here, there = (free.mesh.rim_nodes[np.argmax(np.cos(theta - angle))] for angle in (0.0, pi))
    held = [*free.mesh.node_dofs[here], free.mesh.node_dofs[there, 1]]
    kept = np.setdiff1d(np.arange(free.basis.N), held)
    u = np.zeros(free.basis.N)
    u[kept] = splu(free.stiffness[kept][:, kept].tocsc()).solve(load[kept])
    return u


def _thin() -> Iterator[Row]:
    """Loads at a point of a ring clamped over a short arc; thin-ring theory has neither the arc nor the wall."""
    wall = 0.02
    ring = Ring(ring_mesh(1 - wall / 2, 1 + wall / 2, 360, 2, weld_half_angle=pi / 180), 0.3)
    for angle, exact in CLAMPED.items():
        node = int(np.argmax(np.cos(ring.mesh.rim_theta - radians(angle))))
        load = np.zeros(len(ring.free))
        theta = ring.mesh.rim_theta[node]
        load[ring.rim_dofs.reshape(-1, 2)[node]] = np.cos(theta), np.sin(theta)
        found = float(load @ ring.solve(load)) * wall**3 / 12
        # the clamped end moves by about the weld's half-angle and by h
        within = (3 * (wall + pi / 180) / radians(angle) + 1e-3) * exact
        what = f"C_rr E I/a^3 at {angle} degrees from the weld, h/a = {wall}"
        yield Row("Castigliano, thin ring", what, exact, found, within, "a weld of 1 degree and a wall of h/a")
    free = Ring(ring_mesh(1 - wall / 2, 1 + wall / 2, 480, 2), 0.3)
    theta = free.mesh.rim_theta
    ends = [free.mesh.rim_nodes[np.argmin(np.abs(np.cos(theta - angle) - 1))] for angle in (0.0, pi)]
    load = np.zeros(free.basis.N)
    load[free.mesh.node_dofs[ends[0], 0]], load[free.mesh.node_dofs[ends[1], 0]] = -1.0, 1.0
    u = _held(free, load)
    closing = float(u[free.mesh.node_dofs[ends[1], 0]] - u[free.mesh.node_dofs[ends[0], 0]]) * wall**3 / 12
    exact = pi / 4 - 2 / pi
    what = f"closing of a pinched ring, E I/(P a^3), h/a = {wall}"
    yield Row("Timoshenko, Strength of Materials II", what, exact, closing, 10 * wall**2 * exact, "(h/a)^2")


def _elastica() -> Iterator[Row]:
    """The chain in equilibrium, pinched far beyond what a linear ring follows."""
    wall, weld = 0.02, radians(0.3)
    a = 1 - wall / 2
    for stiffness in STIFFNESSES:
        ring = Elastic(bending_stiffness=stiffness, weld_half_angle=weld)
        floor = Contact(stiffness=1e9, damping=0.0)
        scene = Scene(Hoop(0.1, 1 / (1 - wall)), Friction(0.35, 0.3), Release(0.0), ring=ring, contact=floor)
        stands = equilibrium(hoop_of(scene.to_dimensionless()), Pose(0.0, 0.0, 0.0, 1.0, 0.0, Kind.ROLL))
        exact = closing(a * a / stiffness)
        what = f"closing of a hoop under its disk over its radius, E I/(m g R^2) = {stiffness:g}, h/a = {wall}"
        within = (wall / 2 + weld) * exact
        yield Row("Euler's elastica, by quadrature", what, exact, -float(stands.pos[1]) / a, within,
                  "half of h/a, and a weld of 0.3 degrees")  # fmt: skip


def closing(force: float) -> float:
    """Closing over a of an inextensible ring of radius a that two opposite forces P a^2/(E I) = ``force`` pinch.

    On a quarter, from the load to the side, the tangent turns by theta from 0 to pi/2 and a theta'' = (P/2) cos theta,
    so that theta'^2 = P sin theta + c, and its length is pi/2 (c > 0: no inflection, force below 2.787).
    """

    def along(c: float, power: int) -> float:
        return float(quad(lambda theta: sin(theta) ** power / sqrt(force * sin(theta) + c), 0, pi / 2)[0])

    return 2 - 2 * along(brentq(lambda c: along(c, 0) - pi / 2, 1e-9, 1.0), 1)
