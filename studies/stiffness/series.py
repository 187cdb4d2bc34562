"""The limit of a sequence whose rates are known: y(s) = L + c_1 s^-p_1 + c_2 s^-p_2 + ...

A least-squares line through the first powers says nothing of those behind them, and where the rates are close (1/3 and
2/5) those behind are what it is off by. So the whole series is fitted: its coefficients are unknowns of one common
size at the softest case, a normal distribution of a width that is itself inferred; L is free. Soft cases then count for
what they can tell, none has to be left out, and the interval holds what the terms not seen may still do.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.stats import norm

Array = NDArray[np.float64]

TERMS = 8
"""Powers of the series. At the second case of a ladder the last is some hundred times smaller than the first."""

FEWEST = 4
"""Cases for which an interval is stated: L, two powers, and one to hold them to."""

_SIZES = np.geomspace(0.03, 30, 16)  # of a coefficient, over the span of the values
_UNDERSTATED = (1, 2, 4, 8)  # by what the cases may understate their errors, each half as likely as the one before
_ROUND_OFF = 1e-9  # of the span


class Extrapolated(NamedTuple):
    """What is inferred of a stiffness beyond those that were seen."""

    value: float
    uncertainty: float
    """Half width of its interval."""


class _Posterior(NamedTuple):
    """For each choice of the coefficients' size and the errors'."""

    evidence: Array  # logarithm, up to a constant
    mean: Array
    deviation: Array


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
        Stiffness, growing, and the measure there; cases whose measure is not finite are left out.
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
        With fewer than ``FEWEST`` cases its uncertainty is infinite and the value the last one.
    """
    x, v, e = np.asarray(s, float), np.asarray(y, float), np.nan_to_num(np.abs(np.asarray(error, float)))
    use = np.isfinite(v)
    x, v, e = x[use], v[use], e[use]
    if v.size < FEWEST:
        return Extrapolated(float(v[-1]) if v.size else nan, inf)
    span = float(np.ptp(v))
    if span == 0:
        return Extrapolated(float(v[-1]), float(e.max()))
    powers, there = terms(x / x[0], exponents), terms(to / x[0], exponents)
    understated, size = (grid.ravel() for grid in np.meshgrid(_UNDERSTATED, _SIZES * span))
    common = understated[:, None] * e
    own = np.hypot(common, _ROUND_OFF * span)
    evidence, means, deviations = _posterior(
        v - v[-1], common, own, size[:, None, None] * powers, size[:, None] * there
    )
    weights = evidence - np.log(understated)
    likely = np.exp(weights - weights.max())
    likely /= likely.sum()
    middle = float(likely @ means)

    def outside(half: float) -> float:
        above, below = (middle + half - means) / deviations, (middle - half - means) / deviations
        return float(likely @ (norm.sf(above) + norm.cdf(below))) - (1 - confidence)

    widest = float(np.max(np.abs(means - middle) + 10 * deviations))
    return Extrapolated(middle + float(v[-1]), float(brentq(outside, 0.0, widest, rtol=1e-6)))


def _posterior(y: Array, common: Array, own: Array, powers: Array, there: Array) -> _Posterior:
    """Least squares for L, the coefficients and the common error, the latter two of unit size beforehand.

    ``common`` and ``own`` are (cases, n) errors, ``powers`` (cases, n, TERMS), ``there`` (cases, TERMS); a case is one
    choice of sizes.
    """
    cases, n, count = powers.shape
    unknowns = 2 + count
    design = np.zeros((cases, n + unknowns - 1, unknowns))
    design[:, :n, 0] = 1 / own
    design[:, :n, 1:-1] = powers / own[:, :, None]
    design[:, :n, -1] = common / own
    design[:, n:] = np.eye(unknowns)[1:]
    right = np.concatenate([y / own, np.zeros((cases, unknowns - 1))], axis=1)[..., None]
    orthogonal, upper = np.linalg.qr(design)
    along = np.swapaxes(orthogonal, 1, 2) @ right
    functional = np.zeros((cases, unknowns, 1))
    functional[:, 0], functional[:, 1:-1, 0] = 1.0, there
    reach = np.linalg.solve(np.swapaxes(upper, 1, 2), functional)
    left = np.square(right - orthogonal @ along).sum(axis=(1, 2))
    sizes = np.log(np.abs(np.diagonal(upper, axis1=1, axis2=2))).sum(axis=1) + np.log(own).sum(axis=1)
    return _Posterior(-left / 2 - sizes, (reach * along).sum(axis=(1, 2)), np.linalg.norm(reach, axis=(1, 2)))
