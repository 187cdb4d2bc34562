"""Impact with friction in the impulse variable (Darboux, Keller): landing, and the jam of Painlevé.

During an impact the configuration is frozen, so the velocity of the contact point is piecewise linear in the
normal impulse I:  d(un)/dI = D/K while it slips (D of :mod:`rigid.phases.slipping.series`, which may be negative),
dv/dI = -mu^ (1 + (1 + e c)^2/K) - e s (1 + e c)/K, and v = 0 while it sticks.
Slip that stops sticks if mu_s can hold it, else it reverses. Compression ends when un = 0; restitution ends
when the normal force has given back the square of the coefficient times the work of compression (Stronge).

A jam (un = 0, D < 0, pressed to the floor) has no bounded normal force: it is an impact without collision.
Friction drives the contact point into the floor, which takes the slip away (always: D < 0 needs mu beyond the
value at which dv/dI changes sign) until stick or reversal gives D > 0 and turns un back to zero.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import inf, sqrt

from ..kernel.angle import trig
from ..kernel.compile import kernel
from ..kernel.layout import ANGLE, ECC, GYR, MU, MU_S, OMEGA, ONE_MINUS_E, SLIP, TOP, UN, XDOT, YDOT
from .slipping.series import JAM


@kernel
def strike(par, state, restitution):
    """Change phidot, slip and normal velocity of ``state`` by the impact; True if phidot changed its sign."""
    e, gyr, mu = par[ECC], par[GYR], par[MU]
    s, _, h, _ = trig(state[ANGLE], state[TOP])
    es = e * s
    arm = par[ONE_MINUS_E] + e * h
    v, un = state[SLIP], min(state[UN], 0.0)
    jammed = un == 0.0 and v != 0.0
    omega, xdot, ydot = state[OMEGA], state[XDOT], state[YDOT]
    work = 0.0  # of the normal force: negative in compression
    needed = inf  # what restitution has to give back
    for _ in range(12):
        stick = v == 0.0 and abs(es * arm) <= par[MU_S] * (gyr + arm * arm)
        if v != 0.0:
            friction = -mu if v > 0 else mu
        else:
            friction = mu if s > 0 else -mu
        # while it sticks, es - friction arm = es K/(K + arm^2), written so that a small K keeps its digits
        spin_rate = es / (gyr + arm * arm) if stick else (es - friction * arm) / gyr
        un_rate = 1.0 + es * spin_rate
        # round-off of the angle, the sine, the sum and the product in D - K
        noise = 1e-15 * abs(es) * (abs(es) + abs(friction * arm))
        if jammed and v != 0.0 and -noise < un_rate * gyr <= max(noise, JAM * gyr):
            # D is zero to round-off, whatever its sign; where D > 0 a contact point that grazes the floor is not jammed
            un_rate, spin_rate = -1e-30, -1 / es
        along_rate = arm * spin_rate if stick else friction
        v_rate = 0.0 if stick else friction - arm * spin_rate
        # next: the slip stops, compression ends, or restitution is complete
        to_stop = -v / v_rate if v * v_rate < 0 else inf
        to_end = inf
        over = False
        if un < 0.0 or (un == 0.0 and needed == inf and un_rate < 0):
            if un_rate > 0:
                to_end = -un / un_rate
        elif needed == inf:
            needed = -restitution * restitution * work
            if needed <= 0.0:
                un = 0.0
                break
        if needed < inf:
            # un dI + un_rate dI^2/2 = what is left
            if un_rate == 0.0:
                to_end = needed / un if un > 0 else inf
            else:
                root = un * un + 2 * un_rate * needed
                to_end = 2 * needed / (un + sqrt(root)) if root >= 0 and un + sqrt(max(root, 0.0)) > 0 else inf
            over = True
        step = min(to_stop, to_end)
        if step == inf:
            break
        gain = step * (un + 0.5 * un_rate * step)
        omega += spin_rate * step
        un += un_rate * step
        v += v_rate * step
        xdot += along_rate * step
        ydot += step
        if to_stop <= to_end:
            v, jammed = 0.0, False
        if over:
            needed -= gain
            if to_end <= to_stop:
                un = max(un, 0.0)
                break
        else:
            work += gain
            if to_end <= to_stop:
                un = 0.0
    reverses = omega * state[OMEGA] < 0
    state[OMEGA], state[SLIP], state[UN], state[XDOT], state[YDOT] = omega, v, un, xdot, ydot
    return reverses
