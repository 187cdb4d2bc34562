"""Cases of a sequence: in their order, those that say something, and those that say the same."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, nan

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

CONFIDENCE = 0.95
"""Level of every interval here."""

FEWEST = 4
"""Cases for which an interval is stated: L, two powers, and one to hold them to; see :func:`.series.fewest`."""

_ALIKE = 1e-12  # of the largest value: what lies no further apart is one, as J_F/J_N where all pulses slide throughout


def settled(y: ArrayLike, rigid: float) -> tuple[Array, float]:
    """The values, all of them the last one where no more than round-off is between them, and that round-off.

    Where that is so of the stiffest, at least ``FEWEST`` of them, softer ones are of another kind, such as a slip that
    stops for a moment, and left out. The round-off is 0 where all are the rigid value to the last bit.
    """
    values = np.asarray(y, float)
    known = values[np.isfinite(values)]
    alike = _ALIKE * float(np.max(np.abs(known), initial=0.0))
    if known.size:
        apart = np.isfinite(values) & (np.abs(values - known[-1]) > alike)
        first = int(np.flatnonzero(apart)[-1]) + 1 if apart.any() else 0
        if first == 0 or np.isfinite(values[first:]).sum() >= FEWEST:
            values = np.where(np.isfinite(values) & (np.arange(values.size) >= first), known[-1], nan)
            known = values[np.isfinite(values)]
    return values, alike if np.any(known != rigid) else 0.0


def ascending(
    s: ArrayLike, y: ArrayLike, error: ArrayLike | None, exponents: Sequence[float] | None = None
) -> tuple[Array, Array, Array | None]:
    """Stiffness, measure and its error of the cases in any order, softest first; ``exponents`` are looked at alone.

    Raises
    ------
    ValueError
        Not as many of each, a stiffness that is none, or one twice; exponents that are no rates, slowest first.
    """
    try:
        x, v, e = np.asarray(s, float), np.asarray(y, float), None if error is None else np.asarray(error, float)
    except (TypeError, ValueError):  # words, or rows of several lengths
        raise ValueError("s, y and error of these values are not possible: they are lists of numbers.") from None
    lengths = [each.shape for each in (x, v, e) if each is not None]
    if x.ndim != 1 or len(set(lengths)) > 1:
        told = ", ".join(map(str, lengths))
        raise ValueError(f"s, y and error of shapes {told} are not possible: there is one of each for every case.")
    if not np.all(np.isfinite(x) & (x > 0)):
        raise ValueError(f"s = {x[~(np.isfinite(x) & (x > 0))][0]:g} is not possible: a stiffness is above 0.")
    if e is not None and np.any(e < 0):
        raise ValueError(f"error = {e[e < 0][0]:g} is not possible: an error is at least 0.")
    if exponents is not None:
        try:
            rates = np.asarray(exponents, float)
        except (TypeError, ValueError):
            rates = np.array([])
        if rates.ndim != 1 or not rates.size or not np.all((rates > 0) & (rates < inf)) or np.any(np.diff(rates) < 0):
            raise ValueError(
                f"exponents = {exponents!r} is not possible: they are a list of rates above 0, slowest first."
            )
    order = np.argsort(x)
    if np.any(np.diff(x[order]) == 0):
        raise ValueError(
            f"s = {x[order][:-1][np.diff(x[order]) == 0][0]:g} comes twice: a ladder has each stiffness once."
        )
    return x[order], v[order], None if e is None else e[order]


def known_alike(foundation: ArrayLike, error: ArrayLike) -> Array:
    """Errors of cases that come about by chance, each told by the difference of two runs, which may agree by chance.

    Where points break one at a time they are parts of the patch, which goes like foundation^(-1/3): over that, no error
    is less than the root of the mean square of all.
    """
    patch, e = np.asarray(foundation, float) ** (-1 / 3), np.asarray(error, float)
    seen = np.isfinite(e)
    return np.maximum(e, np.sqrt(np.mean((e[seen] / patch[seen]) ** 2)) * patch) if seen.any() else e


def finite(s: ArrayLike, y: ArrayLike, error: ArrayLike) -> tuple[Array, Array, Array]:
    """The cases that say something: their measure is finite, and so is its error, or not known and taken for none."""
    x, v, e = np.asarray(s, float), np.asarray(y, float), np.abs(np.asarray(error, float))
    use = np.isfinite(v) & ~np.isinf(e)
    return x[use], v[use], np.nan_to_num(e[use])
