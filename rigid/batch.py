"""Many scenes at once, on all cores, in memory that grows with their number and not with their histories."""

# mypy: allow-untyped-defs
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from math import inf, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .allowed import SceneError
from .kernel import layout as at
from .kernel.angle import PI_LOW, angle_of, chart
from .kernel.compile import compiled, kernel
from .kernel.layout import (  # fmt: skip
    ANGLE,
    MORE,
    OMEGA,
    PULSE,
    PULSE_CUT,
    R_COUNT,
    R_PERIOD,
    R_PULSES,
    R_RECORDS,
    R_TURNS,
    R_WHOLE,
    RECORDS,
    REPEAT,
    SLIP,
    STATE,
    STEPS,
    TOP,
    TURN,
    TURN_ENERGY,
    WHOLE,
    WIDTH,
    WORK_BOUND,
    T,
)
from .motion import Array
from .phases.choice import entry_run
from .phases.slipping import ORDER, SERIES
from .record.pulse import cut_pulse
from .scene import Friction, Hoop, Landing, Release, Run, Scene
from .solve import LEVEL, NOTHING_AT_ALL, TAPE_RECORDS, UNTIL_CODES, reason
from .solve import STEPS as WORK

TURN_VALUES = 4  # t, phi, slip velocity, energy
PULSE_VALUES = 12  # t, phi at both ends; J_N, J_F, loss, peak; three restitutions; whether it is cut
CHUNK = 64
QUANTITIES = ("k", "r", "mass_ratio", "mu_s", "mu", "phi0", "omega0", "slip0", "restitution")
_DEFAULTS = {"r": 1.0, "mass_ratio": 0.0, "omega0": 0.0, "slip0": 0.0, "restitution": 0.0}


@kernel
def gather(state, tape, scene, ends, turns, pulses):
    """Take the tape: what it counts into ``ends``, the first turns and pulses of the scene into their arrays."""
    for record in range(int(state[RECORDS])):
        r = record * WIDTH
        n_turns, n_pulses = int(ends[scene, 3]), int(ends[scene, 4])
        if tape[r] == TURN:
            if n_turns < turns.shape[1]:
                turns[scene, n_turns, 0] = tape[r + 1]
                turns[scene, n_turns, 1] = angle_of(tape[r + 2], tape[r + 3], tape[r + 4])
                turns[scene, n_turns, 2] = tape[r + 6]
                turns[scene, n_turns, 3] = tape[r + TURN_ENERGY]
            ends[scene, 3] += 1
        elif tape[r] == PULSE:
            if n_pulses < pulses.shape[1]:
                pulses[scene, n_pulses, 0] = tape[r + 1]
                pulses[scene, n_pulses, 1] = tape[r + 5]
                pulses[scene, n_pulses, 2] = angle_of(tape[r + 2], tape[r + 3], tape[r + 4])
                pulses[scene, n_pulses, 3] = angle_of(tape[r + 6], tape[r + 7], tape[r + 8])
                for i in range(7):
                    pulses[scene, n_pulses, 4 + i] = tape[r + 9 + i]
                pulses[scene, n_pulses, 11] = tape[r + PULSE_CUT]
            ends[scene, 4] += 1
        elif tape[r] == REPEAT:
            count, period, angle = tape[r + R_COUNT], tape[r + R_PERIOD], tape[r + R_WHOLE] * 2 * pi
            again(turns, scene, n_turns, int(tape[r + R_TURNS]), count, 1, period, angle)
            again(pulses, scene, n_pulses, int(tape[r + R_PULSES]), count, 2, period, angle)
            ends[scene, 3] += count * tape[r + R_TURNS]
            ends[scene, 4] += count * tape[r + R_PULSES]
            ends[scene, 2] += count * (tape[r + R_RECORDS] - tape[r + R_TURNS] - tape[r + R_PULSES])
        else:
            ends[scene, 2] += 1


@kernel
def again(rows, scene, done, length, count, ways, period, angle):
    """The last ``length`` rows ``count`` times more, as far as there is room; the first ``ways`` columns are times, as
    many after them angles.
    """
    if length < 1 or done > rows.shape[1]:
        return
    for place in range(done, min(rows.shape[1], done + int(count) * length)):
        times, source = (place - done) // length + 1, done - length + (place - done) % length
        for i in range(rows.shape[2]):
            rows[scene, place, i] = rows[scene, source, i]
        for i in range(ways):
            rows[scene, place, i] += times * period
            rows[scene, place, ways + i] += times * angle


