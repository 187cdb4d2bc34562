"""Pressure and friction along the contact patch at an instant of the march, as the contact itself had them."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ..contact.forces import BRUSH, DRAG, ELASTIC, EPS_N, EPS_T, ETA, MU, SPACING, STICK
from ..contact.friction import SLIDE_LEFT, SLIDE_RIGHT, edge_of_patch
from ..models.rim_contact import RimContact
from ..models.state import State

Array = NDArray[np.float64]

#: of a material point of the rim
STICKS, FREE, SLIPS = 1, 0, -1


@dataclass(frozen=True, eq=False)
class Profile:
    """Along the patch, from edge to edge; linear between neighbours.

    The edge of the friction appears twice, because that of a sticking patch ends in a jump. The trapezoidal rule over
    ``theta`` gives N and F as the contact has them.

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
        on_floor = np.flatnonzero(gap < 0)
        if not len(on_floor):
            continue
        held, flags = np.full(len(around), np.nan), np.zeros(len(around))
        held[1:-1], flags[1:-1] = -eps_t * state.bristles[part, 1], state.flags[part]
        if state.mode in (SLIDE_RIGHT, SLIDE_LEFT):
            held = -state.mode * hoop.law[MU] * eps_n * np.minimum(gap, 0.0) * state.res[ETA]
        elastic = -eps_n * np.minimum(gap, 0.0)
        if state.res[ELASTIC] > 0:
            held += state.res[DRAG] * elastic / state.res[ELASTIC]
        slips = flags != 0 if state.mode == BRUSH else np.full(len(around), state.mode != STICK)
        inside = slice(on_floor[0], on_floor[-1] + 1)
        sticks = np.where(slips, SLIPS, STICKS)
        columns = [theta[inside], state.res[ETA] * elastic[inside], held[inside], sticks[inside]]
        for end, way in ((on_floor[0], -1), (on_floor[-1], 1)):
            share, pull = _beyond(gap, held, end, way, state.mode)
            edge = [theta[end] + way * spacing * share, np.zeros(3), pull, np.full(3, FREE)]
            columns = [np.concatenate([e[::-1], c] if way < 0 else [c, e]) for c, e in zip(columns, edge, strict=True)]
        pieces.append(columns)
    theta, pressure, traction, stick = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return Profile(theta, pressure, traction, stick.astype(np.int8))


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


def _beyond(gap: Array, held: Array, end: int, way: int, mode: int) -> tuple[Array, Array]:
    """Where, in spacings beyond the last touching point, pressure and then friction end (twice), and friction there.

    The pressure's edge is that of :mod:`flexible.contact.normal`, on a straight gap, and so is that of whatever slides;
    that of a sticking patch lies on the parabola of :mod:`flexible.contact.friction`.
    """
    straight = curved = gap[end] / (gap[end] - gap[end + way])
    if mode == STICK and 0 <= end - way < len(gap):
        curved = max(straight, edge_of_patch(gap[end], gap[end + way], gap[end - way])[0])
    share = np.array([straight, curved, curved])
    if mode == STICK and not np.isnan(held[end + way]):  # points leave here, stretched
        pull = held[end] + share * (held[end + way] - held[end])
    else:
        pull = held[end] * (1 - share / curved)
    pull[2] = 0.0
    return share, pull
