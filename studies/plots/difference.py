"""How far curves through a pulse are from a motion, where both are at the same place."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid import Motion, Pulse

from ..running.history import Columns

Array = NDArray[np.float64]

FORCES = ("normal_force", "friction_force", "slip_velocity")
"""What is compared where the disk is at the same angle."""

_FINER = 32  # its square is by how much finer
_NEWTON = 4  # from a guess that is good to a sampling interval each step squares what is left
_LAST = 1e-9  # radians; what is left behind a step of so much is round-off


class Passage(NamedTuple):
    """A pulse of a motion at times between which its forces are straight."""

    motion: Motion
    t: Array
    phi: Array


def passage_of(motion: Motion, pulse: Pulse) -> Passage:
    """A pulse with which others are compared."""
    t = motion.times(pulse.t_start, pulse.t_end)
    return Passage(motion, t, motion.at(t).phi)


def at_the_same_angle(columns: Columns, passage: Passage) -> Columns:
    """Forces and slip velocity minus those of a motion where its disk is at the same angle.

    Not at the same time: two clocks that are apart by little would make the steep flanks of a pulse differ by much.

    Parameters
    ----------
    columns : dict of (n,) arrays
        Through a pulse, in the units of the motion, with ``phi``.
    passage : Passage
        What is compared with.

    Returns
    -------
    dict of (n,) arrays
        NaN at angles that the pulse does not have and at both ends, and all of it where phi turns back within the
        pulse.
    """
    motion, t, phi = passage
    way = np.sign(phi[-1] - phi[0])
    if not np.all(way * np.diff(phi) >= 0) or way == 0:
        return {name: np.full(columns["phi"].size, np.nan) for name in FORCES}
    asked = columns["phi"]
    outside = (way * asked < way * phi[0]) | (way * asked > way * phi[-1])
    outside[[0, -1]] = True  # a pulse begins and ends between two steps of a solver: these are interpolated
    when = np.interp(way * asked, way * phi, t)
    states = motion.at(when)
    for _ in range(_NEWTON):
        away = np.where(outside, 0.0, states.phi - asked)
        when = np.clip(when - away / np.where(states.omega == 0, np.inf, states.omega), t[0], t[-1])
        states = motion.at(when)
        if np.max(np.abs(away)) <= _LAST:
            break
    return {name: np.where(outside, np.nan, columns[name] - getattr(states, name)) for name in FORCES}


def impulses_along(motion: Motion, pulse: Pulse) -> tuple[Array, Array]:
    """Normal and friction impulse of a rigid motion through a pulse of it, (n,) each, from the pulse's start."""
    t = motion.times(pulse.t_start, pulse.t_end)
    # J_F over J_N is to be straight between them, to a thousandth of the 2e-3 to which N and F are straight
    fine = np.append((t[:-1, None] + np.diff(t)[:, None] * np.arange(_FINER) / _FINER).ravel(), t[-1])
    sample: Any = motion.sample
    found: tuple[Array, Array] = sample.impulses(pulse, fine)
    return found


def at_the_same_normal_impulse(columns: Columns, along: tuple[Array, Array]) -> Array:
    """Friction impulse minus that of a motion, given by :func:`impulses_along`, behind as much normal impulse.

    Returns
    -------
    (n,) array
        NaN where the normal impulse is more than all of the pulse's.
    """
    normal, friction = along
    x, y = columns["normal_impulse"], columns["friction_impulse"]
    return np.where(x <= normal[-1], y - np.interp(x, normal, friction), np.nan)
