"""A row: a number from outside, ours, and how far apart they may be for a reason that is given."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, nan
from typing import Any


@dataclass(frozen=True, slots=True)
class Row:
    """Something that somebody else has found or that can be proved, and what the solvers make of it."""

    source: str
    """Who says so; "derived" with the section of the theory where it follows from the equations of motion."""
    what: str
    """Which quantity of which hoop."""
    value: float | str | None
    """The value there, or words such as a sequence of phases; None where no number could be had."""
    ours: float | str | None
    """What the solvers find."""
    within: float = 0.0
    """The largest difference that the reason below allows."""
    why: str = ""
    """Why that much, or what is known about a difference."""
    instead: tuple[float, float] | None = None
    """Where the source's value does not hold: what an independent derivation puts in its place, and to how much."""

    @property
    def difference(self) -> float:
        """Ours less the source's; NaN of words."""
        if isinstance(self.value, str) or isinstance(self.ours, str) or self.value is None or self.ours is None:
            return nan
        return self.ours - self.value

    @property
    def verdict(self) -> str:
        """ "pass" or "fail"; "differs" where ours is the independent value and not the source's; "no number"."""
        if self.value is None or self.ours is None:
            return "no number"
        if isinstance(self.value, str) or isinstance(self.ours, str):
            return "pass" if self.value == self.ours else "fail"
        if abs(self.difference) <= self.within:
            return "pass"
        if self.instead is not None and abs(self.ours - self.instead[0]) <= self.instead[1]:
            return "differs"
        return "fail"

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        told = {name: getattr(self, name) for name in ("source", "what", "value", "ours", "within", "why", "instead")}
        difference = self.difference if isfinite(self.difference) else None
        return {**told, "difference": difference, "verdict": self.verdict}
