"""The limit of a sequence whose rates are known: y(s) = L + c_1 s^-p_1 + c_2 s^-p_2 + ...

A least-squares line through the first powers says nothing of those behind them, and where the rates are close (1/3 and
2/5) those behind are what it is off by. So the whole series is fitted: its coefficients are unknowns of one common
size at the softest case, a normal distribution of a width that is itself inferred; L is free. Soft cases then count for
what they can tell, and the interval holds what the terms not seen may still do. Left out are soft cases of another
kind, such as hoops that leave the floor or break a stick that stiffer ones keep: those that are not what stiffer ones
foresee of them, or move the limit out of the interval that these have for it. (The first alone lets a jump pass where
eight terms foresee all sorts of things.) What the limit owes to the softest that are left is part of its interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf, nan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .cases import FEWEST, finite
from .posterior import Extrapolated, inferred, weighed

Array = NDArray[np.float64]

TERMS = 8
"""Powers of the series. At the second case of a ladder the last is some hundred times smaller than the first."""

_SIZES = np.geomspace(0.03, 30, 16)  # of a coefficient, over the span of the values
_LARGE = np.geomspace(1, 30, 8)  # the same where single powers are asked for: large ones of both signs look small
_MISSED = 3.0  # half widths by which a case may miss what stiffer ones foresee of it
_MOVED = 1.0  # half widths of the stiffer ones' limit by which it may move that
_CONFIRM = 2  # cases beyond the fewest that a series has at least where softer ones are of another kind
_SOFTEST = 2  # cases whose part in the limit is part of its interval


def fewest(exponents: Sequence[float]) -> int:
    """Cases that say more than is assumed of them: L, the powers that lead, two at least, and one to hold them to."""
    return max(FEWEST, len(exponents) + 2)


def terms(x: ArrayLike, exponents: Sequence[float]) -> Array:
    """(..., TERMS) x^-p for the given rates, slowest first, and those behind them in steps of the last, of one alone
    for its multiples; a rate that is given twice comes with log x too.
    """
    distinct = sorted(set(exponents))
    step = distinct[-1] - (distinct[-2] if len(distinct) > 1 else 0.0)
    behind = [distinct[-1] + step * (i + 1) for i in range(TERMS - len(exponents))]
    rates = np.array([*exponents, *behind])
    again = np.append(False, np.diff(rates) == 0)
    x = np.asarray(x, float)[..., None]
    if np.all(np.isinf(x)):
        return np.zeros((*x.shape[:-1], rates.size))
    return x**-rates * np.where(again, np.log(x), 1.0)


def extrapolated(
    s: ArrayLike, y: ArrayLike, error: ArrayLike, exponents: Sequence[float], confidence: float, to: float = inf
) -> Extrapolated:
    """The sequence at a greater s, by default its limit L.

    Parameters
    ----------
    s, y : (n,) array_like
        Stiffness, growing, and the measure there; cases of no finite measure, or an infinite error, are left out.
    error : (n,) array_like
        Numerical error of each ``y``, of which one part is taken to be common to all cases and one each case's own.
    exponents : sequence of float
        The leading rates p, slowest first; see :func:`terms`.
    confidence : float
        Level of the interval.
    to : float
        Where the value is asked for.

    Returns
    -------
    Extrapolated
        With fewer than ``FEWEST`` cases its uncertainty is infinite, and the value NaN.
    """
    return of_one_series(one_series(s, y, error, exponents, confidence), exponents, confidence, to)


def of_one_series(
    cases: tuple[Array, Array, Array], exponents: Sequence[float], confidence: float, to: float = inf
) -> Extrapolated:
    """The same of cases that :func:`one_series` has found."""
    x, v, e = cases
    found = _by_all(x, v, e, exponents, confidence, to)
    fewer = range(1, min(_SOFTEST, v.size - fewest(exponents)) + 1)
    moved = [abs(_by_all(x[n:], v[n:], e[n:], exponents, confidence, to).value - found.value) for n in fewer]
    return found._replace(uncertainty=hypot(found.uncertainty, max(moved, default=0.0)))


def one_series(
    s: ArrayLike, y: ArrayLike, error: ArrayLike, exponents: Sequence[float], confidence: float
) -> tuple[Array, Array, Array]:
    """Stiffness, measure and error of the stiffest cases, down to the first that is of another kind."""
    x, v, e = finite(s, y, error)
    first = max(v.size - fewest(exponents), 0)
    limit = _by_all(x[first:], v[first:], e[first:], exponents, confidence, inf)
    while first > 0:
        told = _by_all(x[first:], v[first:], e[first:], exponents, confidence, float(x[first - 1]))
        if abs(v[first - 1] - told.value) > _MISSED * told.uncertainty + e[first - 1]:
            break
        with_it = _by_all(x[first - 1 :], v[first - 1 :], e[first - 1 :], exponents, confidence, inf)
        if abs(with_it.value - limit.value) > _MOVED * limit.uncertainty:
            break
        first, limit = first - 1, with_it
    return x[first:], v[first:], e[first:]


def is_confirmed(used: int, known: int, exponents: Sequence[float]) -> bool:
    """Whether so many of the ``known`` cases are of one series: all are, or more than it takes to make one of them.

    Where softer ones are of another kind, so may be one of the fewest, of which eight terms make a series always.
    """
    return used == known or used >= fewest(exponents) + _CONFIRM


def _by_all(x: Array, v: Array, e: Array, exponents: Sequence[float], confidence: float, to: float) -> Extrapolated:
    """What all of the cases say of another."""
    if v.size < FEWEST:
        return Extrapolated(nan, inf)
    span = float(np.ptp(v))
    if span == 0:
        return Extrapolated(float(v[-1]), float(e.max()))
    powers, there = terms(x / x[0], exponents), terms(to / x[0], exponents)
    return inferred(v, e, _SIZES * span, powers, np.append(1.0, there), confidence)


def inferred_series(s: ArrayLike, y: ArrayLike, error: ArrayLike, exponents: Sequence[float], to: Array) -> Array:
    """The values of :func:`extrapolated` at many s (n,), without their uncertainty."""
    x, v, e = finite(s, y, error)
    span = float(np.ptp(v)) if v.size else 0.0
    if v.size < FEWEST or span == 0:
        return np.full(len(to), v[-1] if v.size else nan)
    there = np.column_stack([np.ones(len(to)), terms(to / x[0], exponents)])
    likely, means, _ = weighed(v - v[-1], e, _SIZES * span, terms(x / x[0], exponents), there)
    found: Array = likely @ means + v[-1]
    return found


def leading_part(
    s: ArrayLike, distance: ArrayLike, error: ArrayLike, exponents: Sequence[float], count: int, confidence: float
) -> Extrapolated:
    """What the first ``count`` powers alone make of the distance from a limit that is known, at the greatest s.

    The powers behind them, which a distance divided by its leading power has in it too, are inferred with them and left
    out. Parameters as of :func:`extrapolated`; with fewer than ``FEWEST`` - 1 cases the uncertainty is infinite.
    """
    x, d, e = finite(s, distance, error)
    span = float(np.max(np.abs(d), initial=0.0))
    if d.size < FEWEST - 1 or span == 0:
        return Extrapolated(float(d[-1]) if d.size else nan, inf)
    powers = terms(x / x[0], exponents)
    kept = np.where(np.arange(TERMS) < count, powers[-1], 0.0)
    return inferred(d, e, _LARGE * span, powers, np.append(0.0, kept), confidence)
