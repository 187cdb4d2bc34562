"""What a picture shows, from a field series or from any motion, in one form: a :class:`Shot` per instant."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rigid import Motion

from ..fields import AnyArray, Block, Frame, SeriesError, disk_block
from ..placing import disk_in
from ..ring import ring_mesh
from ..series import Series, read
from .style import SI_UNITS, UNITS

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Shot:
    """One instant: bodies undeformed in the world, the contact's forces and slip where they are known."""

    time: float
    ring: Block
    disk: Block | None
    centre: Array  # of the undeformed ring, (2,)
    radius: float
    normal_force: float | None = None
    friction_force: float | None = None
    slip_velocity: float | None = None
    rim: Block | None = None

    @property
    def displacement(self) -> Array:
        """(n, 3) displacement of the ring's points; zero for a rigid ring."""
        value = self.ring.point_data.get("displacement")
        return np.zeros((len(self.ring.points), 3)) if value is None else np.asarray(value, dtype=float)

    def contact(self, factor: float) -> float:
        """Abscissa of the contact's middle with the rim displaced ``factor`` times.

        Below the centre where nothing of a pressure is known. The wall of a soft hoop touches far from there.
        """
        known = {} if self.rim is None else self.rim.point_data
        if self.rim is None or not {"pressure", "theta", "displacement"} <= set(known):
            return float(self.centre[0])
        pressure, theta, moved = (np.asarray(known[name], float) for name in ("pressure", "theta", "displacement"))
        x = np.asarray(self.rim.points, dtype=float)[:, 0] + factor * moved[:, 0]
        weight = pressure * np.gradient(theta)
        return float(weight @ x / weight.sum()) if weight.sum() > 0 else float(self.centre[0])


@dataclass(frozen=True)
class Curves:
    """N(t), F(t) over the whole run and the phases; empty arrays where they are not known."""

    t: Array
    normal_force: Array
    friction_force: Array
    phases: tuple[tuple[str, float, float], ...] = ()

    @cached_property
    def usual(self) -> float | None:
        """Median of the normal force if the pulses dwarf it, so that only a logarithm shows both; or None."""
        usual = float(np.median(self.normal_force)) if len(self.t) else 0.0
        return usual if usual > 0 and np.nanmax(self.normal_force) > 40 * usual else None

    def phase(self, time: float) -> str | None:
        """The kind of phase at ``time``, or None."""
        for kind, start, stop in self.phases:
            if start <= time <= stop and (stop > start or time == start):
                return kind
        return None


class Source(Protocol):
    """Anything that can be drawn."""

    @property
    def span(self) -> tuple[float, float]:
        """First and last time, in the run's unit."""

    @property
    def title(self) -> str:
        """Printed above the picture."""

    @property
    def units(self) -> dict[str, str]:
        """Unit of each field, for colour bars."""

    @property
    def curves(self) -> Curves:
        """Forces and phases over time, below the picture."""

    def instant(self, time: float) -> float:
        """The time of what is seen at a time."""

    def shot(self, time: float) -> Shot:
        """What is seen at a time."""


@dataclass(frozen=True)
class SeriesSource:
    """Fields of a flexible run; an instant shows the frame nearest to it."""

    series: Series

    @property
    def span(self) -> tuple[float, float]:
        """First and last time of the frames."""
        return float(self.series.times[0]), float(self.series.times[-1])

    @property
    def title(self) -> str:
        """As the run called itself."""
        return str(self.series.about["title"])

    @property
    def units(self) -> dict[str, str]:
        """Unit of each field."""
        return dict(self.series.about["units"])

    @cached_property
    def curves(self) -> Curves:
        """The history stored beside the frames."""
        kept = self.series.history
        none = np.empty(0)
        t, normal, friction = (
            np.asarray(kept.get(name, none), dtype=float) for name in ("t", "normal_force", "friction_force")
        )
        if not len(t) == len(normal) == len(friction):
            t = normal = friction = none
        kinds = (kept.get(name, none) for name in ("phase_kind", "phase_start", "phase_end"))
        phases = tuple((str(kind), float(a), float(b)) for kind, a, b in zip(*kinds, strict=False))
        return Curves(t, normal, friction, phases)

    def instant(self, time: float) -> float:
        """That of the frame nearest to ``time``."""
        return float(self.series.times[self.series.nearest_index(time)])

    def shot(self, time: float) -> Shot:
        """The frame nearest to ``time``."""
        return self.frame_shot(self.series.nearest(time))

    def frame_shot(self, frame: Frame) -> Shot:
        """A frame as it is drawn."""
        ring = frame.blocks.get("ring")
        if ring is None:
            raise SeriesError(f"{self.series.pvd} has no ring at t = {frame.time}.")
        points: Array = np.asarray(ring.points, dtype=np.float64)
        low, high = points.min(axis=0), points.max(axis=0)
        curves = self.curves
        force: dict[str, float] = {}
        if len(curves.t):
            for name in ("normal_force", "friction_force"):
                force[name] = float(np.interp(frame.time, curves.t, getattr(curves, name)))
        slip = self.series.history.get("slip_velocity")
        if slip is not None and len(slip) == len(curves.t):
            sticks = curves.phase(frame.time) == "roll"  # what a stuck patch creeps by is no slip
            force["slip_velocity"] = 0.0 if sticks else float(np.interp(frame.time, curves.t, slip))
        return Shot(
            time=frame.time,
            ring=ring,
            disk=frame.blocks.get("disk"),
            rim=frame.blocks.get("rim"),
            centre=(low + high)[:2] / 2,
            radius=float((high - low).max() / 2),
            **force,
        )


