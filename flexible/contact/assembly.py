"""From points to unknowns: sums of forces, and of their derivatives, over the patch.

Directions are counted in two bases: what moves abscissas, (V, phi, u_X of the nodes), and what moves gaps,
(h, phi, u_Y). X and Y tell which; the unknowns are (V, h, phi, then y1, y2 of the nodes in the disk's axes).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit, part

from .points.normal import sum_by_gaps

X, Y = 0, 1


@part
def spread(vector: Any, kind: int, s: float, c: float) -> Any:
    """From a basis to the unknowns."""
    nodes = vector.shape[0] - 2
    first, second = (s, c) if kind == X else (c, -s)
    result = np.zeros(3 + 2 * nodes)
    result[kind], result[2] = vector[0], vector[1]
    for i in range(nodes):
        result[3 + 2 * i], result[4 + 2 * i] = first * vector[2 + i], second * vector[2 + i]
    return result


@part
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


@part
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


@part
def add_outer(tangent: Any, factor: float, left: Any, right: Any) -> None:
    """Add so many times the product of a column and a row."""
    for i in range(left.shape[0]):
        for j in range(right.shape[0]):
            tangent[i, j] += factor * left[i] * right[j]


@part
def _row(q: int, first: int) -> int:
    return q if q < 2 else first + q


@part
def directions(points: Any) -> tuple[Any, Any]:
    """What moves each point's abscissa and gap: by V or h, by phi, by the three nodes of its element."""
    total = points.gap.shape[0]
    along, up = np.ones((total, 5)), np.ones((total, 5))
    for i in range(total):
        along[i, 1], up[i, 1] = points.arm_y[i], points.arm_x[i]
        for q in range(3):  # an assignment of slices would compile numpy's broadcasting with all its messages
            along[i, 2 + q] = up[i, 2 + q] = points.shape[i, q]
    return along, up


@part
def tangents(points: Any, foundation: Any, forces: Any, along: Any, up: Any, nodes: int) -> tuple[Any, Any, Any]:
    """Derivatives of elastic normal forces by gaps, of tangential ones by gaps and by abscissas, in those bases."""
    size = 2 + nodes
    k_yy, k_xy, k_xx = np.zeros((size, size)), np.zeros((size, size)), np.zeros((size, size))
    # the points of an element share a basis: its products are gathered in place and added when it is left
    block = np.zeros((3, 5, 5))
    by_up, by_traction = np.empty(5), np.empty(5)
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
            by_up[w] = -foundation.diagonal[i] * up[i, w]
            by_traction[w] = forces.by_gap[i, 2] * up[i, w]
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
                    by_up[w] -= spring * up[near, w]
                    by_traction[w] += rate * up[near, w]
            else:
                for q in range(5):
                    for w in range(5):
                        k_yy[_row(q, here), _row(w, there)] -= spring * up[i, q] * up[near, w]
                        k_xy[_row(q, here), _row(w, there)] += rate * along[i, q] * up[near, w]
        for q in range(5):
            for w in range(5):
                block[0, q, w] += up[i, q] * by_up[w]
                block[1, q, w] += along[i, q] * by_traction[w]
        if forces.by_abscissa[i] != 0 or forces.by_phi[i] != 0:
            for q in range(5):
                block[2, q, 1] += along[i, q] * forces.by_phi[i]
                for w in range(5):
                    block[2, q, w] += along[i, q] * forces.by_abscissa[i] * along[i, w]
    _scatter(k_yy, k_xy, k_xx, block, element)
    return k_yy, k_xy, k_xx


@part
def gathered(points: Any, values: Any, directions: Any, nodes: int) -> Any:
    """Sum of each point's value times its direction, in the basis (V or h, phi, nodes)."""
    total = np.zeros(2 + nodes)
    for i in range(values.shape[0]):
        for q in range(5):
            total[_row(q, points.local[i])] += values[i] * directions[i, q]
    return total


@jit
def slip_by_gaps(points: Any, ways: Any, foundation: Any, slip: float, elastic: float, up: Any, nodes: int) -> Any:
    """Derivative of the mean slip by the gaps, through the normal forces that weigh it."""
    factors = np.empty(ways.shape[0])
    for i in range(ways.shape[0]):
        factors[i] = (ways[i] - slip) / elastic
    return gathered(points, sum_by_gaps(factors, foundation), up, nodes)
