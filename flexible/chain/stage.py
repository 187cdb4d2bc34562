"""One implicit stage of the chain: Newton on frame, sections and the rim nodes near the floor together.

See :mod:`flexible.models.stage` for the stages. The rim follows the sections and gives way by itself,

    u = U(q) + Q S Q^T f,

f the floor's forces on its nodes, S the compliance that the chain lacks and Q the rotation of the ring at each node.
The forces act where the rim then is, so that they turn the ring by their lever Q S Q^T f as well: what the floor does
to the rim arrives at the ring.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from rigid.kernel.compile import jit

from ..contact.forces import ELASTIC, EPS_N, EPS_T, LENGTH, NORMAL, OUTSIDE, SLIP, contact_forces
from .bordered import FRAME, _empty, factor, solve
from .corotated import elastic
from .inertia import inertia
from .rim import follow, rim_curvature, rim_point


@jit
def floor(contact: Any, pose: Any, u: Any) -> Any:
    """The floor's forces (:func:`flexible.contact.forces.contact_forces`); ``contact`` holds all else it asks for."""
    first, vertex, law, mode, old_pose, u_old, bristles, flags, damper = contact
    return contact_forces(pose, u, first, vertex, law, mode, old_pose, u_old, bristles, flags, damper)


@jit
def turned(missing: Any, rows: Any, columns: Any) -> Any:
    """Q S Q^T for rotations of the nodes."""
    result = np.empty(missing.shape)
    cr, sr, cc, sc = np.cos(rows), np.sin(rows), np.cos(columns), np.sin(columns)
    for i in range(rows.shape[0]):
        for j in range(columns.shape[0]):
            a, b = missing[2 * i, 2 * j], missing[2 * i, 2 * j + 1]
            c, d = missing[2 * i + 1, 2 * j], missing[2 * i + 1, 2 * j + 1]
            e, f = cr[i] * a - sr[i] * c, cr[i] * b - sr[i] * d
            g, h = sr[i] * a + cr[i] * c, sr[i] * b + cr[i] * d
            result[2 * i, 2 * j], result[2 * i, 2 * j + 1] = e * cc[j] - f * sc[j], e * sc[j] + f * cc[j]
            result[2 * i + 1, 2 * j], result[2 * i + 1, 2 * j + 1] = g * cc[j] - h * sc[j], g * sc[j] + h * cc[j]
    return result


@jit
def rise(rod: Any, q: Any, nodes: Any, theta: Any, phi: float, height: float) -> Any:
    """Gap of rim nodes that follow the sections, and their angles from the bottom in (-pi, pi]."""
    s, c = sin(phi), cos(phi)
    m = theta.shape[0]
    gap, psi = np.empty(m), np.empty(m)
    moved, by = np.empty(2), np.empty((2, 18))
    for k in range(m):
        rim_point(rod, q, nodes.part[k], nodes.xi[k], nodes.root[k], moved, by)
        angle = phi - np.pi + theta[k]
        psi[k] = angle - 2 * np.pi * np.round(angle / (2 * np.pi))
        gap[k] = height + 2 * sin(angle / 2) ** 2 + moved[0] * c - moved[1] * s
    return gap, psi


@jit
def _kept(sections: int, part: Any) -> tuple[Any, Any]:
    """Flags of the sections that nodes follow and of the first one, and where each stands in the core.

    Nodes near the weld follow the first and the last section.
    """
    keeps, place = np.zeros(sections, np.bool_), np.full(sections, -1)
    keeps[1] = True
    for k in range(part.shape[0]):
        if part[k] >= 0:
            for i in range(max(part[k] - 1, 1), min(part[k] + 3, sections - 1)):
                keeps[i] = True
        if part[k] <= 0 or part[k] == sections - 2:
            keeps[sections - 2] = True
    at = FRAME
    for i in range(sections):
        if keeps[i]:
            place[i] = at
            at += 3
    return keeps, place


@jit
def _condense(by: Any, part: Any, xi: Any, place: Any, size: int) -> tuple[Any, Any]:
    """Derivatives of displacements (2 m, size) and rotations (m, size) of nodes by the core's unknowns."""
    m = part.shape[0]
    follow, turning = np.zeros((2 * m, size)), np.zeros((m, size))
    for k in range(m):
        for slot in range(6):
            i = part[k] - 1 + slot
            if slot == 4:
                i = 1
            elif slot == 5:
                i = place.shape[0] - 2
            elif part[k] < 0:
                continue
            if i < 1 or i >= place.shape[0] or place[i] < 0:
                continue
            for a in range(3):
                follow[2 * k, place[i] + a] += by[k, 0, 3 * slot + a]
                follow[2 * k + 1, place[i] + a] += by[k, 1, 3 * slot + a]
            if slot == 1:
                turning[k, place[i] + 2] = 1 - xi[k]
            elif slot == 2:
                turning[k, place[i] + 2] = xi[k]
    return follow, turning


