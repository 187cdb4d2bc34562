"""Many scenes at once, on all cores, in memory that grows with their number and not with their histories."""

# mypy: allow-untyped-defs
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .allowed import SceneError, shown
from .kernel import layout as at
from .kernel.compile import compiled, kernel
from .kernel.layout import HOPS, MORE, RECORDS, STATE, STEPS, WIDTH, WORK_BOUND, T
from .kernel.spectral import compiled_workspace
from .lists import phases_of
from .motion import Array, Kind
from .output import summary
from .output.units import without_units
from .phases.choice import entry_run, release_from
from .phases.reasons import reason
from .record.pulse import cut_pulse
from .record.rows import (  # fmt: skip
    CODE,
    END_VALUES,
    HOP_COUNT,
    JAM_COUNT,
    PHASE_COUNT,
    PULSE_COUNT,
    PULSE_VALUES,
    T_STOP,
    TURN_COUNT,
    TURN_VALUES,
    Rows,
    gather,
)
from .scene import LIGHTEST, Friction, Hoop, Landing, Release, Run, Scene, hoop_constants, is_point_mass
from .scenefile import SceneLike, as_scene
from .solve import LOG_RECORDS, UNTIL_CODES
from .solve import STEPS as WORK

if TYPE_CHECKING:
    import pandas

CHUNKS = 8  # of a worker, each of MOST scenes at the most: large ones cost least, small ones end together
MOST = 512
QUANTITIES = ("k", "r", "mass_ratio", "mu_s", "mu", "phi0", "omega0", "slip0", "restitution")
PULSE_MEASURES = (
    "normal_impulse", "friction_impulse", "friction_loss", "peak_normal_force",
    "newton_restitution", "poisson_restitution", "energetic_restitution",
)  # fmt: skip
_DEFAULTS = {"r": 1.0, "mass_ratio": 0.0, "omega0": 0.0, "slip0": 0.0, "restitution": 0.0}


@kernel
def entry_batch(pars, release, low, high, work, state, events, rows):
    """Run scenes ``low`` to ``high``; what is kept of each goes into ``rows``."""
    for scene in range(low, high):
        release_from(state, release[scene, 0], release[scene, 1], release[scene, 2])
        state[STEPS] = WORK
        n_records = 0
        while True:
            state[RECORDS] = 0.0
            code = entry_run(pars[scene], state, work, events)
            gather(state, events, scene, rows)
            n_records += int(state[RECORDS])
            if code == MORE and n_records > 2 * WORK:
                code = WORK_BOUND
            if code != MORE:
                break
        state[RECORDS] = 0.0
        cut_pulse(pars[scene], state, events)
        gather(state, events, scene, rows)
        rows.ends[scene, CODE], rows.ends[scene, T_STOP] = code, state[T]
        rows.ends[scene, HOP_COUNT] = state[HOPS]
        rows.ends[scene, JAM_COUNT] -= state[HOPS]


