"""Which flights are hops and which are chatter.

A flight is chatter where it does not rise above what the hoop gives way by as it stands, or is over before the ring
has moved: its height is compared with the depth to which the floor gives way under the hoop's weight and with the sag
of the ring, its duration with the ring's slowest period.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy as np

from flexible.contact.points.normal import half_width
from rigid import Scene
from rigid.output.units import Length, Time

HEIGHT_OVER_DEPTH = 10.0
HEIGHT_OVER_SAG = 0.01
DURATION_OVER_PERIOD = 0.03
"""What a hop has at least: of a flight that just has one of them the prominence is 1."""

DECADE = (10**-0.5, 10**0.5)
"""Factors on all three constants between which every threshold is told."""


@dataclass(frozen=True, slots=True)
class Scales:
    """What a flight is measured by; lengths in R, times in sqrt(R/g)."""

    depth: Length[float]
    """To which a rigid hoop's patch is pressed in by the weight of disk and hoop."""
    sag: Length[float]
    """Of the hoop's centre, in the equilibrium from which it is released; the patch's depth is in it."""
    period: Time[float]
    """Of the slowest vibration of the ring about the weld; 0 of a ring without mass."""

    def prominence(self, height: float, duration: float) -> float:
        """How far a flight is from chatter: the least of its three ratios over what a hop has at least."""
        ratios = (
            _over(height, HEIGHT_OVER_DEPTH * self.depth),
            _over(height, HEIGHT_OVER_SAG * self.sag),
            _over(duration, DURATION_OVER_PERIOD * self.period),
        )
        return min(ratios)


def _over(value: float, least: float) -> float:
    return max(value, 0.0) / least if least > 0 else inf


def slowest_period(scene: Scene) -> float:
    """Of the ring's vibrations about the weld, in sqrt(R/g); 0 of one without mass."""
    from flexible.ring.rim.reduction import reduce

    if scene.hoop.mass_ratio == 0:
        return 0.0
    return 2 * pi / float(np.sqrt(reduce(scene, 1).frame.modal[0, 0]))


def scales_of(scene: Scene, sag: float) -> Scales:
    """The scales of a scene in which the hoop's centre stands ``sag`` below R at its release."""
    patch = half_width(1 + scene.hoop.mass_ratio, scene.contact.stiffness)
    return Scales(patch**2 / 2, sag, slowest_period(scene))