@dataclass(frozen=True)
class MotionSource:
    """A motion of a rigid hoop, or of any solver, drawn undeformed."""

    motion: Motion

    @property
    def span(self) -> tuple[float, float]:
        """From release to the end."""
        return 0.0, self.motion.t_end

    @property
    def title(self) -> str:
        """The scene in numbers."""
        hoop, friction = self.motion.scene.hoop, self.motion.scene.friction
        return (
            f"k = {hoop.k:g}, r = {hoop.r:g}, m_h/m = {hoop.mass_ratio:g}, μ_s = {friction.mu_s:g}, μ = {friction.mu:g}"
        )

    @property
    def units(self) -> dict[str, str]:
        """The paper's, or SI if the scene is."""
        hoop = self.motion.scene.hoop
        return dict(UNITS if hoop.R == hoop.m == hoop.g == 1 else SI_UNITS)

    @cached_property
    def curves(self) -> Curves:
        """N(t), F(t) sampled within each phase, so that its jumps stay jumps."""
        times = []
        start, stop = self.span
        for phase in self.motion.phases:
            duration = phase.t_end - phase.t_start
            inside = max(1e-9 * duration, 4 * float(np.spacing(phase.t_end)))  # a phase may be that short
            ends = phase.t_start + inside, phase.t_end - inside
            if ends[0] < ends[1]:
                count = max(40, round(900 * duration / (stop - start)))
                within = [np.linspace(*ends, count)]
                for pulse in self.motion.pulses:
                    peak = self._peaked(pulse.t_start, pulse.t_end)
                    within.append(peak[(peak > ends[0]) & (peak < ends[1])])
                times.append(np.unique(np.concatenate(within)))
        t = np.concatenate(times) if times else np.empty(0)
        states = self.motion.at(t)
        phases = tuple((str(p.kind), p.t_start, p.t_end) for p in self.motion.phases)
        return Curves(t, states.normal_force, states.friction_force, phases)

    def _peaked(self, start: float, stop: float) -> Array:
        """Times of a pulse, ever denser toward its peak, which may be a millionth of it wide."""
        times = np.linspace(start, stop, 200)
        for _ in range(6):
            top = int(np.argmax(self.motion.at(times).normal_force))
            around = np.linspace(times[max(top - 1, 0)], times[min(top + 1, len(times) - 1)], 20)
            times = np.unique(np.concatenate([times, around]))
        return times

    @cached_property
    def _parts(self) -> tuple[AnyArray, Array, float, float]:
        scene = self.motion.scene
        R = scene.hoop.R
        inner = R * (1 - scene.wall)
        ring = ring_mesh(inner, R, around=180)
        away, disk = disk_in(scene)
        return ring.quad9, ring.points, R * disk, R * away

    def instant(self, time: float) -> float:
        """That time: a motion is known at any."""
        return float(time)

    def shot(self, time: float) -> Shot:
        """The state at ``time``."""
        state = self.motion.at(time)
        sticks = self.curves.phase(float(time)) == "roll"
        quad9, points, disk, distance = self._parts
        sin, cos = np.sin(float(state.phi)), np.cos(float(state.phi))
        axes = np.array([[sin, cos], [cos, -sin]])
        centre = np.array([float(state.x_C), float(state.y_C)])
        return Shot(
            time=float(time),
            ring=Block(centre + points @ axes, quad9, 28),
            disk=disk_block(centre + distance * axes[0], disk, float(state.phi)),
            centre=centre,
            radius=self.motion.scene.hoop.R,
            normal_force=float(state.normal_force),
            friction_force=float(state.friction_force),
            slip_velocity=0.0 if sticks else float(state.slip_velocity),
        )


def source_of(thing: Series | Motion | str | Path) -> Source:
    """What a series, the folder of one, or a motion gives to draw.

    Raises
    ------
    SeriesError
        No series there, or something else.
    """
    if isinstance(thing, (str, Path)):
        thing = read(thing)
    if isinstance(thing, Series):
        return SeriesSource(thing)
    if not isinstance(thing, Motion):
        raise SeriesError(f"a {type(thing).__name__} cannot be drawn: it takes a series, its folder, or a motion.")
    return MotionSource(thing)
