"""The observed coefficient of a distance, on sequences whose coefficient is known."""

from __future__ import annotations

import numpy as np
import pytest

from studies.limit.prediction import Term
from studies.stiffness.coefficient import coefficient
from studies.stiffness.extrapolation.series import terms

S = np.geomspace(1e8, 1e13, 6)
SMALL = S ** (-1 / 3)
PREDICTED = {"patch": (1.0,), "brush, mu_s = mu": (1.0, 6 / 5), "patch, ring with a mass": (1.0,)}
RATES = {"patch": (1 / 3, 2 / 3), "brush, mu_s = mu": (1 / 3, 2 / 5), "patch, ring with a mass": (1 / 3, 1 / 2)}


def sequence(law: str, random: np.random.Generator, right: float) -> tuple[Term, np.ndarray, np.ndarray, float]:
    """Prediction, measures, numerical errors, and the true coefficient, ``right`` times the predicted one.

    At the softest case the predicted powers and three behind them are of one size.
    """
    powers, rates = PREDICTED[law], RATES[law]
    at_softest = 0.02 * random.normal(size=len(powers) + 3)
    scale = SMALL[0] ** np.array(powers)
    term = Term(0.17, tuple(zip(powers, at_softest[: len(powers)] / scale, strict=True)))
    predicted = term.at(SMALL) - term.limit
    behind = terms(S / S[0], rates)[:, len(powers) : len(powers) + 3] @ at_softest[len(powers) :]
    error = 0.01 * np.abs(predicted + behind)
    off = random.choice([random.uniform(-1, 1, S.size), np.full(S.size, random.choice([-1, 1]))])
    truth = right * predicted[-1] / SMALL[-1]
    return term, term.limit + right * predicted + behind + error * off, error, float(truth)


@pytest.mark.parametrize("law", PREDICTED)
def test_the_interval_holds_the_true_coefficient(law):
    """With a prediction that is that, or 30 % off: 38 of 40 is the level, three standard deviations below are 33.9."""
    random = np.random.default_rng(15)
    held = 0
    for right in [1.0, 0.7] * 20:
        term, values, error, truth = sequence(law, random, right)
        seen = coefficient(term, S, values, error, RATES[law])
        held += abs(seen.observed - truth) <= seen.uncertainty
    assert held >= 34


def test_terms_behind_the_prediction_are_told_from_it():
    """y = L + eps + 2000 eps^2, as a patch has it: over eps it is off by 9 % at 1e13, and by twice as much at 1e12."""
    values = 0.17 + SMALL + 2000 * SMALL**2
    assert (values[-1] - 0.17) / SMALL[-1] > 1.09
    seen = coefficient(Term(0.17, ((1.0, 1.0),)), S, values, 1e-3 * SMALL, RATES["patch"])
    assert abs(seen.observed - 1) <= seen.uncertainty < 0.05


def test_a_wrong_prediction_shows():
    values = 0.17 + 0.7 * SMALL + 500 * SMALL**2
    seen = coefficient(Term(0.17, ((1.0, 1.0),)), S, values, 1e-3 * SMALL, RATES["patch"])
    assert seen.observed == pytest.approx(0.7, abs=seen.uncertainty)
    assert seen.uncertainty < 0.1 * abs(seen.observed - seen.predicted)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_cases_have_none(count):
    values = 0.17 + SMALL[:count]
    assert coefficient(Term(0.17, ((1.0, 1.0),)), S[:count], values, 0.01 * SMALL[:count], RATES["patch"]) is None
