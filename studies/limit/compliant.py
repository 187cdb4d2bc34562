"""A rigid ring on a compliant floor through a whole pulse: the scaled equations at a finite eps.

Nothing is predicted here; it is what predictions, and the flexible solver at great stiffness, can be held to, at any
stiffness for the price of some hundred thousand steps.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import copysign, inf, nan, sqrt
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from flexible.contact.laws.listing import LAWS
from rigid import Scene
from rigid.kernel.interrupts import between_calls

from ..inner.creep import creep, half_width
from ..inner.events import Passage, passage
from ..inner.layers import TOO_LONG, TooLongError
from ..inner.march.body import accelerations, rolling_forces, sliding_force
from ..inner.march.bristles import SIZE, bristles, set_stretch
from ..inner.march.equations import (
    BRUSH,
    FRICTION_IMPULSE,
    FRICTION_WORK,
    HEIGHT,
    NORMAL_IMPULSE,
    OMEGA,
    PATCH,
    PSI,
    REGULARISED,
    SLIDE_LEFT,
    SLIDE_RIGHT,
    SLIP,
    STATE,
    STICK,
    System,
)  # fmt: skip
from ..inner.march.run import march
from ..inner.scales import epsilon
from ..running.case import Case
from ..running.files import StudyError
from ..running.runs import run_cases
from ..running.workers import Pool

_POINTS = 64  # of a brush to its patch where the pulse begins; at its peak there are several times as many
_SPARSE = 1e9  # steps to a record: none but those at events
_MOST = 3e7  # steps, some 25 s
_SEEN = 1e-7  # of a measure: what a rigid ring's own steps leave of it
_ALIKE = 2.0  # times what is predicted, or its inverse: beyond that other terms are as large as those predicted
_TOO_MANY = f"This pulse takes a rigid ring more than {_MOST:g} steps: {TOO_LONG}."


@dataclass(frozen=True, slots=True)
class Passed:
    """Measures of a pulse, in the units of the scene."""

    normal_impulse: float
    friction_impulse: float
    loss: float
    """To friction and damper together."""
    slips: int
    """How often the patch broke or stuck."""

    @property
    def impulse_ratio(self) -> float:
        """J_F/J_N."""
        return self.friction_impulse / self.normal_impulse


def go_through(scene: Scene, fineness: float = 0.1) -> Passed:
    """The first pulse of a scene at its own foundation, from the state at which the flexible hoop is handed over."""
    way, eps = passage(scene, 1.0), epsilon(scene)
    if way.contact.law == REGULARISED:
        whole = passage(scene)
        if (way.start - whole.start) * whole.stretches[0].omega > 0:
            way = _slipped_before(way, whole, eps)
    gained, switches = march_through(way, eps, fineness)
    gained = gained * (1 + scene.hoop.mass_ratio)
    return Passed(
        float(gained[NORMAL_IMPULSE] * eps * scene.impulse_unit),
        float(gained[FRICTION_IMPULSE] * eps * scene.impulse_unit),
        float(-gained[FRICTION_WORK] * eps**2 * scene.energy_unit),
        switches,
    )


def _slipped_before(way: Passage, whole: Passage, eps: float) -> Passage:
    """``way``, as smoothed friction brings the hoop to its start from that of the ``whole``, where it rolls or slips.

    On the way the floor might as well be rigid, and steps would be many.
    """
    first, body = whole.stretches[0], way.body
    onward, v_s = copysign(1.0, first.omega), way.contact.slip_scale * eps

    def rates(psi: float, y: Any) -> list[float]:
        omega = onward * sqrt(y[0]) if y[0] > 0 else nan
        pull = -way.contact.mu * y[1] / sqrt(y[1] ** 2 + v_s**2)
        normal = sliding_force(body, psi, omega, pull)
        alpha, _, slipping = accelerations(*body, psi, omega, normal, pull * normal)
        return [2 * alpha, slipping / omega]

    slip = whole.first_slip
    if first.pull is None:
        slip = eps * creep(whole.contact, *rolling_forces(body, first.psi_start, first.omega)[:2], first.omega).slip
    span = (whole.start, way.start)
    w, slip = solve_ivp(rates, span, [first.omega**2, slip], "LSODA", rtol=1e-9, atol=1e-12).y[:, -1]
    begins = replace(way.stretches[0], omega=onward * sqrt(w), pull=-way.contact.mu * slip / sqrt(slip**2 + v_s**2))
    return replace(way, first_slip=float(slip), stretches=(begins, *way.stretches[1:]))


def march_through(way: Passage, eps: float, fineness: float = 0.1) -> tuple[np.ndarray, int]:
    """What the state of the march gains over a pulse (R = g = M = 1, scaled), and how often it breaks or sticks."""
    state, mode, kept = _start(way, eps)
    switches, before = 0, np.zeros(STATE)
    for psi in way.edges:
        if psi != way.start:
            ends = np.array([np.inf, psi, fineness, _SPARSE, _MOST])
            with between_calls():
                records, turned, state, done = march(System(way.body, way.contact, eps), state, mode, kept, ends)
            if not done:
                raise TooLongError(_TOO_MANY)
            mode = int(records[-1, 5])
            switches = len(turned)
        if psi == way.edges[0]:
            before = state
    return state - before, switches


def _start(way: Passage, eps: float) -> tuple[np.ndarray, int, object]:
    """State, mode and bristles at the hand-over: the forces of the rigid hoop, at rest in the patch."""
    first = way.stretches[0]
    if first.pull is None:
        normal, friction, _ = rolling_forces(way.body, first.psi_start, first.omega)
    else:
        normal = sliding_force(way.body, first.psi_start, first.omega, first.pull)
        friction = first.pull * normal
    half = half_width(normal)
    state = np.zeros(STATE)
    state[PSI], state[OMEGA], state[HEIGHT] = first.psi_start, first.omega, -(half**2) / 2
    brush = way.contact.law == BRUSH
    widest = half_width(2 * max(way.pulse.peak_normal_force / way.scene.force_unit, normal))  # N rings about its peak
    if brush and _POINTS * widest / half > SIZE:
        raise StudyError("The force of this pulse grows too much for the points of a brush to follow it.")
    kept = bristles(2 * half / _POINTS)
    mode = STICK
    if first.pull is None:
        slip = creep(way.contact, normal, friction, first.omega).slip
        curve = np.array([slip * half / abs(first.omega), slip / first.omega, 0.0])
    else:
        slip = way.first_slip / eps
        curve = np.array([-(half**2) / 2, 0.0, 0.5]) * first.pull / way.contact.kappa
        if way.contact.law == PATCH:
            mode = SLIDE_RIGHT if first.pull > 0 else SLIDE_LEFT
        kept.sliding[:] = np.sign(first.pull)
    state[SLIP] = slip
    set_stretch(kept, half, curve, brush)
    return state, mode, kept


def at_foundation(scene: Scene, foundation: float) -> Scene:
    """The scene at another foundation; its ring, and what its law ties to the foundation, go with it."""
    factor = foundation / scene.contact.stiffness
    tied = LAWS[scene.contact.law].stiffened(scene.contact, factor)
    ring = {"bending_stiffness": scene.ring.bending_stiffness * factor}
    return scene.replace(contact={"stiffness": foundation, **tied}, ring=ring)


@dataclass(frozen=True, slots=True)
class Sight:
    """A pulse observed at a finite stiffness."""

    solver: str
    """Who saw it: "rigid ring" or "flexible"."""
    foundation: float
    """eps_n R^2/(m g)."""
    values: dict[str, float]
    """Measures."""
    errors: dict[str, float]
    """Their numerical errors, where the solver knows them."""
    failure: str = ""
    """Why there are none."""


def times_off(sight: Sight, distances: dict[str, tuple[float, float]]) -> dict[str, float]:
    """Observed over predicted distance from the limit, of the measures where that is no number from 1/2 to 2.

    What is below the errors of a run is not told; nor is what nothing is predicted of.
    """
    off = {}
    for name, (found, foreseen) in distances.items():
        error = max(sight.errors.get(name, 0.0), _SEEN * abs(sight.values[name]))
        if foreseen and abs(found - foreseen) > error and not 1 / _ALIKE <= found / foreseen <= _ALIKE:
            off[name] = found / foreseen
    return off


def seen_by_rigid_ring(scene: Scene, foundation: float) -> Sight:
    """A scene's pulse at a foundation, of a rigid ring; or why it cannot be followed there."""
    try:
        seen = go_through(at_foundation(scene, foundation))
    except TooLongError as error:
        return Sight("rigid ring", foundation, {}, {}, str(error))
    values = {
        "impulse_ratio": seen.impulse_ratio,
        "friction_impulse": seen.friction_impulse,
        "normal_impulse": seen.normal_impulse,
    }
    return Sight("rigid ring", foundation, values, {})


