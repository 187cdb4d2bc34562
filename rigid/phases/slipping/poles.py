"""How long a panel may be: the poles of its integrands, and the turn.

A row of Chebyshev nodes sees a function to rho^-NODES, rho being the sum of the half axes of the ellipse about the
panel (foci at its ends, half its length the unit) that reaches the nearest pole. The zeros of D are known beforehand;
that of phidot^2 is where the turn would be, were the rates at the panel's start constant. They are estimates: the last
Chebyshev coefficients decide (:mod:`rigid.phases.slipping.stride`).
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import asin, atan2, inf, log, sqrt
from typing import NamedTuple

from ...kernel.compile import kernel
from ...kernel.layout import (  # fmt: skip
    ECC,
    GYR,
    ONE_MINUS_E,
)

LONGEST, LONGEST_TOP = 4.0, 1.0  # panels in x, in the charts of the bottom and of the top
# (rho + 1/rho)/2 for rho^-31 = 7e-16: the sum of the distances from a pole to the ends, over the length
REACH = 1.7


class Poles(NamedTuple):
    """Zeros of D in the plane of x, as (real, +-imaginary) parts: estimates, exact for a small K."""

    near: float  # two about the bottom
    near_width: float
    near_too: float
    far: float  # the nearer of two others, also in the chart of the top
    far_width: float
    far_top: float
    far_top_width: float


@kernel
def arsinh(x):
    """ln(x + sqrt(1 + x^2))."""
    return log(abs(x) + sqrt(1 + x * x)) * (1.0 if x >= 0.0 else -1.0)


@kernel
def poles_of(par, mu_hat):
    """Zeros of D (1 + u^2)^2 = K - 2 e mu^ (1 - e) u + (2 K + 4 e^2) u^2 - 2 e mu^ (1 + e) u^3 + K u^4.

    The first three terms have those near the bottom, the last three the others.
    """
    e, one_minus_e, gyr = par[ECC], par[ONE_MINUS_E], par[GYR]
    kappa = min(1.0, sqrt(gyr) / (2 * e))
    middle = 2 * gyr + 4 * e * e
    # the near zeros lie about kappa from 0, in the direction whose cosine is this
    cosine = e * mu_hat * one_minus_e / sqrt(gyr * middle)
    side = 1.0 if mu_hat > 0 else -1.0
    size = abs(cosine)
    if size < 1.0:
        near = near_too = side * arsinh(sqrt(size))
        near_width = asin(sqrt(1 - size))
    else:
        near_width = 0.0
        outer = size + sqrt(size * size - 1)
        near, near_too = side * arsinh(outer), side * arsinh(1 / outer)
    half = e * abs(mu_hat) * (1 + e)
    root = half * half - gyr * middle
    if root >= 0.0:
        far, far_width = middle / (half + sqrt(root)), 0.0
        low = e * abs(mu_hat) * one_minus_e
        for _ in range(2):
            # Newton on all of it: a slip that starts near it wants its place
            rest = gyr + far * (far * (middle + far * (far * gyr - 2 * half)) - 2 * low)
            slope = 2 * (far * (middle + far * (2 * far * gyr - 3 * half)) - low)
            if slope != 0.0:
                far -= rest / slope
    else:
        far, far_width = half / gyr, sqrt(-root) / gyr
    size2 = far * far + far_width * far_width
    far_x, turn = 0.5 * log(4 * size2 / (kappa * kappa)), atan2(far_width, far)
    return Poles(near, near_width, near_too, side * far_x, turn, -side * far / size2, far_width / size2)


@kernel
def clear_of(length, ahead, width):
    """The length of a panel, ``length`` at most, that sees a pole at ``ahead`` +- i ``width`` of its start as 1e-15."""
    if ahead == inf:
        return length
    return min(length, 2 * (REACH * sqrt(ahead * ahead + width * width) - ahead) / (REACH * REACH - 1))


@kernel
def first_length(poles, panel, sign):
    """A panel's length in x for what D does."""
    if panel.top != 0.0:
        return clear_of(LONGEST_TOP, sign * (poles.far_top - panel.start), poles.far_top_width)
    x = log(panel.start)
    length = clear_of(LONGEST, sign * (poles.near - x), poles.near_width)
    length = clear_of(length, sign * (poles.near_too - x), poles.near_width)
    return clear_of(length, sign * (poles.far - x), poles.far_width)


@kernel
def turn_ahead(par, mu_hat, angle, panel, omega):
    """How far in x the turn is ahead (or was behind, < 0), were the rates of dw/dx = -g - f w constant."""
    s, c, h, low = angle
    e, gyr = par[ECC], par[GYR]
    p = e * s + mu_hat * (par[ONE_MINUS_E] + e * h)
    # dphi/dx, with 1/(1 + u^2) of the chart
    if panel.top != 0.0:
        rate = h
    else:
        rate = 0.5 * panel.kappa * (panel.start + 1 / panel.start) * low
    rate *= 2 * p / (gyr + e * s * p)
    falls, fades = -rate / (omega * abs(omega)), rate * e * c
    if omega < 0.0:
        fades = -fades
    if abs(fades) <= 1e-6 * abs(falls):
        return 1 / falls if falls != 0.0 else inf
    share = fades / falls if falls != 0.0 else inf
    return log(1 + share) / fades if -1.0 < share < inf else inf


@kernel
def starts(par, mu_hat, angle, omega, d):
    """Whether a slip sets in with an acceleration of the right sign, far above the round-off of its terms."""
    s, c, h, _ = angle
    e = par[ECC]
    arm = par[ONE_MINUS_E] + e * h
    b, spin = 1 - e * c * omega * omega, e * s * omega * omega * d
    force = (mu_hat * par[GYR] + arm * (e * s + mu_hat * arm)) * b
    return (spin - force) * mu_hat > 1e-3 * abs(mu_hat) * (abs(spin) + abs(force))
