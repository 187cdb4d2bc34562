"""Inertia of the wall beside the weld, which moves with the first and the last section, in compiled code.

With p the six coordinates of the two sections, L, M, G, h and g the integrals of
:class:`flexible.chain.mass.ends.EndMass`, and A, alpha and omega as in
:mod:`flexible.chain.mass.inertia`, the force on p is

    L'A + alpha (g + G p) + 2 omega G p' - omega^2 (h + M p) + M p'' .

What of the wall's inertia is not by p is the frame's.
"""

from __future__ import annotations

from typing import Any

from rigid.kernel.compile import loop


@loop
def _of(q: Any, i: int) -> float:
    """The i-th of the six coordinates."""
    return q[1, i] if i < 3 else q[q.shape[0] - 2, i - 3]


@loop
def _sums(ends: Any, i: int, q: Any, qv: Any) -> tuple[float, float, float, float]:
    """The i-th of M p, G p, M p' and G p'."""
    mp, gp, mv, gv = 0.0, 0.0, 0.0, 0.0
    for k in range(6):
        p, v, m, g = _of(q, k), _of(qv, k), ends.mass[i, k], ends.gyro[i, k]
        mp += m * p
        gp += g * p
        mv += m * v
        gv += g * v
    return mp, gp, mv, gv


@loop
def _on_frame(ends: Any, i: int, seen: Any, p: float, v: float, a: float) -> tuple[float, float]:
    """Force along y1 and y2 that is by the i-th coordinate, its rate and its acceleration."""
    (alpha, w), l1, l2 = seen, ends.first[0, i], ends.first[1, i]
    f1 = l1 * a - 2 * w * l2 * v - (alpha * l2 + w * w * l1) * p
    return f1, l2 * a + 2 * w * l1 * v + (alpha * l1 - w * w * l2) * p


@loop
def add_inertia(ends: Any, seen: Any, w: float, rows: Any, force: Any) -> tuple[float, float, float]:
    """Add the forces on the two sections; those on the frame along y1 and y2, and the moment about C.

    Parameters
    ----------
    ends : EndMass
    seen : tuple
        A1, A2 and alpha.
    w : float
        Omega.
    rows : tuple
        Displacements of the sections, their rates and accelerations, (n + 2, 3) each.
    force : (n + 2, 3) array
    """
    (a1, a2, alpha), (q, qv, qa) = seen, rows
    last = q.shape[0] - 2
    f1, f2, moment = 0.0, 0.0, 0.0
    for i in range(6):
        p, v, a = _of(q, i), _of(qv, i), _of(qa, i)
        l1, l2, h, g = ends.first[0, i], ends.first[1, i], ends.stretching[i], ends.turning[i]
        mp, gp, mv, gv = _sums(ends, i, q, qv)
        own = l1 * a1 + l2 * a2 + alpha * (g + gp) + 2 * w * gv - w * w * (h + mp)
        for k in range(6):
            own += ends.mass[i, k] * _of(qa, k)
        force[1 if i < 3 else last, i % 3] += own
        more1, more2 = _on_frame(ends, i, (alpha, w), p, v, a)
        f1, f2 = f1 + more1, f2 + more2
        moment += (l1 * a2 - l2 * a1 + alpha * (2 * h + mp)) * p + 2 * w * (h + mp) * v + (g + gp) * a
    return f1, f2, moment


@loop
def add_derivatives(
    ends: Any, seen: Any, turn: Any, ratios: Any, rows: Any, blocks: Any
) -> tuple[float, float, float, float, float, float, float]:
    """Add the derivatives of :func:`add_inertia` by an increment.

    See :func:`flexible.chain.mass.inertia.inertia_tangent`.

    Parameters
    ----------
    ends : EndMass
    seen : tuple
        A1, A2 and alpha, and the derivatives of A1 and A2 by phi.
    turn : tuple
        Sine and cosine of phi, omega.
    ratios : tuple
        Of rates and accelerations to the increment.
    rows : tuple
        See :func:`add_inertia`.
    blocks : Blocks

    Returns
    -------
    tuple
        Forces on the frame along y1 and y2; derivatives by phi of these and of the moment about C; and the wall's first
        moment.
    """
    (a1, a2, alpha, a1_phi, a2_phi), (s, c, w), (r1, r2), (q, qv, qa) = seen, turn, ratios, rows
    own, across, last = r2 - w * w, alpha + 2 * w * r1, q.shape[0] - 2
    f1, f2, f1_phi, f2_phi, moment_phi, sum1, sum2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    diagonal, columns, borders = blocks.diagonal, blocks.columns, blocks.rows
    for i in range(6):
        at, b = 1 if i < 3 else last, i % 3
        p, v, ga = _of(q, i), _of(qv, i), 0.0
        l1, l2, h, g = ends.first[0, i], ends.first[1, i], ends.stretching[i], ends.turning[i]
        mp, gp, mv, gv = _sums(ends, i, q, qv)
        for k in range(6):
            ga += ends.gyro[i, k] * _of(qa, k)
            value = own * ends.mass[i, k] + across * ends.gyro[i, k]
            if (i < 3) == (k < 3):
                diagonal[at, b, k % 3] += value
            elif i < 3:  # behind the last section comes the first
                blocks.down[last, b, k - 3] += value
            else:
                blocks.up[last, b, k] += value
        columns[at, b, 0] += (l1 * s + l2 * c) * r2
        columns[at, b, 1] += (l1 * c - l2 * s) * r2
        columns[at, b, 2] += l1 * a1_phi + l2 * a2_phi + r2 * (g + gp) + 2 * r1 * gv - 2 * w * r1 * (h + mp)
        by1, by2 = own * l1 - across * l2, own * l2 + across * l1
        moment = l1 * a2 - l2 * a1 + 2 * (alpha + w * r1) * (h + mp) + 2 * w * mv + r2 * (g + gp) - ga
        borders[at, b, 0] += by1 * s + by2 * c
        borders[at, b, 1] += by1 * c - by2 * s
        borders[at, b, 2] += by1 * s + by2 * c + moment
        more1, more2 = _on_frame(ends, i, (alpha, w), p, v, _of(qa, i))
        f1, f2 = f1 + more1, f2 + more2
        f1_phi -= r2 * l2 * p + 2 * r1 * (l2 * v + w * l1 * p)
        f2_phi += r2 * l1 * p + 2 * r1 * (l1 * v - w * l2 * p)
        moment_phi += (l1 * a2_phi - l2 * a1_phi + r2 * (2 * h + mp)) * p + 2 * r1 * (h + mp) * v
        sum1 += l1 * p
        sum2 += l2 * p
    return f1, f2, f1_phi, f2_phi, moment_phi, sum1, sum2


@loop
def moving(ends: Any, c1: float, c2: float, w: float, q: Any, qv: Any) -> tuple[float, float, float]:
    """Kinetic energy that is by the sections' coordinates, and the wall's first moment by them."""
    kinetic, sum1, sum2 = 0.0, 0.0, 0.0
    for i in range(6):
        p, v = _of(q, i), _of(qv, i)
        l1, l2, h, g = ends.first[0, i], ends.first[1, i], ends.stretching[i], ends.turning[i]
        mp, gp, mv, _ = _sums(ends, i, q, qv)
        kinetic += (mv / 2 + w * (g + gp) + l1 * c1 + l2 * c2) * v
        kinetic += w * (w * (mp / 2 + h) + l1 * c2 - l2 * c1) * p
        sum1 += l1 * p
        sum2 += l2 * p
    return kinetic, sum1, sum2
