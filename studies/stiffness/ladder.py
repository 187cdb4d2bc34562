"""A ladder of stiffness: which of the two stiffnesses of a scene is raised, from where to where."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import TypeVar

import numpy as np

from rigid import Scene, SceneError, SceneLike, as_scene
from rigid.allowed import require, require_choice, require_whole

T = TypeVar("T")

ALONG = ("both", "contact", "bending")
BELOW, ABOVE = 1e-2, 1e4
"""Softest and stiffest rung over a scene's own stiffness, where a ladder does not say them."""


@dataclass(frozen=True, slots=True)
class Ladder:
    """Rungs spaced evenly in the logarithm.

    Parameters
    ----------
    along : {"both", "contact", "bending"}
        Raise the contact foundation, the ring's bending stiffness, or both in the ratio they have in the
        scene.
    low, high : float, optional
        Foundation (or, along "bending", bending stiffness) of the softest and the stiffest rung; by default those of
        six decades, from two below the scene's own stiffness to four above it.
    count : int
        Number of rungs, at least 2.

    Raises
    ------
    SceneError
        What no ladder can have.
    """

    along: str = "both"
    low: float | None = None
    high: float | None = None
    count: int = 9

    def __post_init__(self) -> None:
        require_choice("along", self.along, ALONG)
        for end in ("low", "high"):
            if getattr(self, end) is not None:
                stiffness = require(end, getattr(self, end), 0, inf, "a stiffness is above 0", open_low=True)
                object.__setattr__(self, end, stiffness)
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise SceneError(f"The range {self.low:g} to {self.high:g} is not possible: it runs upward.")
        object.__setattr__(self, "count", require_whole("count", self.count, 2, 1000))

    def around(self, scene: SceneLike) -> Ladder:
        """The same ladder with both ends: those that it does not say are the scene's."""
        scene = as_scene(scene)
        own = scene.ring.bending_stiffness if self.along == "bending" else scene.contact.stiffness
        low, high = (own * BELOW if self.low is None else self.low), (own * ABOVE if self.high is None else self.high)
        return replace(self, low=low, high=high)

    @property
    def stiffness(self) -> np.ndarray:
        """(count,) what is raised, dimensionless."""
        if self.low is None or self.high is None:
            raise SceneError(
                "A ladder without low or high has these from a scene: ladder.around(scene) is one of both."
            )
        return np.geomspace(self.low, self.high, self.count)

    @property
    def label(self) -> str:
        """What is raised, in words."""
        return "bending stiffness EI/(mgR²)" if self.along == "bending" else "contact foundation ε_n R²/(mg)"

    @property
    def formula(self) -> str:
        """The same for the axis of a figure."""
        return (
            r"bending stiffness $EI/(mgR^2)$"
            if self.along == "bending"
            else r"contact foundation $\varepsilon_n R^2/(mg)$"
        )

    @property
    def raised(self) -> str:
        """The same in a word or two."""
        return "bending stiffness" if self.along == "bending" else "foundation"

    def rungs(self, scene: Scene) -> list[Scene]:
        """The scene at every rung, softest first; what else the friction law ties to the foundation goes with it.

        All rungs have one mesh around the ring: what it leaves then falls with what the ring gives way by, as the
        distance from the rigid hoop does, and is no step along the ladder.
        """
        from flexible.contact.laws.listing import LAWS
        from flexible.ring.choice import AROUND

        law = LAWS[scene.contact.law]
        ratio = scene.ring.bending_stiffness / scene.contact.stiffness
        rungs = []
        for s in self.around(scene).stiffness.tolist():
            ring = {"both": s * ratio, "contact": scene.ring.bending_stiffness, "bending": s}[self.along]
            foundation = scene.contact.stiffness if self.along == "bending" else s
            tied = law.stiffened(scene.contact, foundation / scene.contact.stiffness)
            rungs.append(
                scene.replace(
                    ring={"bending_stiffness": ring},
                    contact={"stiffness": foundation, **tied},
                    solve={"elements": scene.solve.elements or AROUND},
                )
            )
        return rungs


def spread(rungs: Sequence[T], most: int = 5) -> list[T]:
    """At most so many of the rungs, which are drawn: evenly from the first to the last."""
    if len(rungs) <= most:
        return list(rungs)
    return [rungs[round(i)] for i in np.linspace(0, len(rungs) - 1, most)]
