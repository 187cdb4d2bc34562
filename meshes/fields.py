"""A frame: what the hoop and its surroundings look like at one instant, as plain arrays on a few blocks.

No physics is in here: a solver fills the arrays, :mod:`meshes.series` writes them, :mod:`meshes.view` draws
them. Points are undeformed and placed in the world (x to the right, y up, floor at y = 0); the deformation is
the point field ``displacement``, exact and never exaggerated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from math import inf, isfinite, pi
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .ring import RingMesh

AnyArray = NDArray[np.generic]
Array = NDArray[np.float64]

#: VTK's numbers of the cells used here
LINE, TRIANGLE, QUAD, QUADRATIC_EDGE, BIQUADRATIC_QUAD = 3, 5, 9, 21, 28

#: Nodes per cell of each of them
NODES = {LINE: 2, TRIANGLE: 3, QUAD: 4, QUADRATIC_EDGE: 3, BIQUADRATIC_QUAD: 9}


class SeriesError(ValueError):
    """A frame or a file that is not what it should be: one sentence that says why."""


@dataclass(frozen=True, eq=False)
class Block:
    """One body: points, cells of one kind, and fields on them.

    Points and point fields of two components get a third, zero, because VTK warps nothing else.

    Parameters
    ----------
    points : (n_points, 2 or 3) array
        Undeformed positions in the world.
    cells : (n_cells, nodes per cell) integer array
        Connectivity in VTK's order.
    cell_type : int
        VTK's number of the cell, one of ``NODES``.
    point_data, cell_data : mapping of arrays
        Fields of shape (n,) or (n, components).
    field_data : mapping of arrays or numbers
        Values that belong to the whole block, e.g. ``display_factor``.

    Raises
    ------
    SeriesError
        Arrays that do not fit each other.
    """

    points: AnyArray
    cells: AnyArray
    cell_type: int
    point_data: Mapping[str, AnyArray] = field(default_factory=dict)
    cell_data: Mapping[str, AnyArray] = field(default_factory=dict)
    field_data: Mapping[str, AnyArray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        points, cells = _three(self.points), np.asarray(self.cells)
        if points.ndim != 2 or points.shape[1] != 3 or not len(points):
            raise SeriesError(f"points of shape {points.shape} are no points: it takes (n, 2) or (n, 3).")
        if cells.ndim != 2 or not len(cells) or cells.shape[1] != NODES.get(self.cell_type):
            raise SeriesError(f"cells of shape {cells.shape} do not fit VTK's cell type {self.cell_type}.")
        if cells.dtype.kind not in "iu" or cells.min() < 0 or cells.max() >= len(points):
            raise SeriesError(f"cells are whole numbers of points, 0 to {len(points) - 1} here; these are not.")
        set_ = object.__setattr__
        set_(self, "points", points)
        set_(self, "cells", cells)
        set_(self, "point_data", {name: _three(value) for name, value in self.point_data.items()})
        set_(self, "cell_data", {name: np.asarray(value) for name, value in self.cell_data.items()})
        set_(self, "field_data", {name: np.atleast_1d(value) for name, value in self.field_data.items()})
        for kind, count in (("point", len(points)), ("cell", len(cells))):
            for name, value in getattr(self, f"{kind}_data").items():
                if value.ndim not in (1, 2) or len(value) != count:
                    raise SeriesError(f"{kind} field {name} has shape {value.shape} on {count} {kind}s.")

    def __repr__(self) -> str:
        return f"Block({len(self.points)} points, {len(self.cells)} cells)"


@dataclass(frozen=True, eq=False)
class Frame:
    """An instant: its time in the run's unit of time, and the blocks by name in a lasting order.

    Raises
    ------
    SeriesError
        No block at all.
    """

    time: float
    blocks: Mapping[str, Block]

    def __post_init__(self) -> None:
        if not self.blocks:
            raise SeriesError(f"a frame without a block, at t = {self.time!r}, shows nothing.")

    def __repr__(self) -> str:
        return f"Frame(t = {self.time!r}: {', '.join(self.blocks)})"


def ring_block(ring: RingMesh, points: Array, **fields: AnyArray) -> Block:
    """The ring; ``points`` (n_nodes, 2) and ``fields`` (n_nodes,) or (n_nodes, components) are nodal."""
    return Block(points, ring.quad9, BIQUADRATIC_QUAD, fields)


def rim_block(ring: RingMesh, points: Array, **fields: AnyArray) -> Block:
    """The outer rim as a closed line of quadratic edges.

    ``points`` and ``fields`` have one row per rim node, in the order of ``ring.rim_nodes``.
    """
    return Block(points, _circle(ring.around), QUADRATIC_EDGE, fields)


def disk_block(centre: ArrayLike, radius: float, angle: float, sectors: int = 120) -> Block:
    """A disk as a fan of triangles, turned clockwise by ``angle``, which the cell field ``half`` shows.

    Raises
    ------
    SeriesError
        A radius that is not above 0, a centre or an angle that is none, or no whole number of sectors from 3 on.
    """
    numbers = all(isinstance(value, Real) for value in (radius, angle, sectors)) and _is_place(centre)
    if not (numbers and 0 < radius < inf and sectors >= 3 and sectors % 1 == 0 and isfinite(angle)):
        raise SeriesError(
            f"a disk of radius {radius!r} about {centre!r}, turned by {angle!r}, in {sectors!r} sectors, is "
            "not possible."
        )
    sectors = int(sectors)
    turn = np.arange(sectors) * (2 * pi / sectors) - angle
    rim = np.column_stack([np.cos(turn), np.sin(turn)]) * radius
    points = np.vstack([[0.0, 0.0], rim]) + np.asarray(centre, dtype=float)
    half = (np.arange(sectors) >= sectors // 2).astype(np.uint8)
    return Block(points, _fan(sectors), TRIANGLE, cell_data={"half": half})


def floor_block(left: float, right: float, depth: float) -> Block:
    """The floor from x = ``left`` to ``right``, a slab whose top is y = 0.

    Raises
    ------
    SeriesError
        Ends that are not from left to right, or a depth that is not above 0.
    """
    numbers = all(isinstance(value, Real) for value in (left, right, depth))
    if not (numbers and -inf < left < right < inf and 0 < depth < inf):
        raise SeriesError(f"a floor from {left!r} to {right!r}, {depth!r} deep, is not possible.")
    points = np.array([[left, -depth], [right, -depth], [right, 0.0], [left, 0.0]])
    return Block(points, np.array([[0, 1, 2, 3]]), QUAD)


def _is_place(centre: ArrayLike) -> bool:
    try:
        place = np.asarray(centre, dtype=float)
    except (TypeError, ValueError):
        return False
    return place.shape == (2,) and bool(np.isfinite(place).all())


# the same object for every frame, so that a writer encodes it once
@lru_cache(maxsize=8)
def _circle(around: int) -> AnyArray:
    start = np.arange(0, 2 * around, 2)
    return _fixed(np.column_stack([start, np.roll(start, -1), start + 1]))


@lru_cache(maxsize=8)
def _fan(sectors: int) -> AnyArray:
    first = np.arange(sectors)
    return _fixed(np.column_stack([np.zeros(sectors, dtype=int), first + 1, (first + 1) % sectors + 1]))


def _fixed(cells: AnyArray) -> AnyArray:
    """Shared by many blocks: nobody may write to it."""
    cells.flags.writeable = False
    return cells


def _three(value: ArrayLike) -> AnyArray:
    array = np.asarray(value)
    if array.ndim == 2 and array.shape[1] == 2:
        return np.column_stack([array, np.zeros(len(array), dtype=array.dtype)])
    return array
