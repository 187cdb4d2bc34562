"""Scenes are drawn, run in processes and checked; whatever happens to one is told with the scene."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from concurrent.futures import TimeoutError as Late
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import islice
from typing import Any

from rigid import Scene
from rigid.batch.cores import cores

from ..machine.processes import Processes, WorkerDied
from .checks import Checked, Margins, toml
from .work import Bound, Work

RIGID, FLEXIBLE, SOFT, HOSTILE, CYCLES = "rigid", "flexible", "soft", "hostile", "cycles"
KINDS = (RIGID, FLEXIBLE, SOFT, HOSTILE, CYCLES)
THOROUGH = 5  # one rigid scene in so many is also integrated in time
TWICE = 2  # one flexible scene in so many is run again, mirrored and in SI units
ALL_NODES = 60  # one in so many with all nodes (not with --quick)
CHUNK = 50
HANGS = 60.0  # seconds of processor time in one run that takes no steps, or none that are counted
MOST_STEPS = 50_000  # of a soft scene, as many as any run takes by itself
ENOUGH = 0.8  # of the flexible scenes within the range of the model come to their end


@dataclass(frozen=True)
class Amount:
    """How many scenes are drawn, and the bound on the work of each: seconds, or steps of a run."""

    rigid: int
    flexible: int
    hostile: int
    seconds_rigid: float = 20.0
    steps: int = 12_000
    steps_hostile: int = 5_000
    soft: int = 0


QUICK = Amount(rigid=800, flexible=24, hostile=16, steps=5_000, steps_hostile=1_000)
WHOLE = Amount(rigid=2500, flexible=300, hostile=200)

Check = Callable[[Scene, Work, int], Checked]


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
    completed: bool = True

    @property
    def reason(self) -> str:
        """Why it was not run to its end, its numbers left out; empty where it was."""
        if self.completed:
            return ""
        return "cut at the work bound" if self.cut else re.sub(r"-?\d[\d.]*(e[-+]?\d+)?", "#", self.ended)

    @property
    def broken(self) -> dict[str, float]:
        """Checks that failed, and by how much."""
        return {name: value for name, value in self.margins.items() if not value <= 1}

    @property
    def failed(self) -> bool:
        """Whether a check failed or the run broke down."""
        return bool(self.broken or self.crash)

    def text(self) -> str:
        """The failure with its scene, to be run again."""
        what = self.crash or ", ".join(f"{name} by {value:.3g}" for name, value in self.broken.items())
        return f"# {self.solver} scene {self.number}: {what}; {self.ended or 'it did not end'}\n{toml(self.scene)}"


@dataclass
class Report:
    """All of a stress test."""

    seed: int
    findings: list[Finding] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    seconds: float = 0.0

    @property
    def failures(self) -> list[Finding | str]:
        """What failed, and the scenes whose worker was lost, in words."""
        return [*(finding for finding in self.findings if finding.failed), *self.lost]

    def of(self, solver: str) -> list[Finding]:
        """What came of that solver's scenes."""
        return [finding for finding in self.findings if finding.solver == solver]

    def completed(self, solver: str) -> float | None:
        """Share of the scenes that were run to their end; None where none were drawn."""
        mine = self.of(solver)
        return sum(finding.completed for finding in mine) / len(mine) if mine else None

    def reasons(self, solver: str) -> dict[str, list[int]]:
        """The scenes that were not, by reason, the commonest first."""
        found: dict[str, list[int]] = {}
        for finding in self.of(solver):
            if finding.reason:
                found.setdefault(finding.reason, []).append(finding.number)
        return dict(sorted(found.items(), key=lambda entry: -len(entry[1])))

    def worst(self, solver: str) -> dict[str, tuple[float, int, int]]:
        """By check: the worst margin, how many scenes took it, how many failed it."""
        table: dict[str, tuple[float, int, int]] = {}
        for finding in self.of(solver):
            for name, value in finding.margins.items():
                most, count, failed = table.get(name, (0.0, 0, 0))
                table[name] = max(most, value), count + 1, failed + (not value <= 1)
        return table

    def text(self) -> str:
        """For people."""
        lines = [f"{len(self.findings)} scenes, seed {self.seed}, {self.seconds:.0f} s, {len(self.failures)} failures."]
        for solver in KINDS:
            mine = self.of(solver)
            if not mine:
                lines.append(f"\n{solver}: none drawn")
                continue
            slowest = max(finding.seconds for finding in mine)
            whole = sum(finding.completed for finding in mine)
            lines.append(f"\n{solver}: {len(mine)} scenes, {whole} run to their end, slowest {slowest:.2g} s")
            for reason, scenes in self.reasons(solver).items():
                lines.append(f"  {len(scenes)} not: {reason} ({', '.join(map(str, scenes))})")
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
            "completed": {solver: self.completed(solver) for solver in KINDS},
            "not_completed": {solver: self.reasons(solver) for solver in KINDS},
            "margins": {
                solver: {name: {"worst": m, "scenes": n, "failed": f} for name, (m, n, f) in self.worst(solver).items()}
                for solver in KINDS
            },
            "failures": [failure if isinstance(failure, str) else failure.text() for failure in self.failures],
        }


