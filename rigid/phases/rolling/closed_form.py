"""Rolling without slipping, in closed form: (4) to (8) and (17) to (19).

With h = 1 + cos phi the energy integral (7), (18) reads phidot^2 = 2 (G - h)/(zeta + 2 h): G is the height
that the motion would turn at. Near the bottom of a small hoop h ~ k^2, so every expression below is written
in h and in 1 - e, free of cancellation.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import asin, inf, pi, sin, sqrt, tan

from ...kernel.angle import trig
from ...kernel.compile import kernel
from ...kernel.elliptic import r_f_and_r_j
from ...kernel.layout import ECC, GYR, MU_S, ONE_MINUS_E, ZETA
from ...kernel.polynomial import first_positive, value_and_slope

TIE = 1e-12  # |F| may exceed mu_s N by this fraction and still hold: round-off of a start on the edge


@kernel
def ceiling(zeta, omega, h, low):
    """G and 2 - G from the state; ``low`` = 2 - h."""
    lift = 0.5 * omega * omega * (zeta + 2 * h)
    return h + lift, low - lift


@kernel
def rolling_forces(par, omega, a, top):
    """(N, F) of rolling, (5), (8): the forces over M g."""
    e, zeta = par[ECC], par[ZETA]
    s, _, h, low = trig(a, top)
    g, _ = ceiling(zeta, omega, h, low)
    z = zeta + 2 * h
    b = zeta + 2 * g
    q3 = normal_cubic(e, par[ONE_MINUS_E], zeta, g, h)
    q2 = (par[ONE_MINUS_E] + e * h) * b - 2 * e * (g - h) * z
    return q3 / (z * z), s * q2 / (z * z)


@kernel
def rolling_acceleration(zeta, omega, a, top):
    """phiddot = sin phi (1 + phidot^2)/(zeta + 2 h) of rolling, the equation of motion (4)."""
    s, _, h, _ = trig(a, top)
    return s * (1 + omega * omega) / (zeta + 2 * h)


@kernel
def normal_cubic(e, one_minus_e, zeta, g, h):
    """N (zeta + 2 h)^2, a cubic in h."""
    q2 = 4 * one_minus_e + e * (3 * zeta - 2 * g)
    return zeta * (zeta + 2 * e * g) + h * (zeta * (4 * one_minus_e - 2 * e * g) + h * (q2 + h * 4 * e))


@kernel
def margin_polynomials(par, g, reverse, plus, minus):
    """+-|F| - mu_s N, times (zeta + 2 h)^2 (1 + y^2)^3, as polynomials of degree 6 in y = tan|psi/2|, psi =
    phi - pi.

    ``reverse`` writes them in 1/y, for the upper half.
    """
    e, one_minus_e, zeta, mu_s = par[ECC], par[ONE_MINUS_E], par[ZETA], par[MU_S]
    # F z^2/s = a0 + a1 h + a2 h^2; 1 - e - 2 e G + ... regrouped: e (1 - e) - K is all that can cancel, and
    # does so mildly
    a0 = one_minus_e * zeta + 2 * g * (e * one_minus_e - par[GYR])
    a1 = e * (3 * zeta - 2 * g)
    a2 = 4 * e
    q0 = zeta * (zeta + 2 * e * g)
    q1 = zeta * (4 * one_minus_e - 2 * e * g)
    q2 = 4 * one_minus_e + e * (3 * zeta - 2 * g)
    q3 = 4 * e
    odd0 = 2 * a0
    odd1 = 4 * (a0 + a1)
    odd2 = 2 * (a0 + 2 * a1 + 4 * a2)
    even0 = -mu_s * q0
    even1 = -mu_s * (3 * q0 + 2 * q1)
    even2 = -mu_s * (3 * q0 + 4 * q1 + 4 * q2)
    even3 = -mu_s * (q0 + 2 * q1 + 4 * q2 + 8 * q3)
    if reverse:
        odd0, odd2 = odd2, odd0
        even0, even1, even2, even3 = even3, even2, even1, even0
    plus[0] = minus[0] = even0
    plus[2] = minus[2] = even1
    plus[4] = minus[4] = even2
    plus[6] = minus[6] = even3
    plus[1], plus[3], plus[5] = odd0, odd1, odd2
    minus[1], minus[3], minus[5] = -odd0, -odd1, -odd2


@kernel
def past_tie(c, start, stop):
    """``start``, or just past the root next to it: |F| = mu_s N to round-off and about to fall below is no slip."""
    y, slope = value_and_slope(c, 6, start)
    hold = 0.0  # mu_s N, in the even terms
    for i in range(6, -1, -2):
        hold = hold * start * start - c[i]
    if y > 0.0 and y <= TIE * hold and slope * (stop - start) < 0:
        past = start - 2 * y / slope
        if (stop - past) * (stop - start) > 0:
            return past
    return start


@kernel
def first_slip(par, g, upper, start, stop, plus, minus, room):
    """First y (or 1/y in the upper half) from ``start`` to ``stop`` at which |F| passes mu_s N, and the sign of
    F sin phi there; y = -1 if it never does.
    """
    margin_polynomials(par, g, upper, plus, minus)
    x = first_positive(plus, 6, past_tie(plus, start, stop), stop, room)
    other = first_positive(minus, 6, past_tie(minus, start, stop), stop, room)
    if x < 0 or (other >= 0 and abs(other - start) < abs(x - start)):
        return other, -1.0
    return x, 1.0


@kernel
def rolling_time(zeta, g, h, low, headroom):
    """Time from the bottom to h on a swing with ceiling G; ``low`` = 2 - h, ``headroom`` = G - h.

    T = x/(a sqrt(zeta)) [zeta R_F + (4/3) x^2 R_J] with x = |cos(phi/2)|, a^2 = G/2 and the arguments
    (1 + 4 x^2/zeta, 1 - x^2/a^2, 1 - x^2; 1).
    """
    if headroom <= 0.0 and low <= 0.0:
        return inf
    x2 = 0.5 * h
    if x2 == 0.0:
        return 0.0
    rf, rj = r_f_and_r_j(1 + 4 * x2 / zeta, max(headroom, 0.0) / g, max(0.5 * low, 0.0), 1.0)
    return sqrt(x2 / (0.5 * g * zeta)) * (zeta * rf + 4 / 3 * x2 * rj)


@kernel
def headroom_at(g, below, a, top):
    """G - h at an angle, without cancellation; ``below`` = 2 - G."""
    _, _, h, low = trig(a, top)
    if below <= 0:
        return low - below
    if g <= 1:
        if top != 0.0:
            return 0.0
        turn = 2 * asin(sqrt(0.5 * g))
        return max(0.0, 2 * sin(0.5 * (turn - abs(a))) * sin(0.5 * (turn + abs(a))))
    if top == 0.0:
        return g - h
    turn = 2 * asin(sqrt(0.5 * below))
    return max(0.0, 2 * sin(0.5 * (abs(a) - turn)) * sin(0.5 * (abs(a) + turn)))


@kernel
def turning_point(g, below):
    """(|offset|, chart) of the turn of a swing, (0, 1) for one that goes over the top."""
    if below <= 0:
        return 0.0, 1.0
    if g <= 1:
        return 2 * asin(sqrt(0.5 * g)), 0.0
    return 2 * asin(sqrt(0.5 * below)), 1.0


@kernel
def pulse_edge(zeta, g):
    """h at which rolling has N = M g: N > M g below it. 0 at rest on the bottom."""
    c0 = 2 * g * zeta
    c1 = -(4 + 2 * g) * zeta
    c2 = 3 * zeta - 4 - 2 * g
    # c0 + c1 h + c2 h^2 + 4 h^3 falls through its first root and is negative at the end of the swing
    low = 0.0
    high = min(g, 2.0)
    x = min(0.5 * high, sqrt(c0 / (4 + 2 * g)))
    for _ in range(100):
        y = c0 + x * (c1 + x * (c2 + 4 * x))
        if y > 0:
            low = x
        else:
            high = x
        d = c1 + x * (2 * c2 + 12 * x)
        new = x - y / d if d != 0 else low
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - x) <= 2e-16 * new:
            return new
        x = new
    return x


@kernel
def slip_edges(par, g, below, a, top, plus, minus, room):
    """How far a swing may roll: (y or -1, chart, sign of F sin phi) of the nearest slip inwards and outwards of
    the angle.

    The forces depend on |psi| only, so the stretch around the present |psi| in which friction holds is all
    one needs.
    """
    turn_a, turn_top = turning_point(g, below)
    y = tan(0.5 * abs(a))
    inner = -1.0
    inner_top = top
    if top != 0.0:
        inner, inner_pull = first_slip(par, g, True, y, 1.0, plus, minus, room)
        if inner < 0:
            inner_top = 0.0
            inner, inner_pull = first_slip(par, g, False, 1.0, 0.0, plus, minus, room)
    else:
        inner, inner_pull = first_slip(par, g, False, y, 0.0, plus, minus, room)
    outer = -1.0
    outer_top = top
    end = tan(0.5 * turn_a)
    if top == 0.0:
        outer, outer_pull = first_slip(par, g, False, y, end if turn_top == 0.0 else 1.0, plus, minus, room)
        if outer < 0 and turn_top != 0.0:
            outer_top = 1.0
            outer, outer_pull = first_slip(par, g, True, 1.0, end, plus, minus, room)
    else:
        outer, outer_pull = first_slip(par, g, True, y, end, plus, minus, room)
    return inner, inner_top, inner_pull, outer, outer_top, outer_pull


@kernel
def angle_at_time(zeta, g, below, time):
    """(|offset|, chart, G - h) at a time from the bottom of one swing: Newton on a convex increasing
    function.
    """
    full = below <= 0
    a2 = 0.5 * g
    # u: x = a sin u on a swing, x = sin u on a rotation; dT/du is smooth and grows with u
    limit = 0.5 * pi
    scale = 1.0 if full else sqrt(a2)
    rate = sqrt(a2) if full else 1.0
    u = min(limit, max(time * rate / (sqrt(zeta) + 1e-300), 0.0))
    if u * scale > sqrt(zeta):
        u = min(limit, sqrt(time * rate / scale))
    low, high = 0.0, limit
    for _ in range(100):
        s = sin(u)
        co2 = sin(limit - u) ** 2
        if full:
            h, headroom = 2 * s * s, 2 * co2 - below
            lo = 2 * co2
            slope = 2 * sqrt((zeta + 2 * h) / (2 * headroom)) if headroom > 0 else inf
        else:
            h, headroom = g * s * s, g * co2
            lo = below + g * co2
            slope = sqrt((zeta + 2 * h) / (0.5 * lo)) if lo > 0 else inf
        error = rolling_time(zeta, g, h, lo, headroom) - time
        if error > 0:
            high = u
        else:
            low = u
        new = u - error / slope
        if not low <= new <= high:
            new = 0.5 * (low + high)
        if abs(new - u) <= 3e-16 * abs(u) or error == 0.0:
            break
        u = new
    s = sin(u)
    co2 = sin(limit - u) ** 2
    if full:
        x2, y2, headroom = s * s, co2, 2 * co2 - below
    else:
        x2, y2, headroom = a2 * s * s, 0.5 * below + a2 * co2, g * co2
    if x2 <= 0.5:
        return 2 * asin(sqrt(x2)), 0.0, headroom
    return 2 * asin(sqrt(y2)), 1.0, headroom
