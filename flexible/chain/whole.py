"""Frame and chain as one vector (V, h, phi, then u1, u2 and the rotation of each free section in turn)."""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit, written_out

from ..contact.vectors import times
from .bordered import FRAME, no_blocks, solve
from .corotated import elastic, elastic_tangent, strain_energy
from .inertia import energies, inertia, inertia_tangent, momenta


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


@written_out
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
