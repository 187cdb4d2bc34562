"""From which foundation on the inner problem describes a pulse: its layers are separate, and its rim is the rigid one.

A layer takes a time of eps tau, and the rigid motion's stretches take none less for it. Below some foundation one event
happens in the layer of the one before it: there the pulse is no series in powers of eps, and what is predicted of one
does not hold.

The rim is rigid here. A ring whose bending stiffness grows with the foundation has a compliance of order eps^3 against
the patch's eps^2; so it scales out, but as eps times a number that may be thousands where the floor is far from the
weld. As long as the ring gives way by more than the patch, an impulse behind an event makes the ring vibrate, whose
damper the patch is no longer: what sticks may break loose anew, or leave the floor.
"""

from __future__ import annotations

import itertools
from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from meshes import Placement
from rigid import Scene

from .events import START, Event, Passage
from .layers import Layer, TooLongError, layer, outer_forces, period_of

Array = NDArray[np.float64]

LONGER = 8.0  # of the times in which a vibration falls by e: a force that has doubled falls below 2 %, and more
PERIODS = 1000  # for which a layer is followed at most
_COARSE = {"level": "reduced", "elements": 240, "rtol": 1e-3}  # a compliance to some percent is enough


def separate_from(way: Passage, layers: list[Layer | None] | None = None) -> float:
    """Foundation eps_n R^2/(m g) at which each layer takes as long as the stretch that follows it.

    Infinite where one does not settle, without damping or with next to none; 0 where every event is the last, or jumps
    into a state that it stays in. ``layers`` are those of the events, where they are known; the last is not asked. Of
    one that cannot be followed the slowest of its exponentials tells.
    """
    least = 0.0
    known = layers or [_followed(way, event) for event in way.events[:-1]]
    for now, (event, following) in zip(known, itertools.pairwise(way.events), strict=False):
        normal, period, theta = outer_forces(way.body, event, True)[0], period_of(way.body, event), way.contact.theta
        settles = None if now is None else now.settled(normal)
        # what rings for longer than a layer is followed for falls like exp(-theta omega^2 tau/2), what creeps back like
        # exp(-tau/theta)
        longer = LONGER * max(2 / (theta * (2 * pi / period) ** 2), theta) if theta > 0 else inf
        if now is None:
            settles = longer
        elif settles is None and longer < PERIODS * period:
            until = float(now.tau[-1]) + longer
            longest = _followed(way, event, until)
            settles = until if longest is None else longest.settled(normal)
        if settles is None:
            return inf
        # eps settles = time, eps that of the whole mass
        whole = 1 + way.scene.hoop.mass_ratio
        least = max(least, (settles / (following.t - event.t)) ** 3 * whole)
    return least


def _followed(way: Passage, event: Event, duration: float | None = None) -> Layer | None:
    """The layer of an event; None where something is too fast for it to be followed."""
    try:
        return layer(way.body, way.contact, event, duration)
    except TooLongError:
        return None


def compliance(scene: Scene, phi: float) -> Array:
    """(2, 2) By how much the rim moves at the floor, right and up, under a force to the right and one up.

    In R per m g, times E I/(m g R^2), at the angle ``phi``: of the quads' node that is nearest to the floor.
    """
    from flexible.models.select import ring_for  # finite elements, by whoever asks
    from flexible.ring.fem import membrane_stiffness

    linear = scene.to_dimensionless().replace(ring={"bending_stiffness": 1e4}, solve=_COARSE)
    ring = ring_for(linear)
    rim = ring.mesh.theta[ring.mesh.rim_nodes]
    at = int(np.argmin(np.abs(np.angle(np.exp(1j * (rim - (pi - phi)))))))
    columns = np.array([2 * at, 2 * at + 1])
    moved = ring.pressed(columns)[columns] * linear.ring.bending_stiffness / membrane_stiffness(linear)
    axes = Placement(phi, 0.0, 0.0).axes
    found: Array = axes.T @ moved @ axes
    return found


def stiff_from(way: Passage, scene: Scene) -> float:
    """Foundation eps_n R^2/(m g) at which both give way alike, at the event where that is the largest.

    The bending stiffness goes with the foundation, in the proportion that ``scene`` has. Asked at events behind which
    there is an impulse: where a slip ends or turns round, there with the F that goes with N. 0 where there is none.
    """
    whole = 1 + way.scene.hoop.mass_ratio
    proportion = scene.ring.bending_stiffness / scene.contact.stiffness
    least = 0.0
    for event in way.events:
        if event.kind == START:
            continue
        by = compliance(scene, event.phi)
        up = by[1, 1] + (event.behind or 0.0) * by[1, 0]
        normal = outer_forces(way.body, event, True)[0] * whole
        # ring: up/(proportion eps_n); patch: 1/(2 eps_n a), a = (3 N/(2 eps_n))^(1/3)
        least = max(least, 12 * normal * max(up / proportion, 0.0) ** 3)
    return least
