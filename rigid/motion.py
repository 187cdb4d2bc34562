"""The vocabulary both solvers speak: a scene goes in, a :class:`Motion` comes out.

All values are in the units of the scene (R, m, g unless it is SI); angles in radians, energy 0 at floor
level.
"""

from __future__ import annotations

import dataclasses
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from numbers import Real
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .allowed import shown, times_within
from .output import sampling, summary, units
from .record.values import Array, Phase, Pulse, Side, States, Turn
from .scene import Scene
from .scenefile import scene_to_dict

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, repr=False)
class Motion(summary.Summarised):
    """What a solver returns: phases, turns and pulses as plain values, and any instant between on demand.

    Attributes
    ----------
    scene : Scene
        What was run, whose units all numbers have; :attr:`units` names them.
    phases, turns, pulses : sequence of Phase, Turn, Pulse
        In their order; made on demand where a motion without loss comes round many times.
    ended : str
        In words, why the motion stops.
    sample : callable
        What :meth:`at` asks.
    period : float or None
        Of a motion that will roll for ever.
    completed : bool
        False when the solver gave up before what was asked.
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
        inside = self._inside(t, side)
        if inside.ndim:
            raise ValueError("phase_at takes one time")
        found = search(self.phases, float(inside), key=lambda phase: phase.t_start)
        return self.phases[max(found - 1, 0)]

    def times(self, start: float = 0.0, end: float | None = None) -> Array:
        """Times at which to sample the motion for a picture or a table, both sides of every jump among them: N and F
        are straight between them to two thousandths of their range, as far as some 20 000 times allow (200 pulses) and
        doubles tell them apart. All steps of a flexible motion are among them: there N, F, omega and slip velocity are
        straight between two, and impulses are the steps' own, of a higher order than the areas under these lines.
        """
        end = self.t_end if end is None else end
        for one in (start, end):
            if not isinstance(one, (Real, np.ndarray)) or np.ndim(one):
                told = f"Times from {shown(start)} to {shown(end)} are not possible"
                raise ValueError(f"{told}: each of the two is a number.")
        return sampling.instants(self, start, end)

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

    def _table(self) -> tuple[Sequence[str], list[tuple[str, ...]]]:
        return summary.table_of_pulses(self.pulses)

    def _title(self) -> str:
        return f"{type(self).__name__} to t = {self.t_end:.6g}: {self.ended}"

    def _lines(self) -> list[summary.Line]:
        return summary.lines_of_motion(self)

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
