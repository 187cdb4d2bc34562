"""Friction smoothed by a velocity, as most codes have it: F = -mu N v/sqrt(v^2 + v_s^2) on the patch as a whole.

v is the slip velocity of the patch at the end of the implicit stage, and F is shared over the patch like the pressure.
Nothing is stored and nothing sticks: under a constant friction F = -q mu N the patch creeps with
v = v_s q/sqrt(1 - q^2). A phase is called rolling while |v| < v_s, which is |F| < mu N/sqrt(2). mu_s has no part in it,
so its limit for v_s -> 0 is the rigid hoop with mu_s = mu, and not the paper's where mu_s > mu.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any

from rigid import Friction
from rigid.kernel.compile import loop

from ..points.bristles import keep_touching
from ..points.data import Bristles, Resultants, Shared, Tractions
from .law import Law, PatchState, Rolling

CODE = 2
_MOST = 0.999  # of mu N that a creep is sought for: the rest is sliding


@loop
def tractions(
    forces: Any, points: Any, foundation: Any, carried: Any, mode: int, load: Any, slip: Any, law: Any
) -> Any:  # fmt: skip
    """See :class:`flexible.contact.laws.law.Law`."""
    for i in range(carried.stretch.shape[0]):
        carried.stretch[i] = 0.0
    keep_touching(forces.keeps, points.gap)
    speed = sqrt(slip.velocity**2 + law.slip_scale**2)
    coefficient = -law.mu * slip.velocity / speed
    by_velocity = -law.mu * law.slip_scale**2 / speed**3
    # a damper pulls on the way of Newton alone: friction turned round with N would drive the patch on
    normal, by_elastic = 0.0, 0.0
    if load.eta > 0:
        normal, by_elastic = load.eta * load.elastic, load.eta + load.eta_rate * load.elastic
    shared = Shared(
        load.elastic > 0,
        coefficient * normal,
        by_velocity * slip.rate * normal,
        coefficient * by_elastic,
        0.0,
        speed / slip.rate if slip.rate > 0 and load.eta > 0 else inf,
    )
    stuck = foundation.length if abs(slip.velocity) < law.slip_scale else 0.0
    return Tractions(shared, 0.0, stuck, 0.0, True)


class Regularised(Law):
    """See the head of this file."""

    name, code = "regularised", CODE
    rolls_to = 0.3  # of a hoop that creeps as slowly as that what is left out is a hundredth of what v_s changes
    lost_when_soft = True
    tractions = staticmethod(tractions)

    def rolls(self, state: PatchState, omega: float, share: float) -> bool:
        """Where a rigid hoop would, and this one creeps no faster than twice what carries that one's F, and v_s."""
        if share >= self.parameters.mu:
            return False
        part = share / self.parameters.mu
        return abs(state.slip_velocity) <= self.parameters.slip_scale * (1 + 2 * part / sqrt(1 - part**2))

    def rolled_in(self, bristles: Bristles, res: Resultants, pose: Rolling) -> tuple[Bristles, float]:
        """The creep that carries F."""
        most = self.parameters.mu * res.normal
        if most == 0:
            return bristles, 0.0
        share = min(max(-res.friction / most, -_MOST), _MOST)
        return bristles, self.parameters.slip_scale * share / sqrt(1 - share**2)

    @classmethod
    def explanation(cls, friction: Friction) -> str:
        """See :class:`~flexible.contact.laws.law.Law`."""
        if friction.mu_s == friction.mu:
            return f"Regularised friction with mu_s = mu = {friction.mu:g} tends to the rigid hoop of that mu."
        return (
            "Regularised friction knows no static coefficient, so its limit is the rigid hoop with mu_s replaced by "
            f"mu = {friction.mu:g}."
        )

    @classmethod
    def rolls_below(cls, contact: Any) -> float:
        """v_s."""
        return float(contact.slip_velocity_scale)

    @classmethod
    def stiffened(cls, contact: Any, factor: float) -> dict[str, float]:
        """v_s falls as the patch's half width does, like stiffness^(-1/3)."""
        return {"slip_velocity_scale": contact.slip_velocity_scale * factor ** (-1 / 3)}
