"""What a number may be, and what is said of what is none."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from rigid import Hoop, Release, SceneError, simulate, simulate_batch
from rigid.lists import Repeated

BATCH: dict[str, Any] = {"k": 0.2, "mu_s": 0.35, "mu": 0.3, "phi0": 0.2}


@pytest.mark.parametrize("tenth", [Fraction(1, 10), Decimal("0.1"), np.float64(0.1)])
def test_a_fraction_is_the_float_next_to_it(tenth):
    """0.1 is the float next to a tenth; angles in degrees and batches too."""
    assert Hoop(tenth) == Hoop(0.1)
    assert type(Hoop(tenth).k) is float
    assert Release(phi0_deg=tenth) == Release(phi0_deg=0.1)
    assert simulate_batch({**BATCH, "k": [tenth, 0.2]}).t_end[0] == simulate_batch({**BATCH, "k": 0.1}).t_end[0]


@pytest.mark.parametrize("value", [True, np.True_, 1j, Decimal("sNaN"), Fraction(10**400)])
def test_what_is_no_real_number_is_none_of_a_scene(value):
    with pytest.raises(SceneError, match=r"^hoop.k = .* is not possible: it must be a real number\.$"):
        Hoop(value)


@pytest.mark.parametrize(
    "values",
    [
        True, [True, 0.2], np.array([True]), np.ma.array([True, False]), [np.array(True)], None, [None, 0.2],
        [1j], np.array([0.1 + 1j]), "0.1", ["0.1"], b"0.1", np.array(["2020-01-01"], "datetime64[D]"),
        [Fraction(10**400), 0.2], np.array([10**400], object),
    ],
)  # fmt: skip
def test_nor_is_it_one_of_a_batch(values):
    """Of truths, dates, text and complex numbers numpy makes numbers, of None a NaN; some are beyond a float."""
    with pytest.raises(SceneError, match=r"^k = .* is not possible: a batch takes a number, or an array of them\.$"):
        simulate_batch({**BATCH, "k": values})


def test_a_batch_says_how_an_angle_in_degrees_is_given():
    with pytest.raises(SceneError, match=r"phi0_deg is not a quantity .* phi0 = np.radians"):
        simulate_batch({"k": 0.2, "mu_s": 0.35, "mu": 0.3, "phi0_deg": 10})


@pytest.mark.parametrize("path", [None, 3])
def test_a_motion_is_saved_to_a_path(path):
    with pytest.raises(ValueError, match=f"^{path} is no path to save to"):
        simulate("paper-3.1").save(path)


def test_what_a_lazy_sequence_shows():
    """All of two items, and that there are more only where there are."""
    shown = [repr(Repeated(tuple(range(n)), 0, 0, (), lambda item, _: item)) for n in range(4)]
    assert shown == ["<0 items>", "<1 item: 0>", "<2 items: 0, 1>", "<3 items: 0, 1, ...>"]
