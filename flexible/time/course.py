"""Where a march stands: all that its next step depends on, so that it can be left there and taken up again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ..models.state import Books, Record, State
from .control import AFRESH, Pace


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """A march before its next step.

    A march that goes on from here takes the steps that it would have taken if nobody had stopped it, to the last bit.
    """

    state: State
    step: float  # length of the next step
    pace: Pace  # of the last one
    attempts: int  # steps tried until now
    turns: int
    stalls: int  # events within a shortest step of each other, by now
    books: Books
    records: list[Record]  # of the whole march; those after the first ``length`` came later
    length: int

    @classmethod
    def beginning(cls, state: State, step: float) -> Course:
        """That of a march from ``state``."""
        return cls(state, step, AFRESH, 0, 0, 0, Books(), [], 0)

    def behind(self) -> list[Record]:
        """The records up to here."""
        return self.records[: self.length]


class Marched(NamedTuple):
    """What a march came to."""

    state: State
    records: list[Record]  # one for every accepted step, and for the other side of every event
    attempts: int  # steps tried
    ended: str  # empty when one of the ends was reached, otherwise why the march stopped early
    course: Course  # the last instant before the steps that the march's own ends made shorter
