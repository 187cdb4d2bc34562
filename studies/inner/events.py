"""The events of the rigid motion in and before a pulse, each with the state that its inner problem starts from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import copysign, pi
from typing import NamedTuple

from scipy.optimize import brentq

from flexible import rigid_limit
from flexible.contact.laws.listing import LAWS
from flexible.run.pulses import BEHIND, lead
from rigid import Kind, Motion, Phase, Pulse, Release, Run, Scene, simulate
from rigid.output.units import without_units

from ..running.files import StudyError
from .march.body import Body, arms, body_of
from .march.equations import BRUSH, PATCH, REGULARISED, ScaledContact
from .scales import epsilon, theta_of

START, STOP, REVERSAL, BREAK = "slip starts", "slip stops", "slip reverses", "slip stops, stick breaks"
"""The last is a stop of the rigid hoop behind which a compliant one slides on: its layer ends so."""

_LONGEST = 20.0  # paper's pulses: a hoop that slides on in one has come to its end within so many, or never does
_ROUND_OFF = 1e-12  # of the times at which a phase and a pulse begin or end together


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

    @property
    def stop(self) -> Event:
        """What the rigid hoop of the contact law does here: of a stick that breaks, the stop."""
        return replace(self, kind=STOP, behind=None) if self.kind == BREAK else self


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
    """That of ``scene``; where a stick breaks in it, impulses and friction loss are those of the hoop that slides on
    there, between the same angles."""
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
    last: Event | None = None
    """The event with which the pulse ends; None where N falls below the weight without one."""


def scaled_contact(scene: Scene, damping: float | None = None) -> ScaledContact:
    """The contact of a scene in the scaled problem."""
    contact, friction = scene.contact, scene.friction
    code = LAWS[contact.law].code
    if code not in (PATCH, BRUSH, REGULARISED):
        raise StudyError(f"The {contact.law} law has no scaled form yet, so its limit is not known.")
    scale, theta = contact.slip_velocity_scale / epsilon(scene), theta_of(scene, damping)
    return ScaledContact(code, contact.tangential_ratio, friction.mu_s, friction.mu, theta, scale)


class _Part(NamedTuple):
    """A phase of a motion that begins at ``since`` on the clock of the first."""

    motion: Motion
    phase: Phase
    since: float


def passage(scene: Scene, rolls_to: float | None = None, breaks: Sequence[int] = ()) -> Passage:
    """The first pulse of a scene.

    Parameters
    ----------
    scene : Scene
        What is asked.
    rolls_to : float, optional
        Share of mu N up to which the rolling before the pulse is left out, that of the law's by default; 1 leaves out
        all that is more than half a pulse before.
    breaks : sequence of int, optional
        Which events, ascending, are stops behind which the hoop slides on: see
        :func:`studies.inner.stops.hanging.followed`.

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
    parts = [_Part(motion, p, 0.0) for p in motion.phases if p.t_end > first and p.t_start < pulse.t_end]
    for number in breaks:
        parts = _slid_on(tended, parts, number, pulse)
    stretches, events = _walked(tended, parts, first, pulse, turn, breaks)
    start = _state(motion, first, turn)
    last, t_end = parts[-1], pulse.t_end
    before, t_start = parts[0], pulse.t_start
    if breaks:
        way = copysign(1.0, pulse.phi_end - pulse.phi_start)
        # a stick may break before the pulse begins
        before = [p for p in parts if (p.phase.phi_start - pulse.phi_start) * way < 0 or p is before][-1]
        t_start = t_start if before.motion is motion else _reaches(before, pulse.phi_start)
        t_end = _reaches(last, pulse.phi_end)
    ends = _state(before.motion, t_start, turn), _state(last.motion, t_end, turn)
    if breaks:
        pulse = _of_ends(tended, pulse, (before, t_start), (last, t_end), ends)
    return Passage(
        tended, body_of(scene.hoop), scaled_contact(scene), pulse, start[1], stretches, events,
        (pulse.phi_start - turn, pulse.phi_end - turn), (ends[0][2], ends[1][2]), start[2],
        None if breaks else _last(tended, pulse, stretches[-1].pull, turn),
    )  # fmt: skip


def _pulls(scene: Scene) -> dict[Kind, float | None]:
    """F/N of the phases that have an inner problem at their ends; None where F is what rolling takes."""
    return {Kind.ROLL: None, Kind.SPIN: scene.friction.mu, Kind.SKID: -scene.friction.mu}


def _kind(before: float | None, behind: float | None) -> str:
    return START if before is None else STOP if behind is None else REVERSAL


def _last(scene: Scene, pulse: Pulse, before: float | None, turn: float) -> Event | None:
    """The event at the end of a pulse, if it ends with one: a phase of the motion beyond it begins just there."""
    pulls, t = _pulls(scene), pulse.t_end
    beyond = simulate(scene.replace(run=Run(t_end=t + (t - pulse.t_start))))
    for phase in beyond.phases:
        if abs(phase.t_start - t) <= _ROUND_OFF * (1 + abs(t)) and phase.kind in pulls and pulls[phase.kind] != before:
            omega, psi = _state(beyond, t, turn)[:2]
            behind = pulls[phase.kind]
            return Event(_kind(before, behind), t / scene.time_unit, psi, omega, before, behind, turn)
    return None


