"""Room for all that is known of a patch's points while its forces are made.

A few blocks are allocated at once, and what has a name is a part of one: the named tuples of
:mod:`flexible.contact.points` are made of these parts in code that does not count them
(:func:`rigid.kernel.compile.loop`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import loop, part

from .points.bristles import Carried
from .points.data import Bristles, PointForces
from .points.detection import Points
from .points.normal import Foundation

FOUNDATION, EARLIER, CARRIED, FORCES, PULL, SCRATCH, ROWS = 16, 19, 22, 30, 36, 37, 39  # in the rows, behind points
BASES, UNKNOWNS = 7, 7
SHARING, SPREADING, WAY, ENTERED = 3, 4, 5, 6
"""Of unknowns: what goes like eta, what spreads like the pressure, the way's, and what those that enter pull by it."""


class Room(NamedTuple):
    """Of n points and as many nodes as the window has."""

    ranges: Any  # (elements, 2) first and last point of ranges of neighbours
    ranged: int  # how many there are
    rows: Any  # (ROWS, n)
    fives: Any  # (4, n, 5) what moves abscissas, gaps; derivatives of forces and of weights by five gaps
    shape: Any  # (2, n, 3)
    whole: Any  # (2, n) int64: numbers, first nodes
    flags: Any  # (4, n) int8: last of a range, touched, sliding, kept
    bases: Any  # (BASES, 2 + nodes) see :mod:`flexible.contact.assembly`
    unknowns: Any  # (UNKNOWNS, 3 + 2 nodes)
    by_bases: Any  # (3, 2 + nodes, 2 + nodes)
    block: Any  # (3, 5, 5)
    tangent: Any  # that of the unknowns; of no size where none is asked for


@loop
def points_in(room: Room) -> Any:
    """Where points are described."""
    rows, whole = room.rows, room.whole
    return Points(
        whole[0], room.flags[0], whole[1], room.shape[0], room.shape[1], rows[0], rows[1], rows[2], rows[3], rows[4],
        rows[5], rows[6], rows[7], rows[8], rows[9], rows[10], rows[11], rows[12], rows[13], rows[14], rows[15],
    )  # fmt: skip


@loop
def foundation_in(room: Room, energy: float, length: float) -> Any:
    """The foundation under them."""
    rows = room.rows
    return Foundation(rows[FOUNDATION], rows[FOUNDATION + 1], rows[FOUNDATION + 2], energy, length)


@loop
def earlier_in(room: Room) -> Any:
    """The foundation where they are now as the step began, under other points of the rim."""
    rows = room.rows
    return Foundation(rows[EARLIER], rows[EARLIER + 1], rows[EARLIER + 2], 0.0, 0.0)


@loop
def carried_in(room: Room) -> Any:
    """Their bristles."""
    rows = room.rows
    return Carried(
        rows[CARRIED], rows[CARRIED + 1], rows[CARRIED + 2], rows[CARRIED + 3], rows[CARRIED + 4], room.flags[1],
        room.flags[2], rows[CARRIED + 5], rows[CARRIED + 6], rows[CARRIED + 7],
    )  # fmt: skip


@loop
def forces_in(room: Room) -> Any:
    """The tangential forces on them."""
    rows = room.rows
    return PointForces(
        rows[FORCES], rows[FORCES + 1], rows[FORCES + 2], rows[FORCES + 3], rows[FORCES + 4], room.fives[2],
        rows[FORCES + 5], room.fives[3], room.flags[3],
    )  # fmt: skip


@loop
def keep(room: Room, bristles: Bristles) -> None:
    """Fill in what of the points outlasts the step."""
    stretch, pull = room.rows[CARRIED], room.rows[PULL]
    n = 0
    for i in range(stretch.shape[0]):
        if room.flags[3, i] != 0:
            bristles.number[n], bristles.stretch[n], bristles.pull[n] = room.whole[0, i], stretch[i], pull[i]
            bristles.sliding[n] = room.flags[2, i]
            n += 1


@part
def room_for(total: int, nodes: int, ranges: Any, ranged: int, differentiates: bool) -> Room:
    """All of it, zero where it is added to."""
    basis, unknowns = 2 + nodes, 3 + 2 * nodes
    size = unknowns if differentiates else 0
    return Room(
        ranges, ranged, np.zeros((ROWS, total)), np.zeros((4, total, 5)), np.zeros((2, total, 3)),
        np.empty((2, total), np.int64), np.zeros((4, total), np.int8), np.zeros((BASES, basis)),
        np.zeros((UNKNOWNS, unknowns)), np.zeros((3, basis, basis)), np.zeros((3, 5, 5)), np.zeros((size, size)),
    )  # fmt: skip
