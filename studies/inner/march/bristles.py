"""The tangential side of the scaled patch: bristles between rim and floor, in material coordinates.

A rim point that stands at s now has the label xi = s - Phi, Phi the angle rolled since the bristles were set, so that
points enter the patch at xi = -A - Phi and leave it at A - Phi. With X the way that the patch as a whole has slipped,
the stretch of a bristle is what X has gained since its point touched:

    z(s, tau) = X(tau) - X_in(xi),     z_tau + Omega z_s = V.

``patch``: X_in is a table over xi that grows where points enter and is cut where they leave; the pull of all bristles
is -kappa (2 A X - the integral of X_in over the patch), one look-up at each edge. ``brush``: every point of a grid in
xi carries its own stretch, held to mu_s p or, once it slides, to mu p.
"""

from __future__ import annotations

from collections import namedtuple
from math import ceil, floor
from typing import Any

import numpy as np

from rigid.kernel.compile import part

SIZE = 8192  # entries of the circular tables
ENTRIES = 1000  # of a patch's table, from edge to edge
SLIPPED, TRAILING, LEADING = range(3)  # positions in ``edges``

Bristles = namedtuple("Bristles", ["label", "way", "area", "sliding", "ends", "edges", "spacing"])
Bristles.__doc__ = """Circular tables (entry n stands at n modulo SIZE) and where they begin and end.

``patch``: labels descending from the trailing to the leading edge, X_in there, and its integral from the trailing edge
on; ``ends`` are the first and last entry. ``brush``: point n has the label n ``spacing``, ``way`` is its stretch,
``sliding`` the direction in which friction pushes it if it slides; ``ends`` are the lowest and highest point.
``edges``: X, and the labels of both edges, at the end of the last step (``brush``).
"""


def bristles(spacing: float = 1.0) -> Any:
    """Empty tables; ``spacing`` is that of a brush's points."""
    label, way, area = np.zeros((3, SIZE))
    return Bristles(label, way, area, np.zeros(SIZE, np.int8), np.zeros(2, np.int64), np.zeros(3), spacing)


@part
def set_stretch(kept: Any, half: float, curve: Any, brush: bool) -> None:
    """Begin anew with X = Phi = 0 and z = c_0 + c_1 s + c_2 s^2 over the patch of half-width ``half``."""
    if brush:
        low, high = int(ceil(-half / kept.spacing)), int(floor(half / kept.spacing))
        for j in range(low, high + 1):
            s = j * kept.spacing
            kept.way[j % SIZE] = curve[0] + s * (curve[1] + s * curve[2])
            kept.sliding[j % SIZE] = 0
        kept.ends[0], kept.ends[1] = low, high
    else:
        for n in range(ENTRIES + 1):
            s = half * (1 - 2 * n / ENTRIES)
            kept.label[n] = s
            kept.way[n] = -curve[0] - s * (curve[1] + s * curve[2])
            gone = half - s
            total = (
                curve[0] * gone + curve[1] * (half * half - s * s) / 2 + curve[2] * (half * half * half - s * s * s) / 3
            )
            kept.area[n] = -total
        kept.ends[0], kept.ends[1] = 0, ENTRIES
    kept.edges[SLIPPED], kept.edges[TRAILING], kept.edges[LEADING] = 0.0, half, -half


@part
def _look_up(kept: Any, xi: float, slipped: float) -> tuple[float, float]:
    """X_in at a label and its integral from the table's trailing end to there; beyond the table points enter now."""
    first, last = kept.ends[0], kept.ends[1]
    if xi <= kept.label[last % SIZE]:
        step = kept.label[last % SIZE] - xi
        return slipped, kept.area[last % SIZE] + step * (kept.way[last % SIZE] + slipped) / 2
    if xi >= kept.label[first % SIZE]:
        step = kept.label[first % SIZE] - xi
        return slipped, kept.area[first % SIZE] + step * (kept.way[first % SIZE] + slipped) / 2
    low, high = first, last
    while high - low > 1:
        middle = (low + high) // 2
        if kept.label[middle % SIZE] >= xi:
            low = middle
        else:
            high = middle
    x, y = kept.label[low % SIZE], kept.label[high % SIZE]
    part = (x - xi) / (x - y)
    way = kept.way[low % SIZE] + part * (kept.way[high % SIZE] - kept.way[low % SIZE])
    return way, kept.area[low % SIZE] + (x - xi) * (kept.way[low % SIZE] + way) / 2


@part
def total_stretch(kept: Any, half: float, rolled: float, slipped: float) -> float:
    """Integral of z over the patch (``patch``)."""
    _, ahead = _look_up(kept, -half - rolled, slipped)
    _, behind = _look_up(kept, half - rolled, slipped)
    return 2 * half * slipped - (ahead - behind)


