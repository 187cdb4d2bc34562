"""Real roots of polynomials on an interval: isolated, so that none is stepped over, then polished.

Coefficients run from the constant upwards.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import inf, sqrt

from .compile import kernel

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
def least(c, sign, first, n, x):
    """A bound from below of ``sign`` (c[first] + c[first + 1] z + ... + c[n] z^(n - first)) over 0 <= z <= x: the least
    of the partial sums S_k at x.

    The polynomial at z = x y is the mean sum S_k (y^k - y^(k + 1)) + S_n y^n of them.
    """
    total = low = sign * c[first]
    power = sign
    for i in range(first + 1, n + 1):
        power *= x
        total += power * c[i]
        low = min(low, total)
    return low


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
    last = inf
    for _ in range(200):
        y, d = value_and_slope(c, n, x)
        if y == 0.0:
            return x
        if (y > 0) == rising:
            high = x
        else:
            low = x
        new = x - y / d if d != 0.0 else low - 1.0
        step = abs(new - x)
        if step <= 2.3e-16 * abs(x) or (step <= 1e-15 * abs(x) and step >= 0.5 * last):
            return x  # its steps are round-off
        last = step
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
def bernstein(c, n, low, high, b):
    """Coefficients of a polynomial of degree n <= 6 on [low, high]: it lies in their convex hull, and has no more roots
    there than they change sign.
    """
    for i in range(n + 1):
        b[i] = c[i]
    for i in range(n):
        for j in range(n - 1, i - 1, -1):
            b[j] += low * b[j + 1]
    ways = 1.0  # n over j
    power = 1.0
    for j in range(n + 1):
        b[j] *= power / ways
        power *= high - low
        ways *= (n - j) / (j + 1)
    for i in range(1, n + 1):
        for j in range(n, i - 1, -1):
            b[j] += b[j - 1]


@kernel
def first_positive(c, n, start, stop, b):
    """First x on the way from ``start`` to ``stop`` (both >= 0, either order) beyond which the polynomial is
    positive; ``b`` is room for n + 1 numbers.

    -1 if there is none. An interval is decided when its Bernstein coefficients change sign once at most; else it is
    halved, geometrically over several orders of magnitude, so that all scales are seen.
    """
    here = start
    there = stop
    while here != stop:
        low = min(here, there)
        high = max(here, there)
        bernstein(c, n, low, high, b)
        changes = 0
        for i in range(n):
            changes += (b[i] > 0.0) != (b[i + 1] > 0.0)
        clear = False
        if changes <= 1 or high - low <= 1e-14 * high:
            first, last = (b[0], b[n]) if here < there else (b[n], b[0])
            if first > 0.0 or (last > 0.0 and changes > 1):
                return here
            if last > 0.0:
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
    if least(c, sign, lead, n, length) > 0.0:
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
