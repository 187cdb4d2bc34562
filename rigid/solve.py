"""A scene goes in, a motion comes out."""

from __future__ import annotations

import itertools
import threading
from dataclasses import dataclass
from math import floor, inf, pi
from typing import Any

import numpy as np

from . import history
from .kernel import layout as at
from .kernel.angle import PI_LOW, angle_of, chart
from .kernel.compile import compiled
from .motion import Array, Kind, Motion, Phase, Pulse, States, Turn
from .phases.choice import MOST_STALLS, entry_run
from .phases.rolling_phase import LISTED_PERIODS
from .phases.slipping import ORDER, SERIES
from .scene import Scene

KINDS = {
    at.ROLL: Kind.ROLL, at.SKID: Kind.SKID, at.SPIN: Kind.SPIN,
    at.FLIGHT: Kind.FLIGHT, at.SKIM: Kind.SKIM, at.IMPACT: Kind.IMPACT,
}  # fmt: skip
TAPE_RECORDS = 128
STEPS = 200_000  # the work bound of one motion: Taylor steps and phases
MOST_RECORDS = 200_000  # and its phases, turns and pulses together
PATIENCE = 4_000  # interpreted steps, some 0.4 s, after which a process goes over to the compiled kernel

# phi0 this close to a multiple of pi, relatively, means that multiple: no float but 0 is one itself
LEVEL = 2.3e-16
# an angle or a velocity whose square would underflow
NOTHING_AT_ALL = 1e-140

UNTIL_CODES = {None: at.NOTHING, "pulse": at.FIRST_PULSE, "rest": at.REST}
_REASONS = {
    at.TIME_REACHED: "the time to run is over",
    at.PULSE_OVER: "the first pulse is over",
    at.RESTS: "rests: nothing moves any more",
    at.SLIDES: "slides for ever: a smooth floor takes no energy",
    at.HITS_FLOOR: "the point mass hits the floor",
    at.CREEPS: "creeps up to the top and never gets there",
    at.SETTLES: "all but rolls for ever: a hundred slips took less than a ten-thousandth of its energy",
    at.TURNS_REACHED: "the last turn asked for is reached",
    at.ROLLS: "rolls for ever: |F| < mu_s N over the whole swing",
    at.WHIRLS: "rolls for ever, over the top in every revolution, so there is no turn to wait for",
    at.ROLLS_ON: f"the time to run is over; it rolls for ever, of which {LISTED_PERIODS:g} periods are listed",
    at.WORK_BOUND: "the work bound is reached",
    at.LIFTED: "the point mass rises out of the hoop's reach and takes it off the floor",
}
_interpreted_steps = 0


def parameters(scene: Scene) -> list[float]:
    """The constants of a motion, R = g = M = 1 (see :mod:`rigid.kernel.layout`)."""
    hoop, run = scene.hoop, scene.run
    gyr, one_minus_e, e = hoop.K, hoop.one_minus_e, hoop.e
    if gyr < 1e-100 and one_minus_e < 1e-40:
        gyr, one_minus_e, e = 0.0, 0.0, 1.0
    zeta = (gyr + one_minus_e**2) / e
    turns = inf if run.turns is None else float(run.turns)
    t_end = inf if run.t_end is None else run.t_end / scene.time_unit
    friction = scene.friction
    bounce = scene.landing.restitution
    return [
        e,
        one_minus_e,
        gyr,
        zeta,
        friction.mu_s,
        friction.mu,
        bounce,
        turns,
        t_end,
        float(UNTIL_CODES[run.until]),
    ]


def release_state(scene: Scene) -> list[float]:
    """The state at t = 0 (see :mod:`rigid.kernel.layout`)."""
    release = scene.release
    state = [0.0] * at.STATE
    turns = float(floor(release.phi0 / (2 * pi) + 0.5))
    a = (release.phi0 - turns * (2 * pi)) - turns * (2 * PI_LOW)
    a, top, whole = chart(a, 1.0, turns)
    if a != release.phi0 and abs(a) <= LEVEL * max(1.0, abs(release.phi0)):
        a = 0.0
    state[at.ANGLE], state[at.TOP], state[at.WHOLE] = a, top, whole
    state[at.OMEGA] = float(release.omega0 * scene.time_unit)
    state[at.SLIP] = float(release.slip0 / scene.velocity_unit)
    for i in (at.ANGLE, at.OMEGA, at.SLIP):
        if abs(state[i]) < NOTHING_AT_ALL:
            state[i] = 0.0
    state[at.STEPS] = float(STEPS)
    return state