@kernel
def entry_batch(pars, release, low, high, work, state, tape, ends, turns, pulses):
    """Run scenes ``low`` to ``high``; the first turns and pulses of each go into ``turns`` and ``pulses``."""
    for scene in range(low, high):
        for i in range(len(state)):
            state[i] = 0.0
        state[ANGLE], state[TOP], state[WHOLE], state[OMEGA], state[SLIP] = (
            release[scene, 0], release[scene, 1], release[scene, 2], release[scene, 3], release[scene, 4],
        )  # fmt: skip
        state[STEPS] = WORK
        n_records = 0
        while True:
            state[RECORDS] = 0.0
            code = entry_run(pars[scene], state, work, tape)
            gather(state, tape, scene, ends, turns, pulses)
            n_records += int(state[RECORDS])
            if code == MORE and n_records > 2 * WORK:
                code = WORK_BOUND
            if code != MORE:
                break
        state[RECORDS] = 0.0
        cut_pulse(pars[scene], state, tape)
        gather(state, tape, scene, ends, turns, pulses)
        ends[scene, 0] = code
        ends[scene, 1] = state[T]


@dataclass(frozen=True)
class Batch:
    """What became of ``n`` scenes, in the paper's units (R, m, g).

    ``turns`` and ``pulses`` below are the numbers of columns asked for; what a scene does not have is NaN.
    """

    code: NDArray[np.int64]
    """Why each motion ended, (n,); :meth:`ended` says it in words."""
    t_end: Array
    """When, (n,)."""
    phase_count: NDArray[np.int64]
    """Phases as they were entered, (n,): one that lasts no time counts too."""
    turn_count: NDArray[np.int64]
    pulse_count: NDArray[np.int64]
    turn_t: Array
    """Turns: time, angle, slip velocity, energy, each (n, turns)."""
    turn_phi: Array
    turn_slip_velocity: Array
    turn_energy: Array
    t_start: Array
    """Pulses: as in :class:`rigid.Pulse`, each (n, pulses)."""
    t_stop: Array
    phi_start: Array
    phi_stop: Array
    normal_impulse: Array
    friction_impulse: Array
    friction_loss: Array
    peak_normal_force: Array
    newton_restitution: Array
    poisson_restitution: Array
    energetic_restitution: Array
    cut: Array
    """1 for a pulse in which the run begins or ends, 0 for a whole one."""

    def __len__(self) -> int:
        return len(self.code)

    @property
    def impulse_ratio(self) -> Array:
        """J_F/J_N of each pulse, (n, pulses)."""
        return self.friction_impulse / self.normal_impulse

    def ended(self, scene: int) -> str:
        """In words, why a motion ended."""
        return reason(int(self.code[scene]))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Batch):
            return NotImplemented
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name), equal_nan=True) for f in fields(self))


def simulate_batch(
    scenes: Sequence[Scene] | Mapping[str, ArrayLike],
    *,
    turns: int | None = None,
    t_end: float | None = None,
    until: str | None = None,
    pulses: int = 2,
    workers: int | None = None,
) -> Batch:
    """The motions of many scenes, by the compiled kernel, on all cores.

    Parameters
    ----------
    scenes : sequence of Scene, or mapping of arrays
        The arrays are k, r, mass_ratio, mu_s, mu, phi0, omega0, slip0, restitution in the paper's units (k,
        mu_s, mu and phi0 are needed), of any shapes that broadcast to (n,). Of scenes in SI units, omega0 and
        slip0 are made dimensionless; results are in the paper's units always.
    turns, t_end, until
        How far to run, the same for all (see :class:`rigid.Run`); 2 turns if nothing is said. The ``run`` of
        the scenes is not looked at.
    pulses : int
        How many pulses to keep of each scene.
    workers : int, optional
        Threads; as many as there are cores if not given. Results do not depend on it.

    Returns
    -------
    Batch
        Arrays of shapes (n,), (n, turns) and (n, pulses).

    Raises
    ------
    SceneError
        A value that no scene can have, with its index, or a ``turns``, ``t_end`` or ``until`` that no run can have.
    """
    turns = Run(turns, t_end, until).turns  # refuses what no run can be
    table = _table(scenes)
    count = len(table)
    kept = 2 if turns is None else turns
    pars, release = _constants(table, turns, t_end, until)
    ends = np.zeros((count, 5))
    turn_rows = np.full((count, kept, TURN_VALUES), np.nan)
    pulse_rows = np.full((count, pulses, PULSE_VALUES), np.nan)
    run = compiled()["entry_batch"]

    def work_through(start: int) -> None:
        work, state, tape = np.zeros((SERIES, ORDER + 1)), np.zeros(STATE), np.zeros(TAPE_RECORDS * WIDTH)
        stop = min(start + CHUNK, count)
        run(pars, release, start, stop, work, state, tape, ends, turn_rows, pulse_rows)

    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        list(pool.map(work_through, range(0, count, CHUNK)))
    mass = (1 + table[:, 2])[:, None]
    turn_rows[:, :, 3] *= mass
    pulse_rows[:, :, 4:8] *= mass[:, :, None]
    return Batch(
        ends[:, 0].astype(int),
        ends[:, 1],
        *(ends[:, i].astype(int) for i in (2, 3, 4)),
        *(turn_rows[:, :, i] for i in range(TURN_VALUES)),
        *(pulse_rows[:, :, i] for i in range(PULSE_VALUES)),
    )


