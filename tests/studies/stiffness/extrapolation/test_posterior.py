"""The inference of a limit against the same by dense covariances, and what a fit makes of errors and of its points."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr

from studies.stiffness.extrapolation.fitted import _carried, narrowest
from studies.stiffness.extrapolation.posterior import _UNDERSTATED, inferred, weighed

SIZES = np.geomspace(0.1, 3, 4)
POWERS = np.geomspace(1, 1e3, 7)[:, None] ** -np.array([1 / 3, 2 / 3, 1.0])


def marginal(y, error, size, understated):
    """Mean and deviation of L, and log evidence, where y is normal: L + powers times normal coefficients + errors.

    With nothing known of L beforehand, generalised least squares with the covariance of all that is not L.
    """
    shared = understated * error
    covariance = np.diag(shared**2) + np.outer(shared, shared) + size**2 * POWERS @ POWERS.T
    inverse = np.linalg.inv(covariance)
    information = inverse.sum()
    mean = inverse.sum(axis=0) @ y / information
    left = y - mean
    evidence = -(np.linalg.slogdet(covariance)[1] + np.log(information) + left @ inverse @ left) / 2
    return mean, information**-0.5, evidence


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("confidence", [0.5, 0.95])
def test_the_interval_holds_its_share_of_what_is_likely(seed: int, confidence: float) -> None:
    """Over all sizes and understatements, each of these half as likely as the one before; round-off is 1e-8 of errors.

    To 1e-5 of a probability: dense covariances lose five digits of sixteen to their condition, 1e9 at most.
    """
    random = np.random.default_rng(seed)
    error = random.uniform(0.01, 0.03, len(POWERS))
    y = 0.3 + POWERS @ random.normal(size=3) + error * random.normal(size=len(POWERS))
    found = inferred(y, error, SIZES, POWERS, np.array([1.0, 0.0, 0.0, 0.0]), confidence)
    each = [(u, *marginal(y, error, size, u)) for u in _UNDERSTATED for size in SIZES]
    weights = np.array([np.exp(evidence) / u for u, _, _, evidence in each])
    means, deviations = (np.array([case[i] for case in each]) for i in (1, 2))
    middle = weights @ means / weights.sum()
    assert found.value == pytest.approx(middle, abs=1e-5 * found.uncertainty)
    above = ndtr((means - middle - found.uncertainty) / deviations)
    below = ndtr((middle - means - found.uncertainty) / deviations)
    assert weights @ (above + below) / weights.sum() == pytest.approx(1 - confidence, abs=1e-5)


def test_a_limit_that_is_known_is_no_unknown() -> None:
    """One power, no error to speak of: its coefficient is what the values say, and what is asked of it its share."""
    y = 0.7 * POWERS[:, 0]
    likely, means, deviations = weighed(y, np.full(len(y), 1e-9), SIZES, POWERS[:, :1], np.array([[0.0, 0.25]]))
    assert likely @ means[:, 0] == pytest.approx(0.25 * 0.7, abs=1e-8)
    assert np.all(deviations < 1e-7)


def test_the_choice_of_points_is_part_of_the_interval() -> None:
    """The larger change among fits of up to two points more or fewer, as one more independent part."""
    fits = {4: (1.0, 0.3), 5: (1.4, 0.05), 6: (1.1, 0.1), 9: (3.0, 0.45)}
    assert narrowest(fits) == (6, pytest.approx(np.hypot(0.1, 0.3)))
    assert narrowest({n: fits[n] for n in (5, 6, 9)}) == (5, pytest.approx(np.hypot(0.05, 0.3)))
    assert narrowest({9: fits[9], 4: fits[4]}) == (4, pytest.approx(0.3))


def test_errors_of_a_sum_are_those_in_common_and_each_cases_own() -> None:
    """Of a difference of two cases what they have in common is nothing, of their sum twice of either."""
    error = np.array([0.3, 0.3])
    assert _carried(np.array([1.0, -1.0]), error) == pytest.approx(0.3 * 2**0.5)
    assert _carried(np.array([1.0, 1.0]), error) == pytest.approx(0.3 * 6**0.5)