class _Workspace(threading.local):
    """What the compiled kernel works in, one for each thread."""

    def __init__(self) -> None:
        self.tape = np.zeros(TAPE_RECORDS * at.WIDTH)
        self.work = np.zeros((SERIES, ORDER + 1))


_workspace = _Workspace()


def _run(par: list[float], state: list[float]) -> tuple[int, list[list[float]], list[float]]:
    """Run to the end: why it ended, the records, the final state.

    Interpreted until this process has spent ``PATIENCE`` steps, from then on compiled: the same numbers to
    round-off.
    """
    global _interpreted_steps
    records: list[list[float]] = []
    left = float(STEPS)
    if _interpreted_steps < PATIENCE:
        tape: Any = [0.0] * (TAPE_RECORDS * at.WIDTH)
        work: Any = [[0.0] * (ORDER + 1) for _ in range(SERIES)]
        code = at.MORE
        while code == at.MORE and _interpreted_steps < PATIENCE:
            allowance = float(PATIENCE - _interpreted_steps)
            state[at.RECORDS], state[at.STEPS] = 0.0, allowance
            code = entry_run(par, state, work, tape)
            spent = allowance - state[at.STEPS]
            left -= spent
            _interpreted_steps += int(spent)
            _unroll(tape, state, records)
        if code not in (at.MORE, at.WORK_BOUND) or state[at.STALLS] > MOST_STALLS:
            return code, records, state
    run = compiled()["entry_run"]
    tape, work = _workspace.tape, _workspace.work
    constants, here = np.array(par), np.array(state)
    here[at.STEPS] = left
    code = at.MORE
    while code == at.MORE and len(records) < MOST_RECORDS:
        here[at.RECORDS] = 0.0
        code = run(constants, here, work, tape)
        _unroll(tape, here, records)
    return (at.WORK_BOUND if code == at.MORE else code), records, here.tolist()


def _unroll(tape: Any, state: Any, records: list[list[float]]) -> None:
    """Take the records off the tape."""
    used = int(state[at.RECORDS]) * at.WIDTH
    row = tape[:used].tolist() if isinstance(tape, np.ndarray) else tape[:used]
    records += [row[i : i + at.WIDTH] for i in range(0, used, at.WIDTH)]


def simulate(scene: Scene) -> Motion:
    """The rigid motion of a scene, exact to round-off.

    Parameters
    ----------
    scene : Scene
        Hoop, friction, release and how far to run; its ring and contact are not looked at.

    Returns
    -------
    Motion
        Phases, turns and pulses in the units of the scene; ``at(t)`` gives any instant between. ``period`` is
        that of a motion that ends rolling for ever. A motion never fails: what stops it is said in ``ended``.
    """
    par = parameters(scene)
    code, records, final = _run(par, release_state(scene))
    time, mass = scene.time_unit, 1 + scene.hoop.mass_ratio
    impulse, energy, force = mass * scene.impulse_unit, mass * scene.energy_unit, mass * scene.force_unit
    starts: list[list[float]] = []
    turns: list[Turn] = []
    pulses: list[Pulse] = []
    for row in records:
        tag = row[0]
        if tag == at.TURN:
            turns.append(
                Turn(
                    row[1] * time,
                    angle_of(row[2], row[3], row[4]),
                    row[6] * scene.velocity_unit,
                    row[at.TURN_ENERGY] * energy,
                )
            )
        elif tag == at.PULSE:
            measures = (row[9] * impulse, row[10] * impulse, row[11] * energy, row[12] * force, *row[13:16])
            pulses.append(_pulse(row[1] * time, row[5] * time, row[2:5], row[6:9], measures))
        else:
            starts.append(row)
    end = [float(at.END), *final[: at.MOVING]]
    starts = _merged(starts, end)
    edges = [*starts, end]
    # the angle of release is given, not rounded through its chart
    phases = tuple(
        Phase(KINDS[int(a[0])], a[1] * time, b[1] * time, angle_of(a[2], a[3], a[4]), angle_of(b[2], b[3], b[4]))
        for a, b in itertools.pairwise(edges)
    )
    period = final[at.PERIOD] * time if 0 < final[at.PERIOD] < inf else None
    sample = Sampler(tuple(par), tuple(map(tuple, starts)), scene)
    return Motion(
        scene, phases, tuple(turns), tuple(pulses), _ended(code, scene, period, final), sample, period,
        code != at.WORK_BOUND,
    )  # fmt: skip


