"""Cases run side by side: on this machine's cores, or on a Dask cluster, through the same futures."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.connection import wait as wait_for_end
from typing import Protocol

from rigid import scene_to_dict

from .case import Case, Outcome, run_case
from .files import StudyError, plain
from .solvers import version

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")

_DEATHS = 3
"""A case whose worker has died this often is not tried again."""


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Pool(Protocol):
    """Where cases run."""

    def submit(self, case: Case) -> Future[Outcome]: ...

    def room(self) -> int:
        """How many cases to keep in flight."""
        ...

    def mend(self) -> None:
        """Start again after a worker has died and taken the pool with it."""
        ...


class Here:
    """In this process, one after the other."""

    def submit(self, case: Case) -> Future[Outcome]:
        future: Future[Outcome] = Future()
        future.set_result(run_case(case))
        return future

    def room(self) -> int:
        return 1

    def mend(self) -> None:
        pass


class Processes:
    """In processes of this machine, each on one core."""

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self.executor = self._start()

    def _start(self) -> ProcessPoolExecutor:
        # spawn: nothing of this process, its threads least of all, is inherited but the environment
        executor = ProcessPoolExecutor(self.workers, multiprocessing.get_context("spawn"), initializer=_be_a_worker)
        with _one_thread(), _deaf_to_interrupts():
            executor.submit(os.getpid)  # the first task starts all the processes
        return executor

    def submit(self, case: Case) -> Future[Outcome]:
        return self.executor.submit(run_case, case)

    def room(self) -> int:
        return 2 * self.workers

    def mend(self) -> None:
        self.stop()
        self.executor = self._start()

    def stop(self) -> None:
        """End the workers now, whatever they are at."""
        workers = list((getattr(self.executor, "_processes", None) or {}).values())
        self.executor.shutdown(wait=False, cancel_futures=True)
        for worker in workers:
            worker.kill()


class Cluster:
    """On a Dask cluster, which itself moves the cases of a dead worker to another one."""

    def __init__(self, address: str) -> None:
        try:
            from distributed import Client
        except ImportError:
            raise StudyError("--scheduler needs Dask: pip install 'hoop-pulse[cluster]'.") from None
        try:
            self.client = Client(address, timeout="20s", set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise StudyError(f"There is no Dask scheduler at {address}: {' '.join(str(error).split())}.") from None
        self.executor: Executor = self.client.get_executor(pure=False)

    def submit(self, case: Case) -> Future[Outcome]:
        return self.executor.submit(run_case, case)

    def room(self) -> int:
        return max(4, 2 * sum(self.client.nthreads().values()))

    def mend(self) -> None:
        pass

    def stop(self) -> None:
        self.executor.shutdown(wait=False)
        self.client.close()


@contextmanager
def pool(workers: int | None = None, scheduler: str | None = None) -> Iterator[Pool]:
    """Where cases run: the cluster at ``scheduler``, else ``workers`` processes, else (one worker) here."""
    place: Processes | Cluster
    if scheduler is not None:
        place = Cluster(scheduler)
    elif (workers or cores()) == 1:
        yield Here()
        return
    else:
        place = Processes(workers or cores())
    try:
        yield place
    finally:
        place.stop()


def run_all(cases: Iterable[Case], pool: Pool) -> Iterator[tuple[Case, Outcome]]:
    """Run cases as room allows and hand each back as it is done, in whatever order that is.

    A worker that dies takes only its own case with it: the cases that were in flight are run again, one at a
    time, so that the one that kills is known and the others are not blamed.
    """
    waiting = deque(cases)
    suspects: deque[Case] = deque()
    deaths: dict[Case, int] = {}
    flying: dict[Future[Outcome], Case] = {}
    alone = False
    while waiting or suspects or flying:
        try:
            if suspects:
                alone = not flying
                if alone:
                    _send(suspects, pool, flying)
            elif not (alone and flying):
                alone = False
                while waiting and len(flying) < pool.room():
                    _send(waiting, pool, flying)
        except BrokenProcessPool:  # it broke between two cases: what flies is told so below
            if not flying:
                pool.mend()
        finished, _ = wait(flying, return_when=FIRST_COMPLETED)
        broken = False
        for future in finished:
            case = flying.pop(future)
            try:
                outcome = future.result()
            except BrokenProcessPool:
                broken = True
                deaths[case] = deaths.get(case, 0) + alone
                if deaths[case] < _DEATHS:
                    suspects.append(case)
                else:
                    yield (
                        case,
                        failed(case, f"its worker process died {_DEATHS} times, out of memory perhaps"),
                    )
                continue
            except (Exception, CancelledError) as error:
                yield case, failed(case, f"{type(error).__name__}: {' '.join(str(error).split())}")
                continue
            if outcome.version != version():
                raise StudyError(f"The workers run hoop-pulse {outcome.version}, we run {version()}: they must agree.")
            yield case, outcome
        if broken:
            suspects.extend(flying.values())
            flying.clear()
            pool.mend()


def _send(queue: deque[Case], pool: Pool, flying: dict[Future[Outcome], Case]) -> None:
    future = pool.submit(queue[0])  # the case leaves the queue only once it is taken
    flying[future] = queue.popleft()


def failed(case: Case, reason: str) -> Outcome:
    """The row of a case that never came back."""
    return Outcome(case.key, case.solver, plain(scene_to_dict(case.scene)), version(), failure=reason)


def _be_a_worker() -> None:
    """In a new worker: leave interrupts to the parent, and end with it even if it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    wait_for_end([sentinel])
    os._exit(1)


@contextmanager
def _one_thread() -> Iterator[None]:
    """The environment of workers started meanwhile: one BLAS thread each, as there is a worker for every
    core."""
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


@contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Workers started meanwhile are deaf to Ctrl-C from their first instruction, before their initializer could
    say so; for this process it waits until they are started."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    if hasattr(signal, "pthread_sigmask"):
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        return
    before: Callable[..., object] | int | None = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
