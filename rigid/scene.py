"""What a user describes: hoop, friction, release, how far to run; and, for the flexible solver, ring and contact.

A :class:`Scene` is a frozen value: it compares, hashes, pickles and prints, and it is all that either solver takes.
Numbers are dimensionless in the paper's scaling (lengths by the outer radius R, times by sqrt(R/g), forces by m g with
m the mass of the disk) as long as ``R``, ``m`` and ``g`` keep their default 1; give them in SI units and every
input and output that has a dimension is in SI units too.

Angles are in radians. ``phi`` runs clockwise from the top: the disk is lowest at ``phi = pi``.
Equation numbers are those of V. A. Lubarda, J. Mech. Mater. Struct. 4(6), 2009.
"""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import degrees, inf, pi
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .allowed import SceneError, answering, require, require_choice, require_whole, unknown, users_level
from .elastic import Contact, Ring, Solve
from .output.units import AngularVelocity, Measured, Number, Time, Velocity, scaling, without_units

N = TypeVar("N", float, NDArray[np.float64])

LIGHTEST = 1e-100
"""Least mass of a hoop that has one, over the disk's: of a lighter one's frequencies no float holds the square."""


class HoopConstants(NamedTuple, Generic[N]):
    """The constants of a hoop, (3) and (6), over the outer radius where the paper's are over the inner."""

    e: N
    """Distance of the centre of mass G from the hoop's centre C over R, vartheta/r."""
    one_minus_e: N
    """1 - e without cancellation for a small disk on a thin light hoop."""
    K: N
    """Squared radius of gyration about G over R squared, (eta/r)^2."""
    zeta: N
    """(eta^2 + (r - vartheta)^2)/(r vartheta) = (K + (1 - e)^2)/e."""


def hoop_constants(k: N, r: N, mass_ratio: N) -> HoopConstants[N]:
    """The constants of one hoop from numbers, or of many from arrays of one shape."""
    q = mass_ratio
    # disk about its own centre, hoop about C, and both moved to G: m m_h/(m + m_h) (1 - k)^2, free of cancellation
    eta_squared = (k**2 / 2 + q * (1 + r**2) / 2 + (1 - k) ** 2 * q / (1 + q)) / (1 + q)
    K = eta_squared / r**2
    e = (1 - k) / (1 + q) / r
    one_minus_e = (k + q + (r - 1) * (1 + q)) / (r * (1 + q))
    return HoopConstants(e, one_minus_e, K, (K + one_minus_e**2) / e)


def is_point_mass(hoop: HoopConstants[N]) -> bool | NDArray[np.bool_]:
    """Whether nothing of a hoop but a mass on its rim is left to what a float holds."""
    return (hoop.K < 1e-100) & (hoop.one_minus_e < 1e-40)


@answering("hoop", in_files={"point_mass": "here a point mass is k = 0 on a hoop without mass"})
@dataclass(frozen=True, slots=True)
class Hoop:
    """The hoop and the disk welded inside its rim.

    Parameters
    ----------
    k : float
        Radius of the disk over the inner radius R0 of the hoop, 0 <= k < 1. k = 0 is a point mass.
    r : float
        Outer over inner radius of the hoop, R/R0 >= 1.
    mass_ratio : float
        Mass of the hoop over mass of the disk, m_h/m >= 0.
    R, m, g : float
        Outer radius, mass of the disk and gravity; 1, 1, 1 is the paper's scaling. A file has all three or none; here
        each is 1 unless it is given, so ``Hoop(0.1, R=0.5)`` is one of half a metre where m = 1 kg and g = 1 m/s^2.
    """

    k: float
    r: float = 1.0
    mass_ratio: float = 0.0
    R: float = 1.0
    m: float = 1.0
    g: float = 1.0

    def __post_init__(self) -> None:
        allowed = "k is the disk's radius over the hoop's inner radius, at least 0 and below 1"
        require("hoop.k", self.k, 0, 1, allowed, open_high=True)
        # the upper bounds here and below keep squares and products within what a float holds
        require("hoop.r", self.r, 1, 1e9, "r is the hoop's outer over its inner radius, 1 to 1e9")
        lightest = LIGHTEST if self.mass_ratio != 0 else 0
        require("hoop.mass_ratio", self.mass_ratio, lightest, 1e12, f"mass_ratio is m_h/m, 0 or {LIGHTEST} to 1e12")
        for key in ("R", "m", "g"):
            require(f"hoop.{key}", getattr(self, key), 1e-30, 1e30, f"{key} lies between 1e-30 and 1e30")
        if self.k == 0 and self.mass_ratio == 0 and self.r != 1:
            told = "a point mass (k = 0) on a massless hoop sits on the rim, so r must be 1"
            raise SceneError(f"hoop.r = {self.r!r} is not possible: {told}.")

    @property
    def constants(self) -> HoopConstants[float]:
        """What the equations of motion know of the hoop, (3) and (6)."""
        return hoop_constants(self.k, self.r, self.mass_ratio)

    @property
    def e(self) -> float:
        """Eccentricity of G over the outer radius."""
        return self.constants.e

    @property
    def K(self) -> float:
        """Squared radius of gyration about G over the outer radius squared."""
        return self.constants.K