@jit
def _add_floor(core: Any, q: Any, rod: Any, part: Any, xi: Any, place: Any, follow: Any, turning: Any, lever: Any,
               nodal: Any, tangent: Any, yields: Any, scale: float) -> None:  # fmt: skip
    """Complete the core: the floor's forces on frame and sections, and the rim's nodes.

    ``lever`` is u - U of the nodes, ``yields`` the matrix Q S Q^T.
    """
    m = part.shape[0]
    inner, size = core.shape[0] - 2 * m, core.shape[0]
    core[:FRAME, :FRAME] -= tangent[:FRAME, :FRAME]
    core[:FRAME, inner:] = -tangent[:FRAME, FRAME:]
    t_uu, t_ux = tangent[FRAME:, FRAME:].copy(), tangent[FRAME:, :FRAME].copy()
    # work of the forces: on nodes that follow the sections, and at the lever that they have beyond
    acting, pulled = follow.copy(), yields.copy()
    for k in range(m):
        f1, f2 = nodal[k, 0], nodal[k, 1]
        for a in range(inner):
            turn = turning[k, a]
            if turn != 0:
                acting[2 * k, a] -= lever[k, 1] * turn
                acting[2 * k + 1, a] += lever[k, 0] * turn
    columns = acting.T.copy()
    by_rim = -(columns @ t_uu)
    by_section = np.zeros((inner, inner))
    for k in range(m):
        f1, f2 = nodal[k, 0], nodal[k, 1]
        for a in range(inner):
            turn = turning[k, a]
            if turn != 0:
                by_rim[a, 2 * k] -= turn * f2
                by_rim[a, 2 * k + 1] += turn * f1
                for b in range(inner):
                    by_section[a, b] += turn * (f2 * follow[2 * k, b] - f1 * follow[2 * k + 1, b])
    core[:inner, :inner] += by_section
    core[:inner, :FRAME] -= columns @ t_ux
    core[:inner, inner:] += by_rim
    second = np.zeros((12, 12))
    for k in range(m):
        if part[k] < 0 or (nodal[k, 0] == 0 and nodal[k, 1] == 0):
            continue
        second[:] = 0.0
        rim_curvature(rod, q, part[k], xi[k], nodal[k, 0], nodal[k, 1], second)
        for i in range(4):
            for j in range(4):
                one, two = part[k] - 1 + i, part[k] - 1 + j
                if min(one, two) < 1 or max(one, two) >= place.shape[0] or place[one] < 0 or place[two] < 0:
                    continue
                core[place[one] + 2, place[two] + 2] -= second[3 * i + 2, 3 * j + 2]
    # u - U(q) - Q S Q^T f
    core[inner:, :FRAME] = -scale * (pulled @ t_ux)
    core[inner:, inner:] = -scale * (pulled @ t_uu)
    flat = np.empty((2 * m, m))
    for k in range(m):
        f1, f2 = nodal[k, 0], nodal[k, 1]
        for i in range(2 * m):
            flat[i, k] = -f2 * yields[i, 2 * k] + f1 * yields[i, 2 * k + 1]
    core[inner:, FRAME:inner] = -scale * (follow - flat @ turning)[:, FRAME:]
    for k in range(m):
        for a in range(FRAME, inner):
            core[inner + 2 * k, a] += scale * lever[k, 1] * turning[k, a]
            core[inner + 2 * k + 1, a] -= scale * lever[k, 0] * turning[k, a]
    for i in range(inner, size):
        core[i, i] += scale


