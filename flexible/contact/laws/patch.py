"""The paper's law: the threshold of stick acts on the resultants of the patch, |F| <= mu_s N.

While it sticks, every point hangs on its bristle without a limit of its own, and a damper drags on the patch's mean
slip. While it slides, mu N is shared over the patch like the pressure. Its limit is the rigid law.
"""

from __future__ import annotations

from math import inf, isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid import Friction, Kind
from rigid.kernel.compile import loop

from ..points.bristles import add_pull, cling, drag_of, keep_touching, rolled_in, weigh
from ..points.data import Bristles, Parameters, Resultants, Shared, Tractions
from ..points.normal import force_by_gaps
from .law import Law, PatchState, Rolling

Array = NDArray[np.float64]

CODE = 0
STICK, SLIDE_RIGHT, SLIDE_LEFT = 0, 1, -1  # SLIDE_RIGHT: friction pushes the hoop to the right (spinning)


@loop
def _stick(forces: Any, points: Any, carried: Any, load: Any, slip: Any, law: Any) -> Any:
    """Bristles without a limit, and the damper's drag."""
    weigh(forces, points, carried, law.spacing, True, True)
    keep_touching(forces.keeps, points.gap)
    total = points.gap.shape[0]
    energy, stuck = 0.0, 0.0
    for i in range(total):
        weight = forces.weight[i]
        if weight != 0:
            carried.sliding[i] = 0
            traction = cling(forces, carried, i, law.eps_t)
            stuck += weight
            add_pull(forces, i, traction)
            energy += weight * traction**2 / (2 * law.eps_t)
        # a point just past the edge that points leave still bounds the bristles behind it
        if carried.touched[i] and points.gap[i] >= 0:
            before = i > 0 and not points.last[i - 1] and points.gap[i - 1] < 0
            behind = i + 1 < total and not points.last[i] and points.gap[i + 1] < 0
            forces.keeps[i] = before or behind
    dragging = load.elastic > 0 and (slip.drag > 0 or slip.held != 0)
    drag = slip.held - slip.drag * (slip.way - slip.way_0) if dragging else 0.0
    shared = Shared(dragging, drag, -slip.drag if dragging else 0.0, 0.0, drag, np.inf)
    return Tractions(shared, energy, stuck, 0.0, False)


@loop
def _slide(forces: Any, points: Any, foundation: Any, carried: Any, mode: int, load: Any, law: Any) -> Any:
    """mu N, shared like the foundation's forces; bristles that take it over will pull as much in all."""
    weigh(forces, points, carried, law.spacing, True, False)
    keep_touching(forces.keeps, points.gap)
    weight = forces.weight
    lumped = 0.0
    for i in range(weight.shape[0]):
        lumped -= law.eps_n * weight[i] * min(points.gap[i], 0.0)
    even = load.elastic / lumped if lumped > 0 else 1.0
    force_by_gaps(forces.by_gap, load.eta * mode * law.mu, foundation)
    energy, held, pulled = 0.0, 0.0, 0.0
    for i in range(weight.shape[0]):
        forces.share[i] = mode * law.mu * foundation.force[i]
        forces.force[i] = load.eta * forces.share[i]
        held -= weight[i] * law.eps_t * carried.stretch[i]
        # what a damper adds to the pressure is no spring: bristles that held it would give it back when they stick
        pressure = -law.eps_n * min(points.gap[i], 0.0)
        carried.stretch[i] = -min(load.eta, 1.0) * even * mode * law.mu * pressure / law.eps_t
        pulled -= weight[i] * law.eps_t * carried.stretch[i]
        energy += weight[i] * law.eps_t * carried.stretch[i] ** 2 / 2
    feet = (pulled - held) / (law.eps_t * foundation.length) if foundation.length > 0 else 0.0
    return Tractions(Shared(False, 0.0, 0.0, 0.0, 0.0, np.inf), energy, 0.0, feet, True)


@loop
def tractions(
    forces: Any, points: Any, foundation: Any, carried: Any, mode: int, load: Any, slip: Any, law: Any
) -> Any:  # fmt: skip
    """See :class:`flexible.contact.laws.law.Law`."""
    if mode == STICK:
        return _stick(forces, points, carried, load, slip, law)
    return _slide(forces, points, foundation, carried, mode, load, law)


