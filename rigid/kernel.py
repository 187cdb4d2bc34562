"""One source for two machines: functions that run as plain Python and, on demand, compiled.

A function marked :func:`kernel` keeps to scalars, flat sequences and :mod:`math`, so the interpreter runs it on
lists and numba on arrays, to the same numbers. A first call therefore waits for no compiler and does not even import
numba; :func:`compiled` builds (or loads from the cache on disk) the fast twins of all of them at once.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

_REGISTER: dict[str, FunctionType] = {}


def kernel(function: F) -> F:
    """Mark a function for compilation; its callees must have been marked before it."""
    assert isinstance(function, FunctionType)
    _REGISTER[function.__name__] = function
    return function


def _stamp() -> str:
    """Fingerprint of every marked function's file: a change in a callee makes the cached caller stale."""
    files = sorted({function.__code__.co_filename for function in _REGISTER.values()})
    return hashlib.sha256(b"".join(Path(name).read_bytes() for name in files)).hexdigest()


@cache
def compiled() -> dict[str, Callable[..., Any]]:
    """The compiled twins by name; the first call in a process loads numba, the first on a machine compiles.

    Only the functions named ``entry_*`` are cached on disk (the rest are part of them). The fingerprint enters the
    entry's closure, which is part of numba's cache key.
    """
    import numba

    twins: dict[str, Any] = {}
    for name, function in _REGISTER.items():
        scope = {**function.__globals__, **twins}
        twin = FunctionType(function.__code__, scope, name, function.__defaults__, function.__closure__)
        if name.startswith("entry_"):
            twin = FunctionType(function.__code__, scope, f"{name}_{_stamp()[:16]}", function.__defaults__)
            twin.__qualname__ = twin.__name__
            twins[name] = _cached(numba, twin)
        else:
            twin.__qualname__ = function.__qualname__
            twins[name] = numba.njit(twin, nogil=True, error_model="numpy")
    return twins


def _cached(numba: Any, function: FunctionType) -> Any:
    """Compiled with a cache on disk, or without one where no directory can be written."""
    try:
        return numba.njit(function, nogil=True, error_model="numpy", cache=True)
    except RuntimeError:
        return numba.njit(function, nogil=True, error_model="numpy")
