"""Where the rim of a chain is lowest: found by its sections, and only near those by the rim between them."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from rigid.kernel.compile import jit, loop

from .rim import chords_around, rim_point

THINNER = 0.1  # of its offset a rim is nearer to the centres, or farther, for its strains: nu times a third


@loop
def _above(rod: Any, q: Any, phi: float, height: float, gap: Any) -> float:
    """Gap of the rim at the sections, the least of them returned; of those clearly not the lowest less than the gap.

    The rim is ``offset`` from the centres whichever way they turn, and so no lower than that below one.
    """
    s, c = sin(phi), cos(phi)
    lowest = np.inf
    for i in range(gap.shape[0]):
        gap[i] = height + 1 + (rod.place[i, 0] + q[i, 0]) * c - (rod.place[i, 1] + q[i, 1]) * s
        lowest = min(lowest, gap[i])
    least, radius = np.inf, 1 - rod.offset
    for i in range(gap.shape[0]):
        if gap[i] > lowest + 2 * rod.offset:
            gap[i] -= rod.offset
            continue
        ct, st = cos(q[i, 2]), sin(q[i, 2])
        a, b = rod.place[i, 0] / radius, rod.place[i, 1] / radius
        gap[i] += rod.offset * ((ct * a - st * b) * c - (st * a + ct * b) * s)
        least = min(least, gap[i])
    return least


@jit
def lowest(rod: Any, q: Any, nodes: Any, theta: Any, phi: float, height: float) -> tuple[float, float]:
    """Angles from the bottom, in (-pi, pi], between which rim nodes that follow the sections are below the floor.

    Of the lowest node if none is. Only where the sections at both ends of a part are clear of the floor by no more than
    the part can hang through, its width squared and what its wall is thicker, its nodes are looked at, and always those
    beside a thin wall's weld.
    """
    found = np.empty(2)
    room = np.empty(rod.theta.shape[0]), np.empty((3, 6)), np.empty(2), np.empty((2, 18))
    _lowest(rod, q, nodes, (theta, phi, height), room, found)
    return found[0], found[1]


@loop
def _is_clear(rod: Any, nodes: Any, k: int, above: Any, limit: float) -> bool:
    """Whether a node is above the floor wherever it is between its sections.

    Of one beside a thin wall's weld they do not say it: strains move it by their squares, however large they are.
    """
    part = nodes.part[k]
    if nodes.bow[k, 0, 0, 0, 0] != 0 or nodes.bow[k, 0, 1, 0, 0] != 0:
        return False
    if part < 0:
        return bool(min(above[0], above[above.shape[0] - 1]) > limit + rod.theta[0] ** 2)
    hangs = (rod.theta[part + 1] - rod.theta[part]) ** 2 + 2 * THINNER * rod.offset
    return bool(min(above[part], above[part + 1]) > limit + hangs)


@loop
def _lowest(rod: Any, q: Any, nodes: Any, pose: Any, room: Any, found: Any) -> None:
    theta, phi, height = pose
    above, chords, moved, by = room
    s, c = sin(phi), cos(phi)
    limit = max(_above(rod, q, phi, height, above), 0.0)
    low, high, least, at_least = np.inf, -np.inf, np.inf, 0.0
    for k in range(theta.shape[0]):
        if _is_clear(rod, nodes, k, above, limit):
            continue
        chords_around(rod, q, nodes.part[k], chords)
        rim_point(rod, q, nodes.part[k], nodes.xi[k], (nodes.root[k], nodes.bow[k]), chords, moved, by)
        angle = phi - np.pi + theta[k]
        psi = angle - 2 * np.pi * np.round(angle / (2 * np.pi))
        gap = height + 2 * sin(angle / 2) ** 2 + moved[0] * c - moved[1] * s
        if gap < least:
            least, at_least = gap, psi
        if gap <= 0:
            low, high = min(low, psi), max(high, psi)
    found[0], found[1] = (at_least, at_least) if least > 0 else (low, high)