@dataclass(frozen=True, repr=False)
class Batch:
    """What became of ``n`` scenes, in the paper's units (R, m, g); ``turns`` and ``pulses`` below are the numbers of
    columns asked for; what a scene does not have is NaN.
    """

    code: NDArray[np.int64]
    """Why each motion ended, (n,); :meth:`ended` says it in words."""
    t_end: Array
    """When, (n,)."""
    phase_count: NDArray[np.int64]
    """Phases as they were entered, (n,): one that lasts no time counts too."""
    turn_count: NDArray[np.int64]
    pulse_count: NDArray[np.int64]
    hop_count: NDArray[np.int64]
    """Flights that ended on the floor, (n,)."""
    jam_count: NDArray[np.int64]
    """Impacts without a collision, (n,)."""
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
    sequence: Array
    """What the contact does in each pulse, (n, pulses), as a number; :meth:`phases` says it in words."""

    def __len__(self) -> int:
        return len(self.code)

    @property
    def impulse_ratio(self) -> Array:
        """J_F/J_N of each pulse, (n, pulses)."""
        return self.friction_impulse / self.normal_impulse

    def ended(self, scene: int) -> str:
        """In words, why a motion ended."""
        return reason(int(self.code[scene]))

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each pulse of each scene, indexed by both: the pulse's measures, and how the scene's motion ended.

        A scene without a pulse has one row, of pulse 0, whose measures are NaN.
        """
        from .output.frame import pulses_of_scenes

        measures = ("t_start", "t_stop", "phi_start", "phi_stop", *PULSE_MEASURES, "impulse_ratio", "cut")
        scenes = {name: getattr(self, name) for name in ("phase_count", "turn_count", "pulse_count", "t_end")}
        scenes["ended"] = [reason(int(code)) for code in self.code]
        table = pulses_of_scenes({name: getattr(self, name) for name in measures}, scenes)
        table["cut"] = table["cut"] == 1
        return table

    def phases(self, scene: int, pulse: int = 0) -> tuple[Kind, ...]:
        """What the contact does in a pulse of a scene, in its order; nothing where there is no such pulse."""
        return phases_of(self.sequence[scene, pulse])

    def __repr__(self) -> str:
        return summary.text(self._title(), self._lines())

    def _repr_html_(self) -> str:
        return summary.html(self._title(), self._lines())

    def _title(self) -> str:
        return f"Batch of {len(self)} scenes"

    def _lines(self) -> list[summary.Line]:
        ends = zip(*np.unique(self.code, return_counts=True), strict=True)
        told = [("ended", f"{n}: {reason(int(code))}") for code, n in ends]
        first = self.impulse_ratio[:, :1][np.isfinite(self.impulse_ratio[:, :1])]
        if first.size:
            told.append(("J_F/J_N", f"{first.min():.6g} to {first.max():.6g} in the first pulse"))
        return told

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Batch):
            return NotImplemented
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name), equal_nan=True) for f in fields(self))


def simulate_batch(
    scenes: Sequence[SceneLike] | Mapping[str, ArrayLike],
    *,
    turns: int | None = None,
    t_end: float | None = None,
    until: str | None = None,
    pulses: int = 2,
    whole: bool = False,
    workers: int | None = None,
) -> Batch:
    """The motions of many scenes, by the compiled kernel, on all cores.

    Parameters
    ----------
    scenes : sequence of scenes, or mapping of arrays
        Each of a sequence is anything that :func:`rigid.simulate` takes; of scenes in SI units, omega0 and slip0 are
        made dimensionless. The arrays are k, r, mass_ratio, mu_s, mu, phi0, omega0, slip0, restitution in the paper's
        units (k, mu_s, mu, phi0 are needed), of any shapes that broadcast to (n,). Results are in the paper's units.
    turns, t_end, until
        How far to run, the same for all (see :class:`rigid.Run`); 2 turns if nothing is said. The ``run`` of
        the scenes is not looked at.
    pulses : int
        How many pulses to keep of each scene.
    whole : bool
        That until="pulse" means a whole pulse: one that the release cuts does not end the motion.
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
    pars, release = _parameters(table, turns, t_end, until, whole), np.ascontiguousarray(table[:, 5:8])
    rows = Rows(
        np.zeros((count, END_VALUES)),
        np.full((count, 2 if turns is None else turns, TURN_VALUES), np.nan),
        np.full((count, pulses, PULSE_VALUES), np.nan),
    )
    run = compiled()["entry_batch"]
    workers = workers or os.cpu_count() or 1
    chunk = min(MOST, -(-count // (CHUNKS * workers)) or 1)

    def work_through(start: int) -> None:
        work, state, events = compiled_workspace(), np.zeros(STATE), np.zeros(LOG_RECORDS * WIDTH)
        stop = min(start + chunk, count)
        run(pars, release, start, stop, work, state, events, rows)

    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(work_through, range(0, count, chunk)))
    mass = (1 + table[:, 2])[:, None]
    rows.turns[:, :, 3] *= mass
    rows.pulses[:, :, 4:8] *= mass[:, :, None]
    return Batch(
        rows.ends[:, CODE].astype(int),
        rows.ends[:, T_STOP],
        *(rows.ends[:, i].astype(int) for i in (PHASE_COUNT, TURN_COUNT, PULSE_COUNT, HOP_COUNT, JAM_COUNT)),
        *(rows.turns[:, :, i] for i in range(TURN_VALUES)),
        *(rows.pulses[:, :, i] for i in range(PULSE_VALUES)),
    )


def _table(scenes: Sequence[SceneLike] | Mapping[str, ArrayLike]) -> Array:
    """One row of ``QUANTITIES`` per scene."""
    if isinstance(scenes, Mapping):
        unknown = set(scenes) - set(QUANTITIES)
        missing = set(QUANTITIES) - set(scenes) - set(_DEFAULTS)
        if unknown or missing:
            what = "is not a quantity of" if unknown else "is missing in"
            raise SceneError(f"{', '.join(sorted(unknown or missing))} {what} a batch: {', '.join(QUANTITIES)}.")
        columns = [np.asarray(scenes.get(name, _DEFAULTS.get(name)), dtype=float) for name in QUANTITIES]
        table = np.stack(np.broadcast_arrays(*np.atleast_1d(*columns)), axis=1)
        _check(table)
        return np.ascontiguousarray(table)
    if isinstance(scenes, (str, os.PathLike, Scene)):
        raise SceneError(f"{shown(scenes)} is one scene: a batch takes a list of them, or a dict of arrays.")
    rows = []
    for scene in map(as_scene, scenes):
        hoop, friction, release = scene.hoop, scene.friction, without_units(scene.release, scene)
        hoop_and_friction = (hoop.k, hoop.r, hoop.mass_ratio, friction.mu_s, friction.mu)
        rows.append((*hoop_and_friction, release.phi0, release.omega0, release.slip0, scene.landing.restitution))
    return np.array(rows, dtype=float).reshape(len(rows), len(QUANTITIES))


def _check(table: Array) -> None:
    """Raise what the first impossible row would raise as a scene."""
    k, r, mass, mu_s, mu, *_, bounce = table.T
    fine = np.isfinite(table).all(axis=1) & (k >= 0) & (k < 1) & (r >= 1) & (mu >= 0) & (mu_s >= mu)
    fine &= (bounce >= 0) & (bounce <= 1) & ((k > 0) | (mass > 0) | (r == 1)) & ((mass == 0) | (mass >= LIGHTEST))
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


def _parameters(table: Array, turns: int | None, t_end: float | None, until: str | None, whole: bool) -> Array:
    """Parameters of all scenes, as :func:`rigid.solve.parameters` makes them for one."""
    k, r, mass_ratio, mu_s, mu, *_, bounce = table.T
    hoop = hoop_constants(k, r, mass_ratio)
    point = is_point_mass(hoop)
    pars = np.empty((len(table), at.PARAMETERS))
    pars[:, at.ECC], pars[:, at.ONE_MINUS_E] = np.where(point, 1, hoop.e), np.where(point, 0, hoop.one_minus_e)
    pars[:, at.GYR] = np.where(point, 0, hoop.K)
    pars[:, at.ZETA] = np.where(point, 0, hoop.zeta)
    pars[:, at.MU_S], pars[:, at.MU], pars[:, at.RESTITUTION] = mu_s, mu, bounce
    pars[:, at.TURNS] = inf if turns is None else turns
    pars[:, at.T_END] = inf if t_end is None else t_end
    pars[:, at.UNTIL], pars[:, at.WHOLE_ONLY] = UNTIL_CODES[until], whole
    return pars
