"""How a slip starts under a law whose creep grows without end as the friction force nears its most.

Near the instant t = 0 at which the rigid hoop begins to slip (sigma the sign of F, gamma the rate at which the margin
mu N - |F| of rolling closes, m the part of dot v that the margin feels) the creep can no longer follow: with the mean
slip velocity as the unknown the balance of the contact is a first-order equation without a parameter.

``brush``, mu_s = mu: the sticking part b of the patch obeys m eps U db/dt = -gamma t - mu N b^3 with
U = mu A |Omega|/kappa; scaled, y' = -x - y^3. It sticks until y = 0 at x_0 and has then slipped behind the rigid hoop
by x_0^2/2: a change of v of order eps^(6/5).

``brush``, mu_s > mu: about the b at which the patch carries most, y' = -x - y^2, which runs away at Airy's first zero:
the slip starts late by a time of order eps^(2/3).

``regularised``: y' = x + 1/y^2 for the slip itself, which runs ahead of the rigid hoop's x^2/2 by a constant: a change
of v of order v_s^(4/5).
"""

from __future__ import annotations

from functools import cache
from math import copysign, sqrt
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ai_zeros

from ..inner.creep import half_width, strongest_part
from ..inner.events import Event
from ..inner.march.body import Body, arms, rolling_forces, rolling_inertia
from ..inner.march.equations import ScaledContact
from .outer import Shift, passed


@cache
def brush_end() -> float:
    """x_0 of y' = -x - y^3, y -> (-x)^(1/3) for x -> -infinity, with y(x_0) = 0."""

    def full_slip(x: float, y: np.ndarray) -> float:
        return float(y[0])

    full_slip.terminal = True  # type: ignore[attr-defined]
    start = -10.0  # what is wrong there has died out like exp(-integral of 3 y^2), by e^-83
    found = solve_ivp(
        lambda x, y: -x - y**3, (start, 10.0), [(-start) ** (1 / 3)], "DOP853", events=full_slip, rtol=1e-12, atol=1e-13
    )
    return float(found.t[-1])


@cache
def regularised_lead() -> float:
    """Limit of y - x^2/2 for x -> infinity, y' = x + 1/y^2, y -> (-x)^(-1/2) for x -> -infinity."""
    start, end = -8.0, 200.0  # what is wrong at the start has died out like exp(-integral of 2/y^3), by e^-144
    found = solve_ivp(lambda x, y: x + y**-2, (start, end), [(-start) ** -0.5], "DOP853", rtol=1e-13, atol=1e-14)
    return float(found.y[0, -1] - end**2 / 2 + 4 / (3 * end**3))  # the last is what is left beyond the end


class _Balance(NamedTuple):
    sigma: float
    normal: float
    closing: float  # gamma
    mobility: float  # m


def _balance(body: Body, event: Event, most: float) -> _Balance:
    """The contact's balance where rolling reaches |F| = ``most`` N."""
    psi, omega = event.psi, event.omega
    normal, friction, alpha = rolling_forces(body, psi, omega)
    sigma = copysign(1.0, friction)
    step = 1e-5 * sqrt(body.gyration)

    def margin(step: float) -> float:
        n, f, _ = rolling_forces(body, psi + step, omega + step * alpha / omega)
        return most * n - sigma * f

    closing = -omega * (margin(step) - margin(-step)) / (2 * step)
    a, b, _ = arms(body.e, body.one_minus_e, psi)
    mobility = (body.gyration + a * a - sigma * most * a * b) / rolling_inertia(body, psi)
    return _Balance(sigma, normal, closing, mobility)


def brush_lag(body: Body, contact: ScaledContact, event: Event) -> Shift:
    """Derivative by eps^(6/5) behind the start of a slip, brush with mu_s = mu."""
    sigma, normal, closing, mobility = _balance(body, event, contact.mu)
    full = contact.mu * half_width(normal) * abs(event.omega) / contact.kappa
    stuck = (mobility * full * closing / (contact.mu * normal) ** 2) ** (1 / 5)
    return _kick(body, event, sigma * full * stuck * brush_end() ** 2 / 2)


def regularised_gain(body: Body, contact: ScaledContact, event: Event) -> Shift:
    """Derivative by v_s^(4/5) behind the start of a slip."""
    sigma, normal, closing, mobility = _balance(body, event, contact.mu)
    time = (contact.mu * normal * mobility**2 / (2 * closing**3)) ** (1 / 5)
    return _kick(body, event, -sigma * regularised_lead() * closing * time**2 / mobility)


def _kick(body: Body, event: Event, change: float) -> Shift:
    """A change of the slip velocity by forces at the contact."""
    _, b, _ = arms(body.e, body.one_minus_e, event.psi)
    return Shift(-b * change / rolling_inertia(body, event.psi), change, 0.0)


def brush_delay(body: Body, contact: ScaledContact, event: Event, most: float) -> Shift:
    """Derivative by eps^(2/3) behind the start of a slip, brush with mu_s > mu that carries ``most`` N."""
    _, normal, closing, mobility = _balance(body, event, most)
    mu_s, mu = contact.mu_s, contact.mu
    b = strongest_part(mu_s, mu)
    bend = normal * (3 * mu_s * (3 * b - 1) + mu * (3 - 6 * b))
    full = mu_s * half_width(normal) * abs(event.omega) / contact.kappa
    time = (mobility * full) ** (2 / 3) / (closing * bend) ** (1 / 3)
    later = -float(ai_zeros(1)[0][0]) * time * event.omega
    return passed(body, event.psi, event.omega, Shift(0.0, 0.0, 0.0), later, (event.before, event.behind))
