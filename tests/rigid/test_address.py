"""Functions that compiled code calls by their address."""

import sys
from typing import NamedTuple

import numpy as np
import pytest

from rigid.kernel.compile import apart, jit
from rigid.kernel.insides.parts import are_known

pytestmark = pytest.mark.skipif(not are_known(), reason="a numba whose insides are not known")


class Parts(NamedTuple):
    whole: np.ndarray
    rest: float


@apart(lambda: ((np.empty(0), 0.0), Parts(np.empty(0), 0.0)))
def split(values, unit):
    """Multiples of a unit, and what is left over in all."""
    if unit == 0:
        raise ValueError("no unit")
    whole, rest = np.empty(values.shape[0]), 0.0
    for i in range(values.shape[0]):
        whole[i] = values[i] // unit
        rest += values[i] % unit
    return Parts(whole, rest)


def _summed(values, unit):
    parts = split(values, unit)
    return parts.whole.sum() + parts.rest, parts


summed = jit(_summed, needs=(split,))


@apart(lambda: ((0.0,), 0.0))
def never_loaded(x):
    return 2 * x


@jit
def too_early(x):
    return never_loaded(x)


@apart(lambda: ((0.0,), 0))
def no_integer(x):
    return 2 * x


def test_callers_are_compiled_without_what_they_call():
    values = np.array([3.5, 4.25, 7.0])
    summed.compile_for(values, 2.0)
    assert summed(values, 2.0)[0] == 1 + 2 + 3 + 1.5 + 0.25 + 1


def test_arrays_come_back_whole():
    """As they do from any other function, and the caller's own are let go of as often as they were taken."""
    values = np.arange(1000.0)
    users = sys.getrefcount(values)
    for _ in range(100):
        _, parts = summed(values, 3.0)
    assert sys.getrefcount(values) == users
    assert np.array_equal(parts.whole, values // 3)
    assert parts.rest == pytest.approx(np.sum(values % 3))
    assert np.array_equal(values, np.arange(1000.0))


def test_in_python_it_is_a_function_like_any_other():
    parts = split(np.array([5.0]), 2.0)
    assert (parts.whole.tolist(), parts.rest) == ([2.0], 1.0)
    assert split.__name__ == "split"


def test_what_it_raises_reaches_python():
    with pytest.raises(ValueError, match="no unit"):
        summed(np.ones(1), 0.0)


def test_without_it_compiled_code_says_so():
    with pytest.raises(RuntimeError, match=r"never_loaded was not loaded"):
        too_early(1.0)
    never_loaded.load()
    assert too_early(1.5) == 3.0


def test_an_example_of_other_types_is_refused():
    with pytest.raises(TypeError, match="no_integer returns float64, and int64 by its example"):
        no_integer.load()
