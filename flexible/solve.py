"""A scene through the flexible hoop: simulate(scene) -> FlexibleMotion.

``resolve = "pulses"`` runs the rigid closed form between pulses and the flexible hoop only inside them: each
flexible stretch begins a little before the rigid hoop's pulse, in quasi-static equilibrium, and ends with it. The
rigid hoop is always the one that the contact law tends to (:mod:`flexible.limit`).
``resolve = "all"`` is flexible from the release on.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rigid
from rigid import Hoop, Kind, Motion, Phase, Release, Run, Scene, States, Turn

from .contact import STICK
from .levels import Hoop as FlexibleHoop
from .levels import Range, hoop_of
from .limit import rigid_limit
from .march import MarchError, Record, State, march
from .motion import FlexibleMotion, FlexiblePulse, History, Kept, Ledger
from .start import hand_over
from .stretch import Stretch

Array = NDArray[np.float64]
Progress = Callable[[float], None]

LEAD = 0.5  # a flexible stretch begins this many pulse lengths before the pulse, to let its start settle


@dataclass(frozen=True)
class _Piece:
    """A part of the motion, rigid or flexible, between two times."""

    t_start: float
    t_end: float
    stretch: Stretch | None = None
    motion: Motion | None = None  # its clock starts at ``origin``
    origin: float = 0.0
    x_C: float = 0.0  # where the hoop's centre stands at the start of ``motion``

    def states(self, t: Array) -> States:
        if self.stretch is not None:
            return self.stretch.states(t)
        assert self.motion is not None
        states = self.motion.at(np.clip(t - self.origin, 0.0, self.motion.t_end))
        return replace(states, t=t, x_C=states.x_C + self.x_C)


@dataclass(frozen=True)
class _Sampler:
    """States of a motion made of pieces, in the units of its scene."""

    pieces: tuple[_Piece, ...]
    scene: Scene

    def __call__(self, t: Array) -> States:
        flat = np.atleast_1d(np.asarray(t, dtype=float)).ravel() / self.scene.time_unit
        starts = np.array([piece.t_start for piece in self.pieces])
        owner = np.clip(np.searchsorted(starts, flat, side="right") - 1, 0, len(starts) - 1)
        columns = {field.name: np.empty_like(flat) for field in dataclasses.fields(States)}
        for i in np.unique(owner):
            mask = owner == i
            states = self.pieces[i].states(flat[mask])
            for name, column in columns.items():
                column[mask] = getattr(states, name)
        return _with_units(States(**{name: c.reshape(np.shape(t)) for name, c in columns.items()}), self.scene)


_DIMENSIONS = {
    "t": "time_unit", "t_start": "time_unit", "t_end": "time_unit", "time_off_floor": "time_unit",
    "x_C": "length_unit", "y_C": "length_unit", "patch_length": "length_unit",
    "slip_velocity": "velocity_unit", "approach_velocity": "velocity_unit",
    "normal_force": "force_unit", "friction_force": "force_unit", "peak_normal_force": "force_unit",
    "normal_impulse": "impulse_unit", "friction_impulse": "impulse_unit",
}  # fmt: skip
_ENERGIES = {
    "energy", "initial", "kinetic", "gravity", "ring_strain", "contact_spring", "friction_loss", "damping_loss",
    "hand_over", "numerical_loss", "ring_energy_peak", "contact_energy_peak",
}  # fmt: skip


def _with_units(value: Any, scene: Scene) -> Any:
    """A dataclass of the solver's numbers with every field in the units of the scene."""
    changes: dict[str, Any] = {}
    for field in dataclasses.fields(value):
        content = getattr(value, field.name)
        if field.name in _DIMENSIONS:
            changes[field.name] = content * _unit(scene, _DIMENSIONS[field.name])
        elif field.name in _ENERGIES:
            changes[field.name] = content * scene.energy_unit
        elif field.name == "omega":
            changes[field.name] = content / scene.time_unit
        elif field.name == "phases":
            changes[field.name] = tuple(_with_units(phase, scene) for phase in content)
    return replace(value, **changes)


def _unit(scene: Scene, name: str) -> float:
    return scene.hoop.R if name == "length_unit" else getattr(scene, name)


