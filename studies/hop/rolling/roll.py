"""One roll of the flexible hoop from rest, and every time that it is off the floor.

:func:`roll` is a solver as studies take them (:mod:`studies.running.solvers`).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from math import degrees, pi, sin, sqrt
from typing import Any

import numpy as np

from flexible import FlexibleMotion, simulate
from flexible.output.body import lowest
from rigid import Run, Scene
from rigid.output.units import Length, Number, Time, in_units, without_units

from ...running.files import StudyError
from .energies import HopEnergies, Roll, hop_energies
from .limit import rigid_motion
from .rule import DECADE, Scales, scales_of
from .threshold import hops_in, windows

WHOLE = f"{__name__}:roll"
SOLVER = f"{__name__}:roll_until_decided"
"""The names under which cases call it."""

RTOL = 3e-4
"""Tolerance of the rolls; thresholds are held against a third of it."""

MOST_STEPS = 20_000
"""After which a roll is stopped, a minute or so. Hoops with a ring of some mass end well before (13 000 steps for the
softest of the smallest disk); a massless one may chatter without end. The bound is on steps and not on seconds, so that
a case comes out the same on a busy machine."""


@dataclass(frozen=True, slots=True)
class Flight:
    """A time without contact, in the units of the scene."""

    t: Time[float]
    """Lift-off: the rim's lowest point passes the floor."""
    phi: Number[float]
    """Where the disk is then."""
    duration: Time[float]
    """Until it passes it again, or to the end of the motion."""
    height: Length[float]
    """Of the rim's lowest point, the largest on the way."""
    prominence: Number[float]
    """See :meth:`studies.hop.rolling.rule.Scales.prominence`."""
    swept: Number[float]
    """The largest angle that the disk has come down from its release by then: tells the first pass of the bottom."""
    energies: HopEnergies | None = None
    """Of flights that may count as a hop."""


@dataclass(frozen=True, kw_only=True)
class RollingMotion(FlexibleMotion):
    """A flexible motion with its flights."""

    flights: tuple[Flight, ...] = ()
    scales: Scales = field(default_factory=lambda: Scales(0.0, 0.0, 0.0))
    """In R and sqrt(R/g)."""
    swept: float = 0.0
    """The largest angle that the disk comes down from its release."""
    whole: bool = True
    """Whether it was to roll to the end of the scene's run, and did not end where all was decided."""

    def to_dict(self) -> dict[str, Any]:
        """What a study keeps; phases of a chattering patch may be thousands and are left out."""
        told = FlexibleMotion.to_dict(self)
        return {
            **{name: told[name] for name in ("scene", "ended", "completed", "energy_ledger", "steps")},
            "t_end": self.t_end,
            "swept": self.swept,
            "whole": self.whole,
            "scales": dataclasses.asdict(in_units(self.scales, self.scene)),
            "flights": [dataclasses.asdict(flight) for flight in self.flights],
        }


def from_rest(scene: Scene) -> Scene:
    """The scene as a roll runs it: flexible throughout, from equilibrium, for as long as the rigid hoop is run to which
    it tends.

    The end is a time: the disk of a soft hoop rocks, and every reversal of its rotation is a turn.

    Raises
    ------
    StudyError
        It does not begin at rest, or stays so.
    """
    release = scene.release
    if release.omega0 or release.slip0:
        raise StudyError("A hop is asked of a hoop released at rest: release.omega0 and release.slip0 must be 0.")
    end = rigid_motion(scene, Run(until="pulse") if scene.run.until == "rest" else None)
    if not end.t_end:
        raise StudyError(
            f"A hop is asked of a hoop that rolls: at rest at phi0 = {degrees(release.phi0):g}° it stands still."
        )
    return scene.replace(run=Run(t_end=end.t_end), solve={"resolve": "all", "start": "equilibrium"})


def through_the_pulse(scene: Scene) -> Scene:
    """A scene that rolls from rest, ended where its rigid hoop is halfway from its first pulse to its next turn.

    What hops by then is decided a few times as cheaply as to a second turn: most steps are taken in the chatter later.
    """
    assert scene.run.t_end is not None
    motion = rigid_motion(scene)
    pulse = next((p for p in motion.pulses if not p.cut), None)
    if pulse is None:
        return scene
    turn = next((turn.t for turn in motion.turns if turn.t > pulse.t_end), motion.t_end)
    return scene.replace(run={"t_end": min((pulse.t_end + turn) / 2, scene.run.t_end)})


def roll(scene: Scene, *, history: bool = False, progress: Callable[[float], None] | None = None) -> RollingMotion:
    """Roll the hoop of a scene; with ``history`` its steps and states are kept."""
    return _rolled(simulate(scene, history=True, progress=progress, most_steps=MOST_STEPS), history)


