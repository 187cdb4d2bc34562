"""`hoop bench rigid`: the first full cycle of three hoops, ours and scipy's, against forty digits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import inf
from typing import Any

import numpy as np

import rigid
from rigid import Friction, Hoop, Release, Run, Scene, simulate, simulate_batch
from rigid.kernel.compile import patience

from .peers import scipy_ivp as peers
from .race import Claim, Contestant, Result, Row, race
from .truth.precision import DISKS, MU, MU_S, PHI0
from .truth.precision_values import TURNS

TURNS_ASKED = 2
TOLERANCES = (1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
QUICK_TOLERANCES = (1e-6, 1e-10)
SLOW = 0.3  # seconds; what takes longer is repeated less often


def scene_of(k: float) -> Scene:
    """The hoop of the reference."""
    return Scene(Hoop(k), Friction(MU_S, MU), Release(PHI0), Run(turns=TURNS_ASKED))


def worst(k: float, turns: Sequence[Sequence[float]]) -> float:
    """Largest relative error in time, angle and energy of the turns."""
    return _off([[float(number) for number in row] for row in TURNS[k]], turns)


def worst_of_one(k: float, turns: Sequence[Sequence[float]]) -> float:
    """The same of the hoop with mu_s = mu, for what knows one coefficient only: against this rigid hoop."""
    motion = simulate(scene_of(k).replace(friction={"mu_s": MU}))
    return _off([(t.t, t.phi, t.slip_velocity, t.energy) for t in motion.turns], turns)


def _off(exact: Sequence[Sequence[float]], turns: Sequence[Sequence[float]]) -> float:
    if len(turns) < TURNS_ASKED:
        return inf
    return max(abs(a[i] / b[i] - 1) for a, b in zip(turns, exact, strict=True) for i in (0, 1, 3))


def _ours(k: float) -> Callable[[], Any]:
    scene = scene_of(k)

    def run() -> rigid.Motion:
        motion = simulate(scene)
        len(motion.turns)  # its lists are made when they are looked at; the others return their turns too
        return motion

    return run


def _judge_motion(k: float) -> Callable[[rigid.Motion], float]:
    return lambda motion: worst(k, [(t.t, t.phi, t.slip_velocity, t.energy) for t in motion.turns])


def _forget() -> None:
    """Make the next call an interpreted one, as the first of a process is."""
    patience.renew()


def remember() -> None:
    """Make it a compiled one, as after some tenths of a second of runs."""
    patience.renew(0)


def _judge_batch(ks: np.ndarray) -> Callable[[rigid.Batch], float]:
    """Error of the scene in the batch whose k has a reference."""

    def judge(batch: rigid.Batch) -> float:
        i = int(np.flatnonzero(ks == DISKS[0])[0])
        columns = (batch.turn_t, batch.turn_phi, batch.turn_slip_velocity, batch.turn_energy)
        return worst(DISKS[0], [tuple(float(c[i, j]) for c in columns) for j in range(TURNS_ASKED)])

    return judge


def many_disks(count: int) -> np.ndarray:
    """Different disk radii around that of the paper, one of them exactly it."""
    ks = np.linspace(0.05, 0.25, count)
    ks[np.argmin(abs(ks - DISKS[0]))] = DISKS[0]
    return ks


def batch_of(count: int, workers: int | None = None) -> Callable[[], rigid.Batch]:
    """Run so many different scenes at once."""
    ks = many_disks(count)
    return lambda: simulate_batch({"k": ks, "mu_s": MU_S, "mu": MU, "phi0": PHI0}, turns=TURNS_ASKED, workers=workers)


def _scipy(k: float, method: str, rtol: float) -> Callable[[], Any]:
    return lambda: peers.scipy_turns(k, MU_S, MU, PHI0, TURNS_ASKED, method, rtol)


def contestants(quick: bool) -> list[Contestant]:
    """Everyone, scene by scene."""
    entries = []
    for k in DISKS[:1] if quick else DISKS:
        name = f"k = {k:g}"
        entries.append(
            Contestant("hoop-pulse", "one call, compiled", name, _ours(k), _judge_motion(k), 50, prepare=remember)
        )
        entries.append(
            Contestant("hoop-pulse", "first call, interpreted", name, _ours(k), _judge_motion(k), prepare=_forget)
        )
        for method in peers.METHODS:
            for rtol in QUICK_TOLERANCES if quick else TOLERANCES:
                if quick and method == "Radau" and rtol < 1e-6:
                    continue
                stiff = method == "Radau" and rtol < 1e-4

                def judge(turns: Any, k: float = k) -> float:
                    return worst(k, turns)

                entries.append(
                    Contestant(
                        f"scipy {method}", f"rtol {rtol:.0e}", name, _scipy(k, method, rtol), judge,
                        repeats=2 if stiff else None, memory=not stiff,
                    )
                )  # fmt: skip
    return entries


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """Time everyone and check what is stated."""
    remember()
    simulate(scene_of(DISKS[0]))
    rows = race(contestants(quick), 3 if quick else 7, progress)
    remember()
    count = 1_000 if quick else 10_000
    judge, name = _judge_batch(many_disks(count)), f"k = {DISKS[0]:g}"
    entries = [
        Contestant("hoop-pulse", f"batch of {count}, all cores", name, batch_of(count), judge, clock="wall"),
        # what other work on the machine does not change
        Contestant("hoop-pulse", f"batch of {count}, one core", name, batch_of(count, 1), judge),
    ]
    batches = race(entries, 3 if quick else 5)
    for batch in batches:
        batch.seconds = [seconds / count for seconds in batch.seconds]
        batch.note = "per scene"
    rows += batches
    if peers_too and peers.installed("exudyn"):
        rows += race(_exudyn(), 1)
    if peers_too:
        rows += _nonsmooth(quick)
        rows += [_absent(name) for name in ("exudyn", "pydrake", "solve_nivp") if not peers.installed(name)]
        if peers.installed("pydrake"):
            note = "one coefficient where this hoop has two: its pulse is in `hoop study limit --peers`, with mu_s = mu"
            rows.append(Row("pydrake", "-", "-", [], note=note))
    return Result(rows, _claims(rows, *batches))


def _exudyn() -> list[Contestant]:
    """Exudyn's roll, for the disk of section 3.1 (smaller ones want smaller steps than anyone would wait for)."""
    from .peers.exudyn_roll import SETTINGS, roll_turns

    k = DISKS[0]
    return [
        Contestant(
            "exudyn", str(setting), f"k = {k:g}", partial(roll_turns, k, MU_S, MU, PHI0, TURNS_ASKED, setting),
            partial(worst, k), repeats=1, memory=False,
        )
        for setting in SETTINGS
    ]  # fmt: skip


