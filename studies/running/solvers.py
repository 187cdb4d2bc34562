"""The solvers by name. A scene goes in, a :class:`rigid.Motion` comes out: nothing else is known of them
here.

A third solver is compared by writing one adapter, a function of this signature, and naming it
``module:function`` on the command line (``--solver``) or from Python. Naming it runs it: its module is imported and the
function called, in every worker, with all that the user may do; what it prints goes to stderr. Results know the file of
its module, not what that imports. Files, a sweep's for instance, are data and name the built-in solvers alone.
"""

from __future__ import annotations

import dis
import hashlib
import inspect
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import redirect_stdout, suppress
from functools import cache, wraps
from importlib import import_module, metadata
from importlib.util import find_spec
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any, Protocol

from rigid import Motion, Scene
from rigid.allowed import shown
from rigid.output.file import version

from .files import StudyError
from .measures import own_measures

Progress = Callable[[float], None]


class Solver(Protocol):
    """A scene to its motion; ``history`` asks to keep the steps, ``progress`` takes the fraction done, 0 to
    1."""

    def __call__(self, scene: Scene, *, history: bool = False, progress: Progress | None = None) -> Motion: ...


def rigid(scene: Scene, *, history: bool = False, progress: Progress | None = None) -> Motion:
    """The closed form: it keeps no steps and is over before a bar could be drawn."""
    from rigid import simulate

    return simulate(scene)


def flexible(scene: Scene, *, history: bool = False, progress: Progress | None = None) -> Motion:
    """The elastic ring on the compliant floor; no states of the ring are kept, of which fields would be made."""
    from flexible import simulate

    return simulate(scene, history=history, states=False, progress=progress)


NAMED = {"rigid": f"{__name__}:rigid", "flexible": f"{__name__}:flexible"}


def solver(name: str) -> Solver:
    """The solver of that name: "rigid", "flexible" or ``module:function``.

    Raises
    ------
    StudyError
        There is none.
    """
    if not isinstance(name, str):
        raise StudyError(f"{shown(name)} is not a solver: it must be the name of one, which other processes import.")
    return _solver(name)


@cache
def _solver(name: str) -> Solver:
    module, colon, function = NAMED.get(name, name).partition(":")
    if not colon:
        raise StudyError(f"{name!r} is not a solver: it must be one of {', '.join(NAMED)}, or module:function.")
    try:
        with redirect_stdout(sys.stderr):
            found = getattr(import_module(module), function)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # whatever a module does as it is imported, SystemExit too
        reason = " ".join(str(error).split()) or type(error).__name__
        raise StudyError(f"{name!r} is not a solver: {reason.rstrip('.')}.") from None
    if not callable(found):
        raise StudyError(f"{name!r} is not a solver: it cannot be called.")
    chosen: Solver = found
    return chosen if name in NAMED else _aside(chosen)


def _aside(found: Solver) -> Solver:
    """A solver of one's own, whose prints are no part of a study's output."""

    @wraps(found)
    def run(scene: Scene, **wishes: Any) -> Motion:
        with redirect_stdout(sys.stderr):
            return found(scene, **wishes)

    return run


def ensure_accepts(name: str, scene: Scene) -> None:
    """Before anything is run or written: that there is a solver of that name, and that it takes the scene.

    A solver of one's own is asked when it runs.

    Raises
    ------
    StudyError
        There is no such solver.
    SceneError
        The flexible hoop cannot be of that scene.
    """
    solver(name)
    if name == "flexible":
        from flexible import ensure_possible

        ensure_possible(scene)


def build_here(name: str) -> str:
    """All that results of a solver hang on but the case: its build, and the measures that have been entered here."""
    with suppress(StudyError):  # which its run then says
        solver(name)  # its module may enter some as it is imported
    return build(name) + entered()


def entered() -> str:
    """The measures of one's own, each with a digest of what it computes; part of a case's build."""
    return "".join(f"+{each.name}:{_digest(each.of)}" for each in own_measures())


def homes() -> tuple[str, ...]:
    """The modules that enter them, for other processes; a script these import by themselves."""
    return tuple({entry.of.__module__: None for entry in own_measures() if entry.of.__module__ != "__main__"})


def enter_from(modules: tuple[str, ...]) -> None:
    """Import modules that enter measures, as far as they are to be had here."""
    for name in modules:
        try:
            import_module(name)
        except Exception:  # what is missing then is told by the case's build
            continue


def _digest(function: Callable[..., object]) -> str:
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


@cache
def build(name: str = "rigid") -> str:
    """Version and a digest of the sources, a solver's own module among them, and of what :func:`versions` names.

    Results of a checkout that has changed since, or of another numpy, are not taken for its own.
    """
    digest = hashlib.sha256(json.dumps(versions()).encode())
    for package in ("rigid", "meshes", "flexible", "studies"):
        spec = find_spec(package)
        for place in spec.submodule_search_locations or [] if spec is not None else []:
            for source in sorted(Path(place).rglob("*.py")):
                file = source.relative_to(Path(place).parent).as_posix()
                digest.update(file.encode() + b"\0" + source.read_bytes() + b"\0")
    if name not in NAMED:
        digest.update(_source_of(name.partition(":")[0]))
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
