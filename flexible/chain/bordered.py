"""A cyclic block-tridiagonal matrix with a border, in compiled code: the chain of sections, the frame, the floor.

Sections near the floor are *kept*, and so is the first one: with the frame and the rim they make a small dense system,
the core. All others are eliminated before, in runs from one kept section to the next, which border on the one at their
beginning as they border on the frame. It is the first section for all runs, unless the kept ones lie on both sides of
the weld and leave a single run.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import jit, loop, part

from ..contact.newton import FRAME
from ..contact.vectors import flagged, solved_by

Array = NDArray[np.float64]
WIDTH = 2 * FRAME  # of the border
FADED = 1e-60  # smaller than any product with it could matter, and far from numbers without all their digits


class Blocks(NamedTuple):
    """Newton's matrix; sections are counted from 0 to n + 1, of which both ends are held.

    Attributes
    ----------
    diagonal : (n + 2, 3, 3) array
    up, down : (n + 1, 3, 3) arrays
        Row i, column i + 1; and row i + 1, column i. Behind the last free section n comes the first.
    columns, rows : (n + 2, 3, 6) arrays
        Border: the frame, then a kept section (filled in by the elimination); that below lies on its side.
    corner : (6, 6) array
    """

    diagonal: Array
    up: Array
    down: Array
    columns: Array
    rows: Array
    corner: Array


class Factors(NamedTuple):
    """What is left of a matrix after the elimination.

    Attributes
    ----------
    order : (m, 2) int array
        Eliminated sections in turn, and the section that each is passed on to.
    inverse, ahead, beside, back : (m, 3, 3), (m, 3, 3), (m, 3, 6), (m, 3, 3) arrays
        Inverse of the pivot; it times the block ahead and times the border; the block back from there.
    rows : (n + 2, 3, 6) array
        Border below, of all sections.
    kept : (k,) int array
        Kept sections.
    far : int
        Place in ``kept`` of the one in the border.
    core : (3 + 3 k + r, 3 + 3 k + r) array
        Frame, kept sections, and whatever else the caller adds and eliminates.
    pivots : (3 + 3 k + r,) int array
        Where its rows came from.
    """

    order: Any
    inverse: Array
    ahead: Array
    beside: Array
    back: Array
    rows: Array
    kept: Any
    far: int
    core: Array
    pivots: Any


@jit
def no_blocks(sections: int) -> Any:
    """All zero, for this number of sections, ends included."""
    return Blocks(
        np.zeros((sections, 3, 3)), np.zeros((sections - 1, 3, 3)), np.zeros((sections - 1, 3, 3)),
        np.zeros((sections, 3, WIDTH)), np.zeros((sections, 3, WIDTH)), np.zeros((WIDTH, WIDTH)),
    )  # fmt: skip


@part
def nothing_factored() -> Any:
    """Factors of a matrix of no sections."""
    return Factors(
        np.empty((0, 2), np.int64), np.empty((0, 3, 3)), np.empty((0, 3, 3)), np.empty((0, 3, 6)),
        np.empty((0, 3, 3)), np.empty((0, 3, 6)), np.empty(0, np.int64), 0, np.empty((0, 0)), np.empty(0, np.int64),
    )  # fmt: skip


@loop
def _invert(matrix: Any, at: int, inverse: Any, to: int) -> None:
    """Inverse of a 3 x 3 block."""
    a, b, c = matrix[at, 0, 0], matrix[at, 0, 1], matrix[at, 0, 2]
    d, e, f = matrix[at, 1, 0], matrix[at, 1, 1], matrix[at, 1, 2]
    g, h, k = matrix[at, 2, 0], matrix[at, 2, 1], matrix[at, 2, 2]
    first, second, third = e * k - f * h, f * g - d * k, d * h - e * g
    scale = 1 / (a * first + b * second + c * third)
    inverse[to, 0, 0], inverse[to, 1, 0], inverse[to, 2, 0] = first * scale, second * scale, third * scale
    inverse[to, 0, 1], inverse[to, 0, 2] = (c * h - b * k) * scale, (b * f - c * e) * scale
    inverse[to, 1, 1], inverse[to, 1, 2] = (a * k - c * g) * scale, (c * d - a * f) * scale
    inverse[to, 2, 1], inverse[to, 2, 2] = (b * g - a * h) * scale, (a * e - b * d) * scale


@loop
def _fade(border: Any, below: Any) -> None:
    """Where a section feels nothing any more of the kept one that it borders on, make it none at all."""
    for a in range(3):
        for b in range(FRAME, WIDTH):
            if abs(border[a, b]) > FADED or abs(below[a, b]) > FADED:
                return
    for a in range(3):
        for b in range(FRAME, WIDTH):
            border[a, b] = below[a, b] = 0.0


@loop
def _eliminate(blocks: Any, i: int, here: int, there: int, factors: Any) -> None:
    """Eliminate one section: what it leaves for later, and what it adds to the next one and to the border.

    Loops over rows of a known length, from which compiled code takes several numbers at once.
    """
    inverse, ahead, beside, back = factors
    forth, at = (blocks.up, here) if there > here else (blocks.down, there)
    return_way = blocks.down if there > here else blocks.up
    border, below, corner = blocks.columns, blocks.rows, blocks.corner
    _invert(blocks.diagonal, here, inverse, i)
    if abs(border[here, 0, FRAME]) < FADED:
        _fade(border[here], below[here])
    for a in range(3):
        x, y, z = inverse[i, a, 0], inverse[i, a, 1], inverse[i, a, 2]
        for b in range(3):
            back[i, a, b] = return_way[at, a, b]
            ahead[i, a, b] = x * forth[at, 0, b] + y * forth[at, 1, b] + z * forth[at, 2, b]
        for b in range(WIDTH):
            beside[i, a, b] = x * border[here, 0, b] + y * border[here, 1, b] + z * border[here, 2, b]
    for a in range(3):
        x, y, z = back[i, a, 0], back[i, a, 1], back[i, a, 2]
        for b in range(3):
            blocks.diagonal[there, a, b] -= x * ahead[i, 0, b] + y * ahead[i, 1, b] + z * ahead[i, 2, b]
        for b in range(WIDTH):
            border[there, a, b] -= x * beside[i, 0, b] + y * beside[i, 1, b] + z * beside[i, 2, b]
    for a in range(3):
        x, y, z = ahead[i, 0, a], ahead[i, 1, a], ahead[i, 2, a]
        for b in range(WIDTH):
            below[there, a, b] -= x * below[here, 0, b] + y * below[here, 1, b] + z * below[here, 2, b]
    for a in range(WIDTH):
        x, y, z = below[here, 0, a], below[here, 1, a], below[here, 2, a]
        for b in range(WIDTH):
            corner[a, b] -= x * beside[i, 0, b] + y * beside[i, 1, b] + z * beside[i, 2, b]


@part
def _turns(keeps: Any) -> tuple[Any, int]:
    """Order of elimination, and the kept section that all runs begin at; section 1 must be kept."""
    n = keeps.shape[0] - 2
    order = np.empty((n, 2), np.int64)
    count, far, last = 0, 1, n
    while not keeps[last]:  # back from the last section, behind which comes the first
        order[count, 0], order[count, 1] = last, last - 1
        count, last = count + 1, last - 1
    for i in range(2, last):
        if not keeps[i]:
            if keeps[i - 1]:
                far = i - 1
            order[count, 0], order[count, 1] = i, i + 1
            count += 1
    return order[:count], far


@loop
def _border(blocks: Any, here: int, by: Any, of: Any, at: int) -> None:
    """A section borders on the kept one by these off-diagonal blocks: of its forces by that one, and the other way."""
    for a in range(3):
        for b in range(3):
            blocks.columns[here, a, FRAME + b] = by[at, a, b]
            blocks.rows[here, b, FRAME + a] = of[at, a, b]


@part
def _core(blocks: Any, kept: Any, place: int, size: int) -> Any:
    """Frame and kept sections, that at ``place`` among them in the border, in a matrix of ``size`` rows."""
    n = blocks.diagonal.shape[0] - 2
    core = np.zeros((size, size))
    diagonal, up, down = blocks.diagonal, blocks.up, blocks.down
    columns, rows, corner = blocks.columns, blocks.rows, blocks.corner
    f = FRAME + 3 * place
    for a in range(3):
        for b in range(3):
            core[a, b] += corner[a, b]
            core[a, f + b] += corner[a, FRAME + b]
            core[f + a, b] += corner[FRAME + a, b]
            core[f + a, f + b] += corner[FRAME + a, FRAME + b]
            for k in range(kept.shape[0]):
                i, at = kept[k], FRAME + 3 * k
                core[at + a, at + b] += diagonal[i, a, b]
                core[at + a, b] += columns[i, a, b]
                core[a, at + b] += rows[i, b, a]
                core[at + a, f + b] += columns[i, a, FRAME + b]
                core[f + a, at + b] += rows[i, b, FRAME + a]
                if k > 0 and kept[k - 1] == i - 1:
                    core[at + a, at - 3 + b] += down[i - 1, a, b]
                    core[at - 3 + a, at + b] += up[i - 1, a, b]
                if i == n:
                    core[at + a, FRAME + b] += up[n, a, b]
                    core[FRAME + a, at + b] += down[n, a, b]
    return core


@loop
def _forward(blocks: Any, order: Any, far: int, factors: Any) -> None:
    """Eliminate all sections in their order."""
    n = blocks.diagonal.shape[0] - 2
    for i in range(order.shape[0]):
        here, there = order[i, 0], order[i, 1]
        if there > here and here == far + 1:
            _border(blocks, here, blocks.down, blocks.up, far)
        elif here == n:
            _border(blocks, here, blocks.up, blocks.down, n)
        _eliminate(blocks, i, here, there, factors)


@part
def factor(blocks: Any, keeps: Any, rest: int) -> Any:
    """Eliminate all sections but those flagged, and the blocks with them; ``rest`` unknowns are left to the caller."""
    order, far = _turns(keeps)
    m = order.shape[0]
    inverse, ahead, back = np.empty((m, 3, 3)), np.empty((m, 3, 3)), np.empty((m, 3, 3))
    beside = np.empty((m, 3, WIDTH))
    _forward(blocks, order, far, (inverse, ahead, beside, back))
    kept = flagged(keeps)
    place = keeps[:far].sum()
    core = _core(blocks, kept, place, FRAME + 3 * kept.shape[0] + rest)
    pivots = np.empty(core.shape[0], np.int64)
    return Factors(order, inverse, ahead, beside, back, blocks.rows, kept, place, core, pivots)


@part
def as_one(frame: Any, sections: Any) -> Any:
    """One vector of what belongs to the frame, first in its own, and to the sections but those of the weld."""
    vector = np.empty(FRAME + 3 * (sections.shape[0] - 2))
    for a in range(FRAME):
        vector[a] = frame[a]
        for i in range(1, sections.shape[0] - 1):
            vector[3 * i + a] = sections[i, a]
    return vector


@part
def solve(factors: Any, frame: Any, sections: Any, rest: Any) -> tuple[Any, Any]:
    """Solve for one right-hand side: frame (3,), sections (n + 2, 3), rest (r,); the solution as (3 + 3 n,) and (r,).

    The core must be eliminated; where it is singular, the solution is not finite.
    """
    order, inverse, ahead, beside, back, below, kept, far, core, pivots = factors
    size, m = core.shape[0], order.shape[0]
    border, right = np.zeros(WIDTH), sections.copy()
    for i in range(m):
        here, there = order[i, 0], order[i, 1]
        for a in range(3):
            pivot = inverse[i, a, 0] * right[here, 0] + inverse[i, a, 1] * right[here, 1]
            pivot += inverse[i, a, 2] * right[here, 2]
            for b in range(3):
                right[there, b] -= back[i, b, a] * pivot
            for b in range(WIDTH):
                border[b] -= below[here, a, b] * pivot
    known, after = np.zeros(size), FRAME + 3 * kept.shape[0]
    for a in range(FRAME):
        known[a] = frame[a] + border[a]
    for k in range(kept.shape[0]):
        for a in range(3):
            known[FRAME + 3 * k + a] = right[kept[k], a]
            if k == far:
                known[FRAME + 3 * k + a] += border[FRAME + a]
    for a in range(rest.shape[0]):
        known[after + a] = rest[a]
    found, x = solved_by((core, pivots), known), np.zeros(right.shape)
    for k in range(kept.shape[0]):
        for a in range(3):
            x[kept[k], a] = found[FRAME + 3 * k + a]
    for a in range(3):
        border[a], border[FRAME + a] = found[a], x[kept[far], a]
    for j in range(m):
        i = m - 1 - j
        here, there = order[i, 0], order[i, 1]
        for a in range(3):
            value = 0.0
            for b in range(3):
                value += inverse[i, a, b] * right[here, b] - ahead[i, a, b] * x[there, b]
            for b in range(WIDTH):
                value -= beside[i, a, b] * border[b]
            x[here, a] = value
    return as_one(found, x), found[after:].copy()
