"""A flexible segment of a motion: the march's records read as phases, turns, states and pulse measures.

Everything is in the solver's units, R = m = g = 1.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from rigid import Kind, Phase, Scene, Side, States, Turn
from rigid.output.cubic import cubic, hermite, root, slope_of
from rigid.output.sampling import share_taken

from .contact.laws.listing import LAWS
from .models.state import Record
from .motion import FlexiblePulse, History

Array = NDArray[np.float64]


#: columns whose rate is another one
RATES = {
    "phi": "omega", "y_C": "vertical_velocity", "normal_impulse": "normal_force", "friction_impulse": "friction_force",
}  # fmt: skip

NO_TIME = 1e-13
"""Time off the floor, in sqrt(R/g), that is the round-off of a sum and no flight."""


def peak(t: Array, y: Array) -> float:
    """Largest value of a sampled function, by the parabola through the largest sample and its neighbours."""
    i = int(np.argmax(y))
    if not 0 < i < len(y) - 1 or not t[i - 1] < t[i] < t[i + 1]:
        return float(y[i])
    left, right = (y[i] - y[i - 1]) / (t[i] - t[i - 1]), (y[i + 1] - y[i]) / (t[i + 1] - t[i])
    bend = (right - left) / (t[i + 1] - t[i - 1])
    if bend >= 0:
        return float(y[i])
    top = (t[i - 1] + t[i]) / 2 - left / (2 * bend)  # where the slope, linear, is 0
    return float(y[i] + (top - t[i]) * (left + bend * (top - t[i - 1])))


class Segment:
    """The records of one march of a scene as arrays, and what is read off them."""

    def __init__(self, records: list[Record], scene: Scene, rise: float) -> None:
        self.scene = scene
        self.rise = rise  # of the mass centre G, upward velocity at the first record
        table = np.array(records, dtype=float).reshape(-1, len(Record._fields))
        self.columns: dict[str, Array] = dict(zip(Record._fields, table.T.copy(), strict=True))

    @classmethod
    def of(cls, columns: dict[str, Array], scene: Scene, rise: float) -> Segment:
        """The same from its columns.

        Raises
        ------
        KeyError
            One that a record has is missing.
        """
        segment = cls([], scene, rise)
        segment.columns = {name: columns[name] for name in segment.columns}
        return segment

    def then(self, later: Segment) -> Segment:
        """This and a segment that goes on from its end, as one: totals go on."""
        totals = (*History.TOTALS, "off_floor")
        joined = Segment([], self.scene, self.rise)
        for name, column in self.columns.items():
            before = column[-1] if name in totals else 0.0
            joined.columns[name] = np.concatenate([column, later[name] + before])
        return joined

    def records(self) -> list[Record]:
        """The records again."""
        rows = zip(*(column.tolist() for column in self.columns.values()), strict=True)
        records = [Record(*row) for row in rows]
        return [each._replace(turns=int(each.turns), mode=int(each.mode)) for each in records]

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    @property
    def t_start(self) -> float:
        """Time of the first record, in sqrt(R/g)."""
        return float(self["t"][0])

    @property
    def t_end(self) -> float:
        """Time of the last record, in sqrt(R/g)."""
        return float(self["t"][-1])

    def held(self) -> Array:
        """Energy held at every record."""
        return self["kinetic"] + self["gravity"] + self["ring_strain"] + self["contact_spring"]

    def value(self, name: str, t: Array, side: Side = "right") -> Array:
        """A column at times ``t``: cubic where its rate is known too, linear otherwise.

        What friction took in a step it took as F times the slip velocity has it, which is known at its ends. An event
        left two records of one time, before and after it: ``side`` says which of them counts.
        """
        if name == "x_C":  # the way that it rolls, and what the hoop slips beside it
            slid = self._between(self["x_C"] - self["phi"], None, t, side)
            return slid + self.value("phi", t, side)
        if name == "friction_loss":
            return self._between(self[name], None, t, side, np.abs(self["friction_force"] * self["slip_velocity"]))
        rate = RATES.get(name)
        return self._between(self[name], None if rate is None else self[rate], t, side)

    def _between(self, y: Array, slope: Array | None, t: Array, side: Side, pace: Array | None = None) -> Array:
        """What has the values ``y`` at the records, and the rates ``slope`` if they are known, or in a step rates in
        proportion to ``pace``, which is linear there."""
        times = self["t"]
        i = np.clip(np.searchsorted(times, t, side) - 1, 0, len(times) - 2)
        if slope is not None:
            return hermite(t, times[i], times[i + 1], y[i], y[i + 1], slope[i], slope[i + 1])
        length = times[i + 1] - times[i]
        share = (t - times[i]) / np.where(length > 0, length, 1.0)
        share = np.where(length > 0, np.clip(share, 0.0, 1.0), 1.0 if side == "right" else 0.0)
        if pace is not None:
            share = share_taken(share, pace[i], pace[i + 1])
        return (1 - share) * y[i] + share * y[i + 1]

    def states(self, t: Array, side: Side = "right") -> States:
        """The common vocabulary at times ``t``; energy is all that is held."""
        names = (field.name for field in dataclasses.fields(States) if field.name not in ("t", "energy"))
        columns = {name: self.value(name, t, side) for name in names}
        return States(t=t, **columns, energy=self._between(self.held(), None, t, side))

    def kinds(self) -> list[Kind]:
        """What the patch does from each record to the next."""
        kinds = []
        columns = (self["normal_force"], self["friction_force"], self["stick_fraction"], self["slip_velocity"])
        for normal, friction, stuck, slip in zip(*columns, strict=True):
            if normal == 0:
                kinds.append(Kind.FLIGHT)
            elif stuck > 0:
                kinds.append(Kind.ROLL)
            else:  # a smooth floor says nothing of the direction
                kinds.append(Kind.SPIN if friction > 0 or (friction == 0 and slip < 0) else Kind.SKID)
        return kinds

    def phases(self, first: float = -np.inf, last: float = np.inf) -> list[Phase]:
        """Runs of one kind between the times ``first`` and ``last``."""
        t, phi = self["t"], self["phi"]
        runs: list[tuple[Kind, float, float, float, float]] = []
        for kind, i, start, end in self._stretches():
            if not (end > max(first, start) and start < last):
                continue
            start, end = max(start, first), min(end, last)
            phi_0, phi_1 = phi[i], phi[i + 1]
            if start > t[i] or end < t[i + 1]:
                phi_0, phi_1 = self.value("phi", np.array([start, end]))
            if runs and runs[-1][0] == kind:
                runs[-1] = (kind, runs[-1][1], end, runs[-1][3], phi_1)
            else:
                runs.append((kind, start, end, phi_0, phi_1))
        return [Phase(kind, *map(float, ends)) for kind, *ends in runs]

    def _stretches(self) -> Iterator[tuple[Kind, int, float, float]]:
        """Kind, number of the step, and times from and to which it does so: steps, or parts of them.

        A step belongs to what its end does where it begins in the air, unless an event opened it, and to what its start
        does elsewhere. A patch that stores nothing does what its slip velocity says, which is linear in between.
        """
        t, v, kinds = self["t"], self["slip_velocity"], self.kinds()
        creep = LAWS[self.scene.contact.law].rolls_below(self.scene.contact)
        for i in np.nonzero(np.diff(t) > 0)[0].tolist():
            start, end = float(t[i]), float(t[i + 1])
            if kinds[i] == Kind.FLIGHT and not (i and t[i] == t[i - 1]):
                yield kinds[i + 1], i, start, end
            elif kinds[i] != kinds[i + 1] and Kind.FLIGHT not in kinds[i : i + 2] and creep > 0 and v[i] != v[i + 1]:
                v_0, v_1 = float(v[i]), float(v[i + 1])
                at = ((edge - v_0) / (v_1 - v_0) for edge in (-creep, creep))
                cuts = [start, *(start + z * (end - start) for z in sorted(at) if 0 < z < 1), end]
                for low, high in pairwise(cuts):
                    slip = v_0 + (v_1 - v_0) * ((low + high) / 2 - start) / (end - start)
                    yield Kind.ROLL if abs(slip) < creep else Kind.SPIN if slip < 0 else Kind.SKID, i, low, high
            else:
                yield kinds[i], i, start, end

    def turns(self) -> list[Turn]:
        """Instants by which both the disk and the momentum of the rotation have turned."""
        turns = []
        for i in np.nonzero(np.diff(self["turns"]) > 0)[0] + 1:
            moment = self["t"][i : i + 1]
            state = self.states(moment)
            turns.append(
                Turn(float(moment[0]), float(state.phi[0]), float(state.slip_velocity[0]), float(state.energy[0]))
            )
        return turns

    def in_the_air(self, before: float) -> float:
        """The last time up to ``before`` at which nothing touches the floor, ``before`` itself if it always does."""
        t = self["t"][(self["t"] <= before) & (self["normal_force"] == 0)]
        return float(t[-1]) if len(t) else before

    def crossing(self, phi: float, after: float) -> float | None:
        """First time from ``after`` on at which the disk passes the angle ``phi``."""
        return next(self.crossings(phi, after), None)

    def crossings(self, phi: float, after: float = -np.inf) -> Iterator[float]:
        """All of them."""
        t, angle, omega = self["t"], self["phi"] - phi, self["omega"]
        takes_time = t[1:] > np.maximum(t[:-1], after)  # the two records of an event do not
        for i in np.nonzero((angle[:-1] * angle[1:] <= 0) & takes_time)[0]:
            start, length = float(t[i]), float(t[i + 1] - t[i])
            here = (angle[i], angle[i + 1], omega[i] * length, omega[i + 1] * length)
            low = float(max(after - start, 0.0) / length)
            if cubic(low, *here) * here[1] <= 0:
                yield start + length * root(here, low)

    def pulse(self, first: float, last: float) -> FlexiblePulse:
        """Measures between the times ``first`` and ``last``."""
        ends, t = np.array([first, last]), self["t"]
        inside = (t > first) & (t < last)
        grid = np.concatenate([[first], t[inside], [last]])

        def gain(name: str) -> float:
            return float(np.diff(self.value(name, ends))[0])

        opened, closed = self.value("normal_force", ends[:1]), self.value("normal_force", ends[1:], "left")
        normal_force = np.concatenate([opened, self["normal_force"][inside], closed])
        impulse = self.value("normal_impulse", grid)
        newton, poisson, energetic = self._restitutions(grid, impulse, normal_force)
        phi = self.value("phi", ends)
        strain, spring = (float(np.interp(grid, t, self[name]).max()) for name in ("ring_strain", "contact_spring"))
        off_floor = gain("off_floor")
        return FlexiblePulse(
            t_start=first,
            t_end=last,
            phi_start=float(phi[0]),
            phi_end=float(phi[1]),
            normal_impulse=float(impulse[-1] - impulse[0]),
            friction_impulse=gain("friction_impulse"),
            friction_loss=gain("friction_loss"),
            peak_normal_force=peak(grid, normal_force),
            newton_restitution=newton,
            poisson_restitution=poisson,
            energetic_restitution=energetic,
            time_off_floor=off_floor if off_floor > NO_TIME else 0.0,
            ring_energy_peak=strain,
            contact_energy_peak=spring,
            damping_loss=gain("damping_loss"),
            numerical_loss=gain("numerical_loss"),
            phases=tuple(self.phases(first, last)),
        )

    def _restitutions(self, t: Array, impulse: Array, normal_force: Array) -> tuple[float, float, float]:
        """Newton's, Poisson's and the energetic one, of N and its impulse at the times of a pulse from end to end.

        The mass centre's velocity follows from the impulse, however the ring bends, and so does the work of N on it,
        M (ydot^2/2 + y) between two instants. From each time to the next the impulse is a cubic;
        its rates at the ends of the pulse, within a step, are those of N's line there.
        """
        mass, steps = 1 + self.scene.hoop.mass_ratio, np.diff(t)
        velocity = self.rise + impulse / mass - (t - self.t_start)
        slope = normal_force / mass - 1
        risen = steps * ((velocity[1:] + velocity[:-1]) / 2 - steps * np.diff(slope) / 12)
        height = np.concatenate([[0.0], np.cumsum(risen)])
        i = int(np.argmax(velocity >= 0)) if (velocity >= 0).any() else len(t) - 1
        lowest, depth, speed = t[i], height[i], velocity[i]
        if i > 0 and velocity[i] > 0:
            h = steps[i - 1]
            here = (velocity[i - 1], velocity[i], slope[i - 1] * h, slope[i] * h)
            z, speed = root(here), 0.0
            lowest, depth = (
                t[i - 1] + z * h,
                height[i - 1] + z * h * (here[0] / 2 - z * (slope_of(z, *here) - here[2]) / 12),
            )
        compression = mass * (speed - velocity[0] + lowest - t[0])
        restitution = mass * (velocity[-1] - speed + t[-1] - lowest)
        absorbed = (speed**2 - velocity[0] ** 2) / 2 + depth
        returned = (velocity[-1] ** 2 - speed**2) / 2 + height[-1] - depth
        newton = float(-velocity[-1] / velocity[0]) if velocity[0] else 0.0
        poisson = float(restitution / compression) if compression > 0 else 0.0
        return newton, poisson, sqrt(max(0.0, float(-returned / absorbed))) if absorbed < 0 else 0.0


def history_of(segments: Iterable[Segment | None]) -> History:
    """Every step of the flexible segments of a motion, in the solver's units; totals go on from one to the next."""
    found = [segment for segment in segments if segment is not None]
    columns: dict[str, Array] = {}
    for field in dataclasses.fields(History):
        each, before = [np.empty(0)], 0.0
        for segment in found:
            each.append(segment[field.name] + before)
            before = float(each[-1][-1]) if field.name in History.TOTALS else 0.0
        columns[field.name] = np.concatenate(each)
    return History(**columns)
