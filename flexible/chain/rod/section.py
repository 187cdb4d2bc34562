"""The ring as a rod: compliance of its section and of its end at the weld, measured on the quads of its mesh.

Away from loads and from the weld a plane ring carries nothing but the resultants of its section, normal force N, shear
force Q and moment M about the section's centre of mass. Its strain energy per angle is then a quadratic form of the
three, for a curved bar with N and M coupled. Six loads on the clamped ring give resultants and energies of any piece of
the mesh: a regular piece tells the form, and the piece at the weld how its end gives way. No theory of thick bars
enters, of shear no more than what its compliance is at least, and a rod with this compliance is the mesh itself but for
what dies out within a wall or two (Saint-Venant).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from meshes import gauss_gradient, ring_mesh
from rigid import SceneError

from ...ring.fem import Ring

Array = NDArray[np.float64]

FADING = 3.0  # walls from a cut to the weld or to a load: what is no resultant has faded by exp(-4.2 x 3) there
AT_WELD = 2  # elements of the piece at the weld: the corner's stress, which a quad smears, spoils the first cut
SLENDER = 5.0  # walls to the length of a quad, from which on it knows less of the wall's bending than a rod
FINE, MOST_QUADS = 3.0, 2400  # that measure such a wall: walls to the length; around, or rounding errors tell
LOADED = (2.1, pi, -2.1)  # angles of the rim at which the ring is pulled, in both directions
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def mass_radius(inner: float) -> float:
    """Radius of the centre of mass of a thin slice of the ring, in units of the outer one."""
    return 2 / 3 * (1 - inner**3) / (1 - inner**2)


def radial(theta: float) -> Array:
    """Unit vector (y1, y2) outward."""
    return np.array([cos(theta), sin(theta)])


@dataclass(frozen=True, eq=False)
class RodCompliance:
    """Compliance of a ring at E b = 1, in units of its outer radius.

    Attributes
    ----------
    radius : float
        Of the line through the sections' centres of mass, to which N and M refer.
    section : (3, 3) array
        Energy per angle of the section is half the quadratic form of this in (N, Q, M).
    weld : float
        Angle from the middle of the weld at which the piece ends to which ``ends`` belongs.
    ends : (6, 6) array
        Displacement (y1, y2) and rotation of the sections there, theta > 0 first, under unit forces and moments on
        them; the two feel each other through the wall over the weld.
    ring : Ring
        The one that was measured.
    answers : (n_free, 6) array
        Displacement of its free dofs, as far as no load of the six is near, under the unit forces and moments that
        ``ends`` is of.
    misfit : float
        Largest error of the form, before its shear was made no less than a wall's, on the pieces it was fitted to,
        relative to the largest energy.
    """

    radius: float
    section: Array
    weld: float
    ends: Array
    ring: Ring
    answers: Array
    misfit: float

    def piece(self, angle: float) -> Array:
        """(3, 3) displacement and rotation of the end of a piece from theta = 0 to ``angle`` that is held at 0."""
        at = angle / 2 * (1 + _POINTS)
        total = np.zeros((3, 3))
        for theta, weight in zip(at, angle / 2 * _WEIGHTS, strict=True):
            resultants = _resultants(self.radius, angle, theta)
            total += weight * resultants.T @ self.section @ resultants
        return total


def transfer(radius: float, one: float, two: float) -> Array:
    """What the section at ``two`` moves with that at ``one``; transposed, the loads at ``one`` of those at ``two``."""
    arm = radius * (radial(two) - radial(one))
    return np.array([[1.0, 0.0, -arm[1]], [0.0, 1.0, arm[0]], [0.0, 0.0, 1.0]])


def _resultants(radius: float, loaded: float, theta: float) -> Array:
    """(N, Q, M) of the section at ``theta`` under unit force (y1, y2) and moment on the one at ``loaded``."""
    arm = radius * (radial(loaded) - radial(theta))
    c, s = cos(theta), sin(theta)
    return np.array([[-s, c, 0.0], [c, s, 0.0], [-arm[1], arm[0], 1.0]])


def _loaded(ring: Ring) -> Array:
    """Displacement of all dofs, (n_dofs, 6), under six unit forces on the rim."""
    mesh = ring.mesh
    rim = [int(np.argmin(np.abs(mesh.rim_theta - theta))) for theta in LOADED]
    load = np.zeros((len(ring.free), 6))
    load[ring.rim_dofs.reshape(-1, 2)[rim].ravel(), np.arange(6)] = 1.0
    full = np.zeros((ring.basis.N, 6))
    full[ring.free] = ring.solve(load)
    return full


class _Stressed:
    """What the six loads move, and strain energies and forces of single elements under them."""

    def __init__(self, ring: Ring) -> None:
        self.mesh = ring.mesh
        self.moved = moved = _loaded(ring)
        u = moved[ring.mesh.node_dofs]
        *self.by, area = gauss_gradient(ring.mesh)
        h11, h21, h12, h22 = (by @ u[:, i] for by in self.by for i in (0, 1))
        strain = np.stack([h11, h22, h12 + h21])
        self.poisson = nu = ring.poisson
        elastic = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]]) / (1 - nu**2)
        self.stress = np.einsum("ij,jgm,g->igm", elastic, strain, area.ravel())
        energy = np.einsum("iga,igb->gab", strain, self.stress)
        self.energy = energy.reshape(len(area), 9, 6, 6).sum(axis=1)
        self.corners = moved.T @ (ring.corners.stiffness(ring.basis.N) @ moved)
        self.theta = ring.mesh.theta[ring.mesh.quad9[:, 8]]

    def cut(self, low: float, high: float, at: float) -> Array:
        """Force and moment about C, (3, 6), that the elements from ``low`` to ``high`` bear at their end ``at``."""
        mesh = self.mesh
        s11, s22, s12 = self.stress * np.repeat((low < self.theta) & (self.theta < high), 9)[:, None]
        first, second = self.by[0].T @ s11 + self.by[1].T @ s12, self.by[0].T @ s12 + self.by[1].T @ s22
        nodes = mesh.grid[:, int(np.argmin(np.abs(mesh.rim_theta - at)))]
        y = mesh.points[nodes]
        moment = y[:, :1] * second[nodes] - y[:, 1:] * first[nodes]
        return np.stack([first[nodes].sum(axis=0), second[nodes].sum(axis=0), moment.sum(axis=0)])


def _about(point: Array, forces: Array) -> Array:
    """The same with the moment about ``point`` instead of C."""
    return np.stack([forces[0], forces[1], forces[2] - point[0] * forces[1] + point[1] * forces[0]])


def is_slender(ring: Ring) -> bool:
    """Whether a ring's quads are too long beside its wall to be measured."""
    mesh = ring.mesh
    return 2 * pi / len(mesh.rim_theta[::2]) > SLENDER * (1 - mesh.inner / mesh.outer)


