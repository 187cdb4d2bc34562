"""A layer that an end of a pulse cuts: what its part on the near side of that angle does to the impulses.

A pulse may begin or end with an event itself, where N jumps from one side of the whole hoop's weight to the other. A
compliant hoop comes to that event earlier or later by order eps, as long as a layer lasts. So at that angle it is in
the middle of the layer, and its momenta are those of the motion before the event and what the layer has added so far:
of order eps too. The energy is not: the contact point comes to rest in the event, or has been.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .events import START, Event
from .layers import layer, outer_forces
from .march.body import Body
from .march.equations import PATCH, REGULARISED, ScaledContact


def impulses_until(body: Body, contact: ScaledContact, event: Event, tau: float) -> Any:
    """Impulses of F and N, over eps, by ``tau`` from an event on, beyond those of the forces before it.

    Before the event, at ``tau`` < 0, there are some of laws that lose mu N to a slip that is slow.
    """
    none = np.zeros(2)
    if (event.kind == START and contact.mu_s == contact.mu) or contact.law == REGULARISED:
        return none  # there is no jump; how much longer the layer of a smoothed law lasts is not looked at
    if tau <= 0 and contact.law == PATCH:
        return none
    history = layer(body, contact, event, tau if tau > 0 else None)
    seen = history.tau <= tau * (1 + 1e-12) if tau > 0 else history.tau <= tau
    normal, friction = outer_forces(body, event, False)
    beyond = np.array([history.friction_force - friction, history.normal_force - normal])[:, seen]
    return np.trapezoid(beyond, history.tau[seen], axis=1) if np.count_nonzero(seen) > 1 else none


def impulses_far_behind(body: Body, event: Event, tau: float) -> Any:
    """The same where it comes to the end of the pulse by far more than a layer behind the event: forces are steady."""
    before, behind = outer_forces(body, event, False), outer_forces(body, event, True)
    return max(tau, 0.0) * np.array([behind[1] - before[1], behind[0] - before[0]])
