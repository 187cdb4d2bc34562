"""How long the next step is, by the errors of the last two; and how far a leap goes, where no step however short leads
on."""

from __future__ import annotations

from typing import NamedTuple

from rigid.kernel.compile import loop

SAFETY = 0.9  # of a step whose error is foreseen
LEAST, MOST = 0.2, 3.0  # change of length from one step to the next
SMALL = 1e-2  # error over its tolerance below which its size foretells nothing
SHORT = 1e-11  # the step after an event is no shorter: at foundation 1e14 the patch's own period is 1e-6
FARTHEST = 1e-4  # a leap over an instant to which no step however short leads
WIDER, CLOSER = 10.0, 1.5  # is each leap than the one before it; closer where those led nowhere
DARING, RASH = 3.0, 30.0  # times its tolerance a leap may err, and one of those: it is that, or the end of the run
LEAPT = 3e-4  # sqrt(gR) that one of those may err by, however tight the tolerance: a jump is as large for any


class Pace(NamedTuple):
    """The step before: its length, 0 if there was none to learn from, and its error over the tolerance."""

    length: float = 0.0
    error: float = 0.0


AFRESH = Pace()


@loop
def shorter(length: float, error: float, power: float) -> float:
    """Length in place of one that erred so many times the tolerance; errors grow like its power 1/``power``."""
    return length * max(LEAST, SAFETY / error**power)


@loop
def longer(before: Pace, now: Pace, power: float) -> float:
    """Length of the step after ``now``.

    Where forces grow by a constant factor in a time that gets shorter and shorter, as they do towards the pulse, so do
    the steps. What the last error alone asks for is then too long every time: the error is foreseen to change as it
    did from the step before [Gustafsson, ACM Trans. Math. Softw. 20, 1994].
    """
    error = max(now.error, SMALL)
    factor = SAFETY / error**power
    if before.length > 0:
        factor *= min(1.0, now.length / before.length * (max(before.error, SMALL) / error) ** power)
    return now.length * min(max(factor, LEAST), MOST)


@loop
def daring(leap: float, wider: float, tolerance: float) -> float:
    """Times its tolerance a step may err."""
    if leap == 0:
        return 1.0
    return DARING if wider == WIDER else max(RASH, LEAPT / tolerance)


@loop
def farther(leap: float, wider: float) -> tuple[float, float]:
    """The leap to try after one, 0 if there is none, and how much wider it is."""
    if leap < FARTHEST:
        return max(wider * leap, SHORT), wider
    return (SHORT, CLOSER) if wider == WIDER else (0.0, wider)
