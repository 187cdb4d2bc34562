"""The equations of the inner problem: forces of the scaled patch, and what they do to the hoop.

    p = max(0, -H - s^2/2),    N_el = (2/3) A^3,   A = sqrt(-2 H),    N = N_el + theta N_el' >= 0
    psi' = eps Omega,   Omega' = eps alpha,   H'' = ddot h,   V' = dot v     (:mod:`.body`, ' = d/dtau)

Friction, by law: ``patch`` has F = -kappa times the total stretch of the bristles, less theta kappa 2 A V of the
damper, where it sticks, and -+ mu N where it slides; ``brush`` holds each bristle to the pressure; ``regularised`` is
F = -mu N V/sqrt(V^2 + V_s^2).
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import numpy as np

from rigid.kernel.compile import part

from . import body as mechanics
from .bristles import brush_pull, sliding_share, total_stretch

PATCH, BRUSH, REGULARISED = range(3)  # the codes of the laws in flexible.contact.laws, each in its scaled form here
STICK, SLIDE_RIGHT, SLIDE_LEFT = 0, 1, -1  # a spinning hoop is pushed to the right
# positions in the state of the march
PSI, OMEGA, SLIP, HEIGHT, RATE, WAY, ROLLED, NORMAL_IMPULSE, FRICTION_IMPULSE, FRICTION_WORK = range(10)
STATE = 10

System = namedtuple("System", ["body", "contact", "eps"])
System.__doc__ = "A hoop, its contact, and eps: 0 for the inner problem, the small parameter itself for a whole motion."

ScaledContact = namedtuple("ScaledContact", ["law", "kappa", "mu_s", "mu", "theta", "slip_scale"])
ScaledContact.__doc__ = "Law, tangential ratio, coefficients, relaxation time and V_s on the scaled clock."

arms = part(mechanics.arms)


@part
def normal_force(state: Any, theta: float) -> tuple[float, float, float]:
    """(A, N, eta = N/N_el)."""
    if state[HEIGHT] >= 0:
        return 0.0, 0.0, 1.0
    half = np.sqrt(-2 * state[HEIGHT])
    eta = max(0.0, 1 - 3 * theta * state[RATE] / (half * half))
    return half, eta * 2 / 3 * (half * half * half), eta


@part
def forces(state: Any, contact: Any, mode: int, kept: Any) -> tuple[float, float]:
    """(N, F) at a state, with the bristles as the last step left them."""
    half, normal, eta = normal_force(state, contact.theta)
    if half == 0:
        return 0.0, 0.0
    slip = state[SLIP]
    if contact.law == REGULARISED:
        return normal, -contact.mu * normal * slip / np.sqrt(slip * slip + contact.slip_scale * contact.slip_scale)
    if contact.law == BRUSH:
        return normal, brush_pull(kept, contact, half, state[ROLLED], state[WAY], eta, False)[0]
    if mode != STICK:
        return normal, mode * contact.mu * normal
    stretch = total_stretch(kept, half, state[ROLLED], state[WAY])
    return normal, -contact.kappa * (stretch + contact.theta * 2 * half * slip)


@part
def slopes(state: Any, contact: Any, mode: int, kept: Any, normal: float) -> tuple[float, float, float]:
    """What N and F gain by H', and F by V: what a damper, or a sharply smoothed friction, makes fast."""
    half, _, eta = normal_force(state, contact.theta)
    by_rate = -2 * contact.theta * half if eta > 0 else 0.0
    slip = state[SLIP]
    if contact.law == REGULARISED:
        square = slip * slip + contact.slip_scale * contact.slip_scale
        share = -contact.mu * slip / np.sqrt(square)
        by_slip = -contact.mu * normal * contact.slip_scale * contact.slip_scale / (square * np.sqrt(square))
        return by_rate, share * by_rate, by_slip
    if contact.law == BRUSH:
        # of its points those that slide go with the pressure
        return by_rate, contact.mu * sliding_share(kept, half, state[ROLLED]) * by_rate, 0.0
    if mode != STICK:
        return by_rate, mode * contact.mu * by_rate, 0.0
    return by_rate, 0.0, -contact.kappa * contact.theta * 2 * half


@part
def moved(state: Any, body: Any, eps: float, normal: float, friction: float) -> Any:
    """Derivatives of the state by tau under given forces."""
    a, b, ec = arms(body.e, body.one_minus_e, state[PSI])
    w = state[OMEGA] * state[OMEGA]
    alpha = (normal * a - friction * b) / body.gyration
    out = np.empty(STATE)
    out[PSI], out[OMEGA] = eps * state[OMEGA], eps * alpha
    out[SLIP] = friction - b * alpha + a * w
    out[HEIGHT], out[RATE] = state[RATE], normal - 1 + a * alpha + ec * w
    out[WAY], out[ROLLED] = state[SLIP], state[OMEGA]
    out[NORMAL_IMPULSE], out[FRICTION_IMPULSE], out[FRICTION_WORK] = normal, friction, friction * state[SLIP]
    return out
