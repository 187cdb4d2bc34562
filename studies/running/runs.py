"""Cases run, kept in a folder as they come, and not run twice."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from pathlib import Path

from .case import Case, Outcome
from .store import Store
from .workers import Pool, run_all


def run_cases(
    cases: Iterable[Case],
    pool: Pool,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
    forget: bool = False,
) -> list[Outcome]:
    """Outcomes of cases, in their order; those that the folder ``out`` has already are not run again.

    A case that failed before is tried again. Each outcome is kept as it comes, so an interruption loses no
    more than the cases in flight. With ``forget`` the histories stay in the folder and do not come back: a
    sweep may have more of them than memory.
    """
    cases = list(cases)
    store = Store(out) if out is not None else None
    found: dict[str, Outcome] = {}
    done = store.done() if store is not None else set()
    for case in cases:
        if case.key in done and store is not None and (kept := store.get(case.key, not forget)) is not None:
            found[case.key] = kept
    total = len({case.key for case in cases})
    missing = {case.key: case for case in cases if case.key not in found}  # the same scene twice runs once

    def told() -> None:
        if progress is not None:
            progress(len(found) / max(1, total))

    told()
    for case, outcome in run_all(missing.values(), pool):
        if store is not None:
            store.add(outcome)
        found[case.key] = dataclasses.replace(outcome, histories=()) if forget else outcome
        told()
    return [found[case.key] for case in cases]