def _nonsmooth(quick: bool) -> list[Row]:
    """Time stepping of set-valued friction, of a single coefficient."""
    from .peers import nivp_roll, siconos_roll

    k, note = DISKS[0], "mu_s = mu: error against the rigid hoop of one coefficient"
    name, rows = f"k = {k:g}", []
    if peers.installed("solve_nivp"):
        steps = nivp_roll.STEPS[:1] if quick else nivp_roll.STEPS
        entries = [
            Contestant(
                "solve_nivp", f"composite, h = {step:g}", name,
                partial(nivp_roll.roll_turns, k, MU, PHI0, TURNS_ASKED, step), partial(worst_of_one, k),
                repeats=1, memory=False,
            )
            for step in steps
        ]  # fmt: skip
        rows += race(entries, 1)
        for row in rows:
            row.note = row.note or note
    if siconos_roll.interpreter() is None:
        return [*rows, _absent("siconos")]
    for step in siconos_roll.STEPS[:1] if quick else siconos_roll.STEPS:
        row = Row("siconos", f"Moreau-Jean, h = {step:g}", name, [])
        rows.append(row)
        try:
            turns, seconds = siconos_roll.roll_turns(k, MU, PHI0, TURNS_ASKED, step)
        except RuntimeError as error:
            row.note = " ".join(str(error).split())
            continue
        row.seconds, row.error, row.note = [seconds], worst_of_one(k, turns), note
    return rows


def _absent(name: str) -> Row:
    return Row(name, "-", "-", [], note="not installed")


def _find(rows: list[Row], solver: str, setting: str, scene: str) -> Row:
    return next(row for row in rows if (row.solver, row.setting, row.scene) == (solver, setting, scene))


def _claims(rows: list[Row], batch: Row, on_one: Row) -> list[Claim]:
    """Ratios of the least times, which other work on the machine disturbs least."""
    name = f"k = {DISKS[0]:g}"
    ours = _find(rows, "hoop-pulse", "one call, compiled", name)
    theirs = _find(rows, "scipy DOP853", "rtol 1e-10", name)
    claims = [
        Claim("rigid: faster than scipy DOP853 at rtol 1e-10, k = 0.1", theirs.least / ours.least, 300),
        Claim("rigid: our error over scipy's there", ours.error / theirs.error, 1, at_most=True),
        Claim("rigid: faster per scene in a batch, processor time", theirs.least / on_one.least, 700),
        Claim("rigid: peak memory of the batch, MB", batch.peak_memory, 300, at_most=True),
    ]
    small = [row for row in rows if row.scene == f"k = {DISKS[-1]:g}" and row.setting == "one call, compiled"]
    if small:
        cost = small[0].least / ours.least
        claims.append(Claim("rigid: cost of k = 1e-5 over that of k = 0.1", cost, 1.7, at_most=True))
    return claims
