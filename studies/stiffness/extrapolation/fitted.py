"""Rates of a sequence by lines through its logarithms, and its limit ``y = L + c s^-p`` with p fitted too."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, nan, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import stdtrit

from .cases import CONFIDENCE, finite

Array = NDArray[np.float64]

SLOWEST = 1 / 3
"""Rate with which a fitted one is compared: that of a patch's half-width, s^(-1/3), the slowest that the compliances of
an elastic hoop have by themselves."""


_RATES = (0.05, 3.0)


_SPARE = 2
"""Cases that a fit must have beyond its unknowns before its scatter is taken for an interval: with one, the
t-distribution is 12.7 wide at 95 % and its own shape unknown."""


_MISFIT = 0.02
"""How much the distance to the limit may miss the law, relative to itself: sets the weight of soft against stiff points
and of misfit against numerical error; the width of an interval follows from the scatter that is found."""


@dataclass(frozen=True, slots=True)
class Rate:
    """How fast a distance d(s) goes to zero: d = c s^-p, fitted on log-log axes."""

    value: float
    """Observed rate p; NaN where there is none: too few points, or an interval that is not above 0."""
    interval: tuple[float, float]
    """Its t-interval at the level CONFIDENCE, widened by the change of p when a point more or fewer is used;
    infinite where there is no rate."""
    cases: tuple[int, ...]
    """Which points were used, by their place in the sequence."""


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


def observed_rate(s: ArrayLike, distance: ArrayLike, error: ArrayLike | None = None) -> Rate:
    """Rate of ``distance -> 0`` by a line through log distance against log s of the stiffest points.

    As many points are used as give the narrowest interval, and none beyond a change of sign, at which a distance has
    no rate. Points whose numerical ``error`` exceeds half their distance say nothing of the distance and are left out.
    """
    s, off = np.asarray(s, float), np.asarray(distance, float)
    d = np.abs(off)
    e = np.zeros_like(d) if error is None else np.abs(np.asarray(error, float))
    told = np.flatnonzero(np.isfinite(d) & (d > 0) & ~(e > 0.5 * d))
    turns = np.flatnonzero(np.diff(np.sign(off[told])))
    use = told[turns[-1] + 1 if turns.size else 0 :]
    x, y, share = np.log(s[use]), np.log(d[use]), e[use] / d[use]
    fits = {n: _slope(x[-n:], y[-n:], share[-n:]) for n in range(3 + _SPARE, x.size + 1)}
    if not fits:
        return Rate(nan, (-inf, inf), tuple(use.tolist()))
    points, half = narrowest(fits)
    rate = fits[points][0]
    if not rate - half > 0:  # whether it falls at all is not told
        return Rate(nan, (-inf, inf), tuple(use.tolist()))
    return Rate(rate, (rate - half, rate + half), tuple(use[-points:].tolist()))


def _slope(x: Array, y: Array, error: Array) -> tuple[float, float]:
    """p and the half width of its interval in y = a - p x + b exp(-p x): a power law and its series' next term.

    Without that term the soft points would bend the line by more than their scatter about it shows.
    """
    x = x - x[-1]
    p = float(np.clip(-np.polyfit(x, y, 1)[0], *_RATES))
    for _ in range(3):  # p in the small term is that of the round before
        design = np.column_stack([np.ones_like(x), -x, np.exp(-p * x)])
        found = np.linalg.lstsq(design, y, rcond=None)[0]
        p = float(np.clip(found[1], *_RATES))
    residual = y - design @ found
    free = x.size - 3
    weights = np.linalg.pinv(design)[1]
    scatter = _t(free) * sqrt(float(residual @ residual) / free * float(weights @ weights))
    numerical = float(np.abs(weights) @ error)  # the worst the cases' own errors can do together
    return p, sqrt(scatter**2 + numerical**2) + abs(float(found[1]) - p)


def _carried(weights: Array, error: Array) -> float:
    """What the cases' own errors make of a weighted sum: those in common, and those that each has for itself."""
    return sqrt(float(weights @ error) ** 2 + float(weights**2 @ error**2))