@answering("friction")
@dataclass(frozen=True, slots=True)
class Friction:
    """Coulomb friction: static coefficient ``mu_s`` >= kinetic coefficient ``mu`` >= 0."""

    mu_s: float
    mu: float

    def __post_init__(self) -> None:
        require("friction.mu_s", self.mu_s, 0, 1e9, "mu_s is the static coefficient, 0 to 1e9")
        require("friction.mu", self.mu, 0, 1e9, "mu is the kinetic coefficient, 0 to 1e9")
        if self.mu > self.mu_s:
            told = f"the kinetic coefficient may not exceed mu_s = {self.mu_s!r}"
            raise SceneError(f"friction.mu = {self.mu!r} is not possible: {told}.")


def looks_like_degrees(phi0: Any) -> Any:
    """Whether an angle, or each of an array, is beyond a turn and has two decimals: where a motion gets to has more."""
    return (np.abs(phi0) > 2 * pi) & (phi0 == np.round(phi0, 2))


@answering("release", {"phi0": "phi0_deg"})
@dataclass(frozen=True, slots=True)
class Release:
    """The state at t = 0: angle ``phi0``, angular velocity ``omega0``, and the contact point's velocity ``slip0``.

    ``omega0`` is in sqrt(g/R) and ``slip0`` in sqrt(g R); in rad/s and m/s where the scene has R, m, g in SI units.
    ``Release(phi0_deg=10)`` is ``Release(phi0=radians(10))``. A ``phi0`` beyond a turn with no more than two decimals
    looks like degrees, which a warning says.
    """

    phi0: Number[float]
    omega0: AngularVelocity[float] = 0.0
    slip0: Velocity[float] = 0.0

    if TYPE_CHECKING:

        def __init__(
            self, phi0: float = ..., omega0: float = 0.0, slip0: float = 0.0, *, phi0_deg: float = ...
        ) -> None: ...

    def __post_init__(self) -> None:
        for key in ("phi0", "omega0", "slip0"):
            # of a larger angle too few digits would be left within a turn
            require(f"release.{key}", getattr(self, key), -1e9, 1e9, f"{key} lies between -1e9 and 1e9")
        if not scaling.now and looks_like_degrees(self.phi0):
            said = f"{abs(self.phi0) / (2 * pi):.2g} turns in radians: did you mean phi0_deg = {self.phi0!r}?"
            warnings.warn(f"release.phi0 = {self.phi0!r} is {said}", stacklevel=users_level())

    @property
    def phi0_deg(self) -> float:
        """The angle in degrees."""
        return degrees(self.phi0)


@answering("run")
@dataclass(frozen=True, slots=True)
class Run:
    """How far to run: to a number of turns (after release, see :class:`~rigid.Turn`), to a time, or until an event.

    ``t_end`` is in sqrt(R/g), or in seconds where the scene has R, m, g in SI units.
    ``until`` is "pulse" (the end of the first whole pulse; one that the release cuts is none) or "rest" (nothing is
    lost any more).
    """

    turns: int | None = None
    t_end: Time[float | None] = None
    until: str | None = None

    def __post_init__(self) -> None:
        given = [key for key in ("turns", "t_end", "until") if getattr(self, key) is not None]
        if not given:
            object.__setattr__(self, "turns", 2)
        if len(given) > 1:
            told = f"run.{given[0]} already says how far to run"
            raise SceneError(f"run.{given[1]} = {getattr(self, given[1])!r} is not possible: {told}.")
        if self.turns is not None:
            require_whole("run.turns", self.turns, 1, 1_000_000)
        if self.t_end is not None:
            require("run.t_end", self.t_end, 0, inf, "t_end is a time after release, above 0", open_low=True)
        if self.until is not None:
            require_choice("run.until", self.until, ("pulse", "rest"))


