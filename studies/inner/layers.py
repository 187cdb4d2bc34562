"""The layer at an event: its inner problem solved, and what is read off its history."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from math import log, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import Patience
from rigid.kernel.interrupts import between_calls
from rigid.kernel.store import is_cold

from ..running.files import StudyError
from .creep import creep, half_width, sticking_part
from .events import START, Event
from .march.body import Body, accelerations, contact_mobility, rolling_forces, sliding_force
from .march.bristles import SIZE, Bristles, bristles, set_stretch
from .march.equations import (
    BRUSH,
    HEIGHT,
    OMEGA,
    PATCH,
    PSI,
    RATE,
    REGULARISED,
    SLIDE_LEFT,
    SLIDE_RIGHT,
    SLIP,
    STATE,
    STICK,
    ScaledContact,
    System,
)  # fmt: skip
from .march.run import COLUMNS, march

Array = NDArray[np.float64]

FINENESS = 0.1  # of the fastest time to a step: forces to 1e-4, times of switches to 1e-5
#: some 3 s of interpreted steps where the march is not compiled yet
_patience = Patience(is_ready=lambda: not is_cold(march.__module__), load=0, compiling=60_000)
MOST = 1_000_000  # steps of a layer: some 1 s
TOO_LONG = "it lasts far longer than the fastest in it takes"
_POINTS = 300  # of a brush to its patch
_CARRIED = 1 - 1e-8  # of mu N, by a smoothed law whose slip starts: all of it is carried by no finite V
_FULL = 2.0  # times the creep at which a brush rolls with all of mu_s N: of so fast a slip no point sticks
_FAR = 10.0  # times V_s: smoothed friction lacks half the square of its inverse of mu N there, which is known to 1e-4
_AHEAD = 100.0  # of a layer's duration, for which its slip is looked at before it or behind at most
_CARRYING = 0.2  # of N: a patch whose springs lack no more of it creeps as one that has come to rest, but for some 10 %
_RELEASED = 0.95  # of the part that sticks at the most a brush carries, where its running away begins


class TooLongError(StudyError):
    """Something in it is so fast that steps do not come to the end of what is followed."""


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """The history of an inner problem, in the scaled units of R = g = M = 1."""

    event: Event
    law: int
    theta: float
    """Relaxation time of the damper."""
    tau: Array
    normal_force: Array
    friction_force: Array
    slip: Array
    """V = v/eps."""
    height: Array
    """H = h/eps^2."""
    mode: Array
    switches: tuple[tuple[float, int], ...]
    """(tau, mode) of every change of what the patch does."""
    end: Array
    """State at the end, see :mod:`studies.inner.march.equations`."""
    period: float
    """Of the patch's approach, linearised where the layer tends."""

    @property
    def peak_ratio(self) -> float:
        """Largest |F|/N."""
        touching = self.normal_force > 1e-9 * self.normal_force.max()
        return float((np.abs(self.friction_force[touching]) / self.normal_force[touching]).max())

    @property
    def resticks(self) -> float | None:
        """tau from which on the patch sticks for good; None if it slides at the end, or has no stick, or breaks away on
        a longer clock than this one, as a brush with mu_s > mu does."""
        if self.law == REGULARISED or self.mode[-1] != STICK:
            return None
        slides = np.flatnonzero(self.mode != STICK)
        if not slides.size:
            return None if self.event.kind == START else 0.0
        return float(self.tau[slides[-1] + 1])

    def settled(self, normal: float, share: float = 0.02) -> float | None:
        """tau from which on N is within a ``share`` of the force it tends to, and its springs carry most of that.

        None if N is not there by the end. A strong damper takes N there at once, and leaves it to the springs as slowly
        as exp(-tau/theta), since N = N_el + theta N_el': beyond the history's end, too.
        """
        off = np.flatnonzero(np.abs(self.normal_force - normal) > share * normal)
        if off.size and off[-1] + 1 == self.tau.size:
            return None
        settled = float(self.tau[off[-1] + 1]) if off.size else 0.0
        lacking = np.abs(2 / 3 * np.maximum(-2 * self.height, 0.0) ** 1.5 / normal - 1) / _CARRYING
        late = np.flatnonzero(lacking > 1)
        if late.size and late[-1] + 1 == self.tau.size:
            return float(self.tau[-1]) + self.theta * log(lacking[-1])
        return max(settled, float(self.tau[late[-1] + 1])) if late.size else settled

    @property
    def faithful(self) -> bool:
        """Whether the patch does what the rigid hoop does, and nothing in between."""
        wanted = STICK if self.event.behind is None else SLIDE_RIGHT if self.event.behind > 0 else SLIDE_LEFT
        first = wanted if self.event.kind == START else STICK
        sequence = [first, *(mode for _, mode in self.switches)]
        return sequence == ([wanted] if first == wanted else [first, wanted]) and bool((self.normal_force > 0).all())


