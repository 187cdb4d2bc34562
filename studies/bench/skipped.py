"""What each thing skipped saves: the same work with and without."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import flexible
from flexible.ring.choice import forget_rings
from rigid import Scene, load_scene

from .peers.scipy_ivp import installed
from .race import Contestant, Row, race, wall_of
from .truth import reference

SCENE = "skipped"
HEAVY = ("numba", "scipy.sparse.linalg", "skfem", "meshio", "matplotlib.figure", "pandas", "pyvista")
"""Imports that a program waits for only where it uses them."""


def _command(*words: str) -> list[str]:
    return [sys.executable, "-c", "from studies.cli import main; main()", *words]


def _fields(scene: Scene) -> None:
    from flexible import write_fields

    motion = flexible.simulate(scene, history=True)
    with TemporaryDirectory() as folder:
        write_fields(motion, Path(folder), frames=50)


def skipped(quick: bool) -> list[Row]:
    """Pairs of rows, with first and without second."""
    paper = load_scene("paper-3.3-light").replace(run={"turns": 2}, solve={"rtol": 1e-3, "level": "reduced"})
    pulse = reference.massless_pulse(1e-2)
    pairs: list[tuple[str, Callable[[], Any], Callable[[], Any] | None]] = [
        ("history and states: kept", lambda: flexible.simulate(pulse, history=True), None),
        ("history and states: not kept", lambda: flexible.simulate(pulse), None),
        ("ring: assembled and reduced anew", lambda: flexible.simulate(pulse), forget_rings),
        ("ring: from the cache", lambda: flexible.simulate(pulse), None),
        ("between pulses: flexible", lambda: flexible.simulate(paper.replace(solve={"resolve": "all"})), None),
        ("between pulses: rigid closed form", lambda: flexible.simulate(paper), None),
        ("ring without mass: all nodes", lambda: flexible.simulate(pulse.replace(solve={"level": "full"})), None),
        ("ring without mass: static compliance", lambda: flexible.simulate(pulse), None),
    ]
    if not quick:
        pairs.append(("fields: 50 frames written", lambda: _fields(pulse), None))
        pairs.append(("fields: none", lambda: flexible.simulate(pulse, history=True), None))
    slow = ("ring without mass: all nodes", "fields: 50 frames written")
    # the one that forgets the rings must not leave it to the others, in whose turns they come, to find them again
    entries = [
        Contestant("hoop-pulse", name, SCENE, run, prepare=before or run, repeats=1 if name in slow else None)
        for name, run, before in pairs
    ]
    return race(entries, 2 if quick else 3) + cold_starts(1 if quick else 5)


def cold_starts(repeats: int) -> list[Row]:
    """Wall time of a process that does one thing from nothing, compiled code found on disk."""
    everything = "import " + ", ".join(name for name in HEAVY if installed(name.partition(".")[0]))
    commands: dict[str, Sequence[str]] = {
        "cold start: python -c pass": [sys.executable, "-c", "pass"],
        "cold start: hoop rigid paper-3.1": _command("rigid", "paper-3.1", "--json"),
        "cold start: the same, all imports at once": [
            sys.executable,
            "-c",
            f"{everything}\nfrom studies.cli import run; run(['rigid', 'paper-3.1', '--json'])",
        ],
        "cold start: hoop flexible paper-3.3-massless": _command("flexible", "paper-3.3-massless", "--json"),
    }
    rows = [Row("hoop-pulse", name, SCENE, [], clock="wall") for name in commands]
    for command in commands.values():
        wall_of(command)
    for _ in range(repeats):
        for row, command in zip(rows, commands.values(), strict=True):
            row.seconds.append(wall_of(command))
    return rows
