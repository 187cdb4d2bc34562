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
from math import cos, inf, pi, sin

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from .events import START, Passage
from .layers import Layer, layer, outer_forces

Array = NDArray[np.float64]

LONGER = 8.0  # of the times in which a vibration falls by e: a force that has doubled falls below 2 %, and more
PERIODS = 1000  # for which a layer is followed at most
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(40)


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


def compliance(scene: Scene, phi: float) -> Array:
    """(2, 2) By how much the rim moves at the floor, right and up, under a force to the right and one up.

    In R per m g, times E I/(m g R^2), at the angle ``phi``. Of a wall that does nothing but bend: two arms of its
    centre line, clamped at the ends of the weld and joined at the floor; over the weld it does not give way.
    """
    held, radius = scene.ring.weld_half_angle, 1 - scene.wall / 2
    theta = (pi - phi) % (2 * pi)
    if not held < theta < 2 * pi - held:
        return np.zeros((2, 2))
    stiffness = np.zeros((3, 3))
    for end in (held, 2 * pi - held):
        at = (theta + end) / 2 + (theta - end) / 2 * _POINTS
        # about the sections, under a force along y1, one along y2 and a moment on the rim at the floor
        moments = np.array([radius * np.sin(at) - sin(theta), cos(theta) - radius * np.cos(at), np.ones_like(at)])
        stiffness += np.linalg.inv(moments * (_WEIGHTS * radius * abs(theta - end) / 2) @ moments.T)
    moved = np.linalg.inv(stiffness)[:2, :2]
    axes = np.array([[sin(phi), cos(phi)], [cos(phi), -sin(phi)]])  # of y1 and y2 in the world
    found: Array = axes.T @ moved @ axes
    return found


def stiff_from(way: Passage, scene: Scene) -> float:
    """Foundation eps_n R^2/(m g) at which both give way alike, at the event where that is the largest.

    The bending stiffness goes with the foundation, in the proportion that ``scene`` has. Asked at events behind which
    there is an impulse: where a slip ends or turns round. 0 where there is none.
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
