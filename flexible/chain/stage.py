"""One implicit stage of the chain: Newton on frame, sections and the rim nodes near the floor together.

See :mod:`flexible.contact.stage` for the stages, :mod:`flexible.chain.touch` for what the rim does. Newton's matrix is
exact in the contact, but for the bending of ``RimNodes.root``; that of the chain, whose stiffness and inertia change
little within a stage, is kept while that does.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import apart, jit, part

from ..contact.forces import contact_forces
from ..contact.forces import example as of_contact
from ..contact.foreseen import Foreseen, between, foresee, moved_back, moved_by, moved_damper
from ..contact.guess import GUESSES, as_before, guess_again, held_again, is_let_go, on_its_way
from ..contact.newton import FRAME, before_bend, breaks_loose, goes, move, reached
from ..contact.points.data import MOST_ITERATIONS, Before, Bristles, Parameters, Rim, at_start, pulling
from ..contact.points.rim import margin_around, vertex_angle, window_around
from ..contact.stage import Predictor, Stage
from ..contact.vectors import eliminate, largest, plus, times
from .bordered import Factors, as_one, factor, nothing_factored, solve
from .mass.ends import EndMass
from .mass.inertia import Chain, ChainBody
from .misfit import close, misfit, rounding
from .rim import RimNodes, follow
from .rod.corotated import Rod
from .touch import Facing, kept_by, touch_of
from .whole import balance, beside, lacking, moved, near_floor, reach, sections, tangent

GROWS = 2.0  # a step of Newton after which the forces are off by this many times as much is taken back to a half
LATE = 12  # iterations after which it is where it leaves more at all: it goes to and fro
SOFTER = 1e4  # times as soft as its own is the foundation from which a stage is followed that Newton lost
ROUGHLY = 1e-4  # tolerance on the way from there
STALE = 0.1  # a step of Newton that leaves more than this of the forces is followed by a new matrix of the chain


class Arrays(NamedTuple):
    """A hoop whose ring is a chain, in compiled code."""

    chain: Chain
    nodes: RimNodes  # of the whole rim
    missing: Any  # (2 n_rim, 2 n_rim) compliance that the chain lacks for E b = 1
    stiffness: float  # E b
    slow: Any  # (k, 3 n) momenta of the slow vibrations of a rate of the sections
    vertex: Any  # (n_elements,) angles at which rim elements begin
    theta: Any  # (n_rim,) angles of rim nodes
    element: float  # mean length of one
    law: Parameters
    looked: Any  # (2,) angles between which the first stage of a step has looked for the floor


class Begin(NamedTuple):
    """Where Newton begins."""

    d: Any  # increment
    u: Any  # (m, 2) displacement of the nodes
    foreseen: Foreseen
    tolerance: float  # on forces over 1 + N
    let_go: bool  # of a patch that is (:func:`flexible.contact.guess.is_let_go`)


class Solved(NamedTuple):
    """A stage as compiled code leaves it."""

    iterations: int  # Newton's; -1 when it did not converge, -2 when it did in too short a window
    d: Any
    forces: Any  # of inertia, gravity and strain on frame and sections
    u: Any  # (m, 2) displacement of the window's nodes
    factors: Factors  # of Newton's last matrix
    contact: Any


def example() -> tuple[tuple[Any, ...], Solved]:
    """Arguments and a result, of the types that compiled code has."""
    (row, table, rim, law, mode, before, damper, _), contact = of_contact()
    count, cube = np.empty(0, np.int64), np.empty((0, 2, 2))
    seen, none = np.empty((0, 2, 4, 3)), (0.0,) * 6
    far = np.empty((0, 3, 3, 3, 3))
    rod = Rod(
        row, table, table, cube, cube, row, row, row, seen, far, 0.0, table, row, row, table, 0.0, 0.0, 0.0, seen, 0
    )  # fmt: skip
    chain = Chain(ChainBody(*none), rod, EndMass(table, table, table, row, row))
    facing = Facing(rim, RimNodes(count, row, cube, np.empty((0, 2, 2, 3, 3))), table)
    start = Begin(row, table, Foreseen(0.0, 0.0), 0.0, False)
    solved = Solved(0, row, row, table, nothing_factored(), contact)
    return (chain, facing, law, mode, before, damper, Predictor(row, row, 0.0, row), start), solved


@apart(example, needs=(contact_forces,))
def solve_stage(
    chain: Any, facing: Facing, law: Any, mode: int, before: Any, damper: Any, predictor: Any, start: Begin
) -> Solved:
    """Solve one stage.

    Parameters
    ----------
    chain : Chain
    facing : Facing
    law, mode, before, damper :
        See :func:`flexible.contact.forces.contact_forces`.
    predictor : flexible.contact.stage.Predictor
    start : Begin
    """
    d, u, foreseen, tolerance, let_go = start.d.copy(), start.u.copy(), start.foreseen, start.tolerance, start.let_go
    nodes, rod, m = facing.nodes, chain.rod, facing.nodes.part.shape[0]
    keeps, place = kept_by(rod.theta.shape[0], nodes.part)
    update, update_u = np.zeros(d.shape[0]), np.zeros(2 * m)
    iterations, damping, last, forces, stood, way, stuck, halved = -1, 1.0, np.inf, d, 0.0, np.nan, 0.0, 0
    factors, stands, moved_before, stale = nothing_factored(), foreseen, False, True
    chained, inner = factors.core, FRAME + 3 * keeps.sum()
    softest, damper, iteration = largest(facing.missing), pulling(damper, not let_go), -1
    guesses, asked = 0 if let_go else GUESSES, tolerance > 0  # a plain True would compile contact_forces once more
    while iteration < MOST_ITERATIONS:
        pos, vel, acc = reached(predictor, d)
        contact = contact_forces(pos[:FRAME], u, facing.rim, law, mode, before, damper, asked)
        if guesses > 0:
            guesses = guess_again(pos[:FRAME], u, facing.rim, law, before, damper, contact, guesses)
            if guesses >= 0:
                continue
        touching = (facing.rim, law, mode, before, damper)
        if let_go and contact.res.normal > 0:  # it is not
            break
        if iteration < 0 and not let_go:
            contact = held_again(pos[:FRAME], u, touching, contact, foreseen, asked)
        contact = on_its_way(pos[:FRAME], u, touching, contact, way, asked)
        iteration, res = iteration + 1, contact.res
        moved = moved_by(damper, foreseen, res)
        moves, carries = moved.elastic != 0 or moved.held != 0, contact
        if moves:
            by = moved_damper(damper, moved)
            carries = contact_forces(pos[:FRAME], u, facing.rim, law, mode, before, by, asked)
        if breaks_loose(carries.res, stuck, halved):
            damping, halved = damping / 2, halved + 1
            move(d, u, damping, update, update_u)
            foreseen, way = between(stands, foreseen, 0.5), (stood + way) / 2
            continue
        halved = 0
        q, frame, force = balance(chain, pos, vel, acc)
        touch = touch_of(rod, q, facing, place, inner, u)
        scale = 1.0 + (law.eps_n + law.eps_t) * res.length  # turns an error of u into one of the forces
        lacks = misfit(touch, contact, place, (frame, force), scale)
        small = tolerance * (1 + abs(res.normal)) + rounding(chain, contact, pos, acc, u, scale, damper)
        if not np.isfinite(lacks.forces + lacks.nodes + small):
            break
        if lacks.forces <= small and lacks.nodes <= small * (1 + scale * softest) and iteration > 0:
            if damper.pulls and res.eta < 0:
                damper, last = pulling(damper, False), np.inf
                continue
            iterations, forces = iteration, as_one(frame, force)
            break
        worst = lacks.forces
        if moves:
            worst = misfit(touch, carries, place, (frame, force), scale).forces
            lacks = misfit(touch, moved_back(carries, damper, moved), place, (frame, force), scale)
        elif moved_before or (stands.normal == 0 and res.elastic > 0):
            last = np.inf  # of another damper; and what lands too deep comes up
        if worst > (GROWS if iteration < LATE else 1.0) * last and damping > 1e-9:  # beyond a bend, as a damper's onset
            damping /= 2
            move(d, u, damping, update, update_u)
            foreseen, way = between(stands, foreseen, 0.5), (stood + way) / 2
            continue
        if stale or (iteration > 1 and worst > STALE * last):
            factors = factor(tangent(chain, pos, vel, acc, predictor.beta), keeps, 2 * m)
            chained, stale = factors.core.copy(), False
        close(factors.core, chained, touch, carries, (rod, q, nodes, place), scale)
        eliminate(factors.core, factors.pivots)
        update, update_u = solve(factors, lacks.frame, lacks.sections, lacks.rest)
        if not np.isfinite(largest(update) + largest(update_u)):
            break
        damping = 0.5 if iteration > 0 and worst > last else 1.0
        whole = damping
        damping, stood, way = before_bend(res, damping, goes(contact.way_by, update, update_u))
        # at a bend a misfit may be larger, and is not to be taken back from there
        last, moved_before = worst if damping == whole else np.inf, moves
        stands, stuck = Foreseen(carries.res.normal, carries.res.friction), carries.res.stuck
        foreseen = between(stands, foresee(damper, moved, carries, update, update_u), damping)
        move(d, u, -damping, update, update_u)
    if iterations >= 0 and contact.outside:
        iterations = -2
    return Solved(iterations, d, forces, u, factors, contact)


@part
def _followed(
    arrays: Any, facing: Facing, mode: int, before: Before, damper: Any, predictor: Any, begins: Begin
) -> Solved:  # fmt: skip
    """The stage followed from a softer foundation, on which more of the rim lies and less of it comes and goes."""
    law, bristles = arrays.law, before.bristles
    d, u, foreseen, tolerance, let_go = begins
    softer = SOFTER
    while True:
        by = Parameters(
            law.law, law.spacing, law.eps_n / softer, law.eps_t / softer, law.mu_s, law.mu, law.slip_scale, law.known,
        )  # fmt: skip
        held = Bristles(bristles.number, times(softer, bristles.stretch), bristles.pull, bristles.sliding)
        since = Before(before.pose, before.u, held, before.first, before.dent, before.halves)
        start = Begin(d, u, foreseen, tolerance if softer <= 1 else ROUGHLY, let_go)
        answer = solve_stage(arrays.chain, facing, by, mode, since, damper, predictor, start)
        if answer.iterations < 0 or softer <= 1:
            return answer
        d, u, softer = answer.d, answer.u, softer / 10


def _solved(arrays: Arrays, old: Any, mode: int, damper: Any, predictor: Any, near: Any, first: bool) -> Stage:
    """See ``stage`` of :class:`flexible.models.state.Model`."""
    massless, vertex = arrays.chain.body.ring_mass == 0, arrays.vertex
    if massless:  # no inertia to go by: from where the ring was
        for i in range(FRAME, old.pos.shape[0]):
            predictor.guess[i] = old.pos[i] - predictor.pos[i]
    expected, nothing = plus(predictor.pos, 1.0, predictor.guess), np.zeros(old.pos.shape[0])
    looked = arrays.looked  # all stages of a step look where the first one does
    if first:
        low, high = reach(arrays, expected)
        if old.res.normal > 0:
            low, high = min(low, old.res.low), max(high, old.res.high)
        looked[0], looked[1] = low, high
    margin = margin_around(looked[0], looked[1], arrays.element)
    found = Stage(
        False, expected, expected, expected, nothing_factored(), old.window, old.u, old.nodal, old.res, old.bristles
    )  # fmt: skip
    for _ in range(4):
        window = window_around(vertex, expected[2], looked[0], looked[1], margin)
        u_old, beyond = moved(arrays, old, window)
        number, nodes = near_floor(arrays, window)
        facing = Facing(Rim(window[0], vertex), nodes, lacking(arrays, number, number))
        before = at_start(old, u_old, predictor.beta)
        u = follow(arrays.chain.rod, sections(expected), nodes)[0]
        move(expected, u, 1.0, nothing, beyond.ravel())
        foreseen, free = Foreseen(old.res.normal, old.res.friction), is_let_go(old.res)
        begins = Begin(predictor.guess, u, foreseen, near.known, free)
        answer = solve_stage(arrays.chain, facing, arrays.law, mode, before, damper, predictor, begins)
        if free and answer.iterations == -1:
            begins = Begin(predictor.guess, u, foreseen, near.known, False)
            answer = solve_stage(arrays.chain, facing, arrays.law, mode, before, damper, predictor, begins)
        if answer.iterations == -1 and old.res.elastic > 0:
            as_before(expected, u, facing.rim, before)
            answer = solve_stage(arrays.chain, facing, arrays.law, mode, before, damper, predictor, begins)
            if answer.iterations == -1:
                answer = _followed(arrays, facing, mode, before, damper, predictor, begins)
        contact, d = answer.contact, answer.d
        acc = times(1 / predictor.beta**2, d)
        if massless:
            acc[FRAME:] = 0.0
        found = Stage(
            False, d, acc, answer.forces, answer.factors, window, answer.u, contact.nodal, contact.res, contact.bristles
        )  # fmt: skip
        if answer.iterations == -2:
            margin = 2 * margin + arrays.element
            continue
        if answer.iterations < 0:
            break
        # a soft ring bulges: in a long step another part of it may have come down
        at = plus(predictor.pos, 1.0, d)
        lower, higher = reach(arrays, at)
        gives = 2 * largest(facing.missing) * (abs(contact.res.normal) + abs(contact.res.friction))
        ahead, behind = beside(arrays, at, window, answer.u, contact.nodal, gives)
        start = at[2] - np.pi + vertex_angle(vertex, window[0]) - arrays.element / 2
        lower = min(lower, start) if ahead < 0 else lower
        higher = max(higher, start + (window[1] + 1) * arrays.element) if behind < 0 else higher
        begin, count = window_around(vertex, at[2], lower, higher, 0.0)
        if window[0] <= begin and begin + count <= window[0] + window[1]:
            return Stage(
                True, d, acc, answer.forces, answer.factors, window, answer.u, contact.nodal, contact.res,
                contact.bristles,
            )  # fmt: skip
        looked[0], looked[1] = min(looked[0], lower), max(looked[1], higher)
    return found


solved, solved_in_step = jit(_solved, needs=(solve_stage,)), part(_solved)
