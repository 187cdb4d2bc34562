"""What a picture is coloured by, and the scales it takes from the whole run."""

from __future__ import annotations

from collections.abc import Mapping
from math import log10

import numpy as np
from numpy.typing import NDArray

from ..fields import Block
from ..times import frame_times
from .display import ViewError
from .shots import Curves, Shot, Source

Array = NDArray[np.float64]


def field_names(block: Block) -> list[str]:
    """What a ring can be coloured by: scalars, magnitudes of vectors, components of the stress."""
    names: list[str] = []
    for name in block.point_data:
        names += [f"stress {c}" for c in ("xx", "yy", "xy")] if name == "stress" else [name]
    return sorted(names, key=lambda name: (name != "von_mises", name in ("displacement", "velocity")))


def scalar(block: Block, field: str) -> Array:
    """The numbers that colour the points.

    Raises
    ------
    ViewError
        A field that the series does not hold.
    """
    if field not in (names := field_names(block)):
        known = ", ".join(names) or "none"
        raise ViewError(f"there is no field {field!r} to colour the ring by; of the ring the series holds: {known}.")
    if field.startswith("stress "):
        column = {"xx": 0, "yy": 1, "xy": 2}[field.removeprefix("stress ")]
        return np.asarray(block.point_data["stress"][:, column], dtype=float)
    value = np.asarray(block.point_data[field], dtype=float)
    return value if value.ndim == 1 else np.asarray(np.linalg.norm(value, axis=1))


def sampled(source: Source, count: int = 30) -> list[Shot]:
    """Shots spread over the whole run and dense in its pulses, to choose scales by."""
    curves, (start, stop) = source.curves, source.span
    if start == stop:
        return [source.shot(start)]
    instants = [source.instant(t) for t in frame_times(start, stop, count, curves.t, curves.normal_force)]
    seen = {t: source.shot(t) for t in dict.fromkeys(instants)}  # a frame is read once, however often it is nearest
    return [seen[t] for t in instants]


def tidy_factor(shots: list[Shot], share: float = 0.06) -> float:
    """1, 2 or 5 times a power of ten that shows the largest displacement as that share of R or less; at least 1."""
    largest = max(float(np.linalg.norm(shot.displacement, axis=1).max()) / shot.radius for shot in shots)
    return tidy(share / largest) if largest > 0 else 1.0


def tidy(factor: float) -> float:
    """The next 1, 2 or 5 times a power of ten below, at least 1."""
    if not factor > 1:
        return 1.0
    exponent, rest = divmod(log10(factor), 1.0)
    return float(max(step for step in (1, 2, 5) if log10(step) <= rest + 1e-12) * 10**exponent)


def limits(shots: list[Shot], field: str, signed: bool) -> tuple[float, float]:
    """Range of the colours over the run; the highest thousandth, at the weld's ends, may be outside."""
    values = np.concatenate([scalar(shot.ring, field) for shot in shots])
    values = values[np.isfinite(values)]
    if not values.size:
        return 0.0, 1.0
    if signed:
        most = float(np.quantile(np.abs(values), 0.999)) or 1.0
        return -most, most
    return min(0.0, float(values.min())), float(np.quantile(values, 0.999)) or 1.0


def scale_of(curves: Curves, shots: list[Shot]) -> Mapping[str, float]:
    """Largest force and slip velocity of the run, and the usual force if far below: for the arrows."""
    force = np.hypot(curves.normal_force, curves.friction_force)
    slip = [abs(shot.slip_velocity) for shot in shots if shot.slip_velocity is not None]
    return {
        "force": float(np.nanmax(force)) if len(force) else 0.0,
        "slip": max(slip, default=0.0),
        "usual": curves.usual or 0.0,
    }
