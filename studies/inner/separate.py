"""From which foundation on the layers of a pulse are over before the next event comes.

A layer takes a time of eps tau, and the rigid motion's stretches take none less for it. Below that foundation one event
happens in the layer of the one before it: there the pulse is no series in powers of eps, and what is predicted of one
does not hold.
"""

from __future__ import annotations

import itertools
from math import inf, pi

from .events import Passage
from .layers import Layer, layer, outer_forces

LONGER = 8.0  # of the times in which a vibration falls by e: a force that has doubled falls below 2 %, and more
PERIODS = 1000  # for which a layer is followed at most


def separate_from(way: Passage, layers: list[Layer] | None = None) -> float:
    """Foundation eps_n R^2/(m g) at which each layer takes as long as the stretch that follows it.

    Infinite where one does not settle, without damping or with next to none; 0 where every event is the last, or jumps
    into a state that it stays in. ``layers`` are those of the events, where they are known.
    """
    least = 0.0
    known = layers or [layer(way.body, way.contact, event) for event in way.events]
    for now, (event, following) in zip(known, itertools.pairwise(way.events), strict=False):
        normal = outer_forces(way.body, event, True)[0]
        settles = now.settled(normal)
        # what rings for longer than a layer is followed for falls like exp(-theta omega^2 tau/2)
        longer = LONGER / (way.contact.theta * (2 * pi / now.period) ** 2 / 2) if way.contact.theta > 0 else inf
        if settles is None and longer < PERIODS * now.period:
            settles = layer(way.body, way.contact, event, now.tau[-1] + longer).settled(normal)
        if settles is None:
            return inf
        # eps settles = time, eps that of the whole mass
        whole = 1 + way.scene.hoop.mass_ratio
        least = max(least, (settles / (following.t - event.t)) ** 3 * whole)
    return least
