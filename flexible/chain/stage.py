"""One implicit stage of the chain: Newton on frame, sections and the rim nodes near the floor together.

See :mod:`flexible.models.stage` for the stages, :mod:`flexible.chain.touch` for what the rim does. Newton's matrix is
exact in the contact, but for the bending of ``RimNodes.root``; that of the chain, whose stiffness and inertia change
little within a stage, is kept while that does.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import jit, part

from ..contact.forces import contact_forces
from ..contact.guess import GUESSES, guess_again
from ..contact.newton import breaks_loose, move, reached, round_off, share_before_bend
from ..contact.points.data import MOST_ITERATIONS, pulling
from ..contact.vectors import largest
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


@part
def _round_off(chain: Any, contact: Any, pos: Any, acc: Any, u: Any, scale: float, damper: Any) -> float:
    """Size of the rounding errors: of the contact's, of strain and inertia."""
    local = chain.rod.local
    floor = round_off(contact, pos[1], u, scale, damper)
    floor += 4e-16 * largest(local[local.shape[0] // 2]) * largest(pos[FRAME:])
    return floor + 4e-16 * chain.body.ring_mass * largest(acc[FRAME:])


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
    beyond, tolerance = start
    nodes, rod = facing.nodes, chain.rod
    m = nodes.part.shape[0]
    keeps, place = kept_by(rod.theta.shape[0], nodes.part)
    inner = FRAME + 3 * keeps.sum()
    d = predictor.guess.copy()
    u = follow(rod, sections(reached(predictor, d)[0]), nodes)[0]
    for k in range(m):
        u[k, 0] += beyond[k, 0]
        u[k, 1] += beyond[k, 1]
    update, update_u = np.zeros(d.shape[0]), np.zeros(2 * m)
    iterations, damping, last = -1, 1.0, np.inf
    way, reach = 0.0, np.inf
    stuck, halved = 0.0, 0
    factors = nothing_factored()
    chained, stale = factors.core, True
    softest = largest(facing.missing)
    damper = pulling(damper, True)
    iteration, guesses = -1, GUESSES
    while iteration < MOST_ITERATIONS:
        pos, vel, acc = reached(predictor, d)
        # always with a tangent, but not by a plain True, for which contact_forces would be compiled once more
        contact = contact_forces(pos[:FRAME], u, facing.rim, law, mode, before, damper, guesses <= GUESSES)
        res = contact.res
        if guesses > 0:
            guesses = guess_again(pos[:FRAME], u, facing.rim, law, before, damper, contact, guesses)
            if guesses >= 0:
                continue
        iteration += 1
        share = share_before_bend(res, way, reach)
        if breaks_loose(res, stuck, halved):
            share, halved = 0.5, halved + 1
        if share < 1:
            move(d, u, damping * (1 - share), update, update_u)
            damping *= share
            continue
        way, reach, stuck, halved = res.way, res.reach, res.stuck, 0
        q, frame, force = balance(chain, pos, vel, acc)
        touch = touch_of(rod, q, facing, place, inner, u)
        scale = 1.0 + (law.eps_n + law.eps_t) * res.length  # turns an error of u into one of the forces
        push(touch, contact, place, frame, force)
        rest = astray_of(touch, contact.nodal, scale)
        worst, astray = max(largest(frame), largest(force[1:-1])), largest(rest)
        small = tolerance * (1 + abs(res.normal)) + _round_off(chain, contact, pos, acc, u, scale, damper)
        if not np.isfinite(worst + astray + small):
            break
        if max(worst, astray) > GROWS * last and damping > 1e-9:  # beyond a bend, the damper's onset for one
            move(d, u, 0.9 * damping, update, update_u)
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
            factors = factor(tangent(chain, pos, vel, acc, predictor.beta), keeps, 2 * m)
            chained, stale = factors.core.copy(), False
        for i in range(chained.shape[0]):
            for k in range(chained.shape[0]):
                factors.core[i, k] = chained[i, k]
        add_forces(factors.core, touch, contact.nodal, contact.tangent, scale)
        add_bending(factors.core, rod, q, nodes, place, contact.nodal)
        add_rim(factors.core, touch, contact.nodal, scale)
        update, update_u = solve(factors, frame, force, rest)
        if not np.isfinite(largest(update) + largest(update_u)):
            break
        damping = 0.5 if iteration > 3 and worst > last else 1.0
        last = worst
        move(d, u, -damping, update, update_u)
    if contact.outside:
        iterations = -2
    return Solved(iterations, d, u, factors, contact)