@jit
def solve_stage(body: Any, rod: Any, nodes: Any, missing: Any, contact: Any, pos_pred: Any, vel_pred: Any,
                beta: float, guess: Any, u_guess: Any, tolerance: float) -> Any:  # fmt: skip
    """Solve one stage.

    Parameters
    ----------
    body, rod : Body, Rod
    nodes : RimNodes
        Of the window, m of them.
    missing : (2 m, 2 m) array
        Their compliance that the chain lacks.
    contact : tuple
        See :func:`floor`.
    pos_pred, vel_pred, guess : (3 + 3 n,) arrays
    beta : float
    u_guess : (m, 2) array
        What the nodes move beyond the sections, to begin with.
    tolerance : float

    Returns
    -------
    iterations : int
        Newton's; negative when it did not converge, -2 when the patch left the window.
    d : (3 + 3 n,) array
    u : (m, 2) array
    factors : Factors
        Newton's last matrix.
    nodal, resultants, bristles, flags :
        As the floor returns them.
    """
    n = (pos_pred.shape[0] - FRAME) // 3
    part, xi = nodes.part, nodes.xi
    m = part.shape[0]
    law, damper = contact[2], contact[8]
    keeps, place = _kept(n + 2, part)
    inner = FRAME + 3 * keeps.sum()
    d = guess.copy()
    q, qv, qa = np.zeros((n + 2, 3)), np.zeros((n + 2, 3)), np.zeros((n + 2, 3))
    q[1:-1] = (pos_pred[FRAME:] + d[FRAME:]).reshape(n, 3)
    u = follow(rod, q, nodes)[0] + u_guess
    rest, flat = np.empty(2 * m), np.empty(2 * m)
    iterations, last = -1, np.inf
    softest = np.abs(missing).max()
    stiffest = np.abs(rod.local[rod.local.shape[0] // 2]).max()
    for iteration in range(25):
        pos, vel, acc = pos_pred + d, vel_pred + d / beta, d / beta**2
        q[1:-1], qv[1:-1], qa[1:-1] = pos[FRAME:].reshape(n, 3), vel[FRAME:].reshape(n, 3), acc[FRAME:].reshape(n, 3)
        blocks = _empty(n + 2)
        frame, force = np.zeros(FRAME), np.zeros((n + 2, 3))
        elastic(rod, q, force, blocks.diagonal, blocks.up, blocks.down)
        inertia(body, rod, pos[:3], q, vel[:3], qv, acc[:3], qa, beta, blocks, frame, force)
        moved, by, turn = follow(rod, q, nodes)
        pushed, nodal, tangent, res, new_bristles, new_flags = floor(contact, pos[:3], u)
        yields = turned(missing, turn, turn)
        for k in range(m):
            flat[2 * k], flat[2 * k + 1] = nodal[k, 0], nodal[k, 1]
        gives = yields @ flat
        scale = 1.0 + (law[EPS_N] + law[EPS_T]) * res[LENGTH]  # turns an error of u into one of the forces
        follows, turning = _condense(by, part, xi, place, inner)
        lever = u - moved
        for k in range(m):
            rest[2 * k] = scale * (lever[k, 0] - gives[2 * k])
            rest[2 * k + 1] = scale * (lever[k, 1] - gives[2 * k + 1])
        moment = lever[:, 0] * nodal[:, 1] - lever[:, 1] * nodal[:, 0]
        worst = 0.0
        for i in range(1, n + 1):
            if keeps[i]:
                for a in range(3):
                    for k in range(2 * m):
                        force[i, a] -= follows[k, place[i] + a] * flat[k]
                    for k in range(m):
                        force[i, a] -= turning[k, place[i] + a] * moment[k]
            for a in range(3):
                worst = max(worst, abs(force[i, a]))
        for a in range(FRAME):
            frame[a] -= pushed[a]
            worst = max(worst, abs(frame[a]))
        astray = np.abs(rest).max()
        # below this, the forces are round-off of the gap, of the strain or of the increments
        small = tolerance * (1 + res[NORMAL]) + 4e-16 * scale * (abs(pos[1]) + np.abs(u).max())
        small += 1e-14 * (damper[0] + 1) * res[ELASTIC] + 1e-15 * damper[3] * (abs(res[SLIP]) + abs(damper[4]))
        small += 4e-16 * (stiffest * np.abs(q).max() + body.ring_mass * np.abs(vel_pred[FRAME:]).max() / beta)
        done = worst <= small and astray <= small * (1 + scale * softest) and iteration > 0
        if not (np.isfinite(worst) and np.isfinite(astray)):
            break
        factors = factor(blocks, keeps, 2 * m)
        _add_floor(factors.core, q, rod, part, xi, place, follows, turning, lever, nodal, tangent, yields, scale)
        if done:
            iterations = iteration
            break
        step_frame, step_sections, step_rim = solve(factors, frame, force, rest)
        worst = max(worst, astray)
        damping = 0.5 if iteration > 3 and worst > last else 1.0
        last = worst
        d[:FRAME] -= damping * step_frame
        for i in range(n):
            for a in range(3):
                d[FRAME + 3 * i + a] -= damping * step_sections[1 + i, a]
        for k in range(m):
            u[k, 0] -= damping * step_rim[2 * k]
            u[k, 1] -= damping * step_rim[2 * k + 1]
    if res[OUTSIDE] != 0:
        iterations = -2
    return iterations, d, u, factors, nodal, res, new_bristles, new_flags
