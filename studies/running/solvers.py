"""The solvers by name. A scene goes in, a :class:`rigid.Motion` comes out: nothing else is known of them
here.

A third solver is compared by writing one adapter, a function of this signature, and naming it
``module:function`` on the command line (``--solver``) or from Python. Naming it runs it: its module is imported and the
function called, in every worker, with all that the user may do; what it prints goes to stderr. Results know the file of
its module, not what that imports. Files, a sweep's for instance, are data and name the built-in solvers alone.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import redirect_stdout, suppress
from functools import cache, wraps
from importlib import import_module
from typing import Any, Protocol

from rigid import Motion, Scene
from rigid.allowed import shown

from ..machine.build import build
from .files import StudyError
from .measures import entered

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
    return build("" if name in NAMED else name.partition(":")[0]) + entered()
