"""How sudden a pulse is for the ring, by which the stiffness below which it hops is to be measured.

A rigid hoop that rolls from rest has phidot^2 = 2 (cos phi_0 - cos phi)/(zeta + 2 (1 + cos phi)). Its forces are
smooth in time, but off the real axis, where the denominator vanishes: at phi = pi + i y with cosh y = 1 + zeta/2. The
nearest such times are t_bottom +- i t*,

    t* = integral of sqrt((zeta + 2 - 2 cosh y)/(2 (cos phi_0 + cosh y))) dy from 0 to 2 arsinh(sqrt(zeta)/2).

What a pulse holds of a frequency omega falls like exp(-omega t*), and with it what it leaves in a vibration of the
ring. Slips make the pulse another one; its duration tau, over which the rigid N exceeds M g, knows of them. The hoop
leaves the floor where what is left exceeds the least N behind the pulse,

    omega_s t* = LEFT + ln(N_max/N_min),

omega_s the slowest symmetric vibration about the weld, LEFT measured (studies/README.md says by what, and how far).
"""

from __future__ import annotations

from functools import cache
from math import asinh, cos, cosh, log, pi, sqrt

import numpy as np
from scipy.integrate import quad

from rigid import Run, Scene
from rigid.output.sampling import bottom

from .limit import rigid_motion
from .rule import slowest_period

SYMMETRIC = 2.816
"""omega_s over omega_1 of a thin ring held at a point."""

LEFT = 4.2
"""ln of what a pulse leaves in N over N_max exp(-omega_s t*), where hoops begin to hop: 3.6 to 4.9."""


def pulse_time(scene: Scene) -> float:
    """t* of the rigid hoop that rolls from a scene's release at rest, in sqrt(R/g)."""
    zeta, start = scene.hoop.constants.zeta, cos(scene.release.phi0)

    def slowness(y: float) -> float:
        return sqrt(max(zeta + 2 - 2 * cosh(y), 0.0) / (2 * (start + cosh(y))))

    return float(quad(slowness, 0.0, 2 * asinh(sqrt(zeta) / 2))[0])


@cache
def suddenness(scene: Scene) -> float:
    """E I/(m g R^2) at which omega_1 t* = 1, omega_1 the slowest vibration of the ring about its weld.

    omega_1 goes with the root of the bending stiffness. 0 for a ring without mass, which does not vibrate.
    """
    period = slowest_period(scene.to_dimensionless().replace(ring={"bending_stiffness": 1.0}))
    return (period / (2 * pi * pulse_time(scene))) ** 2 if period > 0 else 0.0


@cache
def duration(scene: Scene) -> float | None:
    """tau of the first pulse of the rigid hoop to which a scene's tends, in sqrt(R/g); None without one."""
    motion = rigid_motion(scene.to_dimensionless(), Run(until="pulse"))
    pulse = next((pulse for pulse in motion.pulses if not pulse.cut), None)
    return None if pulse is None else float(pulse.t_end - pulse.t_start)


@cache
def relief(scene: Scene) -> tuple[float, float] | None:
    """N_max/N_min of the rigid hoop, in its first pulse and behind it to its first turn, and how long N_min comes
    after the disk has passed over the floor, in sqrt(R/g); None without a pulse.
    """
    motion = rigid_motion(scene.to_dimensionless(), Run(turns=1))
    pulse = next((pulse for pulse in motion.pulses if not pulse.cut), None)
    if pulse is None:
        return None
    lowest = bottom(lambda t: motion.at(t).phi, pulse.t_start, pulse.t_end)
    behind = np.linspace(pulse.t_end, motion.t_end, 4001)
    force = motion.at(behind).normal_force
    least = int(force.argmin())
    if force[least] <= 0:
        return None
    return float(pulse.peak_normal_force / force[least]), float(behind[least] - lowest)


def foreseen(scene: Scene, ratio: float = 0.0) -> float | None:
    """E I/(m g R^2) below which the pulse leaves the ring ringing so that the hoop leaves the floor behind it.

    ``ratio`` is a damping ratio of that vibration, small: until N is least it falls by exp(-ratio omega_s) per time,
    of which the flexible solver's ring, without damping in its material, knows nothing. None without a pulse or
    without a mass. Up to k = 0.18 it is off by a fifth at most; from 0.2 on stiffer hoops hop too, see
    studies/README.md.
    """
    sudden, seen = suddenness(scene), relief(scene)
    if sudden == 0 or seen is None:
        return None
    fall, wait = seen
    turned = (LEFT + log(fall)) / SYMMETRIC / (1 + ratio * wait / pulse_time(scene))
    return float(sudden * turned**2)
