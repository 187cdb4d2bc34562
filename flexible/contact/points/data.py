"""What goes through the compiled contact by name. R = m = g = 1 throughout.

Numba takes named tuples as arguments and results; fields typed ``Any`` are arrays, their shapes stand beside them.
"""

from __future__ import annotations

from math import inf, nan
from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import jit, loop, part


class Parameters(NamedTuple):
    """A scene's contact."""

    law: int  # code of the friction law
    spacing: float  # of the points, in theta
    eps_n: float  # normal foundation
    eps_t: float  # tangential foundation
    mu_s: float
    mu: float
    slip_scale: float  # slip velocity by which a regularised friction is smooth
    known: float  # to what share of 1 + N Newton finds the forces of a step


class Rim(NamedTuple):
    """The rim elements near the floor."""

    first: int  # of them, counted round and round
    vertex: Any  # (n_elements,) angles at which all elements of the rim begin


class Bristles(NamedTuple):
    """What is stored of the points in contact from step to step, as arrays of one length; ascending."""

    number: Any  # of the point, int64
    stretch: Any  # of its bristle
    pull: Any  # tangential force on it
    sliding: Any  # int8: direction in which friction pushes it where it slides; 0 where it sticks; twice it at rest


NO_DENT = np.empty((0, 2))


class Before(NamedTuple):
    """The contact at the beginning of a step."""

    pose: Any  # (3,) V, h, phi
    u: Any  # (2 count + 1, 2) displacement of the window's rim nodes
    bristles: Bristles
    first: int = 0  # rim element at which the nodes near the floor began then, and
    dent: Any = NO_DENT  # their displacement, (2 count + 1, 2); of no length off the floor
    halves: float = 0.0  # what of a point's way goes by the dent as it is at the end, of its weight by this pressure


@loop
def _halves(turn: float, length: float) -> float:
    """How much of the way of a patch goes by the dent as it is at the end of a step, and by the pressure at its start.

    The slip velocity is the rate of the way. If that went along the dent as it was at the start, weighed by the
    pressure as it is at the end, it would miss what the dent's slope has changed by since, times the rate of the turn,
    and have too much by the rate of the pressure, times how far each point has gone beyond the others: errors like the
    step, where the wall bends over a wide patch. By halves both are gone but for the step's square. In a step that
    turns the hoop by more than its patch is long, the ``turn`` of a stage by more than a half of that, the dent has
    come and gone with the nodes of the rim: the one at the end tells no more of the way then.
    """
    beyond = min(max(4 * abs(turn) / length - 1, 0.0), 1.0) if length > 0 else 1.0
    return (1 - beyond**2 * (3 - 2 * beyond)) / 2


@part
def at_start(old: Any, u: Any, beta: float) -> Before:
    """The contact at the beginning of a step from a state, whose rim has the displacement ``u`` in another window;
    ``beta`` is that of its stages (:class:`flexible.contact.stage.Predictor`)."""
    touches, halves = old.res.elastic > 0, _halves(old.vel[2] * beta, old.res.length)
    return Before(old.pos[:3], u, old.bristles, old.window[0], old.u if touches else old.u[:0], halves)


MOST_ITERATIONS = 40  # of Newton in a stage
EXACTLY = 1e-9  # of 1 + N: as well as Newton finds forces at any rtol, three digits below the least that is of use


class Damper(NamedTuple):
    """What rates are to the contact in one implicit stage.

    Pressures are eta times the elastic ones, eta = ``eta_0`` + ``relaxation`` (N_el - ``elastic_0``)/N_el, at least 0
    unless the damper ``pulls``: a floor does not, but Newton without that bound meets no bend in N, see
    :func:`pulling`.
    With x the mean way of the patch in the step, its slip velocity at the end of the stage is ``velocity_0`` + ``rate``
    (x - ``way_0``); a damped patch that sticks drags with ``held`` - ``drag`` (x - ``way_0``), shared like the
    pressure. The hoop turns by dphi, at the end with ``turning_0`` + ``ratio`` dphi over the stage's length.
    """

    relaxation: float  # the damper's time over the stage's beta
    elastic_0: float  # N_el if it had no rate
    eta_0: float
    drag: float
    way_0: float  # x if it had no rate
    ratio: float  # the stage's length over its beta
    rate: float  # 1/beta
    velocity_0: float
    turning_0: float = 0.0  # end rate of phi, over the stage's length, if the hoop had not turned
    pulls: bool = False
    held: float = 0.0  # by a step of no length, and on the way of Newton, see :mod:`flexible.contact.foreseen`