def richardson(
    s: ArrayLike, y: ArrayLike, error: ArrayLike | None = None, exponent: float | None = None
) -> tuple[float, float, float]:
    """Limit of ``y(s)`` for s to infinity from ``y = L + c s^-p``, without knowing L.

    Softer points follow the law less well, stiffer ones carry more numerical error: every number of stiffest
    points is tried and the one with the narrowest interval is taken.

    Parameters
    ----------
    s, y : (n,) array_like
        Stiffness, growing, and the measure there.
    error : (n,) array_like, optional
        Numerical error of each ``y``.
    exponent : float, optional
        p where it is known; otherwise it is fitted too, between 0.05 and 3.

    Returns
    -------
    limit, uncertainty, exponent : float
        The uncertainty covers the scatter about the fit (t-interval), the change of the limit when one point
        more or fewer is fitted, and the numerical error carried into the limit. With too few points it is infinite,
        and the limit is NaN.
    """
    x, v, e = finite(s, y, np.zeros(np.shape(y)) if error is None else error)
    unknowns = 2 if exponent is not None else 3
    fits = {n: _fit(x[-n:], v[-n:], e[-n:], exponent) for n in range(unknowns + _SPARE, v.size + 1)}
    if not fits:
        return nan, inf, nan if exponent is None else exponent
    points, half = narrowest({n: (limit, half) for n, (limit, half, _) in fits.items()})
    return fits[points][0], half, fits[points][2]


def _fit(s: Array, y: Array, error: Array, exponent: float | None) -> tuple[float, float, float]:
    """L, half width of its interval, and p, by weighted least squares; linear in L and c for each p."""
    x = s / s[-1]
    spread = np.ptp(y)
    if spread == 0:
        return float(y[-1]), float(error.max()), nan if exponent is None else exponent

    def solve(p: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """L, c, residuals and sigma for each p: the line through y over x^-p, about its centre of weight."""
        power = x ** -np.asarray(p, float)[..., None]
        # a residual counts relative to the distance still to go, as softer points miss the law by more
        sigma = np.hypot(error, _MISFIT * spread * power / (power[..., :1] - 1))
        weight = sigma**-2 / (sigma**-2).sum(-1, keepdims=True)
        from_centre = power - (weight * power).sum(-1, keepdims=True)
        height = (weight * y).sum(-1, keepdims=True)
        c = (weight * from_centre * (y - height)).sum(-1) / (weight * from_centre**2).sum(-1)
        residual = (y - height - c[..., None] * from_centre) / sigma
        return (height + c[..., None] * (from_centre - power))[..., 0], c, residual, sigma

    if exponent is None:
        from scipy.optimize import minimize_scalar

        grid = np.linspace(*_RATES, 60)
        i = int(np.argmin(_cost(solve(grid))))
        bounds = (grid[max(i - 1, 0)], grid[min(i + 1, grid.size - 1)])
        p = float(minimize_scalar(lambda q: _cost(solve(q)), bounds=bounds, method="bounded").x)
    else:
        p = exponent
    limit, c, residual, sigma = solve(p)
    columns = [np.ones_like(x), x**-p] + ([-c * np.log(x) * x**-p] if exponent is None else [])
    jacobian = np.column_stack(columns) / sigma[:, None]
    free = y.size - jacobian.shape[1]
    inverse = np.linalg.pinv(jacobian)
    scatter = _t(free) * sqrt(float(residual @ residual) / free * float(inverse[0] @ inverse[0]))
    numerical = _carried(inverse[0] / sigma, error)
    # the limit is known no better than the law meets the stiffest cases, nor than these are themselves known; a law
    # bent to the soft cases misses the stiff ones by less than it misses the limit: thrice is allowed for
    missed = 3 * float(np.maximum(np.abs(residual * sigma), error)[-2:].max())
    half = sqrt(scatter**2 + numerical**2 + missed**2)
    return float(limit), half if isfinite(half) else inf, p


def _cost(solved: tuple[Array, Array, Array, Array]) -> Array:
    """Minus twice the log-likelihood, the scale of the scatter left free."""
    _, _, residual, sigma = solved
    return residual.shape[-1] * np.log((residual**2).sum(-1) + 1e-300) + 2 * np.log(sigma).sum(-1)


def _t(free: int) -> float:
    return float(stdtrit(free, 0.5 + CONFIDENCE / 2))
