"""The limit of a sequence y(s) as s grows, and how fast it gets there.

Where theory has the rates, the limit is that of their series (``series``). Where it has none, a law ``y = L + c s^-p``
is fitted, p too (``fitted``), and its uncertainty says how well it holds. L and c are never given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import hypot, inf, isfinite, nan
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .cases import CONFIDENCE, ascending, finite, settled
from .fitted import SLOWEST, observed_rate, richardson
from .series import fewest, inferred_series, is_confirmed, of_one_series, one_series

Array = NDArray[np.float64]

CLEAR = 2.0
"""Half widths of its interval by which a limit must miss the rigid value before the answer is no: one in twenty misses
it by one."""


@dataclass(frozen=True, slots=True)
class Limit:
    """The limit of a measure as stiffness grows, and whether the rigid value is it.

    Attributes
    ----------
    value : float
        Extrapolated limit L, found without knowing the rigid value; NaN where cases are too few for one.
    uncertainty : float
        Half width of its interval at 95 %. With known exponents: terms not seen, soft cases, numerical
        error; fitted: scatter, choice of points, numerical error, and the change of the limit with a rate of 1/3.
    exponents : tuple of float
        The leading rates, slowest first.
    known : bool
        Whether theory gave them; otherwise it is one, and fitted.
    rigid : float
        The value of the rigid hoop that this limit is expected to be.
    rate : float
        Observed rate at which the distance to the rigid value goes to zero; NaN where none is to be seen: one that has
        not fallen over the cases, or has another limit beyond doubt.
    rate_interval : (float, float)
        Its interval at 95 %.
    rate_cases : tuple of int
        Which cases that rate was fitted to, by their place among those given, softest first.
    distance : float
        Distance to the rigid value at the stiffest case: what is left without any extrapolation.
    span : float
        How far apart the values of all cases are, or their numerical error where that is more.
    fitted : (float, float)
        Limit and half width with a rate that is fitted to all cases, whatever theory says.
    grows : bool
        Whether the stiffest case is farther from the rigid value than the one before it, by more than their errors.
    holds : float
        Stiffness of the cases from which on the known exponents were asked of them.
    """

    value: float
    uncertainty: float
    exponents: tuple[float, ...]
    known: bool
    rigid: float
    rate: float
    rate_interval: tuple[float, float]
    rate_cases: tuple[int, ...]
    distance: float
    span: float
    fitted: tuple[float, float]
    grows: bool = False
    holds: float = 0.0

    @property
    def rigid_excluded(self) -> bool:
        """Whether the rigid value is outside beyond doubt: by more than ``CLEAR`` half widths, and of a fitted rate's
        interval too. Cases that are not yet those of theory may make a narrow interval of its powers anywhere."""
        value, uncertainty = self.fitted
        outside = not self.known or abs(value - self.rigid) > uncertainty
        return self.rigid_inside is False and self.half_widths > CLEAR and outside

    @property
    def extrapolated(self) -> bool:
        """Whether there were cases enough for a limit."""
        return isfinite(self.uncertainty)

    @property
    def rigid_inside(self) -> bool | None:
        """Whether the rigid value lies within the uncertainty of the limit.

        None where there is no interval to speak of: too few cases, or one wider than all that was measured, in which
        nothing would be outside; nor is the stiffest case, in one wider than its distance, where the cases go
        away from the rigid value.
        """
        if not self.uncertainty <= self.span or (self.grows and self.uncertainty >= self.distance):
            return None
        return abs(self.value - self.rigid) <= self.uncertainty

    @property
    def error(self) -> float:
        """Limit minus rigid value."""
        return self.value - self.rigid

    @property
    def half_widths(self) -> float:
        """How far the rigid value is from the limit, in half widths of its interval."""
        off = abs(self.error)
        return off / self.uncertainty if self.uncertainty else inf if off else 0.0

    def to_dict(self) -> dict[str, Any]:
        """The limit as JSON prints it."""
        return {
            "value": self.value,
            "uncertainty": self.uncertainty,
            "rate": self.rate,
            "rate_interval": list(self.rate_interval),
            "exponents": list(self.exponents),
            "exponents_known": self.known,
            "rigid": self.rigid,
            "error": self.error,
            "rigid_inside": self.rigid_inside,
            "last_distance": self.distance,
            "fitted": {"value": self.fitted[0], "uncertainty": self.fitted[1]},
        }


def limit_of(
    s: ArrayLike,
    y: ArrayLike,
    rigid: float,
    error: ArrayLike | None = None,
    exponents: Sequence[float] | None = None,
    holds: float = 0.0,
) -> Limit:
    """The limit of a measure over a ladder of stiffness beside the rigid value it should have.

    Parameters
    ----------
    s, y : (n,) array_like
        Stiffness of each case, above 0 and in any order, and the measure there; NaN where there is none.
    rigid : float
        The value that the limit should be; the limit does not know it.
    error : (n,) array_like, optional
        Numerical error of each ``y``.
    exponents : sequence of float, optional
        Leading rates, slowest first, where theory knows them. With fewer than :func:`.series.fewest` cases from
        ``holds`` on, or too few of one kind (:func:`.series.is_confirmed`), a rate is fitted, to all cases.
    holds : float
        Stiffness from which on it knows them.

    Raises
    ------
    ValueError
        Not as many of each, a stiffness that is none, or one twice; exponents that are no rates, slowest first.
    """
    s, y, error = ascending(s, y, error, exponents)
    (values, alike), stiff = settled(y, rigid), np.asarray(s, float) >= holds
    off = np.zeros_like(values) if error is None else np.asarray(error, float)
    own, own_uncertainty, own_rate = richardson(s, values, error)
    # a rate fitted where two terms of opposite sign still compete is not that of the last one
    fitted = own, hypot(own_uncertainty, own - richardson(s, values, error, SLOWEST)[0])
    (value, uncertainty), known = fitted, False
    rates: tuple[float, ...] = (own_rate,)
    cases = finite(np.asarray(s)[stiff], values[stiff], off[stiff])
    if exponents is not None and (holds == 0 or cases[0].size >= fewest(exponents)):
        series = one_series(*cases, exponents, CONFIDENCE)
        if is_confirmed(series[0].size, cases[0].size, exponents):
            (value, uncertainty), rates, known = of_one_series(series, exponents, CONFIDENCE), tuple(exponents), True
    rate = observed_rate(s, np.where(np.abs(values - rigid) > alike, values - rigid, 0.0), error)
    found = Limit(
        value,
        max(uncertainty, alike),
        rates,
        known,
        rigid,
        rate.value,
        rate.interval,
        rate.cases,
        float(abs(values[-1] - rigid)) if values.size else nan,
        max(_span(values, error), alike),
        fitted,
        _grows(values, off, rigid),
        holds,
    )
    away = np.abs(values - rigid)[list(rate.cases)]
    if isfinite(rate.value) and (found.rigid_excluded or not away[-1] < away[0]):
        return replace(found, rate=nan, rate_interval=(-inf, inf))
    return found


def fitted_series(
    limit: Limit, s: ArrayLike, y: ArrayLike, error: ArrayLike, points: int = 120
) -> tuple[Array, Array] | None:
    """Stiffness and measure of the series that a limit was extrapolated with, over the cases that it was fitted to.

    Parameters as of :func:`limit_of`, whose ``limit`` it is; None where no exponents were known, or cases too few.
    """
    if not (limit.known and limit.extrapolated):
        return None
    stiff = np.asarray(s, float) >= limit.holds
    x, v, e = (np.asarray(values, float)[stiff] for values in (s, y, error))
    x, v, e = one_series(x, v, e, limit.exponents, CONFIDENCE)
    along = np.geomspace(x[0], x[-1], points)
    return along, inferred_series(x, v, e, limit.exponents, along)


def _grows(values: Array, off: Array, rigid: float) -> bool:
    away, off = np.abs(values - rigid)[-2:], np.nan_to_num(np.abs(off))[-2:]
    return bool(away.size == 2 and away[1] - off[1] > away[0] + off[0])


def _span(values: Array, error: ArrayLike | None) -> float:
    known = values[np.isfinite(values)]
    if not known.size:
        return 0.0
    off = 0.0 if error is None else np.max(np.nan_to_num(np.abs(np.asarray(error, float))), initial=0.0)
    return max(float(np.ptp(known)), float(off))
