"""The records of a run as phases, turns and pulses in the units of a scene; what comes again is kept once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import Any, Generic, TypeVar, overload

import numpy as np

from .kernel import layout as at
from .kernel.angle import angle_of
from .output.units import in_units
from .record.values import Array, Kind, Phase, Pulse, Side, States, Turn
from .scene import Scene

KINDS = {
    at.ROLL: Kind.ROLL, at.SKID: Kind.SKID, at.SPIN: Kind.SPIN,
    at.FLIGHT: Kind.FLIGHT, at.SKIM: Kind.SKIM, at.IMPACT: Kind.IMPACT,
}  # fmt: skip


def phases_of(sequence: float) -> tuple[Kind, ...]:
    """The phases of a pulse from the digits that the kernel notes them in; nothing of NaN."""
    found: list[Kind] = []
    rest = int(sequence) if sequence == sequence else 0
    while rest:
        rest, digit = divmod(rest, at.SEQUENCE_BASE)
        found.append(KINDS[digit])
    return tuple(reversed(found))


T = TypeVar("T")
Row = list[float]
Sample = Callable[[Array, Side], States]


class Lazy(Sequence[T], Generic[T]):
    """A sequence whose items are made when they are asked for; equal to any sequence of the same items."""

    def item(self, index: int) -> T:
        """Item number ``index`` >= 0."""
        raise NotImplementedError

    @overload
    def __getitem__(self, index: int) -> T: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[T, ...]: ...

    def __getitem__(self, index: int | slice) -> T | tuple[T, ...]:
        if isinstance(index, slice):
            return tuple(self.item(i) for i in range(*index.indices(len(self))))
        place = index + len(self) if index < 0 else index
        if not 0 <= place < len(self):
            raise IndexError(f"no item {index} among {len(self)}")
        return self.item(place)

    def __iter__(self) -> Iterator[T]:
        return (self.item(i) for i in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, (tuple, Lazy)) or len(self) != len(other):
            return NotImplemented if not isinstance(other, (tuple, Lazy)) else False
        return all(mine == theirs for mine, theirs in zip(self, other, strict=True))

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        first = [repr(self.item(i)) for i in range(min(2, len(self)))]
        rest = ["..."] if len(self) > 2 else []
        return f"<{len(self)} item{'s' * (len(self) != 1)}{': ' * bool(first)}{', '.join(first + rest)}>"


@dataclass(frozen=True, eq=False, repr=False)
class Repeated(Lazy[T]):
    """``before``, its last ``length`` items ``repeats`` times more, each time moved on by ``later``, and ``after``."""

    before: tuple[T, ...]
    length: int
    repeats: int
    after: tuple[T, ...]
    later: Callable[[T, int], T]

    def __len__(self) -> int:
        return len(self.before) + self.repeats * self.length + len(self.after)

    def item(self, index: int) -> T:
        beyond = index - len(self.before)
        if beyond < 0:
            return self.before[index]
        if beyond >= self.repeats * self.length:
            return self.after[beyond - self.repeats * self.length]
        times, place = divmod(beyond, self.length)
        return self.later(self.before[len(self.before) - self.length + place], times + 1)


class Deferred(Lazy[T]):
    """The sequence that ``make`` makes when it is first looked at."""

    def __init__(self, make: Callable[[], Sequence[T]]) -> None:
        self._make, self._made = make, None

    _make: Callable[[], Sequence[T]]
    _made: Sequence[T] | None

    @property
    def items(self) -> Sequence[T]:
        """The sequence itself."""
        if self._made is None:
            self._made = self._make()
        return self._made

    def __len__(self) -> int:
        return len(self.items)

    def item(self, index: int) -> T:
        return self.items[index]

    def __iter__(self) -> Iterator[T]:
        return iter(self.items)

    def __repr__(self) -> str:
        return repr(self.items)

    def __reduce__(self) -> tuple[Any, ...]:
        return _itself, (self.items,)


def _itself(items: Sequence[T]) -> Sequence[T]:
    return items


@dataclass(frozen=True, slots=True)
class Start:
    """Where a phase begins, and the one before it ends."""

    kind: Kind | None
    t: float
    phi: float


@dataclass(frozen=True, eq=False, repr=False)
class Spans(Lazy[Phase]):
    """Phases, each from its start to the start of the next; the last of ``starts`` is the end of the motion."""

    starts: Sequence[Start]

    def __len__(self) -> int:
        return len(self.starts) - 1

    def item(self, index: int) -> Phase:
        start, stop = self.starts[index], self.starts[index + 1]
        assert start.kind is not None
        return Phase(start.kind, start.t, stop.t, start.phi, stop.phi)


@dataclass(frozen=True, slots=True)
class Later:
    """Moves whatever has times and angles on by whole periods."""

    period: float
    angle: float

    def __call__(self, thing: Any, times: int) -> Any:
        moves = {"t": self.period, "t_start": self.period, "t_end": self.period}
        moves |= dict.fromkeys(("phi", "phi_start", "phi_end"), self.angle)
        changes = {name: getattr(thing, name) + times * by for name, by in moves.items() if hasattr(thing, name)}
        return replace(thing, **changes)


@dataclass(frozen=True, slots=True)
class Fold:
    """The part of a motion that comes again ``count`` times, from ``t`` on with ``period``; R = g = 1."""

    t: float
    period: float
    way: float
    whole: float
    count: int

    def back(self, times: Array) -> tuple[Array, Array]:
        """Times moved back to where the motion was computed, and by how many periods."""
        again = np.clip(np.floor((times - self.t) / self.period) + 1, 0, self.count)
        return times - again * self.period, again


class Listing:
    """Phases, turns and pulses of the records of a run, and the starts from which any instant can be computed.

    ``starts`` are records of phases, those after a repetition moved back by it; ``fold`` says what is repeated.
    ``sampler`` refers to what samples the motion, for the pulses to draw themselves.
    """

    def __init__(self, records: list[Row], end: Row, scene: Scene, sampler: Callable[[], Sample | None]) -> None:
        self.scene, self._sampler = scene, sampler
        self.fold: Fold | None = None
        self.later = Later(0.0, 0.0)
        self.end = end
        self.parts: tuple[list[Row], list[Row], list[Row]] = records, [], []
        tags = [row[0] for row in records]
        if at.REPEAT in tags:
            where = tags.index(at.REPEAT)
            row = records[where]
            self.fold = Fold(row[at.R_T], row[at.R_PERIOD], row[at.R_WAY], row[at.R_WHOLE], int(row[at.R_COUNT]))
            self.later = Later(self.fold.period * scene.time_unit, 2 * pi * self.fold.whole)
            self.parts = records[:where], records[where - int(row[at.R_RECORDS]) : where], records[where + 1 :]

    @cached_property
    def starting(self) -> list[list[Row]]:
        """Of each of the parts, the records of phases that go somewhere."""
        phases = [row for row in self.parts[0] + self.parts[2] if row[0] not in (at.TURN, at.PULSE)]
        kept = {id(row) for row in merged(phases, self.end)}
        return [[row for row in part if id(row) in kept] for part in self.parts]

    @cached_property
    def starts(self) -> tuple[tuple[float, ...], ...]:
        """The records from which any instant can be computed; the last is the end of the motion."""
        before, _, after = self.starting
        return tuple(map(tuple, [*before, *map(self._moved_back, [*after, self.end])]))

    @cached_property
    def phases(self) -> Sequence[Phase]:
        """Every phase."""
        before, once, after = self.starting
        edges = self._list(before, once, [*after, self.end], (*KINDS, at.END), self._start)
        return Spans(edges) if self.fold else Spans(edges)[:]

    @cached_property
    def turns(self) -> Sequence[Turn]:
        """Every turn."""
        return self._list(*self.parts, (at.TURN,), self._turn)

    @cached_property
    def pulses(self) -> Sequence[Pulse]:
        """Every pulse."""
        return self._list(*self.parts, (at.PULSE,), self._pulse)

    def _list(
        self, before: list[Row], once: list[Row], after: list[Row], tags: tuple[int, ...], make: Callable[[Row], T]
    ) -> Sequence[T]:
        head, tail = (tuple([make(row) for row in part if row[0] in tags]) for part in (before, after))
        if self.fold is None:
            return head + tail
        return Repeated(head, sum(row[0] in tags for row in once), self.fold.count, tail, self.later)

    def _moved_back(self, row: Row) -> Row:
        fold = self.fold
        if fold is None:
            return row
        moved = list(row)
        moved[1 + at.T] -= fold.count * fold.period
        moved[1 + at.X_C] -= fold.count * fold.way
        moved[1 + at.WHOLE] -= fold.count * fold.whole
        return moved

    def _start(self, row: Row) -> Start:
        return Start(KINDS.get(int(row[0])), row[1] * self.scene.time_unit, angle_of(row[2], row[3], row[4]))

    def _turn(self, row: Row) -> Turn:
        energy = row[at.TURN_ENERGY] * (1 + self.scene.hoop.mass_ratio)
        return in_units(Turn(row[1], angle_of(row[2], row[3], row[4]), row[6], energy), self.scene)

    def _pulse(self, row: Row) -> Pulse:
        mass = 1 + self.scene.hoop.mass_ratio
        pulse = Pulse(
            t_start=row[1],
            t_end=row[5],
            phi_start=angle_of(*row[2:5]),
            phi_end=angle_of(*row[6:9]),
            normal_impulse=row[9] * mass,
            friction_impulse=row[10] * mass,
            friction_loss=row[11] * mass,
            peak_normal_force=row[12] * mass,
            newton_restitution=row[13],
            poisson_restitution=row[14],
            energetic_restitution=row[15],
            cut=bool(row[at.PULSE_CUT]),
            sample=self._sampler(),
        )
        return in_units(pulse, self.scene)


def merged(starts: list[Row], end: Row) -> list[Row]:
    """Phases that go somewhere (an impact need not), neighbours of one kind as one.

    In the pulse of a tiny disk a phase may take less time than t can resolve: the angle tells.
    """
    kept: list[Row] = []
    for row, following in zip(starts, [*starts[1:], end], strict=True):
        if row[0] != at.IMPACT and following[1:5] == row[1:5] and len(starts) > 1:
            continue
        if kept and kept[-1][0] == row[0] and row[0] != at.IMPACT:
            continue
        kept.append(row)
    return kept or starts[:1]
