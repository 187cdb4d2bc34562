"""Processes of this machine that work side by side, each held by a thread that knows what it is at.

The standard library's pool does not say which task a dead worker had, is broken as a whole by it, and offers no way
to end a worker that hangs. Here a death is the failure of one task, and :meth:`Processes.stop` ends everything at
once.
"""

from __future__ import annotations

import logging
import multiprocessing
import multiprocessing.spawn
import os
import pickle
import queue
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.connection import wait as wait_for_any
from multiprocessing.context import SpawnProcess
from typing import Any

from . import BLAS_THREADS, search_garbage_seldom

_ONE_THREAD = dict.fromkeys((*BLAS_THREADS, "NUMBA_NUM_THREADS"), "1")

_DIED = "its worker process died: out of memory perhaps"
_ONCE = "what is to run once belongs below if __name__ == '__main__'"
_OURS = "hoop-pulse worker"

_READY = b"ready"
"""What a worker sends first: that it has imported what it must."""

_STARTING = threading.Lock()
_LOGGER = logging.getLogger("hoop-pulse")

Task = tuple[Callable[..., Any], tuple[Any, ...]]


class WorkerDied(RuntimeError):
    """The process that had a task is gone, and the task with it."""


class NoWorker(RuntimeError):
    """No worker can begin, for a reason that the next one would have too."""


class Processes:
    """``count`` worker processes; tasks go to whichever is free, in their order.

    Raises
    ------
    RuntimeError
        A worker imports the script that has it, and that would begin anew there.
    """

    def __init__(self, count: int) -> None:
        process = multiprocessing.current_process()
        if getattr(process, "_inheriting", False):
            if process.name == _OURS:
                sys.exit(1)  # without a traceback: who has this worker tells why none begins
            raise RuntimeError(f"Workers import this script: {_ONCE}.")
        self._tasks: queue.SimpleQueue[tuple[Task, Future[Any]] | None] = queue.SimpleQueue()
        self._closing = threading.Event()
        self._workers: dict[int, SpawnProcess] = {}
        self._begun = False
        self._none = _hindrance()
        self._threads = [threading.Thread(target=self._hold, args=(slot,), daemon=True) for slot in range(count)]
        for thread in self._threads:
            thread.start()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Have a worker call an importable function; in the future, a death of the worker is :class:`WorkerDied`, and
        :class:`NoWorker` that there can be none.

        Raises
        ------
        RuntimeError
            The workers have been ended.
        """
        if self._closing.is_set():
            raise RuntimeError("These workers have been ended.")
        future: Future[Any] = Future()
        self._tasks.put(((function, arguments), future))
        return future

    def stop(self) -> None:
        """End the workers now, whatever they are at; what they had is cancelled or dies with them."""
        self._closing.set()
        for _ in self._threads:
            self._tasks.put(None)
        with _STARTING:  # whoever is being started is started, and sees that it is too late
            for worker in self._workers.values():
                worker.kill()
        for thread in self._threads:
            thread.join()

    def _hold(self, slot: int) -> None:
        """One thread's work: hand tasks to one process and its answers to their futures, and replace it if it dies."""
        pipe: Connection | None = None
        while (taken := self._tasks.get()) is not None:
            task, future = taken
            if self._closing.is_set() or not future.set_running_or_notify_cancel():
                future.cancel()
                continue
            try:
                pipe = pipe or self._start(slot)
                pipe.send(task)
                answer, error = self._answer(pipe, self._workers[slot])
            except (WorkerDied, NoWorker) as death:
                pipe, error = None, death
            except OSError:  # it had died before it could be given the task
                pipe, error = None, WorkerDied(_DIED)
            except Exception as unsendable:  # the task or its answer cannot be pickled
                error = unsendable
            if error is not None:
                future.set_exception(error)
            else:
                future.set_result(answer)
        if pipe is not None:
            pipe.close()

    def _start(self, slot: int) -> Connection:
        """A new worker for a slot, once it is ready to work."""
        if self._none:
            raise NoWorker(f"No worker can begin: {self._none}.")
        # spawn: nothing of this process, its threads least of all, is inherited but the environment
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        worker = context.Process(target=_work, name=_OURS, args=(theirs, _LOGGER.level), daemon=True)
        _deaf_to_interrupts()
        with _STARTING, _one_thread():
            if self._closing.is_set():
                raise WorkerDied("the pool is closed")
            try:
                worker.start()
            except OSError as error:  # no more processes, memory or files are allowed, or the current folder is gone
                raise WorkerDied(f"its worker process could not be started: {error.strerror or error}") from None
            self._workers[slot] = worker
        theirs.close()
        if _received(ours, worker) is None:
            # a signal, as of want of memory, may spare the next one, and so may whatever came up since one has begun
            if not self._begun and (worker.exitcode or 0) >= 0:
                self._none = f"each imports this script, and ended in that; {_ONCE}"
                raise NoWorker(f"No worker can begin: {self._none}.")
            raise WorkerDied(_DIED)
        self._begun = True
        return ours

    @staticmethod
    def _answer(pipe: Connection, worker: SpawnProcess) -> tuple[Any, BaseException | None]:
        came = _received(pipe, worker)
        if came is None:
            raise WorkerDied(_DIED)
        try:
            answer: tuple[Any, BaseException | None] = pickle.loads(came)
        except Exception as unreadable:  # an answer whose parts are not to be had here
            return None, unreadable
        return answer