def _measurable(ring: Ring) -> Ring:
    """The ring; or the same of shorter quads, which only has to bear six loads."""
    if not is_slender(ring):
        return ring
    mesh = ring.mesh
    wall = 1 - mesh.inner / mesh.outer
    around = min(ceil(2 * pi / (FINE * wall)), MOST_QUADS)
    return Ring(ring_mesh(1 - wall, 1.0, around, len(mesh.grid) // 2, mesh.weld_half_angle), ring.poisson)


def rod_compliance(ring: Ring, end: float) -> RodCompliance:
    """Compliance of a ring as a rod; its end piece reaches ``end`` beyond the weld, or as far as Saint-Venant asks.

    In a thin wall that may be less than a quad's length, in which the mesh knows no more of what fades: it has two. A
    wall in which quads are longer still is measured on others.

    Parameters
    ----------
    ring : Ring
    end : float
        Angle.

    Raises
    ------
    SceneError
        The wall is too thick, or the weld too wide, for a rod.
    """
    return ring.once(_measured, end)


def _measured(ring: Ring, end: float) -> RodCompliance:
    ring = _measurable(ring)
    mesh = ring.mesh
    inner = mesh.inner / mesh.outer
    radius, fades = mass_radius(inner), FADING * (1 - inner)
    vertex = mesh.rim_theta[::2]
    beyond = vertex[vertex > mesh.weld_half_angle + 1e-9][AT_WELD - 1 :]
    beyond = beyond[beyond > mesh.weld_half_angle + max(end, fades) - 1e-9]
    margin = fades + 0.25 * max(LOADED[0] - mesh.weld_half_angle - 2 * fades, 0.0)
    clear = vertex[(vertex > mesh.weld_half_angle + margin) & (vertex < LOADED[0] - margin)]
    if len(beyond) < 2 or len(clear) < 4:
        raise SceneError("the ring is no rod: its wall is too thick, or its weld too wide, for solve.level = 'chain'.")
    stressed = _Stressed(ring)

    section, misfit = _section(stressed, clear, radius)
    last, behind = beyond[:2].tolist()
    # what the elements behind the cut bear, turned round: those before it may be the corner's, of another stiffness
    cuts = [(last, stressed.cut(last, behind, last)), (-last, stressed.cut(-behind, -last, -last))]
    both = [_about(radius * radial(at), -borne) for at, borne in cuts]
    inverse = np.linalg.inv(np.concatenate(both))
    inside = stressed.energy[np.abs(stressed.theta) < last].sum(axis=0) + stressed.corners
    whole = inverse.T @ inside @ inverse
    ends = (whole + whole.T) / 2
    answers = stressed.moved[ring.free] @ inverse
    return RodCompliance(radius, section, last, ends, ring, answers, misfit)


def _section(stressed: _Stressed, cuts: Array, radius: float) -> tuple[Array, float]:
    """Compliance of the section from the elements between ``cuts``, and its misfit."""
    # no load on them, so that the force and the moment about C are the same at all cuts
    forces = stressed.cut(cuts[0], cuts[-1], cuts[-1])
    thin = 12 / (1 - stressed.mesh.inner / stressed.mesh.outer) ** np.array([1, 1, 3, 2])
    rows, known = [], []
    for low, high in pairwise(cuts):
        middle, half = (low + high) / 2, (high - low) / 2
        inverse = np.linalg.pinv(_about(radius * radial(middle), forces))
        here = (low < stressed.theta) & (stressed.theta < high)
        energy = inverse.T @ stressed.energy[here].sum(axis=0) @ inverse / (2 * half)
        form = np.zeros((4, 3, 3))
        for x, weight in zip(_POINTS, _WEIGHTS, strict=True):
            at = _resultants(radius, middle, middle + half * x)
            pairs = [(at[0], at[0]), (at[1], at[1]), (at[2], at[2]), (at[0], at[2])]
            form += weight / 2 * np.array([(np.outer(a, b) + np.outer(b, a)) / 2 for a, b in pairs])
        form[3] *= 2
        # force and moment to the sizes of their compliances
        unit = np.sqrt(np.array([thin[0], thin[0], thin[2]]))
        rows.append((form * thin[:, None, None] / np.outer(unit, unit)).reshape(4, 9).T)
        known.append((energy / np.outer(unit, unit)).ravel())
    matrix, energies = np.concatenate(rows), np.concatenate(known)
    found = np.linalg.lstsq(matrix, energies, rcond=None)[0]
    nn, qq, mm, nm = found * thin
    # a quad bends evenly where M is linear and so lacks energy of the shear force, in a thin wall all of it and more
    # (L^2/12 of bending, L its length); no stress carries Q with less than an even one
    qq = max(qq, 2 * (1 + stressed.poisson) / (1 - stressed.mesh.inner / stressed.mesh.outer))
    section = np.array([[nn, 0.0, nm], [0.0, qq, 0.0], [nm, 0.0, mm]])
    return section, float(np.abs(matrix @ found - energies).max() / np.abs(energies).max())
