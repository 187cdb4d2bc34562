"""How fast the cases come to a limit, beside what is predicted of that.

A distance over its leading power has the powers behind it in it too: 5 % of it at a foundation of 1e13 where a patch's
next coefficient is a thousand times the first, 20 % at 1e11. What is asked is what the predicted powers alone come to.
So the prediction is taken off the cases, and the whole series is inferred of what is left (:func:`leading_part`): its
part in the predicted powers is by how much they miss.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .extrapolation.cases import CONFIDENCE, FEWEST
from .extrapolation.fitted import narrowest
from .extrapolation.series import leading_part

if TYPE_CHECKING:
    from ..limit.prediction import Term

Array = NDArray[np.float64]


class Coefficient(NamedTuple):
    """What the predicted powers of a distance come to at the stiffest case, over the leading one."""

    observed: float
    predicted: float
    uncertainty: float
    """Half width of the interval of the observed one: terms not seen, numerical error, choice of the cases."""


def coefficient(
    term: Term, foundation: Array, values: Array, errors: Array, rates: Sequence[float]
) -> Coefficient | None:
    """Observed and predicted coefficient of a measure; None with too few cases for an interval, and of one that has
    none: it comes as the first of ``rates``.

    Parameters
    ----------
    term : Term
        The prediction; powers of foundation^(-1/3).
    foundation, values, errors : (n,) ndarray
        Growing; the measure there and its numerical error. Cases so soft that theory does not hold are not among them.
    rates : sequence of float
        The leading powers of 1/foundation, those of the prediction among them as the first.
    """
    if not term.powers or len(values) < FEWEST - 1 or not np.isclose(rates[0], term.exponent / 3):
        return None
    small = foundation ** (-1 / 3)
    missed = values - term.at(small)
    scale = float(small[-1]) ** term.exponent
    fits = {}
    for n in range(FEWEST - 1, len(values) + 1):
        part = leading_part(foundation[-n:], missed[-n:], errors[-n:], rates, len(term.powers), CONFIDENCE)
        fits[n] = (part.value / scale, part.uncertainty / scale)
    fits = {n: fit for n, fit in fits.items() if isfinite(fit[1])}
    if not fits:
        return None
    n, half = narrowest(fits)
    predicted = (float(term.at(small[-1])) - term.limit) / scale
    return Coefficient(predicted + fits[n][0], predicted, half)
