"""The first-order prediction y = L + c eps of a pulse's measures, without a fitted number.

L is the rigid value of the law's own hoop. At order eps the compliance does three things to the motion, and no more:
where the hoop rolls its contact point creeps, v = eps V; at an event the patch passes from one steady state to the next
in a layer whose impulses are those that change v by eps times the change of V, since dot h is of order eps^2 on both
sides; and the next events come earlier or later for it. The layers' history does not enter, as long as the patch has
come to rest in them, but for a layer that an end of the pulse cuts (:mod:`studies.inner.cut`). Laws without a jump at
the start of a slip add a term of their own (:mod:`studies.limit.onset`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import copysign
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid import Scene

from ..inner.creep import creep
from ..inner.cut import impulses_far_behind, impulses_until
from ..inner.events import START, STOP, Event, Passage, Stretch
from ..inner.layers import slip_behind
from ..inner.march.body import arms, rolling_forces, rolling_inertia
from ..inner.march.equations import BRUSH, REGULARISED
from ..inner.scales import epsilon
from ..inner.stops.hanging import followed
from ..running.files import StudyError
from ..running.measures import OF_THE_MEASURE, units_of_measures
from . import onset
from .outer import Shift, delay_of_break, delay_of_stop, grown, passed, roll_along, slide_along

CREEP, NEXT, NEXT_OF_A_RING_WITH_MASS = 1.0, 2.0, 3 / 2
"""Powers of eps by which rolling's creep changes a pulse, and of what comes behind it: the frequencies of an elastic
ring with a mass are greater than the patch's by eps^(-1/2)."""

BRUSH_DELAY, BRUSH_LAG, REGULARISED_GAIN = 2 / 3, 6 / 5, 4 / 5
"""Those that the start of a slip adds where friction has no jump there, of eps (or v_s): see
:mod:`studies.limit.onset`."""

ROUND_OFF = 1e-12
"""Of losses over M g R and of ratios of impulses, and of their coefficients: what is smaller is none."""

