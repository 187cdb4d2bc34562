"""The bending stiffness below which a hoop hops: between neighbours of a map, then by bisection.

Where it hops is told three ways: anywhere between release and end; in the first pulse, the interval of phi in which N
of the rigid hoop to which it tends exceeds the weight; and in that at the bottom, while the contact is under the disk.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import asin, isfinite, pi, sin, sqrt
from typing import Any, Protocol

from rigid import Kind, Run, Scene

from ...plots.sheet import number
from ...running.case import Outcome
from .limit import rigid_motion
from .scaling import duration, suddenness

SYMBOL = "E I/(m g R²)"

WHERE = ("anywhere", "pulse", "bottom")

TOLD = ("t", "phi", "duration", "height", "prominence")
"""Of a hop, in tables."""


@dataclass(frozen=True, slots=True)
class Window:
    """Angles that the disk has come down from its release, between which a lift-off counts."""

    low: float
    high: float


def windows(scene: Scene) -> dict[str, Window | None]:
    """Where a lift-off counts, by name; None is no restriction.

    Without a rigid pulse, or with one that is not over when the run ends, there is only "anywhere". "bottom" is a part
    of "pulse": from k = 0.5 on, where the disk is over the contact wherever it hangs lower than the hoop's centre, it
    is all of it.
    """
    found: dict[str, Window | None] = {"anywhere": None}
    pulses = [pulse for pulse in rigid_motion(scene, Run(until="pulse")).pulses if not pulse.cut]
    if pulses and (scene.run.t_end is None or pulses[0].t_end <= (1 + 1e-9) * scene.run.t_end):
        first, last = (abs(phi - scene.release.phi0) for phi in (pulses[0].phi_start, pulses[0].phi_end))
        found["pulse"] = Window(first, last)
        bottom = abs(pi + 2 * pi * round((pulses[0].phi_start - pi) / (2 * pi)) - scene.release.phi0)
        under = asin(min(scene.hoop.k / (1 - scene.hoop.k), 1.0))  # half the disk as seen from the hoop's centre
        low, high = max(first, bottom - under), min(last, bottom + under)
        if low < high:
            found["bottom"] = Window(low, high)
    return found


def hops_in(motion: Mapping[str, Any], window: Window | None, least: float = 1.0, whole: bool = True) -> bool | None:
    """Whether a roll hops there, of flights at least so prominent; None where it stopped before that was decided.

    In a window the first pass counts, by how far the disk has come down: later ones begin with what vibration the
    first one left. A roll that was not to be ``whole`` decides what the disk has passed.
    """
    for flight in motion["flights"]:
        if flight["prominence"] is not None and flight["prominence"] < least:
            continue
        if window is None or (window.low <= flight["swept"] <= window.high):
            return True
    ended = motion["completed"] and whole
    return False if ended or (window is not None and motion["swept"] > window.high) else None


CLOSE = 1.25
"""Ratio of the ends of a bracket up to which ranges and rules are told of the threshold in it."""


@dataclass(frozen=True, slots=True)
class Bracket:
    """A threshold between two stiffnesses: it hops at ``low`` and not at ``high``."""

    low: float
    """The largest stiffness that hops; 0 where none does."""
    high: float
    """The next larger that does not; infinite where the stiffest hops."""
    open: int = 0
    """Cases between the two that stopped too early to tell."""
    gaps: int = 0
    """How often a larger stiffness hops where a smaller one does not."""

    @property
    def value(self) -> float | None:
        """Their geometric mean, None without both."""
        return sqrt(self.low * self.high) if self.low > 0 and isfinite(self.high) else None

    @property
    def is_close(self) -> bool:
        """Whether its ends are near enough for a rule to be seen in the threshold."""
        return self.value is not None and self.high <= CLOSE * self.low

    @property
    def ends(self) -> str:
        """Its ends in words, with digits enough to tell them and the threshold apart."""
        if self.value is not None:
            return f"{self._digits(self.low)} to {self._digits(self.high)}"
        if self.low > 0:
            return f"still at {self._digits(self.low)}"
        return f"at no stiffness from {self._digits(self.high)} on" if isfinite(self.high) else "undecided"

    def told(self, *doubts: str) -> str:
        """Below which stiffness it hops, between which that lies, and what else there is to doubt."""
        if self.value is None and self.low == 0 and not isfinite(self.high):
            return self.ends
        if self.open:
            doubts = (f"{self.open} undecided{' in between' if self.value is not None else ''}", *doubts)
        if self.gaps:
            doubts = ("not at every softer one", *doubts)
        if self.value is not None:
            between = f"between {self._digits(self.low)} and {self._digits(self.high)}"
            return f"below {self._digits(self.value)} ({', '.join([between, *doubts])})"
        stiffest = [] if self.low == 0 or self.open else ["the stiffest that was rolled"]
        return ", ".join([self.ends, *stiffest, *doubts])

    def _digits(self, stiffness: float) -> str:
        return number(stiffness, self._telling)

    @property
    def _telling(self) -> int:
        """Digits that tell the threshold and the ends of its bracket apart, three at least."""
        known = [each for each in (self.low, self.value, self.high) if each]
        apart = (n for n in range(3, 17) if len({number(each, n) for each in known}) == len(known))
        return next(apart, 17)

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        return {
            "value": self.value,
            "low": self.low or None,
            "high": self.high if isfinite(self.high) else None,
            "undecided_between": self.open,
            "gaps": self.gaps,
        }


def bracket(answers: Mapping[float, bool | None]) -> Bracket:
    """The threshold that answers by stiffness enclose."""
    hopping = [stiffness for stiffness, hops in answers.items() if hops]
    low = max(hopping, default=0.0)
    high = min((s for s, hops in answers.items() if hops is False and s > low), default=float("inf"))
    between = sum(hops is None and low < s < high for s, hops in answers.items())
    decided = [hops for _, hops in sorted(answers.items()) if hops is not None]
    gaps = sum(not one and two for one, two in pairwise(decided))
    return Bracket(low, high, between, gaps)


@dataclass(frozen=True, slots=True)
class HopCase:
    """One roll of the map."""

    bending_stiffness: float
    scene: Scene
    """As it was run."""
    outcome: Outcome
    whole: bool = True
    """Whether it was to roll to the end of the map's run, and not only through the pulse or until all was decided."""

    @property
    def motion(self) -> Mapping[str, Any]:
        """What is known of the motion; of one that failed, that it has no flights and did not come far."""
        return self.outcome.motion or {"flights": [], "completed": False, "swept": 0.0, "scales": None, "t_end": 0.0}

    @property
    def hops(self) -> list[dict[str, Any]]:
        """Flights that are hops."""
        return [f for f in self.motion["flights"] if f["prominence"] is None or f["prominence"] >= 1]

    @property
    def chatter(self) -> int:
        """Number of those that are not."""
        return len(self.motion["flights"]) - len(self.hops)

    @property
    def height(self) -> float | None:
        """Of the highest hop as far as it was rolled; None where the roll stopped early without any."""
        if self.hops or self.motion["completed"]:
            return max((hop["height"] for hop in self.hops), default=0.0)
        return None

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it; ``energy`` is what ring and floor stored just before."""
        hoop = self.scene.hoop
        hops = []
        for hop in self.hops:
            energies = hop["energies"]
            stored = None if energies is None else energies["stored_in_ring"] + energies["stored_in_floor"]
            hops.append({**{key: hop[key] for key in TOLD}, "energy": stored, "energies": energies})
        return {
            "bending_stiffness": self.bending_stiffness,
            "k": hoop.k,
            "mass_ratio": hoop.mass_ratio,
            "foundation": self.scene.contact.stiffness,
            "mu_s": self.scene.friction.mu_s,
            "mu": self.scene.friction.mu,
            "damping": self.scene.contact.damping,
            "hops": hops,
            "chatter": self.chatter,
            "completed": bool(self.motion["completed"]),
            "whole": self.whole,
            "ended": self.outcome.failure or self.outcome.ended,
            "scales": self.motion["scales"],
            "rigid": {"hops": rigid_hops(self.scene)},
        }


def rigid_hops(scene: Scene) -> int:
    """Flights of the rigid hoop to which a scene's tends, over the same time."""
    return sum(phase.kind == Kind.FLIGHT for phase in rigid_motion(scene).phases)