def outer_forces(body: Body, event: Event, behind: bool) -> tuple[float, float]:
    """(N, F) of the rigid hoop before or behind an event."""
    pull = event.behind if behind else event.before
    if pull is None:
        return rolling_forces(body, event.psi, event.omega)[:2]
    normal = sliding_force(body, event.psi, event.omega, pull)
    return normal, pull * normal


def period_of(body: Body, event: Event) -> float:
    """Of small vibrations of the patch in height under the forces behind an event: omega^2 = 2 A d(ddot h)/dN."""
    normal, friction = outer_forces(body, event, True)
    by_normal, across, _ = contact_mobility(body, event.psi)
    pull = 0.0 if event.behind is None else event.behind
    return 2 * pi / sqrt(2 * half_width(normal) * (by_normal + pull * across))


def layer(
    body: Body,
    contact: ScaledContact,
    event: Event,
    duration: float | None = None,
    *,
    fineness: float = FINENESS,
    eps: float = 0.0,
) -> Layer:
    """Solve the inner problem of an event.

    It begins with all of mu N: under laws that lose some of it to a slip that is slow, a while before the event.

    Parameters
    ----------
    duration : float, optional
        In tau, from the event on; by default ten periods and five passages of a point through the patch, and until a
        smoothed friction is all there again where the slip goes on.
    fineness : float
        Step over the fastest time at work.
    eps : float
        0 is the inner problem; otherwise angle and phidot go on, as at that stiffness.
    """
    normal, friction = outer_forces(body, event, False)
    half = half_width(normal)
    period = period_of(body, event)
    slow = 0.0 if event.kind == START else slow_slip(contact, half, event.omega)
    if duration is None:
        duration = 10 * period + 10 * half / abs(event.omega)
        if contact.law == REGULARISED and event.behind is not None and slow > 0:
            duration += min(slow / abs(_quickening(body, event, True)), _AHEAD * duration)
    too_many = f"The layer at phi = {event.phi:.4g} takes more than {MOST:g} steps: {TOO_LONG}."
    state = np.zeros(STATE)
    state[PSI], state[OMEGA], state[HEIGHT] = event.psi, event.omega, -(half**2) / 2
    kept = bristles(2 * half / _POINTS)
    mode, ahead = STICK, 0.0
    if event.kind == START:
        if contact.law == REGULARISED:
            friction = float(np.clip(friction, *(_CARRIED * contact.mu * normal * np.array([-1, 1]))))
        state[SLIP] = creep(contact, normal, friction, event.omega).slip
        if contact.law == PATCH:
            mode = SLIDE_RIGHT if (event.behind or 0.0) > 0 else SLIDE_LEFT
    elif slow > 0:
        rate = _quickening(body, event, False)
        ahead = min(slow / abs(rate), _AHEAD * duration)
        state[SLIP] = -rate * ahead
    if contact.law != REGULARISED:
        pull = float(np.sign(friction)) * contact.mu
        most = pull / contact.kappa
        set_stretch(kept, half, np.array([-most * half**2 / 2, 0.0, most / 2]), contact.law == BRUSH)
        kept.sliding[:] = np.sign(friction)
    if contact.law == BRUSH and event.kind == START and contact.mu_s > contact.mu:
        _break_away(contact, event, half, normal, friction, kept)
    ends = np.array([ahead + duration, np.inf * np.sign(event.omega), fineness, 1.0, MOST])
    records, switches, end, done = _marched(System(body, contact, eps), state, mode, kept, ends)
    if not done:
        raise TooLongError(too_many)
    records[:, 0] -= ahead
    columns = dict(zip(COLUMNS, records.T, strict=True))
    return Layer(
        event=event,
        law=contact.law,
        theta=contact.theta,
        **{name: columns[name] for name in ("tau", "normal_force", "friction_force", "slip", "height")},
        mode=columns["mode"].astype(int),
        switches=tuple((float(t) - ahead, int(m)) for t, m in switches),
        end=end,
        period=period,
    )


