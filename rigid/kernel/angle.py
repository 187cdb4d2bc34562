"""The angle phi without loss of digits near the bottom or the top.

phi = pi + a + 2 pi n (chart 0, around the bottom) or phi = a + 2 pi n (chart 1, around the top), |a| <= pi/2.
Small disks pass the floor within |a| ~ k, and a release near the top is slow by log(1/phi0): both live on the
digits of ``a``, which phi itself does not have.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import atan, floor, pi, sin

from .compile import kernel

PI_LOW = 1.2246467991473532e-16  # pi - float(pi)
HALF_PI = pi / 2


@kernel
def chart(a, top, n):
    """The same angle with |a| <= pi/2."""
    if abs(a) > 4.0:
        turns = floor(a / (2 * pi) + 0.5)
        a = (a - turns * (2 * pi)) - turns * (2 * PI_LOW)
        n += turns
    while abs(a) > HALF_PI:
        if a > 0:
            a = (a - pi) - PI_LOW
            if top == 0.0:
                n += 1.0
        else:
            a = (a + pi) + PI_LOW
            if top != 0.0:
                n -= 1.0
        top = 1.0 - top
    return a, top, n


@kernel
def trig(a, top):
    """sin phi, cos phi, 1 + cos phi and 1 - cos phi, each to its own last digits."""
    if top == 0.0:
        half = sin(0.5 * a)
        h = 2 * half * half
        return -sin(a), h - 1.0, h, 2.0 - h
    half = sin(0.5 * a)
    low = 2 * half * half
    return sin(a), 1.0 - low, 2.0 - low, low


@kernel
def angle_of(a, top, n):
    """phi in radians."""
    if top == 0.0:
        return pi + a + 2 * pi * n
    return a + 2 * pi * n


@kernel
def advance_between(a0, top0, n0, a1, top1, n1):
    """phi_1 - phi_0, exact for neighbours."""
    if top0 == top1:
        return (a1 - a0) + 2 * pi * (n1 - n0)
    return angle_of(a1, top1, n1 - n0) - angle_of(a0, top0, 0.0)


@kernel
def next_angle(s, h, top, n):
    """The angle with sin phi = s and 1 + cos phi = h, less than a quarter turn from chart ``top`` of turn
    ``n``.
    """
    if h < 1.0:
        if top != 0.0 and s < 0:
            n -= 1.0
        return -2 * atan(s / (2 - h)), 0.0, n
    if top == 0.0 and s < 0:
        n += 1.0
    return 2 * atan(s / h), 1.0, n
