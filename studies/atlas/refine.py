"""Which points of a map are run.

A square cell whose corners and centre agree (one sequence of phases, as many hops before the end of the pulse, and
values that the mean of the corners gives at the centre) is filled from its corners; any other is cut into four, down to
the grid. (Values jump where a hoop bounces once more on its way, within one sequence.) Squares of the grid whose
corners have different sequences are then looked into, so that boundaries are finer than the grid.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .plane import Array, Seen

FIRST = 16
"""Grid squares along a side of the cells that are looked at first: what is smaller may be missed."""
WITHIN = 4
"""Parts along the side of a grid square on a boundary."""
PORTION = 16_384
"""Hoops that are run at once."""

Run = Callable[[Array, Array], Seen]


class Map(NamedTuple):
    """What is known of a grid of (n + 1, n + 1) points (up, across), and of the squares between them."""

    sequence: NDArray[np.int64]
    """At the points."""
    values: Array
    """J_F/(mu J_N), friction loss, log10 of the peak of N at the points, (3, n + 1, n + 1)."""
    hops: NDArray[np.bool_]
    """Whether any, at the points."""
    jams: NDArray[np.bool_]
    """At the points."""
    computed: NDArray[np.bool_]
    """Which points were run; the others lie between such."""
    squares: NDArray[np.int64]
    """Sequence in the parts of the squares, (WITHIN n, WITHIN n)."""
    runs: int
    """Hoops that were run, those within squares included."""


class Sheet:
    """A grid being filled."""

    def __init__(self, run: Run, count: int, tell: Callable[[float], None]) -> None:
        self.run, self.count, self.tell, self.runs = run, count, tell, 0
        shape = (count + 1, count + 1)
        self.sequence = np.zeros(shape, dtype=np.int64)
        self.values = np.full((3, *shape), np.nan)
        self.hops = np.zeros(shape, dtype=np.int64)
        self.jams, self.computed = np.zeros((2, *shape), dtype=bool)

    def look(self, i: NDArray[np.int64], j: NDArray[np.int64], told: tuple[float, float]) -> None:
        """Run the points (row, column) that are not known; ``told`` is the progress before and after."""
        wanted = np.zeros_like(self.computed)
        wanted[i, j] = True
        i, j = np.nonzero(wanted & ~self.computed)
        for start in range(0, len(i), PORTION):
            part = slice(start, start + PORTION)
            seen = self.run(j[part] / self.count, i[part] / self.count)
            here = i[part], j[part]
            self.sequence[here], self.computed[here] = seen.sequence, True
            self.hops[here], self.jams[here] = seen.hops, seen.jams
            self.values[:, here[0], here[1]] = seen.share, seen.loss, seen.peak
            self.tell(told[0] + (told[1] - told[0]) * min(1.0, (start + PORTION) / max(len(i), 1)))
        self.runs += len(i)

    def agree(self, i: NDArray[np.int64], j: NDArray[np.int64], size: int, shade: Array) -> NDArray[np.bool_]:
        """Whether corners and centre of the cells with these lower corners agree, (m,)."""
        half = size // 2
        corners = [(i, j), (i, j + size), (i + size, j), (i + size, j + size)]
        middle = i + half, j + half
        same = np.ones(len(i), dtype=bool)
        for corner in corners:
            same &= self.sequence[corner] == self.sequence[middle]
            same &= (self.hops[corner] == self.hops[middle]) & (self.jams[corner] == self.jams[middle])
        mean = sum(self.values[:, a, b] for a, b in corners) / 4
        off = np.abs(mean - self.values[:, middle[0], middle[1]])
        return same & ((off <= shade[:, None]) | np.isnan(off)).all(axis=0)

    def fill(self, i: NDArray[np.int64], j: NDArray[np.int64], size: int) -> None:
        """Fill cells from their corners."""
        w = np.arange(size + 1) / size
        for a in range(size + 1):
            for b in range(size + 1):
                here = i + a, j + b
                free = ~self.computed[here]
                p, q = i[free], j[free]
                mix = (
                    (1 - w[a]) * ((1 - w[b]) * self.values[:, p, q] + w[b] * self.values[:, p, q + size])
                    + w[a] * ((1 - w[b]) * self.values[:, p + size, q] + w[b] * self.values[:, p + size, q + size])
                )  # fmt: skip
                self.values[:, p + a, q + b] = mix
                for kept in (self.sequence, self.hops, self.jams):
                    kept[p + a, q + b] = kept[p, q]


def refined(run: Run, count: int, shade: float, tell: Callable[[float], None] = lambda share: None) -> Map:
    """The map on a grid of ``count`` squares a side, a multiple of ``FIRST``.

    Parameters
    ----------
    run : callable
        First pulses at shares 0 to 1 of the way across and up, each (m,).
    count : int
    shade : float
        How far a value that is read between others may be off in their middle, where it is run to see it, as a share of
        the range of what was run first.
    tell : callable
        Told the share that is done.
    """
    sheet = Sheet(run, count, tell)
    i, j = (axis.ravel() for axis in np.mgrid[0 : count + 1 : FIRST, 0 : count + 1 : FIRST])
    sheet.look(i, j, (0.0, 0.03))
    first = sheet.values[:, i, j]
    ranges = np.array([np.ptp(row[np.isfinite(row)]) if np.isfinite(row).any() else 0.0 for row in first])
    i, j = (axis.ravel() for axis in np.mgrid[0:count:FIRST, 0:count:FIRST])
    size = FIRST
    while size > 1:
        half = size // 2
        progress = 0.5 * (1 - half / FIRST) + 0.03
        sheet.look(i + half, j + half, (progress - 0.25 * half / FIRST, progress))
        done = sheet.agree(i, j, size, shade * ranges)
        sheet.fill(i[done], j[done], size)
        i, j = i[~done], j[~done]
        i, j = np.concatenate([i, i, i + half, i + half]), np.concatenate([j, j + half, j, j + half])
        rows = np.concatenate([i, i, i + half, i + half])
        sheet.look(rows, np.concatenate([j, j + half, j, j + half]), (progress, progress + 0.02))
        size = half
    squares, runs = within(run, sheet.sequence, tell)
    return Map(sheet.sequence, sheet.values, sheet.hops > 0, sheet.jams, sheet.computed, squares, sheet.runs + runs)


def within(run: Run, sequence: NDArray[np.int64], tell: Callable[[float], None]) -> tuple[NDArray[np.int64], int]:
    """The sequences in the parts of every square, and how many hoops that took."""
    count = len(sequence) - 1
    corners = (sequence[:-1, :-1], sequence[:-1, 1:], sequence[1:, :-1], sequence[1:, 1:])
    squares = np.repeat(np.repeat(corners[0], WITHIN, axis=0), WITHIN, axis=1)
    i, j = np.nonzero(np.any([corner != corners[0] for corner in corners], axis=0))
    a, b = (axis.ravel() for axis in np.mgrid[0:WITHIN, 0:WITHIN])
    rows, columns = (WITHIN * i[:, None] + a).ravel(), (WITHIN * j[:, None] + b).ravel()
    for start in range(0, len(rows), PORTION):
        here = rows[start : start + PORTION], columns[start : start + PORTION]
        seen = run((here[1] + 0.5) / (WITHIN * count), (here[0] + 0.5) / (WITHIN * count))
        squares[here] = seen.sequence
        tell(0.55 + 0.45 * min(1.0, (start + PORTION) / len(rows)))
    return squares, len(rows)
