"""One source for two machines: functions that run as plain Python and, on demand, compiled.

A function marked :func:`kernel` keeps to scalars, flat sequences and :mod:`math`, so the interpreter runs it
on lists and numba on arrays, to the same numbers. A first call therefore waits for no compiler and does not
even import numba; :func:`compiled` builds (or loads from the cache on disk) the fast twins of all of them at
once. A function marked :func:`jit` is compiled always.

Where the compiled code is kept is said in :mod:`rigid.kernel.store`, who is told in :mod:`rigid.kernel.announce`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar

from .insides.address import called_by_address, once_loaded
from .insides.parts import as_part

F = TypeVar("F", bound=Callable[..., Any])

#: no function gets an entry for C, which nothing calls and which takes as long to compile as one for Python
_OPTIONS: dict[str, Any] = {"error_model": "numpy", "no_cfunc_wrapper": True, "_nrt": True}
_REGISTER: dict[str, FunctionType] = {}


def kernel(function: F) -> F:
    """Mark a function for compilation, under a name that no other kernel has."""
    assert isinstance(function, FunctionType)
    assert function.__name__ not in _REGISTER
    _REGISTER[function.__name__] = function
    return function


@cache
def _home() -> Path:
    """Where the kernels' compiled code is."""
    from .store import fingerprint, home

    return home("rigid", fingerprint({function.__code__.co_filename for function in _REGISTER.values()}))


def _is_ready() -> bool:
    """Whether this machine has the compiled kernels."""
    from .store import is_compiled

    return is_compiled(_home())


class Patience:
    """How many steps a process takes interpreted before it goes over to compiled code.

    As many as take the time of loading that where this machine has it, and a part of the time of compiling where it has
    none. The default is for steps of a rigid motion, interpreted some 0.3 ms.

    Parameters
    ----------
    limit : float, optional
        The number of steps, whether there is compiled code or none.
    is_ready : callable
        Whether there is; asked once, when ``load`` steps are spent.
    load, compiling : float
        The number where there is, and where there is none.
    """

    LOAD, COMPILE = 1_000, 10_000
    INSTANTS = 8  # of a motion that cost a step

    _spent: float
    _limit: float
    _known: bool  # whether the limit stays, be there compiled code or none

    def __init__(
        self,
        limit: float | None = None,
        is_ready: Callable[[], bool] | None = None,
        load: float = LOAD,
        compiling: float = COMPILE,
    ) -> None:
        self._is_ready = is_ready or _is_ready
        self._load, self._compiling = load, compiling
        self.renew(limit)

    def left(self, instants: int = 0) -> float:
        """Steps that may still be interpreted once so many instants of a motion are; none or less is none."""
        left = self._limit - self._spent - instants / self.INSTANTS
        if left <= 0 and not self._known:
            self._known = True
            self._limit = self._load if self._is_ready() else self._compiling
            return self.left(instants)
        return left

    def spend(self, steps: float = 0.0, instants: int = 0) -> None:
        """What was interpreted."""
        self._spent += steps + instants / self.INSTANTS

    def renew(self, limit: float | None = None) -> None:
        """Begin anew, with so many steps: 0 is compiled from now on."""
        self._spent = 0.0
        self._limit = self._load if limit is None else limit
        self._known = limit is not None


patience = Patience()


@cache
def compiled() -> dict[str, Callable[..., Any]]:
    """The compiled twins by name; the first call in a process loads numba, the first on a machine compiles.

    Only the functions named ``entry_*`` are cached on disk (the others become part of them).
    """
    from .store import moved

    place = _home()
    twins: dict[str, Any] = {}
    scopes: list[dict[str, Any]] = []
    for name, function in _REGISTER.items():
        scopes.append(dict(function.__globals__))
        twin = moved(function, place, scopes[-1])
        entry = name.startswith("entry_")
        # the kernels make no arrays: without counted references, which cost a third of their time
        options = {"nogil": True, "_nrt": False}
        twins[name] = _compiler(twin, True, **options) if entry else _compiler(twin, False, **as_part(), **options)
    for scope in scopes:
        scope.update(twins)
    return twins


