"""Cases run, kept in a folder as they come, and not run twice."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from pathlib import Path

from .case import Case, Outcome
from .store import Store
from .workers import Pool, run_all

FIRST = 12
"""Cases for each worker from which the rest is told: with fewer, compiling and starting would be all of it."""

WORTH = 20.0
"""Seconds below which nothing is said of what is left."""


def run_cases(
    cases: Iterable[Case],
    pool: Pool,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
    forget: bool = False,
    say: Callable[[str], None] | None = None,
    part: str = "",
) -> list[Outcome]:
    """Outcomes of cases, in their order; those that the folder ``out`` has already are not run again.

    A case that failed before is tried again, and so is one whose result is damaged. Each outcome is kept as it comes,
    so an interruption loses no more than the cases in flight. With ``forget`` histories and motions stay in the folder
    and do not come back: a sweep may have more of them than memory. ``say`` is told, in sentences, what was found
    damaged and, after the first cases, what the rest will take: of a ``part`` (" of the map"), where more are to come.
    """
    keyed = [(case.key, case) for case in cases]
    say = say or (lambda sentence: None)
    store = Store(out) if out is not None else None
    found: dict[str, Outcome] = {}
    if store is not None:
        found, damaged = store.find((key for key, _ in keyed), not forget, _light if forget else None)
        if damaged:
            say(f"{len(damaged)} damaged {'result' if len(damaged) == 1 else 'results'} in {out}: run again.")
    missing = {key: case for key, case in keyed if key not in found}  # the same scene twice runs once
    total = len(found) + len(missing)
    estimate = Estimate(len(missing), pool.workers(), store, part)

    def told() -> None:
        if progress is not None:
            progress(len(found) / max(1, total))

    told()
    for case, outcome in run_all(missing.values(), pool):
        if store is not None:
            store.add(outcome)
        found[case.key] = _light(outcome) if forget else outcome
        if (sentence := estimate.after(outcome)) is not None:
            say(sentence)
        told()
    return [found[key] for key, _ in keyed]


def _light(outcome: Outcome) -> Outcome:
    return dataclasses.replace(outcome, histories=(), motion={})


class Estimate:
    """Time and bytes of the cases still to run, once the first of them are done."""

    def __init__(self, count: int, workers: int, store: Store | None, part: str = "") -> None:
        self.count = count
        self.part = part
        self.workers = workers
        self.store = store
        self.done = 0
        self.first = min(FIRST * workers, max(count // 2, 1))
        self.before = store.size() if store is not None else 0
        self.seconds: list[float] = []

    def after(self, outcome: Outcome) -> str | None:
        """A sentence when enough cases are done to tell and enough are left to be worth it, otherwise None."""
        self.done += 1
        if self.done > self.first:
            return None
        self.seconds.append(outcome.seconds)
        left = self.count - self.done
        if self.done < self.first or not left:
            return None
        # each worker's dearest case is left out: its first one loads the solver, or compiles it
        warm = sorted(self.seconds)[: -self.workers] or self.seconds
        rest = left * sum(warm) / len(warm) / self.workers
        if rest < WORTH:
            return None
        grown = "" if self.store is None else f" and {_bytes((self.store.size() - self.before) / self.done * left)}"
        return f"By the first {self.done} cases, the other {left}{self.part} take some {duration(rest)}{grown}."


def duration(seconds: float) -> str:
    """A time in the unit that people would use."""
    for unit, size in (("days", 86_400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 1.5 * size:
            return f"{_round(seconds / size)} {unit}"
    return f"{_round(seconds)} seconds"


def _bytes(count: float) -> str:
    for unit, size in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if count >= size:
            return f"{_round(count / size)} {unit}"
    return f"{max(count / 1e3, 1):.0f} kB"


def _round(value: float) -> str:
    return f"{value:.0f}" if value >= 10 else f"{value:.1f}"
