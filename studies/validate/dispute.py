"""The particle on a hoop without mass, on which the literature does not agree.

On a floor that never lets it slip, N = cos phi: it would hop as the particle passes 90 degrees (Littlewood 1953,
Tokieda 1997). With friction it slips before, and then a hoop without inertia can bear no force: it *skims*, N = F = 0,
while the particle falls freely (postulated by Theron and du Plessis in 2001; disputed by Aglaev and Kovaldzhi in 2024).
Coulomb's law leaves the solver's skim phase no other answer; whether it is one of mechanics is asked of hoops with
inertia here: as that goes to zero their N does, and they come down when the skimming one does.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, degrees, pi, sin, sqrt

import numpy as np

from rigid import Friction, Hoop, Kind, Motion, Release, Run, Scene, load_scene, simulate

from .row import Row

HOP = "Littlewood, A Mathematician's Miscellany, 1953; Tokieda, Amer. Math. Monthly 104 (1997) 152"
SKIM = "Theron and du Plessis 2001 (disputed by Aglaev and Kovaldzhi 2024)"


def rows() -> Iterator[Row]:
    """Hop, skim, and the light hoop beside both."""
    rough = Friction(1e6, 1e6)
    start = Scene(Hoop(0.0), rough, Release(0.0, 1e-4), Run(t_end=40.0))
    why = "thrown with omega0^2 R/g = 1e-8 = cos phi there; mu_s = 1e6 slips at 180 degrees less 1e-4"
    yield Row(
        HOP, "angle in degrees at which N = 0 without slip", 90.0, degrees(simulate(start).phases[0].phi_end), 1e-5, why
    )

    skimming = simulate(load_scene("paper-point-mass"))
    fall = falls(skimming)
    assert skimming.phases[-1].kind == Kind.SKIM
    yield Row(SKIM, "time at which the particle hits the floor, from 10 degrees, 0.35", fall, skimming.t_end, 1e-9,
              "free fall, from the states where rolling ends")  # fmt: skip
    light = {k: _after_slip(k) for k in (1e-3, 1e-4)}
    for k, (_, time) in light.items():
        yield Row(SKIM, f"the same of a hoop with inertia: its pulse's peak, k = {k:g}", fall, time, k,
                  "K = k^2/2 and e = 1 - k: linear in k")  # fmt: skip
    yield Row(SKIM, "N of that hoop half way down, k = 1e-3 over 1e-4", 100.0, light[1e-3][0] / light[1e-4][0], 1.0,
              "N = K b/D, so it goes with k^2: up to a term linear in k")  # fmt: skip


def falls(motion: Motion) -> float:
    """When a particle that leaves the state at the end of rolling falls on the floor: 1 + cos phi above it."""
    end = motion.phases[0].t_end
    state = motion.at(end, "left")
    phi, omega = float(state.phi), float(state.omega)
    height, rate = 1 + cos(phi), -omega * sin(phi)
    return end + rate + sqrt(rate * rate + 2 * height)


def _after_slip(k: float) -> tuple[float, float]:
    """N half way from the start of slip to the pulse, and the time of the pulse's largest N, of a small disk."""
    motion = simulate(load_scene("paper-3.1").replace(hoop={"k": k}, run={"until": "pulse"}))
    pulse = motion.pulses[0]
    middle = (motion.phases[0].t_end + pulse.t_start) / 2
    times = motion.times(pulse.t_start, pulse.t_end)
    states = motion.at(times)
    assert states.phi.min() < pi
    return float(motion.at(middle).normal_force), float(times[int(np.argmax(states.normal_force))])
