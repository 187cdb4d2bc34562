"""One source for two machines: functions that run as plain Python and, on demand, compiled.

A function marked :func:`kernel` keeps to scalars, flat sequences and :mod:`math`, so the interpreter runs it
on lists and numba on arrays, to the same numbers. A first call therefore waits for no compiler and does not
even import numba; :func:`compiled` builds (or loads from the cache on disk) the fast twins of all of them at
once.
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
    """Mark a function for compilation, under a name that no other kernel has."""
    assert isinstance(function, FunctionType)
    assert function.__name__ not in _REGISTER
    _REGISTER[function.__name__] = function
    return function


def _stamp() -> str:
    """Fingerprint of every file that enters the kernel: a change in a callee makes the cached caller
    stale.
    """
    files = sorted({__file__} | {function.__code__.co_filename for function in _REGISTER.values()})
    return hashlib.sha256(b"".join(Path(name).read_bytes() for name in files)).hexdigest()[:16]


@cache
def compiled() -> dict[str, Callable[..., Any]]:
    """The compiled twins by name; the first call in a process loads numba, the first on a machine compiles.

    Only the functions named ``entry_*`` are cached on disk (the others become part of them). The fingerprint
    is in their names, so the cache never serves a kernel whose callee has changed since.
    """
    import numba

    stamp = _stamp()
    twins: dict[str, Any] = {}
    scopes: list[dict[str, Any]] = []
    for name, function in _REGISTER.items():
        scopes.append(dict(function.__globals__))
        twin = FunctionType(function.__code__, scopes[-1], name, function.__defaults__)
        twin.__qualname__ = f"{name}_{stamp}" if name.startswith("entry_") else name
        twins[name] = _jit(numba, twin, name.startswith("entry_"))
    for scope in scopes:
        scope.update(twins)
    return twins


def _jit(numba: Any, function: FunctionType, keep: bool) -> Any:
    """Compiled lazily, with a cache on disk if ``keep`` and if there is a directory to write to."""
    options = {"nogil": True, "error_model": "numpy"}
    if keep:
        try:
            return numba.njit(function, cache=True, **options)
        except RuntimeError:
            pass
    return numba.njit(function, **options)
