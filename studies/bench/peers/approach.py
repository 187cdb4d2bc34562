"""What other programs make of the rigid pulse as their own stiffness, slip velocity or step goes to its limit.

Beside each stands the rigid hoop that its law of friction should tend to, and where it regularises friction as
:mod:`studies.limit.prediction` knows it, what that predicts of the very setting.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from flexible.contact.laws.listing import LAWS
from rigid import Scene, simulate

from ...inner.march.equations import PATCH, REGULARISED
from ...limit.prediction import predict
from ...plots.sheet import Column, Sheet, number
from ...running.files import StudyError
from . import drake_roll, exudyn_roll, mujoco_roll
from .exudyn_roll import Setting
from .rigid_pulse import Start, States, impulse_ratio, start_of
from .scipy_ivp import installed

STEPS = mujoco_roll.STEPS
VELOCITIES = (1e-2, 1e-3, 1e-4)
DRAKE_STEP = 2.5e-6


class Approach(NamedTuple):
    """One program on its way to its limit."""

    program: str
    law: str
    """Its friction, and what is refined."""
    settings: tuple[float, ...]
    """What is refined, coarse to fine."""
    ratios: tuple[float, ...]
    """J_F/J_N at each."""
    predicted: tuple[float, ...]
    """The same without running it, where its law is one of those that are predicted."""
    limit: float
    """Of the rigid hoop that its law tends to."""
    note: str = ""
    """Why there is no number, or what to know of it."""

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        return {name: list(value) if isinstance(value, tuple) else value for name, value in self._asdict().items()}


class Task(NamedTuple):
    """What to run of a program."""

    program: str
    package: str
    law: str
    settings: tuple[float, ...]
    run: Callable[[Start, float], States]
    static: bool = False
    """Whether it has a static coefficient."""
    known: bool = False
    """Whether its regularisation is that of the law that is predicted."""
    note: str = ""


def tasks() -> list[Task]:
    """All programs and ways."""
    found = [
        Task("MuJoCo", "mujoco", "one mu, convex cone; step, contact over 20 steps", STEPS,
             partial(_mujoco, stiff=20.0)),
        Task("MuJoCo", "mujoco", "the same, contact over the 2 steps that it needs", STEPS,
             partial(_mujoco, stiff=2.0), note="chatters: it touches in one step of a hundred"),
        Task("Drake SAP", "pydrake", "one mu, convex cone; step", STEPS, partial(_drake, "SAP")),
    ]  # fmt: skip
    for solver in ("Lagged", "Similar"):
        law = f"one mu, v/sqrt(v^2 + v_s^2); v_s, h = {DRAKE_STEP:g}"
        found.append(Task(f"Drake {solver}", "pydrake", law, VELOCITIES, partial(_drake, solver), known=True))
    law = "linear up to v_s; v_s, h = 2e-06"
    found.append(Task("Exudyn ConvexRoll", "exudyn", f"one mu, {law}", VELOCITIES, _exudyn))
    law = "mu_s at v_s, mu beyond; v_s, h = 2e-06"
    found.append(Task("Exudyn ConvexRoll", "exudyn", law, (1e-2, 1e-3, 3e-4), _exudyn, static=True))
    return found


def approaches(scene: Scene, progress: Callable[[float], None] | None = None) -> Iterator[Approach]:
    """Every program on the first pulse of a scene; those that are not installed say so.

    Raises
    ------
    StudyError
        See :func:`studies.inner.events.passage`.
    """
    laws = {False: _law(scene, REGULARISED), True: _law(scene, PATCH)}
    starts = {static: start_of(of) for static, of in laws.items()}
    terms = {static: predict(of, 1.0).terms["impulse_ratio"] for static, of in laws.items()}
    everything = tasks()
    for done, task in enumerate(everything):
        if progress is not None:
            progress(done / (len(everything) + 1))
        ratios, note = _ratios(task, starts[task.static])
        term = terms[task.static]
        predicted = tuple(float(term.at(v)) for v in task.settings) if task.known else ()
        yield Approach(task.program, task.law, task.settings, ratios, predicted, term.limit, note)
    yield _ipc(scene)


def _law(scene: Scene, code: int) -> Scene:
    """The scene under a law."""
    return scene.replace(contact={"law": next(name for name, law in LAWS.items() if law.code == code)})


def _ratios(task: Task, start: Start) -> tuple[tuple[float, ...], str]:
    if not installed(task.package):
        return (), f"{task.package} is not installed"
    found = []
    for setting in task.settings:
        try:
            found.append(impulse_ratio(start, task.run(start, setting)))
        except (RuntimeError, ValueError) as error:  # a program's own words for not getting there
            return tuple(found), f"at {setting:g}: {str(error).splitlines()[0]}"
    return tuple(found), task.note


def _mujoco(start: Start, step: float, stiff: float) -> States:
    return mujoco_roll.pulse(start, step, stiff)


def _drake(solver: str, start: Start, setting: float) -> States:
    if solver == "SAP":
        return drake_roll.pulse(start, solver, setting, 1e-3)
    return drake_roll.pulse(start, solver, DRAKE_STEP, setting)


def _exudyn(start: Start, velocity: float) -> States:
    return exudyn_roll.pulse(start, Setting(1e8, 1e4, velocity, 2e-6))


def _ipc(scene: Scene) -> Approach:
    """ipctk has potentials and no motion; the most that its friction carries says where one would tend."""
    program, law = "ipctk", "smooth mu_s to mu over v_s"
    if not installed("ipctk"):
        return Approach(program, law, (), (), (), float("nan"), "ipctk is not installed")
    import ipctk

    friction = scene.friction
    slip = np.linspace(0, 2, 20_001)
    most = max(ipctk.smooth_mu_f1(float(v), friction.mu_s, friction.mu, 1.0) for v in slip)
    pulses = simulate(scene.replace(friction={"mu_s": max(float(most), friction.mu)})).pulses
    if not pulses:
        raise StudyError("The rigid hoop of this friction has no pulse.")
    note = f"potentials for meshes, no motion; its |F|/N is at most {most:.4g}, the mu_s of the hoop it can tend to"
    return Approach(program, law, (), (), (), pulses[0].impulse_ratio, note)


def approach_sheet(found: list[Approach]) -> Sheet:
    """All of them, coarse to fine."""

    def told(values: tuple[float, ...], digits: int) -> str:
        return "\n".join(number(value, digits) for value in values) or "-"

    return Sheet(
        "What other programs tend to: J_F/J_N",
        [Column("program", [a.program for a in found], words=True)],
        [
            Column("friction; what is refined", [a.law for a in found], words=True),
            Column("refined", [told(a.settings, 3) for a in found]),
            Column("observed", [told(a.ratios, 6) for a in found]),
            Column("predicted", [told(a.predicted, 6) for a in found]),
            Column("limit\npredicted", [number(a.limit) for a in found]),
            Column("", [a.note for a in found], words=True),
        ],
    )
