"""What a long run will take, told from its first cases."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .case import Outcome

if TYPE_CHECKING:
    from .store import Store

FIRST = 12
"""Cases for each worker from which the rest is told: with fewer, compiling and starting would be all of it."""

WORTH = 20.0
"""Seconds below which nothing is said of what is left."""


class Estimate:
    """Time and bytes of the cases still to run, once the first of them are done."""

    def __init__(self, count: int, workers: int, store: Store | None) -> None:
        self.count = count
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
        return f"By the first {self.done} cases, the other {left} take some {duration(rest)}{grown}."


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
