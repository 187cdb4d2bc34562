"""The bound on the work of one run."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flexible import FlexibleMotion


class Bound(Exception):
    """A run went on although it had used up the work it is allowed."""


class Work:
    """What a run may take.

    Steps, so that a scene comes out the same on a busy machine; seconds only end what takes no steps.

    Parameters
    ----------
    steps : int
        Of one run, which ends with them.
    seconds : float
        Of processor time in one run; told of every step, it raises :class:`Bound` after that.
    """

    def __init__(self, steps: int, seconds: float) -> None:
        self.steps = steps
        self.seconds = seconds
        self.first = time.process_time()
        self.renew()

    def renew(self) -> None:
        """For the next run."""
        self.start = time.process_time()

    def cuts(self, motion: FlexibleMotion) -> bool:
        """Whether a run has had all its steps and is not over."""
        return not motion.completed and motion.steps >= self.steps

    @property
    def used(self) -> float:
        """Seconds of all runs."""
        return time.process_time() - self.first

    def __call__(self, _: float = 0.0) -> None:
        if time.process_time() - self.start > self.seconds:
            raise Bound
