"""One implicit step of the reduced hoop: TR-BDF2, Newton on frame, modes and the rim nodes near the floor together.

TR-BDF2 is one-step, second order, L-stable and stiffly accurate: what a step does not resolve (the ring's and the
contact's own vibrations) it damps, so steps follow the motion and not the stiffness. Both of its stages have the form
``pos = pos_pred + d, vel = vel_pred + d/beta, acc = d/beta^2`` with the small increment d as the unknown.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from rigid.kernel.compile import jit

from ..contact.forces import ELASTIC, EPS_N, EPS_T, LENGTH, NORMAL, OUTSIDE, SLIP, contact_forces
from ..ring.frame import inertia

TAU = 2 - sqrt(2)  # where the first stage ends, as a fraction of the step
BETA = TAU / 2
# weights of the step minus those of its third-order companion (Hosea and Shampine 1996)
_W = sqrt(2) / 4
ERROR_WEIGHTS = (_W - (1 - _W) / 3, _W - (3 * _W + 1) / 3, BETA - BETA / 3)


@jit
def largest(values: Any) -> float:
    """Largest absolute value, infinite if any is not a number: comparing with one would pass it over."""
    most = 0.0
    for value in values.flat:
        if not np.isfinite(value):
            return np.inf
        most = max(most, abs(value))
    return most


@jit
def solve_stage(
    body: Any,
    modal: Any,
    gyro: Any,
    shapes: Any,
    compliance: Any,
    first: int,
    vertex: Any,
    law: Any,
    mode: int,
    old_pose: Any,
    u_old: Any,
    bristles: Any,
    flags: Any,
    damper: Any,
    pos_pred: Any,
    vel_pred: Any,
    beta: float,
    guess: Any,
    u_guess: Any,
    tolerance: float,
) -> Any:
    """Solve one stage.

    ``guess`` and ``u_guess`` start Newton for d and for the displacement of the window's nodes.

    Returns
    -------
    iterations : int
        Newton's; negative when it did not converge.
    d, u, acc : arrays
    matrix : (n, n) array
        Newton's last, for the filter of the error estimate.
    nodal, resultants, bristles, flags :
        As :func:`flexible.contact.forces.contact_forces` returns them.
    """
    n = modal.shape[0]
    nodes = u_guess.shape[0]
    m = 3 + n
    size = m + 2 * nodes
    d, u = guess.copy(), u_guess.copy()
    matrix = np.empty((size, size))
    residual = np.empty(size)
    iterations = -1
    last = np.inf
    softest = np.abs(compliance).max()
    for iteration in range(25):
        pos = pos_pred + d
        acc = d / beta**2
        vel = vel_pred + d / beta
        force, nodal, tangent, res, new_bristles, new_flags = contact_forces(
            pos[:3], u, first, vertex, law, mode, old_pose, u_old, bristles, flags, damper
        )
        own, own_tangent = inertia(body, modal, gyro, pos, vel, acc, beta)
        flat = nodal.copy().reshape(2 * nodes)
        t_uu = tangent[3:, 3:].copy()
        t_ux = tangent[3:, :3].copy()
        scale = 1.0 + (law[EPS_N] + law[EPS_T]) * res[LENGTH]  # turns an error of u into one of the forces
        moved = compliance @ flat
        for i in range(3):
            residual[i] = own[i] - force[i]
        for i in range(n):
            pushed = 0.0
            for k in range(2 * nodes):
                pushed += shapes[k, i] * flat[k]
            residual[3 + i] = own[3 + i] - pushed
        for k in range(2 * nodes):
            modal_part = 0.0
            for i in range(n):
                modal_part += shapes[k, i] * pos[3 + i]
            residual[m + k] = scale * (u[k // 2, k % 2] - modal_part - moved[k])
        # of forces, and of displacements as forces on the foundation
        worst, astray = largest(residual[:m]), largest(residual[m:])
        # below this, the forces are round-off of the gap
        floor = 4e-16 * scale * (abs(pos[1]) + np.abs(u).max()) + 1e-14 * (damper[0] + 1) * res[ELASTIC]
        floor += 1e-15 * damper[3] * (abs(res[SLIP]) + abs(damper[4]))
        small = tolerance * (1 + res[NORMAL]) + floor
        if not np.isfinite(worst + astray + small):
            break
        # a ring softer than the foundation moves by its compliance times what the forces may be off
        if worst <= small and astray <= small * (1 + scale * softest) and iteration > 0:
            iterations = iteration
            break
        worst = max(worst, astray)
        matrix[:m, :m] = own_tangent
        matrix[:3, :3] -= tangent[:3, :3]
        matrix[:3, m:] = -tangent[:3, 3:]
        if n > 0:
            columns = shapes.T.copy()
            matrix[3:m, :3] -= columns @ t_ux
            matrix[3:m, m:] = -(columns @ t_uu)
            matrix[m:, 3:m] = -scale * shapes
        matrix[m:, :3] = -scale * (compliance @ t_ux)
        matrix[m:, m:] = -scale * (compliance @ t_uu)
        for k in range(2 * nodes):
            matrix[m + k, m + k] += scale
        update = np.linalg.solve(matrix, residual)
        if not np.isfinite(largest(update)):
            break
        damping = 1.0
        if iteration > 3 and worst > last:
            damping = 0.5
        last = worst
        for i in range(m):
            d[i] -= damping * update[i]
        for k in range(2 * nodes):
            u[k // 2, k % 2] -= damping * update[m + k]
    acc = d / beta**2
    if res[OUTSIDE] != 0:
        iterations = -2
    return iterations, d, u, acc, matrix, nodal, res, new_bristles, new_flags


@jit
def filtered_error(
    body: Any, modal: Any, gyro: Any, pos: Any, vel: Any, acc: Any, beta: float, matrix: Any, error: Any
) -> Any:
    """An error of velocities or positions as the step itself passes it on: (M + beta C + beta^2 K)^-1 M times it.

    What the step does not resolve, and damps, would otherwise hold the steps down to the vibrations' periods.
    """
    with_error = inertia(body, modal, gyro, pos, vel, acc + error, beta)[0]
    without = inertia(body, modal, gyro, pos, vel, acc, beta)[0]
    load = np.zeros(matrix.shape[0])
    load[: pos.shape[0]] = (with_error - without) / beta**2
    return np.linalg.solve(matrix, load)[: pos.shape[0]]
