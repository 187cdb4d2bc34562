"""States of a motion as a table, and the pulses of many scenes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .axes import columns_of

if TYPE_CHECKING:
    import pandas


def states_of(motion: Any, t: ArrayLike | None) -> pandas.DataFrame:
    """A row for each instant, with the kind of phase; see :meth:`rigid.Motion.to_dataframe`."""
    import pandas

    times = motion.times() if t is None else np.atleast_1d(motion._inside(t, "right"))
    if times.ndim != 1:
        raise ValueError(f"t of shape {times.shape} is not possible: times must be one-dimensional.")
    columns = columns_of(motion.at(times))
    frame = pandas.DataFrame(columns)
    starts = [phase.t_start for phase in motion.phases]
    kinds = np.array([str(phase.kind) for phase in motion.phases], dtype=object)
    frame["phase"] = kinds[np.maximum(np.searchsorted(starts, frame["t"], "right") - 1, 0)]
    units = motion.units
    frame.attrs["units"] = {name: units[name] for name in columns}
    return frame


def pulses_of_scenes(
    of_pulses: Mapping[str, NDArray[np.float64]], of_scenes: Mapping[str, Sequence[object]]
) -> pandas.DataFrame:
    """A row for each pulse of each scene, indexed by both from arrays (n, pulses) and (n,).

    A pulse is there where ``t_start`` is a number; a scene without one has one row, of pulse 0, whose measures are NaN.
    """
    import pandas

    there = ~np.isnan(of_pulses["t_start"])
    without = ~there.any(axis=1)
    scene, pulse = np.nonzero(there)
    scene, pulse = np.append(scene, np.flatnonzero(without)), np.append(pulse, np.full(without.sum(), -1))
    order = np.lexsort((pulse, scene))
    scene, pulse = scene[order], pulse[order]
    nothing = np.full((len(there), 1), np.nan)  # which the pulse -1 is
    table = {name: np.append(column, nothing, axis=1)[scene, pulse] for name, column in of_pulses.items()}
    told = {name: np.asarray(column)[scene] for name, column in of_scenes.items()}
    index = pandas.MultiIndex.from_arrays([scene, pulse + 1], names=["scene", "pulse"])
    return pandas.DataFrame(table | told, index=index)
