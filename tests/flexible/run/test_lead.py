"""Where ``resolve = "pulses"`` goes over to the flexible hoop, and from what."""

from __future__ import annotations

from math import degrees

import numpy as np
import pytest
from scenes import HOOP

import flexible
import rigid
from flexible.run.pulses import BEHIND, lead
from rigid import Kind, Scene

SHARE = 0.3
#: hoops whose first roll asks for more than a third of mu N for a while, and then for less, well before the pulse
PASSING = [(0.166, 0.606, 0.68), (0.171, 0.673, 0.198)]


def creeping(k: float, mu: float, phi0: float) -> Scene:
    return HOOP.replace(
        hoop={"k": k, "mass_ratio": 0.1}, friction={"mu": mu, "mu_s": mu}, release={"phi0_deg": degrees(phi0)},
        contact={"law": "regularised", "stiffness": 1e7, "damping": 1.0}, run={"until": "pulse"},
    )  # fmt: skip


@pytest.mark.parametrize("hoop", PASSING)
def test_a_hoop_that_creeps_is_flexible_from_where_a_roll_first_asks_for_much(hoop):
    """It was from where the roll asks for much last."""
    motion = rigid.simulate(creeping(*hoop))
    pulse = next(pulse for pulse in motion.pulses if not pulse.cut)
    began = lead(motion, pulse, SHARE)
    turned = max((turn.t for turn in motion.turns if turn.t < pulse.t_start), default=0.0)
    times = np.linspace(turned + BEHIND * (pulse.t_start - turned) if turned else 0.0, began, 2000)
    states = motion.at(times)
    assert all(phase.kind is Kind.ROLL for phase in motion.phases if phase.t_start < began)
    share = np.abs(states.friction_force) / (motion.scene.friction.mu * states.normal_force)
    assert began == times[0] or share.max() < SHARE + 1e-3
    behind = motion.at(np.linspace(began, pulse.t_start, 2000))
    assert (np.abs(behind.friction_force) > SHARE * motion.scene.friction.mu * behind.normal_force).any()


def test_a_hoop_is_let_go_undeformed_once():
    """A rigid one that takes over in the middle of a motion hands it over again in equilibrium, wherever that is.

    It did not where the rigid hoop asks for much friction from the first: the ring lost its strain and the floor its N.
    """
    scene = creeping(0.445, 0.29, 1.3).replace(
        release={"omega0": 0.741}, ring={"bending_stiffness": 300.0}, contact={"stiffness": 1e5},
        run={"turns": 1, "until": None}, solve={"start": "undeformed", "rtol": 1e-2, "elements": 60},
    )  # fmt: skip
    motion = flexible.simulate(scene, history=True)
    starts = [kept.states[0] for kept in motion.kept if kept.states[0].t > 0]
    assert len(starts) > 1
    assert all(state.res.normal > 0.1 for state in starts)
