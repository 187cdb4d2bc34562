"""How a perturbation of order eps travels along the rigid motion: its own sensitivities, phase by phase.

A :class:`Shift` is the derivative by eps of phidot, slip velocity and time at a fixed angle psi. Sliding, it follows
the linearised slip equations. Rolling, v = eps V is prescribed by the creep, and the moment of momentum about the
contact point, L = I phidot + B v with I = K + a^2 + B^2, is what no contact force can change:

    dL/dpsi = -(alpha/w) (L - B V) - a V,   phidot's shift = (L - B V)/I,   dt/dpsi's shift = -(phidot's shift)/w.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import copysign, nan, sqrt
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from ..inner.creep import Creep, creep
from ..inner.events import Stretch
from ..inner.march.body import Body, arms, rolling_forces, rolling_inertia, sliding_force
from ..inner.march.equations import ScaledContact

NO_CREEP = Creep(0.0, 0.0)
_ACCURACY: Any = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13}


@dataclass(frozen=True, slots=True)
class Shift:
    """Derivatives by eps at a fixed angle."""

    omega: float
    slip: float
    t: float
    damping_loss: float = 0.0
    """What the damper has taken of the energy so far."""


def roll_along(body: Body, contact: ScaledContact | None, stretch: Stretch, shift: Shift) -> tuple[Shift, float]:
    """The shift at the end of a roll and phidot there; at its start the contact point has come to creep at once.

    Without a contact nothing creeps: what the rigid motion itself makes of a shift.
    """
    way = copysign(1.0, stretch.omega)

    def at(psi: float, w: float) -> tuple[float, float, float, float, float]:
        omega = way * sqrt(w)
        normal, friction, alpha = rolling_forces(body, psi, omega)
        slow = NO_CREEP if contact is None else creep(contact, normal, friction, omega)
        return omega, alpha, slow.slip, slow.drag, rolling_inertia(body, psi)

    def rates(psi: float, y: Any) -> list[float]:
        w, moment = y[0], y[1]
        omega, alpha, slip, drag, inertia = at(psi, w)
        a, b, _ = arms(body.e, body.one_minus_e, psi)
        free = moment - b * slip
        return [2 * alpha, -alpha / w * free - a * slip, -free / (inertia * w), -drag * slip / omega]

    _, b, _ = arms(body.e, body.one_minus_e, stretch.psi_start)
    moment = rolling_inertia(body, stretch.psi_start) * shift.omega + b * shift.slip
    start = [stretch.omega**2, moment, shift.t, shift.damping_loss]
    found = solve_ivp(rates, (stretch.psi_start, stretch.psi_end), start, **_ACCURACY).y[:, -1]
    omega, _, slip, _, inertia = at(stretch.psi_end, found[0])
    _, b, _ = arms(body.e, body.one_minus_e, stretch.psi_end)
    return Shift((found[1] - b * slip) / inertia, slip, float(found[2]), float(found[3])), omega


def slide_along(body: Body, stretch: Stretch, shift: Shift) -> tuple[Shift, float]:
    """The shift at the end of a slip and phidot there."""
    way = copysign(1.0, stretch.omega)
    pull = stretch.pull or 0.0

    def rates(psi: float, y: Any) -> list[float]:
        w, dw = y[0], y[1]
        omega = way * sqrt(w) if w > 0 else nan  # a step that is too long is taken back
        a, b, ec = arms(body.e, body.one_minus_e, psi)
        lever = a - pull * b
        d = body.gyration + a * lever
        alpha = lever * (1 - ec * w) / d
        normal = body.gyration * (1 - ec * w) / d
        slipping = pull * normal - b * alpha + a * w
        by_w = -ec * (pull * body.gyration - b * lever) / d + a
        faster = dw / (2 * omega)
        return [2 * alpha, -2 * ec * lever / d * dw, by_w * dw / omega - slipping * faster / w, -faster / w]

    start = [stretch.omega**2, 2 * stretch.omega * shift.omega, shift.slip, shift.t]
    w, dw, slip, t = solve_ivp(rates, (stretch.psi_start, stretch.psi_end), start, **_ACCURACY).y[:, -1]
    omega = way * sqrt(w)
    return Shift(dw / (2 * omega), float(slip), float(t), shift.damping_loss), omega


def gains(body: Body, psi: float, omega: float, pull: float | None) -> tuple[float, float]:
    """d phidot/dpsi and dv/dpsi of the rigid motion, rolling or sliding."""
    if pull is None:
        return rolling_forces(body, psi, omega)[2] / omega, 0.0
    a, b, _ = arms(body.e, body.one_minus_e, psi)
    normal = sliding_force(body, psi, omega, pull)
    alpha = normal * (a - pull * b) / body.gyration
    return alpha / omega, (pull * normal - b * alpha + a * omega * omega) / omega


def passed(body: Body, psi: float, omega: float, shift: Shift, later: float, pulls: tuple[Any, Any]) -> Shift:
    """The shift beyond an event that happens ``later`` in psi (per eps); ``pulls`` before and behind it."""
    before, behind = (gains(body, psi, omega, pull) for pull in pulls)
    return replace(
        shift,
        omega=shift.omega + (before[0] - behind[0]) * later,
        slip=shift.slip + (before[1] - behind[1]) * later,
    )


def delay_of_stop(body: Body, psi: float, omega: float, shift: Shift, pull: float) -> float:
    """How much later in psi (per eps) a slip comes to its end."""
    return -shift.slip / gains(body, psi, omega, pull)[1]


def delay_of_break(
    body: Body, contact: ScaledContact | None, mu_s: float, psi: float, omega: float, shift: Shift
) -> float:
    """How much later in psi (per eps) a roll reaches |F| = mu_s N: phidot's shift, and what accelerates the creep."""
    normal, friction, alpha = rolling_forces(body, psi, omega)
    sign = 1.0 if friction > 0 else -1.0

    def state(step: float) -> tuple[float, float]:
        return psi + step, omega + step * alpha / omega

    def margin(psi: float, omega: float) -> float:
        normal, friction, _ = rolling_forces(body, psi, omega)
        return sign * friction - mu_s * normal

    def slip(psi: float, omega: float) -> float:
        if contact is None:
            return 0.0
        normal, friction, _ = rolling_forces(body, psi, omega)
        return creep(contact, normal, friction, omega).slip

    step = 1e-5 * sqrt(body.gyration)
    rise = (margin(*state(step)) - margin(*state(-step))) / (2 * step)
    creeping = omega * (slip(*state(step)) - slip(*state(-step))) / (2 * step)
    span = 1e-6 * abs(omega)
    by_omega = (margin(psi, omega + span) - margin(psi, omega - span)) / (2 * span)
    a, b, _ = arms(body.e, body.one_minus_e, psi)
    inertia = rolling_inertia(body, psi)
    by_creeping = (sign * (body.gyration + a * a) - mu_s * a * b) / inertia
    return -(by_omega * shift.omega + by_creeping * creeping) / rise


def grown(body: Body, psi: float, omega: float, slip: float, shift: Shift) -> Any:
    """Derivatives by eps of xdot_G, ydot_G + t and the energy at an angle."""
    a, b, _ = arms(body.e, body.one_minus_e, psi)
    along, up = slip + b * omega, -a * omega
    d_along, d_up = shift.slip + b * shift.omega, -a * shift.omega
    return np.array([d_along, d_up + shift.t, along * d_along + up * d_up + body.gyration * omega * shift.omega])