@answering("landing")
@dataclass(frozen=True, slots=True)
class Landing:
    """Landing of the rigid hoop after a flight: energetic coefficient of restitution, 0 (no bounce) to 1."""

    restitution: float = 0.0

    def __post_init__(self) -> None:
        require("landing.restitution", self.restitution, 0, 1, "restitution runs from 0 to 1")


@answering(None)
@dataclass(frozen=True, slots=True)
class Scene(Measured):
    """Everything both solvers need to know; see the parts for their parameters.

    What no scene can have is a :class:`SceneError`, here as in each part.

    Parameters
    ----------
    hoop, friction, release : Hoop, Friction, Release
        What rolls, on what, and how it begins.
    run, landing : Run, Landing
        How far, by default to the second turn; how the rigid hoop lands after a flight.
    ring, contact, solve : Ring, Contact, Solve
        What the flexible solver alone looks at.

    Examples
    --------
    >>> from rigid import Scene, Hoop, Friction, Release
    >>> scene = Scene(Hoop(k=0.1), Friction(mu_s=0.35, mu=0.3), Release(phi0_deg=10))
    """

    hoop: Hoop
    friction: Friction
    release: Release
    run: Run = field(default_factory=Run)
    landing: Landing = field(default_factory=Landing)
    ring: Ring = field(default_factory=Ring)
    contact: Contact = field(default_factory=Contact)
    solve: Solve = field(default_factory=Solve)

    def __post_init__(self) -> None:
        for name, kind in PARTS.items():
            if not isinstance(part := getattr(self, name), kind):
                raise SceneError(f"{name} = {part!r} is not possible: it must be a {kind.__name__}.")
        if self.hoop.r > 1 and self.ring.thickness is not None:
            raise SceneError(
                f"ring.thickness = {self.ring.thickness!r} is not possible: hoop.r = {self.hoop.r!r} says how thick the"
                " wall is, 1 - 1/r; it is for r = 1."
            )

    @property
    def wall(self) -> float:
        """Thickness of the ring over the outer radius R."""
        if self.hoop.r > 1:
            return 1 - 1 / self.hoop.r
        return 0.02 if self.ring.thickness is None else self.ring.thickness

    def to_dimensionless(self) -> Scene:
        """The same scene in the paper's scaling, R = m = g = 1."""
        release, run = without_units(self.release, self), without_units(self.run, self)
        return self.replace(hoop={"R": 1.0, "m": 1.0, "g": 1.0}, release=release, run=run)

    def replace(self, **changes: Any) -> Scene:
        """A copy with keys of its parts changed, each part given as a dict: ``scene.replace(hoop={"k": 0.2})``.

        A part may also be given whole; ``run`` given as a dict replaces how far to run. Angles may be in degrees
        (``phi0_deg``), as in a file.

        A ring that its file describes by material and section is numbers without units by now: with another ``R``,
        ``m`` or ``g`` it keeps E I/(m g R^2) and m_h/m, so it is not of the same section. That is said in the file, in
        a dict, or in a sweep from the file.

        Raises
        ------
        SceneError
            What no scene can have, in the sentence that a file with it is answered by.
        """
        parts: dict[str, Any] = {}
        for name, change in changes.items():
            if name not in PARTS:
                raise unknown("part of a scene", name, list(PARTS))
            if not isinstance(change, Mapping):
                parts[name] = change
                continue
            part = getattr(self, name)
            # an angle in degrees takes the place of the one in radians
            keys = [f.name for f in dataclasses.fields(part) if name != "run" and f"{f.name}_deg" not in change]
            parts[name] = PARTS[name](**{key: getattr(part, key) for key in keys} | dict(change))
        return dataclasses.replace(self, **parts)


PARTS: dict[str, type] = {
    "hoop": Hoop, "friction": Friction, "release": Release, "run": Run, "landing": Landing,
    "ring": Ring, "contact": Contact, "solve": Solve,
}  # fmt: skip
"""The parts of a scene: tables of its file."""
