"""Whole vectors in compiled code, in loops.

numpy's own expressions and assignments of slices would be compiled anew in each function that has them, with all of
broadcasting and its messages, for seconds.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit, part


@jit
def largest(values: Any) -> float:
    """Largest absolute value, infinite if any is not a number: comparing with one would pass it over."""
    most = 0.0
    for value in values.flat:
        if not np.isfinite(value):
            return np.inf
        most = max(most, abs(value))
    return most


@part
def dot(left: Any, right: Any) -> float:
    """Sum of the products."""
    total = 0.0
    for i in range(left.shape[0]):
        total += left[i] * right[i]
    return total


@part
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
