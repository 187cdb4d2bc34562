"""Whole vectors and small systems in compiled code, in loops.

numpy's own expressions and assignments of slices would be compiled anew in each function that has them, with all of
broadcasting and its messages, for seconds; so would its solver of systems, which is no faster at these sizes.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit, loop, part


@jit
def largest(values: Any) -> float:
    """Largest absolute value, infinite if any is not a number: comparing with one would pass it over."""
    most = 0.0
    for value in values.flat:
        if not np.isfinite(value):
            return np.inf
        most = max(most, abs(value))
    return most


@loop
def dot(left: Any, right: Any) -> float:
    """Sum of the products."""
    total = 0.0
    for i in range(left.shape[0]):
        total += left[i] * right[i]
    return total


@loop
def total(values: Any) -> float:
    """Sum."""
    found = 0.0
    for i in range(values.shape[0]):
        found += values[i]
    return found


@loop
def add(to: Any, factor: float, values: Any) -> None:
    """Add so many times the values in place."""
    for i in range(to.shape[0]):
        to[i] += factor * values[i]


@jit
def plus(start: Any, factor: float, values: Any) -> Any:
    """The sum of a vector and so many times another."""
    total = np.empty(start.shape[0])
    for i in range(total.shape[0]):
        total[i] = start[i] + factor * values[i]
    return total


@jit
def times(factor: float, values: Any) -> Any:
    """So many times a vector."""
    product = np.empty(values.shape[0])
    for i in range(product.shape[0]):
        product[i] = factor * values[i]
    return product


@part
def flagged(flags: Any) -> Any:
    """Where the flags are set, in ascending order."""
    where, count = np.empty(flags.shape[0], np.int64), 0
    for i in range(flags.shape[0]):
        if flags[i]:
            where[count] = i
            count += 1
    return where[:count].copy()


@part
def eliminate(rows: Any, order: Any) -> None:
    """Factors of a matrix of some tens of unknowns in its place, by elimination with row pivots, for :func:`solved_by`.

    ``order`` is filled in with where its rows came from, and with -1 for an unknown that is in no equation but its own:
    that one is left as it is, to be solved when all others are known. Not finite where the matrix is singular.
    """
    _eliminate(rows, order, np.empty(order.shape[0]))


@loop
def _alone(rows: Any, k: int) -> bool:
    """Whether an unknown is in its own equation only."""
    i = 0
    while i < rows.shape[0] and (rows[i, k] == 0 or i == k):
        i += 1
    return bool(i == rows.shape[0])


@loop
def _eliminate(rows: Any, order: Any, pivot: Any) -> None:
    n = order.shape[0]
    for k in range(n):
        order[k] = -1 if _alone(rows, k) else k
    for k in range(n):
        if order[k] < 0:
            continue
        best = k
        for i in range(k + 1, n):
            if order[i] >= 0 and abs(rows[i, k]) > abs(rows[best, k]):
                best = i
        for j in range(n):
            pivot[j], rows[best, j] = rows[best, j], rows[k, j]
            rows[k, j] = pivot[j]
        for j in range(k):
            pivot[j] = 0.0
        order[best], order[k] = order[k], order[best]
        for i in range(k + 1, n):
            if order[i] < 0:
                continue
            factor = rows[i, k] / pivot[k]
            if factor != 0:
                for j in range(n):  # all of the row: from its beginning, compiled code takes several numbers at once
                    rows[i, j] -= factor * pivot[j]
                rows[i, k] = factor


@loop
def _substitute(rows: Any, order: Any, right: Any, x: Any) -> None:
    n = order.shape[0]
    for k in range(n):
        x[k] = 0.0
        if order[k] >= 0:
            x[k] = right[order[k]]
            for j in range(k):
                x[k] -= rows[k, j] * x[j]
    for k in range(n - 1, -1, -1):
        if order[k] >= 0:
            for j in range(k + 1, n):
                x[k] -= rows[k, j] * x[j]
            x[k] /= rows[k, k]
    for k in range(n):
        if order[k] < 0:
            own = right[k]
            for j in range(n):
                if order[j] >= 0:
                    own -= rows[k, j] * x[j]
            x[k] = own / rows[k, k]


@part
def solved_by(factors: Any, right: Any) -> Any:
    """Solution for a right-hand side with the factors and the order of :func:`eliminate`."""
    x = np.empty(right.shape[0])
    _substitute(factors[0], factors[1], right, x)
    return x
