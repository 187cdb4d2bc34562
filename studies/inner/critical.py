"""The critical damping: below it the transient at an event breaks the patch, and the sequence of phases is another.

Most often for the time of the layer alone: what holds the rigid hoop is less than mu N, so the slip of a patch that has
broken comes to its end at once. But a slip may stop into a roll that takes more than mu N. A patch that breaks there
slides on, at any stiffness, and the limit is the rigid hoop that does so (:func:`followed`).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from rigid import Scene

from ..running.files import StudyError
from .body import Body
from .creep import half_width
from .events import BREAK, STOP, Event, Passage, passage
from .layers import layer, outer_forces, period_of
from .march import PATCH, REGULARISED, STICK, ScaledContact
from .scales import damping_of
from .separate import PERIODS

_THETAS = np.geomspace(8.0, 1e-3, 40)  # of the patch's period over 2 pi: far over critical to next to none
_STRONGER = np.geomspace(1024.0, 8.0, 8)
_ACCURACY = 1e-5


def critical_theta(body: Body, contact: ScaledContact, event: Event) -> float | None:
    """Largest relaxation time, on the tau clock, below which the patch does not follow the rigid hoop's phases alone.

    0 where it does so without a damper, infinite where none that can be followed is enough, None for a law that has no
    phases.
    """
    if contact.law != PATCH:
        return None
    period = period_of(body, event)
    half = half_width(outer_forces(body, event, True)[0])
    duration = 5 * period + 4 * half / abs(event.omega)  # overshoot comes in the first swings and passages

    scale = period / (2 * np.pi)

    def follows(theta: float) -> bool | None:
        try:
            return layer(body, contact._replace(theta=theta), event, duration).faithful
        except StudyError:  # a damper too fast to be followed
            return None

    if follows(0.0):
        return 0.0
    low, high = 0.0, inf
    for theta in scale * (_THETAS if follows(_THETAS[0] * scale) else _STRONGER):
        faithful = follows(theta)
        if faithful is None and high == inf:
            continue  # nothing is known of one as strong
        if not faithful:
            low = theta
            break
        high = theta
    if high == inf:
        return inf
    while high - low > _ACCURACY * high:
        middle = (low + high) / 2
        low, high = (low, middle) if follows(middle) else (middle, high)
    return float(high)


@dataclass(frozen=True, slots=True)
class Hanging:
    """A stop behind which rolling takes more than mu N: what breaks there slides on."""

    phi: float
    ratio: float
    """|F|/N of rolling behind it."""
    damping: float | None
    """Damping ratio above which no transient breaks the patch there; infinite where none that can be followed is
    enough, None of a brush, where it is not known."""
    broken: bool
    """Whether the patch of the scene breaks there, and slides on."""


def hanging(scene: Scene, way: Passage) -> tuple[Hanging, ...]:
    """The stops of a pulse on whose sticks the limit hangs: those that a transient breaks at some damping or other."""
    found = []
    for event in way.events:
        if may_slide_on(way.body, way.contact, event.stop):
            theta = critical_theta(way.body, way.contact, event.stop)
            normal, friction = outer_forces(way.body, event.stop, True)
            least = None if theta is None else damping_of(scene, theta)
            if least != 0:
                found.append(Hanging(event.phi, abs(friction) / normal, least, event.kind == BREAK))
    return tuple(found)


def may_slide_on(body: Body, contact: ScaledContact, event: Event) -> bool:
    """Whether an event is a stop behind which a patch that has broken would find no way back: rolling takes more than
    mu N there."""
    if event.kind != STOP or contact.law == REGULARISED:
        return False
    normal, friction = outer_forces(body, event, True)
    return abs(friction) > contact.mu * normal


def slides_on(body: Body, contact: ScaledContact, event: Event) -> bool:
    """Whether the layer of such a stop leaves the patch sliding the way that rolling's F would push it.

    Of a damper above the critical one none is looked at: it keeps the stick, and may be too fast to be followed.
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
