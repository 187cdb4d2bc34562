"""Time stepping of set-valued friction, as a contestant: its equations, and that it comes to the same motion."""

from __future__ import annotations

from math import cos, sin

import numpy as np
import pytest

from studies.bench.peers import nivp_roll, siconos_roll
from studies.bench.rigid import MU, PHI0, TURNS_ASKED, worst_of_one
from studies.bench.truth.precision import DISKS

HOOP = nivp_roll.Hoop(0.9, 0.005, 0.3)


@pytest.mark.parametrize(("phi", "omega", "slip"), [(1.0, 0.7, 0.4), (2.9, 5.0, -0.8), (4.0, -1.2, -0.3)])
def test_the_state_moves_as_the_equations_of_a_slip_have_it(phi: float, omega: float, slip: float):
    """(10) to (13) for phidot and v, and F from them; L = J phidot + (1 + e c) v by the chain rule."""
    e, gyr, mu = HOOP
    s, c, way = sin(phi), cos(phi), np.sign(slip)
    arm, torque = 1 + e * c, e * s + way * mu * (1 + e * c)
    normal = gyr * (1 - e * c * omega**2) / (gyr + e * s * torque)
    assert normal > 0
    alpha = normal * torque / gyr
    slip_rate = -way * mu * normal - arm * alpha + e * s * omega**2
    inertia = gyr + (e * s) ** 2 + arm**2
    inertia_rate = (2 * e * e * s * c - 2 * arm * e * s) * omega
    state = np.array([phi, inertia * omega + arm * slip, slip])
    rates = nivp_roll.slope(HOOP, state) - way * nivp_roll.bound(HOOP, state)
    momentum_rate = inertia * alpha + inertia_rate * omega + arm * slip_rate - e * s * omega * slip
    assert rates == pytest.approx([omega, momentum_rate, slip_rate], rel=1e-12)  # round-off


@pytest.mark.skipif(siconos_roll.interpreter() is None, reason="siconos is not installed")
def test_siconos_comes_to_the_same_turns():
    """Its error falls like its step: a fourth of the step leaves less than 0.4 of it."""
    k = DISKS[0]
    coarse, fine = (
        worst_of_one(k, siconos_roll.roll_turns(k, MU, PHI0, TURNS_ASKED, step)[0]) for step in (1e-3, 2.5e-4)
    )
    assert fine < 0.4 * coarse < 0.1
