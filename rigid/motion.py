"""The vocabulary both solvers speak: a scene goes in, a :class:`Motion` comes out.

All values are in the units of the scene (R, m, g unless it is SI); angles in radians, energy 0 at floor
level.
"""

from __future__ import annotations

import dataclasses
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from math import nan
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .scene import Scene
from .scenefile import scene_to_dict

Array = NDArray[np.float64]
Side = Literal["left", "right"]


class Kind(StrEnum):
    """What the contact does during a phase."""

    ROLL = "roll"
    SKID = "skid"  # the contact point moves forward, v > 0
    SPIN = "spin"  # the contact point moves backward, v < 0
    FLIGHT = "flight"  # off the floor
    SKIM = "skim"  # on the floor without a force
    IMPACT = "impact"  # an instant: velocities jump by an impulse


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of time in which the contact does one thing; an impact has no duration."""

    kind: Kind
    t_start: float
    t_end: float
    phi_start: float
    phi_end: float


@dataclass(frozen=True, slots=True)
class Turn:
    """An instant with phidot = 0 after release."""

    t: float
    phi: float
    slip_velocity: float
    energy: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Pulse:
    """One sweep of the disk past the floor: the phi-interval around phi = pi (mod 2 pi) with rigid N > M g.

    ``friction_loss`` is the integral of |F v|. Restitution compares the velocity of the mass centre G before
    and after: Newton's -ydot+/ydot-, Poisson's impulse of restitution over that of compression (split where
    ydot_G = 0), and the square root of Stronge's -W_r/W_c.

    ``cut`` marks a pulse in which the run begins or ends: its measures are those of the part that was run, its
    restitutions NaN.
    """

    t_start: float
    t_end: float
    phi_start: float
    phi_end: float
    normal_impulse: float
    friction_impulse: float
    friction_loss: float
    peak_normal_force: float
    newton_restitution: float
    poisson_restitution: float
    energetic_restitution: float
    cut: bool = False

    @property
    def impulse_ratio(self) -> float:
        """J_F/J_N; mu or -mu would be the ratio of Whittaker and of Kane and Levinson. NaN without a normal impulse."""
        return self.friction_impulse / self.normal_impulse if self.normal_impulse else nan

    def to_dict(self) -> dict[str, Any]:
        """All measures by name, the ratio among them."""
        return {**dataclasses.asdict(self), "impulse_ratio": self.impulse_ratio}


@dataclass(frozen=True, slots=True)
class States:
    """A motion sampled at times ``t``; every field is an array of the shape of ``t``.

    ``omega`` and ``alpha`` are phidot and phiddot, ``x_C`` and ``y_C`` the hoop's centre, ``slip_velocity`` is that
    of the contact point, F is positive to the right. N, F and ``alpha`` jump where phases meet.
    """

    t: Array
    phi: Array
    omega: Array
    alpha: Array
    x_C: Array
    y_C: Array
    slip_velocity: Array
    normal_force: Array
    friction_force: Array
    energy: Array


@dataclass(frozen=True)
class Motion:
    """What a solver returns: phases, turns and pulses as plain values, and any instant between on demand.

    ``ended`` says in words why the motion stops; ``period`` is that of a motion that will roll for ever.
    ``completed`` is False when the solver gave up before what was asked. The sequences are tuples, or make their items
    on demand where a motion without loss comes round many times.
    """

    scene: Scene
    phases: Sequence[Phase]
    turns: Sequence[Turn]
    pulses: Sequence[Pulse]
    ended: str
    sample: Callable[[Array, Side], States] = field(repr=False, compare=False)
    period: float | None = None
    completed: bool = True

    @property
    def t_end(self) -> float:
        """Time at which the motion stops."""
        return self.phases[-1].t_end if self.phases else 0.0

    def at(self, t: ArrayLike, side: Side = "right") -> States:
        """State at times ``t`` (any shape), computed now and not before.

        Parameters
        ----------
        t : array_like
        side : "right" or "left"
            At an instant that two phases share N, F and ``alpha`` jump: "right" gives their values in the later
            phase, "left" those at the end of the earlier one.

        Raises
        ------
        ValueError
            A time before release or after the end.
        """
        times = np.asarray(t, dtype=float)
        slack = 1e-12 * max(1.0, self.t_end)
        if times.size and not (times.min() >= -slack and times.max() <= self.t_end + slack):
            raise ValueError(f"times must lie in [0, {self.t_end}]")
        return self.sample(np.clip(times, 0.0, self.t_end), side)

    def phase_at(self, t: float, side: Side = "right") -> Phase:
        """The phase at a time; an instant that two phases share belongs to the later one, or with ``side="left"`` to
        the earlier.
        """
        if not self.phases:
            raise ValueError("a motion without phases")
        search = bisect_right if side == "right" else bisect_left
        found = search(self.phases, t, key=lambda phase: phase.t_start)
        return self.phases[max(found - 1, 0)]

    def to_dict(self) -> dict[str, Any]:
        """The motion as the command line's JSON prints it."""
        return {
            "scene": scene_to_dict(self.scene),
            "phases": [dataclasses.asdict(phase) for phase in self.phases],
            "turns": [dataclasses.asdict(turn) for turn in self.turns],
            "pulses": [pulse.to_dict() for pulse in self.pulses],
            "ended": self.ended,
            "completed": self.completed,
        }