def roll_until_decided(
    scene: Scene, *, history: bool = False, progress: Callable[[float], None] | None = None
) -> RollingMotion:
    """The same, ended behind the first pulse or at the first turn if by then it is decided where the hoop hops.

    It is decided if the disk has passed the pulse and the hoop has hopped by the strictest of the rule's constants.
    What has hopped rings, and most of its steps would be taken in the chatter of its way on.
    """
    places, constants = windows(scene), (1.0, *DECADE)
    earlier: FlexibleMotion | None = None
    for t_end in _looks(scene):
        earlier = simulate(
            scene.replace(run=Run(t_end=t_end)), history=True, progress=progress, most_steps=MOST_STEPS, resume=earlier
        )
        found = _rolled(earlier, history)
        told = found.to_dict()
        asked = [hops_in(told, window, least, whole=False) for window in places.values() for least in constants]
        if not earlier.completed or None not in asked:
            return dataclasses.replace(found, whole=not earlier.completed or t_end == scene.run.t_end)
    assert earlier is not None
    return _rolled(earlier, history)


def _looks(scene: Scene) -> list[float]:
    """When it is asked whether all is decided: behind the pulse, at the rigid hoop's first turn, at the end."""
    assert scene.run.t_end is not None
    turns = [turn.t for turn in rigid_motion(scene).turns[:1]]
    pulse = through_the_pulse(scene).run.t_end
    assert pulse is not None
    return sorted(t for t in {pulse, *turns, scene.run.t_end} if t <= scene.run.t_end)


def _rolled(motion: FlexibleMotion, history: bool) -> RollingMotion:
    """The motion with its flights; without ``history`` its steps are let go."""
    values = {entry.name: getattr(motion, entry.name) for entry in dataclasses.fields(FlexibleMotion)}
    found = RollingMotion(**values) if not motion.kept else _with_flights(values, steps_of(motion))
    return found if history else dataclasses.replace(found, history=None, kept=())


def steps_of(motion: FlexibleMotion) -> Roll:
    """The steps of a flexible motion as one run, in the solver's units."""
    history = motion.history
    assert history is not None
    states = [state for kept in motion.kept for state in kept.states]
    return Roll(motion.kept[0].hoop, states, without_units(history, motion.scene))


def _with_flights(values: dict[str, Any], steps: Roll) -> RollingMotion:
    scene: Scene = values["scene"]
    history = steps.history
    scales = scales_of(steps.hoop.scene, max(1 - float(history.y_C[0]), 0.0))
    slow = max(scales.period, 2 * pi * sqrt(scales.sag))  # of the ring, or of the hoop on it
    down = 1.0 if sin(scene.release.phi0) >= 0 else -1.0
    swept = np.maximum.accumulate(down * (history.phi - history.phi[0]))
    flights = []
    for first, last in spans(history.normal_force == 0):
        found = _flight(steps, first, last, scales)
        if found.prominence >= DECADE[0] and first > 0:
            found = dataclasses.replace(found, energies=hop_energies(steps, first, last, slow))
        flights.append(in_units(dataclasses.replace(found, swept=float(swept[first])), scene))
    return RollingMotion(**values, flights=tuple(flights), scales=scales, swept=float(swept[-1]))


def spans(off: np.ndarray) -> list[tuple[int, int]]:
    """First and last of every run of true entries."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], off, [False]]).astype(int)))
    return [(int(first), int(end) - 1) for first, end in zip(edges[::2], edges[1::2], strict=True)]


def _flight(steps: Roll, first: int, last: int, scales: Scales) -> Flight:
    """The flight of the steps ``first`` to ``last``, in the solver's units; its ends are where the gap passes 0."""
    t, phi = steps.history.t, steps.history.phi
    around = range(max(first - 1, 0), min(last + 1, len(t) - 1) + 1)
    gap = {i: lowest(steps.hoop, steps.states[i]) for i in around}
    up = _passes(gap, first - 1, first) if first - 1 in gap else 0.0
    down = _passes(gap, last + 1, last) if last + 1 in gap else 0.0
    start = t[first] - up * (t[first] - t[max(first - 1, 0)])
    end = t[last] + down * (t[min(last + 1, len(t) - 1)] - t[last])
    angle = phi[first] - up * (phi[first] - phi[max(first - 1, 0)])
    height = max(max(gap.values()), 0.0)
    duration = max(float(end - start), 0.0)
    return Flight(float(start), float(angle), duration, height, scales.prominence(height, duration), 0.0)


def _passes(gap: dict[int, float], on: int, off: int) -> float:
    """Share of the step between an instant on the floor and one off it that lies off it."""
    rise = gap[off] - gap[on]
    return min(max(gap[off] / rise, 0.0), 1.0) if rise > 0 else 0.0
