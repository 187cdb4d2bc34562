"""Every number that the paper prints."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin

from rigid import Hoop, load_scene, simulate

from ..paper.numbers import numbers
from .row import Row

PAPER = "Lubarda, J. Mech. Mater. Struct. 4(6), 2009"
SEQUENCES = {
    "paper-3.1": "roll, spin, roll, skid",
    "paper-3.2-k0.25": "roll, spin, roll, skid",
    "paper-3.2-k0.75": "roll",
    "paper-3.3-same-density": "roll",
}


def rows() -> Iterator[Row]:
    """The numbers, then the sequences of phases of the first rotation."""
    instead = _instead()
    for number in numbers():
        yield Row(
            f"{PAPER}, sec. {number.place}",
            number.quantity,
            number.paper,
            float(number.ours),
            number.unit,
            number.why or "one unit of the last digit printed, which may be cut off or rounded",
            instead.get(number.paper),
        )
    for name, sequence in SEQUENCES.items():
        motion = simulate(load_scene(name).replace(run={"turns": 1}))
        yield Row(
            f"{PAPER}, sec. {name[6:9]}", f"phases, {name}", sequence, ", ".join(phase.kind for phase in motion.phases)
        )


def _instead() -> dict[float, tuple[float, float]]:
    """What stands in place of the printed numbers that do not hold, by another way, and its digits."""
    return {
        0.045: (inception(load_scene("paper-3.3-heavier").hoop, radians(10)), 1e-12),
        # half m_h (R^2 + R0^2) over half m k^2 R0^2 with m_h/m = rho (r^2 - 1)/k^2
        0.2048: (0.01 * (1.02**4 - 1) / 0.25**4, 1e-12),
        0.0128: (0.01 * (1.02**4 - 1) / 0.5**4, 1e-12),
        # by hand from the equations of motion, with the angle from the bottom over k as the variable
        1.38862: (1.3892, 5e-5),
        1.80266: (1.8025, 5e-5),
    }


def inception(hoop: Hoop, phi: float) -> float:
    """|F|/N of a hoop that begins to roll from rest: the moment about the contact point gives the acceleration."""
    s, c = hoop.e * sin(phi), 1 + hoop.e * cos(phi)
    acceleration = s / (hoop.K + s * s + c * c)
    return acceleration * c / (1 - acceleration * s)
