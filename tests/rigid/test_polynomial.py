"""Roots on an interval: none stepped over, against numpy's companion matrix."""

from __future__ import annotations

from math import exp, factorial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid.kernel.polynomial import bernstein, first_crossing, first_positive, least, value, value_and_slope

#: the margin of a rolling hoop: 0.1679, 0.4301 and a pair 0.012 beside 0.549, where it all but touches zero
MARGIN = [
    -0.11191683326710739,
    0.8628176242576073,
    -0.1798487937802197,
    -7.556122366809637,
    7.580689444178351,
    17.93068631138434,
    -23.386325477734534,
]


def first(c, start, stop):
    return first_positive(c, len(c) - 1, start, stop, [0.0] * 7)


def test_a_root_behind_a_near_miss():
    assert first(MARGIN, 0.6087, 0.0) == pytest.approx(0.43010775, abs=1e-8)
    assert first(MARGIN, 0.0, 0.6087) == pytest.approx(0.16787563, abs=1e-8)
    assert first(MARGIN, 0.6087, 0.45) == -1
    assert first(MARGIN, 0.4, 0.0) == 0.4  # positive from the start, though not to the end


def test_any_polynomial():
    """Coefficients and intervals over six orders of magnitude, from either end."""
    rng = np.random.default_rng(0)
    found = 0
    for _ in range(4000):
        c = list(rng.standard_normal(7) * 10 ** rng.uniform(-4, 2, 7))
        low, high = sorted(10 ** rng.uniform(-6, 0.3, 2))
        low = 0.0 if rng.random() < 0.5 else low
        start, stop = (low, high) if rng.random() < 0.5 else (high, low)
        if value(c, 6, start) > 0:
            c = [-x for x in c]
        roots = np.roots(c[::-1])
        roots = np.sort(roots[np.abs(roots.imag) < 1e-12 * np.abs(roots)].real)
        roots = roots[(roots > low * (1 + 1e-12)) & (roots < high * (1 - 1e-12))]
        expected = -1.0 if not len(roots) else roots[0] if start < stop else roots[-1]
        found += len(roots) > 0
        assert first(c, start, stop) == pytest.approx(expected, rel=1e-6)
    assert found > 500


def test_bernstein_coefficients_bound_a_polynomial():
    rng = np.random.default_rng(1)
    for _ in range(200):
        c, (low, high) = list(rng.standard_normal(7)), sorted(rng.uniform(0, 3, 2))
        b = [0.0] * 7
        bernstein(c, 6, low, high, b)
        values = np.polyval(c[::-1], np.linspace(low, high, 50))
        slack = 1e-12 * np.abs(values).max()
        assert min(b) - slack <= values.min()
        assert values.max() <= max(b) + slack
        assert (b[0], b[6]) == pytest.approx((values[0], values[-1]), abs=slack + 1e-12)


@pytest.mark.parametrize("degree", [1, 3, 6, 23, 24])
def test_horner_in_four_strands(degree):
    c, x = list(np.random.default_rng(degree).standard_normal(degree + 1)), 0.7
    exact = np.polynomial.Polynomial(c)
    assert value(c, degree, x) == pytest.approx(exact(x), rel=1e-13)
    assert value_and_slope(c, degree, x) == pytest.approx((exact(x), exact.deriv()(x)), rel=1e-12)


@given(st.lists(st.floats(-10, 10), min_size=2, max_size=12), st.floats(0.0, 3.0), st.sampled_from([1.0, -1.0]))
def test_the_least_partial_sum_is_a_bound(coefficients, length, sign):
    """Nowhere on the interval is a polynomial below it, up to the round-off of its terms."""
    n = len(coefficients) - 1
    bound = least(coefficients, sign, 0, n, length)
    x = np.linspace(0.0, length, 200)
    terms = np.abs(coefficients) @ np.power.outer(length, np.arange(n + 1))
    assert np.min(sign * np.polynomial.polynomial.polyval(x, coefficients)) >= bound - 1e-14 * (1 + terms)


def test_the_bound_rules_out_what_falls_by_half():
    """exp(-x) stays positive, and its partial sums at 0.9 do: no search is needed. They do not at 2."""
    series = [(-1.0) ** k / factorial(k) for k in range(25)]
    assert 0 < least(series, 1.0, 0, 24, 0.9) <= exp(-0.9)
    assert least(series, 1.0, 1, 24, 0.9) < 0 < least(series, -1.0, 1, 24, 0.9)
    assert least(series, 1.0, 0, 24, 2.0) < 0
    assert first_crossing(series, 24, 2.0, 1.0) == -1.0
