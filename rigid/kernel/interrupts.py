"""Signals that come while compiled code runs are answered between its calls.

numba makes the named tuples that a compiled function returns by calling Python, and does not look whether that raised.
A Ctrl-C that came meanwhile raises just there, as that is the first Python to run: the process crashes. So for as long
as a motion is made, signals whose handlers are Python's are noted, and :func:`answer` hands them on where they may
raise. Compilation is Python and may take long: it is interrupted at once.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from .announce import compiling

_handlers: dict[int, Any] = {}  # of signals that wait
_came: list[tuple[int, FrameType | None]] = []


@contextmanager
def between_calls() -> Iterator[None]:
    """Let signals wait for :func:`answer` meanwhile, and answer them at the end.

    Elsewhere than in the main thread, the only one in which Python answers signals, nothing changes; nor within another
    such context.
    """
    if _handlers or threading.current_thread() is not threading.main_thread():
        yield
        return
    try:
        for number in signal.valid_signals():
            handler = signal.getsignal(number)
            if callable(handler):
                _handlers[number] = handler
                signal.signal(number, _note)
        yield
    finally:
        handlers = dict(_handlers)
        _handlers.clear()
        for noted, handler in handlers.items():
            if signal.getsignal(noted) is _note:
                signal.signal(noted, handler)
        came = list(_came)
        _came.clear()  # one that raises ends this; the others are not left for a motion that comes later
        for noted, frame in came:
            handlers[noted](noted, frame)


def answer() -> None:
    """Hand on the signals that came. What their handlers raise is raised here: in the main thread, as ever."""
    while _came and threading.current_thread() is threading.main_thread():
        number, frame = _came.pop(0)
        _handlers[number](number, frame)


def _note(number: int, frame: FrameType | None) -> None:
    if compiling():
        _handlers[number](number, frame)
    else:
        _came.append((number, frame))
