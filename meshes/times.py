"""Which instants of a run become frames."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def frame_times(
    start: float,
    stop: float,
    count: int,
    t: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    share: float = 0.5,
) -> Array:
    """``count`` ascending times from ``start`` to ``stop``, denser where the normal force changes.

    Parameters
    ----------
    t, normal_force : array_like, optional
        The force over the run, t ascending, twice the same where the force jumps: half of a jump is followed before
        and half behind it. Without it the times are evenly spaced.
    share : float
        Share of the frames that follows the force, 0 (evenly spaced) to below 1; the rest is evenly spaced,
        so that no stretch of time goes without.

    Raises
    ------
    ValueError
        No whole number of frames from 2 on, no stretch of time or one without end, a share outside [0, 1), or a force
        that is no curve.
    """
    if not (count >= 2 and count % 1 == 0 and -inf < start < stop < inf and 0 <= share < 1):
        raise ValueError(f"{count} frames from {start} to {stop} with a share of {share} cannot be chosen.")
    count = int(count)
    even = np.linspace(start, stop, count)
    if (t is None) != (normal_force is None):
        raise ValueError("frames cannot be chosen: a force and its times are given together.")
    if t is None or not np.size(t):
        return even
    at, force = np.asarray(t, dtype=float), np.asarray(normal_force, dtype=float)
    if at.shape != force.shape or at.ndim != 1 or np.any(np.diff(at) < 0) or not np.all(np.isfinite([at, force])):
        raise ValueError("frames cannot be chosen: t must ascend, with a finite normal_force for each.")
    inside = (at > start) & (at < stop)
    times = np.concatenate([[start], at[inside], [stop]])
    last = np.interp(-stop, -at[::-1], force[::-1])  # before a jump there, as the first is behind one at the start
    change = np.abs(np.diff([np.interp(start, at, force), *force[inside], last]))
    if not change.sum() > 0:
        return even
    wide, jumps = np.flatnonzero(np.diff(times)), np.flatnonzero(np.diff(times) == 0)
    behind = np.searchsorted(wide, jumps)
    for neighbours in (wide[behind - 1], wide[behind]):
        np.add.at(change, neighbours, change[jumps] / 2)
    times, change = np.append(times[wide], stop), change[wide]
    density = (1 - share) * np.diff(times) / (stop - start) + share * change / change.sum()
    passed = np.concatenate([[0.0], np.cumsum(density)])
    chosen = np.interp(np.linspace(0, passed[-1], count), passed, times)
    chosen[[0, -1]] = start, stop
    return chosen
