"""What can end a step early: slip that starts or ends, a turn, the angle at which the march is to end.

A turn is where both the disk's phidot and the momentum of the rotation have changed their sign: on a soft ring the disk
vibrates, and its phidot alone would have a hoop turn many times that has just been let go or turns once. Off the floor
a hoop has no turn: its momentum about G stays.

An event is a function of the state that passes zero; here it is counted in what its quantity can be told apart by,
so that one number, 1, bounds them all. Where in a step that is, is found by inverse quadratic interpolation, and by
bisection where that has not halved the bracket three times in a row. A length that cannot be solved is replaced by
others in the bracket; if none of them can be, the step goes to the last instant before the event that could.

A search says which length to try next and is told what came of it, so that it can wait for a step of any hoop.
"""

from __future__ import annotations

from math import inf, isnan, nan
from typing import Any, NamedTuple

from rigid.kernel.compile import loop, part

from ..contact.laws.listing import excess, is_smoothed, may_end
from ..contact.points.data import EXACTLY, Rates, Resultants
from ..models.state import rotation

NO_EVENT, MODE_ENDS, TURN, LOW_END, HIGH_END = range(-1, 4)


class Ends(NamedTuple):
    """How far to march, whichever comes first."""

    t: float = inf
    low: float = -inf  # angles phi
    high: float = inf
    turns: int = 0  # 0 for any number


# How far past its zero an event may be taken (R = m = g = 1), and how short a bracket of it in time. A step that is cut
# short has the noise of its slip, some 1e-15 of R by its length: events whose step comes out very short are told by the
# bracket alone, and so are those at which a function jumps.
VELOCITY = 1e-9  # of sqrt(gR): the slip of a step of 1e-6, whose ends are known to 1e-15
ANGLE = 1e-9  # of the end of a pulse, where N is about M g: 1e-9 of its impulse
RATE = 1e-9  # of the rotation at a turn, whose energy is then below 1e-18 m g R
BEARS = 0.1  # of m g: a patch of a ring that began to bear nothing, let go undeformed, tells of no rotation below it
TIME = 1e-15  # sqrt(R/g): what t itself can tell apart
SHARE = 1e-10  # of the step: the bracket of an event may also be this part of its step


class Sight(NamedTuple):
    """What of an instant tells of events."""

    mode: int
    phi: float
    omega: float
    rotation: float  # phidot by its momentum; on the way that the hoop goes where phidot is, or nothing touches
    res: Resultants
    slip_velocity: float
    rates: Rates


@part
def sight(model: Any, law: Any, there: Any, old: Any, way: float) -> Sight:
    """What tells of events before a step from ``old``, or behind it, of a hoop that goes that way (:func:`onward`).

    Whether it rolls is asked once in a step: where bristles that enter are short of their bound a patch that slides has
    some that stick at one instant and none at the next, and with them its rotation by momentum would jump to and fro.
    """
    omega, by_momentum = there.vel[2], way
    if there.res.elastic > 0 and (way == 0 or way * omega <= 0):
        # a patch on bristles that rolls slips to and fro by their vibration alone
        creep = there.slip_velocity if is_smoothed(law) else 0.0
        by_momentum = rotation(model, there.pos, there.vel, old.res.stuck > 0, creep)
    return Sight(old.mode, there.pos[2], omega, by_momentum, there.res, there.slip_velocity, there.rates)


@loop
def past_turn(way: float, now: Sight) -> float:
    """How far past a turn of a hoop that went that way."""
    return min(-way * now.omega, -way * now.rotation) / RATE


@loop
def passed(event: int, law: Any, ends: Ends, way: float, before: Sight, now: Sight) -> float:
    """How far ``now``, in the step that begins at ``before``, is past an event: positive past it, within 1 at it.

    -inf for an event that this step does not have.
    """
    if event == MODE_ENDS and may_end(law):
        return float(excess(law, now, EXACTLY, VELOCITY))
    if event == TURN and way != 0 and past_turn(way, before) < 0:
        return past_turn(way, now)
    if event == LOW_END and ends.low > -inf:
        return (ends.low - now.phi) / ANGLE
    if event == HIGH_END and ends.high < inf:
        return (now.phi - ends.high) / ANGLE
    return -inf


@loop
def onward(way: float, turns: int, event: int, before: Sight, now: Sight, bears: float) -> tuple[float, int]:
    """After a step, and the event at its end: the way that a hoop goes, 1 or -1, 0 until disk and momentum agreed over
    a patch that ``bears`` so much; and its turns. A landing, or a slide that ends, may have turned the momentum at
    once.
    """
    if way == 0:
        agreed = 1.0 if now.omega > 0 else -1.0
        return agreed if now.omega * now.rotation > 0 and now.res.normal > bears else 0.0, turns
    if event == TURN or past_turn(way, before) >= 0:
        return -way, turns + 1
    return way, turns


