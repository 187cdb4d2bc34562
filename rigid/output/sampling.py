"""Where to sample a motion: dense where something happens."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, floor, pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Curve = Callable[[Array], Array]


def bottom(phi: Curve, start: float, end: float) -> float:
    """Time from ``start`` to ``end`` at which ``phi``, monotonic there, is pi (mod 2 pi); the middle if it never is."""
    ends = phi(np.array([start, end]))
    low, high = ends.min(), ends.max()
    turns = [n for n in range(floor(low / (2 * pi)) - 1, ceil(high / (2 * pi)) + 1) if low <= pi + 2 * pi * n <= high]
    early, late = start, end
    if not turns:
        return 0.5 * (early + late)
    target = pi + 2 * pi * turns[0]
    rising = ends[1] > ends[0]
    for _ in range(4):  # 129 points at once, four times, is 1e-8 of the length
        grid = np.linspace(early, late, 129)
        passed = (phi(grid) >= target) == rising
        index = int(np.argmax(passed)) if passed.any() else grid.size - 1
        early, late = float(grid[max(index - 1, 0)]), float(grid[index])
    return 0.5 * (early + late)


def share_taken(share: Array, first: Array, last: Array) -> Array:
    """What part of all that a step takes is taken in a share (n,) of its time, at a pace that goes evenly from
    ``first`` to ``last``, both at least 0; where both are, at an even one.
    """
    mean = (first + last) / 2
    return np.where(mean > 0, share * (first + (mean - first) * share) / np.where(mean > 0, mean, 1.0), share)


MANY = 200
"""Pulses from which on the middle of each is taken for its lowest point, which takes long to find."""


def instants(motion: Any, start: float, end: float) -> Array:
    """Times at which to sample a motion; see :meth:`rigid.Motion.times`."""
    inside = [pulse for pulse in motion.pulses if pulse.t_end >= start and pulse.t_start <= end]
    if len(inside) > MANY:
        lowest = [(pulse.t_start + pulse.t_end) / 2 for pulse in inside]
    else:
        lowest = [bottom(lambda t: motion.at(t).phi, pulse.t_start, pulse.t_end) for pulse in inside]
    edges = [phase.t_end for phase in motion.phases]
    return times(lambda t: forces_of(motion.at(t)), (start, end), lowest, edges, steps_of(motion.sample))


def steps_of(sample: Any) -> Array:
    """Instants between which a solver that marches knows no more than a line, (n,) and ascending; twice where values
    jump. None of a solver that does not say any."""
    return np.asarray(getattr(sample, "step_times", ()), dtype=float)


def forces_of(states: Any) -> Array:
    """N and F at n instants, (2, n)."""
    return np.vstack([states.normal_force, states.friction_force])


def times(
    forces: Curve,
    span: tuple[float, float],
    bottoms: Sequence[float] = (),
    edges: ArrayLike = (),
    steps: ArrayLike = (),
    *,
    tolerance: float = 2e-3,
    limit: int = 20_000,
) -> Array:
    """Times over a span between which forces are straight to ``tolerance`` of their range, as far as ``limit`` allows.

    The first grid crowds geometrically on ``bottoms``: the spike of a small disk there is k^2 wide, and bisection alone
    would step over it. Both sides of every one of ``edges``, where forces jump, are among the times, and all ``steps``
    of a march, both sides of those that are there twice.

    Parameters
    ----------
    forces : callable
        Times (n,) to forces (m, n).
    span : (float, float)
    bottoms, edges, steps : sequence of float
    tolerance : float
    limit : int
        Of the number of times beside the steps, about.

    Raises
    ------
    ValueError
        A span that ends before it starts.
    """
    start, end = span
    if not start <= end:
        raise ValueError(f"Times from {start:g} to {end:g} are not possible: they run upward.")
    length = end - start
    if length == 0:
        return np.array([start], dtype=float)
    crowd = length * np.logspace(-9, 0, min(46, limit // (2 * max(len(bottoms), 1))))
    grid = [np.linspace(start, end, 129)]
    grid += [side for middle in bottoms for side in (np.array([middle]), middle - crowd, middle + crowd)]
    nearest = 1e-12 * max(abs(start), abs(end))
    apart = 32 * np.spacing(max(abs(start), abs(end)))  # below, values are of other times than they are asked for
    jumps = np.asarray(edges, dtype=float)
    known = np.asarray(steps, dtype=float)
    known = known[(known >= start) & (known <= end)]
    grid += [jumps - nearest, jumps + nearest, known, known[1:][np.diff(known) <= nearest] - nearest]
    distinct = np.unique(known)  # two jumps so close that the near side of the second would lie before the first
    grid += [np.nextafter(distinct[1:][np.diff(distinct) <= nearest], -np.inf)]
    limit += known.size
    t = np.unique(np.clip(np.concatenate(grid), start, end))
    values = forces(t)
    fresh = np.ones(t.size - 1, dtype=bool)
    while fresh.any() and t.size < limit:
        where = np.flatnonzero(fresh & (np.diff(t) > apart))
        middle = 0.5 * (t[where] + t[where + 1])
        found = forces(middle)
        scale = np.ptp(values, axis=1, keepdims=True) + 1e-300
        bent = (np.abs(found - 0.5 * (values[:, where] + values[:, where + 1])) > tolerance * scale).any(axis=0)
        if not bent.any():
            break
        where, middle, found = where[bent], middle[bent], found[:, bent]
        t, values = np.insert(t, where + 1, middle), np.insert(values, where + 1, found, axis=1)
        fresh = np.zeros(t.size - 1, dtype=bool)
        halves = where + np.arange(where.size)
        fresh[halves] = fresh[halves + 1] = True
    return t
