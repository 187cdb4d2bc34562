"""How sudden a pulse is for the ring, by which the stiffness below which it hops is to be measured.

A rigid hoop that rolls from rest has phidot^2 = 2 (cos phi_0 - cos phi)/(zeta + 2 (1 + cos phi)). Its forces are
smooth in time, but off the real axis, where the denominator vanishes: at phi = pi + i y with cosh y = 1 + zeta/2. The
nearest such times are t_bottom +- i t*,

    t* = integral of sqrt((zeta + 2 - 2 cosh y)/(2 (cos phi_0 + cosh y))) dy from 0 to 2 arsinh(sqrt(zeta)/2).

What a pulse holds of a frequency omega falls like exp(-omega t*), and with it what it leaves in a vibration of the
ring. Slips make the pulse another one; its duration tau, over which the rigid N exceeds M g, knows of them.
"""

from __future__ import annotations

from functools import cache
from math import asinh, cos, cosh, pi, sqrt

from scipy.integrate import quad

from rigid import Run, Scene, simulate

from .rule import slowest_period


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
    return (period / (2 * pi * pulse_time(scene))) ** 2


@cache
def duration(scene: Scene) -> float | None:
    """tau of the rigid hoop's first pulse, in sqrt(R/g); None without one."""
    motion = simulate(scene.to_dimensionless().replace(run=Run(until="pulse")))
    pulse = next((pulse for pulse in motion.pulses if not pulse.cut), None)
    return None if pulse is None else float(pulse.t_end - pulse.t_start)
