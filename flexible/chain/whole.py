"""Frame and chain as one vector (V, h, phi, then u1, u2 and the rotation of each free section in turn).

And what stands with it: energies, forces, the rim.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit, part

from ..contact.newton import FRAME
from ..contact.points.data import Rim
from ..contact.points.detection import least_gap
from ..contact.vectors import largest, times
from .bordered import as_one, no_blocks, solve
from .lowest import lowest
from .mass.inertia import energies, inertia, inertia_tangent, momenta
from .rim import RimNodes, follow
from .rod.corotated import elastic, strain_energy
from .rod.tangent import elastic_tangent
from .touch import turned


@jit
def sections(vector: Any) -> Any:
    """Rows of the sections, those of the weld included."""
    n = (vector.shape[0] - FRAME) // 3
    rows = np.zeros((n + 2, 3))
    for i in range(n):
        for a in range(3):
            rows[1 + i, a] = vector[FRAME + 3 * i + a]
    return rows


@jit
def balance(chain: Any, pos: Any, vel: Any, acc: Any) -> Any:
    """Sections, and the forces of inertia, gravity and strain on the frame and on the sections."""
    q = sections(pos)
    frame, force = np.zeros(FRAME), np.zeros(q.shape)
    elastic(chain.rod, q, force)
    inertia(chain, (pos, q), (vel, sections(vel)), (acc, sections(acc)), frame, force)
    return q, frame, force


@part
def tangent(chain: Any, pos: Any, vel: Any, acc: Any, beta: float) -> Any:
    """Derivatives of the forces of :func:`balance` by an increment."""
    q = sections(pos)
    blocks = no_blocks(q.shape[0])
    elastic_tangent(chain.rod, q, blocks.diagonal, blocks.up, blocks.down)
    inertia_tangent(chain, (pos, q), (vel, sections(vel)), (acc, sections(acc)), beta, blocks)
    return blocks


@jit
def held(chain: Any, pos: Any, vel: Any) -> tuple[float, float, float]:
    """Kinetic energy, gravity and strain energy of the chain."""
    q = sections(pos)
    kinetic, gravity = energies(chain, pos, q, vel, sections(vel))
    return kinetic, gravity, strain_energy(chain.rod, q)


@jit
def passed_on(factors: Any, chain: Any, pos: Any, error: Any, beta: float) -> Any:
    """An error of velocities or positions as a step passes it on: (M + beta C + beta^2 K)^-1 M times it."""
    q = sections(pos)
    frame, force = np.empty(FRAME), np.empty(q.shape)
    momenta(chain, pos, q, error, sections(error), frame, force)
    rest = np.zeros(factors.core.shape[0] - FRAME - 3 * factors.kept.shape[0])
    rate = solve(factors, frame, force, rest)[0]
    return times(1 / beta**2, rate)


@part
def floor_forces(arrays: Any, pos: Any, vel: Any, acc: Any) -> Any:
    """Forces of the floor on all coordinates that go with these accelerations."""
    _, frame, force = balance(arrays.chain, pos, vel, acc)
    return as_one(frame, force)


@part
def held_by(arrays: Any, pos: Any, vel: Any) -> tuple[float, float, float]:
    """What the coordinates hold by themselves, see :class:`flexible.models.state.Model`."""
    return held(arrays.chain, pos, vel)


@part
def momentum_error(arrays: Any, pos: Any, vel: Any, acc: Any, beta: float, matrix: Any, error: Any) -> float:
    """Size of an ``error`` in the velocities, see :class:`flexible.models.state.Model`.

    Of the ring that of the slow vibrations: steps do not follow the fast.
    """
    rate, slow = passed_on(matrix, arrays.chain, pos, error, beta), arrays.slow
    ringing = 0.0
    for i in range(slow.shape[0]):
        momentum = 0.0
        for k in range(slow.shape[1]):
            momentum += slow[i, k] * rate[FRAME + k]
        ringing = max(ringing, abs(momentum))
    ringing /= (1 + arrays.chain.body.ring_mass) ** 0.5
    return max(largest(rate[1:FRAME]), abs(rate[0] + rate[2]), ringing)


@part
def near_floor(arrays: Any, window: tuple[int, int]) -> tuple[Any, RimNodes]:
    """Rim nodes of a window: their numbers, and what they follow."""
    count, every = 2 * window[1] + 1, arrays.nodes
    number, at = np.empty(count, np.int64), np.empty(count, np.int64)
    xi, root, bow = np.empty(count), np.empty((count, 2, 6)), np.empty((count, 2, 2, 3, 3))
    for k in range(count):
        number[k] = (2 * window[0] + k) % arrays.theta.shape[0]
        at[k], xi[k] = every.part[number[k]], every.xi[number[k]]
        for a in range(2):
            for i in range(6):
                root[k, a, i] = every.root[number[k], a, i]
            for i in range(3):
                for j in range(3):
                    bow[k, a, 0, i, j] = every.bow[number[k], a, 0, i, j]
                    bow[k, a, 1, i, j] = every.bow[number[k], a, 1, i, j]
    return number, RimNodes(at, xi, root, bow)


@part
def lacking(arrays: Any, rows: Any, columns: Any) -> Any:
    """Compliance between rim nodes that the chain lacks, (2 rows, 2 columns)."""
    block = np.empty((2 * rows.shape[0], 2 * columns.shape[0]))
    for i in range(block.shape[0]):
        for j in range(block.shape[1]):
            unit = arrays.missing[2 * rows[i // 2] + i % 2, 2 * columns[j // 2] + j % 2]
            block[i, j] = unit / arrays.stiffness
    return block


@jit
def moved(arrays: Any, old: Any, window: tuple[int, int]) -> tuple[Any, Any]:
    """Displacement of the rim nodes of a window at a known state, and what of it the sections do not account for."""
    rod, q = arrays.chain.rod, sections(old.pos)
    here, nodes = near_floor(arrays, window)
    u, _, turn = follow(rod, q, nodes)
    beyond = np.zeros(u.shape)
    if window == old.window:
        for i in range(u.shape[0]):
            for a in range(2):
                beyond[i, a] = old.u[i, a] - u[i, a]
        return old.u, beyond
    if old.res.normal != 0:
        there, nodes = near_floor(arrays, old.window)
        gives = turned(lacking(arrays, here, there), turn, follow(rod, q, nodes)[2])
        for i in range(gives.shape[0]):
            for j in range(gives.shape[1]):
                beyond[i // 2, i % 2] += gives[i, j] * old.nodal[j // 2, j % 2]
        # nodes in both windows are where they were: a tolerance of their forces is many times a stiff patch's depth
        for i in range(here.shape[0]):
            for k in range(there.shape[0]):
                if here[i] == there[k]:
                    for a in range(2):
                        beyond[i, a] = old.u[k, a] - u[i, a]
        for i in range(u.shape[0]):
            for a in range(2):
                u[i, a] += beyond[i, a]
    return u, beyond


@part
def energies_of(arrays: Any, state: Any, held: Any) -> tuple[float, float, float]:
    """Kinetic, gravity and strain energy of a state whose coordinates hold so much of them."""
    strain = held[2]
    if state.res.normal > 0:
        beyond = moved(arrays, state, state.window)[1]
        for i in range(beyond.shape[0]):
            strain += (state.nodal[i, 0] * beyond[i, 0] + state.nodal[i, 1] * beyond[i, 1]) / 2
    return held[0], held[1], strain


@part
def lacks(arrays: Any, window: Any) -> bool:
    """Whether a step may have failed for want of a part of the rim: the chain knows all of it."""
    return False


@part
def reach(arrays: Any, pos: Any) -> tuple[float, float]:
    """Angles from the bottom between which rim nodes are below the floor; of the lowest node if none is."""
    return lowest(arrays.chain.rod, sections(pos), arrays.nodes, arrays.theta, pos[2], pos[1])


@part
def beside(arrays: Any, pos: Any, window: tuple[int, int], u: Any, nodal: Any, most: float) -> tuple[float, float]:
    """The least gap of the rim in the element before a window and in the one behind it.

    ``u`` and ``nodal``: displacement of the window's nodes and the forces on them, to which those beside it give way
    too, by no more than ``most``, but less than its last one: between the two a rim may come down that by its sections
    is off the floor.
    """
    rod, q = arrays.chain.rod, sections(pos)
    gap = np.empty(2)
    for side in range(2):
        element, end = window[0] - 1 + side * (1 + window[1]), 2 * (1 - side)
        here, nodes = near_floor(arrays, (element, 1))
        rim, (own, _, turns) = Rim(element, arrays.vertex), follow(rod, q, nodes)
        for again in range(2):
            for a in range(2):  # to the last digit, which a sum over the compliance is not
                own[end, a] = u[side * (u.shape[0] - 1), a]
            gap[side] = least_gap(pos[1], pos[2], own, rim)
            if again == 1 or gap[side] > 2 * most:  # 5/4 are the weights of a parabola at most
                break
            there, nodes = near_floor(arrays, window)
            gives = turned(lacking(arrays, here, there), turns, follow(rod, q, nodes)[2])
            for i in range(gives.shape[0]):
                for j in range(gives.shape[1]):
                    own[i // 2, i % 2] += gives[i, j] * nodal[j // 2, j % 2]
    return gap[0], gap[1]
