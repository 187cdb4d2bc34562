"""The bound on the work of one run."""

from __future__ import annotations

import time


class Bound(Exception):
    """A run went on although it had used up the work it is allowed."""


class Work:
    """Asked in every step, it stops a run that has used up its steps where it is.

    Steps, so that a scene comes out the same on a busy machine; seconds only end what takes no steps.

    Parameters
    ----------
    steps : int
        Of one run.
    seconds : float
        Of processor time in one run, after which :class:`Bound` is raised from within it.
    """

    def __init__(self, steps: int, seconds: float) -> None:
        self.steps = steps
        self.seconds = seconds
        self.first = time.process_time()
        self.renew()

    def renew(self) -> None:
        """For the next run."""
        self.taken = 0
        self.start = time.process_time()

    @property
    def spent(self) -> bool:
        """Whether the run has had all its steps."""
        return self.taken > self.steps

    @property
    def used(self) -> float:
        """Seconds of all runs."""
        return time.process_time() - self.first

    def __call__(self, _: float = 0.0) -> bool:
        self.taken += 1
        if time.process_time() - self.start > self.seconds:
            raise Bound
        return self.spent
