"""A scene goes in, a motion comes out."""

from __future__ import annotations

import threading
from math import ceil, inf
from os import PathLike
from typing import Any, NamedTuple

import numpy as np

from .allowed import SceneError, require, shown
from .kernel import layout as at
from .kernel.compile import compiled, patience
from .kernel.spectral import compiled_workspace, workspace
from .lists import Deferred
from .motion import Motion
from .output.file import Stored, read
from .output.units import Unit, without_units
from .phases.choice import MOST_STALLS, entry_run, release_from
from .phases.reasons import reason
from .record.pulse import cut_pulse
from .record.values import Array
from .sampler import Log, Sampler, parameters
from .scene import Run, Scene, is_point_mass
from .scenefile import SceneLike, as_scene, scene_from_dict

LOG_RECORDS = 128
STEPS = 200_000  # the work bound of one motion: Taylor steps and phases
MOST_RECORDS = 200_000  # and its phases, turns and pulses together


class Aloft(NamedTuple):
    """Where over the floor a hoop is released, in the units of its scene: in flight, if this is not 0.

    Parameters
    ----------
    height, rise : float
        Of its lowest point, and the velocity of that, upward.
    """

    height: float = 0.0
    rise: float = 0.0


ON_THE_FLOOR = Aloft()


def release_of(scene: Scene) -> tuple[float, float, float]:
    """phi0, omega0, slip0, R = g = 1."""
    release = without_units(scene.release, scene)
    return float(release.phi0), float(release.omega0), float(release.slip0)


def release_state(scene: Scene, aloft: tuple[float, float] = (0.0, 0.0)) -> list[float]:
    """The state at t = 0 (see :mod:`rigid.kernel.layout`); ``aloft`` without units."""
    state = [0.0] * at.STATE
    release_from(state, *release_of(scene))
    state[at.GAP], state[at.UN] = aloft
    state[at.STEPS] = float(STEPS)
    return state


class _Workspace(threading.local):
    """What the compiled kernel works in, one for each thread."""

    def __init__(self) -> None:
        self.events = np.zeros(LOG_RECORDS * at.WIDTH)
        self.state = np.zeros(at.STATE)
        self.work = compiled_workspace()


_workspace = _Workspace()


def _run(scene: Scene, aloft: tuple[float, float]) -> Log:
    """Run to the end; ``aloft`` without units.

    Interpreted until the ``patience`` of this process is spent, from then on compiled: the same numbers to round-off.
    """
    par = parameters(scene)
    if patience.left() <= 0:
        state, events, work = _workspace.state, _workspace.events, _workspace.work
        code = compiled()["entry_start"](np.array(par), (*release_of(scene), *aloft, float(STEPS)), state, work, events)
        logs = [_logged(events, state)]
        state[at.RECORDS] = 0.0
        return _run_on(par, code, state, logs)
    code, here, logs, begun = _run_interpreted(par, release_state(scene, aloft))
    if code == at.MORE:
        _workspace.events[: len(begun)] = begun
        return _run_on(par, code, np.array(here), logs)
    return _whole(par, code, logs, here)


def _run_interpreted(par: list[float], state: list[float]) -> tuple[int, list[float], list[Array], list[float]]:
    """Run to the end or to the end of the patience: why it ended, the state there, the records in parts, and the log
    that is begun, on which a run that is not over goes on: it is as full as that of one that is compiled throughout.
    """
    events, work = [0.0] * (LOG_RECORDS * at.WIDTH), workspace()
    logs: list[Array] = []
    left = float(STEPS)
    while (allowance := float(ceil(min(patience.left(), left)))) > 0:
        state[at.STEPS] = allowance
        code = entry_run(par, state, work, events)
        spent = allowance - state[at.STEPS]
        left -= spent
        patience.spend(spent)
        state[at.STEPS] = left
        if code == at.WORK_BOUND and left > 0 and state[at.STALLS] <= MOST_STALLS:
            continue
        logs.append(_logged(events, state))
        if code != at.MORE or sum(map(len, logs)) >= MOST_RECORDS:
            return at.WORK_BOUND if code == at.MORE else code, state, logs, []
        state[at.RECORDS] = 0.0
    return at.MORE, state, logs, events


def _run_on(par: list[float], code: int, state: Array, logs: list[Array]) -> Log:
    """Go on, compiled, while there is more."""
    if code == at.MORE:
        events, work, constants = _workspace.events, _workspace.work, np.array(par)
        count = sum(map(len, logs))
        while code == at.MORE and count < MOST_RECORDS:
            code = compiled()["entry_run"](constants, state, work, events)
            logs.append(_logged(events, state))
            count += len(logs[-1])
            state[at.RECORDS] = 0.0
    return _whole(par, at.WORK_BOUND if code == at.MORE else code, logs, state.tolist())


