"""From points to unknowns: sums of forces, and of their derivatives, over the patch.

Directions are counted in two bases: what moves abscissas, (V, phi, u_X of the nodes), and what moves gaps,
(h, phi, u_Y). X and Y tell which; the unknowns are (V, h, phi, then y1, y2 of the nodes in the disk's axes).
"""

from __future__ import annotations

from typing import Any

from rigid.kernel.compile import loop

X, Y = 0, 1


@loop
def spread(vector: Any, kind: int, s: float, c: float, to: Any) -> None:
    """Add what is known in a basis to the unknowns."""
    first, second = (s, c) if kind == X else (c, -s)
    to[kind] += vector[0]
    to[2] += vector[1]
    for i in range(2, vector.shape[0]):
        to[2 * i - 1] += first * vector[i]
        to[2 * i] += second * vector[i]


@loop
def share_out(unknowns: Any, frame: Any, nodal: Any) -> None:
    """Fill in what of the unknowns' forces is the frame's, and the nodes'."""
    for i in range(3):
        frame[i] = unknowns[i]
    for i in range(nodal.shape[0]):
        nodal[i, 0], nodal[i, 1] = unknowns[3 + 2 * i], unknowns[4 + 2 * i]


@loop
def add_spread(tangent: Any, matrix: Any, row_kind: int, column_kind: int, s: float, c: float, factor: float) -> None:
    """Add ``factor`` times a matrix between two bases to the tangent of the unknowns."""
    r1, r2 = (s, c) if row_kind == X else (c, -s)
    c1, c2 = (s, c) if column_kind == X else (c, -s)
    n = matrix.shape[0]
    for i in range(n):
        for j in range(n):
            value = factor * matrix[i, j]
            if value == 0:
                continue
            column = column_kind if j == 0 else 2 if j == 1 else 2 * j - 1
            if i < 2:
                row = row_kind if i == 0 else 2
                if j < 2:
                    tangent[row, column] += value
                else:
                    tangent[row, column] += c1 * value
                    tangent[row, column + 1] += c2 * value
            else:
                row = 2 * i - 1
                if j < 2:
                    tangent[row, column] += r1 * value
                    tangent[row + 1, column] += r2 * value
                else:
                    tangent[row, column] += r1 * c1 * value
                    tangent[row, column + 1] += r1 * c2 * value
                    tangent[row + 1, column] += r2 * c1 * value
                    tangent[row + 1, column + 1] += r2 * c2 * value


@loop
def _scatter(k_yy: Any, k_xy: Any, k_xx: Any, block: Any, first: int) -> None:
    """Add an element's products to the tangents, and clear them."""
    for q in range(5):
        row = q if q < 2 else first + q
        for w in range(5):
            column = w if w < 2 else first + w
            k_yy[row, column] += block[0, q, w]
            k_xy[row, column] += block[1, q, w]
            k_xx[row, column] += block[2, q, w]
            block[0, q, w] = block[1, q, w] = block[2, q, w] = 0.0


@loop
def add_outer(tangent: Any, factor: float, left: Any, right: Any) -> None:
    """Add so many times the product of a column and a row."""
    for i in range(left.shape[0]):
        for j in range(right.shape[0]):
            tangent[i, j] += factor * left[i] * right[j]


@loop
def _row(q: int, first: int) -> int:
    return q if q < 2 else first + q


@loop
def direct(points: Any, along: Any, up: Any) -> None:
    """What moves each point's abscissa and gap: by V or h, by phi, by the three nodes of its element."""
    for i in range(along.shape[0]):
        along[i, 0], up[i, 0] = 1.0, 1.0
        along[i, 1], up[i, 1] = points.arm_y[i], points.arm_x[i]
        for q in range(3):
            along[i, 2 + q] = up[i, 2 + q] = points.shape[i, q]


@loop
def tangents(points: Any, foundation: Any, forces: Any, along: Any, up: Any, to: Any, block: Any) -> None:
    """Derivatives of elastic normal forces by gaps, of tangential ones by gaps and by abscissas, in those bases.

    The points of an element share a basis: its products are gathered in a block and added when it is left.
    """
    k_yy, k_xy, k_xx, by = to[0], to[1], to[2], block[3]
    element = 0
    total = points.gap.shape[0]
    for i in range(total):
        if foundation.force[i] == 0 and forces.force[i] == 0:
            continue
        here = points.local[i]
        if here != element:
            _scatter(k_yy, k_xy, k_xx, block, element)
            element = here
        for w in range(5):
            by[0, w] = -foundation.diagonal[i] * up[i, w]
            by[1, w] = forces.by_gap[i, 2] * up[i, w]
        for away in (-2, -1, 1, 2):
            near = i + away
            if near < 0 or near >= total or points.last[min(i, near)]:
                continue
            spring, rate = 0.0, forces.by_gap[i, 2 + away]
            if abs(away) == 1:
                spring = foundation.coupling[min(i, near)]
            elif rate == 0:
                continue
            there = points.local[near]
            if there == here:
                for w in range(5):
                    by[0, w] -= spring * up[near, w]
                    by[1, w] += rate * up[near, w]
            else:
                for q in range(5):
                    for w in range(5):
                        k_yy[_row(q, here), _row(w, there)] -= spring * up[i, q] * up[near, w]
                        k_xy[_row(q, here), _row(w, there)] += rate * along[i, q] * up[near, w]
        for q in range(5):
            for w in range(5):
                block[0, q, w] += up[i, q] * by[0, w]
                block[1, q, w] += along[i, q] * by[1, w]
        if forces.by_abscissa[i] != 0 or forces.by_phi[i] != 0:
            for q in range(5):
                block[2, q, 1] += along[i, q] * forces.by_phi[i]
                for w in range(5):
                    block[2, q, w] += along[i, q] * forces.by_abscissa[i] * along[i, w]
    _scatter(k_yy, k_xy, k_xx, block, element)


@loop
def gather(points: Any, values: Any, factor: float, directions: Any, to: Any) -> None:
    """Add so many times the sum of each point's value times its direction, in the basis (V or h, phi, nodes)."""
    for i in range(values.shape[0]):
        value = factor * values[i]
        for q in range(5):
            to[_row(q, points.local[i])] += value * directions[i, q]
