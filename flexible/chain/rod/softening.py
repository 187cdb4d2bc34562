"""What bends far bends easier: the energy of fourth order in the angles of a part.

Of a straight wall with Green's strain in plane stress, of the thickness h and the curvature kappa, fibres get thinner
and the middle moves as the energy is least; with no force along it the energy over an even bending stiffness is

    kappa^2 (1 - c y)/2,    c = 1 - 2 nu/5 + nu^2/5,    y = (kappa h/2)^2,

to the fourth order. Of this the line's shortening by what a bent part is easier to pull has 3 (1 - nu)^2/4 (see
:mod:`flexible.chain.rod.corotated`); the rest, S = 1/4 + 11 nu/10 - 11 nu^2/20, is an energy of the angles by itself.
A series of such terms falls without end. It is taken as -S y^2/(1 + y), which has that order and its sign of the next
and leaves every part a stiffness, however far it bends.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import loop

Array = NDArray[np.float64]


def softening_of(bending: float, chord: float, wall: float, poisson: float) -> Array:
    """(6,): of tau_1^4, tau_1^3 tau_2, ... tau_2^4, in a part that bends evenly, and by tau_1^2 + tau_2^2 of y."""
    share = 1 / 4 + 11 / 10 * poisson - 11 / 20 * poisson**2
    size = (wall / (2 * chord)) ** 2
    even = -bending / 2 * share * size * np.array([1.0, -4.0, 6.0, -4.0, 1.0])
    return np.array([*even, 2 * size])


@loop
def softened(soft: Any, one: float, two: float) -> tuple[float, float, float]:
    """Energy of fourth order of a part with these angles, and its derivatives."""
    a, b, c, d, e, scale = soft
    p = (((a * one + b * two) * one + c * two * two) * one + d * two * two * two) * one + e * two * two * two * two
    p1 = ((4 * a * one + 3 * b * two) * one + 2 * c * two * two) * one + d * two * two * two
    p2 = ((b * one + 2 * c * two) * one + 3 * d * two * two) * one + 4 * e * two * two * two
    g = 1 / (1 + scale * (one * one + two * two))
    fall = 2 * scale * g * p
    return g * p, g * (p1 - fall * one), g * (p2 - fall * two)


@loop
def softening(soft: Any, one: float, two: float) -> tuple[float, float, float]:
    """Second derivatives of that energy: 11, 12 and 22."""
    a, b, c, d, e, scale = soft
    p = (((a * one + b * two) * one + c * two * two) * one + d * two * two * two) * one + e * two * two * two * two
    p1 = ((4 * a * one + 3 * b * two) * one + 2 * c * two * two) * one + d * two * two * two
    p2 = ((b * one + 2 * c * two) * one + 3 * d * two * two) * one + 4 * e * two * two * two
    p11 = (12 * a * one + 6 * b * two) * one + 2 * c * two * two
    p12 = (3 * b * one + 4 * c * two) * one + 3 * d * two * two
    p22 = (2 * c * one + 6 * d * two) * one + 12 * e * two * two
    g = 1 / (1 + scale * (one * one + two * two))
    fall, steep = 2 * scale * g, 8 * scale * scale * g * g * p
    return (
        g * (p11 - fall * (2 * p1 * one + p) + steep * one * one),
        g * (p12 - fall * (p1 * two + p2 * one) + steep * one * two),
        g * (p22 - fall * (2 * p2 * two + p) + steep * two * two),
    )