def seen_by_rigid_rings(scene: Scene, foundations: Sequence[float]) -> list[Sight]:
    """The same at several; what takes too many steps takes more of them on a stiffer one, where it is not tried."""
    failed, seen = Sight("rigid ring", inf, {}, {}), dict[float, Sight]()
    for foundation in sorted(foundations):
        if failed.failure:
            seen[foundation] = replace(failed, foundation=foundation)
            continue
        seen[foundation] = seen_by_rigid_ring(scene, foundation)
        failed = seen[foundation]
    return [seen[foundation] for foundation in foundations]


def seen_by_flexible(
    scene: Scene,
    limits: Mapping[str, float],
    foundations: Sequence[float],
    pool: Pool,
    out: Any,
    progress: Callable[[float], None] | None,
) -> list[Sight]:
    """What the flexible solver sees of the ``limits`` and of what goes with them, its errors held against them."""
    if not foundations:
        return []
    against = tuple((name, limits[name], 0.0) for name in ("impulse_ratio", "friction_loss"))
    cases = [Case("flexible", at_foundation(scene, foundation), against) for foundation in foundations]
    sights = []
    for foundation, outcome in zip(foundations, run_cases(cases, pool, out, progress), strict=True):
        if outcome.failure:
            sights.append(Sight("flexible", foundation, {}, {}, outcome.failure))
            continue
        values = {name: outcome.pulses[0][name] for name in limits}
        sights.append(Sight("flexible", foundation, values, {n: outcome.numerical_error[0][n] for n in limits}))
    return sights
