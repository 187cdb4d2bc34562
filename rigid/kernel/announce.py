"""Compiling is told while it lasts, and its seconds are nobody's run time.

It is told as a warning of the logger ``hoop-pulse``: on stderr where nothing else was arranged, in a script or a pipe
as on a terminal.
"""

from __future__ import annotations

import gc
import logging
import threading
import time
from functools import cache
from typing import Any

SOLVERS = ("rigid", "flexible")

_SELDOM = 10_000
"""New objects between two searches for garbage while compiling. Most of what it makes lives until it is done: after
every 700, as Python up to 3.12 has it (2000 from 3.13 on), a tenth of the time goes into finding that."""

_logger = logging.getLogger("hoop-pulse")
_told: set[str] = set()
_thread = threading.local()
_before: list[tuple[int, ...]] = []  # how often garbage was searched for


@cache
def tell() -> None:
    """From now on, say when a kernel of this project is being compiled."""
    from numba.core import event

    class Listener(event.Listener):
        """Told by numba at the beginning and end of each function that it compiles and does not find on disk."""

        def on_start(self, happening: Any) -> None:
            module = happening.data["dispatcher"].py_func.__module__ or ""  # none of what was made by exec
            _begin(module.partition(".")[0])

        def on_end(self, happening: Any) -> None:
            _end()

    event.register("numba:compile", Listener())


def is_told(package: str) -> None:
    """That this package is being compiled is told by another process."""
    _told.add(package)


def _begin(package: str) -> None:
    """A function is being compiled, perhaps as a part of another one."""
    depth = getattr(_thread, "depth", 0)
    ours = getattr(_thread, "ours", False)
    if depth == 0:
        _thread.ours = ours = package in SOLVERS
        _thread.start = time.perf_counter()
        _search_seldom()
    _thread.depth = depth + 1
    if depth == 0 and ours and package not in _told:
        from .store import keeps, user_cache

        _told.add(package)
        folder, trouble = user_cache()
        _logger.warning(
            "hoop: compiling a part of the %s solver for this machine, once: 10 to 40 s, or more if it is busy.%s",
            package,
            f" Kept in {folder}{f', as {trouble}' if trouble else ''}." if keeps() else "",
        )


def _end() -> None:
    _thread.depth -= 1
    if _thread.depth == 0:
        _search_as_before()
    if _thread.depth == 0 and _thread.ours:
        _thread.seconds = compile_seconds() + time.perf_counter() - _thread.start


def _search_seldom() -> None:
    often, *later = gc.get_threshold()
    if 0 < often < _SELDOM:
        _before.append((often, *later))
        gc.set_threshold(_SELDOM, *later)


def _search_as_before() -> None:
    if _before:
        gc.set_threshold(*_before.pop())


def compiling() -> bool:
    """Whether this thread compiles kernels now."""
    return getattr(_thread, "depth", 0) > 0


def compile_seconds() -> float:
    """Seconds that this thread has spent compiling kernels so far."""
    return getattr(_thread, "seconds", 0.0)


def running_clock() -> float:
    """A clock that stands still while this thread compiles kernels."""
    return time.perf_counter() - compile_seconds()
