"""Steps so short that their damper multiplies what the depth of a patch is off by thousands of times."""

import pytest
from scenes import HOOP

import flexible
from flexible.models.rim_contact import share_of_linear_steps

#: a thick hoop without mass on a floor far stiffer than its wall; half of its patch sticks behind the pulse
SCENE = HOOP.replace(
    hoop={"k": 0.03273, "r": 1.124, "mass_ratio": 0.0}, friction={"mu_s": 0.17125, "mu": 0.1301},
    release={"phi0": 0.98237}, ring={"bending_stiffness": 2269.4},
    contact={"law": "brush", "stiffness": 5.939e11, "damping": 1.0}, solve={"elements": 240, "through": 2},
)  # fmt: skip


@pytest.mark.slow
def test_a_brush_that_sticks_under_a_damper_is_left_in_long_steps():
    """From a depth foreseen to a thousandth the damper of a step of 1e-7 pulls more than the patch presses.

    Under no pressure nothing sticks, and Newton went from bristles all slid one way to bristles all slid the other. At
    1e-4 the hoop crawled from phi = 3.1413 to 3.1409 in steps of 1e-8, or its run ended there.
    """
    rough, fine = (flexible.simulate(SCENE.replace(solve={"rtol": rtol})) for rtol in (1e-4, 1e-5))
    assert rough.completed, rough.ended
    assert rough.steps < 800
    tighter = 10 * share_of_linear_steps(rough.scene) / share_of_linear_steps(fine.scene)
    assert fine.steps < 1.4 * tighter ** (1 / 3) * rough.steps  # like the root of the tolerance, at third order
    for name in ("normal_impulse", "friction_impulse", "friction_loss"):
        assert getattr(rough.pulses[0], name) == pytest.approx(getattr(fine.pulses[0], name), rel=1e-4)
