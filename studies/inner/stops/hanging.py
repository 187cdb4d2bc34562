"""Stops that a compliant hoop may slide through: rolling takes more than mu N behind them.

A patch that breaks there slides on, at any stiffness, and the limit is the rigid hoop that does so (:func:`followed`).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, nan

import numpy as np

from rigid import Scene

from ...running.files import StudyError
from ..events import BREAK, STOP, Event, Passage, passage
from ..layers import layer, outer_forces
from ..march.body import Body
from ..march.equations import PATCH, REGULARISED, STICK, ScaledContact
from ..scales import damping_of
from ..separate import PERIODS
from .critical import critical_theta, first_swings

_DECADES = range(23, 5, -1)  # of foundations, down to the softest within the range of the model
_SPLITS = 6  # of a decade: what a layer leaves out of order eps is a tenth of it and more


@dataclass(frozen=True, slots=True)
class Hanging:
    """A stop behind which rolling takes more than mu N: what breaks there slides on."""

    phi: float
    ratio: float
    """|F|/N of rolling behind it."""
    damping: float | None
    """Damping ratio above which no transient breaks the patch there; infinite where none is enough, None of a brush,
    where it is not known."""
    broken: bool
    """Whether the patch of the scene breaks there, and slides on, where it is ever stiffer."""
    other: float
    """J_F/J_N of the rigid hoop that does otherwise there; NaN where it comes to no end that is known."""
    holds: float
    """Foundation from which on a patch does there what it does in the limit, by its layer at a finite eps: the critical
    damping is zeta_c + O(eps). 0 where it does so from 1e6 on, and of a brush, where it is not known."""

    def is_otherwise(self, impulse_ratio: float, foreseen: float) -> bool:
        """Whether a pulse is nearer to the other hoop than to what is foreseen of it."""
        return abs(impulse_ratio - self.other) < abs(impulse_ratio - foreseen)

    def to_dict(self) -> dict[str, float | bool | None]:
        """As JSON prints it."""
        return {
            "phi": self.phi,
            "force_ratio": self.ratio,
            "critical_damping": self.damping,
            "broken": self.broken,
            "other_impulse_ratio": self.other,
            "holds": self.holds,
        }


def hanging(scene: Scene, way: Passage) -> tuple[Hanging, ...]:
    """The stops of a pulse on whose sticks the limit hangs: those that a transient breaks at some damping or other."""
    found, breaks = [], list[int]()
    for number, event in enumerate(way.events):
        if may_slide_on(way.body, way.contact, event.stop):
            theta = critical_theta(way.body, way.contact, event.stop)
            normal, friction = outer_forces(way.body, event.stop, True)
            least = None if theta is None else damping_of(scene, theta)
            if least != 0:
                broken, ratio = event.kind == BREAK, abs(friction) / normal
                other = _impulse_ratio(scene, breaks if broken else [*breaks, number])
                found.append(Hanging(event.phi, ratio, least, broken, other, _holds_from(way, number)))
        if event.kind == BREAK:
            breaks.append(number)
    return tuple(found)


def _impulse_ratio(scene: Scene, breaks: list[int]) -> float:
    try:
        return passage(scene, None, breaks).pulse.impulse_ratio
    except StudyError:
        return nan


def _holds_from(way: Passage, number: int) -> float:
    """Foundation from which on the layer of a stop, with angle and phidot that go on, is that of the limit."""
    event, whole = way.events[number], 1 + way.scene.hoop.mass_ratio
    if way.contact.law != PATCH:
        return 0.0
    stick = way.events[number + 1].t - event.t if number + 1 < len(way.events) else inf

    def alike(decade: float) -> bool:
        eps = (10**decade / whole) ** (-1 / 3)
        duration = min(first_swings(way.body, event.stop), stick / (2 * eps))  # the next event is another one's
        try:
            kept = layer(way.body, way.contact, event.stop, duration, eps=eps).faithful
        except StudyError:  # nothing else is known of it
            return True
        return kept != (event.kind == BREAK)

    high: float = _DECADES.start + 1
    if not alike(high):
        return inf
    for decade in _DECADES:
        if not alike(decade):
            break
        high = decade
    else:
        return 0.0
    low = high - 1
    for _ in range(_SPLITS):
        middle = (low + high) / 2
        low, high = (low, middle) if alike(middle) else (middle, high)
    return float(10**high)


def may_slide_on(body: Body, contact: ScaledContact, event: Event) -> bool:
    """Whether an event is a stop behind which a patch that has broken would find no way back: rolling takes more than
    mu N there."""
    if event.kind != STOP or contact.law == REGULARISED:
        return False
    normal, friction = outer_forces(body, event, True)
    return abs(friction) > contact.mu * normal


def slides_on(body: Body, contact: ScaledContact, event: Event) -> bool:
    """Whether the layer of such a stop leaves the patch sliding the way that rolling's F would push it.

    Of a damper above the critical one none is looked at: it keeps the stick.
    """
    least = critical_theta(body, contact, event)
    if least is not None and least < contact.theta:
        return False
    onward = np.sign(outer_forces(body, event, True)[1])
    duration = None
    while True:
        history = layer(body, contact, event, duration)
        changes = np.flatnonzero(np.diff(history.mode))
        # what has rung for as long again without a change is left to itself
        duration = 4 * float(history.tau[-1])
        if (
            not changes.size
            or 2 * history.tau[changes[-1] + 1] < history.tau[-1]
            or duration > PERIODS * history.period
        ):
            return bool(history.mode[-1] == onward != STICK)


def followed(scene: Scene, rolls_to: float | None = None) -> Passage:
    """The first pulse of a scene as a compliant hoop of its damping goes through it where it is ever stiffer.

    See :func:`studies.inner.events.passage`; it is another where a layer breaks a stick that mu N cannot restore.
    """
    way, breaks = passage(scene, rolls_to), list[int]()
    number = 0
    while number < len(way.events):
        event = way.events[number]
        if may_slide_on(way.body, way.contact, event) and slides_on(way.body, way.contact, event):
            breaks.append(number)
            way = passage(scene, rolls_to, breaks)
        number += 1
    return way
