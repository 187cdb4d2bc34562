"""Cases run, kept in a folder as they come, and not run twice."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from pathlib import Path

from .case import Case, Outcome
from .estimate import Estimate
from .store import Store
from .workers import Pool, run_all


def run_cases(
    cases: Iterable[Case],
    pool: Pool,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
    forget: bool = False,
    say: Callable[[str], None] | None = None,
) -> list[Outcome]:
    """Outcomes of cases, in their order; those that the folder ``out`` has already are not run again.

    A case that failed before is tried again, and so is one whose result is damaged. Each outcome is kept as it comes,
    so an interruption loses no more than the cases in flight. With ``forget`` histories and motions stay in the folder
    and do not come back: a sweep may have more of them than memory. ``say`` is told, in sentences, what was found
    damaged and, after the first cases, what the rest will take.
    """
    keyed = [(case.key, case) for case in cases]
    say = say or (lambda sentence: None)
    store = Store(out) if out is not None else None
    found: dict[str, Outcome] = {}
    if store is not None:
        found, damaged = store.find((key for key, _ in keyed), histories=not forget)
        if forget:
            found = {key: _light(outcome) for key, outcome in found.items()}
        if damaged:
            say(f"{len(damaged)} damaged {'result' if len(damaged) == 1 else 'results'} in {out}: run again.")
    missing = {key: case for key, case in keyed if key not in found}  # the same scene twice runs once
    total = len(found) + len(missing)
    estimate = Estimate(len(missing), pool.workers(), store)

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