def _received(pipe: Connection, worker: SpawnProcess) -> bytes | None:
    """What a worker sends next; None where it is gone instead."""
    wait_for_any([pipe, worker.sentinel])
    try:
        came = pipe.recv_bytes() if pipe.poll() else None  # also where it died just after it had answered
    except (EOFError, OSError):
        came = None
    if came is None:
        worker.join()
    return came


def _hindrance() -> str:
    """Why no worker could begin, where it is known beforehand: what it imports as the script is no file."""
    script = multiprocessing.spawn.get_preparation_data(_OURS).get("init_main_from_path")
    if script is None or os.path.exists(script):
        return ""
    return f"each imports the script, and there is no file {script}, as of one that is read from stdin"


def _work(pipe: Connection, level: int) -> None:
    """What a worker does: leave interrupts to the parent, end with it even if it is killed, and answer.

    It is as quiet about compiling as its parent, whose logger has that ``level``.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    search_garbage_seldom()
    _LOGGER.setLevel(level)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()
    with suppress(OSError):  # nobody is there any more, and no task comes
        pipe.send_bytes(_READY)
    while True:
        try:
            task = pipe.recv_bytes()
        except (EOFError, OSError):
            return
        try:
            function, arguments = pickle.loads(task)
        except Exception as error:  # the task cannot be unpickled here
            pipe.send((None, error))
            continue
        try:
            answer: tuple[Any, BaseException | None] = (function(*arguments), None)
        except Exception as error:
            answer = (None, error)
        try:
            pipe.send(answer)
        except (EOFError, OSError):
            return
        except Exception as error:  # what came out cannot be pickled
            pipe.send((None, TypeError(f"the answer cannot be sent: {error}")))


def _end_with(sentinel: int) -> None:
    wait_for_any([sentinel])
    os._exit(1)


@contextmanager
def _one_thread() -> Iterator[None]:
    """The environment of a worker started meanwhile: one BLAS thread each, as there is a worker for every core."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(_ONE_THREAD)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _deaf_to_interrupts() -> None:
    """Processes that this thread starts are deaf to Ctrl-C from their first instruction, before they could say so
    themselves.

    The standard library starts its resource tracker with the first of them, and lets interrupts through to this thread
    then: so that is started first.
    """
    if hasattr(signal, "pthread_sigmask"):
        resource_tracker.ensure_running()
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
