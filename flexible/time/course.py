"""Where a march stands: all that its next step depends on, so that it can be left there and taken up again; and why it
stopped there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from ..models.state import Books, Record, State
from .control import AFRESH, Pace
from .events import Ends

PAST = 1e-8  # of a time or an angle, past the end of a march: it ends within 1e-9, and machines differ in round-off


class Standing(NamedTuple):
    """A march before its next step, for compiled code."""

    state: State
    step: float  # length of the next step
    pace: Pace  # of the last one
    books: Books
    attempts: int  # steps tried until now
    turns: int
    way: float  # 1 or -1 as it goes on to larger or smaller angles, 0 while that is not known
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
    return Standing(state, step, AFRESH, Books(), 0, 0, 0.0, 0, False)


@dataclass(frozen=True, slots=True)
class Stop:
    """Why and where a march stopped early, or a run; times are told in the units of whoever asks."""

    why: str  # follows the place: ": the reason", or " after 5 steps"
    t: float | None = None  # sqrt(R/g)
    phi: float | None = None
    what: str = "stopped"
    by_ring: bool = True  # whether a ring too soft for its disk may be the cause

    def told(self, unit: float = 1.0, label: str = "") -> str:
        """The sentence, with times in units of which sqrt(R/g) is ``unit``, and the name of that behind them."""
        places = []
        if self.t is not None:
            places.append(f"t = {self.t * unit:.6g} {label}".rstrip())
        if self.phi is not None:
            places.append(f"phi = {self.phi:.6g}")
        return f"{self.what} at {', '.join(places)}{self.why}"


class Marched(NamedTuple):
    """What a march came to."""

    state: State
    records: list[Record]  # one for every accepted step, and for the other side of every event
    attempts: int  # steps tried
    stop: Stop | None  # None when one of the ends was reached; a file does not keep it: what goes on stops anew
    course: Course  # an instant before the steps that the march's own ends made shorter


def goes_past(marched: Marched, ends: Ends) -> bool:
    """Whether a march went on where one with these ends would not have."""
    phi = [record.phi for record in marched.records]
    if min(phi) < ends.low - PAST or max(phi) > ends.high + PAST:
        return True
    return marched.state.t > ends.t + PAST or 0 < ends.turns <= marched.course.now.turns