def _find(solver: str, number: int, scene: Scene, work: Work, check: Check) -> Finding:
    """Run the checks of a scene; whatever happens is told."""
    try:
        with work.alarm():
            found, crash = check(scene, work, number), ""
    except Bound:
        found, crash = Checked({}, "went on to the work bound", False, True), ""
    except Exception as error:
        found, crash = Checked({}, "", False), f"{type(error).__name__}: {' '.join(str(error).split())}"
    margins = found.margins
    if solver == RIGID:
        # it has no steps to be stopped at, and must come to its end by itself
        margins = {**margins, "work bound": work.used / work.seconds}
    return Finding(solver, number, scene, found.ended, work.used, margins, crash, found.cut, found.completed)


@dataclass(frozen=True)
class Task:
    """Scenes ``low`` to ``high`` of a sequence of ``count``, each with a bound on its work."""

    kind: str
    seed: int
    count: int = 0
    low: int = 0
    high: int = 0
    steps: int = 0
    seconds: float = HANGS
    all_nodes: bool = False


def run_chunk(task: Task) -> list[Finding]:
    """The scenes of a task, in this process."""
    from . import checks, cycles, draws, flexible

    def rigid_check(scene: Scene, _: Work, number: int) -> Checked:
        return checks.rigid_margins(scene, number % THOROUGH == 0)

    def flexible_check(scene: Scene, work: Work, number: int) -> Checked:
        found = flexible.flexible_margins(scene, number % TWICE == 0, work)
        if task.all_nodes and number % ALL_NODES == 0 and found.completed:
            coarse = scene.replace(
                solve={"rtol": max(scene.solve.rtol, 1e-3), "elements": min(scene.solve.elements or 72, 72)}
            )
            return found._replace(margins=found.margins | flexible.against_all_nodes(coarse, work))
        return found

    draw, check = {
        CYCLES: (lambda *_: iter(cycles.HOOPS.values()), lambda scene, *_: cycles.drift(scene)),
        RIGID: (draws.rigid_scenes, rigid_check),
        FLEXIBLE: (draws.flexible_scenes, flexible_check),
        SOFT: (draws.soft_scenes, flexible_check),
        HOSTILE: (draws.hostile_scenes, flexible_check),
    }[task.kind]
    _warm(RIGID if task.kind in (RIGID, CYCLES) else FLEXIBLE)
    scenes = islice(enumerate(draw(task.count, task.seed)), task.low, task.high or None)
    return [_find(task.kind, number, scene, Work(task.steps, task.seconds), check) for number, scene in scenes]


@cache
def _warm(kind: str) -> None:
    """Load the compiled code, or compile it, before anything is timed."""
    from rigid import load_scene, simulate
    from rigid.kernel.compile import patience

    scene = load_scene("paper-3.3-light")
    patience.renew(0)
    simulate(scene)
    if kind == FLEXIBLE:
        from flexible import simulate as simulate_flexible

        for mass in (0.1, 0.0):  # all friction laws are one compiled function
            short = scene.replace(hoop={"mass_ratio": mass}, run={"t_end": 1e-3})
            for level in ("reduced", "chain"):
                simulate_flexible(short.replace(solve={"resolve": "all", "level": level}))


def run_stress(
    scenes: int | None = None,
    seed: int = 0,
    quick: bool = False,
    progress: Callable[[float], None] | None = None,
    soft: int = 0,
) -> Report:
    """Draw, run and check.

    Parameters
    ----------
    scenes : int, optional
        How many; five in six are rigid, two thirds of the others within the range of the flexible model.
    seed : int
        Of the sequence.
    quick : bool
        Fewer scenes, with fewer steps each: a few minutes on two cores.
    progress : callable, optional
        Told the fraction done.
    soft : int
        So many more, of any stiffness, at the default level and tolerance.
    """
    amount = QUICK if quick else WHOLE
    if scenes is not None:
        flexible, hostile = max(scenes // 9, 1), scenes // 18
        amount = replace(amount, rigid=max(scenes - flexible - hostile, 1), flexible=flexible, hostile=hostile)
    amount = replace(amount, soft=soft)
    start = time.perf_counter()
    report = Report(seed)
    tasks = [Task(CYCLES, seed)]
    for kind, count, steps, seconds in (
        (FLEXIBLE, amount.flexible, amount.steps, HANGS),
        (SOFT, amount.soft, MOST_STEPS, HANGS),
        (HOSTILE, amount.hostile, amount.steps_hostile, HANGS),
        (RIGID, amount.rigid, 0, amount.seconds_rigid),
    ):
        step = CHUNK if kind == RIGID else max(1, min(CHUNK, count // 8))
        for low in range(0, count, step):
            nodes = kind == FLEXIBLE and not quick
            tasks.append(Task(kind, seed, count, low, min(low + step, count), steps, seconds, nodes))
    processes = Processes(cores())
    try:
        futures = [processes.submit(run_chunk, task) for task in tasks]
        for number, (future, task) in enumerate(zip(futures, tasks, strict=True)):
            where = f"# {task.kind} scenes {task.low} to {task.high}, seed {seed}"
            try:
                # a chunk may have to wait for those before it
                report.findings += future.result(timeout=300 + 3 * (task.high - task.low) * task.seconds)
            except WorkerDied:
                report.lost.append(f"{where}: their process died")
            except Late:
                report.lost.append(f"{where}: they hang")
                break
            if progress is not None:
                progress((number + 1) / len(tasks))
    finally:
        processes.stop()
    report.seconds = time.perf_counter() - start
    return report
