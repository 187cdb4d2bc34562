"""Ring and patch brought to rest together, under all loads at once or along a way of more and more of them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.interrupts import answer

from ..models.equilibrium import Patch, RestingRing, Window

Array = NDArray[np.float64]

LONG = 0.1  # half-width of a patch, in R, that no ring at rest carries along the rim by many times its length
LEAST_SHARE = 1 / 256  # of all loads, a step too short to go on
CLOSEST = 1.02  # times as stiff, a step from a softer foundation too short to go on


def settle(ring: RestingRing, patch: Patch) -> float:
    """Bring ring and patch to rest together; the share of all loads that was reached.

    A soft ring turns under the load where the floor touches it. If that carries a short patch along the rim by many
    times its length, Newton loses it whatever the load: then it is found on a soft foundation, where it is long, and
    followed to its own.
    """
    begins, known = ring.coordinates, dict(patch.__dict__)
    reached = _in_shares(ring, patch)
    if reached == 1 or patch.half >= LONG:
        return reached
    ring.coordinates, patch.__dict__ = begins, known
    return 1.0 if _from_soft(ring, patch) else reached


class _Nothing:
    """In place of a patch, of a ring that nothing touches."""

    low = high = 0.0

    def __init__(self, window: Window) -> None:
        self.window, self.nodal = window, np.zeros((2 * window[1] + 1, 2))

    def solve(self, ring: RestingRing, share: float) -> bool:
        """It bears no force, whatever the ring does."""
        return True

    def roll(self, angle: float) -> None:
        """It is everywhere."""


def settle_free(ring: RestingRing, window: Window) -> Array | None:
    """Bring a ring that nothing touches to rest under the inertia of its frame.

    Returns
    -------
    (nodes, 2) array or None
        Displacements of a window of rim nodes; nothing where it comes to no rest.
    """
    if _in_shares(ring, _Nothing(window)) < 1:
        return None
    ring.linearise(1.0)
    return ring.response(window)[0].reshape(-1, 2)


class _Way:
    """Equilibria under more and more of the loads: where the next one is guessed to lie."""

    def __init__(self, ring: RestingRing, patch: Patch | _Nothing) -> None:
        self.ring, self.patch = ring, patch
        self.last: list[tuple[float, Array, float]] = []

    def reached(self, at: float) -> None:
        """Keep the equilibrium under a share of the loads, beside the one before."""
        self.last = [*self.last[-1:], (at, self.ring.coordinates, (self.patch.low + self.patch.high) / 2)]

    def ahead(self, at: float) -> None:
        """Guess the one under another share: on the straight line through the last two."""
        if len(self.last) == 2:
            (first, shape, middle), (second, now, here) = self.last
            far = (at - second) / (second - first)
            self.ring.coordinates = now + far * (now - shape)
            self.patch.roll(far * (here - middle))


def _in_shares(ring: RestingRing, patch: Patch | _Nothing) -> float:
    """In steps of all loads if one is too much."""
    share, step, way = 0.0, 1.0, _Way(ring, patch)
    lost = False  # by the step before: twice the length that was found is then one that was not
    while share < 1:
        if _try(ring, patch, share + step, partial(way.ahead, share + step)):
            share += step
            way.reached(share)
            step, lost = min(step if lost else 2 * step, 1 - share), False
        else:
            step, lost = step / 2, True
            if step < LEAST_SHARE:
                return share
    return 1.0


def _from_soft(ring: RestingRing, patch: Patch) -> bool:
    """Find the patch on a soft foundation and follow it to its own; whether that was reached."""
    law, softness, step = patch.law, (LONG / patch.half) ** 3, 10.0
    patch.lie_on(law, softness)
    if _in_shares(ring, patch) < 1:
        return False
    while softness > 1:
        less = max(softness / step, 1.0)
        if _try(ring, patch, 1.0, partial(patch.lie_on, law, less)):
            softness = less
        else:
            step **= 0.5
            if step < CLOSEST:
                return False
    return True


def _try(ring: RestingRing, patch: Patch | _Nothing, share: float, change: Callable[[], None] = lambda: None) -> bool:
    """Whether ring and patch come to rest under a share of the loads; if not they stay what they were."""
    start, known = ring.coordinates, dict(patch.__dict__)
    with suppress(np.linalg.LinAlgError):
        change()
        if _settled(ring, patch, share):
            return True
    ring.coordinates, patch.__dict__ = start, known
    return False


def _settled(ring: RestingRing, patch: Patch | _Nothing, share: float) -> bool:
    change = np.inf
    for _ in range(15):
        answer()  # of all nodes of an exact ring one of these takes seconds
        ring.linearise(share)
        if not patch.solve(ring, share):
            return False
        last, change = change, ring.move(patch.window, patch.nodal.ravel())
        if change < 1e-11 or (change < 1e-7 and change > last / 4):
            return True
        if not change < 10:
            return False
    return False
