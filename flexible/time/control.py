"""How long the next step is, by the errors of the last two."""

from __future__ import annotations

from typing import NamedTuple

from rigid.kernel.compile import loop

SAFETY = 0.9  # of a step whose error is foreseen
LEAST, MOST = 0.2, 3.0  # change of length from one step to the next
SMALL = 1e-2  # error over its tolerance below which its size foretells nothing


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
