"""What stays the same about a view from one instant to the next: scales, colours and reach of a whole run."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real
from pathlib import Path

import numpy as np

from rigid import Motion

from ..draw import style
from ..draw.display import ViewError
from ..draw.lens import enlargement
from ..draw.patch import patch_of
from ..draw.renderer import Colours
from ..draw.scales import field_names, limits, sampled, scale_of, tidy_factor
from ..draw.shots import Shot, Source, source_of
from ..series import Series


@dataclass(frozen=True)
class Setting:
    """Everything about a view that stays the same from one instant to the next."""

    source: Source
    first: Shot
    colours: Colours | None
    factor: float
    largest: dict[str, float]
    reach: tuple[float, float]  # of the hoop over the whole run, in x
    zoom: float  # 1 shows the whole hoop
    lens_factor: float  # exaggeration inside the lens
    patches: tuple[Shot, ...] = ()  # spread over the run, if they know the contact's pressure


def as_told(time: float, span: tuple[float, ...]) -> float:
    """A time, or the end of the span of which it is what is printed, to six digits.

    Raises
    ------
    ViewError
        It is no number.
    """
    if not isinstance(time, Real):
        raise ViewError(f"time = {time!r} is not possible: it is a number.")
    return next((end for end in span if time == float(f"{end:.6g}")), time)


def setting(
    thing: Series | Motion | str | Path, field: str | None = None, factor: float | None = None, zoom: float = 1.0
) -> Setting:
    """Scales and colours taken from the whole run.

    Raises
    ------
    ViewError
        A field that is not there, a factor or an enlargement that is no number.
    SeriesError
        A damaged series, or nothing that can be drawn.
    """
    if factor is not None and not (isinstance(factor, Real) and np.isfinite(factor) and factor >= 0):
        raise ViewError(f"factor = {factor!r} is not possible: it must be a number from 0.")
    if not (isinstance(zoom, Real) and np.isfinite(zoom) and zoom >= 1):
        raise ViewError(f"zoom = {zoom!r} is not possible: it must be a number from 1.")
    source = source_of(thing)
    shots = sampled(source)
    first = shots[0]
    names = field_names(first.ring)
    chosen = field or (names[0] if names else None)
    colours = None
    if chosen is not None:
        colours = Colours(chosen, *limits(shots, chosen, style.signed(chosen)))
    lens_factor = tidy_factor(shots, 0.06 / enlargement(first)) if factor is None else factor
    if factor is None:
        stored = first.ring.field_data.get("display_factor")
        factor = tidy_factor(shots, 0.06 / zoom) if stored is None or zoom > 1 else float(stored[0])
    x = [float(shot.centre[0]) for shot in shots]
    reach = (min(x) - 1.7 * first.radius, max(x) + 1.2 * first.radius)  # on the left there is text
    largest = dict(scale_of(source.curves, shots))
    patches = tuple(shot for shot in shots if len(patch_of(shot)[0]))
    return Setting(source, first, colours, factor, largest, reach, zoom, lens_factor, patches)