@part
def step_on(kept: Any, half: float, rolled: float, slipped: float) -> None:
    """Take the patch's new edges into the table: points have entered, or left, at either (``patch``)."""
    ahead, behind = -half - rolled, half - rolled
    way_ahead, area_ahead = _look_up(kept, ahead, slipped)
    way_behind, area_behind = _look_up(kept, behind, slipped)
    first, last = kept.ends[0], kept.ends[1]
    spacing = 2 * half / ENTRIES
    entered = ahead <= kept.label[last % SIZE]
    if entered and kept.label[(last - 1) % SIZE] - kept.label[last % SIZE] >= spacing:
        last += 1
    while not entered and last > first + 1 and kept.label[(last - 1) % SIZE] <= ahead:
        last -= 1
    grown = behind >= kept.label[first % SIZE]
    if grown and kept.label[first % SIZE] - kept.label[(first + 1) % SIZE] >= spacing:
        first -= 1
    while not grown and last > first + 1 and kept.label[(first + 1) % SIZE] >= behind:
        first += 1
    for n, xi, way, area in ((first, behind, way_behind, area_behind), (last, ahead, way_ahead, area_ahead)):
        kept.label[n % SIZE], kept.way[n % SIZE], kept.area[n % SIZE] = xi, way, area
    kept.ends[0], kept.ends[1] = first, last


@part
def brush_pull(
    kept: Any, contact: Any, half: float, rolled: float, slipped: float, eta: float, commit: bool
) -> tuple[float, float]:
    """Pull of the brush's bristles, and the part of the patch that sticks; ``commit`` makes the step a step taken.

    The traction is held to ``eta`` times the pressure (A^2 - s^2)/2 times mu_s, or mu where a point slides. The sum
    over the points is scaled by what the same sum makes of the pressure, so that gross slip has exactly mu N.
    """
    gap, kappa = kept.spacing, contact.kappa
    low, high = int(ceil((-half - rolled) / gap)), int(floor((half - rolled) / gap))
    old_low, old_high = kept.ends[0], kept.ends[1]
    behind_slides, ahead_slides = kept.sliding[old_high % SIZE], kept.sliding[old_low % SIZE]
    gained = slipped - kept.edges[SLIPPED]
    pull, carried, stuck = 0.0, 0.0, 0
    for j in range(low, high + 1):
        xi = j * gap
        s = xi + rolled
        pressure = (half * half - s * s) / 2
        if old_low <= j <= old_high:
            stretch, slides = kept.way[j % SIZE] + gained, kept.sliding[j % SIZE]
        elif j < old_low:
            stretch, slides = gained * (xi + half + rolled) / (kept.edges[LEADING] + half + rolled), ahead_slides
        else:
            stretch, slides = gained * (half - rolled - xi) / (half - rolled - kept.edges[TRAILING]), behind_slides
        limit = (contact.mu if slides != 0 else contact.mu_s) * eta * pressure
        if abs(kappa * stretch) > limit:
            slides = 1 if stretch < 0 else -1
            traction = slides * contact.mu * eta * pressure
            stretch = -traction / kappa
        else:
            slides = 0
            traction = -kappa * stretch
            stuck += 1
        pull += traction
        carried += pressure
        if commit:
            kept.way[j % SIZE], kept.sliding[j % SIZE] = stretch, slides
    if commit:
        kept.ends[0], kept.ends[1] = low, high
        kept.edges[SLIPPED], kept.edges[TRAILING], kept.edges[LEADING] = slipped, half - rolled, -half - rolled
    if carried == 0:
        return 0.0, 0.0
    return pull * (2 / 3) * half**3 / carried, stuck / (high - low + 1)


@part
def sliding_share(kept: Any, half: float, rolled: float) -> float:
    """Share of the pressure that is on points which slid in the last step taken, to the right less to the left."""
    share, whole = 0.0, 0.0
    for j in range(kept.ends[0], kept.ends[1] + 1):
        s = j * kept.spacing + rolled
        pressure = max(half * half - s * s, 0.0)
        share += kept.sliding[j % SIZE] * pressure
        whole += pressure
    return share / whole if whole > 0 else 0.0


@part
def way_of_sliding(kept: Any) -> int:
    """1 or -1 where a brush slid throughout in the last step taken, to the right or to the left; 0 where it stuck.

    A bristle that slides stands just where it would stick: the next step alone says which.
    """
    total = 0
    for j in range(kept.ends[0], kept.ends[1] + 1):
        if kept.sliding[j % SIZE] == 0:
            return 0
        total += 1 if kept.sliding[j % SIZE] > 0 else -1
    return 1 if total > 0 else -1