def dimensionless(scene: Scene) -> Scene:
    """The same scene in the paper's scaling, R = m = g = 1."""
    release, run = scene.release, scene.run
    return scene.replace(
        hoop={"R": 1.0, "m": 1.0, "g": 1.0},
        release={
            "omega0": release.omega0 * scene.time_unit,
            "slip0": release.slip0 / scene.velocity_unit,
        },
        run=run if run.t_end is None else Run(t_end=run.t_end / scene.time_unit),
    )


class _Progress:
    """Fraction done, from the angle swept within the stretch that runs."""

    def __init__(self, report: Progress | None) -> None:
        self.report = report

    def watch(self, low: float, high: float, fraction: Callable[[State], float]) -> Callable[[State], None] | None:
        if self.report is None:
            return None
        report = self.report
        return lambda state: report(low + (high - low) * min(max(fraction(state), 0.0), 1.0))


class _Builder:
    """Collects the pieces of a motion, in the solver's units."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.hoop: Hoop = scene.hoop
        self.pieces: list[_Piece] = []
        self.phases: list[Phase] = []
        self.turns: list[Turn] = []
        self.pulses: list[FlexiblePulse] = []
        self.steps = 0
        self.range: Range
        self.kept: list[Kept] | None = None
        self.completed = True
        self.t = 0.0
        self.x_C = 0.0
        self.initial: float | None = None
        self.hand_over = 0.0
        self.friction_loss = 0.0
        self.damping_loss = 0.0
        self.numerical_loss = 0.0
        self.held: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)

    def _add_phase(self, phase: Phase) -> None:
        if phase.t_end <= phase.t_start and phase.kind != Kind.IMPACT:
            return
        if self.phases and self.phases[-1].kind == phase.kind != Kind.IMPACT:
            self.phases[-1] = replace(self.phases[-1], t_end=phase.t_end, phi_end=phase.phi_end)
        else:
            self.phases.append(phase)

    def _meet(self, energy: float) -> None:
        """Energy at the start of a piece; what differs from the end of the last one was handed over."""
        if self.initial is None:
            self.initial = energy
        else:
            self.hand_over += energy - sum(self.held)

    def add_rigid(self, motion: Motion, until: float) -> None:
        """The first ``until`` of a rigid motion that begins now."""
        if until <= 0 and self.pieces:
            return
        ends = motion.at(np.array([0.0, until]))
        self._meet(float(ends.energy[0]))
        self.friction_loss += float(ends.energy[0] - ends.energy[1])
        potential = float((1 + self.hoop.mass_ratio) * (ends.y_C[1] + self.hoop.e * np.cos(ends.phi[1])))
        self.held = (float(ends.energy[1]) - potential, potential, 0.0, 0.0)
        for phase in motion.phases:
            if phase.t_start < until:
                end = min(phase.t_end, until)
                phi_end = phase.phi_end if end == phase.t_end else float(ends.phi[1])
                self._add_phase(replace(phase, t_start=self.t + phase.t_start, t_end=self.t + end, phi_end=phi_end))
        self.turns += [replace(turn, t=self.t + turn.t) for turn in motion.turns if turn.t <= until]
        self.pieces.append(_Piece(self.t, self.t + until, motion=motion, origin=self.t, x_C=self.x_C))
        self.x_C += float(ends.x_C[1])
        self.t += until

    def add_flexible(self, records: list[Record], attempts: int) -> Stretch:
        """A flexible stretch that begins now."""
        stretch = Stretch(records, self.hoop)
        held = stretch.held()
        self._meet(float(held[0]))
        friction, damping = float(stretch["friction_loss"][-1]), float(stretch["damping_loss"][-1])
        self.friction_loss += friction
        self.damping_loss += damping
        self.numerical_loss += float(held[0] - held[-1]) - friction - damping
        last = records[-1]
        self.held = (last.kinetic, last.gravity, last.ring_strain, last.contact_spring)
        for phase in stretch.phases():
            self._add_phase(phase)
        self.turns += stretch.turns()
        self.pieces.append(_Piece(stretch.t_start, stretch.t_end, stretch=stretch))
        self.t, self.x_C = last.t, last.x_C
        self.steps += attempts
        return stretch

    def march(
        self, hoop: FlexibleHoop, state: State, *arguments: Any, **options: Any
    ) -> tuple[State, list[Record], int, str]:
        """:func:`march.march`, watching the ring's range, and the states if they are to be kept."""
        progress = options.pop("progress", None)

        def watch(now: State) -> None:
            self.range(now)
            if progress is not None:
                progress(now)

        states: list[State] = []
        if self.kept is not None:
            options["keep"] = states.append
        options["progress"] = watch
        result = march(hoop, state, *arguments, **options)
        if self.kept is not None:
            self.kept.append(Kept(hoop, tuple(states)))
        return result

    def motion(self, scene: Scene, ended: str, history: bool) -> FlexibleMotion:
        """The motion in the units of ``scene``."""
        ledger = Ledger(
            self.initial or 0.0, *self.held, self.friction_loss, self.damping_loss, self.hand_over, self.numerical_loss
        )
        return FlexibleMotion(
            scene=scene,
            phases=tuple(_with_units(phase, scene) for phase in self.phases),
            turns=tuple(_with_units(turn, scene) for turn in self.turns),
            pulses=tuple(_with_units(pulse, scene) for pulse in self.pulses),
            ended=ended,
            completed=self.completed,
            sample=_Sampler(tuple(self.pieces), scene),
            ledger=_with_units(ledger, scene),
            steps=self.steps,
            history=_with_units(self._history(), scene) if history else None,
            kept=tuple(self.kept or ()),
        )

    def _history(self) -> History:
        stretches = [piece.stretch for piece in self.pieces if piece.stretch is not None]
        return History(
            **{
                field.name: np.concatenate([stretch[field.name] for stretch in stretches] or [np.empty(0)])
                for field in dataclasses.fields(History)
            }
        )


