"""The angle of a chord, to two units of the last digit and in a third of libm's time.

Every part of a chain asks for it some fifteen times a step, which is most of what such a step spends on a function that
compiled code cannot see into.
"""

from __future__ import annotations

from math import atan, atan2, copysign

import numpy as np

from rigid.kernel.compile import loop

CUTS = 16  # of the slopes from 0 to 1; an angle is that of the nearest cut and a series of one of a 32nd at most
_AT_CUTS = np.array([atan(k / CUTS) for k in range(CUTS + 1)])


@loop
def angle(y: float, x: float) -> float:
    """atan2(y, x): of a direction within 45 degrees of the axis by tan (a - b) = (t - s)/(1 + t s), t and s of a and b.

    What is left of the series, d^13/13, is nothing to d at a 32nd.
    """
    if not abs(y) <= x or x == 0:
        return atan2(y, x)
    slope = abs(y) / x
    nearest = int(CUTS * slope + 0.5)
    cut = nearest / CUTS
    d = (slope - cut) / (1 + slope * cut)
    s = d * d
    series = 1 - s * (1 / 3 - s * (1 / 5 - s * (1 / 7 - s * (1 / 9 - s * (1 / 11)))))
    return copysign(_AT_CUTS[nearest] + d * series, y)
