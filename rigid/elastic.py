"""The parts of a scene that only the flexible solver looks at: ring, contact, and how it works."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, radians

from .allowed import answering, require, require_choice, require_whole


@answering("ring", {"weld_half_angle": "weld_half_angle_deg"})
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
        Wall h over R. It follows from r when r > 1; when r = 1 it defaults to 0.02.
    weld_half_angle : float
        Half the arc of the inner rim that is welded to the disk, seen from the centre, in radians;
        ``weld_half_angle_deg`` gives it in degrees.
    """

    bending_stiffness: float = 1e4
    poisson: float = 0.3
    thickness: float | None = None
    weld_half_angle: float = radians(3)

    def __post_init__(self) -> None:
        require(
            "ring.bending_stiffness",
            self.bending_stiffness,
            0,
            inf,
            "E I/(m g R^2) must be positive",
            open_low=True,
        )
        require("ring.poisson", self.poisson, -1, 0.5, "Poisson's ratio lies between -1 and 0.5", open_low=True)
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
        require(
            "ring.weld_half_angle_deg",
            self.weld_half_angle * 180 / pi,
            0,
            90,
            "the weld's half angle lies between 0 and 90",
            open_low=True,
        )


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
        Normal foundation eps_n R^2/(m g): force per area of rim and unit penetration, dimensionless.
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
            0,
            inf,
            "the foundation eps_n R^2/(m g) must be positive",
            open_low=True,
        )
        require(
            "contact.tangential_ratio",
            self.tangential_ratio,
            0,
            inf,
            "the tangential over the normal foundation must be positive",
            open_low=True,
        )
        require("contact.damping", self.damping, 0, inf, "the damping ratio is at least 0")
        require(
            "contact.slip_velocity_scale",
            self.slip_velocity_scale,
            0,
            inf,
            "the slip velocity v_s/sqrt(g R) that smooths a regularised friction must be positive",
            open_low=True,
        )


@answering("solve")
@dataclass(frozen=True, slots=True)
class Solve:
    """How the flexible solver works: what it resolves, how finely, and to which tolerance.

    Parameters
    ----------
    level : {"auto", "reduced", "full", "exact", "chain"}
        Reduced modes with static correction, every node of the ring, every node of the geometrically exact ring, or a
        chain of parts that bend and turn far; "auto" takes one of the first and third that the scene allows.
    resolve : {"pulses", "all"}
        Flexible inside the pulses only, with the rigid closed form between them, or flexible throughout.
    start : {"equilibrium", "undeformed"}
        Whether the flexible hoop begins sagged in quasi-static equilibrium, or undeformed and touching the floor.
    rtol : float
        Tolerance on the impulses, over M sqrt(g R) with M the mass of disk and hoop, about.
    elements : int
        Elements around the ring.
    """

    level: str = "auto"
    resolve: str = "pulses"
    start: str = "equilibrium"
    rtol: float = 1e-4
    elements: int = 240

    def __post_init__(self) -> None:
        require_choice("solve.level", self.level, ("auto", "reduced", "full", "exact", "chain"))
        require_choice("solve.resolve", self.resolve, ("pulses", "all"))
        require_choice("solve.start", self.start, ("equilibrium", "undeformed"))
        require("solve.rtol", self.rtol, 1e-12, 0.5, "the tolerance lies between 1e-12 and 0.5")
        require_whole("solve.elements", self.elements, 24, 4000)
