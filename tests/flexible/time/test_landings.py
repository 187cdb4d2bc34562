"""A step in which a hoop lands: energy that it gives is its error."""

from math import radians

import pytest

import flexible
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve

#: thrown, off the floor at once, and down again on a floor whose damper makes far more of N than its springs
HEAVY = Scene(
    Hoop(k=0.21181788974940577, r=1.014869316891838, mass_ratio=0.20570071700434264),
    Friction(0.6851272406179011, 0.6851272406179011), Release(radians(36.325299727103925), 2.022952745202727),
    Run(until="pulse"), ring=Ring(bending_stiffness=341654.2792243484, poisson=0.11523765725267376),
    contact=Contact("regularised", 3525449.505840993, damping=26.67544225107544), solve=Solve(rtol=1e-3),
)  # fmt: skip


def test_no_step_throws_up_a_hoop_that_lands():
    """One step went from the air, falling, to N = 20, rising, and gave 0.16 of the energy, which no estimate saw.

    What all steps err by is some rtol; J_N, whose integral over the pulse is a change of momentum, no more.
    """
    motion = flexible.simulate(HEAVY)
    closer = flexible.simulate(HEAVY.replace(solve={"rtol": 3e-4}))
    ledger, rtol = motion.ledger, HEAVY.solve.rtol
    assert abs(ledger.residual) < rtol * ledger.initial
    assert ledger.numerical_loss > -rtol * ledger.initial
    one, other = motion.pulses[0], closer.pulses[0]
    assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=rtol)
    assert one.t_start == pytest.approx(other.t_start, abs=rtol)