UNDAMPED = Damper(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


class Load(NamedTuple):
    """The normal force of the patch as a whole."""

    elastic: float  # N_el
    eta: float  # damping factor
    eta_rate: float  # its derivative by N_el


class Slip(NamedTuple):
    """The slip of the patch as a whole, rolling included."""

    way: float  # mean way along the floor since the step began, weighted by the load
    way_0: float  # what it would be if it had no rate
    velocity: float
    rate: float  # derivative of the velocity by the way
    drag: float  # of a sticking patch
    held: float  # the force of the drag at ``way_0``


class PointForces(NamedTuple):
    """Tangential forces of the points, and their derivatives."""

    force: Any  # (n,)
    share: Any  # (n,) by the damping factor eta
    by_abscissa: Any  # (n,)
    by_phi: Any  # (n,)
    by_way: Any  # (n,) by the mean way of the patch
    by_gap: Any  # (n, 5) by the gaps of two points before, the point, two points behind
    weight: Any  # (n,) length of patch that belongs to each
    weight_by: Any  # (n, 5) its derivatives by those gaps
    keeps: Any  # (n,) whose bristles outlast the step, not 0


class Shared(NamedTuple):
    """A tangential force on the patch as a whole, shared like the pressure, and its derivatives."""

    acts: bool
    force: float
    by_way: float
    by_elastic: float  # by N_el
    damping: float  # the part of it that is a damper's and no friction
    reach: float  # way over which it is about linear


class Tractions(NamedTuple):
    """What a friction law answers, besides the forces of the points."""

    shared: Shared
    energy: float  # stored
    stuck: float  # length of the patch that sticks
    feet: float  # how far the feet of the bristles slid in the step, where all slide
    like_pressure: bool  # whether all of it is shared so: its work is then that along the mean way


class Resultants(NamedTuple):
    """The patch as a whole."""

    normal: float
    friction: float
    normal_energy: float
    bristle_energy: float
    length: float
    stuck: float  # share of the length that sticks
    way: float  # mean, along the floor in the step
    low: float  # angles psi of the ends
    high: float
    elastic: float  # elastic part of the normal force
    eta: float  # damping factor
    damping: float  # part of the friction that is the damper's
    beyond: float  # work of the bristles beyond their mean force times the mean way
    steepness: float  # -dF/dx of a force shared by the patch as a whole, x its way
    reach: float  # in x over which that is about linear
    feet: float  # how far the feet of the bristles of a sliding patch slid in the step


class Rates(NamedTuple):
    """How a sliding patch changes at the end of a step, as far as it tells whether that would hold if it stuck."""

    normal: float  # of N
    elastic: float  # of N_el
    drag: float  # of what the damper would drag
    feet: float  # of the feet of its bristles, along the floor; nan where these entered in the same step


UNKNOWN = Rates(0.0, 0.0, 0.0, nan)


class Contact(NamedTuple):
    """Forces of the floor on the rim, their tangent, and the state of the patch."""

    force: Any  # (3,) generalised, on (V, h, phi)
    nodal: Any  # (2 count + 1, 2) on the nodes, in the disk's axes
    tangent: Any  # (n, n) derivative of (force, nodal) by (pose, u), n = 3 + 2 (2 count + 1)
    res: Resultants
    bristles: Bristles
    outside: bool  # whether the window of rim is too short for the patch
    by_eta: Any  # (n,) derivative of (force, nodal) by the damping factor, and
    by_held: Any  # (n,) by the damper's ``held``; both where there is a tangent and the damper acts
    way_by: Any  # (n,) derivative of the patch's way by (pose, u), where a tangent and a force that follows it are


NOTHING = Resultants(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf, 0.0)


@jit
def pulling(damper: Damper, pulls: bool) -> Damper:
    """The same damper, which may pull on the floor or not.

    Newton solves a stage with one that may: N is linear in N_el then, where the bound at 0 would leave a guess without
    any force of the floor, and so without a hint of where it is. Only where the damper pulls in the solution the stage
    is solved on with the bound; the solution then has N = 0, as inertia and N both grow with N_el.
    """
    return Damper(
        damper.relaxation, damper.elastic_0, damper.eta_0, damper.drag, damper.way_0, damper.ratio, damper.rate,
        damper.velocity_0, damper.turning_0, pulls, damper.held,
    )  # fmt: skip


def no_bristles() -> Bristles:
    """Those of a hoop off the floor."""
    return Bristles(np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty(0, np.int8))
