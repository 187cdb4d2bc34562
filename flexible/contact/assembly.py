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
def _add_row(
    row: Any, first: int, factor: float, v0: float, v1: float, v2: float, v3: float, v4: float
) -> None:  # fmt: skip
    """Add so many times the five values of an element whose nodes begin at ``first``."""
    row[0] += factor * v0
    row[1] += factor * v1
    row[first + 2] += factor * v2
    row[first + 3] += factor * v3
    row[first + 4] += factor * v4


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
    k_yy, k_xy, k_xx = to[0], to[1], to[2]
    element = 0
    total = points.gap.shape[0]
    for i in range(total):
        if foundation.force[i] == 0 and forces.force[i] == 0:
            continue
        here = points.local[i]
        if here != element:
            _scatter(k_yy, k_xy, k_xx, block, element)
            element = here
        # numbers, not arrays: compiled code need not ask whether one of them is changed with another
        y0, y1, y2, y3, y4 = up[i, 0], up[i, 1], up[i, 2], up[i, 3], up[i, 4]
        factor = -foundation.diagonal[i]
        n0, n1, n2, n3, n4 = factor * y0, factor * y1, factor * y2, factor * y3, factor * y4
        factor = forces.by_gap[i, 2]
        f0, f1, f2, f3, f4 = factor * y0, factor * y1, factor * y2, factor * y3, factor * y4
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
            y0, y1, y2, y3, y4 = up[near, 0], up[near, 1], up[near, 2], up[near, 3], up[near, 4]
            if there == here:
                n0, n1, n2 = n0 - spring * y0, n1 - spring * y1, n2 - spring * y2
                n3, n4 = n3 - spring * y3, n4 - spring * y4
                f0, f1, f2 = f0 + rate * y0, f1 + rate * y1, f2 + rate * y2
                f3, f4 = f3 + rate * y3, f4 + rate * y4
            else:
                for q in range(5):
                    row = q if q < 2 else here + q
                    factor = -spring * up[i, q]
                    _add_row(k_yy[row], there, factor, y0, y1, y2, y3, y4)
                    factor = rate * along[i, q]
                    _add_row(k_xy[row], there, factor, y0, y1, y2, y3, y4)
        for q in range(5):
            _add_row(block[0, q], 0, up[i, q], n0, n1, n2, n3, n4)
            _add_row(block[1, q], 0, along[i, q], f0, f1, f2, f3, f4)
        by_abscissa, by_phi = forces.by_abscissa[i], forces.by_phi[i]
        if by_abscissa != 0 or by_phi != 0:
            x0, x1, x2, x3, x4 = along[i, 0], along[i, 1], along[i, 2], along[i, 3], along[i, 4]
            for q in range(5):
                factor = along[i, q]
                block[2, q, 1] += factor * by_phi
                _add_row(block[2, q], 0, factor * by_abscissa, x0, x1, x2, x3, x4)
    _scatter(k_yy, k_xy, k_xx, block, element)


@loop
def gather(points: Any, values: Any, factor: float, directions: Any, to: Any) -> None:
    """Add so many times the sum of each point's value times its direction, in the basis (V or h, phi, nodes)."""
    for i in range(values.shape[0]):
        value = factor * values[i]
        for q in range(5):
            to[_row(q, points.local[i])] += value * directions[i, q]
