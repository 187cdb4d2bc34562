"""Run time against error: contestants of one scene, timed in turns on one core, and the ratios that are claimed."""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

Clock = Literal["cpu", "wall"]
NAN = float("nan")


@dataclass
class Row:
    """One contestant at one setting.

    ``error`` is against the reference of its scene, ``seconds`` are of one run: processor time where one core works
    (the machine may have other things to do), wall time where several do or a process is started. ``peak_memory`` is
    the largest resident size, in MB, of a process that does this run and nothing else but load the package.
    """

    solver: str
    setting: str
    scene: str
    seconds: list[float]
    error: float = NAN
    peak_memory: float = NAN
    clock: Clock = "cpu"
    note: str = ""
    more: dict[str, float] = field(default_factory=dict)

    @property
    def median(self) -> float:
        """Of the runs, s; NaN of none."""
        return statistics.median(self.seconds) if self.seconds else NAN

    @property
    def least(self) -> float:
        """The quickest run, s; NaN of none."""
        return min(self.seconds, default=NAN)

    def to_dict(self) -> dict[str, Any]:
        """The row as ``--json`` prints it."""
        rest = asdict(self)
        del rest["seconds"], rest["more"]
        most = max(self.seconds, default=NAN)
        times = {"seconds_median": self.median, "seconds_min": self.least, "seconds_max": most}
        return {**rest, **times, "repeats": len(self.seconds), **self.more}


@dataclass
class Claim:
    """A ratio that is stated, and what was measured."""

    name: str
    measured: float
    stated: float
    at_most: bool = False
    why_not: str = ""

    @property
    def holds(self) -> bool:
        """Whether it does; what could not be measured does not count against it."""
        if self.why_not:
            return True
        return self.measured <= self.stated if self.at_most else self.measured >= self.stated

    def to_dict(self) -> dict[str, Any]:
        """The claim as ``--json`` prints it."""
        return {
            "measured": self.measured,
            "stated": self.stated,
            "sense": "at most" if self.at_most else "at least",
            "holds": self.holds,
            "not_measured": self.why_not or None,
        }


@dataclass
class Result:
    """All of one benchmark."""

    rows: list[Row] = field(default_factory=list)
    claims: list[Claim] = field(default_factory=list)
    exponents: dict[str, float] = field(default_factory=dict)
    compared: tuple[str, ...] = ()
    """Entries of ``Row.more`` with a table of their own, and how far ``"NAME off"`` says that they are off."""
    parts: tuple[str, ...] = ()
    """Entries of ``Row.more`` of which the error is made up."""
    told: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """Titles of more tables, and the entries of ``Row.more`` in each; a row is in those of which it has the first."""

    def to_dict(self) -> dict[str, Any]:
        """What ``--json`` prints."""
        return {
            "rows": [row.to_dict() for row in self.rows],
            "ratios": {claim.name: claim.to_dict() for claim in self.claims},
            "exponents": self.exponents,
        }


@dataclass
class Contestant:
    """Something to be timed: ``run`` does the work ``calls`` times over and returns its last answer.

    ``judge`` makes an error, and more numbers if it likes, of an answer. ``prepare`` runs before the clock starts.
    """

    solver: str
    setting: str
    scene: str
    run: Callable[[], Any]
    judge: Callable[[Any], float | tuple[float, dict[str, float]]] = lambda answer: NAN
    calls: int = 1
    clock: Clock = "cpu"
    repeats: int | None = None
    prepare: Callable[[], Any] | None = None
    memory: bool = True


def race(
    contestants: Sequence[Contestant], repeats: int = 5, progress: Callable[[float], None] | None = None
) -> list[Row]:
    """Time the contestants in turns, after one warm-up each; a contestant that fails says so in its row.

    What is to run once only is timed as it warms up.
    """
    rows = []
    for number, entry in enumerate(contestants):
        row = Row(entry.solver, entry.setting, entry.scene, [], clock=entry.clock)
        rows.append(row)
        clock = _clock(entry)
        start = clock()
        try:
            answer = entry.run()
        except Exception as error:
            row.note = " ".join(str(error).split())
            continue
        if entry.repeats == 1:
            row.seconds.append(clock() - start)
        verdict = entry.judge(answer)
        row.error, row.more = verdict if isinstance(verdict, tuple) else (verdict, {})
        if entry.memory:
            row.peak_memory = peak_memory(entry)
        if progress is not None:
            progress(0.5 * (number + 1) / len(contestants))
    for turn in range(repeats):
        for row, entry in zip(rows, contestants, strict=True):
            if row.note or entry.repeats == 1 or turn >= (entry.repeats or repeats):
                continue
            if entry.prepare is not None:
                entry.prepare()
            clock = _clock(entry)
            start = clock()
            for _ in range(entry.calls):
                entry.run()
            row.seconds.append((clock() - start) / entry.calls)
        if progress is not None:
            progress(0.5 + 0.5 * (turn + 1) / repeats)
    return rows


def _clock(entry: Contestant) -> Callable[[], float]:
    return time.process_time if entry.clock == "cpu" else time.perf_counter


def peak_memory(entry: Contestant) -> float:
    """Largest resident size in MB of a forked process that does the run once; NaN where there is no fork."""
    try:
        import resource
    except ImportError:  # Windows
        return NAN
    if not hasattr(os, "fork"):
        return NAN
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.close(reader)
            if entry.prepare is not None:
                entry.prepare()
            entry.run()
            os.write(writer, str(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss).encode())
        finally:
            os._exit(0)
    os.close(writer)
    with os.fdopen(reader) as pipe:
        said = pipe.read()
    os.waitpid(child, 0)
    return int(said) / (1024**2 if sys.platform == "darwin" else 1024) if said else NAN  # bytes there, else kB


def exponent(sizes: Sequence[float], costs: Sequence[float]) -> float:
    """Slope p of cost ~ size^p by least squares on logarithms."""
    import numpy as np

    return float(np.polyfit(np.log(sizes), np.log(costs), 1)[0])


def wall_of(command: Sequence[str]) -> float:
    """Seconds that a process of its own takes.

    Raises
    ------
    RuntimeError
        It failed.
    """
    import subprocess

    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    return time.perf_counter() - start
