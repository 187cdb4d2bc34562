"""Frame and chain as one vector (V, h, phi, then u1, u2 and the rotation of each free section in turn)."""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit

from .bordered import FRAME, _empty, solve
from .corotated import elastic, strain_energy
from .inertia import energies, inertia, momenta


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
def joined(frame: Any, rows: Any) -> Any:
    """The vector of frame and sections."""
    n = rows.shape[0] - 2
    vector = np.empty(FRAME + 3 * n)
    for a in range(FRAME):
        vector[a] = frame[a]
    for i in range(n):
        for a in range(3):
            vector[FRAME + 3 * i + a] = rows[1 + i, a]
    return vector


@jit
def held(body: Any, rod: Any, pos: Any, vel: Any) -> tuple[float, float, float]:
    """Kinetic energy, gravity and strain energy of the chain."""
    q = sections(pos)
    kinetic, gravity = energies(body, rod, pos, q, vel, sections(vel))
    return kinetic, gravity, strain_energy(rod, q)


@jit
def forces(body: Any, rod: Any, pos: Any, vel: Any, acc: Any) -> Any:
    """Inertial, gravitational and elastic forces."""
    q = sections(pos)
    blocks = _empty(q.shape[0])
    frame, force = np.zeros(FRAME), np.zeros(q.shape)
    elastic(rod, q, force, blocks.diagonal, blocks.up, blocks.down)
    inertia(body, rod, pos, q, vel, sections(vel), acc, sections(acc), 1.0, blocks, frame, force)
    return joined(frame, force)


@jit
def passed_on(factors: Any, body: Any, rod: Any, pos: Any, error: Any, beta: float) -> Any:
    """An error of velocities or positions as a step passes it on: (M + beta C + beta^2 K)^-1 M times it."""
    q = sections(pos)
    frame, force = np.empty(FRAME), np.empty(q.shape)
    momenta(body, rod, pos, q, error, sections(error), frame, force)
    rest = np.zeros(factors.core.shape[0] - FRAME - 3 * factors.kept.shape[0])
    frame, force, _ = solve(factors, frame / beta**2, force / beta**2, rest)
    return joined(frame, force)
