"""What the damper adds to N counts for friction, and no bristle holds it."""

import numpy as np
from scenes import HOOP

import flexible

FOUNDATION = 1e6  # soft, so that the damper's share of N is a tenth where the phases change
DAMPED = HOOP.replace(
    ring={"bending_stiffness": 1e4}, contact={"stiffness": FOUNDATION, "damping": 1.0}, solve={"rtol": 1e-5}
)
# of N_el by the length of the patch, which ends where straight cells do: up to (d/a)^2/8 of a, d the distance of the 38
# points that this rtol has across the patch
EDGE = 3 / 8 * (2 / 38) ** 2


def history_of(scene):
    """Steps of the first pulse, and N_el by the length of the patch, (2/3) eps a^3."""
    steps = flexible.simulate(scene, history=True, states=False).history
    return steps, 2 / 3 * FOUNDATION * (steps.patch_length / 2) ** 3


def test_a_sliding_brush_pulls_mu_times_the_damped_force():
    """Where all its points slide |F| = mu N, the damper's share of N, a tenth here, included."""
    scene = DAMPED.replace(hoop={"k": 0.25, "mass_ratio": 0.0}, contact={"law": "brush"})
    steps, elastic = history_of(scene)
    loose = (steps.stick_fraction == 0) & (steps.normal_force > 0)
    normal = steps.normal_force[loose]
    assert np.abs(normal / elastic[loose] - 1).max() > 0.05
    assert np.allclose(np.abs(steps.friction_force[loose]), scene.friction.mu * normal, rtol=1e-12)


def test_a_patch_that_sticks_holds_mu_times_the_springs_force_or_less():
    """Its F is mu N_el in the instant after a slide if N rises there, since no spring holds what a damper adds, and
    what it was if N falls.
    """
    mu = DAMPED.friction.mu
    steps, elastic = history_of(DAMPED)
    stuck = steps.stick_fraction > 0.5
    sticks = np.flatnonzero((np.diff(steps.t) == 0) & ~stuck[:-1] & stuck[1:])
    assert sticks.size == 2
    for i in sticks:
        assert steps.normal_force[i] > 1.05 * elastic[i]
        before, after = steps.friction_force[i : i + 2]
        assert np.isclose(abs(before), mu * steps.normal_force[i], rtol=1e-12)
        assert np.isclose(after, np.sign(before) * mu * elastic[i], rtol=EDGE)