def _pulse(t0: float, t1: float, start: list[float], stop: list[float], measures: tuple[float, ...]) -> Pulse:
    normal, friction, loss, peak, newton, poisson, energetic = measures
    return Pulse(
        t_start=t0,
        t_end=t1,
        phi_start=angle_of(*start),
        phi_end=angle_of(*stop),
        normal_impulse=normal,
        friction_impulse=friction,
        friction_loss=loss,
        peak_normal_force=peak,
        newton_restitution=newton,
        poisson_restitution=poisson,
        energetic_restitution=energetic,
    )


def _merged(starts: list[list[float]], end: list[float]) -> list[list[float]]:
    """Phases that go somewhere (an impact need not), neighbours of one kind as one.

    In the pulse of a tiny disk a phase may take less time than t can resolve: the angle tells.
    """
    kept: list[list[float]] = []
    for row, following in zip(starts, [*starts[1:], end], strict=True):
        if row[0] != at.IMPACT and following[1:5] == row[1:5] and len(starts) > 1:
            continue
        if kept and kept[-1][0] == row[0] and row[0] != at.IMPACT:
            continue
        kept.append(row)
    return kept or starts[:1]


def reason(code: int) -> str:
    """Why a motion ends, in words."""
    return _REASONS[code]


def _ended(code: int, scene: Scene, period: float | None, final: list[float]) -> str:
    """The reason, with the numbers of this motion."""
    words = reason(code)
    if code == at.TURNS_REACHED:
        return f"{words}: number {scene.run.turns}"
    if code == at.WORK_BOUND:
        return f"{words} after {final[at.T] * scene.time_unit:.6g}: the motion goes on"
    if period is None or code not in (at.ROLLS, at.WHIRLS, at.ROLLS_ON):
        return words
    return f"{words}; period {period:.12g}"


@dataclass(frozen=True)
class Sampler:
    """Evaluates a motion at given times from the starting states of its phases; a plain value."""

    par: tuple[float, ...]
    starts: tuple[tuple[float, ...], ...]
    scene: Scene

    def __call__(self, t: Array) -> States:
        """States at times of any shape, in the units of the scene."""
        scene = self.scene
        order = np.argsort(t, axis=None, kind="stable")
        times = t.ravel()[order] / scene.time_unit
        rows = self._rows(times)
        table = np.empty_like(rows)
        table[order] = rows
        columns = [column.reshape(t.shape) for column in table.T]
        phi, omega, x, gap, slip, normal, friction, energy = columns
        hoop = scene.hoop
        mass = 1 + hoop.mass_ratio
        return States(
            t=t,
            phi=phi,
            omega=omega / scene.time_unit,
            x_C=x * hoop.R,
            y_C=(1 + gap) * hoop.R,
            slip_velocity=slip * scene.velocity_unit,
            normal_force=normal * mass * scene.force_unit,
            friction_force=friction * mass * scene.force_unit,
            energy=energy * mass * scene.energy_unit,
        )

    def _rows(self, times: Array) -> Array:
        width = history.COLUMNS
        padded = [list(row) + [0.0] * (at.WIDTH - len(row)) for row in self.starts]
        flat = [number for row in padded for number in row]
        if _interpreted_steps < PATIENCE and len(times) < PATIENCE:
            out: Any = [0.0] * (len(times) * width)
            work: Any = [[0.0] * (ORDER + 1) for _ in range(SERIES)]
            tape = [0.0] * (16 * at.WIDTH)
            state = [0.0] * at.STATE
            history.entry_sample(list(self.par), flat, len(padded), times.tolist(), out, work, state, tape)
            return np.array(out, dtype=float).reshape(len(times), width)
        out = np.zeros(len(times) * width)
        work = np.zeros((SERIES, ORDER + 1))
        compiled()["entry_sample"](
            np.array(self.par),
            np.array(flat),
            len(padded),
            times,
            out,
            work,
            np.zeros(at.STATE),
            np.zeros(16 * at.WIDTH),
        )
        return out.reshape(len(times), width)
