"""A panel of the quadrature that slipping is, over phi: (12) with its integrating factor, and the time from it.

Over phi (12) is linear in w = phidot^2, so with P, D as in :mod:`rigid.phases.slipping.series`

    w = [D0 w0 + 2 int P E dphi]/(D E),   ln E = mu^ e int (e + c)/D dphi,   t = int dphi/phidot,

three cumulative integrals of smooth functions on Chebyshev nodes. Their only singularities are the zeros of D, of which
two lie at a distance ~ sqrt(K) from the bottom, and those of w, the turns. So the variable is x with
tan(psi/2) = kappa sinh x, psi = phi - pi, kappa = sqrt(K)/(2 e), below the hoop's centre (tan(phi/2) = x above it): the
bottom of a small hoop is no narrower than any other place, and with T = e^x there is no trigonometry in it. A panel
that starts at a turn has x ~ theta^2, in which phidot is smooth; one that comes to a turn is the same panel the other
way round, and so is the way back. theta runs from 0 to 1 over a panel.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import exp, inf, log, sqrt
from typing import NamedTuple

from ...kernel.compile import kernel
from ...kernel.layout import (  # fmt: skip
    ECC,
    GYR,
    NODES,
    ONE_MINUS_E,
    Q_D,
    Q_E,
    Q_F,
    Q_FROM_TURN,
    Q_H,
    Q_INTEGRAL,
    Q_LOG,
    Q_NODE,
    Q_OMEGA,
    Q_OMEGA2,
    Q_SIN,
    Q_STRETCH,
    Q_T,
    Q_X,
    ROW,
)
from ...kernel.spectral import exponentials, largest, least_of, product, tail

CLEAR = 2e-3  # D over its terms: below, towards a jam, P must be carried along (rigid.phases.slipping.series.known_p)
MOST_EXPONENT = 2.5  # of the integrating factor over a panel, and of T in one sum: exp has no reduction


class Panel(NamedTuple):
    """A stretch of angles and how theta runs over it."""

    top: float  # chart: 0 around the bottom, u = tan(psi/2); 1 around the top, u = tan(phi/2)
    start: float  # T = e^x at theta = 0 (chart 0) or u (chart 1)
    kappa: float
    length: float  # in x, with the sign of dphi/dtheta
    turn: bool  # theta = 0 is a turn


@kernel
def panel_at(par, u, top, length, turn):
    """The panel that starts at u = tan(a/2) of a chart."""
    if top != 0.0:
        return Panel(1.0, u, 1.0, length, turn)
    kappa = min(1.0, sqrt(par[GYR]) / (2 * par[ECC]))
    r = abs(u) / kappa
    stretched = r + sqrt(1 + r * r)
    return Panel(0.0, stretched if u >= 0.0 else 1 / stretched, kappa, length, turn)


@kernel
def offset(panel, theta):
    """u at theta."""
    x = panel.length * (theta * theta if panel.turn else theta)
    if panel.top != 0.0:
        return panel.start + x
    t = panel.start * exp(x)
    return 0.5 * panel.kappa * (t - 1 / t)


@kernel
def place_of_bottom(panel):
    """theta where phi = pi; inf if nowhere on the panel."""
    if panel.top != 0.0 or panel.start == 1.0:
        return inf
    share = -log(panel.start) / panel.length
    if not 0.0 < share <= 1.0:
        return inf
    return sqrt(share) if panel.turn else share


@kernel
def place(panel, theta):
    """sin phi and 1 + cos phi at theta."""
    u = offset(panel, theta)
    q = 1 / (1 + u * u)
    if panel.top != 0.0:
        return 2 * u * q, 2 * q
    return -2 * u * q, 2 * u * u * q


@kernel
def unroll(panel, rows):
    """sin phi, 1 + cos phi and dphi/dtheta at the nodes."""
    length, kappa, start = panel.length, panel.kappa, panel.start
    even, odd = (0.0, length) if panel.turn else (length, 0.0)
    wide = abs(length) > MOST_EXPONENT
    part = 0.5 if wide else 1.0
    for i in range(ROW):
        rows[Q_X + i] = part * (even + odd * rows[Q_NODE + i]) * rows[Q_NODE + i]
    if panel.top != 0.0:
        for i in range(ROW):
            v = start + rows[Q_X + i]
            q = 2 / (1 + v * v)
            rows[Q_SIN + i] = v * q
            rows[Q_H + i] = q
            rows[Q_STRETCH + i] = (even + 2 * odd * rows[Q_NODE + i]) * q
    else:
        exponentials(rows, Q_X, Q_E)
        if wide:
            for i in range(ROW):
                rows[Q_E + i] *= rows[Q_E + i]
        for i in range(ROW):
            # from T, T^2 and T u by a single division
            t = start * rows[Q_E + i]
            t2 = t * t
            tu = 0.5 * kappa * (t2 - 1)
            q = 1 / (t2 + tu * tu)
            rows[Q_SIN + i] = -2 * t * tu * q
            rows[Q_H + i] = 2 * tu * tu * q
            rows[Q_STRETCH + i] = kappa * t * (t2 + 1) * (even + 2 * odd * rows[Q_NODE + i]) * q


@kernel
def spin_up(par, mu_hat, panel, d0_w0, rows):
    """phidot^2 (from a turn: over theta^2) at the nodes from D0 w0.

    Returns the part of d(ln E)/dtheta that the nodes do not resolve, inf where D is lost in its terms.
    """
    e, one_minus_e, gyr = par[ECC], par[ONE_MINUS_E], par[GYR]
    me = mu_hat * e
    unroll(panel, rows)
    for i in range(ROW):
        es, h = e * rows[Q_SIN + i], rows[Q_H + i]
        there = gyr + es * (es + mu_hat * (one_minus_e + e * h))
        rows[Q_D + i] = there
        rows[Q_E + i] = there - CLEAR * (gyr + es * es)
        rows[Q_F + i] = me * (h - one_minus_e) / there * rows[Q_STRETCH + i]
    if not least_of(rows, Q_E) > 0.0:
        return inf
    rough = tail(rows, Q_F)
    product(rows, Q_INTEGRAL, Q_F, Q_LOG)
    if not largest(rows, Q_LOG) < MOST_EXPONENT:
        return inf
    exponentials(rows, Q_LOG, Q_E)
    for i in range(ROW):
        p = e * rows[Q_SIN + i] + mu_hat * (one_minus_e + e * rows[Q_H + i])
        rows[Q_F + i] = 2 * p * rows[Q_E + i] * rows[Q_STRETCH + i]
    if panel.turn:
        # near the turn w ~ theta^2 has all its digits
        for i in range(ROW):
            rows[Q_F + i] /= rows[Q_NODE + i]
        product(rows, Q_FROM_TURN, Q_F, Q_OMEGA2)
    else:
        product(rows, Q_INTEGRAL, Q_F, Q_OMEGA2)
    for i in range(ROW):
        rows[Q_OMEGA2 + i] = (d0_w0 + rows[Q_OMEGA2 + i]) / (rows[Q_D + i] * rows[Q_E + i])
    return rough


@kernel
def run_clock(panel, rows):
    """The size of phidot, and the time from theta = 0, at the nodes; returns the part of the time's mean rate that they
    do not resolve.
    """
    for i in range(ROW):
        rows[Q_OMEGA + i] = sqrt(rows[Q_OMEGA2 + i])
    if panel.turn:
        for i in range(ROW):
            rows[Q_OMEGA + i] *= rows[Q_NODE + i]
    for i in range(ROW):
        rows[Q_F + i] = abs(rows[Q_STRETCH + i]) / rows[Q_OMEGA + i]
    product(rows, Q_INTEGRAL, Q_F, Q_T)
    return tail(rows, Q_F) / rows[Q_T + NODES]
