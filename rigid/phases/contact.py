"""What the contact of a hoop with inertia does from a state on.

A contact point at rest rolls if |F| <= mu_s N with N >= 0; else the slip starts in the direction in which the contact
point would move without friction. (That slip never lies in Painlevé's D < 0: if it did, rolling would be admissible.)
One that moves is carried on, lifts off or jams; the rules for that are with the phase machine,
:mod:`rigid.phases.choice`.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from ..kernel.angle import trig
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    ANGLE,
    ECC,
    FLIGHT,
    GAP,
    GYR,
    IMPACT,
    MU,
    MU_S,
    OMEGA,
    ONE_MINUS_E,
    PULL,
    ROLL,
    SKID,
    SLIP,
    SPIN,
    TOP,
    UN,
)
from .flight import lifts
from .rolling.closed_form import TIE, rolling_forces
from .slipping.series import JAM, denominator
from .slipping.step import is_upright


@kernel
def slip_kind(par, state):
    """Slip, flight, or IMPACT in a jam, where rolling is out of the question; what F has pulled before is used up."""
    a, top, omega = state[ANGLE], state[TOP], state[OMEGA]
    s, c, h, _ = trig(a, top)
    e, gyr, v = par[ECC], par[GYR], state[SLIP]
    if lifts(e, omega, s, c):
        return FLIGHT
    pull = state[PULL]
    state[PULL] = 0.0
    if v == 0.0 and pull != 0.0:
        # the end of a rolling knows which way F has pulled; where N is round-off, as when the contact force of a hoop
        # of next to no inertia has died out, F = N e s/(1 + e c) changes sign with it, and the slip follows sin phi
        n, _ = rolling_forces(par, omega, a, top)
        v = -pull if abs(n) > 1e-14 * (1 + omega * omega) else s
    elif v == 0.0:
        # acceleration of the contact point under the normal force of a smooth floor
        arm = par[ONE_MINUS_E] + e * h
        n = gyr * (1 - e * c * omega * omega) / (gyr + e * e * s * s)
        if is_upright(s, omega):
            s = c * omega
        v = e * s * omega * omega - arm * e * s * n / gyr
    sign = 1.0 if v > 0 else -1.0
    if denominator(par, par[MU] * sign, a, top) > JAM * gyr:
        return SKID if sign > 0 else SPIN
    return IMPACT


@kernel
def contact_kind(par, state):
    """What it does from here on, IMPACT in a jam; as :func:`slip_kind`."""
    if state[GAP] > 0.0 or state[UN] > 0.0:
        return FLIGHT
    if state[SLIP] == 0.0:
        n, f = rolling_forces(par, state[OMEGA], state[ANGLE], state[TOP])
        # without friction what turns rolls for no time, where F passes through 0
        lasts = par[MU_S] > 0.0 or state[OMEGA] == 0.0
        if n >= 0.0 and abs(f) <= par[MU_S] * n * (1 + TIE) and lasts:
            return ROLL
    return slip_kind(par, state)
