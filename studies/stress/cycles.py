"""A thousand cycles without drift."""

from __future__ import annotations

from math import radians

from rigid import Friction, Hoop, Release, Run, Scene, simulate

from .checks import Checked

CYCLES = 1000
HOOPS = {
    # rolls for ever: the turns are multiples of one period
    "rolling": Scene(Hoop(0.75), Friction(0.35, 0.3), Release(radians(10)), Run(turns=2 * CYCLES)),
    # a smooth floor: every half cycle is a Taylor series of its own
    "smooth floor": Scene(Hoop(0.1), Friction(0.0, 0.0), Release(radians(10)), Run(turns=2 * CYCLES)),
    "heavy hoop, smooth floor": Scene(Hoop(0.3, 1.1, 2.0), Friction(0.0, 0.0), Release(2.0), Run(turns=2 * CYCLES)),
}


def drift(scene: Scene) -> Checked:
    """Angle, energy and half-period of the last cycle against those of the first."""
    motion = simulate(scene)
    first, last = motion.turns[1], motion.turns[-1]
    half = motion.turns[1].t - motion.turns[0].t
    expected = first.t + (len(motion.turns) - 2) * half
    margins = {
        "all cycles": abs(len(motion.turns) - 2 * CYCLES) * 1e9,
        "angle drifts": abs(last.phi - first.phi) / 1e-10,
        "energy drifts": abs(last.energy / first.energy - 1) / 1e-11,
        "period drifts": abs(last.t / expected - 1) / 1e-11,
    }
    return Checked(margins, motion.ended, motion.completed)
