"""The rim: where its elements and nodes are, and how far its points are over the floor.

A function without a loop serves numbers in compiled code and arrays outside of it.
"""

from __future__ import annotations

from math import floor, pi
from typing import Any

import numpy as np

from rigid.kernel.compile import jit, loop, part


@loop
def shape_functions(xi: Any) -> tuple[Any, Any, Any]:
    """Weights of the three nodes of a quadratic element at its coordinate ``xi``, 0..1."""
    return (1 - xi) * (1 - 2 * xi), 4 * xi * (1 - xi), xi * (2 * xi - 1)


@loop
def shape_slopes(xi: Any, width: Any) -> tuple[Any, Any, Any]:
    """Their derivatives by the angle, in an element of that ``width``."""
    return (4 * xi - 3) / width, (4 - 8 * xi) / width, (4 * xi - 1) / width


@loop
def lift(psi: Any) -> Any:
    """Height of the undeformed circle over its lowest point, at the angle ``psi`` from there."""
    return 2 * np.sin(psi / 2) ** 2


@loop
def gap_at(height: Any, psi: Any, u_y: Any) -> Any:
    """Gap of a rim point displaced upward by ``u_y`` on a hoop whose centre is ``height`` above R."""
    return height + lift(psi) + u_y


@loop
def upward(u1: Any, u2: Any, s: Any, c: Any) -> Any:
    """Vertical component of a displacement in the disk's axes; s, c are sine and cosine of phi."""
    return u1 * c - u2 * s


@loop
def sideways(u1: Any, u2: Any, s: Any, c: Any) -> Any:
    """Horizontal component."""
    return u1 * s + u2 * c


@loop
def vertex_angle(vertex: Any, element: Any) -> Any:
    """Angle at which rim element ``element`` begins; elements are counted on round and round."""
    n = vertex.shape[0]
    turn = element // n
    return vertex[element - turn * n] + 2 * pi * turn


MARGIN, LEAST_MARGIN = 0.3, 0.1  # of a patch, and of an element: what of the rim is looked at to either side of it
STIFF = 1e-4  # displacement over R below which no turn of the rim is worth its arithmetic


@loop
def turned(theta: Any, window: tuple[int, int], u: Any) -> float:
    """Rotation of the rim, the mean over a window, by the displacement of its nodes.

    ``theta`` are the angles of all nodes of the rim; 0 where it can only be small.
    """
    most, along, outward = 0.0, 0.0, 0.0
    count, angle = u.shape[0], 0.0
    start = vertex_angle(theta, 2 * window[0])
    for i in range(count):
        angle = vertex_angle(theta, 2 * window[0] + i)
        s, c = np.sin(angle), np.cos(angle)
        along += (u[i, 1] * c - u[i, 0] * s) / count
        most = max(most, abs(u[i, 0]), abs(u[i, 1]))
        radial = u[i, 0] * c + u[i, 1] * s
        if i == 0:
            outward -= radial
        if i == count - 1:
            outward += radial
    return float(abs(along - outward / (angle - start))) if most >= STIFF else 0.0


@jit
def element_at(vertex: Any, theta: float) -> int:
    """Rim element that holds the material angle ``theta``."""
    n = vertex.shape[0]
    turn = int(floor((theta - vertex[0]) / (2 * pi)))
    rest = theta - 2 * pi * turn
    low, high = -1, n
    while high - low > 1:
        middle = (low + high) // 2
        if vertex[middle] <= rest:
            low = middle
        else:
            high = middle
    return low + turn * n


@jit
def below_floor(theta: Any, phi: float, height: float, moved: Any) -> tuple[float, float]:
    """Angles from the bottom between which rim nodes are below the floor; of the lowest node if none is.

    ``theta`` are the angles of all rim nodes, (n_rim,), ``moved`` their displacement, (2 n_rim,), node by node.
    """
    s, c = np.sin(phi), np.cos(phi)
    gap, psi = np.empty(theta.shape[0]), np.empty(theta.shape[0])
    for i in range(theta.shape[0]):
        angle = phi - pi + theta[i]
        psi[i] = angle - 2 * pi * floor(angle / (2 * pi) + 0.5)
        gap[i] = gap_at(height, psi[i], upward(moved[2 * i], moved[2 * i + 1], s, c))
    deepest = gap[0]
    for i in range(1, theta.shape[0]):
        deepest = min(deepest, gap[i])
    deepest = max(deepest, 0.0)
    low, high = np.inf, -np.inf
    for i in range(theta.shape[0]):
        if gap[i] <= deepest:
            low, high = min(low, psi[i]), max(high, psi[i])
    return low, high


@loop
def margin_around(low: float, high: float, element: float) -> float:
    """How far beyond ``low`` and ``high``, the ends of a patch, its window reaches; ``element`` is the length of one.

    A patch that comes to reach beyond its window is solved again in a wider one.
    """
    return MARGIN * (high - low) + LEAST_MARGIN * element


@part
def window_around(vertex: Any, phi: float, low: float, high: float, margin: float) -> tuple[int, int]:
    """First rim element and number of elements of the part ``low`` to ``high`` (angles from the bottom)."""
    theta = pi - phi
    first = element_at(vertex, theta + low - margin)
    last = element_at(vertex, theta + high + margin)
    return first, last - first + 1