class Search(NamedTuple):
    """A bracket in the length of a step, not past an event at its low and past it at its high end."""

    event: int
    low: float
    high: float
    past: float  # how far, at the high end
    narrow: float  # enough
    length: float  # to try next
    guessed: bool  # by interpolation
    slow: int  # how often in a row that has not halved the bracket
    failed: int  # lengths of the bracket that could not be solved
    lengths: tuple[float, float, float]  # known last
    values: tuple[float, float, float]  # how far they are past the event, infinite where none is known yet
    tries: int


NOWHERE = Search(NO_EVENT, 0.0, 0.0, -inf, 0.0, 0.0, False, 0, 0, (0.0, 0.0, 0.0), (inf, inf, inf), 0)
OTHERS = (0.5, 0.25, 0.75, 0.125, 0.875)  # shares of the bracket tried where its first length cannot be solved


@loop
def is_open(search: Search) -> bool:
    """Whether there is a length to try."""
    found = search.past <= 1 or search.high - search.low <= search.narrow
    return not found and search.failed <= len(OTHERS)


@loop
def is_lost(search: Search) -> bool:
    """Whether no length of the bracket could be solved."""
    return bool(search.failed > len(OTHERS))


@loop
def chosen(search: Search) -> float:
    """Length of the step at the end of a search: at the event, or the last one before it; 0 if there is none.

    Where the patch's forces jump, at no instant they are at their bound: the mode ends before they are beyond it.
    """
    jumps = search.event == MODE_ENDS and search.past > 1 and search.low > 0
    return search.low if jumps or is_lost(search) else search.high


@loop
def _just_past(lengths: Any, values: Any) -> float:
    """Where a function known at two or three places is 1/2, within 1 past its zero: its inverse is a parabola, or a
    line; nan where it has none.
    """
    found, known = 0.0, 0
    for i in range(len(values)):
        value, share = values[i] - 0.5, 1.0
        if abs(value) == inf:
            continue
        for j in range(len(values)):
            other = values[j] - 0.5
            if j != i and abs(other) < inf:
                if other == value:
                    return nan
                share *= other / (other - value)
        found += lengths[i] * share
        known += 1
    return found if known > 1 else nan


@loop
def search_of(event: int, length: float, before: float, past: float, tries: int = 0) -> Search:
    """The search for an event that a step of this length is so far ``past``; where it begins, ``before``.

    After ``tries`` for others in the same step.
    """
    lengths, values = (0.0, 0.0, length), (inf, min(before, 0.0), past)
    narrow = max(SHARE * length, TIME)
    return _aimed(Search(event, 0.0, length, past, narrow, length, False, 0, 0, lengths, values, tries))


@loop
def _aimed(search: Search) -> Search:
    """With the length to try next in a new bracket."""
    low, high = search.low, search.high
    width, guess = high - low, nan
    if search.slow < 3:
        guess = _just_past(search.lengths, search.values)
    length = guess if low < guess < high else (low + high) / 2
    length = min(max(length, low + 0.001 * width), high - 0.001 * width)
    return Search(
        search.event, low, high, search.past, search.narrow, length, not isnan(guess), search.slow, 0,
        search.lengths, search.values, search.tries,
    )  # fmt: skip


@loop
def unsolved(search: Search) -> Search:
    """After a length that could not be solved."""
    failed, length = search.failed + 1, search.length
    if failed <= len(OTHERS):
        length = search.low + OTHERS[failed - 1] * (search.high - search.low)
    return Search(
        search.event, search.low, search.high, search.past, search.narrow, length, search.guessed, search.slow, failed,
        search.lengths, search.values, search.tries + 1,
    )  # fmt: skip


@loop
def told(search: Search, value: float) -> Search:
    """After a step of the length asked for that is so far past the event."""
    low, high, past = search.low, search.high, search.past
    if value >= 0:
        high, past = search.length, value
    else:
        low = search.length
    slow = search.slow + 1 if search.guessed and high - low > (search.high - search.low) / 2 else 0
    lengths = search.lengths[1], search.lengths[2], search.length
    values = search.values[1], search.values[2], value
    return _aimed(
        Search(
            search.event, low, high, past, search.narrow, 0.0, False, slow, 0, lengths, values,
            search.tries + 1,
        )
    )  # fmt: skip


@loop
def next_event(search: Search, law: Any, ends: Ends, way: float, before: Sight, now: Sight, length: float) -> Search:
    """The search for the event after this one, of a step of that length from ``before`` to ``now``; closed where the
    step does not pass it."""
    event = search.event + 1
    past = passed(event, law, ends, way, before, now)
    return search_of(event, length, passed(event, law, ends, way, before, before), past, search.tries)
