"""The dent: how far the rim was displaced when a step began, sideways and upward, as functions of the angle.

In rolling material points go through a dent that stands still, so that what moves one is how far it goes along it.
"""

from __future__ import annotations

from math import cos, inf, sin
from typing import NamedTuple

from rigid.kernel.compile import loop

from .data import Before, Rim
from .rim import element_at, sideways, upward, vertex_angle


class Dent(NamedTuple):
    """An element of the rim as it was when the step began: at a material angle theta its sideways displacement is
    x + rise d + bend d^2, d = theta - origin, and that upward y + climb d + bow d^2.
    """

    start: float  # material angles
    end: float
    origin: float
    x: float
    rise: float
    bend: float
    y: float
    climb: float
    bow: float


NO_ELEMENT = Dent(inf, -inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)  # holds no angle


@loop
def dent_at(before: Before, rim: Rim, theta: float) -> Dent:
    """The element that holds a material angle; beyond those near the floor the displacement is that of the last node.

    It is 0 everywhere of a hoop that was off the floor.
    """
    u, first = before.dent, before.first
    if u.shape[0] == 0:
        return Dent(-inf, inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    s, c = sin(before.pose[2]), cos(before.pose[2])
    element = element_at(rim.vertex, theta)
    if rim.first <= element < rim.first + (before.u.shape[0] - 1) // 2:  # what is near the floor now was known as well
        u, first = before.u, rim.first
    last = first + (u.shape[0] - 1) // 2
    if element < first:
        x, y = sideways(u[0, 0], u[0, 1], s, c), upward(u[0, 0], u[0, 1], s, c)
        return Dent(-inf, vertex_angle(rim.vertex, first), 0.0, x, 0.0, 0.0, y, 0.0, 0.0)
    if element >= last:
        x, y = sideways(u[-1, 0], u[-1, 1], s, c), upward(u[-1, 0], u[-1, 1], s, c)
        return Dent(vertex_angle(rim.vertex, last), inf, 0.0, x, 0.0, 0.0, y, 0.0, 0.0)
    k = 2 * (element - first)
    x0 = sideways(u[k, 0], u[k, 1], s, c)
    x1 = sideways(u[k + 1, 0], u[k + 1, 1], s, c)
    x2 = sideways(u[k + 2, 0], u[k + 2, 1], s, c)
    y0 = upward(u[k, 0], u[k, 1], s, c)
    y1 = upward(u[k + 1, 0], u[k + 1, 1], s, c)
    y2 = upward(u[k + 2, 0], u[k + 2, 1], s, c)
    start, end = vertex_angle(rim.vertex, element), vertex_angle(rim.vertex, element + 1)
    width = end - start
    rise, bend = (4 * x1 - 3 * x0 - x2) / width, (2 * (x0 + x2) - 4 * x1) / width**2
    climb, bow = (4 * y1 - 3 * y0 - y2) / width, (2 * (y0 + y2) - 4 * y1) / width**2
    return Dent(start, end, start, x0, rise, bend, y0, climb, bow)


@loop
def displaced(dent: Dent, theta: float) -> tuple[float, float]:
    """Sideways displacement at a material angle in the element, and its derivative by that."""
    d = theta - dent.origin
    return dent.x + d * (dent.rise + d * dent.bend), dent.rise + 2 * d * dent.bend


@loop
def raised(dent: Dent, theta: float) -> tuple[float, float]:
    """The same upward."""
    d = theta - dent.origin
    return dent.y + d * (dent.climb + d * dent.bow), dent.climb + 2 * d * dent.bow


@loop
def through_dent(
    dent: Dent, before: Before, rim: Rim, theta: float, dphi: float, spacing: float
) -> tuple[float, float]:
    """How much farther sideways a turn ``dphi`` takes what is at a material angle now, and the derivative by the turn
    of what that is beyond the displacement there.

    Of a turn longer than the points' distance the dent's slope over that, about the angle, stands for all of the way:
    a mean, as the slope itself jumps from element to element.
    """
    part = min(max(dphi, -spacing), spacing)
    ahead = theta + part / 2
    x, x_by = displaced(next_dent(dent, before, rim, ahead), ahead)
    y, y_by = displaced(next_dent(dent, before, rim, ahead - part), ahead - part)
    slope = displaced(dent, theta)[1]
    if part == dphi:
        return x - y, 1.5 * x_by - 0.5 * y_by - slope
    return (x - y) * dphi / part, (x - y + (x_by - y_by) * dphi) / part - slope


@loop
def next_dent(dent: Dent, before: Before, rim: Rim, theta: float) -> Dent:
    """The same element where it still holds the angle, another one where it does not."""
    return dent if dent.start <= theta < dent.end else dent_at(before, rim, theta)