def _whole(par: list[float], code: int, logs: list[Array], final: list[float]) -> Log:
    """The log of a run that is over, and in it the pulse that its end cuts short."""
    if final[at.P_OPEN] != 0.0:
        events = [0.0] * at.WIDTH
        final[at.RECORDS] = 0.0
        cut_pulse(par, final, events)
        logs.append(_logged(events, final))
    return Log(code, logs[0] if len(logs) == 1 else np.concatenate(logs), final)


def _logged(events: Any, state: Any) -> Array:
    """A copy of the records on the event log, (n, WIDTH)."""
    return np.array(events[: int(state[at.RECORDS]) * at.WIDTH], dtype=float).reshape(-1, at.WIDTH)


def simulate(scene: SceneLike, aloft: Aloft | tuple[float, float] = ON_THE_FLOOR) -> Motion:
    """The rigid motion of a scene, exact to round-off.

    Parameters
    ----------
    scene : Scene, str, path or dict
        Hoop, friction, release and how far to run (its ring and contact are not looked at), or what says so: the name
        of a shipped scene, the path of a TOML file, a dict as such a file gives it.
    aloft : (height, rise), optional
        Height of the lowest point over the floor at the release, and its velocity upward, in the units of the scene: a
        hoop let fall or thrown up. 0 by default, a hoop on the floor.

    Returns
    -------
    Motion
        Phases, turns and pulses in the units of the scene; ``at(t)`` gives any instant between. ``period`` is
        that of a motion that ends rolling for ever. A motion never fails: what stops it is said in ``ended``.
        The lists of one without loss are as long as they are and take no room: their part that comes again is kept
        once.

    Raises
    ------
    SceneError
        No such scene, or one that cannot be; a height below 0.
    """
    scene = as_scene(scene)
    try:
        height, rise = aloft
    except (TypeError, ValueError):
        raise SceneError(f"aloft = {shown(aloft)} is not possible: it is a height and a velocity upward.") from None
    height = require(
        "aloft's height", height, 0.0, 1e9, "the height of its lowest point over the floor is a number from 0 to 1e9"
    )
    least = 0.0 if height == 0 else -1e9
    rise = require(
        "aloft's rise", rise, least, 1e9, "its velocity upward is a number up to 1e9, of a hoop on the floor at least 0"
    )
    if (height or rise) and is_point_mass(scene.hoop.constants):
        raise SceneError("A point mass on a massless hoop is on the floor: what lands of it has no inertia.")
    return _motion(scene, _run(scene, (height / scene.hoop.R, rise * scene.time_unit / scene.hoop.R)))


def _motion(scene: Scene, log: Log) -> Motion:
    """The motion of a scene from what its run left; its lists are made when they are looked at."""
    sample = Sampler(scene, log)
    return Motion(
        scene,
        Deferred(lambda: sample.listing.phases),
        Deferred(lambda: sample.listing.turns),
        Deferred(lambda: sample.listing.pulses),
        _ended(log, scene.run, scene),
        sample,
        _period(log, scene.time_unit),
        log.code != at.WORK_BOUND,
    )


def _period(log: Log, unit: float) -> float | None:
    period = log.final[at.PERIOD]
    return period * unit if 0 < period < inf else None


def _ended(log: Log, run: Run, scene: Scene) -> str:
    """The reason, with the numbers of this motion in the units of a scene."""
    code, _, final = log
    words, period = reason(code), _period(log, scene.time_unit)
    unit = "" if scene.dimensionless else f" {Unit.TIME.label(scene)}"
    if code == at.TURNS_REACHED:
        return f"{words}: number {run.turns}"
    if code == at.WORK_BOUND:
        return f"{words} after {final[at.T] * scene.time_unit:.6g}{unit}: the motion goes on"
    if period is None or code not in (at.ROLLS, at.WHIRLS, at.ROLLS_ON):
        return words
    return f"{words}; period {period:.12g}{unit}"


def ended_in(motion: Motion, scene: Scene) -> str:
    """Why a motion of this solver ends, as ``motion.ended`` says it, with its times in the units of another scene."""
    return _ended(motion.sample.log, motion.scene.run, scene)  # type: ignore[attr-defined]


def unstored(told: Stored, scene: Scene) -> Motion:
    """The motion that a file has kept."""
    arrays = told.arrays
    return _motion(scene, Log(int(told.told["code"]), arrays["records"], arrays["final"].tolist()))


def load_motion(path: str | PathLike[str]) -> Motion:
    """A motion of the rigid hoop that was saved by :meth:`Motion.save`, the same to the last bit.

    Raises
    ------
    MotionFileError
        Not a saved motion, a damaged one, or one of the flexible hoop, which :func:`flexible.load_motion` reads.
    """
    return read(path, {"rigid": unstored}, scene_from_dict)
