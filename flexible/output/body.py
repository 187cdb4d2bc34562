"""How a hoop moves as a whole: mass centre, spin, and what of its kinetic energy is neither; its rim
and the lowest point of that.

Momenta, and inertias as those of a unit turn, follow from the kinetic energy (:func:`flexible.models.state.momentum`).
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact.points.rim import gap_at, sideways, upward
from ..models.select import Hoop
from ..models.state import State, momentum

Array = NDArray[np.float64]
Window = tuple[int, int]


class Whole(NamedTuple):
    """The hoop as a whole, R = m = g = 1. Kinetic energy is the sum of its three shares."""

    velocity: tuple[float, float]
    """Of the mass centre G, to the right and up."""
    height: float
    """Of G over the floor."""
    spin: float
    """Angular momentum about G over the moment of inertia about G, clockwise."""
    translation: float
    """Kinetic energy of the whole mass moving with G."""
    rotation: float
    """Of the bent hoop turning rigidly about G with the spin."""
    vibration: float
    """What is left; of all rigid motions this one leaves the least."""


def whole(hoop: Hoop, state: State) -> Whole:
    """Mass centre, spin and shares of the kinetic energy of a hoop in a state."""
    right, up, turn = np.zeros((3, len(state.vel)))
    right[0] = up[1] = turn[2] = 1.0
    turn[0] = -1.0  # C stands: V = x_C - phi

    turning = state._replace(vel=turn)
    mass = momentum(hoop, state._replace(vel=right), right)
    moving = np.array([momentum(hoop, state, right), momentum(hoop, state, up)])
    carried = np.array([momentum(hoop, turning, right), momentum(hoop, turning, up)])  # by a unit turn about C
    inertia = momentum(hoop, turning, turn) - float(carried @ carried) / mass
    about = momentum(hoop, state, turn) - float(carried @ moving) / mass
    moved, spun = float(moving @ moving) / (2 * mass), about**2 / (2 * inertia)
    vx, vy = (moving / mass).tolist()
    height = 1 + float(state.pos[1]) + float(carried[0]) / mass
    return Whole((vx, vy), height, about / inertia, moved, spun, float(hoop.energies(state)[0]) - moved - spun)


def outline(hoop: Hoop, state: State) -> Array:
    """The rim's nodes in the world, (2 elements, 2), in R; x is 0 where the hoop's centre was at its release."""
    angle, u_x, u_y = _rim(hoop, state)
    x = state.x_C - np.sin(angle) + u_x
    return np.column_stack([x, 1 + state.pos[1] - np.cos(angle) + u_y])


def _rim(hoop: Hoop, state: State, window: Window | None = None) -> tuple[Array, Array, Array]:
    """Angles of the rim's nodes from the bottom, and their displacement to the right and up; of all, or of a window."""
    first, count = window or (0, len(hoop.vertex))
    nodes = np.arange(2 * first, 2 * (first + count) + (0 if window is None else 1))
    u1, u2 = hoop.displacement(state, (first, count))[: len(nodes)].T
    phi = float(state.pos[2])
    s, c = np.sin(phi), np.cos(phi)
    return phi + hoop.rim_angle(nodes) - pi, sideways(u1, u2, s, c), upward(u1, u2, s, c)


def lowest(hoop: Hoop, state: State) -> float:
    """Height of the rim's lowest point over the floor, in R; below 0 where it is pressed in.

    The parabola through the lowest node and its neighbours: of a circle it misses the depth by 3/128 (angle between
    nodes)^4 at most, 7e-10 with 240 elements.
    """
    window = hoop.lowest_in(state)
    angle, _, u_y = _rim(hoop, state, window)
    gap = gap_at(float(state.pos[1]), angle, u_y)
    i = int(np.argmin(gap))
    if window is not None:
        i = min(max(i, 1), len(gap) - 2)
    near = np.array([i - 1, i, i + 1]) % len(gap)
    at = angle[near] - angle[i]
    at -= 2 * pi * np.round(at / (2 * pi))
    bend, slope, here = np.polyfit(at, gap[near], 2)
    return float(here - slope**2 / (4 * bend)) if bend > 0 else float(gap.min())