MEASURES = ("normal_impulse", "friction_impulse", "impulse_ratio", "friction_loss", "damping_loss")
NOTHING = Shift(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Term:
    """A measure at great stiffness: limit + the sum of coefficient x^exponent."""

    limit: float
    powers: tuple[tuple[float, float], ...]
    """(exponent, coefficient), the leading one first."""

    @property
    def coefficient(self) -> float:
        """Of the leading power."""
        return self.powers[0][1] if self.powers else 0.0

    @property
    def exponent(self) -> float:
        """The leading power's."""
        return self.powers[0][0] if self.powers else 1.0

    def at(self, x: Any) -> Any:
        """The measure at values of the small parameter."""
        return self.limit + sum(c * np.asarray(x, float) ** p for p, c in self.powers)

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        return {
            "limit": self.limit,
            "coefficient": self.coefficient,
            "exponent": self.exponent,
            "further": [{"coefficient": c, "exponent": p} for p, c in self.powers[1:]],
        }


@dataclass(frozen=True, slots=True)
class Prediction:
    """Limit and approach of the measures of a scene's first pulse."""

    parameter: str
    """What is small: "eps", the foundation eps_n R^2/(m g) to the power -1/3, or "v_s", the slip velocity scale of a
    regularised law over sqrt(g R)."""
    terms: dict[str, Term]
    """By measure, in the units of the scene."""
    complete: bool
    """Whether all terms down to the order of the creep are there; otherwise those left out, smaller in the end, may be
    the larger ones at stiffnesses that can be reached."""
    exponents: tuple[float, ...]
    """The leading powers of what is small, whether their coefficients are known or not; twice where it comes with a
    logarithm too. What is small falls with the foundation to the power -1/3, a slip velocity scale because
    :meth:`flexible.contact.laws.law.Law.stiffened` has it so."""

    @property
    def rates(self) -> tuple[float, ...]:
        """The same as rates: powers of 1/foundation."""
        return tuple(power / 3 for power in self.exponents)


def predict(scene: Scene, rolls_to: float | None = None) -> Prediction:
    """The approach of the scene's first pulse to its limit, for every stiffness at once.

    Parameters
    ----------
    scene : Scene
        What is asked.
    rolls_to : float, optional
        See :func:`studies.inner.events.passage`.

    Raises
    ------
    StudyError
        See :func:`studies.inner.events.passage`.
    """
    way = followed(scene, rolls_to)
    return _with_units(scene, way, powers(way))


def foreseen(scene: Scene, law: str) -> Prediction | None:
    """The same under another law of friction; None where its pulse has more in it than this scene's."""
    try:
        return predict(scene.replace(contact={"law": law}))
    except StudyError:
        return None


def powers(way: Passage) -> dict[float, NDArray[np.float64]]:
    """Changes of J_F, J_N, energy and damping loss over a pulse, by the power of eps (or v_s); R = g = M = 1."""
    law, mu_s, mu = way.contact.law, way.contact.mu_s, way.contact.mu
    found: dict[float, NDArray[np.float64]] = {}
    breaks = law == BRUSH and mu_s > mu  # then a term of lower order than the creep leads, and the next is not known
    starts = [(i, event) for i, event in enumerate(way.events) if event.kind == START]
    if law == REGULARISED:
        way = replace(way, contact=way.contact._replace(slip_scale=1.0))
    for number, event in starts:
        if law == REGULARISED:
            shift = onset.regularised_gain(way.body, way.contact, event)
            _add(found, REGULARISED_GAIN, _walk(way, number + 1, shift, REGULARISED_GAIN))
        elif breaks:
            shift = onset.brush_delay(way.body, way.contact, event, way.scene.friction.mu_s)
            _add(found, BRUSH_DELAY, _walk(way, number + 1, shift, BRUSH_DELAY))
        elif law == BRUSH:
            shift = onset.brush_lag(way.body, way.contact, event)
            _add(found, BRUSH_LAG, _walk(way, number + 1, shift, BRUSH_LAG))
    if not (starts and (breaks or law == REGULARISED)):
        _add(found, CREEP, _walk(way, 0, _handed_over(way), CREEP))
    return found


def _add(found: dict[float, NDArray[np.float64]], exponent: float, change: NDArray[np.float64]) -> None:
    found[exponent] = found.get(exponent, 0.0) + change


def _walk(way: Passage, number: int, shift: Shift, exponent: float) -> NDArray[np.float64]:
    """What a shift of order eps^``exponent`` at the start of stretch ``number`` makes of J_F, J_N, energy and damping
    loss over the pulse; of that of the creep, with what the creep does from there on.
    """
    body, creeps = way.body, exponent == CREEP
    before, cut = np.zeros(4), np.zeros(4)
    for i in range(number, len(way.stretches)):
        stretch = way.stretches[i]
        if _reaches(stretch, way.edges[0]) or (i == 0 and way.edges[0] == way.start):
            here, omega = _along(way, replace(stretch, psi_end=way.edges[0]), shift, creeps)
            before = np.append(grown(body, way.edges[0], omega, way.slips[0], here), here.damping_loss)
        shift, omega = _along(way, stretch, shift, creeps)
        if i < len(way.events):
            if abs(way.events[i].psi - way.edges[0]) < ROUND_OFF:
                cut[:2] -= _cut(way, way.events[i], shift, exponent)
            shift = _through(way, way.events[i], shift, creeps)
    if way.last is not None:
        cut[:2] += _cut(way, way.last, shift, exponent)
    after = np.append(grown(body, way.edges[1], omega, way.slips[1], shift), shift.damping_loss)
    return after - before + cut


def _cut(way: Passage, event: Event, shift: Shift, exponent: float) -> Any:
    """What has come of an event at an end of the pulse, to J_F and J_N, by the angle of that end."""
    tau = -_later(way, event, shift, exponent == CREEP) / event.omega
    if exponent == CREEP:
        return impulses_until(way.body, way.contact, event, tau)
    # a shift of lower order passes the whole layer over the end; one of higher order is little of it
    return impulses_far_behind(way.body, event, tau) if exponent < CREEP else np.zeros(2)


def _reaches(stretch: Stretch, psi: float) -> bool:
    """Whether a stretch comes to an angle behind its start; what begins with an event is what was before it."""
    way = copysign(1.0, stretch.omega)
    return way * stretch.psi_start < way * psi <= way * stretch.psi_end


def _handed_over(way: Passage) -> Shift:
    """The flexible hoop takes phidot over, and creeps as its patch does in steady rolling."""
    first = way.stretches[0]
    if first.pull is not None:
        return NOTHING
    normal, friction, _ = rolling_forces(way.body, first.psi_start, first.omega)
    return Shift(0.0, creep(way.contact, normal, friction, first.omega).slip, 0.0)


def _along(way: Passage, stretch: Stretch, shift: Shift, creeps: bool) -> tuple[Shift, float]:
    if stretch.pull is None:
        return roll_along(way.body, way.contact if creeps else None, stretch, shift)
    return slide_along(way.body, stretch, shift)


def _later(way: Passage, event: Event, shift: Shift, creeps: bool) -> float:
    """By how much in psi an event comes later."""
    where = way.body, event.psi, event.omega
    if event.before is not None:
        return delay_of_stop(*where, shift, event.before)
    # without a jump it does not matter when it happens
    if way.contact.mu_s == way.contact.mu or way.contact.law == REGULARISED:
        return 0.0
    return delay_of_break(way.body, way.contact if creeps else None, way.scene.friction.mu_s, *where[1:], shift)


def _through(way: Passage, event: Event, shift: Shift, creeps: bool) -> Shift:
    """The shift behind an event: it comes later, and its layer changes the slip."""
    body, contact = way.body, way.contact
    later = _later(way, event, shift, creeps)
    shift = passed(body, event.psi, event.omega, shift, later, (event.before, event.behind))
    if event.kind == START:
        return shift
    if event.kind != STOP and creeps:
        change = slip_behind(body, contact, event)
        _, b, _ = arms(body.e, body.one_minus_e, event.psi)
        shift = replace(
            shift, slip=shift.slip + change, omega=shift.omega - b * change / rolling_inertia(body, event.psi)
        )
    return shift


def units_told(scene: Scene) -> dict[str, str]:
    """What the numbers of a limit study are measured in, by name: measures in units of the scene, events never."""
    pure = ("foundation", "separate", "stiff", "exponent", "phi", "peak_ratio", "critical_damping", "damping", "decay",
            "force_ratio", "other_impulse_ratio", "holds", "over_predicted")  # fmt: skip
    of_measures = ("value", "numerical_error", "limit", "distance", "predicted", "coefficient")
    weight, tau = "(m + m_h) g", "eps sqrt(R/g)"
    return {
        **dict.fromkeys(pure, "1"),
        **{name: unit for name, unit in units_of_measures(scene).items() if name in MEASURES},
        **dict.fromkeys(of_measures, OF_THE_MEASURE),
        **{"t": "sqrt(R/g)", "omega": "sqrt(g/R)", "normal_force": weight, "friction_force": weight},
        **{"resticks": tau, "settles": tau, "period": tau, "creep": "eps sqrt(gR)"},
    }


def _with_units(scene: Scene, way: Passage, found: dict[float, NDArray[np.float64]]) -> Prediction:
    pulse, mass = way.pulse, 1 + scene.hoop.mass_ratio
    regularised = way.contact.law == REGULARISED
    # eps is that of the total mass, the foundation's unit that of the disk
    unit = 1.0 if regularised else epsilon(scene) * scene.contact.stiffness ** (1 / 3)
    limits = {name: getattr(pulse, name, 0.0) for name in MEASURES}
    if abs(limits["friction_loss"]) < ROUND_OFF * mass * scene.energy_unit:
        limits["friction_loss"] = 0.0
    powers: list[list[tuple[float, float]]] = [[] for _ in MEASURES]
    none = [ROUND_OFF * mass * each for each in (*[scene.impulse_unit] * 2, 1 / mass, *[scene.energy_unit] * 2)]
    for exponent in sorted(found):
        friction, normal, energy, damped = found[exponent] * mass * unit**exponent
        friction, normal = friction * scene.impulse_unit, normal * scene.impulse_unit
        ratio = (friction - pulse.impulse_ratio * normal) / pulse.normal_impulse
        losses = (-energy - damped) * scene.energy_unit, damped * scene.energy_unit
        for kept, value, least in zip(powers, (normal, friction, ratio, *losses), none, strict=True):
            kept.append((exponent, float(value) if abs(value) >= least else 0.0))
    terms = {name: Term(float(limits[name]), tuple(kept)) for name, kept in zip(MEASURES, powers, strict=True)}
    # CREEP follows where an onset leads; where it leads itself, the onset's lag or the next order
    behind = NEXT_OF_A_RING_WITH_MASS if scene.hoop.mass_ratio > 0 else NEXT
    leading = sorted({*found, CREEP, behind})[:2]
    if not any(coefficient for term in terms.values() for _, coefficient in term.powers):
        leading = [behind, behind + 1]  # it slides throughout: the patch's depth, and what the ring gives way
    if BRUSH_DELAY in found:  # the runaway takes its time from the creep, as a logarithm
        leading.append(CREEP)
    return Prediction("v_s" if regularised else "eps", terms, CREEP in found, tuple(leading))
