"""The pieces of a motion, rigid and flexible: its state at any time."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid import Motion, Scene, Side, States, scene_to_dict
from rigid.output.file import Stored
from rigid.output.units import in_units

from .motion import FlexibleMotion
from .packed import stored
from .segment import Segment

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Piece:
    """A part of the motion, rigid or flexible, between two times."""

    t_start: float
    t_end: float
    segment: Segment | None = None
    motion: Motion | None = None  # its clock starts at ``origin``
    origin: float = 0.0
    x_C: float = 0.0  # where the hoop's centre stands at the start of ``motion``

    def states(self, t: Array, side: Side) -> States:
        """At times of the whole motion, (n,)."""
        if self.segment is not None:
            return self.segment.states(t, side)
        assert self.motion is not None
        known = np.array([0.0, *(phase.t_end for phase in self.motion.phases), self.motion.t_end])
        own = on_clock(t, known, self.origin + known, t - self.origin, side)
        states = self.motion.at(np.clip(own, 0.0, self.motion.t_end), side)
        return replace(states, t=t, x_C=states.x_C + self.x_C)

    @property
    def instants(self) -> Array:
        """Where values may jump, (n,), in the clock of the whole motion."""
        if self.segment is not None:
            return self.segment["t"]
        assert self.motion is not None
        within = [self.origin + phase.t_end for phase in self.motion.phases if phase.t_end < self.t_end - self.origin]
        return np.array([self.t_start, *within, self.t_end])

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """What a file keeps of it, as plain data and as arrays: the records of a flexible one, or a rigid motion."""
        told: dict[str, Any] = {name: getattr(self, name) for name in ("t_start", "t_end", "origin", "x_C")}
        if self.segment is not None:
            return told | {"rise": self.segment.rise, "columns": list(self.segment.columns)}, self.segment.columns
        assert self.motion is not None
        rigid = self.motion.sample.stored(self.motion)  # type: ignore[attr-defined]
        return told | {"rigid": rigid.told, "scene": scene_to_dict(self.motion.scene)}, rigid.arrays


def on_clock(t: Array, known: Array, seen: Array, about: Array, side: Side) -> Array:
    """Times on one clock that are ``t`` on another, on the side of every known instant on which they are there.

    Parameters
    ----------
    t : (n,) array
        On the other clock.
    known, seen : (m,) arrays
        Instants on the one, and what they are on the other: round-off may be between them and a reckoning back.
    about : (n,) array
        ``t`` reckoned back.
    side : "right" or "left"
        Of instants that are one on the other clock alone the last, or the first.
    """
    order = np.argsort(known, kind="stable")
    known, seen = known[order], seen[order]
    first, behind = np.searchsorted(seen, t, "left"), np.searchsorted(seen, t, "right")
    last = len(seen) - 1
    low = np.where(first > 0, np.nextafter(known[np.maximum(first - 1, 0)], np.inf), -np.inf)
    high = np.where(behind <= last, np.nextafter(known[np.minimum(behind, last)], -np.inf), np.inf)
    met = known[np.clip(first if side == "left" else behind - 1, 0, last)]
    return np.where(behind > first, met, np.minimum(np.maximum(about, low), high))


@dataclass(frozen=True)
class Sampler:
    """States of a motion made of pieces, in the units of its scene."""

    pieces: tuple[Piece, ...]
    scene: Scene

    @cached_property
    def _instants(self) -> Array:
        return np.concatenate([piece.instants for piece in self.pieces])

    @property
    def step_times(self) -> Array:
        """Times of all records of the flexible segments, (n,), in the scene's unit; those of events and of hand-overs,
        where values jump, are there twice or more."""
        known = [piece.segment["t"] for piece in self.pieces if piece.segment is not None]
        met = [piece.t_start for piece in self.pieces[1:]] * 2
        return np.sort(np.concatenate([met, *known])) * self.scene.time_unit

    def stored(self, motion: FlexibleMotion) -> Stored:
        """See :func:`flexible.packed.stored`."""
        return stored(motion, [piece.stored() for piece in self.pieces])

    def __call__(self, t: Array, side: Side) -> States:
        if not self.pieces:
            raise ValueError("The motion has no states: it was not started, as its ``ended`` says.")
        unit = self.scene.time_unit
        asked = np.atleast_1d(np.asarray(t, dtype=float)).ravel()
        flat = asked if unit == 1 else on_clock(asked, self._instants, self._instants * unit, asked / unit, side)
        starts = np.array([piece.t_start for piece in self.pieces])
        owner = np.clip(np.searchsorted(starts, flat, side) - 1, 0, len(starts) - 1)
        columns = {field.name: np.empty_like(flat) for field in dataclasses.fields(States)}
        for i in np.unique(owner):
            mask = owner == i
            states = self.pieces[i].states(flat[mask], side)
            for name, column in columns.items():
                column[mask] = getattr(states, name)
        found = in_units(States(**{name: c.reshape(np.shape(t)) for name, c in columns.items()}), self.scene)
        return replace(found, t=asked.reshape(np.shape(t)))  # to the last bit as asked for
