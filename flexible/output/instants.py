"""Which instants of a flexible motion become frames, and the hoop at each of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes import Placement, SeriesError, frame_times
from rigid import Pulse
from rigid.allowed import times_within
from rigid.output.units import without_units

from ..airborne import rise
from ..models.state import State
from ..motion import FlexibleMotion, Kept
from ..time.adaptive import attempt
from ..time.methods import chosen

Array = NDArray[np.float64]

_AROUND = 0.25  # by default the frames begin and end this share of a pulse before and after it


@dataclass(frozen=True, slots=True)
class Instant:
    """A frame to be: where the hoop is, and the ring's state if it is elastic there, with its neighbours."""

    t: float
    place: Placement
    velocity_C: tuple[float, float]
    omega: float
    kept: Kept | None = None
    state: State | None = None
    before: State | None = None
    after: State | None = None


def times_of(motion: FlexibleMotion, frames: int, times: ArrayLike | None, pulse: int | None) -> Array:
    """Times of the frames, in the scene's unit: those listed, or so many through a pulse, denser where N changes, and
    at steps of the march where there are as many.
    """
    end = motion.t_end
    if times is not None:
        try:
            listed = np.unique(times_within(times, end, 1e-12 * end))
        except ValueError as error:
            raise SeriesError(str(error)) from None
        if not listed.size:
            raise SeriesError("times are not possible: none is given.")
        return listed
    if not (isinstance(frames, int | np.integer) and frames >= 2):
        raise SeriesError(f"frames = {frames!r} is not possible: it is a whole number, at least 2.")
    start = 0.0
    if pulse is not None and motion.pulses:
        if not (isinstance(pulse, int | np.integer) and 0 <= pulse < len(motion.pulses)):
            raise SeriesError(f"pulse = {pulse!r} is not possible: the motion has {len(motion.pulses)}.")
        start, end = _around(motion, motion.pulses[pulse])
    if not start < end:
        raise SeriesError(f"there is no stretch of time to show from t = {start:g} on: {motion.ended}.")
    history = motion.history
    if history is None or not len(history.t):
        return frame_times(start, end, frames)
    chosen = frame_times(start, end, frames, history.t, history.normal_force)
    return _at_steps(chosen, [clock * motion.scene.time_unit for clock in _clocks(motion)])


def _clocks(motion: FlexibleMotion) -> list[Array]:
    """Times of the kept states, a flexible segment each, in the solver's units."""
    return [np.array([state.t for state in kept.states]) for kept in motion.kept]


def _at_steps(chosen: Array, clocks: list[Array]) -> Array:
    """Times (n,), each at the step nearest to it if that is nearer than the next one; distinct and ascending as before.

    Between two steps there is only a shorter step from the first of them, which rings with what the longer one damps.
    Outside the clocks' spans the motion is in closed form, and a time stays as it is.
    """
    steps = np.unique(np.concatenate(clocks))
    steps = steps[(steps >= chosen[0]) & (steps <= chosen[-1])]
    if not steps.size:
        return chosen
    marched = np.any([(clock[0] <= chosen) & (chosen <= clock[-1]) for clock in clocks], axis=0)
    nearest = np.searchsorted((steps[1:] + steps[:-1]) / 2, chosen)
    away, gaps = np.abs(steps[nearest] - chosen), np.diff(chosen)
    near = marched & (away < np.maximum(np.append(gaps, gaps[-1]), np.insert(gaps, 0, gaps[0])))
    # a step that is the nearest of several frames' is taken by the one that is nearest to it
    order = np.lexsort((away, nearest))
    first = np.zeros(chosen.size, dtype=bool)
    first[order[np.insert(np.diff(nearest[order]) > 0, 0, True)]] = True
    return np.where(near & first, steps[nearest], chosen)


def _around(motion: FlexibleMotion, pulse: Pulse) -> tuple[float, float]:
    """From a little before a pulse to a little after it, as far as the hoop is flexible there."""
    margin, unit = _AROUND * (pulse.t_end - pulse.t_start), motion.scene.time_unit
    start, end = max(0.0, pulse.t_start - margin), min(motion.t_end, pulse.t_end + margin)
    for kept in motion.kept:
        first, last = kept.states[0].t * unit, kept.states[-1].t * unit
        if first <= (pulse.t_start + pulse.t_end) / 2 <= last:
            start, end = max(start, first), min(end, last)
    return start, end


def _within(kept: Kept, before: State, t: float) -> State | None:
    """The state at a time within the step from ``before``, by a shorter step of the same method."""
    solve = kept.hoop.scene.solve
    return attempt(kept.hoop, before, t - before.t, chosen(solve.integrator, solve.rtol, kept.hoop.vibrates))


def _instant(motion: FlexibleMotion, clocks: list[Array], t: float, told: float) -> Instant:
    """The state at ``t``, in the solver's units; ``told`` is the same time in the scene's.

    ``clocks`` are the times of the kept states.
    """
    for kept, steps in zip(motion.kept, clocks, strict=True):
        first, last = steps[0], steps[-1]
        if not first - 1e-12 * last <= t <= last * (1 + 1e-12):
            continue
        i = min(max(int(np.searchsorted(steps, t, side="right")) - 1, 0), len(steps) - 2)
        before, after = kept.states[i], kept.states[i + 1]
        state: State | None = before
        slack = 1e-15 * last  # a step's time comes back from the scene's unit so far off
        if t > before.t + slack:
            state = after if t >= after.t - slack else _within(kept, before, t)
        if state is None:
            state = min(before, after, key=lambda s: abs(s.t - t))
        place = Placement(float(state.pos[2]), state.x_C, 1 + float(state.pos[1]))
        velocity = (float(state.vel[0] + state.vel[2]), float(state.vel[1]))
        return Instant(told, place, velocity, float(state.vel[2]), kept, state, before, after)
    now = without_units(motion.at(told), motion.scene)
    place = Placement(float(now.phi), float(now.x_C), float(now.y_C))
    omega = float(now.omega)
    return Instant(told, place, (omega + float(now.slip_velocity), rise(motion, told, now)), omega)


def instants_at(motion: FlexibleMotion, times: Array) -> list[Instant]:
    """The hoop at times in the scene's unit."""
    clocks = _clocks(motion)
    return [_instant(motion, clocks, float(t) / motion.scene.time_unit, float(t)) for t in times]
