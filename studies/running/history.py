"""A motion as columns over time, sampled where something happens."""

from __future__ import annotations

import csv
import dataclasses
import io
from collections.abc import Iterable
from math import ceil, floor, pi

import numpy as np
from numpy.typing import NDArray

from rigid import Motion, Pulse, Scene

Array = NDArray[np.float64]
Columns = dict[str, Array]

ENERGIES = (
    "energy",
    "kinetic",
    "gravity",
    "ring_strain",
    "contact_spring",
    "friction_loss",
    "damping_loss",
    "numerical_loss",
)
"""Columns that are energies."""

TOTALS = ("normal_impulse", "friction_impulse", "friction_loss", "damping_loss", "numerical_loss")
"""Columns that a solver gathers from its start; through a pulse they count from the pulse's start."""


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
        columns = at(motion, times(motion, pulse.t_start, pulse.t_end, bottom(motion, pulse)))
    else:
        kept = (own["t"] >= pulse.t_start) & (own["t"] <= pulse.t_end)
        columns = {name: values[kept] for name, values in own.items()}
    for name in TOTALS:
        if name in columns and columns[name].size:
            columns[name] = columns[name] - columns[name][0]
    for force, impulse in (("normal_force", "normal_impulse"), ("friction_force", "friction_impulse")):
        if impulse not in columns:
            columns[impulse] = accumulated(columns["t"], columns[force])
    return columns


def whole(motion: Motion) -> Columns:
    """Time histories of all of a motion, dense in its pulses."""
    own = own_steps(motion)
    if own is not None:
        return own
    return at(motion, times(motion, 0.0, motion.t_end, *(bottom(motion, pulse) for pulse in motion.pulses)))


def dimensionless(columns: Columns, scene: Scene) -> Columns:
    """Columns in the paper's scaling, whatever the units of the scene; angles and shares stay as they are."""
    units = {
        "t": scene.time_unit,
        "omega": 1 / scene.time_unit,
        "alpha": 1 / scene.time_unit**2,
        "normal_impulse": scene.impulse_unit,
        "friction_impulse": scene.impulse_unit,
        **dict.fromkeys(("x_C", "y_C", "patch_length"), scene.hoop.R),
        **dict.fromkeys(("slip_velocity", "approach_velocity"), scene.velocity_unit),
        **dict.fromkeys(("normal_force", "friction_force"), scene.force_unit),
        **dict.fromkeys(ENERGIES, scene.energy_unit),
    }
    return {name: values / units.get(name, 1.0) for name, values in columns.items()}


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


def bottom(motion: Motion, pulse: Pulse) -> float:
    """Time in a pulse at which the disk is lowest, phi = pi (mod 2 pi), or the pulse's middle if it never
    is."""
    low, high = sorted((pulse.phi_start, pulse.phi_end))
    turns = [n for n in range(floor(low / (2 * pi)) - 1, ceil(high / (2 * pi)) + 1) if low <= pi + 2 * pi * n <= high]
    early, late = pulse.t_start, pulse.t_end
    if not turns:
        return 0.5 * (early + late)
    target = pi + 2 * pi * turns[0]
    rising = pulse.phi_end > pulse.phi_start
    for _ in range(4):  # phi is monotonic in a pulse; 129 points at once, four times, is 1e-8 of its length
        grid = np.linspace(early, late, 129)
        passed = (motion.at(grid).phi >= target) == rising
        index = int(np.argmax(passed)) if passed.any() else grid.size - 1
        early, late = float(grid[max(index - 1, 0)]), float(grid[index])
    return 0.5 * (early + late)


def times(
    motion: Motion, start: float, end: float, *bottoms: float, tolerance: float = 2e-3, limit: int = 20_000
) -> Array:
    """Times from ``start`` to ``end`` between which N and F are straight to ``tolerance`` of their range.

    The first grid crowds geometrically on ``bottoms``: the spike of a small disk there is k^2 wide, and
    bisection alone would step over it. Both sides of every change of phase are among the times.
    """
    length = end - start
    if length <= 0:
        return np.array([start])
    crowd = length * np.logspace(-9, 0, 46)
    grid = [np.linspace(start, end, 129)]
    grid += [side for middle in bottoms for side in (np.array([middle]), middle - crowd, middle + crowd)]
    edges = np.array([phase.t_end for phase in motion.phases])
    nearest = 1e-12 * max(1.0, abs(end))
    grid += [edges - nearest, edges + nearest]
    t = np.unique(np.clip(np.concatenate(grid), start, end))
    values = _forces(motion, t)
    fresh = np.ones(t.size - 1, dtype=bool)
    while fresh.any() and t.size < limit:
        where = np.flatnonzero(fresh & (np.diff(t) > 4 * nearest))
        middle = 0.5 * (t[where] + t[where + 1])
        found = _forces(motion, middle)
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


def _forces(motion: Motion, t: Array) -> Array:
    states = motion.at(t)
    return np.vstack([states.normal_force, states.friction_force])


def to_csv(columns: Columns) -> str:
    """Columns as text, numbers to the last bit."""
    return rows_to_csv(list(columns), zip(*(values.tolist() for values in columns.values()), strict=True))


def rows_to_csv(header: list[str], rows: Iterable[Iterable[object]]) -> str:
    """A table as text."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()
