"""Where a march stands: all that its next step depends on, so that it can be left there and taken up again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from ..models.state import Books, Record, State
from .control import AFRESH, Pace


class Standing(NamedTuple):
    """A march before its next step, for compiled code."""

    state: State
    step: float  # length of the next step
    pace: Pace  # of the last one
    books: Books
    attempts: int  # steps tried until now
    turns: int
    stalls: int  # events within a shortest step of each other, by now
    cut: bool  # whether a step was made shorter by the end


#: why compiled code comes back: for a pause; at an end; at the end of a mode of friction; at the last step allowed;
#: because no step can be solved, or modes follow each other without end; for the rim near the floor; and, of a single
#: step, because it could not be solved
PAUSED, REACHED, MODE_ENDED, CAPPED, UNSOLVED, STALLED, LACKS, NO_FORCES = range(1, 9)


class Advanced(NamedTuple):
    """What compiled code came to."""

    now: Standing
    written: int  # rows
    why: int
    window: Any  # of rim that is not known, if that is why


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """A march before one of its next steps.

    A march that goes on from here takes the steps that it would have taken if nobody had stopped it, to the last bit.
    """

    now: Standing
    records: list[Record]  # of the whole march; those after the first ``length`` came later
    length: int

    def behind(self) -> list[Record]:
        """The records up to here."""
        return self.records[: self.length]


def beginning(state: State, step: float) -> Standing:
    """Before the first step from ``state``."""
    return Standing(state, step, AFRESH, Books(), 0, 0, 0, False)


class Marched(NamedTuple):
    """What a march came to."""

    state: State
    records: list[Record]  # one for every accepted step, and for the other side of every event
    attempts: int  # steps tried
    ended: str  # empty when one of the ends was reached, otherwise why the march stopped early
    course: Course  # an instant before the steps that the march's own ends made shorter
