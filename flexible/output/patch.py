"""Pressure and friction along the contact patch at an instant of the march, as the contact itself had them."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ..contact.laws.listing import sticks
from ..contact.points.bristles import edge_of_patch
from ..contact.points.rim import element_at, gap_at, shape_functions, upward, vertex_angle
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
    if not len(state.bristles.number):
        none = np.empty(0)
        return Profile(none, none, none, np.empty(0, np.int8))
    law, number = hoop.law, state.bristles.number
    spacing = law.parameters.spacing
    holds = sticks(law.parameters, state.mode)
    parts = np.split(np.arange(len(number)), np.flatnonzero(np.diff(number) > 1) + 1)
    pieces = []
    for part in parts:
        around = np.arange(number[part[0]] - 1, number[part[-1]] + 2)
        theta = around * spacing
        gap = _gap(hoop, state, theta)
        on_floor = np.flatnonzero(gap < 0)
        if not len(on_floor):
            continue
        stretch, sliding = np.full(len(around), np.nan), np.zeros(len(around))
        stretch[1:-1], sliding[1:-1] = state.bristles.stretch[part], state.bristles.sliding[part]
        elastic = -law.parameters.eps_n * np.minimum(gap, 0.0)
        held = law.pulls(state, stretch, elastic)
        # what the damper drags is shared like the pressure and ends with it, not with the bristles
        dragged = state.res.damping * elastic / state.res.elastic if state.res.elastic > 0 else 0 * elastic
        inside = slice(on_floor[0], on_floor[-1] + 1)
        stick = np.where(law.slipping(state, sliding), SLIPS, STICKS)
        columns = [theta[inside], state.res.eta * elastic[inside], held[inside], stick[inside]]
        for end, way in ((on_floor[0], -1), (on_floor[-1], 1)):
            share, pull = _beyond(gap, held - dragged, end, way, holds)
            edge = [theta[end] + way * spacing * share, np.zeros(3), pull, np.full(3, FREE)]
            columns = [np.concatenate([e[::-1], c] if way < 0 else [c, e]) for c, e in zip(columns, edge, strict=True)]
        pieces.append(columns)
    theta, pressure, traction, stick = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return Profile(theta, pressure, traction, stick.astype(np.int8))


def window_of(hoop: RimContact, state: State) -> tuple[float, float]:
    """Material angles between which the contact knew where the rim was."""
    first, count = state.window
    return float(vertex_angle(hoop.vertex, first)), float(vertex_angle(hoop.vertex, first + count))


def displaced(hoop: RimContact, state: State, theta: Array) -> Array:
    """Displacement of material points in the disk's axes, as the contact used it, (n, 2)."""
    vertex, (first, count) = hoop.vertex, state.window
    element = np.clip([element_at(vertex, angle) for angle in theta], first, first + count - 1)
    start, end = vertex_angle(vertex, element), vertex_angle(vertex, element + 1)
    k = 2 * (element - first)
    shape = np.stack(shape_functions((theta - start) / (end - start)))
    return np.asarray(np.einsum("in,inj->nj", shape, state.u[k + np.arange(3)[:, None]]))


def _gap(hoop: RimContact, state: State, theta: Array) -> Array:
    """Gap of material points."""
    u = displaced(hoop, state, theta)
    phi, height = state.pos[2], state.pos[1]
    gap: Array = gap_at(height, phi + theta - pi, upward(u[:, 0], u[:, 1], np.sin(phi), np.cos(phi)))
    return gap


def _beyond(gap: Array, held: Array, end: int, way: int, holds: bool) -> tuple[Array, Array]:
    """Where, in spacings beyond the last touching point, pressure and then friction end (twice), and friction there.

    The pressure's edge is that of :mod:`flexible.contact.points.normal`, on a straight gap, and so is that of whatever
    slides; that of a patch that sticks as a whole lies on the parabola of :mod:`flexible.contact.points.bristles`.
    """
    straight = curved = gap[end] / (gap[end] - gap[end + way])
    if holds and 0 <= end - way < len(gap):
        curved = max(straight, edge_of_patch(gap[end], gap[end + way], gap[end - way])[0])
    share = np.array([straight, curved, curved])
    if holds and not np.isnan(held[end + way]):  # points leave here, stretched
        pull = held[end] + share * (held[end + way] - held[end])
    else:
        pull = held[end] * (1 - share / curved)
    pull[2] = 0.0
    return share, pull
