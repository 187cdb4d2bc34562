"""Where a patch that slides sticks: at slip zero, or behind it where N falls faster than what would hold the patch."""

from itertools import pairwise
from math import nan
from types import SimpleNamespace

import numpy as np
import pytest
from scenes import HOOP

import flexible
import rigid
from flexible.contact.laws.patch import SLIDE_LEFT, SLIDE_RIGHT, STICK, excess
from flexible.contact.points.data import Parameters, Rates
from flexible.handover import hand_over
from flexible.models.reduced import ReducedHoop
from flexible.time.adaptive import march
from flexible.time.events import VELOCITY, Ends

MU, EPS_T, LENGTH = 0.3, 1e8, 0.01
LAW = Parameters(0, 1e-3, 1e8, EPS_T, 0.35, MU, 1e-3, 1e-9)


def patch(slip, normal_rate, drag_rate=0.0, feet=nan, mode=SLIDE_RIGHT, eta=1.0):
    """What the law sees of a patch that slides."""
    res = SimpleNamespace(normal=20.0, friction=mode * MU * 20.0, eta=eta, length=LENGTH, elastic=20.0)
    return SimpleNamespace(mode=mode, slip_velocity=slip, rates=Rates(normal_rate, drag_rate, feet), res=res)


@pytest.mark.parametrize("mode", [SLIDE_RIGHT, SLIDE_LEFT])
def test_slip_ends_at_zero_unless_n_falls_faster_than_the_patch_would_hold(mode):
    """Bristles pulled along at v let go of eps_t l v, mu N falls by mu |dN/dt|: it slides on until these are one.

    A damper's drag that grows, mirrored like the slip, counts with the bristles; a damper that adds to N leaves no such
    doubt. Where the feet of the bristles are known, they tell.
    """

    def past(slip, *rates, **more):
        return excess(LAW, patch(mode * slip, *rates, mode=mode, **more), 1e-9, VELOCITY) > 0

    rate = -1e5
    lags = MU * -rate / (EPS_T * LENGTH)
    assert past(1e-6, -rate)
    assert not past(-1e-6, -rate)
    assert not past(0.99 * lags, rate)
    assert past(1.01 * lags, rate)
    assert past(1e-6, rate, eta=1.1)
    assert past(1e-6, rate, drag_rate=mode * 1.01 * MU * rate)
    assert not past(1e-6, rate, drag_rate=mode * 0.99 * MU * rate)
    assert past(1e-6, rate, feet=mode * 1e-8)
    assert not past(1e-6, rate, feet=-mode * 1e-8)


@pytest.mark.parametrize("bending", [10.0, 5.0])
def test_friction_does_not_push_a_soft_hoop_on(bending):
    """In steps in which the whole patch is renewed slip went on past zero unseen, up to a fourteenth of the loss.

    The work of a friction with the slip, of all friction's while all of the patch slides: to the tolerance.
    """
    scene = HOOP.replace(
        hoop={"mass_ratio": 0.05}, ring={"bending_stiffness": bending}, solve={"level": "auto", "rtol": 1e-3}
    )
    motion = flexible.simulate(scene, history=True)
    known = motion.history
    assert known is not None
    power = np.where(known.stick_fraction == 0, known.friction_force * known.slip_velocity, 0.0)[1:] * np.diff(known.t)
    assert power.min() < 0  # it does slide
    assert power[power > 0].sum() < scene.solve.rtol * -power[power < 0].sum()


@pytest.mark.parametrize("rtol", [1e-3, 1e-4, 1e-5])
def test_a_damped_patch_sticks_at_slip_zero(rtol):
    """N falls there, but the damper's drag grows with the slip's acceleration and holds the patch at any tolerance."""
    scene = HOOP.replace(hoop={"mass_ratio": 0.0}, contact={"damping": 1.0}, solve={"rtol": rtol})
    hoop, motion, states = ReducedHoop(scene), rigid.simulate(scene), []
    pulse = motion.pulses[0]
    march(hoop, hand_over(hoop, motion, pulse.t_start), Ends(high=pulse.phi_end), rtol, keep=states.append)
    caught = [before.slip_velocity for before, after in pairwise(states) if before.mode != STICK == after.mode]
    assert caught
    assert np.all(np.abs(caught) <= VELOCITY)