def _walked(
    scene: Scene, parts: Sequence[_Part], first: float, pulse: Pulse, turn: float, breaks: Sequence[int]
) -> tuple[tuple[Stretch, ...], tuple[Event, ...]]:
    """The stretches of a motion that is put together of parts, and the events between them."""
    stretches: list[Stretch] = []
    events: list[Event] = []
    pulls = _pulls(scene)
    for number, (motion, phase, since) in enumerate(parts):
        if phase.kind not in pulls:
            article = "an" if phase.kind.value[0] in "aeiou" else "a"
            raise StudyError(
                f"The pulse has {article} {phase.kind.value} in it: there is no inner problem for that yet."
            )
        t = max(phase.t_start, first) if number == 0 else phase.t_start
        omega, psi = _state(motion, t, turn)[:2]
        if omega == 0:
            raise StudyError("The hoop is at rest where the pulse begins: there is no limit to predict from there.")
        psi_end = (phase.phi_end if number + 1 < len(parts) else pulse.phi_end) - turn
        if number > 0:
            psi = phase.phi_start - turn
            before, behind = stretches[-1].pull, pulls[phase.kind]
            kind = BREAK if number - 1 in breaks else _kind(before, behind)
            t = (since + phase.t_start) / scene.time_unit
            events.append(Event(kind, t, psi, omega, before, behind, turn))
        stretches.append(Stretch(psi, psi_end, omega, pulls[phase.kind]))
    return tuple(stretches), tuple(events)


def _slid_on(scene: Scene, parts: Sequence[_Part], number: int, pulse: Pulse) -> list[_Part]:
    """The same motion up to an event, a stop; behind it mu N is all that acts until the slip comes to its end again."""
    motion, roll, since = parts[number + 1]
    found = list(parts[: number + 1])
    way, t = copysign(1.0, pulse.phi_end - pulse.phi_start), roll.t_start
    for hoop in (scene.replace(friction={"mu_s": scene.friction.mu}), scene):
        here = motion.at(t)
        begun = Release(float(here.phi), float(here.omega), 0.0)
        left = Run(t_end=_LONGEST * (pulse.t_end - pulse.t_start))
        motion, since = simulate(hoop.replace(release=begun, run=left)), since + t
        for phase in motion.phases[:1] if hoop is not scene else motion.phases:
            found.append(_Part(motion, phase, since))
            t = _until(found[-1])
            if (float(motion.at(t).phi) - pulse.phi_end) * way >= 0:
                return found
            if t < phase.t_end:
                raise StudyError(
                    "The hoop that slides on turns round in its pulse: there is no limit to predict for that yet."
                )
    raise StudyError("The hoop that slides on does not come to the end of its pulse: there is no limit to predict.")


def _until(part: _Part) -> float:
    """When a part ends, or the hoop turns round in it."""
    return min([part.phase.t_end, *(turn.t for turn in part.motion.turns if turn.t > part.phase.t_start)])


def _reaches(part: _Part, phi: float) -> float:
    """When a part comes to an angle in it, on the clock of its motion."""
    span = part.phase.t_start, _until(part)
    return float(brentq(lambda t: float(part.motion.at(t).phi) - phi, *span, xtol=1e-15 * (1 + span[1])))


def _of_ends(
    scene: Scene,
    pulse: Pulse,
    begins: tuple[_Part, float],
    ends: tuple[_Part, float],
    states: Sequence[tuple[float, float, float]],
) -> Pulse:
    """The pulse of a motion between two states: impulses are those of the mass centre, M v_x and M (v_y + g t)."""
    body = body_of(scene.hoop)
    momenta = []
    for (part, t), (omega, psi, slip) in zip((begins, ends), states, strict=True):
        a, b, _ = arms(body.e, body.one_minus_e, psi)
        momenta.append((slip + b * omega, (t + part.since) / scene.time_unit - a * omega))
    unit = (1 + scene.hoop.mass_ratio) * scene.impulse_unit
    energies = [float(part.motion.at(t).energy) for part, t in (begins, ends)]
    return replace(
        pulse,
        t_start=begins[1] + begins[0].since,
        t_end=ends[1] + ends[0].since,
        friction_impulse=(momenta[1][0] - momenta[0][0]) * unit,
        normal_impulse=(momenta[1][1] - momenta[0][1]) * unit,
        friction_loss=energies[0] - energies[1],
    )


def _state(motion: Motion, t: float, turn: float) -> tuple[float, float, float]:
    """(phidot, psi, slip velocity) of the rigid motion at a time, dimensionless."""
    now = without_units(motion.at(t), motion.scene)
    return float(now.omega), float(now.phi) - turn, float(now.slip_velocity)
