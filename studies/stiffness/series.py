"""The limit of a sequence whose rates are known: y(s) = L + c_1 s^-p_1 + c_2 s^-p_2 + ...

A least-squares line through the first powers says nothing of those behind them, and where the rates are close (1/3 and
2/5) those behind are what it is off by. So the whole series is fitted: its coefficients are unknowns of one common
size at the softest case, a normal distribution of a width that is itself inferred; L is free. Soft cases then count for
what they can tell, and the interval holds what the terms not seen may still do. Left out are soft cases of another
kind, such as hoops that leave the floor: those that are not what stiffer ones foresee of them. What the limit owes to
the softest that are left is part of its interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf, nan, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtr

Array = NDArray[np.float64]

TERMS = 8
"""Powers of the series. At the second case of a ladder the last is some hundred times smaller than the first."""

FEWEST = 4
"""Cases for which an interval is stated: L, two powers, and one to hold them to; see :func:`fewest`."""

_SIZES = np.geomspace(0.03, 30, 16)  # of a coefficient, over the span of the values
_MISSED = 3.0  # half widths by which a case may miss what stiffer ones foresee of it
_SOFTEST = 2  # cases whose part in the limit is part of its interval
_LARGE = np.geomspace(1, 30, 8)  # the same where single powers are asked for: large ones of both signs look small
_UNDERSTATED = (1, 2, 4, 8)  # by what the cases may understate their errors, each half as likely as the one before
_ROUND_OFF = 3e-11  # of the largest size
_ALIKE = 1e-12  # of the largest value: what lies no further apart is one, as J_F/J_N where all pulses slide throughout


class Extrapolated(NamedTuple):
    """What is inferred of a stiffness beyond those that were seen."""

    value: float
    uncertainty: float
    """Half width of its interval."""


class _Posterior(NamedTuple):
    """For each choice of the coefficients' size and the errors'."""

    evidence: Array  # (cases,) logarithm, up to a constant
    mean: Array  # (cases, m)
    deviation: Array  # (cases, m)


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
    x, v, e = one_series(s, y, error, exponents, confidence)
    found = _by_all(x, v, e, exponents, confidence, to)
    fewer = range(1, min(_SOFTEST, v.size - fewest(exponents)) + 1)
    moved = [abs(_by_all(x[n:], v[n:], e[n:], exponents, confidence, to).value - found.value) for n in fewer]
    return found._replace(uncertainty=hypot(found.uncertainty, max(moved, default=0.0)))


def one_series(
    s: ArrayLike, y: ArrayLike, error: ArrayLike, exponents: Sequence[float], confidence: float
) -> tuple[Array, Array, Array]:
    """Stiffness, measure and error of the stiffest cases, down to the first that is not what they foresee of it."""
    x, v, e = finite(s, y, error)
    first = max(v.size - fewest(exponents), 0)
    while first > 0:
        told = _by_all(x[first:], v[first:], e[first:], exponents, confidence, float(x[first - 1]))
        if abs(v[first - 1] - told.value) > _MISSED * told.uncertainty + e[first - 1]:
            break
        first -= 1
    return x[first:], v[first:], e[first:]


def _by_all(x: Array, v: Array, e: Array, exponents: Sequence[float], confidence: float, to: float) -> Extrapolated:
    """What all of the cases say of another."""
    if v.size < FEWEST:
        return Extrapolated(nan, inf)
    span = float(np.ptp(v))
    if span == 0:
        return Extrapolated(float(v[-1]), float(e.max()))
    powers, there = terms(x / x[0], exponents), terms(to / x[0], exponents)
    return _inferred(v, e, _SIZES * span, powers, np.append(1.0, there), confidence)


def inferred_series(s: ArrayLike, y: ArrayLike, error: ArrayLike, exponents: Sequence[float], to: Array) -> Array:
    """The values of :func:`extrapolated` at many s (n,), without their uncertainty."""
    x, v, e = finite(s, y, error)
    span = float(np.ptp(v)) if v.size else 0.0
    if v.size < FEWEST or span == 0:
        return np.full(len(to), v[-1] if v.size else nan)
    there = np.column_stack([np.ones(len(to)), terms(to / x[0], exponents)])
    likely, means, _ = _weighed(v - v[-1], e, _SIZES * span, terms(x / x[0], exponents), there)
    found: Array = likely @ means + v[-1]
    return found


def ascending(
    s: ArrayLike, y: ArrayLike, error: ArrayLike | None, exponents: Sequence[float] | None = None
) -> tuple[Array, Array, Array | None]:
    """Stiffness, measure and its error of the cases in any order, softest first; ``exponents`` are looked at alone.

    Raises
    ------
    ValueError
        Not as many of each, a stiffness that is none, or one twice; exponents that are no rates, slowest first.
    """
    x, v, e = np.asarray(s, float), np.asarray(y, float), None if error is None else np.asarray(error, float)
    lengths = [each.shape for each in (x, v, e) if each is not None]
    if x.ndim != 1 or len(set(lengths)) > 1:
        told = ", ".join(map(str, lengths))
        raise ValueError(f"s, y and error of shapes {told} are not possible: there is one of each for every case.")
    if not np.all(np.isfinite(x) & (x > 0)):
        raise ValueError(f"s = {x[~(np.isfinite(x) & (x > 0))][0]:g} is not possible: a stiffness is above 0.")
    if exponents is not None:
        rates = np.asarray(exponents, float)
        if rates.ndim != 1 or not rates.size or not np.all((rates > 0) & (rates < inf)) or np.any(np.diff(rates) < 0):
            raise ValueError(f"exponents = {exponents!r} is not possible: rates are above 0, slowest first.")
    order = np.argsort(x)
    if np.any(np.diff(x[order]) == 0):
        raise ValueError(
            f"s = {x[order][:-1][np.diff(x[order]) == 0][0]:g} comes twice: a ladder has each stiffness once."
        )
    return x[order], v[order], None if e is None else e[order]


def finite(s: ArrayLike, y: ArrayLike, error: ArrayLike) -> tuple[Array, Array, Array]:
    """The cases that say something: their measure is finite, and so is its error, or not known and taken for none."""
    x, v, e = np.asarray(s, float), np.asarray(y, float), np.abs(np.asarray(error, float))
    use = np.isfinite(v) & ~np.isinf(e)
    return x[use], v[use], np.nan_to_num(e[use])


def narrowest(fits: dict[int, tuple[float, float]]) -> tuple[int, float]:
    """Of fits ``{points: (value, half width)}`` the one of the narrowest interval, and half that interval's width.

    The value's change when up to two points more or fewer are fitted counts into the interval: softer points
    follow the law less well, and the scatter about one fit does not show that.
    """
    halves = {}
    for n, (value, half) in fits.items():
        near = [abs(value - other) for m, (other, _) in fits.items() if 0 < abs(m - n) <= 2]
        halves[n] = sqrt(half**2 + max(near, default=0.0) ** 2)
    points = min(halves, key=lambda n: halves[n])
    return points, halves[points]


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
    return _inferred(d, e, _LARGE * span, powers, np.append(0.0, kept), confidence)


def _inferred(
    y: Array, error: Array, sizes: Array, powers: Array, functional: Array, confidence: float
) -> Extrapolated:
    """A linear functional of L and the coefficients, over all sizes of these and of the errors; where L is not in it, L
    is known and 0."""
    from scipy.optimize import brentq  # by whoever infers, and not by every process that is told

    origin = float(y[-1]) if functional[0] else 0.0
    likely, several, spread = _weighed(y - origin, error, sizes, powers, functional[None])
    means, deviations = several[:, 0], spread[:, 0]
    middle = float(likely @ means)

    def outside(half: float) -> float:
        above, below = (middle + half - means) / deviations, (middle - half - means) / deviations
        return float(likely @ (ndtr(-above) + ndtr(below))) - (1 - confidence)

    widest = float(np.max(np.abs(means - middle) + 10 * deviations))
    return Extrapolated(middle + origin, float(brentq(outside, 0.0, widest, rtol=1e-6)))


def _weighed(
    y: Array, error: Array, sizes: Array, powers: Array, functionals: Array
) -> tuple[Array, Array, Array]:  # fmt: skip
    """How likely each choice of sizes is, (cases,), and what each makes of linear functionals (m, 1 + TERMS): means and
    deviations, (cases, m)."""
    understated, size = (grid.ravel() for grid in np.meshgrid(_UNDERSTATED, sizes))
    common = understated[:, None] * error
    own = np.hypot(common, _ROUND_OFF * float(np.ptp(sizes)))
    weighed = np.repeat(functionals[None], size.size, axis=0)
    weighed[:, :, 1:] *= size[:, None, None]
    evidence, means, deviations = _posterior(y, common, own, size[:, None, None] * powers, weighed)
    weights = evidence - np.log(understated)
    likely = np.exp(weights - weights.max())
    return likely / likely.sum(), means, deviations


def _posterior(y: Array, common: Array, own: Array, powers: Array, functionals: Array) -> _Posterior:
    """Least squares for L, the coefficients and the common error, the latter two of unit size beforehand.

    ``common`` and ``own`` are (cases, n) errors, ``powers`` (cases, n, TERMS), ``functionals`` (cases, m, 1 + TERMS); a
    case is one choice of sizes. L is no unknown where the functionals do not have it.
    """
    cases, n, count = powers.shape
    free = int(bool(functionals[0, 0, 0]))
    unknowns = free + count + 1
    design = np.zeros((cases, n + count + 1, unknowns))
    if free:
        design[:, :n, 0] = 1 / own
    design[:, :n, free:-1] = powers / own[:, :, None]
    design[:, :n, -1] = common / own
    design[:, n:] = np.eye(unknowns)[free:]
    right = np.concatenate([y / own, np.zeros((cases, count + 1))], axis=1)[..., None]
    orthogonal, upper = np.linalg.qr(design)
    along = np.swapaxes(orthogonal, 1, 2) @ right
    asked = np.zeros((cases, unknowns, functionals.shape[1]))
    asked[:, :-1] = np.swapaxes(functionals[:, :, 1 - free :], 1, 2)
    reach = np.linalg.solve(np.swapaxes(upper, 1, 2), asked)
    left = np.square(right - orthogonal @ along).sum(axis=(1, 2))
    sizes = np.log(np.abs(np.diagonal(upper, axis1=1, axis2=2))).sum(axis=1) + np.log(own).sum(axis=1)
    return _Posterior(-left / 2 - sizes, (reach * along).sum(axis=1), np.linalg.norm(reach, axis=1))
