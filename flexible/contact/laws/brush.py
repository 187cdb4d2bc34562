"""The brush: a bristle breaks at mu_s p, p the pressure at its point, and slides at mu p.

One that slides stands again as soon as what it may carry, mu p, grows faster than the rim stretches it. If it would
while the damper adds the same share to p, it sticks, and breaks at mu_s p. If not it only rests, and breaks at mu p:
it stands since the damper presses it harder from one instant to the next. As a brush breaks loose that goes on and on
otherwise: friction falls from mu_s to mu, a wall without mass gives way to that, at once, and N falls with it, since
the damper lets no depth jump; N comes back within the damper's time on the wall, some 1e-6, all points stand, break
together, and N falls again. How often hangs on the steps, the points and the wall, and the impulses with it, by up to
a hundredth. The stiffer the wall the more of it there is, and none on a rigid one.

A rolling patch then breaks away from its rear. With pressure p = 4 p_0 u (1 - u), u from 0 at the leading to 1 at the
trailing edge, and bristles stretched in proportion to the way from the leading edge, the points with u < b stick and
the rest slides when c b = 4 mu_s p_0 b (1 - b) at u = b; so

    F/N = 6 [c b^2/2 + mu * 4 p_0 (1/6 - b^2/2 + b^3/3)]/(4 p_0) = 3 mu_s (b^2 - b^3) + mu (1 - 3 b^2 + 2 b^3),

whatever the stiffness. Its largest value, at b = 2 (mu_s - mu)/(3 mu_s - 2 mu), is all that a rolling brush can carry:
its limit is the rigid hoop with that static coefficient.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid import Friction
from rigid.kernel.compile import loop

from ..points.bristles import add_pull, cling, keep_touching, rolled_in, weigh
from ..points.data import Bristles, Resultants, Shared, Tractions
from .law import Law, PatchState, Rolling

Array = NDArray[np.float64]

CODE = 1
LIMITED = 0.97  # of all that a rolling patch can carry


@loop
def tractions(
    forces: Any, points: Any, foundation: Any, carried: Any, mode: int, load: Any, slip: Any, law: Any
) -> Any:  # fmt: skip
    """See :class:`flexible.contact.laws.law.Law`."""
    stretch, sliding = carried.stretch, carried.sliding
    # a brush pulls nothing at its edges, and is held to the pressure, which ends on a straight gap
    weigh(forces, points, carried, law.spacing, False, False)
    keep_touching(forces.keeps, points.gap)
    energy, stuck, side, slides = 0.0, 0.0, 0, True
    for i in range(stretch.shape[0]):
        weight = forces.weight[i]
        if weight == 0:
            continue
        pressure = -law.eps_n * min(points.gap[i], 0.0)
        was = sliding[i]
        limit = (law.mu if was != 0 else law.mu_s) * load.eta * pressure
        if abs(law.eps_t * stretch[i]) > limit:
            sliding[i] = 1 if stretch[i] < 0 else -1
            forces.share[i] = weight * sliding[i] * law.mu * pressure
            traction = sliding[i] * law.mu * load.eta * pressure
            stretch[i] = -traction / law.eps_t
            forces.by_gap[i, 2] = -weight * sliding[i] * law.mu * load.eta * law.eps_n
        else:
            if was != 0:
                grows = pressure + law.eps_n * min(points.gap_old[i], 0.0)
                side_of = 1 if was > 0 else -1
                sticks = -side_of * law.eps_t * carried.way[i] <= law.mu * load.eta * grows
                sliding[i] = 0 if sticks else 2 * side_of
            traction = cling(forces, carried, i, law.eps_t)
            stuck += weight
        slides = slides and abs(sliding[i]) == 1 and was == sliding[i] and (side == 0 or side == was)
        side = was
        add_pull(forces, i, traction)
        energy += weight * traction**2 / (2 * law.eps_t)
    return Tractions(Shared(False, 0.0, 0.0, 0.0, 0.0, np.inf), energy, stuck, 0.0, slides)


@loop
def effective_mu_s(mu_s: float, mu: float) -> float:
    """Largest F/N of a rolling parabolic brush patch whose points break at ``mu_s`` p and slide at ``mu`` p."""
    if mu_s <= mu:
        return mu_s
    q = mu / mu_s
    b = 2 * (1 - q) / (3 - 2 * q)
    return max(mu, mu_s * (3 * (b**2 - b**3) + q * (1 - 3 * b**2 + 2 * b**3)))


@loop
def is_loaded(law: Any, state: Any) -> bool:
    """Whether the patch carries next to all that a rolling one can."""
    res = state.res
    most = effective_mu_s(law.mu_s, law.mu) * res.normal
    return bool(res.stuck > 0 and abs(res.friction) > LIMITED * most)


@loop
def breaks(law: Any, before: Any, now: Any) -> bool:
    """Whether the patch breaks loose in a step, or may."""
    breaks_here = before.res.stuck > 0 and now.res.stuck == 0
    return bool(now.res.normal > 0 and (is_loaded(law, before) or breaks_here))


class Brush(Law):
    """See the head of this file. It has one mode: stick and slip are each point's own."""

    name, code, points, points_of_soft = "brush", CODE, 12, 20
    tractions = staticmethod(tractions)

    def rolls(self, state: PatchState, omega: float, share: float) -> bool:
        """Points that stick are not enough, as some do for an instant in a brush that slides: it creeps no faster than
        one that slips as a whole does, and swings no faster than bristles can catch a hoop, both twice."""
        law, res = self.parameters, state.res
        creeps = law.mu_s * abs(omega) * res.length / 2 * law.eps_n / law.eps_t
        caught = law.mu_s * res.normal / sqrt(law.eps_t * res.length) if res.length > 0 else 0.0
        return res.stuck > 0 and abs(state.slip_velocity) <= 2 * (creeps + caught)

    def rolled_in(self, bristles: Bristles, res: Resultants, pose: Rolling) -> tuple[Bristles, float]:
        """See :func:`flexible.contact.points.bristles.rolled_in`."""
        return rolled_in(bristles, self.parameters, res, pose.phi, pose.omega)

    def slid_in(self, bristles: Bristles, res: Resultants) -> Bristles:
        """All points slide, their stretch beyond what they hold: one that is at it to the last bit would stick."""
        sliding = np.full_like(bristles.sliding, 1 if res.friction > 0 else -1)
        return bristles._replace(stretch=2 * bristles.stretch, sliding=sliding)

    def pulls(self, state: PatchState, stretch: Array, pressure: Array) -> Array:
        """The bristles' pull."""
        return -self.parameters.eps_t * stretch

    def slipping(self, state: PatchState, sliding: Array) -> NDArray[np.bool_]:
        """See :class:`~flexible.contact.laws.law.Law`."""
        return np.abs(sliding) == 1

    @classmethod
    def static_coefficient(cls, friction: Friction) -> float:
        """See :func:`effective_mu_s`."""
        return effective_mu_s(friction.mu_s, friction.mu)

    @classmethod
    def breaks_by_points(cls, friction: Friction) -> bool:
        """Where there is more to hold than to slide with."""
        return friction.mu_s > friction.mu

    @classmethod
    def explanation(cls, friction: Friction) -> str:
        """See :class:`~flexible.contact.laws.law.Law`."""
        if friction.mu_s == friction.mu:
            return f"A brush with mu_s = mu = {friction.mu:g} tends to the rigid hoop of the same coefficients."
        return (
            "A brush breaks away from its rear, so its limit is the rigid hoop with mu_s replaced by "
            f"mu_eff = {cls.static_coefficient(friction):.5f}."
        )
