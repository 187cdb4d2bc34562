"""What the outer rim has of a rod's strains besides the motion of the sections.

A wall that is bent gets thinner outside: beside where a section stands, the mean on which a shear force does work, its
surface sinks by some nu h^2/10 times dphi/dtheta. One that is pulled by N gets thinner on either side, by
nu N/(2 E b). One that bears a shear force Q warps: of the shift u = (2 + nu) Q z^3/(6 E I) of Saint-Venant's cantilever
(Timoshenko and Goodier, Theory of Elasticity, 21) its surface is (2 + nu) Q/(10 E b) behind the plane that turns with
it. The last two are a fifth of what a load of a unit dents a wall, small beside a bent ring, and many times the depth
of a patch on a stiff floor. And between two sections the rim runs as the line between them does: it is stretched as
that is, and slopes against the normal of the sections by the shear.

Without all that the rod gave way under a load on the rim in other places than the wall does, by 0.2/(E b) to 1/(E b).
"""

from __future__ import annotations

from math import log

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

OUTWARD, ONWARD, STRETCH, SLOPE = range(4)

_THIN = 0.01  # walls in which the exact pinch is lost in rounding, and its two first terms have 3e-5 of it
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def pinch_of(inner: float, poisson: float) -> float:
    """What the rim sinks where a ring of outer radius 1 bends by dphi/dtheta = 1.

    By the displacement of a curved bar under a moment (Timoshenko and Goodier, 29), less its mean over the section with
    the weight of an even shear force's stress, a parabola.
    """
    wall, square = 1 - inner, inner**2
    if wall < _THIN:
        return poisson * wall**2 * (0.1 + 0.19 * wall)
    a, b, c = 2 * square * log(inner), square - 1, 1 - square * (1 + 2 * log(inner))

    def moved(rho: Array | float) -> Array | float:
        bends = (1 - poisson) * rho * (2 * b * np.log(rho) + c) - (1 + poisson) * (a / rho + b * rho)
        return bends / (4 * b)

    rho, weights = (1 + inner + wall * _POINTS) / 2, _WEIGHTS * (1 - _POINTS**2)
    return float(weights @ moved(rho) / weights.sum() - moved(1.0))


def seen_of(local: Array, chord: Array, radius: float, shear: float, poisson: float) -> Array:
    """What of the strains of the parts before and behind it the rim has at each section, at E b = 1.

    Parameters
    ----------
    local : (n + 1, 3, 3) array
        Stiffness of each part in (e, tau_1, tau_2).
    chord : (n + 1,) array
    radius, shear : float
        Of the line through the sections' centres of mass; its compliance by a shear force, per angle.
    poisson : float

    Returns
    -------
    (n + 2, 2, 4, 3) array
        Displacement outward and onward, stretch and slope of the rim by the three strains of the part before and of the
        part behind, the mean of what either says; beside the weld of the one part that is a rod, on it of none.
    """
    of_part = np.zeros((len(chord), 4, 3))
    of_part[:, OUTWARD] = -poisson / 2 * local[:, 0]
    across = (local[:, 1] + local[:, 2]) / chord[:, None]
    of_part[:, ONWARD] = -(2 + poisson) / 10 * across
    of_part[:, STRETCH, 0] = radius / chord
    of_part[:, SLOPE] = shear * across
    seen = np.zeros((len(chord) + 1, 2, 4, 3))
    seen[2:-1, 0] = of_part[1:-1] / 2
    seen[1:-2, 1] = of_part[1:-1] / 2
    seen[[1, -2]] *= 2
    return seen
