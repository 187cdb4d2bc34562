"""The rigid hoop as its contact sees it: what the forces N and F at the lowest point of the rim do to it.

Units R = g = M = 1 with M the total mass; ``psi = phi - pi`` is the disk's angle from the bottom, in which nothing
cancels where a small disk passes. With s = sin phi, c = cos phi and the arms a = e s and B = 1 + e c of the floor's
forces about the mass centre,

    K alpha = N a - F B,   ddot h = N - 1 + a alpha + e c w,   dot v = F - B alpha + a w,   w = phidot^2.

The functions are plain Python on scalars; :mod:`studies.inner.march.equations` compiles ``arms``, and has the
accelerations written out among the other rates of its state.
"""

from __future__ import annotations

from collections import namedtuple
from math import cos, sin

from rigid import Hoop

Body = namedtuple("Body", ["e", "one_minus_e", "gyration"])
Body.__doc__ = "Eccentricity e of the mass centre over R, 1 - e, and squared radius of gyration K over R^2."


def body_of(hoop: Hoop) -> Body:
    """The three numbers of a hoop that its motion depends on."""
    constants = hoop.constants
    return Body(constants.e, constants.one_minus_e, constants.K)


def arms(e: float, one_minus_e: float, psi: float) -> tuple[float, float, float]:
    """(a, B, e c): arms of N and F about the mass centre, and what multiplies the centripetal term."""
    half = sin(0.5 * psi)
    return -e * sin(psi), one_minus_e + 2 * e * half * half, -e * cos(psi)


def accelerations(
    e: float, one_minus_e: float, gyration: float, psi: float, omega: float, normal: float, friction: float
) -> tuple[float, float, float]:
    """(alpha, ddot h, dot v) under given forces of the floor."""
    a, b, ec = arms(e, one_minus_e, psi)
    w = omega * omega
    alpha = (normal * a - friction * b) / gyration
    return alpha, normal - 1 + a * alpha + ec * w, friction - b * alpha + a * w


def sliding_force(body: Body, psi: float, omega: float, pull: float) -> float:
    """N of a hoop that slides with F = ``pull`` N: K (1 - e c w)/(K + a (a - pull B)), (13)."""
    a, b, ec = arms(body.e, body.one_minus_e, psi)
    return body.gyration * (1 - ec * omega * omega) / (body.gyration + a * (a - pull * b))


def rolling_inertia(body: Body, psi: float) -> float:
    """Moment of inertia about the contact point, K + a^2 + B^2."""
    a, b, _ = arms(body.e, body.one_minus_e, psi)
    return body.gyration + a * a + b * b


def rolling_forces(body: Body, psi: float, omega: float) -> tuple[float, float, float]:
    """(N, F, alpha) of a hoop that rolls, (5), (8)."""
    a, b, ec = arms(body.e, body.one_minus_e, psi)
    w = omega * omega
    alpha = a * (1 + w) / rolling_inertia(body, psi)
    return 1 - a * alpha - ec * w, b * alpha - a * w, alpha


def contact_mobility(body: Body, psi: float) -> tuple[float, float, float]:
    """(by N on ddot h, across, by F on dot v): accelerations of the contact point under unit forces."""
    a, b, _ = arms(body.e, body.one_minus_e, psi)
    return 1 + a * a / body.gyration, -a * b / body.gyration, 1 + b * b / body.gyration
