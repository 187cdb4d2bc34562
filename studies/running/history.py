"""A motion as columns over time, sampled where something happens."""

from __future__ import annotations

import csv
import dataclasses
import io
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rigid import Motion, Pulse, Scene, States
from rigid.output.sampling import share_taken
from rigid.output.units import units_of

Array = NDArray[np.float64]
Columns = dict[str, Array]


def through(motion: Motion, pulse: Pulse) -> Columns:
    """Time histories through one pulse: the solver's own steps where it kept them, else sampled finely enough
    to draw.

    Returns
    -------
    dict of (n,) arrays
        ``t``, ``phi``, ``normal_force``, ``friction_force``, ``slip_velocity`` and whatever else the solver
        has, and the impulses ``normal_impulse`` and ``friction_impulse`` accumulated since the pulse began.
    """
    own = own_steps(motion)
    if own is None:
        columns = at(motion, motion.times(pulse.t_start, pulse.t_end))
        if (impulses := getattr(motion.sample, "impulses", None)) is not None:  # exact, of a solver that has them
            normal, friction = impulses(pulse, columns["t"])
            return {**columns, "normal_impulse": normal, "friction_impulse": friction}
    else:
        columns = {name: _between(own["t"], values, pulse.t_start, pulse.t_end) for name, values in own.items()}
        if "friction_loss" in own:
            pace = np.abs(own["friction_force"] * own["slip_velocity"])
            columns["friction_loss"] = _between(own["t"], own["friction_loss"], pulse.t_start, pulse.t_end, pace)
        for name in getattr(getattr(motion, "history", None), "TOTALS", ()):
            columns[name] = columns[name] - columns[name][:1]
    for force, impulse in (("normal_force", "normal_impulse"), ("friction_force", "friction_impulse")):
        if not columns["t"].size:
            columns[impulse] = columns["t"].copy()
        elif impulse not in columns:
            columns[impulse] = accumulated(columns["t"], columns[force])
        else:  # what is off is the first point alone, which lies within a step
            columns[impulse][1:] += getattr(pulse, impulse) - columns[impulse][-1]
    return columns


def _between(t: Array, values: Array, start: float, end: float, pace: Array | None = None) -> Array:
    """Values at the times from start to end, and at both of these, which need not be steps: read in proportion to the
    time there, or at a ``pace`` that is known at the steps."""
    ends = np.array([max(start, t[0]), min(end, t[-1])])
    inside = values[(t > ends[0]) & (t < ends[1])]
    read = np.interp(ends, t, values)
    if pace is not None:
        i = np.clip(np.searchsorted(t, ends, "right") - 1, 0, t.size - 2)
        length = t[i + 1] - t[i]
        share = np.where(length > 0, (ends - t[i]) / np.where(length > 0, length, 1.0), 1.0)
        read = values[i] + share_taken(share, pace[i], pace[i + 1]) * (values[i + 1] - values[i])
    return np.concatenate([read[:1], inside, read[1:]])


def whole(motion: Motion) -> Columns:
    """Time histories of all of a motion, dense in its pulses."""
    own = own_steps(motion)
    if own is not None:
        return own
    return at(motion, motion.times())


def dimensionless(columns: Columns, scene: Scene) -> Columns:
    """Columns in the paper's scaling, whatever the units of the scene; angles and shares stay as they are."""
    units = units_of(Pulse) | units_of(States)
    if not columns.keys() <= units.keys():  # a rigid motion needs no solver that takes a second to load
        from flexible import History

        units |= units_of(History)
    return {name: values / units[name].of(scene) for name, values in columns.items()}


def own_steps(motion: Motion) -> Columns | None:
    """The steps a solver kept, as columns, or None."""
    steps = getattr(motion, "history", None)
    if steps is None:
        return None
    return {entry.name: np.asarray(getattr(steps, entry.name)) for entry in dataclasses.fields(steps)}


def at(motion: Motion, t: Array) -> Columns:
    """The motion's states at times ``t`` as columns."""
    states = motion.at(t)
    return {entry.name: np.asarray(getattr(states, entry.name)) for entry in dataclasses.fields(states)}


def accumulated(t: Array, values: Array) -> Array:
    """Integral from the first time to each (trapezoids)."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t))]) if t.size else t.copy()


def to_csv(columns: Columns) -> str:
    """Columns as text, numbers to the last bit."""
    return rows_to_csv(list(columns), zip(*(values.tolist() for values in columns.values()), strict=True))


def records_to_csv(records: Sequence[Mapping[str, object]]) -> str:
    """Records as text, each value below its own name; nothing where a record has none."""
    names = list(dict.fromkeys(name for record in records for name in record))
    return rows_to_csv(names, ([record.get(name, "") for name in names] for record in records)) if records else ""


def rows_to_csv(header: list[str], rows: Iterable[Iterable[object]]) -> str:
    """A table as text."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()
