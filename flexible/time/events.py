"""What can end a step early: slip that starts or ends, a turn, the angle at which the march is to end.

An event is a function of the state that passes zero; here it is counted in what its quantity can be told apart by,
so that one number, 1, bounds them all.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, prod
from typing import NamedTuple

from ..contact.laws.law import Law
from ..models.state import State
from .step import Step

MODE_ENDS, TURN, LOW_END, HIGH_END = range(4)


class Ends(NamedTuple):
    """How far to march, whichever comes first."""

    t: float = inf
    low: float = -inf  # angles phi
    high: float = inf
    turns: int = 0  # instants with phidot = 0; 0 for any number


class Tolerances(NamedTuple):
    """How far past its zero an event may be taken (R = m = g = 1), and how short a bracket of it in time.

    A step that is cut short has the noise of its slip, some 1e-15 of R by its length: events whose step comes out very
    short are told by the bracket alone, and so are those at which a function jumps.
    """

    force: float = 1e-9  # of 1 + N: Newton's own, by which the forces are known
    velocity: float = 1e-9  # of sqrt(gR): the slip of a step of 1e-6, whose ends are known to 1e-15
    angle: float = 1e-9  # of the end of a pulse, where N is about M g: 1e-9 of its impulse
    rate: float = 1e-9  # of phidot at a turn, whose energy is then below 1e-18 m g R
    time: float = 1e-15  # sqrt(R/g): what t itself can tell apart
    share: float = 1e-10  # of the step: the bracket of an event may also be this part of its step


TOLERANCES = Tolerances()


def watches(law: Law, state: State, ends: Ends) -> list[int]:
    """The events that a step from ``state`` may meet."""
    found = [MODE_ENDS] if law.may_end(state.mode) else []
    if state.vel[2] != 0:
        found.append(TURN)
    if ends.low > -inf:
        found.append(LOW_END)
    if ends.high < inf:
        found.append(HIGH_END)
    return found


def passed(watch: int, law: Law, ends: Ends, old: State, now: State, tolerances: Tolerances = TOLERANCES) -> float:
    """How far ``now``, a step from ``old``, is past an event: positive past it, within 1 of it at it."""
    if watch == MODE_ENDS:
        return law.excess(now, tolerances.force, tolerances.velocity)
    if watch == TURN:
        return float(-now.vel[2] if old.vel[2] > 0 else now.vel[2]) / tolerances.rate
    phi = float(now.pos[2])
    return (ends.low - phi if watch == LOW_END else phi - ends.high) / tolerances.angle


class Located(NamedTuple):
    """A step cut short."""

    trial: Step | None  # None where no step could be solved
    at_event: bool  # otherwise it ends before the event
    attempts: int


def _just_past(known: list[tuple[float, float]]) -> float | None:
    """Where a function known at two or three places is 1/2, within 1 past its zero: its inverse is a parabola, or a
    line; None where it has none.
    """
    known = [(x, f - 0.5) for x, f in known if abs(f) < inf]
    if len({f for _, f in known}) < max(len(known), 2):
        return None
    return sum(x * prod(g / (g - f) for _, g in known if g != f) for x, f in known)


def locate(
    attempt: Callable[[float], Step | None],
    past: Callable[[Step], float],
    trial: Step,
    before: float,
    length: float,
    tolerances: Tolerances = TOLERANCES,
) -> Located:
    """The step that ends at an event, between no step and one of ``length``, ``trial``, that is past it.

    Inverse quadratic interpolation, and bisection where that has not halved the bracket three times in a row. A
    length that cannot be solved is replaced by others in the bracket; if none of them can be, the step goes to the last
    instant before the event that could.

    Parameters
    ----------
    attempt : callable
        The step of a length, or None.
    past : callable
        How far a step is past the event, see :func:`passed`.
    before : float
        That of the instant at which the step begins.
    """
    low, f_low, safe = 0.0, min(before, 0.0), None
    high, f_high = length, past(trial)
    narrow = max(tolerances.share * length, tolerances.time)
    slow, attempts = 0, 0
    known = [(low, f_low), (high, f_high)]
    while f_high > 1 and high - low > narrow:
        width = high - low
        guess = _just_past(known[-3:]) if slow < 3 else None
        first = guess if guess is not None and low < guess < high else (low + high) / 2
        first = min(max(first, low + 0.001 * width), high - 0.001 * width)
        for h in (first, *(low + share * width for share in (0.5, 0.25, 0.75, 0.125, 0.875))):
            attempts += 1
            middle = attempt(h)
            if middle is not None:
                break
        else:
            return Located(safe, False, attempts)
        value = past(middle)
        known.append((h, value))
        if value >= 0:
            high, f_high, trial = h, value, middle
        else:
            low, safe = h, middle
        slow = slow + 1 if guess is not None and high - low > width / 2 else 0
    return Located(trial, True, attempts)
