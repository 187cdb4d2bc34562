"""How much damping the limit needs: a rigid ring on a compliant floor over damping ratio and foundation.

The ringing that the end of a slip leaves in a patch decays and breaks the stick early where it is still there when the
rigid hoop would slip again. So the distance to the limit, beyond what is predicted for a patch that has come to rest,
depends on x = zeta omega T alone: zeta and omega the patch's own damping ratio and frequency at that stiffness and the
N of the stick, T the rigid hoop's stick time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, pi
from typing import Any

from rigid import Scene

from ..inner.events import STOP, passage
from ..inner.layers import period_of
from ..inner.scales import epsilon, theta_of
from .compliant import at_foundation, go_through
from .prediction import predict

DAMPINGS = (0.0, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
FOUNDATIONS = (1e8, 1e9, 1e10, 1e11, 1e12)


@dataclass(frozen=True, slots=True)
class Spot:
    """One pulse of the map."""

    damping: float
    foundation: float
    decay: float
    """x: how often the ringing falls by e within the stick."""
    impulse_ratio: float
    limit: float
    predicted: float
    """Of a patch that comes to rest."""

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        return {name: getattr(self, name) for name in self.__slots__}


def damping_map(
    scene: Scene, dampings: Sequence[float] = DAMPINGS, foundations: Sequence[float] = FOUNDATIONS
) -> list[Spot]:
    """The first pulse's J_F/J_N over damping ratio and foundation."""
    spots = []
    for damping in dampings:
        damped = scene.replace(contact={"damping": damping})
        foreseen = predict(damped)
        term = foreseen.terms["impulse_ratio"]
        for foundation in foundations:
            here = at_foundation(damped, foundation)
            seen = go_through(here).impulse_ratio
            small = foundation ** (-1 / 3) if foreseen.parameter == "eps" else here.contact.slip_velocity_scale
            predicted = float(term.at(small))
            spots.append(Spot(damping, foundation, decay_in_stick(here), seen, term.limit, predicted))
    return spots


def decay_in_stick(scene: Scene) -> float:
    """x of a scene's shortest stick: theta omega^2/2 times its duration, omega the frequency on the tau clock.

    With H'' = -omega^2 (H + theta H') the ringing decays at the rate theta omega^2/2. Infinite where no stick ends
    within the pulse.
    """
    way = passage(scene)
    least = inf
    for now, following in zip(way.events, way.events[1:], strict=False):
        if now.kind == STOP:
            rate = theta_of(scene) * (2 * pi / period_of(way.body, now)) ** 2 / 2
            least = min(least, rate * (following.t - now.t) / epsilon(scene))
    return least
