"""The events of the rigid motion in and before a pulse, each with the state that its inner problem starts from."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from flexible import rigid_limit
from flexible.contact.laws.listing import LAWS
from flexible.run.pulses import BEHIND, lead
from rigid import Kind, Motion, Pulse, Run, Scene, simulate
from rigid.output.units import without_units

from ..running.files import StudyError
from .body import Body, body_of
from .march import BRUSH, PATCH, REGULARISED, ScaledContact
from .scales import epsilon, theta_of

START, STOP, REVERSAL = "slip starts", "slip stops", "slip reverses"


@dataclass(frozen=True, slots=True)
class Event:
    """An instant of the rigid motion at which its forces jump; units R = g = M = 1."""

    kind: str
    t: float
    psi: float
    """Angle of the disk from the bottom."""
    omega: float
    before: float | None
    """F/N in the slip before it, None where the hoop rolled."""
    behind: float | None
    """F/N in the slip behind it, None where the hoop rolls."""
    bottom: float = pi
    """phi of the rigid motion where the disk is lowest in this pulse: -pi of a hoop that rolls left from the top."""

    @property
    def phi(self) -> float:
        """Angle from the top, as the rigid motion counts it."""
        return self.psi + self.bottom


@dataclass(frozen=True, slots=True)
class Stretch:
    """A phase of the rigid motion between two angles; ``pull`` is F/N where it slides, None where it rolls."""

    psi_start: float
    psi_end: float
    omega: float
    """phidot at the start."""
    pull: float | None


@dataclass(frozen=True, slots=True)
class Passage:
    """The rigid motion from the hand-over to the end of a pulse, as the prediction walks along it."""

    scene: Scene
    """The hoop that the contact law tends to."""
    body: Body
    contact: ScaledContact
    pulse: Pulse
    start: float
    """psi at which the flexible hoop begins."""
    stretches: tuple[Stretch, ...]
    events: tuple[Event, ...]
    edges: tuple[float, float]
    """psi at both ends of the pulse."""
    slips: tuple[float, float]
    """Slip velocity there."""
    first_slip: float
    """Slip velocity at the start."""


def scaled_contact(scene: Scene, damping: float | None = None) -> ScaledContact:
    """The contact of a scene in the scaled problem."""
    contact, friction = scene.contact, scene.friction
    code = LAWS[contact.law].code
    if code not in (PATCH, BRUSH, REGULARISED):
        raise StudyError(f"The {contact.law} law has no scaled form yet, so its limit is not known.")
    scale, theta = contact.slip_velocity_scale / epsilon(scene), theta_of(scene, damping)
    return ScaledContact(code, contact.tangential_ratio, friction.mu_s, friction.mu, theta, scale)


def passage(scene: Scene, rolls_to: float | None = None) -> Passage:
    """The first pulse of a scene.

    Parameters
    ----------
    scene : Scene
        What is asked.
    rolls_to : float, optional
        Share of mu N up to which the rolling before the pulse is left out, that of the law's by default; 1 leaves out
        all that is more than half a pulse before.

    Raises
    ------
    StudyError
        There is no whole pulse, the hoop is released inside another one, it has more than rolling and sliding in it, or
        the hoop is at rest where it begins or turns round in it.
    """
    tended = rigid_limit(scene)
    motion = simulate(tended.replace(run=Run(until="pulse")))
    if not motion.pulses:
        raise StudyError(f"The rigid hoop has no pulse to study here: {motion.ended}.")
    pulse = motion.pulses[0]
    if pulse.cut:
        raise StudyError(
            "The hoop is released inside a pulse: how the state in which it comes to the first whole one tends to that "
            "of the rigid hoop is not foreseen."
        )
    share = LAWS[scene.contact.law].rolls_to if rolls_to is None else rolls_to
    first = lead(motion, pulse, share)
    if motion.at(first).omega == 0:  # from rest nothing is foreseen: the creep right behind it is left out
        first = BEHIND * lead(motion, pulse)
    if any(first < turn.t < pulse.t_end for turn in motion.turns):
        raise StudyError("The hoop turns round in its pulse: there is no limit to predict for that yet.")
    turn = pi + 2 * pi * round(((pulse.phi_start + pulse.phi_end) / 2 - pi) / (2 * pi))
    stretches: list[Stretch] = []
    events: list[Event] = []
    inside = [p for p in motion.phases if p.t_end > first and p.t_start < pulse.t_end]
    pulls = {Kind.ROLL: None, Kind.SPIN: scene.friction.mu, Kind.SKID: -scene.friction.mu}
    for number, phase in enumerate(inside):
        if phase.kind not in pulls:
            article = "an" if phase.kind.value[0] in "aeiou" else "a"
            raise StudyError(
                f"The pulse has {article} {phase.kind.value} in it: there is no inner problem for that yet."
            )
        t = max(phase.t_start, first)
        omega, psi = _state(motion, t, turn)[:2]
        if omega == 0:
            raise StudyError("The hoop is at rest where the pulse begins: there is no limit to predict from there.")
        psi_end = (phase.phi_end if phase.t_end <= pulse.t_end else pulse.phi_end) - turn
        if number > 0:
            psi = phase.phi_start - turn
            before, behind = stretches[-1].pull, pulls[phase.kind]
            kind = START if before is None else STOP if behind is None else REVERSAL
            events.append(Event(kind, phase.t_start / scene.time_unit, psi, omega, before, behind, turn))
        stretches.append(Stretch(psi, psi_end, omega, pulls[phase.kind]))
    ends = [_state(motion, t, turn) for t in (first, pulse.t_start, pulse.t_end)]
    return Passage(
        tended, body_of(scene.hoop), scaled_contact(scene), pulse, ends[0][1], tuple(stretches), tuple(events),
        (pulse.phi_start - turn, pulse.phi_end - turn), (ends[1][2], ends[2][2]), ends[0][2],
    )  # fmt: skip


def _state(motion: Motion, t: float, turn: float) -> tuple[float, float, float]:
    """(phidot, psi, slip velocity) of the rigid motion at a time, dimensionless."""
    now = without_units(motion.at(t), motion.scene)
    return float(now.omega), float(now.phi) - turn, float(now.slip_velocity)
