"""The angle of a chord, against libm's."""

from math import atan2, copysign, inf, isnan, nan, pi, tan

import numpy as np
import pytest

from flexible.chain.rod.angle import CUTS, angle
from rigid.kernel.compile import jit


@jit
def compiled(y, x):
    return angle(y, x)


@pytest.mark.parametrize("of", [angle, compiled])
def test_angle_to_two_units_of_the_last_digit(of):
    """In all quadrants, however small, on both sides of every cut and of 45 degrees."""
    rng = np.random.default_rng(3)
    between = [(k + 0.5) / CUTS for k in range(CUTS)]
    slopes = np.concatenate([[tan(pi / 8), 1.0], between, np.nextafter(between, 0), rng.uniform(0, 1, 2000)])
    small = 10 ** rng.uniform(-300, 0, 500)
    for slope in np.concatenate([slopes, small, 1 / slopes]):
        for x in (1.0, 3e-5, -0.7):
            for y in (slope * x, -slope * x):
                expected = atan2(y, x)
                assert abs(of(y, x) - expected) <= 2 * np.spacing(abs(expected))


def test_angle_where_there_is_none():
    """Zeros have their sign, as atan2's; what is not a number stays none."""
    assert angle(0.0, 0.0) == angle(0.0, inf) == 0.0
    assert copysign(1, angle(-0.0, 1.0)) == -1
    assert isnan(angle(nan, 1.0))
    assert isnan(angle(1.0, nan))