def _table(scenes: Sequence[Scene] | Mapping[str, ArrayLike]) -> Array:
    """One row of ``QUANTITIES`` per scene."""
    if isinstance(scenes, Mapping):
        unknown = set(scenes) - set(QUANTITIES)
        missing = set(QUANTITIES) - set(scenes) - set(_DEFAULTS)
        if unknown or missing:
            names = ", ".join(sorted(unknown or missing))
            what = "is not a quantity of" if unknown else "is missing in"
            raise SceneError(f"{names} {what} a batch: {', '.join(QUANTITIES)}.")
        columns = [np.asarray(scenes.get(name, _DEFAULTS.get(name)), dtype=float) for name in QUANTITIES]
        table = np.stack(np.broadcast_arrays(*np.atleast_1d(*columns)), axis=1)
        _check(table)
        return np.ascontiguousarray(table)
    rows = []
    for scene in scenes:
        hoop, friction, release = scene.hoop, scene.friction, scene.release
        time = scene.time_unit
        rows.append(
            (
                hoop.k,
                hoop.r,
                hoop.mass_ratio,
                friction.mu_s,
                friction.mu,
                release.phi0,
                release.omega0 * time,
                release.slip0 * time / hoop.R,
                scene.landing.restitution,
            )
        )
    return np.array(rows, dtype=float).reshape(len(rows), len(QUANTITIES))


def _check(table: Array) -> None:
    """Raise what the first impossible row would raise as a scene."""
    k, r, mass, mu_s, mu, *_, bounce = table.T
    fine = np.isfinite(table).all(axis=1) & (k >= 0) & (k < 1) & (r >= 1) & (mass >= 0) & (mu >= 0) & (mu_s >= mu)
    fine &= (bounce >= 0) & (bounce <= 1) & ((k > 0) | (mass > 0) | (r == 1))
    fine &= (np.abs(np.delete(table, 2, axis=1)) <= 1e9).all(axis=1) & (mass <= 1e12)
    if not fine.all():
        index = int(np.argmin(fine))
        row = [float(number) for number in table[index]]
        try:
            Hoop(*row[:3])
            Friction(*row[3:5])
            Release(*row[5:8])
            Landing(row[8])
        except SceneError as error:
            raise SceneError(f"scene {index} of the batch: {error}") from None


def _constants(table: Array, turns: int | None, t_end: float | None, until: str | None) -> tuple[Array, Array]:
    """Parameters and release states of all scenes, as :mod:`rigid.solve` makes them for one."""
    k, r, q, mu_s, mu, phi0, omega0, slip0, bounce = table.T
    gyr = (k**2 / 2 + q * (1 + r**2) / 2 + (1 - k) ** 2 * q / (1 + q)) / (1 + q) / r**2
    e = (1 - k) / (1 + q) / r
    one_minus_e = (k + q + (r - 1) * (1 + q)) / (r * (1 + q))
    point = (gyr < 1e-100) & (one_minus_e < 1e-40)
    gyr, one_minus_e, e = np.where(point, 0, gyr), np.where(point, 0, one_minus_e), np.where(point, 1, e)
    pars = np.empty((len(table), at.PARAMETERS))
    pars[:, at.ECC], pars[:, at.ONE_MINUS_E], pars[:, at.GYR] = e, one_minus_e, gyr
    pars[:, at.ZETA] = (gyr + one_minus_e**2) / e
    pars[:, at.MU_S], pars[:, at.MU], pars[:, at.RESTITUTION] = mu_s, mu, bounce
    pars[:, at.TURNS] = inf if turns is None else turns
    pars[:, at.T_END] = inf if t_end is None else t_end
    pars[:, at.UNTIL] = UNTIL_CODES[until]
    whole = np.floor(phi0 / (2 * pi) + 0.5)
    offsets = (phi0 - whole * (2 * pi)) - whole * (2 * PI_LOW)
    angles = [chart(a, 1.0, n) for a, n in zip(offsets.tolist(), whole.tolist(), strict=True)]
    release = np.column_stack([np.array(angles, dtype=float).reshape(len(table), 3), omega0, slip0])
    level = (release[:, 0] != phi0) & (np.abs(release[:, 0]) <= LEVEL * np.maximum(1, np.abs(phi0)))
    release[level, 0] = 0.0
    for column in (0, 3, 4):
        release[np.abs(release[:, column]) < NOTHING_AT_ALL, column] = 0.0
    return pars, np.ascontiguousarray(release)
