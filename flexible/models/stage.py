"""One implicit stage of the reduced hoop: Newton on frame, modes and the rim nodes near the floor together.

See :mod:`flexible.contact.stage` for the form of a stage.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import apart, loop, part

from ..contact.forces import contact_forces
from ..contact.forces import example as of_contact
from ..contact.guess import GUESSES, as_deep, guess_again, on_its_way, shift, slipping_on, too_deep
from ..contact.newton import before_bend, breaks_loose, goes, left_by_kept, left_by_newton, move, reached, round_off
from ..contact.points.data import MOST_ITERATIONS, Before, Contact, Damper, Parameters, Rim, pulling
from ..contact.stage import Predictor
from ..contact.vectors import eliminate, largest, plus, solved_by
from ..ring.frame import Body, Frame, inertia

MOST_POINTS = 5000  # to a patch, forty times as wide as under the weight or more: 1e5 weights are no solution

#: ways to begin: with the patch as deep and as fast as foreseen; as deep as before, as fast as guessed; that deep, and
#: held to the floor; let go of
FORESEEN, RAISED, HELD, LET_GO = 0, 1, 2, 3


class From(NamedTuple):
    """Where Newton begins, see :class:`flexible.contact.stage.Near`, in the window of the stage to solve."""

    u: Any  # displacement of the window's nodes
    deepest: float  # the least gap in the last stage
    elastic: float  # N_el there
    expected: float  # N_el here
    tolerance: float  # on forces over 1 + N
    begins: int  # FORESEEN, RAISED, HELD or LET_GO


class Window(NamedTuple):
    """What a ring of modes answers to the floor near which it is: u = shapes q + compliance f."""

    rim: Rim
    shapes: Any  # (2 nodes, n)
    compliance: Any  # (2 nodes, 2 nodes)


class Solved(NamedTuple):
    """A stage as compiled code leaves it."""

    iterations: int  # Newton's; negative when it did not converge, or the window was too short
    d: Any
    acc: Any
    forces: Any  # of inertia, gravity and strain on frame and modes
    u: Any  # (nodes, 2) displacement of the window's nodes
    matrix: Any  # factors of Newton's last, for the filter of the error estimate
    contact: Contact


@loop
def _misfit(residual: Any, own: Any, contact: Contact, window: Window, pos: Any, u: Any, scale: float) -> None:
    """What frame, modes and window lack of equilibrium."""
    m, nodes = own.shape[0], window.shapes.shape[0]
    for i in range(3):
        residual[i] = own[i] - contact.force[i]
    for i in range(3, m):
        pushed = 0.0
        for k in range(nodes):
            pushed += window.shapes[k, i - 3] * contact.nodal[k // 2, k % 2]
        residual[i] = own[i] - pushed
    for k in range(nodes):
        moved = 0.0
        for i in range(3, m):
            moved += window.shapes[k, i - 3] * pos[i]
        for i in range(nodes):
            moved += window.compliance[k, i] * contact.nodal[i // 2, i % 2]
        residual[m + k] = scale * (u[k // 2, k % 2] - moved)


@loop
def _assemble(matrix: Any, own: Any, contact: Any, window: Window, scale: float) -> None:
    """Newton's matrix for frame, modes and window, out of the tangents of inertia and contact."""
    # in loops: an assignment of slices would compile numpy's broadcasting with all its messages; the innermost along
    # rows, from their beginning: compiled code takes several numbers at once
    m, nodes = own.shape[0], window.shapes.shape[0]
    for i in range(m):
        row, edge = matrix[i], matrix[i, m:]
        for j in range(m):
            row[j] = own[i, j]
        for j in range(nodes):
            edge[j] = 0.0
        if i < 3:
            for j in range(3):
                row[j] -= contact[i, j]
            near = contact[i, 3:]
            for j in range(nodes):
                edge[j] = -near[j]
            continue
        for k in range(nodes):
            frame, near, shape = contact[3 + k], contact[3 + k, 3:], window.shapes[k, i - 3]
            for j in range(3):
                row[j] -= shape * frame[j]
            for j in range(nodes):
                edge[j] -= shape * near[j]
    for i in range(nodes):
        row, edge = matrix[m + i], matrix[m + i, m:]
        for j in range(nodes):
            edge[j] = 0.0
        for j in range(3):
            row[j] = 0.0
        for k in range(nodes):
            frame, near, gives = contact[3 + k], contact[3 + k, 3:], window.compliance[i, k]
            for j in range(3):
                row[j] += gives * frame[j]
            for j in range(nodes):
                edge[j] += gives * near[j]
        for j in range(3):
            row[j] *= -scale
        for j in range(nodes):
            edge[j] *= -scale
        for j in range(3, m):
            row[j] = -scale * window.shapes[i, j - 3]
        edge[i] += scale


@loop
def _guesses(begins: int, foreseen: bool) -> int:
    """How many guesses Newton begins with."""
    if begins == LET_GO:
        return 0
    return 1 if foreseen else GUESSES


@loop
def _along(begins: int, slipping: float, held: float) -> float:
    """How far along the floor Newton begins from where the guess is."""
    if begins == HELD:
        return held
    return slipping if begins == FORESEEN else 0.0


