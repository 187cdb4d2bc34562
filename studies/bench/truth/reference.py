"""What the flexible benchmark takes for true: runs of all nodes, brought to the limit of fine steps, mesh and contact.

Scene B: k = 0.1, r = 1.02, m_h/m = 0.1, E I/(m g R^2) = 65.3, brush law, from the undeformed ring at phi = 2.9 with
phidot = 4 (R0 = 1) to t = 0.1426; units R = m = g = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, sqrt
from typing import Any

import numpy as np

from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve

R = 1.02  # outer radius in the inner one, in which scenes A and B are given
BENDING = 1e8 * (1 - 1 / R) ** 3 / 12
FOUNDATION = 1e7 * R**2
END_OF_A = 6.72  # in the inner radius

MASSLESS = "massless pulse"

SCENES = {
    "scene B, pulse": (
        "k = 0.1, m_h/m = 0.1, E I/(m g R²) = 65, foundation 10⁷,\nbrush, undeformed from φ = 2.9, through the pulse"
    ),
    "scene A, full roll": "the same hoop from rest at 10°, to φ = 4",
    MASSLESS: "k = 0.1, m_h/m = 0, E I/(m g R²) = 10⁵,\nfoundation 10¹⁰, from rest at 10°",
}
"""What the scenes of the flexible benchmark are, by the name that its table gives them."""


@dataclass(frozen=True)
class Measured:
    """What is compared: impulses, friction loss, largest normal force."""

    normal_impulse: float
    friction_impulse: float
    friction_loss: float
    peak_normal_force: float

    def __add__(self, other: Measured) -> Measured:
        return Measured(*(a + b for a, b in zip(_row(self), _row(other), strict=True)))

    def __sub__(self, other: Measured) -> Measured:
        return Measured(*(a - b for a, b in zip(_row(self), _row(other), strict=True)))


def _row(measured: Measured) -> tuple[float, ...]:
    return (
        measured.normal_impulse,
        measured.friction_impulse,
        measured.friction_loss,
        measured.peak_normal_force,
    )


#: (elements around, through the wall, rtol, contact points) -> all nodes, found by :func:`run_all_nodes`
ALL_NODES = {
    (240, 1, 1e-4, 24): Measured(2.1272373, -0.0052106, 0.0112685, 31.57202),
    (480, 2, 1e-5, 48): Measured(2.12714342, -0.00530213, 0.01129497, 31.591939),
    (720, 3, 1e-5, 48): Measured(2.12713741, -0.00530410, 0.01129550, 31.591382),
    (480, 2, 1e-6, 48): Measured(2.12713590, -0.00530942, 0.01129698, 31.592929),
    (480, 2, 1e-6, 96): Measured(2.12713893, -0.00530680, 0.01129656, 31.593202),
}
STEP_ORDER = 1.0  # of these errors in rtol, by the step control
POINTS_ORDER = 2  # in the spacing of the points


def scene_b(rtol: float = 1e-3, elements: int | None = None, level: str = "reduced") -> Scene:
    """Rolling into the floor with an undeformed ring."""
    return Scene(
        Hoop(k=0.1, r=R, mass_ratio=0.1),
        Friction(0.35, 0.3),
        Release(2.9, 4.0 * sqrt(R)),
        Run(t_end=0.1426 / sqrt(R)),
        ring=Ring(bending_stiffness=BENDING),
        contact=Contact(law="brush", stiffness=FOUNDATION, tangential_ratio=1.0, damping=0.0),
        solve=Solve(resolve="all", start="undeformed", rtol=rtol, elements=elements, level=level),
    )


def scene_a(rtol: float = 1e-3) -> Scene:
    """A full roll from rest at ten degrees, through the pulse, to phi = 4."""
    scene = scene_b(rtol)
    return scene.replace(
        release=Release(radians(10)), run={"t_end": END_OF_A / sqrt(R)}, solve={"start": "equilibrium"}
    )


def massless_pulse(rtol: float = 1e-3) -> Scene:
    """The pulse of the massless hoop on a foundation of 1e10."""
    return Scene(
        Hoop(k=0.1, r=R),
        Friction(0.35, 0.3),
        Release(radians(10)),
        Run(until="pulse"),
        ring=Ring(bending_stiffness=1e5),
        contact=Contact(stiffness=1e10),
        solve=Solve(rtol=rtol, level="reduced"),
    )


def massless_brush(rtol: float = 1e-3) -> Scene:
    """The same where every point of the patch breaks loose by itself."""
    return massless_pulse(rtol).replace(contact={"law": "brush"})


def run_hoop(scene: Scene, hoop: Any) -> Measured:
    """A scene to its ``t_end``, or through its first pulse, by a hoop of any level, modes and points.

    Raises
    ------
    RuntimeError
        The run did not come to its end.
    """
    from flexible.run.pulses import LEAD
    from flexible.segment import peak
    from flexible.start.handover import hand_over
    from flexible.time.adaptive import march
    from flexible.time.events import Ends
    from flexible.time.methods import chosen
    from rigid import simulate

    motion, start = simulate(scene), 0.0
    if scene.run.t_end is not None:
        ends = Ends(t=scene.run.t_end)
    else:
        pulse = motion.pulses[0]
        start, ends = pulse.t_start - LEAD * (pulse.t_end - pulse.t_start), Ends(high=pulse.phi_end)
    solve = scene.solve
    methods = chosen(solve.integrator, solve.rtol, hoop.vibrates)
    _, records, _, stop, _ = march(hoop, hand_over(hoop, motion, start), ends, solve.rtol, methods=methods)
    if stop is not None:
        raise RuntimeError(stop.told())
    last = records[-1]
    top = peak(*(np.array([getattr(record, name) for record in records]) for name in ("t", "normal_force")))
    return Measured(last.normal_impulse, last.friction_impulse, last.friction_loss, top)


def run_all_nodes(elements: int, through: int, rtol: float, points: int) -> Measured:
    """Find an entry of ``ALL_NODES`` anew (6 s to 5 min), by the method whose errors fall like ``STEP_ORDER``."""
    from flexible.models.full import FullHoop

    scene = scene_b(rtol, elements).replace(solve={"through": through, "integrator": "esdirk3"})
    return run_hoop(scene, FullHoop(scene, points=points))


def limit() -> Measured:
    """Richardson in the step and the contact points, and the change to the finest mesh; to about 1e-6 of J_N.

    From 480 to 720 elements J_N changes by 3e-6 of itself, by the power 3.4 of their number a third more beyond.
    """
    rough = ALL_NODES[480, 2, 1e-5, 48]
    step = _part(ALL_NODES[480, 2, 1e-6, 48] - rough, 1 / (10**STEP_ORDER - 1))
    points = _part(ALL_NODES[480, 2, 1e-6, 96] - ALL_NODES[480, 2, 1e-6, 48], 1 / (2**POINTS_ORDER - 1))
    return ALL_NODES[480, 2, 1e-6, 96] + step + points + (ALL_NODES[720, 3, 1e-5, 48] - rough)


def _part(change: Measured, share: float) -> Measured:
    return Measured(*(share * value for value in _row(change)))


def errors(found: Measured, true: Measured) -> tuple[float, float]:
    """Of impulses and loss, over J_N (or, the loss, m g R); of the peak, relative."""
    gap = _row(found - true)
    return max(map(abs, gap[:3])) / true.normal_impulse, abs(gap[3]) / true.peak_normal_force