@dataclass(frozen=True, slots=True)
class Line:
    """All rolls at one value of the second key, softest first."""

    value: Any
    """Of the second key; None where there is only one."""
    scene: Scene
    windows: dict[str, Window | None]
    mapped: tuple[HopCase, ...]
    """Those of the map."""
    between: tuple[HopCase, ...] = ()
    """Those of the bisection."""
    finer: tuple[HopCase, ...] = ()
    """The ends of the brackets at a third of the tolerance."""

    def answers(self, where: str, least: float = 1.0, cases: tuple[HopCase, ...] | None = None) -> dict[float, Any]:
        """Whether it hops there, by stiffness."""
        window = self.windows[where]
        rolled = (*self.mapped, *self.between) if cases is None else cases
        return {case.bending_stiffness: hops_in(case.motion, window, least, case.whole) for case in rolled}

    def threshold(self, where: str, least: float = 1.0) -> Bracket:
        """Below which it hops there."""
        return bracket(self.answers(where, least))

    def angles(self, where: str) -> list[float] | None:
        """Of the disk, between which a lift-off counts there, in the order in which it comes to them; None is any."""
        window, release = self.windows[where], self.scene.release.phi0
        down = 1 if sin(release) >= 0 else -1
        return None if window is None else [release + down * swept for swept in (window.low, window.high)]

    def turning(self, where: str) -> float | None:
        """omega_1 t* at the threshold, see :mod:`studies.hop.rolling.scaling`; None without one
        that is closely known, or without a mass.
        """
        found, sudden = self.threshold(where), suddenness(self.scene)
        return sqrt(found.value / sudden) if found.value is not None and found.is_close and sudden > 0 else None

    def times_duration(self, where: str) -> float | None:
        """E I tau^2 at the threshold, E I over m g R^2 and tau, the time of the rigid pulse, over sqrt(R/g); None
        without a threshold that is closely known.
        """
        found, tau = self.threshold(where), duration(self.scene)
        return found.value * tau**2 if found.value is not None and found.is_close and tau is not None else None

    def holds(self, where: str) -> bool | None:
        """Whether a third of the tolerance says the same at both ends of the bracket; None where it does not say."""
        found = self.threshold(where)
        finer = self.answers(where, cases=self.finer)
        said = (finer.get(found.low), finer.get(found.high))
        return None if None in said else said == (True, False)


class Mapped(Protocol):
    """What is drawn of a study."""

    @property
    def scene(self) -> Scene:
        """From which all starts."""

    @property
    def second(self) -> str | None:
        """The key besides the bending stiffness."""

    @property
    def lines(self) -> tuple[Line, ...]:
        """The rolls by its values."""
