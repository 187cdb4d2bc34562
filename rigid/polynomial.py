"""Real roots of polynomials on an interval: isolated, so that none is stepped over, then polished.

Coefficients run from the constant upwards.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import sqrt

from .kernel import kernel

SAMPLES = 8


@kernel
def value(c, n, x):
    """c[0] + c[1] x + ... + c[n] x^n, as four polynomials in x^4 that do not wait for each other."""
    x2 = x * x
    x4 = x2 * x2
    last = n - n % 4
    y0 = c[last]
    y1 = c[last + 1] if last + 1 <= n else 0.0
    y2 = c[last + 2] if last + 2 <= n else 0.0
    y3 = c[last + 3] if last + 3 <= n else 0.0
    for i in range(last - 4, -1, -4):
        y0 = y0 * x4 + c[i]
        y1 = y1 * x4 + c[i + 1]
        y2 = y2 * x4 + c[i + 2]
        y3 = y3 * x4 + c[i + 3]
    return (y0 + x * y1) + x2 * (y2 + x * y3)


@kernel
def value_and_slope(c, n, x):
    """A polynomial and its derivative, in the manner of :func:`value`."""
    x2 = x * x
    x4 = x2 * x2
    last = n - n % 4
    y0 = c[last]
    y1 = c[last + 1] if last + 1 <= n else 0.0
    y2 = c[last + 2] if last + 2 <= n else 0.0
    y3 = c[last + 3] if last + 3 <= n else 0.0
    d0 = 0.0
    d1 = 0.0
    d2 = 0.0
    d3 = 0.0
    for i in range(last - 4, -1, -4):
        d0 = d0 * x4 + y0
        d1 = d1 * x4 + y1
        d2 = d2 * x4 + y2
        d3 = d3 * x4 + y3
        y0 = y0 * x4 + c[i]
        y1 = y1 * x4 + c[i + 1]
        y2 = y2 * x4 + c[i + 2]
        y3 = y3 * x4 + c[i + 3]
    slope = (y1 + 2 * x * y2) + x2 * (3 * y3 + 4 * x * ((d0 + x * d1) + x2 * (d2 + x * d3)))
    return (y0 + x * y1) + x2 * (y2 + x * y3), slope


@kernel
def polish(c, n, low, high):
    """The root between ``low`` and ``high``, where the polynomial has opposite signs: Newton kept in its
    bracket.
    """
    rising = value(c, n, high) > 0
    x = 0.5 * (low + high)
    for _ in range(200):
        y, d = value_and_slope(c, n, x)
        if y == 0.0:
            return x
        if (y > 0) == rising:
            high = x
        else:
            low = x
        new = x - y / d if d != 0.0 else low - 1.0
        if not min(low, high) < new < max(low, high):
            if 0 < 4 * min(low, high) < max(low, high):
                new = sqrt(low * high)
            else:
                new = 0.5 * (low + high)
        if abs(new - x) <= 2.3e-16 * abs(new) or new in (low, high):
            return new
        x = new
    return x


@kernel
def first_positive(c, n, start, stop):
    """First x on the way from ``start`` to ``stop`` (both >= 0, either order) beyond which the polynomial is
    positive.

    -1 if there is none. An interval is dropped when the polynomial is bounded below zero on it: for x >= 0
    the terms of positive and of negative coefficients are each monotone. It is decided when the slope keeps
    its sign, by the same bound; else it is halved, geometrically over several orders of magnitude, so that
    all scales are seen.
    """
    here = start
    there = stop
    for _ in range(2000):
        if here == stop:
            return -1.0
        low = min(here, there)
        high = max(here, there)
        above_low = 0.0
        below_low = 0.0
        above_high = 0.0
        below_high = 0.0
        slope_above_low = 0.0
        slope_below_low = 0.0
        slope_above_high = 0.0
        slope_below_high = 0.0
        for i in range(n, -1, -1):
            slope_above_low = slope_above_low * low + above_low
            slope_below_low = slope_below_low * low + below_low
            slope_above_high = slope_above_high * high + above_high
            slope_below_high = slope_below_high * high + below_high
            up = max(c[i], 0.0)
            down = max(-c[i], 0.0)
            above_low = above_low * low + up
            below_low = below_low * low + down
            above_high = above_high * high + up
            below_high = below_high * high + down
        clear = above_high <= below_low
        if not clear:
            monotone = slope_above_high <= slope_below_low or slope_above_low >= slope_below_high
            narrow = high - low <= 1e-14 * high
            if monotone or narrow:
                if value(c, n, there) > 0:
                    if narrow or value(c, n, here) > 0:
                        return here
                    return polish(c, n, here, there)
                clear = True
        if clear:
            width = there - here
            here = there
            there = here + 2 * width
            if (there - stop) * (stop - start) >= 0:
                there = stop
        elif low > 0 and high > 4 * low:
            there = sqrt(low * high)
        elif low == 0:
            if high < 1e-30:
                return -1.0
            there = 0.0625 * high
        else:
            there = 0.5 * (low + high)
    return -1.0


@kernel
def first_crossing(c, n, length, sign):
    """First x in (0, length] where ``sign`` times a resolved polynomial falls through zero; -1 if it does
    not.

    A root at x = 0 (c[0] = 0, an event that has just happened) does not count; 0 if it is negative from the
    start. The polynomial is a Taylor series well inside its circle of convergence, so it has at most one
    extremum between neighbours of ``SAMPLES`` points, and the slopes there betray it.
    """
    lead = 0
    while lead < n and c[lead] == 0.0:
        lead += 1
    rest = 0.0
    for i in range(n, lead, -1):
        rest = rest * length + abs(c[i])
    if sign * c[lead] > rest * length:
        return -1.0
    if sign * c[lead] < 0:
        return 0.0
    before = 0.0
    y0, d0 = value_and_slope(c, n, 0.0)
    for k in range(1, SAMPLES + 1):
        x = length * k / SAMPLES
        y, d = value_and_slope(c, n, x)
        if sign * y < 0:
            if before == 0.0 and y0 == 0.0:
                # leave the root at zero behind before bracketing the next one
                before = x
                while sign * value(c, n, before) <= 0 and before > 1e-30 * length:
                    before *= 0.5
            return polish(c, n, before, x)
        if sign * d0 < 0 and sign * d > 0:
            low = before
            high = x
            for _ in range(60):
                middle = 0.5 * (low + high)
                ym, dm = value_and_slope(c, n, middle)
                if sign * ym < 0:
                    return polish(c, n, before, middle)
                if sign * dm < 0:
                    low = middle
                else:
                    high = middle
                if high - low < 1e-12 * length:
                    break
        before = x
        y0 = y
        d0 = d
    return -1.0
