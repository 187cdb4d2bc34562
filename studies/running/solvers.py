"""The solvers by name. A scene goes in, a :class:`rigid.Motion` comes out: nothing else is known of them
here.

A third solver is compared by writing one adapter, a function of this signature, and naming it
``module:function`` wherever a solver is named.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from importlib import import_module, metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Protocol

from rigid import Motion, Scene

from .files import StudyError

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
    """The elastic ring on the compliant floor."""
    from flexible import simulate

    return simulate(scene, history=history, progress=progress)


NAMED = {"rigid": f"{__name__}:rigid", "flexible": f"{__name__}:flexible"}


@cache
def solver(name: str) -> Solver:
    """The solver of that name: "rigid", "flexible" or ``module:function``.

    Raises
    ------
    StudyError
        There is none.
    """
    module, colon, function = NAMED.get(name, name).partition(":")
    if not colon:
        raise StudyError(f"{name!r} is not a solver: it must be one of {', '.join(NAMED)}, or module:function.")
    try:
        return getattr(import_module(module), function)
    except (ImportError, AttributeError) as error:
        raise StudyError(f"{name!r} is not a solver: {error}.") from None


@cache
def version() -> str:
    """Version of this package."""
    try:
        return metadata.version("hoop-pulse")
    except metadata.PackageNotFoundError:
        return "uninstalled"


@cache
def build() -> str:
    """Version and a digest of the sources: results of a checkout that has changed since are not taken for its own."""
    digest = hashlib.sha256()
    for package in ("rigid", "meshes", "flexible", "studies"):
        spec = find_spec(package)
        for place in spec.submodule_search_locations or [] if spec is not None else []:
            for source in sorted(Path(place).rglob("*.py")):
                digest.update(source.read_bytes())
    return f"{version()}+{digest.hexdigest()[:12]}"


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
