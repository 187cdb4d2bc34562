"""Scenes are drawn, run in processes and checked; whatever happens to one is told with the scene."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures import TimeoutError as Late
from dataclasses import dataclass, field
from functools import cache
from itertools import islice
from typing import Any

from rigid import Scene

from ..running.workers import cores
from .checks import Margins, toml

RIGID, FLEXIBLE, CYCLES = "rigid", "flexible", "cycles"
THOROUGH = 5  # one rigid scene in so many is also integrated in time
TWICE = 2  # one flexible scene in so many is run again, mirrored and in SI units
ALL_NODES = 60  # one in so many with all nodes (not with --quick)
CHUNK = 50
CYCLE_COUNT = 1000


@dataclass(frozen=True)
class Amount:
    """How much is drawn, and the bound on the work of a scene in seconds."""

    rigid: int
    flexible: int
    seconds_rigid: float
    seconds_flexible: float


QUICK = Amount(rigid=800, flexible=40, seconds_rigid=20.0, seconds_flexible=1.0)
WHOLE = Amount(rigid=2500, flexible=500, seconds_rigid=20.0, seconds_flexible=5.0)


Watch = Callable[[float], bool]
Check = Callable[[Scene, Watch, int], tuple[Margins, str]]


class Bound(Exception):
    """A scene went on although it had used up the work it is allowed."""


@dataclass(frozen=True)
class Finding:
    """What came of one scene."""

    solver: str
    number: int
    scene: Scene
    ended: str
    seconds: float
    margins: Margins
    crash: str = ""
    cut: bool = False

    @property
    def broken(self) -> dict[str, float]:
        """Checks that failed, and by how much."""
        return {name: value for name, value in self.margins.items() if not value <= 1}

    @property
    def failed(self) -> bool:
        return bool(self.broken or self.crash)

    def text(self) -> str:
        """The failure with its scene, to be run again."""
        what = self.crash or ", ".join(f"{name} by {value:.3g}" for name, value in self.broken.items())
        return f"# {self.solver} scene {self.number}: {what}; it {self.ended or 'did not end'}\n{toml(self.scene)}"


@dataclass
class Report:
    """All of a stress test."""

    seed: int
    findings: list[Finding] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    seconds: float = 0.0

    @property
    def failures(self) -> list[Finding | str]:
        return [*(finding for finding in self.findings if finding.failed), *self.lost]

    def worst(self, solver: str) -> dict[str, tuple[float, int, int]]:
        """By check: the worst margin, how many scenes took it, how many failed it."""
        table: dict[str, tuple[float, int, int]] = {}
        for finding in self.findings:
            if finding.solver == solver:
                for name, value in finding.margins.items():
                    most, count, failed = table.get(name, (0.0, 0, 0))
                    table[name] = max(most, value), count + 1, failed + (not value <= 1)
        return table

    def text(self) -> str:
        """For people."""
        lines = [f"{len(self.findings)} scenes, seed {self.seed}, {self.seconds:.0f} s, {len(self.failures)} failures."]
        for solver in (RIGID, FLEXIBLE, CYCLES):
            mine = [finding for finding in self.findings if finding.solver == solver]
            if not mine:
                continue
            cut = sum(finding.cut for finding in mine)
            stopped = sum(finding.ended.startswith("stopped") for finding in mine)
            slowest = max(finding.seconds for finding in mine)
            lines.append(
                f"\n{solver}: {len(mine)} scenes, {cut} cut at the work bound, "
                f"{stopped} stopped early and said so, slowest {slowest:.2g} s"
            )
            for name, (most, count, failed) in self.worst(solver).items():
                lines.append(f"  {name:20} {count:6} scenes, {failed:3} failed, worst margin {most:.2g}")
        for failure in self.failures:
            lines += ["", failure if isinstance(failure, str) else failure.text().rstrip()]
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """For machines."""
        return {
            "seed": self.seed,
            "scenes": len(self.findings),
            "seconds": self.seconds,
            "margins": {
                solver: {name: {"worst": m, "scenes": n, "failed": f} for name, (m, n, f) in self.worst(solver).items()}
                for solver in (RIGID, FLEXIBLE, CYCLES)
            },
            "failures": [failure if isinstance(failure, str) else failure.text() for failure in self.failures],
        }


class Budget:
    """The work of one scene: asked in every step, it stops a motion that has used up its seconds where it is."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.start = time.process_time()

    @property
    def used(self) -> float:
        return time.process_time() - self.start

    def __call__(self, _: float = 0.0) -> bool:
        if self.used > 3 * self.seconds:
            raise Bound
        return self.used > self.seconds


