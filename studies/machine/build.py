"""What a result hangs on beside its case: versions, these sources, and what a function of one's own does."""

from __future__ import annotations

import dis
import hashlib
import inspect
import json
from collections.abc import Callable, Iterator
from functools import cache
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from types import CodeType, FunctionType

from rigid.output.file import version


@cache
def build(module: str = "") -> str:
    """Version and a digest of the sources, a solver's own ``module`` among them, and of what :func:`versions` names.

    Results of a checkout that has changed since, or of another numpy, are not taken for its own.
    """
    digest = hashlib.sha256(json.dumps(versions()).encode())
    for package in ("rigid", "meshes", "flexible", "studies"):
        spec = find_spec(package)
        for place in spec.submodule_search_locations or [] if spec is not None else []:
            for source in sorted(Path(place).rglob("*.py")):
                file = source.relative_to(Path(place).parent).as_posix()
                digest.update(file.encode() + b"\0" + source.read_bytes() + b"\0")
    if module:
        digest.update(_source_of(module))
    return f"{version()}+{digest.hexdigest()[:12]}"


def _source_of(module: str) -> bytes:
    """The file of a module, empty where there is none."""
    try:
        spec = find_spec(module)
        return Path(spec.origin).read_bytes() if spec is not None and spec.origin is not None else b""
    except (ImportError, ValueError, OSError):
        return b""


def versions() -> dict[str, str]:
    """Versions of everything a result depends on."""
    import platform

    found = {"hoop-pulse": version(), "python": platform.python_version()}
    for package in ("numpy", "scipy", "numba", "scikit-fem"):
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            found[package] = "not installed"
    return found


def digest_of(function: Callable[..., object]) -> str:
    """Eight digits that change with what a function does, by :func:`_told`."""
    return hashlib.sha256("\n".join(_told(inspect.unwrap(function), [])).encode()).hexdigest()[:8]


def _told(value: object, seen: list[object]) -> Iterator[str]:
    """What a function does, in words that are the same in every process: its code, and what that names.

    What other modules have in their place is left out, and so is a number that the function itself counts with.
    """
    if isinstance(value, (int, float, complex, str, bytes, type(None))):
        yield repr(value)
    elif isinstance(value, (tuple, frozenset)):
        yield type(value).__name__
        each = [" ".join(_told(entry, seen)) for entry in value]
        yield from sorted(each) if isinstance(value, frozenset) else each  # a set of words has an order by process
    elif isinstance(value, CodeType):
        yield value.co_code.hex()
        yield " ".join(value.co_names)
        for constant in value.co_consts:
            yield from _told(constant, seen)
    elif isinstance(value, FunctionType) and value not in seen:
        seen.append(value)
        cells = [cell.cell_contents for cell in value.__closure__ or ()]
        named = [value.__globals__.get(name) for name in _globals(value.__code__)]
        near = [each for each in named if getattr(each, "__module__", value.__module__) == value.__module__]
        for part in (value.__code__, value.__defaults__, *(value.__kwdefaults__ or {}).values(), *cells, *near):
            yield from _told(part, seen)


@cache
def _globals(code: CodeType) -> tuple[str, ...]:
    """Names of its module that code reads and does not set."""
    steps = list(dis.get_instructions(code))
    read, written = ({step.argval for step in steps if step.opname == f"{does}_GLOBAL"} for does in ("LOAD", "STORE"))
    inner = {name for each in code.co_consts if isinstance(each, CodeType) for name in _globals(each)}
    return tuple(sorted((inner | read) - written))
