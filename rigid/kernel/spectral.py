"""A function on [0, 1] by its values at Chebyshev nodes: integrated, interpolated, and its roots counted.

A row is ``ROW`` numbers of a flat sequence, named by the place of its first: values at the ``NODES`` zeros of a
Chebyshev polynomial and, last, at 1. What is done with rows are products with tables that stand behind them, so that
compiled code takes several nodes at once.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from functools import cache
from math import comb

import numpy as np

from .compile import kernel
from .layout import (  # fmt: skip
    NODES,
    ORDER,
    PANEL_ROOM,
    Q_BARY,
    Q_FROM_TURN,
    Q_HULL,
    Q_HULL_OF,
    Q_INTEGRAL,
    Q_LAST,
    Q_NEXT_TO_LAST,
    Q_NODE,
    Q_NOISE,
    Q_SHARE,
    ROW,
    SERIES,
)

NO_ROOT, UNCLEAR = -1.0, -2.0
LEBESGUE = 3.2  # more than the constant of the nodes, 2/pi ln 31 + 0.97 = 3.16
ROUND_OFF = 1e-15  # of an interpolated value over the largest of its row


@cache
def _tables():
    """The rows of a panel, zeros but for the tables."""
    n = NODES
    k = np.arange(n)
    angle = np.pi * (2 * k + 1) / (2 * n)
    x = -np.cos(angle)
    # Chebyshev coefficients of the values: c_k = (2 - [k = 0])/n sum_j f_j T_k(x_j)
    to_chebyshev = np.cos(np.outer(k, np.pi - angle)) * (2 - (k == 0))[:, None] / n
    ends = np.append(x, 1.0)
    t = np.cos(np.outer(np.arange(n + 1), np.append(np.pi - angle, 0.0)))
    sign = (-1.0) ** np.arange(n + 1)
    integrals = np.empty((n, n + 1))  # of T_k from -1
    integrals[0], integrals[1] = ends + 1, (ends * ends - 1) / 2
    for m in range(2, n):
        up, down = (t[m + 1] - sign[m + 1]) / (m + 1), (t[m - 1] - sign[m - 1]) / (m - 1)
        integrals[m] = (up - down) / 2
    degree = n - 1
    hull = np.zeros((n, n))  # Bernstein coefficients of T_k: those of its own degree, raised
    for m in range(n):
        b = [(-1.0) ** (m - i) * comb(2 * m, 2 * i) / comb(m, i) for i in range(m + 1)]
        for d in range(m + 1, degree + 1):
            b = [b[0], *(i / d * b[i - 1] + (1 - i / d) * b[i] for i in range(1, d)), b[-1]]
        hull[m] = b
    rows = np.zeros(PANEL_ROOM)

    def put(first, values):
        for i, row in enumerate(values):
            rows[first + i * ROW : first + i * ROW + len(row)] = row

    put(Q_NODE, 0.5 * (ends + 1)[None])
    put(Q_BARY, (sign[:n] * np.sin(angle))[None])
    put(Q_LAST, to_chebyshev[-1:])
    put(Q_NEXT_TO_LAST, to_chebyshev[-2:-1])
    to_hull = hull.T @ to_chebyshev
    put(Q_NOISE, ROUND_OFF * np.abs(to_hull).sum(1)[None])
    put(Q_INTEGRAL, 0.5 * to_chebyshev.T @ integrals)
    put(Q_FROM_TURN, to_chebyshev.T @ _from_turn(ends))
    put(Q_HULL_OF, to_hull.T)
    return rows


def _from_turn(ends):
    """The integral of theta T_k from 0, over theta^2, at the ends: by Gauss points, as it would cancel near 0."""
    gauss, weight = np.polynomial.legendre.leggauss(NODES // 2 + 1)
    share = 0.5 * (gauss + 1)
    at = np.arccos(np.clip(np.outer(ends + 1, share) - 1, -1, 1))
    return np.array([(np.cos(m * at) * share) @ (0.5 * weight) for m in range(NODES)])


def workspace():
    """What a phase works in, as lists (see :mod:`rigid.kernel.layout`): rows of Taylor coefficients, and, flat, the
    rows of a panel with their tables.
    """
    return [[0.0] * (ORDER + 1) for _ in range(SERIES)], _tables().tolist()


def compiled_workspace():
    """The same as arrays."""
    return np.zeros((SERIES, ORDER + 1)), _tables().copy()


@kernel
def product(rows, matrix, f, out):
    """The row ``out``: the matrix whose columns are the rows from ``matrix`` on, times the row ``f``."""
    if matrix < 0 or f < 0 or out < 0:
        return  # never: but what may count from the end is not compiled to vectors
    for i in range(ROW):
        rows[out + i] = 0.0
    for j in range(0, ROW, 8):
        a, b, c, d = rows[f + j], rows[f + j + 1], rows[f + j + 2], rows[f + j + 3]
        p, q, r, s = rows[f + j + 4], rows[f + j + 5], rows[f + j + 6], rows[f + j + 7]
        m = matrix + j * ROW
        n = m + 4 * ROW
        for i in range(ROW):
            rows[out + i] += (
                (a * rows[m + i] + b * rows[m + ROW + i]) + (c * rows[m + 2 * ROW + i] + d * rows[m + 3 * ROW + i])
            ) + ((p * rows[n + i] + q * rows[n + ROW + i]) + (r * rows[n + 2 * ROW + i] + s * rows[n + 3 * ROW + i]))


@kernel
def exponentials(rows, x, out):
    """exp of a row of numbers up to 2.5 in size, to some 1e-15 of each, without a branch."""
    if x < 0 or out < 0:
        return
    for i in range(ROW):
        y = 0.25 * rows[x + i]
        p = 1 / 87178291200 + y * (1 / 1307674368000)
        p = 1 / 6227020800 + y * p
        p = 1 / 479001600 + y * p
        p = 1 / 39916800 + y * p
        p = 1 / 3628800 + y * p
        p = 1 / 362880 + y * p
        p = 1 / 40320 + y * p
        p = 1 / 5040 + y * p
        p = 1 / 720 + y * p
        p = 1 / 120 + y * p
        p = 1 / 24 + y * p
        p = 1 / 6 + y * p
        p = 0.5 + y * p
        p = 1.0 + y * p
        p = 1.0 + y * p
        p = p * p
        rows[out + i] = p * p


@kernel
def largest(rows, f):
    """The largest size in a row."""
    a, b, c, d = abs(rows[f]), abs(rows[f + 1]), abs(rows[f + 2]), abs(rows[f + 3])
    for i in range(4, ROW, 4):
        a, b = max(a, abs(rows[f + i])), max(b, abs(rows[f + i + 1]))
        c, d = max(c, abs(rows[f + i + 2])), max(d, abs(rows[f + i + 3]))
    return max(max(a, b), max(c, d))


@kernel
def least_of(rows, f):
    """The least value of a row."""
    a, b, c, d = rows[f], rows[f + 1], rows[f + 2], rows[f + 3]
    for i in range(4, ROW, 4):
        a, b, c, d = min(a, rows[f + i]), min(b, rows[f + i + 1]), min(c, rows[f + i + 2]), min(d, rows[f + i + 3])
    return min(min(a, b), min(c, d))


@kernel
def tail(rows, f):
    """Size of the last two Chebyshev coefficients: what the row may lack of the function."""
    a = b = c = d = 0.0
    for i in range(0, ROW, 2):
        a += rows[Q_LAST + i] * rows[f + i]
        b += rows[Q_LAST + i + 1] * rows[f + i + 1]
        c += rows[Q_NEXT_TO_LAST + i] * rows[f + i]
        d += rows[Q_NEXT_TO_LAST + i + 1] * rows[f + i + 1]
    return abs(a + b) + abs(c + d)


@kernel
def interpolate(rows, f, x):
    """The polynomial through the nodes, at x; at 1 the last number of the row."""
    if x == 1.0:
        return rows[f + NODES]
    for i in range(ROW):
        gap = x - rows[Q_NODE + i]
        rows[Q_SHARE + i] = rows[Q_BARY + i] / (gap if gap != 0.0 else 1e-280)
    above = above1 = above2 = above3 = 0.0
    below = below1 = below2 = below3 = 0.0
    # sums that do not wait for each other
    for i in range(0, ROW, 4):
        above += rows[Q_SHARE + i] * rows[f + i]
        above1 += rows[Q_SHARE + i + 1] * rows[f + i + 1]
        above2 += rows[Q_SHARE + i + 2] * rows[f + i + 2]
        above3 += rows[Q_SHARE + i + 3] * rows[f + i + 3]
        below += rows[Q_SHARE + i]
        below1 += rows[Q_SHARE + i + 1]
        below2 += rows[Q_SHARE + i + 2]
        below3 += rows[Q_SHARE + i + 3]
    return ((above + above1) + (above2 + above3)) / ((below + below1) + (below2 + below3))


@kernel
def stays(rows, f, terms):
    """Whether the polynomial of a row surely keeps its sign: a parabola does, and no interpolant of what is left at the
    nodes is beyond ``LEBESGUE`` times its largest.
    """
    low, middle, high = rows[f], rows[f + NODES // 2], rows[f + NODES]
    # by Newton's differences: low + (x - x0) (slope + (x - 1/2) bend)
    start = rows[Q_NODE]
    if f < 0:
        return False
    slope = (middle - low) / (0.5 - start)
    bend = ((high - middle) / 0.5 - slope) / (1 - start)
    least = min(low - start * (slope - 0.5 * bend), high)
    most = max(low - start * (slope - 0.5 * bend), high)
    if bend != 0.0:
        x = 0.5 * (start + 0.5 - slope / bend)
        if 0.0 < x < 1.0:
            y = low + (x - start) * (slope + (x - 0.5) * bend)
            least, most = min(least, y), max(most, y)
    for i in range(ROW):
        x = rows[Q_NODE + i]
        rows[Q_SHARE + i] = rows[f + i] - (low + (x - start) * (slope + (x - 0.5) * bend))
    off = largest(rows, Q_SHARE) + ROUND_OFF * terms
    return least > LEBESGUE * off or most < -LEBESGUE * off


@kernel
def only_root(rows, f, terms):
    """Where the polynomial of a row changes its sign, if it does so once: in (0, 1), ``NO_ROOT`` or ``UNCLEAR``.

    A polynomial has no more roots in [0, 1] than its Bernstein coefficients change sign, and as many but for an even
    number. ``UNCLEAR`` is two changes or more, or a coefficient within the round-off of its terms; ``terms`` is the
    size of what the values of the row are sums of.
    """
    if stays(rows, f, terms):
        return NO_ROOT
    product(rows, Q_HULL_OF, f, Q_HULL)
    scale = max(largest(rows, f), terms)
    changes = 0
    for j in range(NODES):
        if abs(rows[Q_HULL + j]) <= rows[Q_NOISE + j] * scale:
            return UNCLEAR
        if j > 0 and (rows[Q_HULL + j] > 0) != (rows[Q_HULL + j - 1] > 0):
            changes += 1
    if changes == 0:
        return NO_ROOT
    if changes > 1:
        return UNCLEAR
    low, y_low = 0.0, rows[Q_HULL]
    i = 0
    while (rows[f + i] > 0) == (y_low > 0) and i < NODES:
        low, y_low = rows[Q_NODE + i], rows[f + i]
        i += 1
    return root_between(rows, f, low, y_low, rows[Q_NODE + i], rows[f + i])


@kernel
def root_between(rows, f, low, y_low, high, y_high):
    """The root in a bracket: regula falsi (Anderson and Björck), halved where that is slow."""
    if (y_high > 0) == (y_low > 0):
        return UNCLEAR
    scale = ROUND_OFF * largest(rows, f)
    x = high
    for n in range(60):
        x = 0.5 * (low + high) if n % 10 == 9 else (low * y_high - high * y_low) / (y_high - y_low)
        y = interpolate(rows, f, x)
        if abs(y) <= 0.1 * scale or high - low <= 1e-16:
            break
        if (y > 0) == (y_low > 0):
            moved = x - low
            y_high *= max(1 - y / y_low, 0.0) or 0.5
            low, y_low = x, y
        else:
            moved = high - x
            y_low *= max(1 - y / y_high, 0.0) or 0.5
            high, y_high = x, y
        if moved <= 1e-16:
            break
    return x
