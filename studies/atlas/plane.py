"""The plane of an atlas: two quantities of a scene, each over a range, and the rigid hoops at any of its points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isclose, isfinite, log10
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid import Kind, Scene, SceneError, load_scene, scene_names, simulate_batch
from rigid.allowed import shown
from rigid.output.units import without_units

Array = NDArray[np.float64]

SYMBOLS = {
    "hoop.k": "radius of the disk over that of the hoop, $k$",
    "hoop.r": "outer over inner radius of the hoop, $r$",
    "hoop.mass_ratio": "mass of the hoop over that of the disk, $m_h/m$",
    "friction.mu_s": r"static friction $\mu_s$",
    "friction.mu": r"friction $\mu$",
    "release.phi0_deg": r"angle of release $\varphi_0$ [degrees]",
    "release.omega0": r"angular velocity at release $\omega_0$ [$\sqrt{g/R}$]",
    "release.slip0": r"slip velocity at release $v_0$ [$\sqrt{gR}$]",
    "landing.restitution": "restitution of landings",
}
"""What may be varied, and how an axis says it."""

SPREAD = 100.0
"""Ratio of the ends of a range from which on it runs evenly in the logarithm."""

NO_PULSE, NO_HOOP = 0, -1
"""In place of a sequence: the motion has no pulse, there is no hoop with mu_s < mu."""


class Axis(NamedTuple):
    """A quantity and its range."""

    key: str
    low: float
    high: float

    @property
    def logarithmic(self) -> bool:
        """Whether the range runs evenly in the logarithm."""
        return self.low > 0 and self.high / self.low >= SPREAD

    def at(self, share: Array) -> Array:
        """Values at shares 0 to 1 of the way."""
        if self.logarithmic:
            way = 10 ** (log10(self.low) + share * (log10(self.high) - log10(self.low)))
            return np.asarray(np.clip(way, self.low, self.high))  # the ends themselves, not their round-off
        return self.low + share * (self.high - self.low)

    def share(self, value: Array) -> Array:
        """The inverse of :meth:`at`."""
        if self.logarithmic:
            return np.asarray(np.log10(value / self.low) / log10(self.high / self.low))
        return (value - self.low) / (self.high - self.low)


class Seen(NamedTuple):
    """The first pulses of m hoops, each field (m,)."""

    sequence: NDArray[np.int64]
    """Phases, as :attr:`rigid.Batch.sequence` numbers them, or ``NO_PULSE`` or ``NO_HOOP``."""
    share: Array
    """J_F/(mu J_N); 1 or -1 is slip in one direction throughout. 0 without friction."""
    loss: Array
    """Work done against friction over the weight of the whole hoop times R."""
    peak: Array
    """Decimal logarithm of the largest N over the weight; NaN where a jam knows no largest."""
    hops: NDArray[np.int64]
    """How often the hoop has left the floor before the pulse was over."""
    jams: NDArray[np.bool_]
    """Whether it has jammed: Coulomb's law had no finite force, and an impact without collision ended the slip."""


@dataclass(frozen=True, slots=True)
class Region:
    """The hoops whose first pulse has one sequence of phases."""

    sequence: int
    """Its number in the arrays."""
    phases: str
    """In words."""
    share: float
    """Of the map's area."""


