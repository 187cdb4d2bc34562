"""What all levels of the hoop share: the law of the contact, the patch's damper, the window of rim near the floor."""

from __future__ import annotations

from math import ceil, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from ..contact.laws.law import Law
from ..contact.laws.listing import LAWS
from ..contact.points.data import EXACTLY, Parameters
from ..contact.points.normal import half_width
from ..contact.points.rim import below_floor, window_around
from .state import State

Array = NDArray[np.float64]


LEAST_POINTS = 8  # points to a patch: with fewer the force of a patch that moves is noise
KNOWN = EXACTLY, 1e-4  # of 1 + N: Newton's least and largest tolerance on the forces of a step
#: least share of a step's tolerance on a soft ring; E I from which on it may have all of it, and rtol down from which;
#: E I below which the first and the last are less, like its power 3/2
STEPS = 0.3, 33.0, 3e-4, 1.0
#: wall over R from which on a step may have less of the tolerance, how much of it, and from which rtol down how much
TIGHTER = 0.15, 0.7, 3e-4, 0.3
#: wall over R from which on a step's tolerance falls faster than rtol, from which rtol down, like which power more, and
#: rtol as which no step is more exact: what is left then is round-off
FASTER = 0.06, 1e-4, 0.6, 5e-8
#: modes by whose error steps are chosen of a ring of nodes or parts; a reduced one has all of its own
SLOW = 24
COARSE = 1e-3  # rtol at which a law has its number of points; their share of the error falls like its cube, and faster


def points_to_a_patch(law: type[Law], rtol: float, soft: bool = False) -> int:
    """Contact points by which a patch under the weight is as accurate as a tolerance asks for.

    On a ``soft`` ring, whose sections turn far, there are as many as its law has for one, if those are more.
    """
    number = max(law.points, law.points_of_soft) if soft else law.points
    return ceil(max(LEAST_POINTS, number * (COARSE / rtol) ** (1 / 3)))


def known_to(rtol: float) -> float:
    """Share of 1 + N to which Newton finds the forces of a step: what is left falls faster than the tolerance.

    A thirtieth of it at 1e-3, where all else errs as much as it may; a thousandth at 1e-6, where limits of stiff
    floors are drawn from the differences of pulses.
    """
    least, most = KNOWN
    return min(max(least, rtol**1.5), most)


def contact_law(scene: Scene, elements: int, points: float, within: float = 0.0) -> Law:
    """The scene's friction law, with ``points`` to the patch of a rigid hoop under the disk's weight.

    ``within`` is what the rim's wall gives way by point by point, besides the foundation and its bristles.
    """
    contact, friction = scene.contact, scene.friction
    eps = 1 / (1 / contact.stiffness + within)
    law = LAWS[contact.law]
    parameters = Parameters(
        law=law.code,
        spacing=min(2 * half_width(1.0, eps) / points, 2 * pi / elements / 8),
        eps_n=eps,
        eps_t=1 / (1 / (contact.stiffness * contact.tangential_ratio) + within),
        mu_s=float(friction.mu_s),
        mu=float(friction.mu),
        slip_scale=float(contact.slip_velocity_scale),
        known=known_to(scene.solve.rtol),
    )
    return law(parameters)


def patch_stiffness(scene: Scene) -> float:
    """dN/ddelta of the patch of a rigid hoop under its own weight M g: 2 eps times its half-width."""
    eps = scene.contact.stiffness
    return 2 * eps * half_width(1 + scene.hoop.mass_ratio, eps)


def patch_period(scene: Scene) -> float:
    """Period in which a rigid hoop that stands on its patch moves up and down, undamped."""
    return 2 * pi * ((1 + scene.hoop.mass_ratio) / patch_stiffness(scene)) ** 0.5


def relaxation_time(scene: Scene) -> float:
    """The damper's time theta = 2 zeta sqrt(M/k), M the mass of disk and hoop and k the patch's stiffness under M g.

    A rigid hoop that stands on its patch, the disk lowest, then moves up and down with the damping ratio zeta. The
    patch is as stiff as it is wide, k = dN/ddelta = 2 eps a, which grows like N^(1/3), and away from phi = pi a
    vertical force at the floor sets less mass in motion, M/(1 + (e sin phi)^2/K): with theta a constant of the
    foundation the ratio elsewhere is zeta (N/(M g))^(1/6) sqrt(1 + (e sin phi)^2/K).
    """
    return 2 * scene.contact.damping * ((1 + scene.hoop.mass_ratio) / patch_stiffness(scene)) ** 0.5


