"""Which instants of a run an animation shows, and how fast."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import NDArray

from ..draw.display import ViewError
from ..draw.shots import Source
from ..times import frame_times
from .setting import as_told


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """Which instants of a run an animation shows, and how fast.

    Parameters
    ----------
    frames : int, optional
        Number of pictures; 60 for a gif or a page, 150 for a film.
    fps : int
        Pictures per second.
    start, stop : float, optional
        Stretch of time; the whole run by default.
    pace : {"force", "time"}
        "time" runs evenly in time; "force" spends half of its pictures where the normal force changes, so
        that a pulse is seen in slow motion.

    Raises
    ------
    ViewError
        Fewer than two pictures or one per second, a stretch that ends before it begins, or another pace.
    """

    frames: int | None = None
    fps: int = 20
    start: float | None = None
    stop: float | None = None
    pace: str = "force"

    def __post_init__(self) -> None:
        if not ((self.frames is None or (self.frames >= 2 and self.frames % 1 == 0)) and self.fps >= 1):
            count = "any number of" if self.frames is None else self.frames
            raise ViewError(f"{count} frames at {self.fps} per second are no animation: it takes 2 at 1 per second.")
        for name, time in (("start", self.start), ("stop", self.stop)):
            if time is not None and not (isinstance(time, Real) and np.isfinite(time)):
                raise ViewError(f"{name} = {time!r} is not possible: it is a time.")
        if self.start is not None and self.stop is not None and self.start >= self.stop:
            raise ViewError(f"start = {self.start!r} is not possible: it must lie before stop = {self.stop!r}.")
        if self.pace not in ("force", "time"):
            raise ViewError(f"pace = {self.pace!r} is not possible: it is 'force' or 'time'.")


def instants(source: Source, timing: Timing, usual: int) -> NDArray[np.float64]:
    """The instants of an animation, ``usual`` in number unless told."""
    count = usual if timing.frames is None else timing.frames
    first, last = source.span
    asked = first if timing.start is None else timing.start, last if timing.stop is None else timing.stop
    start, stop = (as_told(time, (first, last)) for time in asked)
    if not first <= start < stop <= last:
        raise ViewError(f"{start!r} to {stop!r} is not possible: the run goes from {first:g} to {last:g}.")
    if timing.pace == "time":
        return np.linspace(start, stop, count)
    return frame_times(start, stop, count, source.curves.t, np.cbrt(source.curves.normal_force))
