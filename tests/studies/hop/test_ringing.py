"""What a pulse leaves in the ring, measured without a hop: N of a roll without a slip, less that of the rigid hoop."""

from __future__ import annotations

from math import pi, radians, sqrt

import numpy as np
import pytest

import flexible
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve, simulate
from studies.hop.rolling.roll import from_rest
from studies.hop.rolling.rule import slowest_period
from studies.hop.rolling.scaling import LEFT, SYMMETRIC, pulse_time


def ringing(stiffness: float) -> tuple[float, float]:
    """omega_s t*, and the amplitude of N at 255 to 315 degrees over the largest N of the rigid hoop.

    A narrow weld: the ring of the theory is held at a point. N of the rigid hoop as a function of phi, and a cubic in
    time for what the ring gives way by slowly, are taken off.
    """
    scene = Scene(
        Hoop(k=0.1, r=1.02, mass_ratio=0.3), Friction(50, 50), Release(radians(10)), Run(turns=1),
        ring=Ring(bending_stiffness=stiffness, weld_half_angle=radians(0.3)),
        contact=Contact(stiffness=1e9, law="brush"), solve=Solve(rtol=1e-5, level="reduced"),
    )  # fmt: skip
    motion = flexible.simulate(from_rest(scene), history=True)
    assert motion.completed, motion.ended
    beside = simulate(scene)
    rigid = beside.at(np.linspace(0, beside.t_end, 20001))
    forth = rigid.omega > 0
    history = motion.history
    near = (history.phi > radians(255)) & (history.phi < radians(315))
    t = np.linspace(history.t[near][0], history.t[near][-1], 1600)
    without = history.normal_force - np.interp(history.phi, rigid.phi[forth], rigid.normal_force[forth])
    left = np.interp(t, history.t, without)
    left -= np.polyval(np.polyfit(t, left, 3), t)
    turns = SYMMETRIC * 2 * pi / slowest_period(scene) * pulse_time(scene)
    return turns, sqrt(2) * left.std() / rigid.normal_force.max()


@pytest.mark.slow
def test_what_a_pulse_leaves_falls_like_the_exponential():
    """From 1.3 to 2.3 times the stiffness at which such hoops hop: slope -1 in omega_s t*.

    Powers of omega t* (4/3: 1/3 of the spectrum, 1 of the force that an amplitude makes) change the slope by 4/3 over
    omega t*, 0.17, either way as they are counted; three amplitudes beat between two vibrations by some tenths. The
    constant of the thresholds, 4.2, is that of these amplitudes, but for the beats, within what it scatters by: e^0.7.
    """
    turns, amplitudes = np.array([ringing(stiffness) for stiffness in (12.0, 16.0, 22.0)]).T
    slope, _ = np.polyfit(turns, np.log(amplitudes), 1)
    assert slope == pytest.approx(-1, abs=0.3)
    assert np.mean(np.log(amplitudes) + turns) == pytest.approx(LEFT, abs=0.7)
