"""What must hold for any scene. Every check gives a margin: the violation over what round-off or rtol allows, so that
1 is the edge and less is fine.
"""

from __future__ import annotations

import dataclasses
import json
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from itertools import pairwise
from math import inf, isfinite, isnan
from typing import Any, NamedTuple

import numpy as np

from rigid import Kind, Motion, Release, Scene, scene_to_dict, simulate
from rigid.output.units import in_units

Margins = dict[str, float]


class Checked(NamedTuple):
    """What the checks of a scene found."""

    margins: Margins
    ended: str
    completed: bool = True
    cut: bool = False


METRE, KILOGRAM, GRAVITY = 0.3, 0.7, 9.81  # any units that are no powers of two
MOST_GROWTH = 1e6  # of a change of the release: each hop multiplies it, and after many a motion does not repeat
RESOLVED = 1e-9
ENERGY = 1e-10  # growth that is round-off, of the energy at release
NO = 1e9  # the margin of what is plainly wrong


def toml(scene: Scene) -> str:
    """The scene's file."""
    lines = []
    for part, table in scene_to_dict(scene).items():
        lines.append(f"[{part}]")
        lines += [f"{key} = {json.dumps(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"


def mirrored(scene: Scene) -> Scene:
    """phi -> -phi."""
    release = scene.release
    return scene.replace(release=Release(-release.phi0, -release.omega0, -release.slip0))


def in_si(scene: Scene) -> Scene:
    """The same scene in metres, kilograms, seconds."""
    si = scene.replace(hoop={"R": METRE, "m": KILOGRAM, "g": GRAVITY})
    return si.replace(release=in_units(scene.release, si), run=in_units(scene.run, si))


def flights(motion: Motion) -> int:
    """How often the hoop is off the floor."""
    return sum(phase.kind == Kind.FLIGHT for phase in motion.phases)


def numbers(motion: Motion) -> Iterator[float]:
    """Every number a motion lists."""
    for phase in motion.phases:
        yield from (phase.t_start, phase.t_end, phase.phi_start, phase.phi_end)
    for turn in motion.turns:
        yield from (turn.t, turn.phi, turn.slip_velocity, turn.energy)
    impacts = [phase.t_start for phase in motion.phases if phase.kind == Kind.IMPACT]
    for pulse in motion.pulses:
        values = pulse.to_dict()
        if bisect_left(impacts, pulse.t_start) < bisect_right(impacts, pulse.t_end):
            del values["peak_normal_force"]  # a jam knows none, at the start of a pulse too
        if pulse.cut:  # what is split at the bottom is unknown
            values = {name: value for name, value in values.items() if "restitution" not in name}
        yield from (value for value in values.values() if isinstance(value, float))


def listed(motion: Motion) -> Margins:
    """Finite, in order, joined without gaps."""
    # a march that cannot take its first step says so, and has nothing to list
    told = bool(motion.phases) or not motion.completed
    fine = all(map(isfinite, numbers(motion))) and bool(motion.ended) and told
    jumps = [abs(b.phi_start - a.phi_end) / max(1.0, abs(a.phi_end)) for a, b in pairwise(motion.phases)]
    ordered = all(a.t_start <= a.t_end == b.t_start for a, b in pairwise(motion.phases))
    return {
        "finite": 0.0 if fine else NO,
        "in order": 0.0 if ordered else NO,
        "angle joined": max(jumps, default=0.0) / 1e-9,
    }


def gained(motion: Motion) -> Margins:
    """No pulse of a rigid hoop gives energy back."""
    scale = max(motion.scene.energy_unit, abs(float(motion.at(0.0).energy)))
    return {"gained in a pulse": max((-p.friction_loss for p in motion.pulses), default=0.0) / scale / ENERGY}


def instants(motion: Motion, count: int = 60) -> np.ndarray:
    """Times evenly over the motion and within its first phases.

    None within a phase of less than a billionth of the time that has passed: phidot ~ 1/k makes phases of a few last
    digits of t, and no instant within them can be told.
    """
    lasting = [p for p in motion.phases if p.t_end - p.t_start > RESOLVED * max(1.0, p.t_end)]
    even = np.linspace(0, motion.t_end, count)
    inside = [even[(even > p.t_start) & (even < p.t_end)] for p in lasting]
    inside += [np.linspace(p.t_start, p.t_end, 5)[1:-1] for p in lasting[:40]]
    return np.unique(np.concatenate([[0.0], *inside]))


def sampled(motion: Motion) -> Margins:
    """Energy, N >= 0, |F| <= mu_s N, above the floor, at many instants; energy at the turns, which are exact."""
    scene = motion.scene
    states = motion.at(instants(motion))
    table = np.array([getattr(states, field.name) for field in dataclasses.fields(states)])
    if not np.isfinite(table).all():
        return {"finite": NO}
    energy, normal, friction = states.energy, states.normal_force, states.friction_force
    turns = np.array([turn.energy for turn in motion.turns])
    scale = max(1.0, float(np.abs(energy).max()))
    most = max(1.0, float(normal.max()))
    excess = np.abs(friction) - scene.friction.mu_s * normal * (1 + 1e-9)
    growth = max(float(np.diff(values).max(initial=0.0)) for values in (energy, turns))
    return {
        "energy": growth / scale / ENERGY,
        "N >= 0": float(-normal.min()) / most / 1e-10,
        "|F| <= mu_s N": float(excess.max()) / (1e-10 * most),
        "above the floor": float(1 - states.y_C.min()) / 1e-9,
    }


def _turns(motion: Motion) -> np.ndarray:
    return np.array([(t.t, t.phi, t.energy) for t in motion.turns[:2]]).reshape(-1, 3)


def impulses(motion: Motion) -> np.ndarray:
    """J_N and J_F of the first two pulses, (n, 2)."""
    return np.array([(p.normal_impulse, p.friction_impulse) for p in motion.pulses[:2]]).reshape(-1, 2)


def apart(a: np.ndarray, b: np.ndarray) -> float:
    """Largest difference over the largest value, or one; plainly wrong where the shapes differ."""
    if a.shape != b.shape:
        return NO
    return float(np.abs(a - b).max(initial=0.0) / max(1.0, np.abs(a).max(initial=0.0)))


def _changed(motion: Motion, other: Motion) -> float:
    """How far turns and impulses are apart, each over the largest of their own."""
    return max(apart(_turns(motion), _turns(other)), apart(impulses(motion), impulses(other)))


def sensitivity(motion: Motion) -> float:
    """Change of the results per change of the release; infinite where another course is taken or it grows too far.

    What is released at rest or without slip is left so: the least velocity of one sign would come to a turn at once, or
    to a jam, and be another course.
    """
    scene, nudge = motion.scene, 1e-11
    worst = 0.0
    for signs in ((1, 1, 1), (-1, -1, -1), (1, -1, 1), (-1, 1, -1)):
        angle, *rates = (sign * nudge for sign in signs)
        phi0, *moving = dataclasses.astuple(scene.release)
        moved = (value + rate if value else 0.0 for value, rate in zip(moving, rates, strict=True))
        release = Release(phi0 + angle, *moved)
        change = _changed(motion, simulate(scene.replace(release=release)))
        worst = max(worst, inf if change > MOST_GROWTH * nudge else change / nudge)
    return worst


def _margin(motion: Motion, difference: float) -> float | None:
    """``difference`` over what round-off may grow to: by 1/k in a pulse, otherwise by the motion's own sensitivity.

    None where a motion depends on its last digits, so that there is nothing to compare.
    """
    allowed = 1e-8 + 1e-13 / motion.scene.hoop.k
    if difference <= allowed:
        return difference / allowed
    grown = sensitivity(motion)
    return None if grown == inf else difference / (allowed + 1e-12 * grown)


def repeated(motion: Motion) -> Margins:
    """The same answer mirrored, in SI units, and restarted from the middle of a phase."""
    scene = motion.scene
    turns, pushes = _turns(motion), impulses(motion)
    other = simulate(mirrored(scene))
    margins = {
        "mirrored": _margin(
            motion, max(apart(turns, _turns(other) * (1, -1, 1)), apart(pushes, impulses(other) * (1, -1)))
        )
    }
    si = in_si(scene)
    other = simulate(si)
    units = np.array([si.time_unit, 1.0, si.energy_unit])
    margins["in SI units"] = _margin(
        motion, max(apart(turns, _turns(other) / units), apart(pushes, impulses(other) / si.impulse_unit))
    )
    margins["restarted"] = restarted(motion)
    return {name: value for name, value in margins.items() if value is not None}


def restarted(motion: Motion) -> float | None:
    """How far the turns after a restart from the middle of the middle phase are from those that should come."""
    if motion.scene.run.turns is None or len(motion.phases) < 2 or len(motion.turns) < motion.scene.run.turns:
        return None
    phase = motion.phases[len(motion.phases) // 2]
    t = (phase.t_start + phase.t_end) / 2
    later = [turn for turn in motion.turns if turn.t > t + 1e-9][:2]
    on_floor = phase.kind in (Kind.ROLL, Kind.SKID, Kind.SPIN)
    if not on_floor or not later or not phase.t_start < t < phase.t_end:
        return None
    state = motion.at(t)
    release = Release(float(state.phi), float(state.omega), float(state.slip_velocity))
    again = simulate(motion.scene.replace(release=release, run={"turns": len(later)}))
    return _margin(again, apart(np.array([turn.phi for turn in later]), np.array([turn.phi for turn in again.turns])))


def right_hand_side(scene: Scene, mu_hat: float | None) -> Any:
    """d(phi, phidot, slip velocity)/dt, R = g = M = 1; ``mu_hat`` None is rolling, otherwise F = -mu_hat N."""
    e, gyr = scene.hoop.e, scene.hoop.K

    def slope(_: float, y: np.ndarray) -> list[float]:
        omega, s, c = y[1], np.sin(y[0]), np.cos(y[0])
        if mu_hat is None:
            return [omega, e * s * (1 + omega**2) / (1 + e * e + gyr + 2 * e * c), 0.0]
        arm = e * s + mu_hat * (1 + e * c)
        normal = gyr * (1 - e * c * omega**2) / (gyr + e * s * arm)
        alpha = arm * normal / gyr
        return [omega, alpha, -mu_hat * normal + e * s * omega**2 - (1 + e * c) * alpha]

    return slope


def _near_jam(scene: Scene, phi: float, mu_hat: float | None) -> bool:
    """Whether the denominator of slipping has all but vanished: a time integration then takes any time it likes."""
    if mu_hat is None:
        return False
    e, gyr, s = scene.hoop.e, scene.hoop.K, float(np.sin(phi))
    free = gyr + (e * s) ** 2
    return free + mu_hat * e * s * (1 + e * float(np.cos(phi))) < 0.03 * free


def integrated(motion: Motion) -> Margins:
    """Each phase on the floor by DOP853 from its start: it arrives where the closed form does.

    Only where a time integration has digits to tell: k >= 1e-3, and no phase that ends in a jam (peak N < 1e4).
    """
    from scipy.integrate import solve_ivp

    scene = motion.scene
    worst = 0.0
    hats = {Kind.ROLL: None, Kind.SKID: scene.friction.mu, Kind.SPIN: -scene.friction.mu}
    if scene.hoop.k < 1e-3 or any(p.peak_normal_force > 1e4 for p in motion.pulses):
        return {}
    for phase in motion.phases[:12]:
        span = phase.t_end - phase.t_start
        if phase.kind not in hats or not 1e-6 < span < 20:
            continue
        hat = hats[phase.kind]
        end = phase.t_end - 1e-9 * span
        first, last = motion.at(phase.t_start), motion.at(end)
        if max(float(last.normal_force), float(first.normal_force)) > 1e4 or _near_jam(scene, float(last.phi), hat):
            continue
        start = [float(first.phi), float(first.omega), float(first.slip_velocity)]
        slope = right_hand_side(scene, hat)
        theirs, rough = (
            solve_ivp(slope, (phase.t_start, end), start, "DOP853", rtol=rtol, atol=rtol / 10).y[:, -1]
            for rtol in (1e-12, 1e-11)
        )
        ours = np.array([last.phi, last.omega, last.slip_velocity], dtype=float)
        scale = np.maximum(1, np.abs(ours))
        # what the integration itself leaves open, near a jam or on the way from the top
        allowed = 1e-8 + 1e-11 / scene.hoop.k + float((np.abs(theirs - rough) / scale).max())
        worst = max(worst, float((np.abs(theirs - ours) / scale).max()) / allowed)
    return {"integrated in time": worst}


def rigid_margins(scene: Scene, thorough: bool) -> Checked:
    """All checks of a rigid scene, and how it ended."""
    motion = simulate(scene)
    margins = listed(motion)
    if max(margins.values()) <= 1:
        margins |= gained(motion)
        margins |= sampled(motion)
        margins |= repeated(motion)
        if thorough:
            margins |= integrated(motion)
    margins = {name: NO if isnan(value) else max(value, 0.0) for name, value in margins.items()}
    return Checked(margins, motion.ended, motion.completed)
