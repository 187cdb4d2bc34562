"""Phases, turns, pulses and states as plain values, in the units of a scene."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from math import nan
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..output import summary
from ..output.same import Same
from ..output.units import AngularAcceleration, AngularVelocity, Energy, Force, Impulse, Length, Number, Time, Velocity

Array = NDArray[np.float64]
Side = Literal["left", "right"]


class Kind(StrEnum):
    """What the contact does during a phase.

    "roll" where it sticks; "skid" where its point moves forward, v > 0, and "spin" where it moves backward; "flight"
    off the floor, "skim" on it without a force; "impact" is an instant, in which velocities jump by an impulse.
    """

    ROLL = "roll"
    SKID = "skid"
    SPIN = "spin"
    FLIGHT = "flight"
    SKIM = "skim"
    IMPACT = "impact"


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of time in which the contact does one thing; an impact has no duration.

    Attributes
    ----------
    kind : Kind
        What it does.
    t_start, t_end : float
        When it begins and ends, since the release.
    phi_start, phi_end : float
        The angle of the disk then, counted on over whole turns.
    """

    kind: Kind
    t_start: Time[float]
    t_end: Time[float]
    phi_start: Number[float]
    phi_end: Number[float]


@dataclass(frozen=True, slots=True)
class Turn:
    """An instant with phidot = 0 after release; of an impact that turns the hoop round, what is behind the blow.

    Of a flexible hoop, whose disk vibrates, one by which its momentum has turned too.

    Attributes
    ----------
    t, phi : float
        When and at which angle.
    slip_velocity : float
        Of the contact point, forward; off the floor of the lowest point.
    energy : float
        Kinetic and of gravity, of a flexible hoop that of its springs too.
    """

    t: Time[float]
    phi: Number[float]
    slip_velocity: Velocity[float]
    energy: Energy[float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pulse(Same):
    """One sweep of the disk past the floor: the phi-interval around phi = pi (mod 2 pi) with rigid N > M g.

    Attributes
    ----------
    t_start, t_end, phi_start, phi_end : float
        When and at which angles it begins and ends.
    normal_impulse, friction_impulse : float
        Integrals of N and F, J_N and J_F.
    friction_loss : float
        Integral of |F v|.
    peak_normal_force : float
        Largest N; inf in a pulse that jams.
    newton_restitution, poisson_restitution, energetic_restitution : float
        By the velocity of the mass centre G before and after: Newton's -ydot+/ydot-, Poisson's impulse of restitution
        over that of compression (split where ydot_G = 0), and the square root of Stronge's -W_r/W_c.
    cut : bool
        Whether the run begins or ends in it: its measures are then those of the part that was run, its restitutions
        NaN.
    sample : callable or None
        That of the motion which the pulse is a part of.
    """

    t_start: Time[float]
    t_end: Time[float]
    phi_start: Number[float]
    phi_end: Number[float]
    normal_impulse: Impulse[float]
    friction_impulse: Impulse[float]
    friction_loss: Energy[float]
    peak_normal_force: Force[float]
    newton_restitution: Number[float]
    poisson_restitution: Number[float]
    energetic_restitution: Number[float]
    cut: bool = False
    sample: Callable[[Array, Side], States] | None = field(default=None, repr=False, compare=False)

    def __str__(self) -> str:
        return summary.text(summary.title_of_pulse(self), self._lines())

    def _lines(self) -> list[summary.Line]:
        return summary.lines_of_pulse(self)

    @property
    def impulse_ratio(self) -> float:
        """J_F/J_N; mu or -mu would be the ratio of Whittaker and of Kane and Levinson. NaN without a normal impulse."""
        return self.friction_impulse / self.normal_impulse if self.normal_impulse else nan

    def to_dict(self) -> dict[str, Any]:
        """All measures by name, the ratio among them."""
        told = {field.name: getattr(self, field.name) for field in dataclasses.fields(self) if field.name != "sample"}
        return {**told, "impulse_ratio": self.impulse_ratio}

    def plot(self, *quantities: str, over: str = "t", axes: Any = None) -> NDArray[np.object_]:
        """N, F and slip velocity, or the quantities named, through the pulse; see :meth:`rigid.Motion.plot`.

        Raises
        ------
        ValueError
            A pulse that belongs to no motion, or a quantity that there is not.
        """
        from ..output.axes import of_pulse

        return of_pulse(self, quantities, over, axes)


@dataclass(frozen=True, slots=True, eq=False)
class States(Same):
    """A motion sampled at times ``t``; every field has the shape of ``t``, and at one time is a number, a float64.

    N, F and ``alpha`` jump where phases meet.

    Attributes
    ----------
    t, phi, omega, alpha : array
        Time, angle, phidot and phiddot.
    x_C, y_C : array
        Place of the hoop's centre, to the right of where it was released and over the floor.
    slip_velocity : array
        Of the contact point.
    normal_force, friction_force : array
        N, and F, positive to the right.
    energy : array
        Kinetic and of gravity, of a flexible hoop that of its springs too.
    """

    t: Time[Array]
    phi: Number[Array]
    omega: AngularVelocity[Array]
    alpha: AngularAcceleration[Array]
    x_C: Length[Array]
    y_C: Length[Array]
    slip_velocity: Velocity[Array]
    normal_force: Force[Array]
    friction_force: Force[Array]
    energy: Energy[Array]

    def __post_init__(self) -> None:
        for each in dataclasses.fields(self):  # numpy takes some of what has no axes for numbers, and some for arrays
            object.__setattr__(self, each.name, np.asarray(getattr(self, each.name))[()])
