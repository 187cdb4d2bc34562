"""The curves of a panel as numbers: a motion sampled densely where it changes, with both sides of every jump."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import cache
from math import asinh, ceil, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from rigid import Motion, States, load_scene, simulate

from .panels import QUANTITIES, TURNS, Array, Curve, Figure, Panel, Part

EVEN = 240  # intervals of a whole panel, as wide as its pixels can show
LEAST_INTERVALS = 24  # intervals of a phase however short
STEP = 0.025  # of the argument of sinh: a pulse's peak is off by no more than its square over 8


@dataclass(frozen=True)
class Samples:
    """A part of a motion in the order of time; where phases meet there are two states of one time."""

    states: States
    phase: NDArray[np.str_]


@dataclass(frozen=True)
class Line:
    """A curve's points in a panel, and the phase that each belongs to."""

    curve: Curve
    t: Array
    x: Array
    y: Array
    phase: NDArray[np.str_]


@cache
def motion_of(name: str, turns: int = 1) -> Motion:
    """A shipped scene as far as a number of turns."""
    return simulate(load_scene(name).replace(run={"turns": turns}))


def passes(motion: Motion, phi: float, early: float, late: float) -> float:
    """When phi, in one rotation from ``early`` to ``late``, passes a value: Newton kept in its bracket."""
    rising = bool(motion.at(late).phi > motion.at(early).phi)
    t = 0.5 * (early + late)
    while True:
        now = motion.at(t)
        error, rate = float(now.phi) - phi, float(now.omega)
        early, late = (early, t) if (error > 0) == rising else (t, late)
        new = t - error / rate if rate != 0 else early
        if not early < new < late:
            new = 0.5 * (early + late)
        if error == 0 or abs(new - t) <= 2.3e-16 * abs(t):
            return t
        t = new


@cache
def bottoms(motion: Motion) -> tuple[float, ...]:
    """When the disk is lowest in each of its pulses from rest, phi = pi."""
    return tuple(passes(motion, pi, pulse.t_start, pulse.t_end) for pulse in motion.pulses)


def span(motion: Motion, panel: Panel) -> tuple[float, float]:
    """First and last time of a panel."""
    if panel.part is Part.FIRST_PULSE:
        return motion.pulses[0].t_start, motion.pulses[0].t_end
    end = motion.turns[TURNS[panel.part] - 1].t
    if panel.part is Part.NEAR_BOTTOM:
        middle = bottoms(motion)[0]
        return passes(motion, pi - panel.reach, 0.0, middle), passes(motion, pi + panel.reach, middle, end)
    return 0.0, end


def instants(motion: Motion, start: float, end: float) -> Array:
    """Times from ``start`` to ``end``: even ones, in all and in each phase, and around each bottom t_0 those of
    t_0 + w sinh(u) with u even.

    The forces of a small disk are functions of zeta + 2 (1 + cos phi), so w = sqrt(zeta)/phidot is the time that its
    pulse takes, and on either side of it everything changes in proportion to t - t_0.
    """
    times = [np.linspace(start, end, EVEN + 1)]
    for middle in bottoms(motion):
        width = sqrt(motion.scene.hoop.constants.zeta) / abs(float(motion.at(middle).omega))
        reach = asinh(motion.t_end / width)
        count = ceil(reach / STEP)
        times.append(middle + width * np.sinh(np.linspace(-reach, reach, 2 * count + 1)))
    times += [np.linspace(phase.t_start, phase.t_end, LEAST_INTERVALS + 1) for phase in motion.phases]
    t = np.unique(np.concatenate(times))
    return t[(t >= start) & (t <= end)]


@cache
def samples(name: str, turns: int, start: float, end: float) -> Samples:
    """A part of a shipped scene's motion, each phase from its start up to its end, both included."""
    motion = motion_of(name, turns)
    within = instants(motion, start, end)
    parts, lasts, kinds = [], [], []
    for phase in motion.phases:
        first, last = max(phase.t_start, start), min(phase.t_end, end)
        if first < last:
            parts.append(np.concatenate([[first], within[(within > first) & (within < last)]]))
            lasts.append(last)
            kinds.append(np.full(len(parts[-1]) + 1, phase.kind.value))
    # all at once, which is one pass along the motion; the ends of phases apart, by their values before the jump
    states, ends = motion.at(np.concatenate(parts)), motion.at(np.array(lasts), "left")
    where = np.cumsum([len(times) for times in parts])
    names = [field.name for field in dataclasses.fields(States)]
    columns = {name: np.insert(getattr(states, name), where, getattr(ends, name)) for name in names}
    return Samples(States(**columns), np.concatenate(kinds))


def line(curve: Curve, panel: Panel) -> Line:
    """A curve of a panel."""
    turns = TURNS[panel.part]
    part = samples(curve.scene, turns, *span(motion_of(curve.scene, turns), panel))
    x, y = (QUANTITIES[quantity].of(part.states) for quantity in (panel.x, panel.y))
    return Line(curve, part.states.t, x, y, part.phase)


def lines(figure: Figure, side: str) -> tuple[Line, ...]:
    """Every curve of a figure's panel."""
    return tuple(line(curve, figure.panels[side]) for curve in figure.curves)
