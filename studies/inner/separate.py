"""From which foundation on the layers of a pulse are over before the next event comes.

A layer takes a time of eps tau, and the rigid motion's stretches take none less for it. Below that foundation one event
happens in the layer of the one before it: there the pulse is no series in powers of eps, and what is predicted of one
does not hold.
"""

from __future__ import annotations

import itertools
from math import inf

from .events import Passage
from .layers import Layer, layer, outer_forces


def separate_from(way: Passage, layers: list[Layer] | None = None) -> float:
    """Foundation eps_n R^2/(m g) at which each layer takes as long as the stretch that follows it.

    Infinite where one does not settle, without damping; 0 where every event is the last, or jumps into a state that it
    stays in. ``layers`` are those of the events, where they are known.
    """
    least = 0.0
    known = layers or [layer(way.body, way.contact, event) for event in way.events]
    for now, (event, following) in zip(known, itertools.pairwise(way.events), strict=False):
        settles = now.settled(outer_forces(way.body, event, True)[0])
        if settles is None:
            return inf
        # eps settles = time, eps that of the whole mass
        whole = 1 + way.scene.hoop.mass_ratio
        least = max(least, (settles / (following.t - event.t)) ** 3 * whole)
    return least