def share_of_steps(scene: Scene) -> float:
    """Share of a step's tolerance by which the motion of a ring whose sections turn far is as exact as is asked for.

    In long steps instants at which the wall of a softer one comes down and leaves the floor are missed, on which the
    rest of a pulse hangs. See README.md, section 5.
    """
    least, stiff, fine, limp = STEPS
    bending = scene.ring.bending_stiffness
    of_softer = max(least, fine / scene.solve.rtol) * min(1.0, (bending / limp) ** 1.5)
    return min(max(of_softer, bending / stiff), 1.0) * LAWS[scene.contact.law].steps_of_soft


def share_of_linear_steps(scene: Scene) -> float:
    """The same of a linear ring: the less of a thick wall, whose vibrations hide more of the bristles' kinks.

    Where a brush slips and sticks over and over, as the modes of such a wall make it, errors of its steps add up as
    often as there are steps, and fall like a lower power of their tolerance. See README.md, section 5.
    """
    rtol = scene.solve.rtol
    wall, share, fine, of_fine = TIGHTER
    thick = 1.0 if scene.wall < wall else of_fine if rtol <= fine else share
    wall, fine, power, finest = FASTER
    return thick if scene.wall < wall else max(thick * min(1.0, rtol / fine) ** power, min(1.0, finest / rtol))


class RimContact:
    """The rim of a scene's hoop as the floor sees it.

    Parameters
    ----------
    vertex : (n_elements,) array
        Angles at which rim elements begin.
    points : float, optional
        Contact points to a patch; by default what the scene's tolerance asks for.
    within : float
        What the wall gives way by within an element, in R per pressure: the foundation and its bristles do in addition.
    around : int, optional
        Elements of the mesh, where the rim's are finer.
    """

    linear = True
    """Whether rotations of the ring's sections against one are neglected."""

    def __init__(
        self, scene: Scene, vertex: Array, points: float | None, within: float = 0.0, around: int | None = None
    ) -> None:
        self.scene = scene
        self.vertex = vertex
        middle = (vertex + np.append(vertex[1:], vertex[0] + 2 * pi)) / 2
        self.theta = np.column_stack([vertex, middle]).ravel()
        if points is None:
            points = points_to_a_patch(LAWS[scene.contact.law], scene.solve.rtol, soft=not self.linear)
        self.law = contact_law(scene, around or len(vertex), points, within)
        self.element = 2 * pi / len(vertex)
        self.relaxation = relaxation_time(scene)
        self.steps = share_of_linear_steps(scene) if self.linear else share_of_steps(scene)

    @property
    def vibrates(self) -> bool:
        """Whether a linear ring has a mass."""
        return self.linear and self.scene.hoop.mass_ratio > 0

    @property
    def arrays(self) -> Any:
        """See :class:`flexible.models.state.Model`: none, unless a level has them."""
        return None

    def learns(self, window: tuple[int, int] | None) -> bool:
        """See :class:`flexible.models.state.Model`."""
        return False

    def window(self, phi: float, low: float, high: float, margin: float) -> tuple[int, int]:
        """See :func:`window_around`."""
        window: tuple[int, int] = window_around(self.vertex, phi, low, high, margin)
        return window

    def reach(self, phi: float, height: float, moved: Array) -> tuple[float, float]:
        """Angles from the bottom between which rim nodes are below the floor; of the lowest node if none is.

        ``moved`` is the displacement of all rim nodes, (2 n_rim,), node by node.
        """
        low, high = below_floor(self.theta, phi, height, moved)
        return float(low), float(high)

    def lowest_in(self, state: State) -> tuple[int, int] | None:
        """A window in which the rim's lowest node is, and its neighbours; None where all nodes are known at once."""
        return None

    def rim_angle(self, nodes: NDArray[np.int64]) -> Array:
        """Angles of rim nodes, counted round and round from the first element's first."""
        return self.theta[nodes % len(self.theta)] + 2 * pi * (nodes // len(self.theta))