def example() -> tuple[tuple[Any, ...], Solved]:
    """Arguments and a result, of the types that compiled code has."""
    (row, table, rim, law, mode, before, damper, _), contact = of_contact()
    frame = Frame(Body(0.0, 0.0, 0.0, 0.0), table, table)
    start = From(table, 0.0, 0.0, 0.0, 0.0, 0)
    solved = Solved(0, row, row, row, table, (table, np.empty(0, np.int64)), contact)
    window = Window(rim, table, table)
    return (frame, window, law, mode, before, damper, Predictor(row, row, 0.0, row), start), solved


@apart(example, needs=(contact_forces, inertia))
def solve_stage(
    frame: Frame, window: Window, law: Parameters, mode: int, before: Before, damper: Damper, predictor: Predictor,
    start: From,
) -> Solved:  # fmt: skip
    """Solve one stage; ``predictor.guess`` and ``start.u`` are where Newton begins."""
    tolerance, nodes = start.tolerance, start.u.shape[0]
    m = 3 + frame.modal.shape[0]
    size = m + 2 * nodes
    d, u = predictor.guess.copy(), start.u.copy()
    height, phi = predictor.pos[1] + d[1], predictor.pos[2] + d[2]
    foreseen = start.begins == FORESEEN and as_deep(height, phi, u, window.rim, start)
    matrix, order = np.empty((size, size)), np.empty(size, np.int64)
    residual, update = np.empty(size), np.zeros(size)
    iterations, forces, damping, last = -1, d, 1.0, np.inf
    way_by, stood, way = predictor.guess, 0.0, np.nan
    stuck, halved, softest = 0.0, 0, largest(window.compliance)
    damper = pulling(damper, start.begins != LET_GO)
    iteration, guesses = -1, _guesses(start.begins, foreseen)
    asked = tolerance > 0  # for a tangent; nowhere a plain True, for which contact_forces would be compiled once more
    while iteration < MOST_ITERATIONS:
        pos, vel, acc = reached(predictor, d)
        contact = contact_forces(pos[:3], u, window.rim, law, mode, before, damper, asked)
        res = contact.res
        if guesses > 0:
            guesses = guess_again(pos[:3], u, window.rim, law, before, damper, contact, guesses)
            if guesses >= 0:
                continue
            by = _along(start.begins, slipping_on(law, before, damper, res), damper.way_0 - res.way)
            if by != 0:
                shift(u, pos[2], by, too_deep(law, start.expected, res) if foreseen else 0.0)
                guesses = 0
                continue
        contact = on_its_way(pos[:3], u, (window.rim, law, mode, before, damper), contact, way, asked)
        res, iteration = contact.res, iteration + 1
        if breaks_loose(res, stuck, halved):
            damping, halved, way = damping / 2, halved + 1, (stood + way) / 2
            move(d, u, damping, update[:m], update[m:])
            continue
        if start.begins == LET_GO and res.normal > 0:
            break
        stuck = res.stuck
        own, own_tangent = inertia(frame, pos, vel, acc, predictor.beta)
        scale = 1.0 + (law.eps_n + law.eps_t) * res.length  # turns an error of u into one of the forces
        _misfit(residual, own, contact, window, pos, u, scale)
        # of forces, and of displacements as forces on the foundation
        worst, astray = largest(residual[:m]), largest(residual[m:])
        small = tolerance * (1 + abs(res.normal)) + round_off(contact, pos[1], u, scale, damper)
        if not np.isfinite(worst + astray + small) or res.length > MOST_POINTS * law.spacing:
            break
        # a ring softer than the foundation moves by its compliance times what the forces may be off
        if worst <= small and astray <= small * (1 + scale * softest) and iteration > 0:
            if damper.pulls and res.eta < 0:
                damper, last, asked = pulling(damper, False), np.inf, iteration > 0
                continue
            iterations, forces = iteration, own
            break
        load = 1 + abs(res.normal)
        worst = max(worst, astray) / load
        if asked:
            _assemble(matrix, own_tangent, contact.tangent, window, scale)
            eliminate(matrix, order)
        elif left_by_kept(worst, last) > tolerance:  # the last one is not good enough for what it has left
            asked = not asked
            iteration -= 1
            continue
        update = solved_by((matrix, order), residual)
        if not np.isfinite(largest(update)):
            break
        damping = 0.5 if iteration > 3 and worst > last else 1.0
        way_by = contact.way_by if asked else way_by
        damping, stood, way = before_bend(res, damping, goes(way_by, update, update[m:]))
        # a tangent is a good part of what forces cost, and its matrix dear: kept where it will do for what is left
        left = left_by_newton(worst, last) if asked else left_by_kept(worst, last)
        asked = left_by_kept(left, worst) > tolerance
        last = worst
        move(d, u, -damping, update[:m], update[m:])
    if contact.outside:
        iterations = -2
    return Solved(iterations, d, reached(predictor, d)[2], forces, u, (matrix, order), contact)


@part
def filtered_error(frame: Frame, pos: Any, vel: Any, acc: Any, beta: float, factors: Any, error: Any) -> Any:
    """The error of the velocities as the step itself passes it on: (M + beta C + beta^2 K)^-1 M times it.

    What the step does not resolve, and damps, would otherwise hold the steps down to the vibrations' periods.
    """
    size = pos.shape[0]
    load = np.zeros(factors[1].shape[0])
    with_error, without = (
        inertia(frame, pos, vel, plus(acc, 1.0, error), beta)[0],
        inertia(frame, pos, vel, acc, beta)[0],
    )
    for i in range(size):
        load[i] = (with_error[i] - without[i]) / beta**2
    return solved_by(factors, load)[:size]
