"""The first-order prediction y = L + c eps of a pulse's measures, without a fitted number.

L is the rigid value of the law's own hoop. At order eps the compliance does three things to the motion, and no more:
where the hoop rolls its contact point creeps, v = eps V; at an event the patch passes from one steady state to the next
in a layer whose impulses are those that change v by eps times the change of V, since dot h is of order eps^2 on both
sides; and the next events come earlier or later for it. The layers' history does not enter, as long as the patch has
come to rest in them; see the theory in ``studies/README.md``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rigid import Scene

from .body import arms, rolling_forces
from .creep import creep
from .events import REVERSAL, START, STOP, Event, Passage, passage
from .inner import BRUSH, PATCH
from .layers import slip_behind
from .outer import Shift, Stretch, delay_of_break, delay_of_stop, grown, passed, roll_along, slide_along
from .scales import epsilon


@dataclass(frozen=True, slots=True)
class Term:
    """A measure as stiffness grows: limit + coefficient eps."""

    limit: float
    coefficient: float
    """Of the (-1/3) power of the foundation eps_n R^2/(m g), in the measure's unit."""

    def at(self, foundation: float) -> float:
        """The measure at a foundation."""
        return self.limit + self.coefficient * foundation ** (-1 / 3)


def predict(scene: Scene) -> dict[str, Term]:
    """Limit and coefficient of ``normal_impulse``, ``friction_impulse``, ``impulse_ratio``, ``friction_loss`` and
    ``damping_loss`` of the scene's first pulse, in the units of the scene.
    """
    way = passage(scene)
    body, pulse = way.body, way.pulse
    shift = _handed_over(way)
    marks = {}
    for number, stretch in enumerate(way.stretches):
        low, high = sorted((stretch.psi_start, stretch.psi_end))
        if low <= way.edges[0] <= high and 0 not in marks:
            at_edge, omega = _along(way, replace(stretch, psi_end=way.edges[0]), shift)
            marks[0] = grown(body, way.edges[0], omega, way.slips[0], at_edge), at_edge.damping_loss
        shift, omega = _along(way, stretch, shift)
        if number < len(way.events):
            shift = _through(way, way.events[number], shift)
    marks[1] = grown(body, way.edges[1], omega, way.slips[1], shift), shift.damping_loss
    friction, normal, energy = marks[1][0] - marks[0][0]
    damped = marks[1][1] - marks[0][1]
    # eps is that of the total mass, the foundation's unit and the impulses' that of the disk
    hoop = scene.hoop
    mass = 1 + hoop.mass_ratio
    unit = epsilon(scene) * scene.contact.stiffness ** (1 / 3)
    impulse, work = unit * mass * scene.impulse_unit, unit * mass * scene.energy_unit
    ratio = pulse.impulse_ratio
    return {
        "normal_impulse": Term(pulse.normal_impulse, normal * impulse),
        "friction_impulse": Term(pulse.friction_impulse, friction * impulse),
        "impulse_ratio": Term(ratio, (friction - ratio * normal) * impulse / pulse.normal_impulse),
        "friction_loss": Term(pulse.friction_loss, (-energy - damped) * work),
        "damping_loss": Term(0.0, damped * work),
    }


def _handed_over(way: Passage) -> Shift:
    """The flexible hoop takes phidot over, and creeps as an undamped patch would (``flexible.start.hand_over``)."""
    first = way.stretches[0]
    if first.pull is not None:
        return Shift(0.0, 0.0, 0.0)
    normal, friction, _ = rolling_forces(way.body, first.psi_start, first.omega)
    undamped = way.contact._replace(law=PATCH, theta=0.0)
    return Shift(0.0, creep(undamped, normal, friction, first.omega).slip, 0.0)


def _along(way: Passage, stretch: Stretch, shift: Shift) -> tuple[Shift, float]:
    if stretch.pull is None:
        return roll_along(way.body, way.contact, stretch, shift)
    return slide_along(way.body, stretch, shift)


def _through(way: Passage, event: Event, shift: Shift) -> Shift:
    """The shift behind an event: it comes later, and its layer changes the slip."""
    pulls = event.before, event.behind
    where = (way.body, event.psi, event.omega)
    if event.kind == START:
        # with mu_s = mu nothing jumps, whenever it happens; a brush with mu_s > mu breaks away another way
        if way.contact.law == BRUSH or way.contact.mu_s == way.contact.mu:
            return shift
        return passed(*where, shift, delay_of_break(way.body, way.contact, event.psi, event.omega, shift), pulls)
    assert event.before is not None
    shift = passed(*where, shift, delay_of_stop(*where, shift, event.before), pulls)
    if event.kind == STOP:
        return shift
    assert event.kind == REVERSAL
    change = slip_behind(way.body, way.contact, event)
    a, b, _ = arms(way.body.e, way.body.one_minus_e, event.psi)
    turned = -b * change / (way.body.gyration + a * a + b * b)
    return replace(shift, slip=shift.slip + change, omega=shift.omega + turned)