def simulate(scene: Scene, *, history: bool = False, progress: Progress | None = None) -> FlexibleMotion:
    """Move the flexible hoop through a scene.

    Parameters
    ----------
    scene : Scene
    history : bool
        Keep every step, as ``motion.history``, and the ring's states, of which fields are made.
    progress : callable, optional
        Called with the fraction done, 0 to 1.

    Returns
    -------
    FlexibleMotion
        In the units of the scene.

    Raises
    ------
    SceneError
        A point mass without inertia cannot ride on a flexible hoop.
    """
    if scene.hoop.k == 0 and scene.hoop.mass_ratio == 0:
        raise rigid.SceneError(
            "hoop.k = 0 is not possible here: the flexible hoop needs a disk with a radius, or a hoop with a mass."
        )
    inner = dimensionless(scene)
    hoop = hoop_of(inner)
    builder = _Builder(inner)
    builder.range = Range(hoop)
    builder.kept = [] if history else None
    run = _through_pulses if scene.solve.resolve == "pulses" else _throughout
    ended = run(inner, hoop, builder, _Progress(progress))
    complaint = builder.range.complaint()
    return builder.motion(scene, f"{ended}; {complaint}" if complaint else ended, history)


def _through_pulses(scene: Scene, hoop: FlexibleHoop, builder: _Builder, progress: _Progress) -> str:
    """Rigid between pulses, flexible inside."""
    current = scene
    done = 0
    while True:
        motion = rigid.simulate(rigid_limit(current))
        pulse = next((p for p in motion.pulses if p.t_start > 0 or not builder.pulses), None)
        # a run to rest is over when the rigid hoop would slip no more; what it rolls through is no pulse with a loss
        at_rest = scene.run.until == "rest" and all(phase.kind == Kind.ROLL for phase in motion.phases)
        if pulse is None or at_rest:
            builder.add_rigid(motion, motion.t_end)
            builder.completed = motion.completed
            over = scene.run.turns is not None and len(builder.turns) >= scene.run.turns
            return _last_turn(scene.run.turns or 0) if over else motion.ended
        start = max(0.0, pulse.t_start - LEAD * (pulse.t_end - pulse.t_start))
        try:
            state = hand_over(hoop, motion, start, scene.contact.law)
        except MarchError as error:
            builder.add_rigid(motion, start)
            return str(error) + _too_soft(scene)
        builder.add_rigid(motion, start)
        state = replace(state, t=builder.t, x_C=builder.x_C)
        sign = 1.0 if pulse.phi_end > pulse.phi_start else -1.0
        limit = builder.t + 4 * (pulse.t_end - start)

        def finished(s: State, sign: float = sign, end: float = pulse.phi_end, limit: float = limit) -> float:
            return max(sign * (s.pos[2] - end), s.t - limit)

        span = (float(state.pos[2]), pulse.phi_end)
        low, high = done / (done + 2), (done + 1) / (done + 3)
        watch = progress.watch(low, high, _swept(span))
        state, records, attempts, trouble = builder.march(hoop, state, finished, scene.solve.rtol, progress=watch)
        stretch = builder.add_flexible(records, attempts)
        if not trouble and sign * (float(state.pos[2]) - pulse.phi_end) < 0:
            trouble = f"stopped at t = {state.t:.6g}, phi = {state.pos[2]:.6g}: the hoop does not get through the pulse"
        if trouble:
            builder.completed = False
            return trouble + _too_soft(scene)
        first = stretch.crossing(pulse.phi_start, stretch.t_start)
        builder.pulses.append(stretch.pulse(stretch.t_start if first is None else first, stretch.t_end))
        done += 1
        if scene.run.until == "pulse":
            return "the first pulse is over"
        rest = _rest_of(scene.run, builder)
        if rest is None:
            return "the time to run is over" if scene.run.turns is None else _last_turn(scene.run.turns)
        slip = 0.0 if state.mode == STICK else state.slip_velocity
        release = Release(float(state.pos[2]), float(state.vel[2]), float(slip))
        current = dataclasses.replace(scene, release=release, run=rest)


