"""Skidding and spinning in series: (10) to (16), with the normal impulse as the independent variable.

With dt = D dtau, where D = K + e s P and P = e s + mu^ (1 + e c), the equation of motion (12) loses its
denominator:

    dphi/dtau = D w,   dw/dtau = P b,   b = 1 - e c w^2,   d(impulse) = N dt = K b dtau      (w = phidot).

All of it is polynomial in (s, 1 + c, w), so its Taylor series follow from convolutions and every step is
summed to round-off. tau is proportional to the normal impulse, so neither the pulse of a tiny disk (D ~ k^2)
nor a near-jam (D -> 0+, N ~ 1/D) needs small steps: both are passed in a number of steps that grows like the
logarithm. The slip velocity is the first integral xdot_G + mu^ (ydot_G + t) = const; N = K b/D, and N - 1 is
the slope of ydot_G.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import exp, log

from ...kernel.angle import trig
from ...kernel.compile import kernel
from ...kernel.layout import (
    ECC,
    GYR,
    ONE_MINUS_E,
    ORDER,
    S_B,
    S_CO,
    S_D,
    S_H,
    S_N1,
    S_OMEGA,
    S_P,
    S_SIN,
    S_SLIP,
    S_T,
    S_YDOT,
)
from ...kernel.polynomial import value

TOLERANCE = -34.0  # log of the neglected term over the leading one: below round-off
SHORTER = 0.7  # of a step that goes beyond a quarter turn is left
JAM = 1e-13  # D/K below which the contact is jammed: D is then round-off of its terms


@kernel
def known_p(p, terms, carried):
    """P from the angle, or as carried along by the series where its terms have cancelled.

    P -> 0 is where a hoop of little inertia jams (D = K + e s P); D keeps its digits there only if P does.
    """
    if abs(p) < 1e-3 * terms and abs(p - carried) <= 1e-13 * terms:
        return carried
    return p


@kernel
def series(par, mu_hat, angle, omega, slip, p_known, work):
    """Taylor coefficients in tau of one step from the angle (as :func:`rigid.kernel.angle.trig` gives it), phidot and
    the slip velocity, and the length over which they are exact to round-off, of a quarter turn at most.

    ``work`` holds, by index: sin phi, 1 + cos phi, phidot, phidot cos phi, P, D, b, ydot_G, slip velocity,
    time from the start of the step, and N - 1 times D.
    """
    s, c, h, _ = angle
    e, one_minus_e, gyr = par[ECC], par[ONE_MINUS_E], par[GYR]
    sn, hh, om, co, pp, dd = work[S_SIN], work[S_H], work[S_OMEGA], work[S_CO], work[S_P], work[S_D]
    bb, yd, vv, tt, n1 = work[S_B], work[S_YDOT], work[S_SLIP], work[S_T], work[S_N1]
    me = mu_hat * e
    arm = mu_hat * (one_minus_e + e * h)
    p = known_p(e * s + arm, e * abs(s) + abs(arm), p_known)
    b, d = 1.0 - e * c * omega * omega, gyr + e * s * p
    sn[0], hh[0], om[0], co[0], pp[0], bb[0], dd[0] = s, h, omega, c * omega, p, b, d
    yd[0], vv[0], tt[0], n1[0] = -e * s * omega, slip, 0.0, gyr * b - d
    om[1], sn[1], hh[1], tt[1], yd[1] = p * b, co[0] * d, yd[0] * d / e, d, n1[0]
    for n in range(1, ORDER + 1):
        # the inner terms of all products at once: independent sums keep the arithmetic units busy
        h_om = 0.0
        s_p = 0.0
        co_om = 0.0
        p_b = 0.0
        co_d = 0.0
        y_d = 0.0
        for j in range(1, n):
            w, q, f = om[n - j], pp[n - j], dd[n - j]
            h_om += hh[j] * w
            co_om += co[j] * w
            s_p += sn[j] * q
            p_b += bb[j] * q
            co_d += co[j] * f
            y_d += yd[j] * f
        pn = e * sn[n] + me * hh[n]
        h_om += h * om[n] + hh[n] * omega
        cn = h_om - om[n]
        bn = -e * (co_om + co[0] * om[n] + cn * omega)
        dn = e * (s_p + s * pn + sn[n] * p)
        pp[n], co[n], bb[n], dd[n] = pn, cn, bn, dn
        n1[n] = gyr * bn - dn
        vv[n] = -mu_hat * gyr * bb[n - 1] / n - one_minus_e * om[n] - e * h_om
        if n < ORDER:
            m = n + 1
            om[m] = (p_b + p * bn + pn * b) / m
            sn[m] = (co_d + co[0] * dn + cn * d) / m
            hh[m] = (y_d + yd[0] * dn + yd[n] * d) / (e * m)
            yd[m] = n1[n] / m
            tt[m] = dn / m
    length = min(step_length(om, 0), step_length(sn, 0), 1e3 / (abs(dd[0]) + 1e-6))
    if dd[0] < 1e-3 * (gyr + e * e * s * s):
        # towards a jam D decays alone, while the angle stands still
        length = min(length, step_length(dd, 0))
    # a disk at next to no distance from the centre goes round by up to 2.5 in a step: sin and cos leave the turn open
    while c * (value(hh, ORDER, length) - 1.0) + s * value(sn, ORDER, length) < 0.0:
        length *= SHORTER
    return length


@kernel
def step_length(c, first):
    """The x at which the last two terms drop below round-off of one of the leading two."""
    big0 = log(abs(c[first]) + 1e-300)
    big1 = log(abs(c[first + 1]) + 1e-300)
    length = 690.0
    for n in range(ORDER - 1, ORDER + 1):
        last = log(abs(c[n]) + 1e-300)
        reach = max((TOLERANCE + big0 - last) / (n - first), (TOLERANCE + big1 - last) / (n - first - 1))
        length = min(length, reach)
    return exp(length)


@kernel
def normal_force(par, mu_hat, omega, a, top):
    """N = K (1 - e c phidot^2)/D over M g, (13); F = -mu^ N."""
    e, gyr = par[ECC], par[GYR]
    s, c, h, _ = trig(a, top)
    d = gyr + e * s * (e * s + mu_hat * (par[ONE_MINUS_E] + e * h))
    return gyr * (1 - e * c * omega * omega) / d


@kernel
def slipping_acceleration(par, mu_hat, normal, a, top):
    """phiddot = N P/K, the moments of N and F = -mu^ N about G, (11)."""
    s, _, h, _ = trig(a, top)
    return normal * (par[ECC] * s + mu_hat * (par[ONE_MINUS_E] + par[ECC] * h)) / par[GYR]


@kernel
def denominator(par, mu_hat, a, top):
    """D = K + e s P; the contact point is free to leave the floor with acceleration D/K per unit of normal
    force.
    """
    s, _, h, _ = trig(a, top)
    return par[GYR] + par[ECC] * s * (par[ECC] * s + mu_hat * (par[ONE_MINUS_E] + par[ECC] * h))
