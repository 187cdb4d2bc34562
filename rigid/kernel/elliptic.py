"""Carlson's symmetric elliptic integrals R_F and R_J by duplication (DLMF 19.36), the two in one sweep."""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import atan, log, sqrt

from .compile import kernel


@kernel
def r_c(x):
    """R_C(1, 1 + x), x > -1."""
    if abs(x) < 1e-3:
        return 1 - x * (1 / 3 - x * (1 / 5 - x * (1 / 7 - x * (1 / 9 - x * (1 / 11 - x / 13)))))
    if x > 0:
        root = sqrt(x)
        return atan(root) / root
    root = sqrt(-x)
    return 0.5 * log((1 + root) / (1 - root)) / root


@kernel
def r_f_and_r_j(x, y, z, p):
    """R_F(x, y, z) and R_J(x, y, z, p) for x, y, z >= 0, at most one of them 0, and p > 0; relative error
    below 1e-15.
    """
    f0 = (x + y + z) / 3
    j0 = (x + y + z + 2 * p) / 5
    spread = max(abs(j0 - x), abs(j0 - y), abs(j0 - z), abs(j0 - p), abs(f0 - x), abs(f0 - y), abs(f0 - z))
    fm, jm, xm, ym, zm, pm = f0, j0, x, y, z, p
    delta = (p - x) * (p - y) * (p - z)
    quarter = 1.0
    total = 0.0
    # the neglected terms are of seventh order in the spread over the mean
    while quarter * spread > 1.2e-3 * min(fm, jm):
        a, b, c, d = sqrt(xm), sqrt(ym), sqrt(zm), sqrt(pm)
        mix = a * b + b * c + c * a
        denominator = (d + a) * (d + b) * (d + c)
        total += quarter / denominator * r_c(quarter**3 * delta / (denominator * denominator))
        quarter *= 0.25
        fm, jm = 0.25 * (fm + mix), 0.25 * (jm + mix)
        xm, ym, zm, pm = 0.25 * (xm + mix), 0.25 * (ym + mix), 0.25 * (zm + mix), 0.25 * (pm + mix)
    u = quarter * (f0 - x) / fm
    v = quarter * (f0 - y) / fm
    s = -u - v
    e2 = u * v - s * s
    e3 = u * v * s
    r_f = (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44 - 5 * e2**3 / 208 + 3 * e3 * e3 / 104) / sqrt(fm)
    u = quarter * (j0 - x) / jm
    v = quarter * (j0 - y) / jm
    s = quarter * (j0 - z) / jm
    q = -(u + v + s) / 2
    e2 = u * v + u * s + v * s - 3 * q * q
    e3 = u * v * s + 2 * e2 * q + 4 * q**3
    e4 = (2 * u * v * s + e2 * q + 3 * q**3) * q
    e5 = u * v * s * q * q
    series = (
        1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26
        - e2**3 / 16 + 3 * e3 * e3 / 40 + 3 * e2 * e4 / 20
    )  # fmt: skip
    return r_f, quarter * series / (jm * sqrt(jm)) + 6 * total
