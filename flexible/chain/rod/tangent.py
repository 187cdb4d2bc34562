"""The stiffness of a chain of rod parts: derivatives of the forces of :mod:`flexible.chain.rod.corotated`."""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit, loop, part

from .corotated import outward, stiffer, strains, stress, stress_at_weld
from .softening import far_bent, softened


@loop
def _stiffness(way: Any, w: Any, stress: Any, local: Any) -> Any:
    """Second derivatives of a part's energy by the way of its second section from the first, and both rotations.

    Those of a symmetric (4, 4), row by row from its diagonal on. ``way``: direction and length of the chord; ``w``:
    derivatives of the line's stretch by the angles; ``stress``: force along the line and sum of the moments, over the
    length and its square; ``local``: second derivatives by the strains, entries 00, 01, 02, 11, 12 and 22.
    """
    (t1, t2, now), (w1, w2), (pull, turn) = way, w, stress
    l00, l01, l02, l11, l12, l22 = local
    a, b = t2 / now, -t1 / now  # of both angles by the way
    e, f = t1 + (w1 + w2) * a, t2 + (w1 + w2) * b
    x0, x1, x2 = l00 * e + (l01 + l02) * a, l01 * e + (l11 + l12) * a, l02 * e + (l12 + l22) * a
    y0, y1, y2 = l00 * f + (l01 + l02) * b, l01 * f + (l11 + l12) * b, l02 * f + (l12 + l22) * b
    z0, z1, z2 = l00 * w1 + l01, l01 * w1 + l11, l02 * w1 + l12
    k00 = e * x0 + a * (x1 + x2) + pull * t2 * t2 - 2 * turn * t1 * t2
    k01 = f * x0 + b * (x1 + x2) - pull * t1 * t2 + turn * (t1 * t1 - t2 * t2)
    k11 = f * y0 + b * (y1 + y2) + pull * t1 * t1 + 2 * turn * t1 * t2
    k33 = w2 * (l00 * w2 + 2 * l02) + l22
    return (
        k00, k01, w1 * x0 + x1, w2 * x0 + x2, k11, w1 * y0 + y1, w2 * y0 + y2, w1 * z0 + z1, w2 * z0 + z2, k33,
    )  # fmt: skip


@loop
def _add(tangent: Any, p: int, diagonal: Any, up: Any, down: Any, joins: bool) -> None:
    """Add a part's stiffness to the blocks of its sections, and to those between them if it ``joins`` free ones."""
    k00, k01, k02, k03, k11, k12, k13, k22, k23, k33 = tangent
    one, two = diagonal[p], diagonal[p + 1]
    one[0, 0] += k00
    one[0, 1] += k01
    one[1, 0] += k01
    one[1, 1] += k11
    one[0, 2] -= k02
    one[2, 0] -= k02
    one[1, 2] -= k12
    one[2, 1] -= k12
    one[2, 2] += k22
    two[0, 0] += k00
    two[0, 1] += k01
    two[1, 0] += k01
    two[1, 1] += k11
    two[0, 2] += k03
    two[2, 0] += k03
    two[1, 2] += k13
    two[2, 1] += k13
    two[2, 2] += k33
    if joins:
        above, below = up[p], down[p]
        above[0, 0], above[0, 1], above[0, 2] = -k00, -k01, -k03
        above[1, 0], above[1, 1], above[1, 2] = -k01, -k11, -k13
        above[2, 0], above[2, 1], above[2, 2] = k02, k12, k23
        below[0, 0], below[0, 1], below[0, 2] = -k00, -k01, k02
        below[1, 0], below[1, 1], below[1, 2] = -k01, -k11, k12
        below[2, 0], below[2, 1], below[2, 2] = -k03, -k13, k23


@jit
def elastic_tangent(rod: Any, q: Any, diagonal: Any, up: Any, down: Any) -> None:
    """Add the derivatives of the forces of :func:`elastic`; those between two sections are filled in.

    Parameters
    ----------
    rod : Rod
    q : (n + 2, 3) array
    diagonal : (n + 2, 3, 3) array
    up, down : (n + 1, 3, 3) arrays
        Derivatives of the forces on section i by i + 1, and on i + 1 by i; those behind n are on n by 1, and on 1 by n.
    """
    _within(rod, q, diagonal, up, down)
    last = rod.local.shape[0] - 1
    _add_across(rod, q, up[last], down[last])


@loop
def _within(rod: Any, q: Any, diagonal: Any, up: Any, down: Any) -> None:
    """Of the parts one by one."""
    last = rod.local.shape[0] - 1
    for p in range(last + 1):
        t1, t2, now, x, tau_1, tau_2, w1, w2 = strains(rod, q, p)
        local, bow = rod.local[p], rod.bow[p]
        if 0 < p < last:
            _, s0, s1, s2 = stress(rod, p, x, tau_1, tau_2)
            bend, pull = rod.pulled[p] * (tau_2 - tau_1), rod.pulled[p] * x
            m00, m01, m02, m11, m12, m22 = 0.0, -bend, bend, pull, -pull, pull
        else:
            _, s0, s1, s2 = stress_at_weld(rod, q, p, x, tau_1, tau_2)
            m00, m01, m02, m11, m12, m22 = stiffer(rod.bent[min(p, 1)], x, tau_1, tau_2)
            _, _, _, _, f00, f01, f02, f11, f12, f22 = far_bent(rod.far[min(p, 1)], rod.fading, local, x, tau_1, tau_2)
            m00, m01, m02, m11, m12, m22 = m00 + f00, m01 + f01, m02 + f02, m11 + f11, m12 + f12, m22 + f22
        _, _, less = softened(rod.softening[p], rod.strained[p], tau_2 - tau_1)
        second = (
            local[0, 0] + m00, local[0, 1] + m01, local[0, 2] + m02,
            local[1, 1] + m11 + less + s0 * bow[0, 0], local[1, 2] + m12 - less + s0 * bow[0, 1],
            local[2, 2] + m22 + less + s0 * bow[1, 1],
        )  # fmt: skip
        pulls = s0 / now, (s1 + s2 + s0 * (w1 + w2)) / (now * now)
        _add(_stiffness((t1, t2, now), (w1, w2), pulls, second), p, diagonal, up, down, 0 < p < last)


@loop
def outwards(rod: Any, q: Any, p: int, end: int, by: Any) -> None:
    """Derivatives (3, 3) of the strains of the first or the last part, of its line, by its section off the weld."""
    t1, t2, now, _, _, _, w1, w2 = strains(rod, q, p)
    for k in range(3):
        for i in range(3):
            by[i, k] = outward(t1, t2, now, end, i, k)
        by[0, k] += w1 * by[1, k] + w2 * by[2, k]


@part
def _add_across(rod: Any, q: Any, up: Any, down: Any) -> None:
    """What the last section feels of the first, and the first of the last."""
    first, final = np.empty((3, 3)), np.empty((3, 3))
    outwards(rod, q, 0, 0, first)
    outwards(rod, q, rod.local.shape[0] - 1, 1, final)
    for i in range(3):
        for j in range(3):
            for a in range(3):
                for b in range(3):
                    value = first[i, a] * rod.across[i, j] * final[j, b]
                    down[a, b] += value
                    up[b, a] += value
