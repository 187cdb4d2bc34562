"""The parts of a scene that only the flexible solver looks at: ring, contact, and how it works."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, pi, radians
from typing import Any

from .allowed import SceneError, answering, require, require_choice, require_whole

#: keys of [hoop] of which all others have their units
UNITS = ("R", "m", "g")

#: keys of [ring] in a scene file that say in SI units what section the ring has
SECTION = ("youngs_modulus", "width", "height", "tube_diameter", "tube_wall", "density")

#: stiffness, over any unit that a scene has, with whose inverse a float can still be reckoned
LEAST = 1e-12


@answering(
    "ring",
    {"weld_half_angle": "weld_half_angle_deg"},
    dict.fromkeys(SECTION, "a ring that is made has bending_stiffness = E I/(m g R^2), without units"),
)
@dataclass(frozen=True, slots=True)
class Ring:
    """The elastic ring of the flexible hoop (the rigid solver does not look at it).

    Parameters
    ----------
    bending_stiffness : float
        E I/(m g R^2) of the ring's section, I = b h^3/12; dimensionless, so it is the same number in SI units.
    poisson : float
        Poisson's ratio, plane stress.
    thickness : float or None
        Wall h over R, of a hoop with r = 1 alone, 0.02 by default; with r > 1 it is 1 - 1/r. With r = 1 the rigid hoop
        has none, and turns with some m_h h R more: a stiff hoop with a mass is the rigid one for r > 1 alone.
    weld_half_angle : float
        Half the arc of the inner rim that is welded to the disk, seen from the centre, in radians;
        ``weld_half_angle_deg`` gives it in degrees.
    section_width : float or None
        Width b of the wall over R, by which stresses are divided; without it they are those of a hoop of width R. No
        motion knows of it. A section in SI units in a scene file says it.
    """

    bending_stiffness: float = 1e4
    poisson: float = 0.3
    thickness: float | None = None
    weld_half_angle: float = radians(3)
    section_width: float | None = None

    def __post_init__(self) -> None:
        require(
            "ring.bending_stiffness",
            self.bending_stiffness,
            LEAST,
            1e30,
            f"E I/(m g R^2) must be positive, {LEAST:.0e} to 1e+30",
        )
        require("ring.poisson", self.poisson, -1, 0.5, "Poisson's ratio lies above -1, up to 0.5", open_low=True)
        if self.thickness is not None:
            require(
                "ring.thickness",
                self.thickness,
                0,
                1,
                "thickness is the wall over R, between 0 and 1",
                open_low=True,
                open_high=True,
            )
        if self.section_width is not None:
            require("ring.section_width", self.section_width, 1e-12, 1e12, "section_width is the width over R, above 0")
        weld = require("ring.weld_half_angle", self.weld_half_angle, -1e9, 1e9, "it is an angle, in radians")
        require(
            "ring.weld_half_angle_deg",
            weld * 180 / pi,
            1e-9,
            90,
            "the weld's half angle lies between 0 and 90, not below 1e-9",
        )


#: foundation whose patch of the weight is 5e-6 R to either side: of a stiffer one gaps are known to some of its depth
STIFFEST = 1e16

#: names of the friction laws, which are defined in the flexible solver
LAWS = ("patch", "brush", "regularised")


@answering("contact")
@dataclass(frozen=True, slots=True)
class Contact:
    """The compliant frictional contact of the flexible hoop with the floor.

    Parameters
    ----------
    law : {"patch", "brush", "regularised"}
        "patch": the static coefficient acts on the resultants of the contact patch, |F| <= mu_s N (the paper's law);
        "brush": it acts at every point of the patch; "regularised": no static coefficient at all,
        F = -mu N v/sqrt(v^2 + v_s^2) with v the slip velocity of the patch.
    stiffness : float
        Normal foundation eps_n R^2/(m g), dimensionless: eps_n is the force per length of rim and unit penetration, of
        a floor known by its pressure per unit penetration that times the width on which the hoop stands.
    tangential_ratio : float
        Tangential over normal foundation.
    damping : float
        Damping ratio of the patch: of a rigid hoop that stands on it, the disk lowest, and moves up and down by little,
        with the mass and under the weight M g of disk and hoop. 1 is critical there. The damper is a relaxation time of
        the foundation, so the ratio grows with the load, like N^(1/6): 2.6 times at 300 M g. 0 is none. Every ratio
        above 0 has the rigid hoop as its limit for infinite stiffness, 0 has not.
    slip_velocity_scale : float
        v_s in sqrt(g R), of the regularised law.
    """

    law: str = "patch"
    stiffness: float = 1e9
    tangential_ratio: float = 0.8
    damping: float = 1.0
    slip_velocity_scale: float = 1e-3

    def __post_init__(self) -> None:
        require_choice("contact.law", self.law, LAWS)
        require(
            "contact.stiffness",
            self.stiffness,
            LEAST,
            STIFFEST,
            f"the foundation eps_n R^2/(m g) lies above 0, {LEAST:.0e} to {STIFFEST:.0e}",
        )
        require(
            "contact.tangential_ratio",
            self.tangential_ratio,
            LEAST,
            1 / LEAST,
            f"the tangential over the normal foundation must be positive, {LEAST:.0e} to {1 / LEAST:.0e}",
        )
        require("contact.damping", self.damping, 0, 1e9, "the damping ratio is at least 0, and 1e+09 at most")
        require(
            "contact.slip_velocity_scale",
            self.slip_velocity_scale,
            0,
            inf,
            "the slip velocity v_s/sqrt(g R) that smooths a regularised friction must be positive",
            open_low=True,
        )


#: tolerance below which steps are soon lost in round-off: as for 6e-9 they do not end (flexible/README.md)
TIGHTEST = 1e-8


@answering("solve")
@dataclass(frozen=True, slots=True)
class Solve:
    """How the flexible solver works: what it resolves, how finely, and to which tolerance.

    Parameters
    ----------
    level : {"auto", "reduced", "full", "exact", "chain"}
        Reduced modes with static correction, every node of the ring, every node of the geometrically exact ring, or a
        chain of parts that bend and turn far; "auto" takes the first, for a soft ring (E I below 40) the last, and
        where the wall of a soft ring is too thick for a chain every node of the exact one, a hundred times as slow.
    resolve : {"pulses", "all"}
        Flexible inside the pulses only, with the rigid closed form between them, or flexible throughout. Between pulses
        landings, and the blow that may stop a hoop thrown with slip, are the rigid hoop's.
    start : {"equilibrium", "undeformed"}
        Whether the flexible hoop begins sagged in quasi-static equilibrium, or undeformed and touching the floor; one
        thrown with a slip that no friction allows is undeformed anyway where it is flexible throughout.
    rtol : float
        Tolerance on the impulses, over M sqrt(g R) with M the mass of disk and hoop, about; of a patch that sticks
        while it or a ring with mass vibrates, by which it breaks, they may be off by several times that.
    elements : int or None
        Elements around the ring; by default 240, and more where ``rtol`` asks for it: with a wall of 2 % 463 at 1e-5
        up to E I = 400, and of the chain of a soft ring up to 480, at 1e-3 from E I = 3 down, at 1e-4 from 12.9 down;
        2 pi over its thickness on a floor far stiffer than the wall, at most 1200.
    through : int or None
        Elements through its wall; by default as many as keep the ring's slow frequencies and its compliances within
        0.1 %: one up to r = 1.029, three at 1.2, five at 2; of the chain's mesh two at least. Linear rings ("reduced"
        and "full") have more where ``rtol`` asks for it, at most ten: at 1e-4 three at 1.2 and nine at 1.5, at 1e-5 two
        at 1.02 and five at 1.2.
    integrator : {"auto", "esdirk3", "esdirk4", "tr-bdf2"}
        Implicit Runge-Kutta method of a step; "auto" is the first, of a linear ring with mass the second below 2e-5.
    """

    level: str = "auto"
    resolve: str = "pulses"
    start: str = "equilibrium"
    rtol: float = 1e-4
    elements: int | None = None
    through: int | None = None
    integrator: str = "auto"

    def __post_init__(self) -> None:
        require_choice("solve.level", self.level, ("auto", "reduced", "full", "exact", "chain"))
        require_choice("solve.resolve", self.resolve, ("pulses", "all"))
        require_choice("solve.integrator", self.integrator, ("auto", "esdirk3", "esdirk4", "tr-bdf2"))
        require_choice("solve.start", self.start, ("equilibrium", "undeformed"))
        require(
            "solve.rtol",
            self.rtol,
            TIGHTEST,
            0.5,
            f"the tolerance lies between {TIGHTEST:.0e} and 0.5, for steps to tighter ones are lost in round-off",
        )
        if self.elements is not None:
            require_whole("solve.elements", self.elements, 24, 4000)
        if self.through is not None:
            require_whole("solve.through", self.through, 1, 20)


def ring_of_section(ring: Mapping[str, Any], hoop: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """What a scene file says of the section of a ring one can hold, as keys of [ring] and [hoop] without units.

    A strip ``width`` wide and ``height`` thick, or a tube of ``tube_diameter`` with a wall of ``tube_wall`` (half the
    diameter is a full rod), lengths in m, lies with its outermost fibre at R. With ``youngs_modulus`` (Pa) that is the
    bending stiffness E I/(m g R^2), and the width of the strip that bends and is strained like it; with ``density``
    (kg/m^3) also the mass of the hoop, of a bar as long as the circle through its middle.

    Parameters
    ----------
    ring, hoop : mapping
        The tables of the file, of which at least one key in ``SECTION`` is in ``ring``.

    Returns
    -------
    (dict, dict)
        Of [ring] and [hoop], to be added to what else the tables say.

    Raises
    ------
    SceneError
        No SI units, the same thing said twice, half a section, or a value that cannot be.
    """
    first = next(key for key in SECTION if key in ring)
    for key in UNITS:
        if key not in hoop:
            raise SceneError(f"ring.{first} is in SI units: hoop.R, hoop.m and hoop.g must be given in them too.")
        require(f"hoop.{key}", hoop[key], 1e-30, 1e30, f"{key} lies between 1e-30 and 1e30")
    for key in SECTION:
        if key in ring:
            require_section(key, ring[key])
    if "bending_stiffness" in ring:
        raise SceneError(
            f"ring.bending_stiffness and ring.{first} cannot both be given: each says how stiff the ring is."
        )
    if "youngs_modulus" not in ring:
        raise SceneError(f"ring.youngs_modulus is missing: ring.{first} says the section alone.")
    R, m, g = (float(hoop[key]) for key in UNITS)
    high, area, moment = _section(ring)
    if high >= R:
        raise SceneError(f"The ring's section is {high!r} m high: it must be less than hoop.R = {R!r}.")
    r = R / (R - high)
    if "r" in hoop:
        require("hoop.r", hoop["r"], 1, 1e9, "r is the hoop's outer over its inner radius, 1 to 1e9")
    if abs(hoop.get("r", r) / r - 1) > 1e-6:
        raise SceneError(
            f"hoop.r = {hoop['r']!r} is not possible: the ring's section says {r:.9g}, and it may be left out."
        )
    if "thickness" in ring:
        raise SceneError(
            f"ring.thickness and ring.{first} cannot both be given: the section says how thick the ring is."
        )
    if "section_width" in ring:
        raise SceneError(
            f"ring.section_width and ring.{first} cannot both be given: the section says how wide the ring is."
        )
    of_hoop: dict[str, Any] = {"r": r}
    if "density" in ring:
        if "mass_ratio" in hoop:
            raise SceneError("hoop.mass_ratio and ring.density cannot both be given: each says how heavy the hoop is.")
        of_hoop["mass_ratio"] = ring["density"] * area * 2 * pi * (R - high / 2) / m
    # a tube bends, and is strained where it is farthest out, as a strip as high and as stiff
    width = 12 * moment / high**3
    of_ring = {"bending_stiffness": ring["youngs_modulus"] * moment / (m * g * R**2), "section_width": width / R}
    return of_ring, of_hoop


def require_section(key: str, value: Any) -> None:
    """Refuse what no section has of one of the keys in ``SECTION``."""
    require(f"ring.{key}", value, 0, 1e30, f"{key} is in SI units, above 0", open_low=True)


def _section(ring: Mapping[str, Any]) -> tuple[float, float, float]:
    """Height, area and second moment of area of a strip or a tube."""
    said = [key for key in SECTION[1:5] if key in ring]
    if said not in (list(SECTION[1:3]), list(SECTION[3:5])):
        raise SceneError(
            "The ring's section is unclear: it is ring.width and ring.height or ring.tube_diameter and ring.tube_wall."
        )
    if "width" in ring:
        b, h = float(ring["width"]), float(ring["height"])
        return h, b * h, b * h**3 / 12
    outer, wall = float(ring["tube_diameter"]), float(ring["tube_wall"])
    if 2 * wall > outer:
        raise SceneError(f"ring.tube_wall = {wall!r} is not possible: it is at most half of tube_diameter = {outer!r}.")
    inner = outer - 2 * wall
    return outer, pi * (outer**2 - inner**2) / 4, pi * (outer**4 - inner**4) / 64
