"""A third solver, made for the tests by one adapter: the rigid motion with measures that miss it by a known
law.

The impulse ratio and the friction loss are off by ``C s^-1/3`` with s the contact foundation, and by a
numerical error of the asked tolerance; so a study of it must find rate 1/3 and the rigid values.
"""

from __future__ import annotations

import dataclasses
import os
import time
from pathlib import Path

from rigid import Motion, Scene, simulate

RATE = 1 / 3
OFF = 20.0
"""Relative distance C: 2e-2 at a foundation of 1e9."""


def softened(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The rigid motion of the scene that the contact law tends to, its pulses missed by the law above."""
    tended = scene
    if scene.contact.law != "patch":  # only then is there need for the flexible package, which takes time to import
        from flexible import rigid_limit

        tended = rigid_limit(scene)
    motion = simulate(tended)
    miss = OFF * scene.contact.stiffness**-RATE
    pulses = tuple(
        dataclasses.replace(
            pulse,
            friction_impulse=pulse.friction_impulse * (1 + miss) + scene.solve.rtol,
            friction_loss=pulse.friction_loss * (1 - miss) + scene.solve.rtol,
        )
        for pulse in motion.pulses
    )
    return dataclasses.replace(motion, scene=scene, pulses=pulses)


def talking(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, with a word on stdout, as other programs greet."""
    print("talking")
    return softened(scene)


def unfinished(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, but above a foundation of 1e10 it stops before the end."""
    motion = softened(scene)
    if scene.contact.stiffness > 1e10:
        motion = dataclasses.replace(motion, completed=False, ended="stopped at t = 4.2: no step could be found")
    return motion


def tiring(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, but above a foundation of 1e10 it stops behind the first pulse."""
    motion = softened(scene)
    if scene.contact.stiffness > 1e10:
        ended = "stopped at t = 9.9: no step could be found"
        motion = dataclasses.replace(motion, completed=False, ended=ended, pulses=motion.pulses[:1])
    return motion


def slow(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, slowly enough to be interrupted, unless a test has no use for that."""
    time.sleep(float(os.environ.get("HOOP_TEST_PAUSE", "0.7")))
    return softened(scene)


def failing(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, but above a foundation of 1e10 it gives up."""
    if scene.contact.stiffness > 1e10:
        raise ArithmeticError("no step could be found at t = 4.2")
    return softened(scene)


def deadly(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, but at k = 0.3 the process dies under it."""
    if scene.hoop.k == 0.3:
        os.kill(os.getpid(), 9)
    return softened(scene)


def deadly_once(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, but at k = 0.3 the first process that gets it dies; a file named by the test remembers it."""
    mark = Path(os.environ["HOOP_TEST_MARK"])
    if scene.hoop.k == 0.3 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), 9)
    return slow(scene)


def leaving(scene: Scene, *, history: bool = False, progress: object = None) -> Motion:
    """The same, but at k = 0.3 it wants to end the program."""
    if scene.hoop.k == 0.3:
        raise SystemExit("enough of it")
    return softened(scene)
