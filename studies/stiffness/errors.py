"""What the numerical errors of rungs say of a limit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from rigid import Scene

from .extrapolation.cases import known_alike


class Known(Protocol):
    """A rung that came through."""

    @property
    def contact_stiffness(self) -> float:
        """Its foundation."""

    def error(self, name: str) -> float:
        """Numerical error of a measure."""


def errors_of(rungs: Sequence[Known], name: str, scene: Scene) -> np.ndarray:
    """(rungs,) numerical errors of a measure, as a limit is inferred with them.

    Points of a patch that break one at a time do so in other steps in each run: two that agree do so by chance.
    """
    from flexible.contact.laws.listing import LAWS

    errors = np.array([rung.error(name) for rung in rungs])
    if not LAWS[scene.contact.law].breaks_by_points(scene.friction):
        return errors
    return known_alike([rung.contact_stiffness for rung in rungs], errors)
