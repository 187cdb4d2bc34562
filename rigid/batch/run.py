"""The loop over many scenes, in compiled code, on all cores."""

# mypy: allow-untyped-defs
from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import ArrayLike

from ..allowed import require_whole
from ..kernel.compile import compiled, kernel
from ..kernel.layout import HOPS, MORE, RECORDS, STATE, STEPS, WIDTH, WORK_BOUND, T
from ..kernel.spectral import compiled_workspace
from ..phases.choice import entry_run, release_from
from ..record.pulse import cut_pulse
from ..record.rows import (  # fmt: skip
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
from ..scene import Run
from ..scenefile import SceneLike
from ..solve import LOG_RECORDS, MOST_RECORDS
from ..solve import STEPS as WORK
from .cores import cores
from .result import Batch
from .table import parameters_of, table_of

CHUNKS = 8  # of a worker, each of MOST scenes at the most: large ones cost least, small ones end together
MOST = 512


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
            if code == MORE and n_records >= MOST_RECORDS:
                code = WORK_BOUND
            if code != MORE:
                break
        state[RECORDS] = 0.0
        cut_pulse(pars[scene], state, events)
        gather(state, events, scene, rows)
        rows.ends[scene, CODE], rows.ends[scene, T_STOP] = code, state[T]
        rows.ends[scene, HOP_COUNT] = state[HOPS]
        rows.ends[scene, JAM_COUNT] -= state[HOPS]


def simulate_batch(
    scenes: Sequence[SceneLike] | Mapping[str, ArrayLike],
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
    scenes : sequence of scenes, or mapping (or pandas table) of arrays
        Each of a sequence is anything that :func:`rigid.simulate` takes; of scenes in SI units, omega0 and slip0 are
        made dimensionless. The arrays are k, r, mass_ratio, mu_s, mu, phi0, omega0, slip0, restitution in the paper's
        units, phi0 in radians (k, mu_s, mu, phi0 are needed), of any shapes that broadcast to (n,). Results are in the
        paper's units.
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
        A value that no scene can have, with its index, or a ``turns``, ``t_end`` or ``until`` that no run can have;
        ``pulses`` or ``workers`` that are no whole number.
    """
    pulses = require_whole("pulses", pulses, 0, 1_000_000)
    if workers is not None:
        workers = require_whole("workers", workers, 1, 1024)
    turns = Run(turns, t_end, until).turns  # refuses what no run can be
    table = table_of(scenes)
    count = len(table)
    pars, release = parameters_of(table, turns, t_end, until), np.ascontiguousarray(table[:, 5:8])
    rows = Rows(
        np.zeros((count, END_VALUES)),
        np.full((count, 2 if turns is None else turns, TURN_VALUES), np.nan),
        np.full((count, pulses, PULSE_VALUES), np.nan),
    )
    run = compiled()["entry_batch"]
    workers = workers or cores()
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