@loop
def excess(law: Parameters, state: Any, force: float, velocity: float) -> float:
    """How far |F| is beyond mu_s N, or the slip beyond zero: see :func:`flexible.contact.laws.listing.excess`.

    A patch sticks up to ``|F| = mu_s N``. It slides as long as the feet of its bristles move against its friction:
    where N rises they stand before the patch does, and bristles that were stretched further with N all the same would
    take energy from nowhere; where mu N falls faster than what bristles and damper would pull if it stuck, it slides on
    beyond v = 0, as it would break in the same instant. Where a damper adds to N both have to be so;
    where it takes from N, it slides to v = 0 at least.

    Bristles let go by their stiffness times the slip. Those at the points of a patch that narrows do so by a little
    more or less; in very short steps their feet tell, without which a patch would stick and break time and again.
    """
    res = state.res
    if state.mode == STICK:  # a damper may take all of N while the bristles still pull
        beyond = (abs(res.friction) - law.mu_s * res.normal) / (force * (1 + res.normal))
        return beyond if res.elastic > 0 else -inf
    if res.normal == 0 or law.mu_s == 0:
        return -inf
    rates, beyond = state.rates, state.mode * state.slip_velocity
    if res.length > 0:
        stiffness = law.eps_t * res.length
        lags, lets_go = state.mode * rates.feet - beyond, -state.mode * rates.drag / stiffness
        if isnan(lags):
            lags = law.mu * (rates.elastic if res.eta > 1 else rates.normal) / stiffness
        if res.eta > 1:  # bristles hold nothing of what a damper adds to N
            beyond += max(min(lags, law.mu * rates.normal / stiffness + lets_go), 0.0)
        elif res.eta == 1 and lags > 0:
            beyond += lags
        else:
            beyond += min(lags + max(lets_go, 0.0), 0.0)
    return float(beyond / velocity)


@loop
def successor(state: Any) -> int:
    """From stick to sliding under the friction that broke it, and back."""
    if state.mode != STICK:
        return STICK
    return SLIDE_RIGHT if state.res.friction > 0 else SLIDE_LEFT


def opposite(state: Any) -> int:
    """The other way of sliding than that in which a patch slides, or would break loose."""
    return -(successor(state) if state.mode == STICK else state.mode)


@loop
def care(law: Parameters, state: Any) -> float:
    """A tenth before a stick breaks.

    When it does follows from the momentary F, to which the creep of the patch, a thousandth of the velocities,
    adds its acceleration: what a step may do to velocities moves that time by more than it may do to impulses.
    """
    near = state.mode == STICK and abs(state.res.friction) > law.mu_s * state.res.normal / 2
    return 0.1 if near else 1.0


@loop
def free(state: Any) -> int:
    """A patch off the floor comes down sliding, the way it moves, if only until its feet are seen to stand."""
    if state.res.elastic > 0 or state.slip_velocity == 0:
        return int(state.mode)
    return SLIDE_LEFT if state.slip_velocity > 0 else SLIDE_RIGHT


def sharing(parameters: Parameters, ratio: float) -> tuple[Parameters, int]:
    """Parameters and mode of a patch that shares the friction ``ratio`` N over its points like the pressure."""
    return parameters._replace(law=CODE, mu=ratio), SLIDE_RIGHT


class Patch(Law):
    """See the head of this file."""

    name, code, steps_of_soft = "patch", CODE, 0.3
    tractions = staticmethod(tractions)

    def start(self, kind: Kind) -> int:
        """Friction pushes a skidding hoop to the left; a smooth floor never holds."""
        slides = {Kind.SKID: SLIDE_LEFT, Kind.SPIN: SLIDE_RIGHT}.get(kind, STICK)
        return SLIDE_RIGHT if slides == STICK and kind != Kind.ROLL and self.parameters.mu_s == 0 else slides

    def rolled_in(self, bristles: Bristles, res: Resultants, pose: Rolling) -> tuple[Bristles, float]:
        """See :func:`flexible.contact.points.bristles.rolled_in`."""
        drag = drag_of(self.parameters, res.length, pose.relaxation)
        return rolled_in(bristles, self.parameters, res, pose.phi, pose.omega, drag)

    def pulls(self, state: PatchState, stretch: Array, pressure: Array) -> Array:
        """Bristles and the damper's drag, or mu times the pressure."""
        res, law = state.res, self.parameters
        held = -law.eps_t * stretch if state.mode == STICK else state.mode * law.mu * pressure * res.eta
        return held + res.damping * pressure / res.elastic if res.elastic > 0 else held

    def slipping(self, state: PatchState, sliding: Array) -> NDArray[np.bool_]:
        """All points or none."""
        return np.full(len(sliding), state.mode != STICK)

    @classmethod
    def static_coefficient(cls, friction: Friction) -> float:
        """The scene's own."""
        return friction.mu_s

    @classmethod
    def explanation(cls, friction: Friction) -> str:
        """See :class:`~flexible.contact.laws.law.Law`."""
        return (
            f"The stick threshold acts on the patch's resultants: it keeps mu_s = {friction.mu_s:g} and "
            f"mu = {friction.mu:g}."
        )
