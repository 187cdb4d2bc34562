"""Rows of Chebyshev nodes against closed forms, and the count of their roots against polynomials of known roots."""

from math import exp, sin

import numpy as np
import pytest

from rigid.kernel import layout as at
from rigid.kernel.spectral import (
    NO_ROOT,
    UNCLEAR,
    exponentials,
    interpolate,
    least_of,
    only_root,
    product,
    tail,
    workspace,
)

ROUND_OFF = 4e-15  # of sums of 32 products of numbers of order 1


@pytest.fixture
def rows():
    return workspace()[1]


def nodes(rows):
    return np.array(rows[at.Q_NODE : at.Q_NODE + at.ROW])


def put(rows, values, row=at.Q_F):
    rows[row : row + at.ROW] = [float(value) for value in values]


def got(rows, row):
    return np.array(rows[row : row + at.ROW])


def test_integral_of_an_exponential(rows):
    """Over [0, theta] of exp(-3 theta): (1 - exp(-3 theta))/3, at the nodes and at 1."""
    put(rows, np.exp(-3 * nodes(rows)))
    product(rows, at.Q_INTEGRAL, at.Q_F, at.Q_T)
    assert got(rows, at.Q_T) == pytest.approx((1 - np.exp(-3 * nodes(rows))) / 3, abs=ROUND_OFF)


def test_integral_from_a_turn_keeps_its_digits_there(rows):
    """Int theta cos(theta) from 0, over theta^2: relative to itself as exact at the first node as at the last."""
    theta = nodes(rows)
    put(rows, np.cos(theta))
    product(rows, at.Q_FROM_TURN, at.Q_F, at.Q_T)
    series = sum((-1) ** k * theta ** (2 * k) / np.prod(np.arange(1.0, 2 * k + 1)) / (2 * k + 2) for k in range(9))
    assert got(rows, at.Q_T) == pytest.approx(series, rel=ROUND_OFF)


def test_exponentials(rows):
    x = np.linspace(-2.5, 2.5, at.ROW)
    put(rows, x, at.Q_X)
    exponentials(rows, at.Q_X, at.Q_E)
    assert got(rows, at.Q_E) == pytest.approx(np.exp(x), rel=ROUND_OFF)


@pytest.mark.parametrize("x", [0.0, 1e-9, 0.3, 0.5, 1.0])
def test_interpolation(rows, x):
    put(rows, np.sin(2 * nodes(rows)))
    assert interpolate(rows, at.Q_F, x) == pytest.approx(sin(2 * x), abs=ROUND_OFF)
    assert interpolate(rows, at.Q_F, rows[at.Q_NODE + 7]) == pytest.approx(rows[at.Q_F + 7], rel=1e-15)


def test_the_tail_falls_like_the_ellipse_that_reaches_the_pole(rows):
    """1/(x - p) on [-1, 1] has Chebyshev coefficients ~ rho^-n, rho = p + sqrt(p^2 - 1), exactly."""
    p = 1.5
    x = 2 * nodes(rows) - 1
    put(rows, 1 / (p - x))
    rho = p + (p * p - 1) ** 0.5
    last = 2 / (p * p - 1) ** 0.5 * rho ** (1 - at.NODES)
    # what lies beyond the last coefficient folds back upon it, at most doubling it
    assert last * (1 + rho) * 0.5 < tail(rows, at.Q_F) < last * (1 + rho) * 2


def test_no_root_is_missed(rows):
    """Polynomials of given roots: none is called free of roots that has one in (0, 1), and a place given is a root."""
    without = with_one = 0
    for seed in range(400):
        rng = np.random.default_rng(seed)
        # every other one has few roots, and those seldom inside: most of the others are called unclear
        most, low = ((6, -0.5), (3, -4.0))[seed % 2]
        roots = rng.uniform(low, 1.5, rng.integers(1, most))
        if seed % 4 == 0:
            roots = np.append(roots, roots[0] + 10.0 ** rng.uniform(-9, -2))  # a pair as close as a tangent
        bumps = rng.uniform(0.1, 2, 2)
        theta = nodes(rows)
        put(rows, np.prod(theta[:, None] - roots, axis=1) * np.exp(bumps[0] * theta) * (1 + bumps[1] * theta**2))
        inside = [root for root in roots if 0 < root < 1]
        found = only_root(rows, at.Q_F, 0.0)
        if found == UNCLEAR:
            continue
        if found == NO_ROOT:
            without += 1
            assert not inside
        else:
            with_one += 1
            assert len(inside) == 1
            # the row is known to 1e-15 of its largest: so far is its root, by the slope there
            slope = abs(interpolate(rows, at.Q_F, min(found + 1e-4, 1.0)) - interpolate(rows, at.Q_F, found - 1e-4))
            assert abs(found - inside[0]) < 1e-14 * np.abs(got(rows, at.Q_F)).max() / (slope / 2e-4) + 1e-15
    assert min(without, with_one) > 50


def test_clear_cases_are_clear(rows):
    """What the count is for: a row that keeps well off zero, and one that passes it."""
    theta = nodes(rows)
    put(rows, 1.2 + np.cos(4 * theta))
    assert only_root(rows, at.Q_F, 0.0) == NO_ROOT
    assert least_of(rows, at.Q_F) > 0.2
    put(rows, np.exp(-3 * theta) - exp(-1.5))
    assert only_root(rows, at.Q_F, 0.0) == pytest.approx(0.5, abs=ROUND_OFF)


def test_two_roots_and_round_off_are_unclear(rows):
    theta = nodes(rows)
    put(rows, (theta - 0.31) * (theta - 0.32))
    assert only_root(rows, at.Q_F, 0.0) == UNCLEAR
    put(rows, 1e-10 * (2 + np.cos(theta)))
    assert only_root(rows, at.Q_F, 0.0) == NO_ROOT
    assert only_root(rows, at.Q_F, 1e6) == UNCLEAR  # a difference of terms of 1e6 does not know its sign to 1e-10
