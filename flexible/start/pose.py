"""Instants of a rigid motion: its angle, velocities and forces in the units of the flexible solver."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from math import ceil, cos, inf, sin, sqrt
from typing import get_args

import numpy as np

from rigid import Kind, Motion, Side, States
from rigid.output.units import without_units

from ..models.select import Hoop

# Time between the equilibria of which rates are made, in the time in which the forces change. Its square is the error
# of the rates; a shorter one sees how the patch's height ripples as point after point comes to bear (measured at a
# foundation of 1e4: rates 35 % off at 1e-3, 0.5 % at 1e-2).
SPAN = 1e-2
# The shortest one, in the same time: equilibria are found to some 1e-12, and the rates' error is then the same 1e-4. Of
# a phase that is over sooner there are none.
LEAST_SPAN = 1e-8


@dataclass(frozen=True, slots=True)
class Pose:
    """An instant of the rigid motion in the units of the flexible solver (R = m = g = 1)."""

    phi: float
    omega: float
    slip_velocity: float
    normal_force: float
    friction_force: float
    kind: Kind
    height: float = 0.0  # of the lowest point over the floor

    def accelerations(self, hoop: Hoop) -> tuple[float, float, float]:
        """Acceleration of C, horizontal and vertical, the latter beyond free fall, and angular acceleration, from the
        balance of the rigid hoop."""
        rigid = hoop.scene.hoop
        mass = 1 + rigid.mass_ratio
        s, c = sin(self.phi), cos(self.phi)
        angular = (self.normal_force * rigid.e * s - self.friction_force * (1 + rigid.e * c)) / (rigid.K * mass)
        up = rigid.e * self.omega**2 * c if self.kind is Kind.FLIGHT else 1.0
        return self.friction_force / mass - rigid.e * (angular * c - self.omega**2 * s), up, angular


def pose_of(now: States, kind: Kind) -> Pose:
    """A rigid motion's state, without units, of a phase of a kind."""
    forces = float(now.normal_force), float(now.friction_force)
    return Pose(float(now.phi), float(now.omega), float(now.slip_velocity), *forces, kind, max(float(now.y_C) - 1, 0.0))


def instants_around(
    motion: Motion, t: float, now: States, places: float = 0.0
) -> tuple[tuple[float, Side, float], ...]:
    """Instants (time, side, weight) of the phase at ``t``: the weighted sum of a quantity over them is its rate.

    ``now`` are the motion's states there, without units. The hoop turns by a whole number of ``places`` between them.

    The forces of the rigid hoop are functions of the angle, by way of zeta + 2 (1 + cos phi), and of 1 + phidot^2: they
    change in the time in which the root of the first or the second one do, k^2 in the pulse of a small disk. Across an
    end of the phase they jump, which is no rate, so there the parabola through three instants leans to one side.
    """
    phase, unit = motion.phase_at(t), motion.scene.time_unit
    omega, alpha = float(now.omega), float(now.alpha)
    width = sqrt(motion.scene.hoop.constants.zeta + 4 * cos(float(now.phi) / 2) ** 2)
    fastest = max(1.0, abs(omega) / width, 2 * abs(omega * alpha) / (1 + omega**2))
    span = SPAN / fastest
    if places > 0 and omega != 0:
        span = ceil(span * abs(omega) / places) * places / abs(omega)
    step = min(span * unit, (phase.t_end - phase.t_start) / 2)
    if not LEAST_SPAN * unit / fastest <= step < inf:
        return ()
    middle = min(max(t, phase.t_start + step), phase.t_end - step)
    x, rate = (t - middle) / step, unit / step
    around: tuple[tuple[float, Side, float], ...] = (
        (max(middle - step, phase.t_start), "right", (x - 0.5) * rate),
        (middle, "right", -2 * x * rate),
        (min(middle + step, phase.t_end), "left" if middle + step >= phase.t_end else "right", (x + 0.5) * rate),
    )
    return tuple(one for one in around if one[2] != 0)


def one_of(states: States, i: int) -> States:
    """The state at one of several instants."""
    return States(*(getattr(states, field.name)[i] for field in fields(States)))


def poses_at(motion: Motion, instants: tuple[tuple[float, Side, float], ...]) -> Iterator[tuple[Pose, float]]:
    """The rigid motion at instants (time, side, weight), and their weights.

    All at once: of a slip every instant is found from its beginning on.
    """
    for side in get_args(Side):
        those = [instant for instant in instants if instant[1] == side]
        if those:
            times = np.array([t for t, _, _ in those])
            states = without_units(motion.at(times, side), motion.scene)
            for i, (t, _, weight) in enumerate(those):
                yield pose_of(one_of(states, i), motion.phase_at(t, side).kind), weight
