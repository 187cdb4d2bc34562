"""The bound on the work of one run."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flexible import FlexibleMotion


class Bound(Exception):
    """A run went on although it had used up the work it is allowed."""


class Work:
    """What a run may take.

    Steps, so that a scene comes out the same on a busy machine; seconds only end what takes no steps, and within
    :meth:`alarm` that which takes none that it tells of, too.

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

    @contextmanager
    def alarm(self) -> Iterator[None]:
        """Raise :class:`Bound` in whatever runs inside once its run has used up its seconds.

        Where the system has no timer of processor time, or outside the main thread, only what is told of is bounded.
        """
        if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
            yield
            return

        def over(*_: Any) -> None:
            left = self.seconds - (time.process_time() - self.start)
            if left <= 0:
                raise Bound
            signal.setitimer(signal.ITIMER_PROF, left + 1e-3)

        before = signal.signal(signal.SIGPROF, over)
        signal.setitimer(signal.ITIMER_PROF, self.seconds + 1e-3)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            signal.signal(signal.SIGPROF, before)

    def __call__(self, _: float = 0.0) -> None:
        if time.process_time() - self.start > self.seconds:
            raise Bound
