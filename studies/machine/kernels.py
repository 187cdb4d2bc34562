"""What is compiled for this machine, once: part by part, side by side where there are cores for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Future
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from rigid import Scene
from rigid.batch.cores import cores
from rigid.kernel.store import is_cold

from .processes import Processes, WorkerDied

LEVELS = {"reduced": "flexible.time.advance", "chain": "flexible.time.chain_step"}
"""Levels of the flexible solver that have compiled code of their own, and the module whose code is compiled last."""

CONTACT, LAWS, INERTIA = "flexible.contact.forces", "flexible.contact.laws.listing", "flexible.ring.frame"
STAGE, CHAIN_STAGE = "flexible.models.stage", "flexible.chain.stage"
APART = {
    CONTACT: "contact_forces",
    LAWS: "tractions",
    INERTIA: "inertia",
    STAGE: "solve_stage",
    CHAIN_STAGE: "solve_stage",
}
"""Functions that are compiled by themselves, by their modules."""

CALLED = {"reduced": (STAGE, CONTACT, LAWS, INERTIA), "chain": (CHAIN_STAGE, CONTACT, LAWS)}
"""Those of them that a level's steps call."""

DEAREST = ("rigid", "chain", CHAIN_STAGE, "reduced", CONTACT, STAGE, LAWS, INERTIA)
"""The same with levels and "rigid", the dearest first: to compile some 25 s, 18, 18, 9, 8, 4, 2 and 1."""


def levels_of(scenes: Iterable[Scene]) -> list[str]:
    """Those that the flexible solver needs for these scenes."""
    from flexible.models.select import level_of

    found = {level_of(scene.to_dimensionless()) for scene in scenes}
    return [level for level in LEVELS if level in found]


def missing(levels: Iterable[str]) -> list[str]:
    """Those of the levels for which this machine has no compiled code yet."""
    found = []
    for level in levels:
        import_module(LEVELS[level])  # which knows where its kernels are
        if any(map(is_cold, (LEVELS[level], *CALLED[level]))):
            found.append(level)
    return found


def _short() -> Scene:
    """A scene that is soon over."""
    import rigid

    return rigid.load_scene("paper-3.3-light").replace(solve={"rtol": 1e-2}, run=rigid.Run(until="pulse"))


def prepare(*names: str) -> Path:
    """Compile what "rigid", or a level of the flexible solver, needs and this machine does not have yet.

    Returns
    -------
    Path
        The folder where it is kept.
    """
    import rigid
    from rigid.kernel.compile import patience
    from rigid.kernel.store import user_cache

    assert set(names) <= {"rigid", *LEVELS}
    scene = _short()
    if "rigid" in names:
        rigid.simulate_batch([scene], workers=1)
        patience.renew(0)
        rigid.simulate(scene).at(0.0)
    levels = [level for level in LEVELS if level in names]
    if levels:
        from flexible import simulate
    for level in levels:
        simulate(scene.replace(solve={"level": level}), states=False)
    return user_cache()[0]


def compile_alone(name: str, told: bool) -> None:
    """Compile a function of ``APART``, by its module, or a level's steps without those, and nothing else.

    What others have ``told`` of is not told again.
    """
    from rigid.kernel.announce import is_told

    if told:
        is_told("flexible")
    if name in APART:
        getattr(import_module(name), APART[name]).load_alone()
        return
    from flexible.models.select import hoop_of
    from flexible.start.equilibrium import compile_ahead

    compile_ahead(hoop_of(_short().replace(solve={"level": name}).to_dimensionless()))


def compile_side_by_side(names: Iterable[str], submit: Callable[..., Future[Any]]) -> list[str]:
    """Compile the dear parts of what :func:`prepare` does, in the processes that ``submit`` has call functions.

    Returns
    -------
    list of str
        What is left to ``prepare``: the levels of which this machine had no compiled code, and "rigid" if it is named.
    """
    names = list(names)
    levels = missing(level for level in LEVELS if level in names)
    cold = [name for name in names if name == "rigid" or name in levels]
    parts = {name for name in cold if name == "rigid" or is_cold(LEVELS[name])}
    parts.update(name for level in levels for name in CALLED[level] if is_cold(name))
    waiting, told = [], False
    for part in sorted(parts, key=DEAREST.index):
        if part == "rigid":
            waiting.append(submit(prepare, part))
        else:
            waiting.append(submit(compile_alone, part, told))
            told = True
    for future in waiting:
        with suppress(WorkerDied):  # of want of memory beside the others, perhaps: whoever calls it compiles it, alone
            future.result()
    return cold


def compile_on_all_cores(names: Iterable[str]) -> None:
    """The same in processes of its own, one for each core; one core alone has nothing to gain by it."""
    names = list(names)
    if cores() == 1 or not ("rigid" in names or missing(names)):
        return
    processes = Processes(min(cores(), len(DEAREST)))
    try:
        compile_side_by_side(names, processes.submit)
    finally:
        processes.stop()
