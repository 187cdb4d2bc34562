"""When points of the rim touch the floor in a step, also where the hoop turns round in it."""

from math import pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexible import simulate
from flexible.contact.points.entry import Point, entry_of
from flexible.contact.points.rim import lift
from rigid import scene_from_dict

#: phidot when the step ends, over its mean; negative: it turns round in between
ENDING = st.floats(-6, 6)


@given(st.floats(1e-6, 1), st.floats(0, 3), st.floats(-0.02, 0.02), st.floats(-1, 1), ENDING)
def test_a_point_that_is_pressed_in_the_end_has_touched(deep, high, dphi, where, ratio):
    """The gap, of a circle that turns by a parabola in time, is then 0; before, and behind the step, it is not."""
    psi = 0.01 * where
    point = Point(1e-6 * high, -1e-6 * deep, psi, sin(psi), lift(psi))
    entry = entry_of(point, dphi, ratio * dphi, ratio)
    if high < 1e-10:
        return  # it was on the floor as the step began, as far as gaps of 1e-16 R tell

    def gap(s):
        own = point.gap_old - point.gap - (lift(psi - dphi) - lift(psi))
        return point.gap + lift(psi - ratio * dphi * s + (ratio - 1) * dphi * s**2) - lift(psi) + own * s

    assert 0 <= entry.rest <= 1
    scale = max(point.gap_old - point.gap, lift(2 * abs(dphi) * (1 + abs(ratio))))
    # of a last step of Newton of 1e-9, and of the rounding of four heights of the circle
    rounding = 4e-16 * lift(abs(psi) + 2 * abs(dphi) * (1 + abs(ratio)))
    assert gap(entry.rest) == pytest.approx(0, abs=1e-8 * scale + rounding)
    assert entry.psi == pytest.approx(psi - ratio * dphi * entry.rest + (ratio - 1) * dphi * entry.rest**2, abs=1e-15)


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("phi0", range(60, 90, 3))
def test_a_brush_slides_through_the_turn_of_a_swing(phi0, way):
    """As the hoop turns round its phidot is 0, and friction is mu N all along the slide.

    Points that the floor had come to bear in the step in which it turned round were taken for ones that never touched:
    they stuck without a pull, the slide for a roll, and the turn for that of a rolling hoop, one in twenty times, at
    phidot = -0.12 to -0.19 and so up to a tenth late.
    """
    motion = simulate(
        scene_from_dict(
            {
                "hoop": {"k": 0.1, "r": 1.02},
                "friction": {"mu_s": 0.2, "mu": 0.2},
                "release": {"phi0_deg": way * phi0},
                "run": {"turns": 1},
                "contact": {"law": "brush"},
                "solve": {"resolve": "all", "rtol": 1e-3},
            }
        )
    )
    (turn,) = motion.turns
    now = motion.at(turn.t)
    assert abs(way * turn.phi - pi) < pi / 2
    assert way * float(now.slip_velocity) > 0.1
    assert float(now.omega) == pytest.approx(0, abs=1e-5)  # of the root on a step's polynomial
    states = motion.at(np.linspace(motion.phases[-1].t_start + 0.05, turn.t, 200))
    assert np.abs(states.friction_force / states.normal_force) == pytest.approx(0.2, rel=1e-6)