def _too_soft(scene: Scene) -> str:
    """What to say of a run that failed with a ring too soft for its disk."""
    needed = 1.3 / scene.hoop.k if scene.hoop.k > 0 else inf
    if scene.ring.bending_stiffness >= 10 * needed:
        return ""
    return f"; the pulse of so small a disk wants ring.bending_stiffness well above 1.3/k = {needed:.3g}"


def _last_turn(number: int) -> str:
    return f"the last turn asked for is reached: number {number}"


def _swept(span: tuple[float, float]) -> Callable[[State], float]:
    """Fraction of an angle swept."""
    return lambda state: (state.pos[2] - span[0]) / (span[1] - span[0])


def _rest_of(run: Run, builder: _Builder) -> Run | None:
    """How far there is still to run; None if that is reached."""
    if run.turns is not None:
        left = run.turns - len(builder.turns)
        return Run(turns=left) if left > 0 else None
    if run.t_end is not None:
        return Run(t_end=run.t_end - builder.t) if run.t_end > builder.t else None
    return run


def _throughout(scene: Scene, hoop: FlexibleHoop, builder: _Builder, progress: _Progress) -> str:
    """Flexible from the release on; pulses are measured over the rigid hoop's intervals."""
    reference = rigid.simulate(rigid_limit(scene))
    state = hand_over(hoop, reference, 0.0, scene.contact.law)
    windows = [(p.phi_start, p.phi_end) for p in reference.pulses]
    run = scene.run
    horizon = run.t_end if run.t_end is not None else reference.t_end
    counted = {"turns": 0, "omega": float(state.vel[2])}

    def finished(s: State) -> float:
        if run.t_end is not None:
            return s.t - run.t_end
        if run.until == "pulse" and windows:
            sign = 1.0 if windows[0][1] > windows[0][0] else -1.0
            return sign * (s.pos[2] - windows[0][1])
        if run.turns is not None and counted["turns"] >= run.turns:
            return 0.0
        return s.t - 4 * horizon - 10

    report = progress.watch(0.0, 1.0, lambda s: s.t / horizon)

    def watch(s: State) -> None:
        if counted["omega"] * s.vel[2] < 0:
            counted["turns"] += 1
        if s.vel[2] != 0:
            counted["omega"] = float(s.vel[2])
        if report is not None:
            report(s)

    state, records, attempts, trouble = builder.march(hoop, state, finished, scene.solve.rtol, progress=watch)
    stretch = builder.add_flexible(records, attempts)
    after = -inf
    for first_angle, last_angle in windows:
        first = stretch.crossing(first_angle, after)
        last = None if first is None else stretch.crossing(last_angle, first)
        if first is None or last is None:
            break
        builder.pulses.append(stretch.pulse(first, last))
        after = last
    if not trouble and run.turns is not None and counted["turns"] < run.turns == len(reference.turns):
        trouble = f"stopped at t = {state.t:.6g}: the rigid hoop turned that often in a quarter of this time"
    builder.completed = reference.completed and not trouble
    return trouble + _too_soft(scene) if trouble else reference.ended
