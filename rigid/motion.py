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
from math import degrees, nan
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .allowed import times_within
from .output import sampling, summary, units
from .output.same import Same
from .output.units import AngularAcceleration, AngularVelocity, Energy, Force, Impulse, Length, Number, Time, Velocity
from .scene import Scene
from .scenefile import scene_to_dict

if TYPE_CHECKING:
    import pandas

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
    t_start: Time[float]
    t_end: Time[float]
    phi_start: Number[float]
    phi_end: Number[float]


@dataclass(frozen=True, slots=True)
class Turn:
    """An instant with phidot = 0 after release; of an impact that turns the hoop round, what is behind the blow.

    Of a flexible hoop, whose disk vibrates, one by which its momentum has turned too.
    """

    t: Time[float]
    phi: Number[float]
    slip_velocity: Velocity[float]
    energy: Energy[float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pulse(Same):
    """One sweep of the disk past the floor: the phi-interval around phi = pi (mod 2 pi) with rigid N > M g.

    ``friction_loss`` is the integral of |F v|; the peak of N is inf in a pulse that jams. Restitution compares the
    velocity of the mass centre G before and after: Newton's -ydot+/ydot-, Poisson's impulse of restitution over that of
    compression (split where ydot_G = 0), and the square root of Stronge's -W_r/W_c.

    ``cut`` marks a pulse in which the run begins or ends: its measures are those of the part that was run, its
    restitutions NaN. ``sample`` is that of the motion which the pulse is a part of.
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
        """N, F and slip velocity, or the quantities named, through the pulse; see :meth:`Motion.plot`.

        Raises
        ------
        ValueError
            A pulse that belongs to no motion, or a quantity that there is not.
        """
        from .output.axes import of_pulse

        return of_pulse(self, quantities, over, axes)


@dataclass(frozen=True, slots=True, eq=False)
class States(Same):
    """A motion sampled at times ``t``; every field has the shape of ``t``, and at one time is a number, a float64.

    ``omega`` and ``alpha`` are phidot and phiddot, ``x_C`` and ``y_C`` the hoop's centre, ``slip_velocity`` is that
    of the contact point, F is positive to the right. N, F and ``alpha`` jump where phases meet.
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


@dataclass(frozen=True, repr=False)
class Motion(summary.Summarised):
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
            At an instant that two phases share N, F and ``alpha`` jump, and over an impact velocities: "right" gives
            their values in the later phase, "left" those at the end of the earlier one. Where the motion ends with an
            impact "right" is behind the blow.

        Raises
        ------
        ValueError
            What is no time, or one before release or after the end.
        """
        return self.sample(self._inside(t, side), side)

    def _inside(self, t: ArrayLike, side: Side) -> Array:
        """Times within the motion; those that round-off has beyond its ends are at them."""
        if side not in ("left", "right"):
            raise ValueError(f"side must be 'left' or 'right', not {side!r}")
        return times_within(t, self.t_end, 1e-12 * max(self.scene.time_unit, self.t_end))

    def phase_at(self, t: float, side: Side = "right") -> Phase:
        """The phase at a time; an instant that two phases share belongs to the later one, or with ``side="left"`` to
        the earlier. Errors are those of :meth:`at`.
        """
        if not self.phases:
            raise ValueError("a motion without phases")
        search = bisect_right if side == "right" else bisect_left
        if np.ndim(t):
            raise ValueError("phase_at takes one time")
        found = search(self.phases, float(self._inside(t, side)), key=lambda phase: phase.t_start)
        return self.phases[max(found - 1, 0)]

    def times(self, start: float = 0.0, end: float | None = None) -> Array:
        """Times at which to sample the motion for a picture or a table, both sides of every jump among them: N and F
        are straight between them to two thousandths of their range, as far as some 20 000 times allow (200 pulses) and
        doubles tell them apart. All steps of a flexible motion are among them: there N, F, omega and slip velocity are
        straight between two, and impulses are the steps' own, of a higher order than the areas under these lines.
        """
        return sampling.instants(self, start, self.t_end if end is None else end)

    def plot(self, *quantities: str, over: str = "t", axes: Any = None) -> NDArray[np.object_]:
        """Curves of the motion, a panel for each quantity; phases that do not roll are shaded if there are no more than
        200 of all: over the time behind the curves, over anything else, where the motion may come by again, along them.

        Parameters
        ----------
        *quantities : str
            Fields of :class:`States`; N, F and slip velocity if none are named.
        over : str
            The abscissa: "t", "phi" or any other.
        axes : matplotlib Axes or sequence of them, optional
            Where to draw, shades labelled for ``axes.legend()``; by default a new figure, which has a legend of them.

        Returns
        -------
        (n,) array of matplotlib Axes
        """
        from .output.axes import of_motion

        return of_motion(self, quantities, over, axes)

    def to_dataframe(self, t: ArrayLike | None = None) -> pandas.DataFrame:
        """The states at times ``t`` (n,), by default :meth:`times`, and the kind of phase: a row for each.

        ``attrs["units"]`` of the table has what each column of numbers is measured in, as :attr:`units`.
        """
        from .output.frame import states_of

        return states_of(self, t)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the motion into a file, with its scene and the version of this program; ``load_motion`` reads it.

        Raises
        ------
        ValueError
            A motion of a solver that says not how; what is no path.
        """
        from .output.file import write

        stored = getattr(self.sample, "stored", None)
        if stored is None or not isinstance(path, (str, PathLike)):
            raise ValueError("This motion cannot be saved." if stored is None else f"{path!r} is no path to save to.")
        write(path, scene_to_dict(self.scene), stored(self))

    def _table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        header = ("pulse", "t", "J_N", "J_F", "J_F/J_N", "friction loss", "peak N")
        rows = [
            (str(number), f"{p.t_start:.6g} to {p.t_end:.6g}", *(f"{value:.6g}" for value in (
                p.normal_impulse, p.friction_impulse, p.impulse_ratio, p.friction_loss, p.peak_normal_force)))
            for number, p in enumerate(self.pulses[: summary.SHOWN], 1)
        ]  # fmt: skip
        return header, rows

    def _title(self) -> str:
        return f"{type(self).__name__} to t = {self.t_end:.6g}: {self.ended}"

    def _lines(self) -> list[summary.Line]:
        """What there is to tell of the motion."""
        hoop, friction, release = self.scene.hoop, self.scene.friction, self.scene.release
        shown = summary.SHOWN
        return [
            ("scene", f"k = {hoop.k:g}, r = {hoop.r:g}, m_h/m = {hoop.mass_ratio:g}, mu_s = {friction.mu_s:g}, "
                      f"mu = {friction.mu:g}, from {degrees(release.phi0):g} degrees"),
            ("phases", summary.some([str(phase.kind) for phase in self.phases[:shown]], len(self.phases))),
            ("turns", summary.some([f"phi = {turn.phi:.6g}" for turn in self.turns[:shown]], len(self.turns))),
            ("pulses", summary.some([f"J_F/J_N = {p.impulse_ratio:.6g}{' (cut)' if p.cut else ''}"
                                     for p in self.pulses[:shown]], len(self.pulses))),
        ]  # fmt: skip

    @property
    def units(self) -> dict[str, str]:
        """What each number of this motion is measured in, by its name; "1" for angles in radians and shares."""
        return {**units.unit_names(self.scene, Phase, Turn, Pulse, States), "impulse_ratio": "1"}

    def to_dict(self) -> dict[str, Any]:
        """The motion as the command line's JSON prints it, but for NaN and infinity, which are null there."""
        return {
            "scene": scene_to_dict(self.scene),
            "phases": [dataclasses.asdict(phase) for phase in self.phases],
            "turns": [dataclasses.asdict(turn) for turn in self.turns],
            "pulses": [pulse.to_dict() for pulse in self.pulses],
            "ended": self.ended,
            "completed": self.completed,
        }
