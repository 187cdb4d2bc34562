"""What Newton on a stage is alike for all rings in compiled code: increments, steps taken back, rounding errors."""

from __future__ import annotations

from typing import Any

from rigid.kernel.compile import loop, part

from .points.data import Contact, Damper, Resultants
from .vectors import add, dot, largest, plus, times

FRAME = 3  # V, h, phi, before the nodes
HALVINGS = 6  # of a step of Newton that breaks a patch loose
FEW = 0.1  # share of a patch that sticks whose breaking loose is no danger to Newton
BENT = 0.03  # of the square of a misfit over 1 + N, what Newton leaves at most in four of five first steps


@part
def reached(predictor: Any, d: Any) -> tuple[Any, Any, Any]:
    """Position, velocity and acceleration with an increment, see :class:`flexible.contact.stage.Predictor`."""
    beta = predictor.beta
    return plus(predictor.pos, 1.0, d), plus(predictor.vel, 1 / beta, d), times(1 / beta**2, d)


@loop
def move(d: Any, u: Any, factor: float, update: Any, update_u: Any) -> None:
    """Move the increment and the window's nodes by so many times an update, that of the nodes flat."""
    add(d, factor, update)
    for k in range(update_u.shape[0]):
        u[k // 2, k % 2] += factor * update_u[k]


@loop
def goes(way_by: Any, update: Any, update_u: Any) -> float:
    """How far along the floor a patch goes back with an update, to the first order."""
    return dot(way_by[:FRAME], update[:FRAME]) + dot(way_by[FRAME:], update_u)


@loop
def before_bend(res: Resultants, damping: float, back: float) -> tuple[float, float, float]:
    """How many times an update, by which the patch goes ``back``, is taken; its way before and after that.

    Smoothed friction is straight over ``res.reach``: across its bend Newton would go to and fro for ever.
    """
    if abs(damping * back) > 1.5 * res.reach:
        damping = res.reach / abs(back)
    return damping, res.way, res.way - damping * back


@loop
def breaks_loose(res: Resultants, stuck: float, halved: int) -> bool:
    """Whether a step of Newton after which no point of a patch sticks, where a share of it did, is to be halved.

    It may pass the bristles' reach on both sides; and where all slide nothing tells where they would stick. A patch
    that does break loose still does so after a 64th of the step. The last points to stick, at an edge, are let go at
    once: what they pull is nothing. A patch whose N the damper has taken away, or made a pull, holds nothing at all.
    """
    return bool(stuck > FEW and res.stuck == 0 and res.normal > 0 and halved < HALVINGS)


@loop
def round_off(contact: Contact, height: float, u: Any, scale: float, damper: Damper) -> float:
    """Size of the rounding errors in the contact's forces: of the gap's, of the damping factor's, of the slip's."""
    res = contact.res
    gap = 4e-16 * scale * (abs(height) + largest(u))
    floor = (damper.relaxation + damper.eta_0) * (gap + 1e-14 * res.elastic)
    return floor + 1e-15 * max(damper.drag, res.steepness) * (abs(res.way) + abs(damper.way_0))


@loop
def left_by_kept(last: float, before_last: float) -> float:
    """What a step with the matrix of the last one, which left ``last`` of ``before_last``, is to leave in its turn.

    A matrix is as wrong as what it leaves of a misfit is large, by twice as much where the misfit is a square.
    """
    return 2 * last * last / before_last


@loop
def left_by_newton(last: float, before_last: float) -> float:
    """What a step of Newton is to leave of a misfit ``last``, over 1 + N: its square, as many times as before."""
    return last * last * max(last / (before_last * before_last), BENT)
