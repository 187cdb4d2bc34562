"""The critical damping: below it the transient at an event breaks the patch, and the sequence of phases is another.

Most often for the time of the layer alone: what holds the rigid hoop is less than mu N, so the slip of a patch that has
broken comes to its end at once; where it is more, see :mod:`studies.inner.stops.hanging`.
"""

from __future__ import annotations

from math import inf

import numpy as np

from ...running.files import StudyError
from ..creep import half_width
from ..events import Event
from ..layers import layer, outer_forces, period_of
from ..march.body import Body
from ..march.equations import PATCH, ScaledContact

_THETAS = np.geomspace(8.0, 1e-3, 40)  # of the patch's period over 2 pi: far over critical to next to none
_STRONGER = np.geomspace(2.0**23, 8.0, 11)  # where N falls by far, behind a slip that ends near a jam
_ACCURACY = 1e-5


def critical_theta(body: Body, contact: ScaledContact, event: Event) -> float | None:
    """Largest relaxation time, on the tau clock, below which the patch does not follow the rigid hoop's phases alone.

    0 where it does so without a damper, infinite where none is enough, None for a law that has no phases.
    """
    if contact.law != PATCH:
        return None
    duration, scale = first_swings(body, event), period_of(body, event) / (2 * np.pi)

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


def first_swings(body: Body, event: Event) -> float:
    """Within which a layer overshoots, if it does: swings, and passages of a point."""
    half = half_width(outer_forces(body, event, True)[0])
    return 5 * period_of(body, event) + 4 * half / abs(event.omega)
