"""The first pulse of the rigid hoop, as a program of rigid bodies gets and tells it: planar, R = m = g = 1.

The hoop is a sphere or a barrel that touches the floor in one point; its mass centre lies off the middle. A program is
given the state of the rigid motion a little before the pulse and tells its states, step by step, until the disk is
through; the impulses follow from momentum, so that no output of forces is needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from ...inner.events import passage
from ...inner.march.body import rolling_forces, sliding_force

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Start:
    """A rigid hoop at the beginning of its pulse."""

    e: float
    """Distance of the mass centre from the middle."""
    gyration: float
    """Squared radius of gyration about the mass centre."""
    mu_s: float
    mu: float
    phi: float
    """Angle of the disk, clockwise from the top."""
    omega: float
    """phidot."""
    slip: float
    """Slip velocity, of the middle less phidot."""
    normal: float
    """N, over the weight."""
    edges: tuple[float, float]
    """phi at both ends of the pulse."""
    duration: float
    """Time in which every program should be through."""

    @property
    def velocity(self) -> tuple[float, float]:
        """Of the mass centre, to the right and upward."""
        return (
            self.slip + (1 + self.e * cos(self.phi)) * self.omega,
            -self.e * sin(self.phi) * self.omega,
        )


class States(NamedTuple):
    """What a program tells, (steps,) each: time, phi, phidot and the velocity of the middle."""

    t: Array
    phi: Array
    omega: Array
    right: Array
    up: Array


def start_of(scene: Scene) -> Start:
    """Where the rigid motion of a scene begins its first pulse.

    Raises
    ------
    StudyError
        See :func:`studies.inner.events.passage`.
    """
    way = passage(scene, 1.0)
    first, body = way.stretches[0], way.body
    if first.pull is None:
        normal = rolling_forces(body, first.psi_start, first.omega)[0]
    else:
        normal = sliding_force(body, first.psi_start, first.omega, first.pull)
    length = (way.pulse.t_end - way.pulse.t_start) / scene.time_unit
    return Start(
        body.e, body.gyration, way.scene.friction.mu_s, way.scene.friction.mu, way.start + pi, first.omega,
        way.first_slip, normal, (way.edges[0] + pi, way.edges[1] + pi), 2 * length,
    )  # fmt: skip


def impulse_ratio(start: Start, states: States) -> float:
    """J_F/J_N between the edges of the pulse; NaN where a program does not come through."""
    way = np.sign(start.omega)
    through = np.maximum.accumulate(way * states.phi)
    low, high = sorted(way * edge for edge in start.edges)
    if not (np.all(np.isfinite(through)) and through[0] <= low and through[-1] >= high):
        return float("nan")
    c, s = np.cos(states.phi), np.sin(states.phi)
    right = states.right + start.e * c * states.omega
    upward = states.up - start.e * s * states.omega + states.t
    order = np.append(True, np.diff(through) > 0)
    friction, normal = (
        float(np.diff(np.interp([low, high], through[order], momentum[order]))[0]) for momentum in (right, upward)
    )
    return friction / normal
