"""What a rolling patch must slip to carry a friction force: the outer solution of the inner problem.

Where the forces change slowly the patch is in steady rolling and V follows F, N and Omega. It is the one effect of
order eps that the contact's compliance has on the rigid motion: v = eps V instead of 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

from flexible.contact.points.normal import half_width as width_on

from .march.equations import BRUSH, REGULARISED, ScaledContact


@dataclass(frozen=True, slots=True)
class Creep:
    """Steady rolling under given forces."""

    slip: float
    """V."""
    drag: float
    """Part of F that the damper carries, and not the bristles."""


def half_width(normal: float) -> float:
    """A, from N = (2/3) A^3: of the scaled patch, whose foundation is 1."""
    return width_on(normal, 1.0)


def creep(contact: ScaledContact, normal: float, friction: float, omega: float) -> Creep:
    """Steady rolling at ``omega`` under N and F; V is infinite where the law cannot carry F.

    ``patch``: z = V (A + s)/|Omega|, or A - s where Omega < 0, so F = -kappa V (2 A)^2/(2 |Omega|) - theta kappa 2 A V:
    the damper carries its share. ``brush``: the part b of the patch, from its leading edge, sticks, and

        |F|/N = 3 mu_s (b^2 - b^3) + mu (1 - 3 b^2 + 2 b^3),   |V| = mu_s A (1 - b) |Omega|/kappa.

    ``regularised``: F = -mu N V/sqrt(V^2 + V_s^2).
    """
    half, omega = half_width(normal), abs(omega)
    if contact.law == REGULARISED:
        used = friction / (contact.mu * normal)
        return Creep(-contact.slip_scale * used / sqrt(1 - used * used) if abs(used) < 1 else -used * inf, 0.0)
    if contact.law == BRUSH:
        b = sticking_part(contact.mu_s, contact.mu, abs(friction) / normal)
        size = contact.mu_s * half * (1 - b) * omega / contact.kappa
        return Creep(-size if friction > 0 else size, 0.0)
    transit = half / omega if omega > 0 else inf
    return Creep(
        -friction / (2 * half * contact.kappa * (transit + contact.theta)),
        friction * contact.theta / (transit + contact.theta),
    )


def strongest_part(mu_s: float, mu: float) -> float:
    """b of the rolling brush that carries most."""
    return 2 * (mu_s - mu) / (3 * mu_s - 2 * mu) if mu_s > mu else 0.0


def carried(b: float, mu_s: float, mu: float) -> float:
    """F/N of a rolling brush whose part b sticks; the most is ``effective_mu_s`` of the law, there in compiled code."""
    return 3 * mu_s * (b**2 - b**3) + mu * (1 - 3 * b**2 + 2 * b**3)


def sticking_part(mu_s: float, mu: float, ratio: float) -> float:
    """b of a rolling brush that carries F/N = ``ratio``, the larger of the two where there are two."""
    strongest = strongest_part(mu_s, mu)
    if ratio >= carried(strongest, mu_s, mu):
        return strongest
    if mu_s == mu:
        return float((1 - ratio / mu) ** (1 / 3))
    from scipy.optimize import brentq

    return float(brentq(lambda b: carried(b, mu_s, mu) - ratio, strongest, 1.0, xtol=1e-15))
