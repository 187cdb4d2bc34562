"""What bends far bends easier: the energy of fourth order of a part.

Of a straight wall with Green's strain in plane stress, of the thickness h and the curvature kappa, fibres get thinner
and the middle moves as the energy is least; with no force along it the energy over an even bending stiffness is

    kappa^2 (1 - c y)/2,    c = 1 - 2 nu/5 + nu^2/5,    y = (kappa h/2)^2,

to the fourth order. Of c the line has 3 (1 - nu)^2/4 by itself, which shortens as a part that is pulled bends harder
(:mod:`flexible.chain.rod.corotated`); the rest, c_b = 1/4 + 11 nu/10 - 11 nu^2/20, is of the bend tau_2 - tau_1 alone.
A series of such terms falls without end. It is taken as -c_b y/(1 + y), which has that order and its sign of the next
and leaves every part a stiffness, however far it bends.

The first and the last part have the fourth order of the mesh (:mod:`flexible.chain.rod.orders`), in all their strains:
Q/(1 + U/U_s), U the energy of second order. U_s is so large that no bend loses all its stiffness.
"""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import loop

Array = NDArray[np.float64]

CONVEX = 1.3  # the smallest U/U_s at which -Q reaches U; with 5/4 a bend is left without stiffness


def softening_of(bending: float, poisson: float) -> float:
    """Bending stiffness that a part loses as y grows: c_b of it."""
    return bending * (1 / 4 + 11 / 10 * poisson - 11 / 20 * poisson**2)


def strained_of(chord: float, wall: float) -> float:
    """y by the square of tau_2 - tau_1, of a part that bends evenly."""
    return (wall / (2 * chord)) ** 2


def fading_of(far: Array, local: Array) -> float:
    """1/U_s, by the fourth derivatives of an energy and its stiffness: by bends without a force along the line.

    Zero, so that nothing fades, where the fourth order stiffens all of them.
    """
    angle = np.linspace(0, pi, 181)
    bends = np.stack([np.cos(angle), np.sin(angle)])
    strains = np.concatenate([-(local[:1, 1:] @ bends) / local[0, 0], bends])
    energy = np.einsum("ij,ia,ja->a", local, strains, strains) / 2
    fourth = np.einsum("ijkl,ia,ja,ka,la->a", far, strains, strains, strains, strains) / 24
    return float(CONVEX * max(0.0, (-fourth / energy**2).max()))


@loop
def softened(softening: float, strained: float, bend: float) -> tuple[float, float, float]:
    """Energy, moment and stiffness that a part has less for its having bent so far: all three negative, or zero."""
    y = strained * bend * bend
    share = y / (1 + y)
    moment = softening * share * (2 - share) * bend
    slope = softening * share * (2 - share + 4 * (1 - share) * (1 - share))
    return -softening * share * bend * bend / 2, -moment, -slope


@loop
def far_bent(
    far: Any, fading: float, local: Any, x: float, tau_1: float, tau_2: float
) -> tuple[float, float, float, float, float, float, float, float, float, float]:
    """Energy of fourth order of a part at the weld, the force along its line and both moments, and what it adds to its
    stiffness: to the entries 00, 01, 02, 11, 12 and 22."""
    m00, m01, m02, m11, m12, m22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        one = x if k == 0 else (tau_1 if k == 1 else tau_2)
        for j in range(3):
            both = one * (x if j == 0 else (tau_1 if j == 1 else tau_2)) / 2
            m00 += far[0, 0, k, j] * both
            m01 += far[0, 1, k, j] * both
            m02 += far[0, 2, k, j] * both
            m11 += far[1, 1, k, j] * both
            m12 += far[1, 2, k, j] * both
            m22 += far[2, 2, k, j] * both
    q0 = (m00 * x + m01 * tau_1 + m02 * tau_2) / 3
    q1 = (m01 * x + m11 * tau_1 + m12 * tau_2) / 3
    q2 = (m02 * x + m12 * tau_1 + m22 * tau_2) / 3
    energy = (q0 * x + q1 * tau_1 + q2 * tau_2) / 4
    s0 = local[0, 0] * x + local[0, 1] * tau_1 + local[0, 2] * tau_2
    s1 = local[1, 0] * x + local[1, 1] * tau_1 + local[1, 2] * tau_2
    s2 = local[2, 0] * x + local[2, 1] * tau_1 + local[2, 2] * tau_2
    a = 1 / (1 + fading * (x * s0 + tau_1 * s1 + tau_2 * s2) / 2)
    b = -fading * a * a  # the first derivative of a by U, and half the second
    c = -2 * fading * energy * a * b
    e = energy * b
    return (
        energy * a, q0 * a + e * s0, q1 * a + e * s1, q2 * a + e * s2,
        m00 * a + 2 * b * q0 * s0 + e * local[0, 0] + c * s0 * s0,
        m01 * a + b * (q0 * s1 + q1 * s0) + e * local[0, 1] + c * s0 * s1,
        m02 * a + b * (q0 * s2 + q2 * s0) + e * local[0, 2] + c * s0 * s2,
        m11 * a + 2 * b * q1 * s1 + e * local[1, 1] + c * s1 * s1,
        m12 * a + b * (q1 * s2 + q2 * s1) + e * local[1, 2] + c * s1 * s2,
        m22 * a + 2 * b * q2 * s2 + e * local[2, 2] + c * s2 * s2,
    )  # fmt: skip
