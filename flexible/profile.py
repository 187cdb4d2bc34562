"""Pressure and friction along the contact patch at an instant of the march, as the contact itself had them."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from .contact import BRUSH, DRAG, ELASTIC, EPS_N, EPS_T, ETA, SPACING, STICK
from .state import State
from .touch import RimContact

Array = NDArray[np.float64]

#: of a material point of the rim
STICKS, FREE, SLIPS = 1, 0, -1


@dataclass(frozen=True, eq=False)
class Profile:
    """Along the patch, from edge to edge; linear between neighbours.

    Both edges appear twice, inside and outside, because the friction of a sticking patch ends in a jump. The
    trapezoidal rule over ``theta`` gives N exactly, and F up to the last spacing at that jump.

    Attributes
    ----------
    theta : (n,) array
        Material angle, counted round and round.
    pressure, traction : (n,) arrays
        Vertical and horizontal force on the rim per length of rim, in m g/R.
    stick : (n,) array of int8
        ``STICKS``, ``SLIPS``, or ``FREE`` off the floor.
    """

    theta: Array
    pressure: Array
    traction: Array
    stick: NDArray[np.int8]


def profile(hoop: RimContact, state: State) -> Profile:
    """The profile at a state; empty off the floor."""
    if not len(state.bristles):
        none = np.empty(0)
        return Profile(none, none, none, np.empty(0, np.int8))
    spacing, eps_n, eps_t = (float(hoop.law[i]) for i in (SPACING, EPS_N, EPS_T))
    number = state.bristles[:, 0].astype(np.int64)
    parts = np.split(np.arange(len(number)), np.flatnonzero(np.diff(number) > 1) + 1)
    pieces = []
    for part in parts:
        around = np.arange(number[part[0]] - 1, number[part[-1]] + 2)
        theta = around * spacing
        gap = _gap(hoop, state, theta)
        gap[1:-1] = np.minimum(gap[1:-1], 0.0)  # touching, whatever the last digit says
        elastic = -eps_n * gap[1:-1]
        traction = -eps_t * state.bristles[part, 1]
        if state.res[ELASTIC] > 0:
            traction = traction + state.res[DRAG] * elastic / state.res[ELASTIC]
        slips = state.flags[part] != 0 if state.mode == BRUSH else np.full(len(part), state.mode != STICK)
        ends = [_edge(gap[1], gap[0]), _edge(gap[-2], gap[-1])]
        edge = np.array([theta[1] - ends[0] * spacing, theta[-2] + ends[1] * spacing])
        at_edge = _traction_at_edges(state, traction, ends)
        pieces.append((
            np.concatenate([edge[[0, 0]], theta[1:-1], edge[[1, 1]]]),
            np.concatenate([[0.0, 0.0], state.res[ETA] * elastic, [0.0, 0.0]]),
            np.concatenate([[0.0, at_edge[0]], traction, [at_edge[1], 0.0]]),
            np.concatenate([[FREE, FREE], np.where(slips, SLIPS, STICKS), [FREE, FREE]]).astype(np.int8),
        ))  # fmt: skip
    return Profile(*(np.concatenate(column) for column in zip(*pieces, strict=True)))


def _gap(hoop: RimContact, state: State, theta: Array) -> Array:
    """Gap of material points, on the displacement that the contact used."""
    vertex = hoop.vertex
    turn = np.floor((theta - vertex[0]) / (2 * pi))
    element = np.searchsorted(vertex, theta - 2 * pi * turn, side="right") - 1
    element = element + turn.astype(np.int64) * len(vertex)
    first, count = state.window
    element = np.clip(element, first, first + count - 1)
    start, end = (vertex[e % len(vertex)] + 2 * pi * (e // len(vertex)) for e in (element, element + 1))
    xi = (theta - start) / (end - start)
    k = 2 * (element - first)
    shape = np.stack([(1 - xi) * (1 - 2 * xi), 4 * xi * (1 - xi), xi * (2 * xi - 1)])
    u = sum(shape[i][:, None] * state.u[k + i] for i in range(3))
    phi, height = state.pos[2], state.pos[1]
    return height + 2 * np.sin((phi + theta - pi) / 2) ** 2 + u[:, 0] * np.cos(phi) - u[:, 1] * np.sin(phi)


def _edge(inside: float, outside: float) -> float:
    """Share of the spacing from the last touching point to where the gap, linear, is zero."""
    return float(inside / (inside - outside)) if outside > 0 else 1.0


def _traction_at_edges(state: State, traction: Array, ends: list[float]) -> tuple[float, float]:
    """Zero where the patch slides or points enter; carried on linearly where a sticking patch lets points go."""
    if state.mode != STICK or len(traction) < 2:
        return 0.0, 0.0
    low = traction[0] + ends[0] * (traction[0] - traction[1])
    high = traction[-1] + ends[1] * (traction[-1] - traction[-2])
    # points move toward larger psi as phi grows
    return (0.0, float(high)) if state.vel[2] >= 0 else (float(low), 0.0)
