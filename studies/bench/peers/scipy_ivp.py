"""The rigid hoop as a competent user of ``scipy.integrate.solve_ivp`` writes it: in time, modes switched by events.

Massless hoop with r = 1, R = m = g = 1, state (x_C, phi, xdot_C, phidot).
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...running.files import StudyError

Array = NDArray[np.float64]
METHODS = ("DOP853", "LSODA", "Radau")
_LONGEST = 20.0
_MOST_PHASES = 60


class Equations:
    """Equations of motion and events of the three modes: 0 rolls, otherwise the sign of the slip velocity."""

    def __init__(self, k: float, mu_s: float, mu: float) -> None:
        self.a, self.j, self.mu_s, self.mu = 1 - k, k * k / 2, mu_s, mu

    def rolling(self, phi: float, w: float) -> tuple[float, float, float]:
        """Angular acceleration, N and F."""
        a, s, c = self.a, sin(phi), cos(phi)
        alpha = a * s * (1 + w * w) / (1 + a * a + 2 * a * c + self.j)
        return alpha, 1 - a * (c * w * w + s * alpha), alpha - a * (s * w * w - c * alpha)

    def slope(self, mode: int) -> Callable[[float, Array], list[float]]:
        """Right-hand side."""
        a, j, friction = self.a, self.j, self.mu * mode

        def roll(_: float, y: Array) -> list[float]:
            alpha, _, _ = self.rolling(y[1], y[3])
            return [y[2], y[3], alpha, alpha]

        def slide(_: float, y: Array) -> list[float]:
            w, s, c = y[3], sin(y[1]), cos(y[1])
            arm = a * s + friction * (1 + a * c)
            load = (1 - a * c * w * w) / (j + a * s * arm)
            alpha = arm * load
            return [y[2], w, -friction * j * load - a * (c * alpha - s * w * w), alpha]

        return slide if mode else roll

    def contact_event(self, mode: int) -> Any:
        """Where the mode ends."""

        def slides(_: float, y: Array) -> float:
            _, normal, friction = self.rolling(y[1], y[3])
            return self.mu_s * normal - abs(friction)

        def sticks(_: float, y: Array) -> float:
            return float(y[2] - y[3])

        event: Any = sticks if mode else slides
        event.terminal, event.direction = True, -mode if mode else -1
        return event


def scipy_turns(
    k: float, mu_s: float, mu: float, phi0: float, turns: int, method: str, rtol: float
) -> list[tuple[float, float, float, float]]:
    """Turns as (t, phi, slip velocity, energy), with atol = rtol/100.

    Raises
    ------
    StudyError
        An event was missed, so that the motion never gets there.
    """
    from scipy.integrate import solve_ivp

    hoop = Equations(k, mu_s, mu)
    y, t, mode = np.array([0.0, phi0, 0.0, 0.0]), 0.0, 0
    _, normal, friction = hoop.rolling(phi0, 0.0)
    if abs(friction) > mu_s * normal:
        mode = -1 if friction > 0 else 1
    found: list[tuple[float, float, float, float]] = []
    for _ in range(_MOST_PHASES):

        def turn(_: float, y: Array) -> float:
            return float(y[3])

        event: Any = turn
        event.terminal, event.direction = True, -1 if len(found) % 2 == 0 else 1
        events = [event, hoop.contact_event(mode)]
        run = solve_ivp(hoop.slope(mode), (t, _LONGEST), y, method, rtol=rtol, atol=rtol / 100, events=events)
        if run.status != 1:
            break
        t, y = float(run.t[-1]), run.y[:, -1].copy()
        if len(run.t_events[0]):
            y[3] = 0.0
            found.append((t, float(y[1]), float(y[2]), 0.5 * float(y[2]) ** 2 + 1 + hoop.a * cos(y[1])))
            if len(found) == turns:
                return found
            continue
        y[2] = y[3]
        _, normal, friction = hoop.rolling(y[1], y[3])
        if mode == 0:
            mode = -1 if friction > 0 else 1
        else:
            mode = 0 if normal > 0 and abs(friction) <= mu_s * normal else -mode
    raise StudyError(f"{method} at rtol = {rtol:g} missed an event after t = {t:.6g}.")


def installed(name: str) -> bool:
    """Whether a package of another solver can be imported."""
    return find_spec(name) is not None
