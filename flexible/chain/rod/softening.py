"""What bends far bends easier: the energy of fourth order in the bend of a part.

Of a straight wall with Green's strain in plane stress, of the thickness h and the curvature kappa, fibres get thinner
and the middle moves as the energy is least; with no force along it the energy over an even bending stiffness is

    kappa^2 (1 - c y)/2,    c = 1 - 2 nu/5 + nu^2/5,    y = (kappa h/2)^2,

to the fourth order. Of c the line has 3 (1 - nu)^2/4 by itself, which shortens as a part that is pulled bends harder
(:mod:`flexible.chain.rod.corotated`); the rest, c_b = 1/4 + 11 nu/10 - 11 nu^2/20, is of the bend tau_2 - tau_1 alone.
A series of such terms falls without end. It is taken as -c_b y/(1 + y), which has that order and its sign of the next
and leaves every part a stiffness, however far it bends.
"""

from __future__ import annotations

from rigid.kernel.compile import loop


def softening_of(bending: float, poisson: float) -> float:
    """Bending stiffness that a part loses as y grows: c_b of it."""
    return bending * (1 / 4 + 11 / 10 * poisson - 11 / 20 * poisson**2)


def strained_of(chord: float, wall: float) -> float:
    """y by the square of tau_2 - tau_1, of a part that bends evenly."""
    return (wall / (2 * chord)) ** 2


@loop
def softened(softening: float, strained: float, bend: float) -> tuple[float, float, float]:
    """Energy, moment and stiffness that a part has less for its having bent so far: all three negative, or zero."""
    y = strained * bend * bend
    share = y / (1 + y)
    moment = softening * share * (2 - share) * bend
    slope = softening * share * (2 - share + 4 * (1 - share) * (1 - share))
    return -softening * share * bend * bend / 2, -moment, -slope
