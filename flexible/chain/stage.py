"""One implicit stage of the chain: Newton on frame, sections and the rim nodes near the floor together.

See :mod:`flexible.models.stage` for the stages, :mod:`flexible.chain.touch` for what the rim does. Newton's matrix is
exact in the contact, but for the bending of ``RimNodes.root``; that of the chain, whose stiffness and inertia change
little within a stage, is kept while that does.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import jit

from ..contact.forces import forces_in_newton
from ..contact.points.data import MOST_ITERATIONS, pulling
from .bordered import FRAME, Factors, factor, nothing_factored, solve
from .rim import follow
from .touch import Facing, add_bending, add_forces, add_rim, astray_of, kept_by, push, touch_of
from .whole import balance, sections, tangent

GROWS = 100.0  # a step of Newton after which the forces are off by this many times as much is taken back to a tenth
STALE = 0.1  # a step of Newton that leaves more than this of the forces is followed by a new matrix of the chain


class Solved(NamedTuple):
    """A stage as compiled code leaves it."""

    iterations: int  # Newton's; negative when it did not converge, -2 when the window was too short
    d: Any
    u: Any  # (m, 2) displacement of the window's nodes
    factors: Factors  # of Newton's last matrix
    contact: Any


@jit
def _largest(values: Any) -> float:
    """Largest absolute value, infinite if any is not a number."""
    most = 0.0
    for value in values.flat:
        if not np.isfinite(value):
            return np.inf
        most = max(most, abs(value))
    return most


@jit
def _round_off(chain: Any, contact: Any, pos: Any, acc: Any, u: Any, scale: float, damper: Any) -> float:
    """Size of the rounding errors: of the gap's, of the damping factor's, of the slip's, of strain and inertia."""
    res, rod = contact.res, chain.rod
    gap = 4e-16 * scale * (abs(pos[1]) + np.abs(u).max())
    floor = (damper.relaxation + 1) * (gap + 1e-14 * res.elastic)
    floor += 1e-15 * max(damper.drag, res.steepness) * (abs(res.way) + abs(damper.way_0))
    floor += 4e-16 * np.abs(rod.local[rod.local.shape[0] // 2]).max() * np.abs(pos[FRAME:]).max()
    return floor + 4e-16 * chain.body.ring_mass * np.abs(acc[FRAME:]).max()


@jit
def solve_stage(
    chain: Any, facing: Facing, law: Any, mode: int, before: Any, damper: Any, predictor: Any, start: Any
) -> Solved:
    """Solve one stage.

    Parameters
    ----------
    chain : Chain
    facing : Facing
    law, mode, before, damper :
        See :func:`flexible.contact.forces.contact_forces`.
    predictor : flexible.models.stage.Predictor
    start : tuple
        What the nodes move beyond the sections, (m, 2), to begin with; tolerance on forces.
    """
    pos_pred, vel_pred, beta = predictor.pos, predictor.vel, predictor.beta
    beyond, tolerance = start
    nodes, rod = facing.nodes, chain.rod
    m = nodes.part.shape[0]
    keeps, place = kept_by(rod.theta.shape[0], nodes.part)
    inner = FRAME + 3 * keeps.sum()
    d = predictor.guess.copy()
    u = follow(rod, sections(pos_pred + d), nodes)[0] + beyond
    update, update_u = np.zeros(d.shape), np.zeros(u.shape)
    iterations, damping, last = -1, 1.0, np.inf
    way, reach = 0.0, np.inf
    factors = nothing_factored()
    chained, stale = factors.core, True
    softest = np.abs(facing.missing).max()
    damper = pulling(damper, True)
    for iteration in range(MOST_ITERATIONS):
        pos, vel, acc = pos_pred + d, vel_pred + d / beta, d / beta**2
        contact = forces_in_newton(pos[:FRAME], u, facing.rim, law, mode, before, damper, iteration == 0)
        res = contact.res
        # across the bend of a smoothed friction Newton would go to and fro for ever
        if res.elastic > 0 and abs(res.way - way) > 1.5 * reach:
            share = reach / abs(res.way - way)
            d += damping * (1 - share) * update
            u += damping * (1 - share) * update_u
            damping *= share
            continue
        way, reach = res.way, res.reach
        q, frame, force = balance(chain, pos, vel, acc)
        touch = touch_of(rod, q, facing, place, inner, u)
        scale = 1.0 + (law.eps_n + law.eps_t) * res.length  # turns an error of u into one of the forces
        push(touch, contact, place, frame, force)
        rest = astray_of(touch, contact.nodal, scale)
        worst, astray = max(_largest(frame), _largest(force[1:-1])), _largest(rest)
        small = tolerance * (1 + abs(res.normal)) + _round_off(chain, contact, pos, acc, u, scale, damper)
        if not np.isfinite(worst + astray + small):
            break
        if max(worst, astray) > GROWS * last and damping > 1e-9:  # beyond a bend, the damper's onset for one
            d += 0.9 * damping * update
            u += 0.9 * damping * update_u
            damping *= 0.1
            continue
        if worst <= small and astray <= small * (1 + scale * softest) and iteration > 0:
            if damper.pulls and res.eta < 0:
                damper, last = pulling(damper, False), np.inf
                continue
            iterations = iteration
            break
        worst = max(worst, astray)
        if stale or (iteration > 1 and worst > STALE * last):
            factors = factor(tangent(chain, pos, vel, acc, beta), keeps, 2 * m)
            chained, stale = factors.core.copy(), False
        factors.core[:] = chained
        add_forces(factors.core, touch, contact.nodal, contact.tangent)
        add_bending(factors.core, rod, q, nodes, place, contact.nodal)
        add_rim(factors.core, touch, contact.nodal, contact.tangent, scale)
        update, step_u = solve(factors, frame, force, rest)
        if not np.isfinite(_largest(update) + _largest(step_u)):
            break
        update_u = step_u.reshape(m, 2)
        damping = 0.5 if iteration > 3 and worst > last else 1.0
        last = worst
        d -= damping * update
        u -= damping * update_u
    if contact.outside:
        iterations = -2
    return Solved(iterations, d, u, factors, contact)