def slow_slip(contact: ScaledContact, half: float, omega: float) -> float:
    """|V| above which friction is mu N or next to it, in a patch of half-width ``half``; 0 of one that slides whole."""
    if contact.law == BRUSH:
        return _FULL * contact.mu_s * half * abs(omega) / contact.kappa
    return _FAR * contact.slip_scale if contact.law == REGULARISED else 0.0


def _quickening(body: Body, event: Event, behind: bool) -> float:
    """dot v of the slip before or behind an event."""
    return accelerations(*body, event.psi, event.omega, *outer_forces(body, event, behind))[2]


def _lacking(body: Body, contact: ScaledContact, event: Event, slip: float, behind: bool) -> float:
    """What V still gains, or has gained, on the far side of ``slip`` by what a smoothed friction lacks of mu N there.

    That is mu N V_s^2/(2 V^2), of a V that grows evenly, and it changes N too.
    """
    pull = event.behind if behind else event.before
    if contact.law != REGULARISED or pull is None:
        return 0.0
    step = 1e-6 * contact.mu
    rates = []
    for each in (pull + step, pull - step):
        normal = sliding_force(body, event.psi, event.omega, each)
        rates.append(accelerations(*body, event.psi, event.omega, normal, each * normal)[2])
    by_pull = (rates[0] - rates[1]) / (2 * step)
    lacks = -by_pull * pull * contact.slip_scale**2 / 2
    return lacks / (abs(_quickening(body, event, behind)) * abs(slip))


def _marched(system: System, state: Array, mode: int, kept: Bristles, ends: Array) -> Any:
    """:func:`.march.run.march`; by the interpreter, to the same numbers, as long as compiling takes longer."""
    if system.contact.law == BRUSH or (left := _patience.left()) <= 0:
        return _compiled(system, state, mode, kept, ends)
    by_python: Any = march
    room, short = deepcopy(kept), np.append(ends[:-1], left)
    with np.errstate(all="ignore"):
        found = by_python.py_func(system, state, mode, room, short)
    _patience.spend(steps=len(found[0]))
    return found if found[-1] else _compiled(system, state, mode, kept, ends)


def _compiled(*given: Any) -> Any:
    with between_calls():
        return march(*given)


def _break_away(
    contact: ScaledContact, event: Event, half: float, normal: float, friction: float, kept: Bristles
) -> None:
    """A brush that has just begun to break: its leading part sticks in steady rolling, and slides behind that.

    It runs away more slowly than a layer lasts (:func:`studies.limit.onset.brush_delay`): what is seen here is how near
    to it the roll stays.
    """
    part = sticking_part(contact.mu_s, contact.mu, abs(friction) / normal)
    slip = creep(contact, normal, friction, event.omega).slip
    low, high = kept.ends
    for j in range(low, high + 1):
        way = half + np.sign(event.omega) * j * kept.spacing
        if way < _RELEASED * part * 2 * half:
            kept.way[j % SIZE], kept.sliding[j % SIZE] = slip * way / abs(event.omega), 0


def slip_behind(body: Body, contact: ScaledContact, event: Event) -> float:
    """The V with which the outer motion begins behind an event.

    Where the patch comes to roll it is the creep. Where it slides it is V less what the outer sliding makes of it, and
    less what is still to come of the vibration of N, whose impulse is that of the height's rate. What a smoothed
    friction lacks of mu N beyond both ends of the layer's history is added.
    """
    if event.behind is None:
        return creep(contact, *outer_forces(body, event, True), event.omega).slip
    history = layer(body, contact, event)
    by_normal, across, by_friction = contact_mobility(body, event.psi)
    # of V and of H', by an N that brings F along
    share = (across + event.behind * by_friction) / (by_normal + event.behind * across)
    before, steady = _quickening(body, event, False), _quickening(body, event, True)
    read = history.end[SLIP] - steady * history.tau[-1] - share * history.end[RATE]
    # what is slower before the event comes to it earlier or later
    lacked = _lacking(body, contact, event, history.slip[0], False) * steady / before
    return float(read + lacked + _lacking(body, contact, event, history.end[SLIP], True))
