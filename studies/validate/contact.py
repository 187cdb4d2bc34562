"""The contact on a rigid rim: Winkler's patch, Kalker's rolling brush; and a hoop that stands on its patch."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, sqrt

import numpy as np

from flexible.contact.forces import contact_forces
from flexible.contact.laws.listing import LAWS
from flexible.contact.points.data import UNDAMPED, Before, Bristles, Parameters, Rim, no_bristles
from flexible.contact.points.rim import element_at
from flexible.models.reduced import ReducedHoop
from flexible.start.equilibrium import equilibrium
from flexible.start.pose import Pose
from rigid import Contact, Friction, Hoop, Kind, Release, Scene
from rigid import Ring as RingOf

from .row import Row

EPS = 1e6
MU = 0.3
VERTEX = -pi + 2 * pi / 240 * np.arange(240)
LAW = "brush"


def rows() -> Iterator[Row]:
    """Pressed, rolled, stood upon."""
    depth = 1e-6
    spacing = 2 * sqrt(2 * depth) / 64
    # the mean over positions of the points in the patch, which is by chance at any one
    places = 2.9 + spacing * np.linspace(0, 1, 7, endpoint=False)
    found = float(np.mean([_pressed(depth, spacing, phi) for phi in places]))
    exact = 4 / 3 * EPS * depth * sqrt(2 * depth)
    yield Row("Winkler, Die Lehre von der Elasticitaet, 1867", "N of a patch, eps = 1e6, delta = 1e-6 R", exact, found,
              1e-3 * exact, "64 points: their distance over the patch, squared, is 2e-4")  # fmt: skip
    for xi in (0.3, 0.8, 1.5):
        exact = 1 - (1 - min(xi, 1.0)) ** 3
        yield Row("Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, sec. 1.3.4",
                  f"F/(mu N) of a rolling brush, xi = {xi}", exact, _rolled(xi), 1e-3,
                  "200 points in the patch leave a few 1e-4")  # fmt: skip
    yield _standing()


def _pressed(depth: float, spacing: float, phi: float) -> float:
    """Normal force of a rim pressed on the floor."""
    return float(_forces(spacing, np.array([0.0, -depth, phi]), None, None).res.normal)


def _forces(spacing: float, pose: np.ndarray, before: np.ndarray | None, bristles: Bristles | None):  # type: ignore[no-untyped-def]
    law = Parameters(LAWS[LAW].code, spacing, EPS, 0.8 * EPS, MU, MU, 1e-3, 1e-9)
    rim, flat = Rim(element_at(VERTEX, pi - pose[2]) - 6, VERTEX), np.zeros((27, 2))
    was = Before(pose if before is None else before, flat, no_bristles() if bristles is None else bristles)
    return contact_forces(pose, flat, rim, law, 0, was, UNDAMPED, True)


def _rolled(xi: float) -> float:
    """F/(mu N) in steady rolling with the creep that ``xi`` stands for, over the last of many steps."""
    depth = 1e-8
    a = sqrt(2 * depth)
    spacing, creep, step = 2 * a / 200, xi * 2 * MU * depth / (0.8 * a), a / 37
    pose = np.array([0.0, -depth, 2.9])
    bristles = _forces(spacing, pose, None, None).bristles
    bristles = bristles._replace(stretch=np.zeros(len(bristles.stretch)))
    shares = []
    for _ in range(160):
        moved = pose + np.array([creep * step, 0.0, step])
        result = _forces(spacing, moved, pose, bristles)
        pose, bristles = np.array([0.0, moved[1], moved[2]]), result.bristles
        shares.append(-result.res.friction / (MU * result.res.normal))
    return float(np.mean(shares[-37:]))


def _standing() -> Row:
    """Penetration of a hoop at rest with the disk lowest, on a ring too stiff to give way: N = M g."""
    weight = 2.0
    hoop = ReducedHoop(
        Scene(
            Hoop(0.1, 1.02, weight - 1), Friction(0.35, 0.3), Release(pi),
            ring=RingOf(bending_stiffness=1e9), contact=Contact(stiffness=EPS, damping=0.0),
        ),
        points=96,
    )  # fmt: skip
    state = equilibrium(hoop, Pose(pi, 0.0, 0.0, weight, 0.0, Kind.ROLL))
    exact = (3 * weight / (4 * EPS * sqrt(2))) ** (2 / 3)
    return Row("Winkler's patch under M g", "penetration of a hoop at rest, m_h/m = 1, foundation 1e6", exact,
               -float(state.pos[1]), 1e-3 * exact, "96 points in the patch; E I = 1e9 gives 1e-6 of it")  # fmt: skip