@dataclass(frozen=True, slots=True)
class Plane:
    """Two axes through a scene; what they do not vary is that of the scene.

    Where one of ``friction.mu`` and ``friction.mu_s`` is varied alone, their ratio is that of the scene; mu = 0 beside
    a mu_s above 0 stays 0.
    """

    scene: Scene
    across: Axis
    up: Axis

    @property
    def keys(self) -> tuple[str, str]:
        """The two keys."""
        return self.across.key, self.up.key

    def hoops(self, x: Array, y: Array) -> dict[str, Array]:
        """The table that :func:`rigid.simulate_batch` takes, for values of the two quantities."""
        scene, values = self.scene, dict(zip(self.keys, (x, y), strict=True))
        friction, release = scene.friction, without_units(scene.release, scene)
        told = {
            "k": values.get("hoop.k", scene.hoop.k),
            "r": values.get("hoop.r", scene.hoop.r),
            "mass_ratio": values.get("hoop.mass_ratio", scene.hoop.mass_ratio),
            "phi0": np.deg2rad(values["release.phi0_deg"]) if "release.phi0_deg" in values else release.phi0,
            "omega0": values.get("release.omega0", release.omega0),
            "slip0": values.get("release.slip0", release.slip0),
            "restitution": values.get("landing.restitution", scene.landing.restitution),
        }
        ratio = friction.mu_s / friction.mu if friction.mu > 0 else 1.0
        slippery = friction.mu == 0 < friction.mu_s  # it sticks, and slips without friction
        if "friction.mu" in values:
            told["mu"] = values["friction.mu"]
            told["mu_s"] = values.get("friction.mu_s", ratio * values["friction.mu"])
        else:
            told["mu_s"] = values.get("friction.mu_s", friction.mu_s)
            told["mu"] = told["mu_s"] / ratio if "friction.mu_s" in values and not slippery else friction.mu
        return {name: np.broadcast_to(np.asarray(column, dtype=float), x.shape) for name, column in told.items()}

    def run(self, x: Array, y: Array) -> Seen:
        """The first pulses of the hoops with these values, each (m,).

        What is left of a pulse in which a hoop is released is none: that would measure the release.
        """
        hoops = self.hoops(x, y)
        there = hoops["mu_s"] >= hoops["mu"]
        batch = simulate_batch({name: column[there] for name, column in hoops.items()}, until="pulse")
        first = np.arange(len(batch)), (batch.cut[:, 0] == 1).astype(int)  # at most one is cut by the release
        seen = batch.cut[first] == 0
        sequence = np.full(x.shape, NO_HOOP, dtype=np.int64)
        sequence[there] = np.where(seen, np.nan_to_num(batch.sequence[first]), NO_PULSE).astype(np.int64)
        columns = np.full((3, *x.shape), np.nan)
        mu, weight = hoops["mu"][there], 1 + hoops["mass_ratio"][there]
        with np.errstate(divide="ignore", invalid="ignore"):
            columns[0, there] = np.where(mu > 0, batch.impulse_ratio[first] / mu, 0.0)
            columns[1, there] = batch.friction_loss[first] / weight
            columns[2, there] = np.log10(batch.peak_normal_force[first] / weight)
        columns[np.isinf(columns)] = np.nan
        columns[:, sequence <= 0] = np.nan
        hops, jams = np.zeros(x.shape, dtype=np.int64), np.zeros(x.shape, dtype=bool)
        hops[there], jams[there] = batch.hop_count, batch.jam_count > 0
        return Seen(sequence, columns[0], columns[1], columns[2], hops, jams)

    def scenes_of_the_paper(self) -> list[tuple[str, float, float]]:
        """Name and place of each of the paper's scenes that lies in this plane."""
        found = []
        for name in scene_names():
            if name.startswith("paper-"):
                place = self._place(load_scene(name))
                if place is not None:
                    found.append((name.removeprefix("paper-"), *place))
        return found

    def _place(self, scene: Scene) -> tuple[float, float] | None:
        x, y = (_value(scene, axis.key) for axis in (self.across, self.up))
        inside = all(a.low <= value <= a.high for a, value in zip((self.across, self.up), (x, y), strict=True))
        mine = {name: column.item() for name, column in self.hoops(np.array(x), np.array(y)).items()}
        other = Plane(scene, self.across, self.up).hoops(np.array(x), np.array(y))
        # mu_s/mu of the paper's scenes is 1.17 to 1.2
        near = {name: 0.05 if name == "mu_s" else 1e-9 for name in mine}
        same = all(isclose(mine[name], column.item(), rel_tol=near[name]) for name, column in other.items())
        return (x, y) if inside and same else None


def _value(scene: Scene, key: str) -> float:
    part, name = key.split(".")
    return float(getattr(getattr(scene, part), name))


def plane(scene: Scene, over: Mapping[str, tuple[float, float]] | Sequence[tuple[str, float, float]]) -> Plane:
    """The plane of a scene over two ranges.

    Raises
    ------
    SceneError
        Not two different keys, a key that no atlas has, a range that does not run upward or leads to no hoop.
    """
    try:
        ranges = [(key, *ends) for key, ends in over.items()] if isinstance(over, Mapping) else over
        axes = [Axis(key, float(low), float(high)) for key, low, high in ranges]
    except (TypeError, ValueError):
        raise SceneError(f"over = {shown(over)} is not possible: it has two keys, each with both ends.") from None
    keys = [axis.key for axis in axes]
    if len(set(keys)) != 2 or len(axes) != 2:
        raise SceneError(f"An atlas is over two different keys: it was given {', '.join(keys) or 'none'}.")
    for key, low, high in axes:
        if key not in SYMBOLS:
            raise SceneError(f"{key} is not a key that an atlas can vary: {', '.join(SYMBOLS)}.")
        if not (isfinite(low) and isfinite(high) and low < high):
            raise SceneError(f"{key} = {low:g}:{high:g} is not possible: a range runs up, from a number to a number.")
    made = Plane(scene, *axes)
    corners = np.array([0.0, 1.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0, 1.0])
    hoops = made.hoops(axes[0].at(corners[0]), axes[1].at(corners[1]))
    if set(keys) == {"friction.mu", "friction.mu_s"}:
        hoops["mu_s"] = np.maximum(hoops["mu_s"], hoops["mu"])  # what lies below is left blank
    try:
        simulate_batch(hoops, t_end=1e-9)
    except SceneError as error:
        raise SceneError(str(error).partition("batch: ")[2] or str(error)) from None
    return made


def words(sequence: int, kinds: tuple[Kind, ...]) -> str:
    """A sequence in words."""
    if sequence == NO_HOOP:
        return "no hoop: mu_s < mu"
    return ", ".join(map(str, kinds)) if kinds else "no pulse"


def parse_range(text: str) -> tuple[str, float, float]:
    """KEY=A:B as a key and two numbers.

    Raises
    ------
    SceneError
        It is none.
    """
    key, _, ends = text.partition("=")
    try:
        low, high = map(float, ends.split(":"))
    except ValueError:
        raise SceneError(f"--over {text} is not possible: it is KEY=A:B, as hoop.k=0.02:0.9.") from None
    return key.strip(), low, high
