"""Cases run side by side: on this machine's cores, or on a Dask cluster, through the same futures."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from contextlib import contextmanager, suppress
from typing import Protocol, TypeVar

from rigid import scene_to_dict
from rigid.allowed import require_whole, shown
from rigid.batch.cores import cores
from rigid.output.file import version

from ..machine.kernels import compile_side_by_side, levels_of, prepare
from ..machine.processes import NoWorker, Processes, WorkerDied
from .case import Case, OtherBuild, Outcome, run_case
from .files import StudyError, plain
from .measures import homes

T = TypeVar("T")

_EARLY = 4
"""So many processes begin at once, before there is anything for them to do; the others with their first case."""

_DEATHS = 3
"""A case whose worker has died this often is not tried again."""


class Pool(Protocol):
    """Where cases run."""

    def submit(self, case: Case) -> Future[Outcome]:
        """Have a case run; its trouble is in the outcome, but for an OtherBuild or a worker's death."""
        ...

    def beside(self, function: Callable[..., T], *arguments: object) -> Future[T]:
        """Have this machine call an importable function that leaves files here."""
        ...

    def workers(self) -> int:
        """How many cases run at once."""
        ...


def at_once(function: Callable[..., T], *arguments: object) -> Future[T]:
    """Call it now, in this process."""
    future: Future[T] = Future()
    try:
        future.set_result(function(*arguments))
    except Exception as error:
        future.set_exception(error)
    return future


class Here(Pool):
    """In this process, one after the other."""

    beside = staticmethod(at_once)

    def submit(self, case: Case) -> Future[Outcome]:
        future: Future[Outcome] = Future()
        try:
            future.set_result(run_case(case))
        except OtherBuild as error:
            future.set_exception(error)
        return future

    def workers(self) -> int:
        return 1


class Machine(Pool):
    """In processes of this machine, each on one core."""

    def __init__(self, workers: int) -> None:
        self._count = workers
        self._processes = Processes(workers)
        self._ready: set[str] = set()
        for _ in range(min(workers, _EARLY)):
            self._processes.submit(_awake)

    def submit(self, case: Case) -> Future[Outcome]:
        if case.solver == "flexible":
            levels = [level for level in levels_of([case.scene]) if level not in self._ready]
            with suppress(NoWorker):  # which the case then says
                if absent := compile_side_by_side(levels, self._processes.submit):  # once for all workers
                    with suppress(WorkerDied):  # the cases compile it; one that does not survive that is tried again
                        self._processes.submit(prepare, *absent).result()
            self._ready.update(levels)
        return self._processes.submit(run_case, case, homes())

    def beside(self, function: Callable[..., T], *arguments: object) -> Future[T]:
        return self._processes.submit(function, *arguments)

    def workers(self) -> int:
        return self._count

    def stop(self) -> None:
        """End the processes, whatever they do."""
        self._processes.stop()


def _awake() -> None:
    """Load what cases take, while the process that has them is still finding out what they are."""
    import flexible  # noqa: F401


def ensure_address(address: str) -> None:
    """Whether an address says where a scheduler is, before it is looked for.

    Raises
    ------
    StudyError
        It has no port, nor a scheme that needs none.
    """
    if not isinstance(address, str) or not re.fullmatch(r"inproc://.+|([\w-]+://)?.+:\d{1,5}", address):
        raise StudyError(f"There is no Dask scheduler at {address}: it takes host and port, tcp://host:8786.")


class Cluster(Pool):
    """On a Dask cluster, which itself moves the cases of a dead worker to another one."""

    beside = staticmethod(at_once)

    def __init__(self, address: str) -> None:
        ensure_address(address)
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
        return self.executor.submit(run_case, case, homes())

    def workers(self) -> int:
        return max(1, sum(self.client.nthreads().values()))

    def stop(self) -> None:
        """Leave the cluster, which goes on."""
        self.executor.shutdown(wait=False)
        self.client.close()


@contextmanager
def pool(workers: int | None = None, scheduler: str | None = None) -> Iterator[Pool]:
    """Where cases run: the cluster at ``scheduler``, else ``workers`` processes, else (one worker) here.

    Processes import the script that has them: what it does belongs below ``if __name__ == "__main__":``.

    Raises
    ------
    SceneError
        ``workers`` that are no whole number from 1 to 1024.
    StudyError
        There is no scheduler at that address.
    """
    place: Machine | Cluster
    if workers is not None:
        workers = require_whole("workers", workers, 1, 1024)
    if scheduler is not None:
        place = Cluster(scheduler)
    elif (workers or cores()) == 1:
        yield Here()
        return
    else:
        place = Machine(workers or cores())
    try:
        yield place
    finally:
        place.stop()


def as_pool(given: Pool | None) -> Pool:
    """Where cases run, here if nothing is said.

    Raises
    ------
    StudyError
        What is no pool.
    """
    if given is None:
        return Here()
    if not all(callable(getattr(given, name, None)) for name in ("submit", "workers")):
        raise StudyError(f"pool = {shown(given)} is not possible: it is what `with studies.pool(4) as pool:` gives.")
    return given


def run_all(cases: Iterable[Case], pool: Pool) -> Iterator[tuple[Case, Outcome]]:
    """Run cases as room allows and hand each back as it is done, in whatever order that is.

    A worker that dies takes only its own case with it. The case is tried again after all others, alone, as it may
    have died of want of memory beside them.

    Raises
    ------
    StudyError
        The workers have other sources than this process, and their results are not ours; or none can begin.
    """
    waiting = deque(cases)
    again: deque[Case] = deque()
    deaths: dict[Case, int] = {}
    flying: dict[Future[Outcome], Case] = {}
    while waiting or again or flying:
        # one case here at once; elsewhere one more waits for each worker
        while waiting and len(flying) < (1 if isinstance(pool, Here) else 2 * pool.workers()):
            case = waiting.popleft()
            flying[pool.submit(case)] = case
        if again and not flying:
            case = again.popleft()
            flying[pool.submit(case)] = case
        for future in wait(flying, return_when=FIRST_COMPLETED).done:
            case = flying.pop(future)
            try:
                yield case, future.result()
            except WorkerDied as death:
                deaths[case] = deaths.get(case, 0) + 1
                if deaths[case] < _DEATHS:
                    again.append(case)
                else:
                    yield case, failed(case, f"{_DEATHS} times {death}")
            except OtherBuild as error:
                raise StudyError(f"{error}.") from None
            except NoWorker as error:
                raise StudyError(str(error)) from None
            except (Exception, CancelledError) as error:
                yield case, failed(case, f"{type(error).__name__}: {' '.join(str(error).split())}")


def failed(case: Case, reason: str) -> Outcome:
    """The row of a case that never came back."""
    return Outcome(case.key, case.solver, plain(scene_to_dict(case.scene)), version(), failure=reason)