def jit(function: F, module: str = "", needs: tuple[Any, ...] = (), **instead: Any) -> F:
    """Mark a function for compilation at its first call, with a cache on disk.

    Compiled code takes what is given by name ``instead`` of the functions that have these names where it is written, so
    that one text serves Python and compiled code. It is kept under the name of the ``module`` that asks, by default the
    function's own, whose file must import the modules of both. ``needs`` are functions marked :func:`apart` that it
    calls, itself or through others; it is called from Python alone then.
    """
    compiler = _compiler(_at_home(function, module, instead), keep=True)
    entry: F = once_loaded(compiler, needs) if needs else compiler
    return entry


def apart(
    example: Callable[[], tuple[tuple[Any, ...], Any]], needs: tuple[Any, ...] = ()
) -> Callable[[F], F]:  # fmt: skip
    """Mark a function that is compiled by itself and called by its address, see :mod:`rigid.kernel.insides.address`.

    ``example`` returns arguments and a result of the types that compiled code calls it with. ``needs`` are others like
    it that it calls.

    Raises
    ------
    ImportError
        Nothing is to be compiled: without that there is no address.
    """
    import numba

    options: Any = numba.config
    if options.DISABLE_JIT:
        raise ImportError("the flexible solver runs compiled alone, which NUMBA_DISABLE_JIT forbids")

    def mark(function: F) -> F:
        marked: F = called_by_address(_compiler(_at_home(function, "", {}), keep=True), example, needs)
        return marked

    return mark


def part(function: F, module: str = "", **instead: Any) -> F:
    """Mark a function that compiled code alone calls.

    It gets no entry from Python, whose unpacking of named tuples takes long to compile, and no cache; it is compiled
    once for arguments that are known beforehand and for others. Called from Python it runs as it stands.
    ``module`` and ``instead`` are those of :func:`jit`.
    """
    from numba.extending import register_jitable

    text: Any = _at_home(function, module, instead) if instead else function
    marked: F = register_jitable(**_OPTIONS, **as_part())(text)
    return marked


def loop(function: F) -> F:
    """Mark a part that makes no array: it reads and fills those it is given, and returns some to other loops alone.

    Compiled code counts the users of every array, one by one of those in a named tuple, wherever it is named. Here it
    does not; with all of a contact's parts counted, that took a quarter of a step's time.
    """
    from numba.extending import register_jitable

    marked: F = register_jitable(**{**_OPTIONS, "_nrt": False}, **as_part())(function)
    return marked


def in_loops(text: Callable[..., Any], **options: bool) -> Callable[[F], F]:
    """Mark a function of whole arrays, for which compiled code takes a ``text`` of loops.

    Loops are quick to compile; whole arrays are quick as they stand, for the many unknowns of a ring not compiled.
    """
    from numba.extending import overload

    def mark(function: F) -> F:
        jit_options: Any = {**_OPTIONS, **as_part(), **options}
        overload(function, jit_options=jit_options, strict=False)(lambda *_: text)
        return function

    return mark


def _at_home(function: Callable[..., Any], module: str, instead: dict[str, Any]) -> FunctionType:
    """The function with what it takes instead, as if its file stood where its compiled code is kept."""
    from .store import moved

    assert isinstance(function, FunctionType)
    module = module or function.__module__
    place = _home_of(module, str(sys.modules[module].__file__))
    return moved(function, place, {**function.__globals__, **instead} if instead else None)


@cache
def _home_of(module: str, file: str) -> Path:
    from .store import fingerprint, home

    return home(module, fingerprint([file]))


def _compiler(function: FunctionType, keep: bool, **options: Any) -> Any:
    """Compiled lazily, with a cache on disk if ``keep``."""
    import numba

    from .announce import tell
    from .store import keep_code

    tell()
    mark: Any = numba.njit
    compiler = mark(**{**_OPTIONS, **options})(function)
    if keep and compiler is not function:  # which it is where NUMBA_DISABLE_JIT is set
        keep_code(compiler)
    return compiler
