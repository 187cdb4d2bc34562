"""The rigid hoop in ``solve_nivp``, an integrator of nonsmooth initial value problems: friction of one coefficient.

Its Coulomb projection acts on one coordinate of the state, within a bound that is a function of the state. So the state
is (phi, L, v), with L the angular momentum about the contact point, which friction does not change, and v the slip
velocity. The bound is the acceleration of v by the friction of a slip, without a limit where Coulomb's law has none to
that side. R = m = g = 1.
"""

from __future__ import annotations

from math import copysign, cos, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

STEPS = (1.6e-2, 4e-3)
LONGEST = 9.5
NONE_TO_THAT_SIDE = 1e4  # over the weight
Array = NDArray[np.float64]


class Hoop(NamedTuple):
    """A massless hoop with r = 1."""

    e: float
    gyration: float
    mu: float


class Parts(NamedTuple):
    """Of a state: what friction has no part in."""

    arm: float  # 1 + e cos phi
    lift: float  # e sin phi
    share: float  # K + e^2 sin^2 phi
    inertia: float  # about the contact point
    omega: float
    load: float  # K (1 - e cos phi phidot^2)
    alpha: float  # on a smooth floor
    slip_rate: float  # on a smooth floor


def parts(hoop: Hoop, state: Array) -> Parts:
    """What equations and bound are made of."""
    phi, momentum, slip = state
    lift, drop = hoop.e * sin(phi), hoop.e * cos(phi)
    arm, share = 1 + drop, hoop.gyration + lift * lift
    inertia = share + arm * arm
    omega = (momentum - arm * slip) / inertia
    load = hoop.gyration * (1 - drop * omega * omega)
    alpha = load * lift / (share * hoop.gyration)
    return Parts(arm, lift, share, inertia, omega, load, alpha, lift * omega * omega - arm * alpha)


def slope(hoop: Hoop, state: Array) -> Array:
    """Rates on a smooth floor."""
    p = parts(hoop, state)
    inertia_rate = (2 * p.lift * (p.arm - 1) - 2 * p.arm * p.lift) * p.omega
    momentum_rate = p.inertia * p.alpha + p.arm * p.slip_rate + inertia_rate * p.omega - p.lift * p.omega * state[2]
    return np.array([p.omega, momentum_rate, p.slip_rate])


def bound(hoop: Hoop, state: Array) -> Array:
    """What friction can add to the rate of the slip velocity."""
    p = parts(hoop, state)
    way = copysign(1.0, state[2] if abs(state[2]) > 1e-12 else p.slip_rate)
    give = p.share + way * hoop.mu * p.lift * p.arm
    normal = p.load / give if give > p.load / NONE_TO_THAT_SIDE else NONE_TO_THAT_SIDE
    return np.array([0.0, 0.0, hoop.mu * normal * p.inertia / p.share])


def roll_turns(k: float, mu: float, phi0: float, turns: int, step: float) -> list[tuple[float, float, float, float]]:
    """Turns as (t, phi, slip velocity, energy), between steps by straight lines.

    Raises
    ------
    ImportError
        ``solve_nivp`` is not installed.
    """
    from solve_nivp import solve_ivp_ns

    hoop, whole = Hoop(1 - k, k * k / 2, mu), [slice(0, 3)]

    def bounded(state: Array, *_: Any) -> Array:
        return bound(hoop, state)

    t, states, *_ = solve_ivp_ns(
        lambda t, state, *_: slope(hoop, state), (0.0, LONGEST), np.array([phi0, 0.0, 0.0]), "composite",
        "coulomb", "semismooth_newton", adaptive=False, h0=step, component_slices=whole,
        projection_opts={
            "con_force_func": bounded, "rhok": np.ones(3), "constraint_indices": [2], "component_slices": whole,
        },
    )  # fmt: skip
    omega = np.array([parts(hoop, state).omega for state in states])
    found = []
    for i in [i for i in np.flatnonzero(omega[1:] * omega[:-1] < 0) if t[i] > 0.1][:turns]:
        share = omega[i] / (omega[i] - omega[i + 1])
        phi, _, slip = states[i] + share * (states[i + 1] - states[i])
        energy = 0.5 * slip * slip + 1 + hoop.e * cos(phi)
        found.append((float(t[i] + share * (t[i + 1] - t[i])), float(phi), float(slip), float(energy)))
    return found