def _find(solver: str, number: int, scene: Scene, seconds: float, check: Check) -> Finding:
    """Run the checks of a scene; whatever happens is told."""
    budget = Budget(seconds)
    margins: Margins = {}
    ended, crash, cut = "", "", False
    try:
        margins, ended = check(scene, budget, number)
        cut = solver == FLEXIBLE and budget.used > seconds
    except Bound:
        ended, cut = "went on to the work bound", True
    except Exception as error:
        crash = f"{type(error).__name__}: {' '.join(str(error).split())}"
    if solver == RIGID:
        # it has no steps to be stopped at, and must come to its end by itself
        margins = {**margins, "work bound": budget.used / seconds}
    return Finding(solver, number, scene, ended, budget.used, margins, crash, cut)


def run_chunk(kind: str, seed: int, count: int, low: int, high: int, seconds: float, quick: bool) -> list[Finding]:
    """Scenes ``low`` to ``high`` of a sequence of ``count``, in this process."""
    from . import checks, cycles, draws

    if kind == CYCLES:
        return [
            _find(CYCLES, number, scene, seconds, lambda scene, *_: cycles.drift(scene))
            for number, scene in enumerate(cycles.HOOPS.values())
        ]
    if kind == RIGID:
        _warm(RIGID)
        scenes = islice(enumerate(draws.rigid_scenes(count, seed)), low, high)

        def check(scene: Scene, watch: Watch, number: int) -> tuple[Margins, str]:
            return checks.rigid_margins(scene, number % THOROUGH == 0)
    else:
        _warm(FLEXIBLE)
        scenes = islice(enumerate(draws.flexible_scenes(count, seed)), low, high)

        def check(scene: Scene, watch: Watch, number: int) -> tuple[Margins, str]:
            return _flexible(scene, number, quick, watch)

    return [_find(kind, number, scene, seconds, check) for number, scene in scenes]


@cache
def _warm(kind: str) -> None:
    """Load the compiled code, or compile it, before anything is timed."""
    from rigid import load_scene, simulate, solve

    scene = load_scene("paper-3.3-light")
    solve._interpreted_steps = solve.PATIENCE
    simulate(scene)
    if kind == FLEXIBLE:
        from flexible import simulate as simulate_flexible

        for law, mass in (("patch", 0.1), ("brush", 0.1), ("patch", 0.0), ("brush", 0.0)):
            short = scene.replace(hoop={"mass_ratio": mass}, run={"t_end": 1e-3}, contact={"law": law})
            simulate_flexible(short.replace(solve={"resolve": "all"}))


def _flexible(scene: Scene, number: int, quick: bool, watch: Watch) -> tuple[Margins, str]:
    from . import flexible

    margins, ended = flexible.flexible_margins(scene, number % TWICE == 0, watch)
    if not quick and number % ALL_NODES == 0 and not watch(0.0):
        coarse = scene.replace(solve={"rtol": max(scene.solve.rtol, 1e-3), "elements": min(scene.solve.elements, 72)})
        margins |= flexible.against_all_nodes(coarse, watch)
    return margins, ended


def run_stress(
    scenes: int | None = None, seed: int = 0, quick: bool = False, progress: Callable[[float], None] | None = None
) -> Report:
    """Draw, run and check.

    Parameters
    ----------
    scenes : int, optional
        How many; five in six are rigid.
    seed : int
        Of the sequence.
    quick : bool
        Within a minute on two cores.
    progress : callable, optional
        Told the fraction done.
    """
    amount = QUICK if quick else WHOLE
    if scenes is not None:
        flexible = max(scenes // 6, 1)
        amount = Amount(max(scenes - flexible, 1), flexible, amount.seconds_rigid, amount.seconds_flexible)
    start = time.perf_counter()
    report = Report(seed)
    tasks = [(CYCLES, seed, 0, 0, 0, 60.0, quick)]
    step = max(1, min(CHUNK, amount.flexible // 8))
    tasks += [
        (FLEXIBLE, seed, amount.flexible, low, min(low + step, amount.flexible), amount.seconds_flexible, quick)
        for low in range(0, amount.flexible, step)
    ]
    tasks += [
        (RIGID, seed, amount.rigid, low, min(low + CHUNK, amount.rigid), amount.seconds_rigid, quick)
        for low in range(0, amount.rigid, CHUNK)
    ]
    # spawn: nothing of this process is inherited
    executor = ProcessPoolExecutor(cores(), multiprocessing.get_context("spawn"))
    try:
        futures = [executor.submit(run_chunk, *task) for task in tasks]
        for number, (future, task) in enumerate(zip(futures, tasks, strict=True)):
            kind, _, _, low, high, seconds, _ = task
            try:
                # a chunk may have to wait for those before it
                report.findings += future.result(timeout=300 + 3 * (high - low) * seconds)
            except Late:
                report.lost.append(f"# {kind} scenes {low} to {high}, seed {seed}: they hang")
                break
            if progress is not None:
                progress((number + 1) / len(tasks))
    finally:
        workers = list((getattr(executor, "_processes", None) or {}).values())
        executor.shutdown(wait=False, cancel_futures=True)
        if report.lost:
            for worker in workers:
                worker.kill()
    report.seconds = time.perf_counter() - start
    return report
