"""A thousand cycles without drift."""

from __future__ import annotations

import dataclasses
from math import radians

from rigid import Friction, Hoop, Release, Run, Scene, simulate

from .checks import Checked

CYCLES = 1000
HOOPS = {
    "rolling": Scene(Hoop(0.75), Friction(0.35, 0.3), Release(radians(10)), Run(turns=2 * CYCLES)),
    "smooth floor": Scene(Hoop(0.1), Friction(0.0, 0.0), Release(radians(10)), Run(turns=2 * CYCLES)),
    "heavy hoop, smooth floor": Scene(Hoop(0.3, 1.1, 2.0), Friction(0.0, 0.0), Release(2.0), Run(turns=2 * CYCLES)),
}


def drift(scene: Scene) -> Checked:
    """Angle, energy and period of the last cycle against those of the first, each cycle computed anew from the turn
    that ends the one before; and the thousand in one run.
    """
    motion = simulate(scene)
    cycle, time, turns = scene.replace(run={"turns": 2}), 0.0, []
    for _ in range(CYCLES):
        turn = simulate(cycle).turns[1]
        time += turn.t
        turns.append(dataclasses.replace(turn, t=time))
        cycle = cycle.replace(release=Release(turn.phi, 0.0, turn.slip_velocity))
    first, last = turns[0], turns[-1]
    expected = CYCLES * first.t
    margins = {
        "all cycles": abs(len(motion.turns) - 2 * CYCLES) * 1e9,
        "one run": abs(motion.turns[-1].t / last.t - 1) / 1e-11,
        "angle drifts": abs(last.phi - first.phi) / 1e-10,
        "energy drifts": abs(last.energy / first.energy - 1) / 1e-11,
        "period drifts": abs(last.t / expected - 1) / 1e-11,
    }
    return Checked(margins, motion.ended, motion.completed)
