"""Cubics between instants at which values and rates are known."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

T = TypeVar("T", float, Array)


def cubic(z: T, y0: T, y1: T, s0: T, s1: T) -> T:
    """Cubic on [0, 1] through values and slopes at both ends."""
    a, b = s0 - (y1 - y0), (y1 - y0) - s1
    return (1 - z) * y0 + z * y1 + z * (1 - z) * (a * (1 - z) + b * z)


def slope_of(z: float, y0: float, y1: float, s0: float, s1: float) -> float:
    """Derivative of the same."""
    a, b = s0 - (y1 - y0), (y1 - y0) - s1
    return (y1 - y0) + (1 - 2 * z) * (a * (1 - z) + b * z) + z * (1 - z) * (b - a)


def root(ends: tuple[float, float, float, float], low: float = 0.0) -> float:
    """Where from ``low`` to 1 the cubic with these ends loses the sign that it has at ``low``."""
    sign, high = cubic(low, *ends), 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if cubic(middle, *ends) * sign > 0 else (low, middle)
    return (low + high) / 2


def hermite(x: Array, x0: Array, x1: Array, y0: Array, y1: Array, s0: Array, s1: Array) -> Array:
    """The cubic of :func:`cubic` between two abscissas."""
    h = np.where(x1 > x0, x1 - x0, 1.0)
    return cubic((x - x0) / h, y0, y1, s0 * h, s1 * h)
