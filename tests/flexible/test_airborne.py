"""Where the rigid hoop is in flight and the flexible one takes over, or the other way round, the flight goes on."""

from math import radians

import numpy as np
import pytest

import flexible
import rigid
from flexible.airborne import taken_over
from flexible.models.chain import ChainHoop
from flexible.models.reduced import ReducedHoop
from flexible.run.ahead import from_here
from flexible.start.handover import hand_over
from rigid import Contact, Friction, Hoop, Kind, Release, Ring, Run, Scene

#: thrown up, it flies over the top and lands at t = 1.67 where its disk is low enough for a pulse to begin
THROWN = Scene(
    Hoop(0.2, 1.1, 0.5), Friction(0.6, 0.6), Release(radians(-20), 1.8108), Run(until="pulse"), ring=Ring(1e6),
    contact=Contact(stiffness=1e10),
)  # fmt: skip


@pytest.mark.parametrize("level", [ReducedHoop, ChainHoop])
@pytest.mark.parametrize("t", [0.2, 1.0, 1.6])
def test_a_flight_goes_on_through_both_hand_overs(level, t):
    """Height and rise are the rigid hoop's, and the rigid hoop that takes over from the flexible one flies on as it
    did.

    But for what turning stretches the ring, M phidot^2/(E I) or 5e-6 at the most, of the angle's unit.
    """
    motion = rigid.simulate(THROWN)
    flight = motion.phases[0]
    assert flight.kind == Kind.FLIGHT
    assert t < flight.t_end
    hoop = level(THROWN)
    state = hand_over(hoop, motion, t)
    assert state.res.normal == 0
    heights = motion.at(t + 1e-4 * np.arange(-1, 2)).y_C
    _, slip, (height, rise) = taken_over(hoop, state)
    assert slip == pytest.approx(motion.at(t).slip_velocity, abs=1e-5)
    assert height == pytest.approx(heights[1] - 1, abs=5e-6)
    assert rise == pytest.approx((heights[2] - heights[0]) / 2e-4, abs=1e-5)
    later = np.linspace(0, flight.t_end - t, 5)[:-1]
    on, before = from_here(THROWN, hoop, state, Run(turns=1)).at(later), motion.at(t + later)
    for name in ("phi", "y_C", "omega", "slip_velocity", "energy"):
        assert getattr(on, name) == pytest.approx(getattr(before, name), abs=5e-5)


@pytest.mark.parametrize("t", [0.5, 2.0, 2.7])
def test_what_a_law_is_told_of_a_rolling_hoop_is_its_ratio_of_forces(monkeypatch, t):
    """|F|/N of the rigid hoop that rolls, turning fast too, which says to the law without bristles whether it does.

    But for the momentum of the ring's sag and of the hoop's creep, S^(-1/3) of the limit: some 1e-4 here.
    """
    scene = Scene(
        Hoop(0.2, 1.1, 0.5), Friction(0.95, 0.95), Release(radians(60)), Run(until="pulse"), ring=Ring(1e7),
        contact=Contact(stiffness=1e11),
    )  # fmt: skip
    motion = rigid.simulate(scene)
    assert motion.phase_at(t).kind is Kind.ROLL
    hoop, told = ReducedHoop(scene), []
    monkeypatch.setattr(type(hoop.law), "rolls", lambda law, state, omega, share: told.extend((omega, share)) or True)
    taken_over(hoop, hand_over(hoop, motion, t))
    at = motion.at(t)
    assert told == pytest.approx([float(at.omega), abs(float(at.friction_force / at.normal_force))], rel=3e-4)


def test_a_hoop_in_flight_lands_by_itself():
    """The flexible part begins in flight, with next to no energy lost, and lands when the rigid hoop does.

    It begins half a pulse before the rigid hoop's, which the end of the run cuts.
    """
    motion = flexible.simulate(THROWN.replace(run={"until": None, "t_end": 1.68}), history=True)
    whole = rigid.simulate(THROWN)
    landing, pulse = whole.phases[0].t_end, whole.pulses[0]
    taken = motion.history.t[0]
    assert pulse.t_start < 1.68 < pulse.t_end
    assert taken == pytest.approx(pulse.t_start - (pulse.t_end - pulse.t_start) / 2, abs=1e-9)
    assert 0 < taken < landing
    assert abs(motion.ledger.hand_over) < 1e-6 * motion.ledger.initial
    around = motion.at(taken + 1e-9 * np.array([-1, 1]))
    assert np.diff(around.y_C) == pytest.approx(0, abs=1e-7)
    lands = motion.history.t[np.argmax(motion.history.normal_force > 0)]
    assert lands == pytest.approx(landing, abs=1e-4)
    (pulse,) = motion.pulses
    assert pulse.normal_impulse == pytest.approx(motion.history.normal_impulse[-1], rel=1e-6)  # all of the landing's


@pytest.mark.slow
@pytest.mark.parametrize("law", ["patch", "brush"])
def test_what_a_patch_creeps_is_no_slip(law):
    """A hoop that rolls up, turns and rolls down again has the pulse of the rigid one, and none where it turned."""
    scene = Scene(
        Hoop(0.1, 1.6, 0.5), Friction(0.7, 0.6), Release(radians(120), -1.0), Run(turns=2), ring=Ring(1e6),
        contact=Contact(law=law, stiffness=1e10, damping=0.2),
    )  # fmt: skip
    (expected,) = rigid.simulate(scene).pulses
    (pulse,) = flexible.simulate(scene.replace(solve={"resolve": "all", "elements": 120})).pulses
    assert pulse.normal_impulse == pytest.approx(expected.normal_impulse, rel=1e-4)  # S^(-1/3) of the limit
