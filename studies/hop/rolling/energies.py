"""Where the energy goes in a hop: what ring and floor stored before it, and what becomes of that.

Between the instant at which ring and floor store most and the lift-off the stored energy goes into the mass centre
(upward motion and height), into rolling on (horizontal motion and rotation), into vibration, friction and the damper.
Every term is found by itself; that they add up is a check. Units R = m = g = 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexible import History
from flexible.models.select import Hoop
from flexible.models.state import State
from flexible.output.body import whole
from rigid.output.units import Energy

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class HopEnergies:
    """Energies of one hop, in the unit of the scene."""

    stored_in_ring: Energy[float]
    """Strain of the ring at the instant at which ring and floor store most within a slow period before lift-off."""
    stored_in_floor: Energy[float]
    """Springs of the contact then."""
    mass_centre: Energy[float]
    """From then to the lift-off: gain of the mass centre's vertical motion and height, the work of N on it."""
    rolling: Energy[float]
    """Gain of its horizontal motion and of the rotation of the whole."""
    vibration: Energy[float]
    """What vibration has at lift-off: strain, and kinetic energy beyond that of a rigid motion."""
    vibration_before: Energy[float]
    """Kinetic energy of vibration at the first instant."""
    friction: Energy[float]
    """Lost to friction between the two."""
    damping: Energy[float]
    """Lost to the contact's damper."""
    numerical: Energy[float]
    """Lost to the integrator's error, by its own estimate."""
    upward: Energy[float]
    """Energy of the mass centre's upward motion at lift-off: with this it would rise against gravity."""
    landing: Energy[float]
    """Lost to friction and damper within a slow period after coming down, and before the next flight."""

    @property
    def stored(self) -> float:
        """In ring and floor together, just before."""
        return self.stored_in_ring + self.stored_in_floor

    @property
    def residual(self) -> float:
        """What the terms leave unexplained."""
        spent = self.mass_centre + self.rolling + self.friction + self.damping + self.numerical
        return self.stored + self.vibration_before - self.vibration - spent


@dataclass(frozen=True, slots=True)
class Roll:
    """A flexible motion from its steps: states and, beside each, what the history says. R = m = g = 1."""

    hoop: Hoop
    states: Sequence[State]
    history: History
    """Losses as totals over the whole motion."""

    @property
    def stored(self) -> Array:
        """Energy of ring and floor at every step."""
        return self.history.ring_strain + self.history.contact_spring


def hop_energies(roll: Roll, first: int, last: int, period: float) -> HopEnergies:
    """Energies of the flight whose steps off the floor are ``first`` to ``last``.

    Parameters
    ----------
    roll : Roll
    first, last : int
        Of the steps; the one before ``first`` is the last on the floor.
    period : float
        How long before the lift-off is looked; and after the landing, as far as the hoop is on the floor.
    """
    history, t = roll.history, roll.history.t
    standing = history.normal_force > 0
    lift = first - 1
    before = int(np.searchsorted(t, t[lift] - period))  # whatever it touched and left in between
    peak = before + int(np.argmax(roll.stored[before : lift + 1]))
    mass = 1 + roll.hoop.scene.hoop.mass_ratio
    early, late = (whole(roll.hoop, roll.states[i]) for i in (peak, lift))

    def gain(name: str, start: int = peak, end: int = lift) -> float:
        column = getattr(history, name)
        return float(column[end] - column[start])

    rise = mass * (late.velocity[1] ** 2 - early.velocity[1] ** 2) / 2 + mass * (late.height - early.height)
    on = mass * (late.velocity[0] ** 2 - early.velocity[0] ** 2) / 2 + late.rotation - early.rotation
    down = min(last + 1, len(t) - 1)
    after = _stretch(standing, t, down, period) if standing[down] else down
    return HopEnergies(
        stored_in_ring=float(history.ring_strain[peak]),
        stored_in_floor=float(history.contact_spring[peak]),
        mass_centre=rise,
        rolling=on,
        vibration=late.vibration + float(roll.stored[lift]),
        vibration_before=early.vibration,
        friction=gain("friction_loss"),
        damping=gain("damping_loss"),
        numerical=gain("numerical_loss"),
        upward=mass * max(late.velocity[1], 0.0) ** 2 / 2,
        landing=gain("friction_loss", last, after) + gain("damping_loss", last, after),
    )


def _stretch(standing: NDArray[np.bool_], t: Array, start: int, period: float) -> int:
    """The last step on the floor from ``start`` on, within ``period``."""
    i = start
    while i + 1 < len(t) and standing[i + 1] and t[i + 1] - t[start] <= period:
        i += 1
    return i
