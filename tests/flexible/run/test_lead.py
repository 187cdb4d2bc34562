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


#: rigid hoops that begin their pulse soon behind a landing, and after a roll in which the flexible one creeps loose
THROWN = HOOP.replace(
    hoop={"k": 0.3, "mass_ratio": 0.0}, release={"phi0_deg": 60, "omega0": 3.0, "slip0": -4.0},
    ring={"bending_stiffness": 1e4},
)  # fmt: skip
CREEPING = HOOP.replace(hoop={"mass_ratio": 0.0}, contact={"law": "regularised"}, ring={"bending_stiffness": 1e4})


#: thrown so that it turns in a pulse that it leaves at once, never over the bottom
TURNED = HOOP.replace(
    hoop={"k": 0.2834, "mass_ratio": 0.0}, friction={"mu_s": 1.054, "mu": 1.054},
    release={"phi0": 3.38116, "omega0": -3.99692, "slip0": 8.66496}, solve={"rtol": 1e-2},
    ring={"bending_stiffness": 1e4}, run={"until": None, "turns": 1},
)  # fmt: skip


def test_a_turn_is_the_same_however_many_are_asked_for():
    """The rigid hoop that turns there and stops lists no pulse, and all was rigid; further it has one."""
    assert not rigid.simulate(flexible.rigid_limit(TURNED)).pulses
    one, two = (flexible.simulate(TURNED.replace(run={"turns": turns})) for turns in (1, 2))
    assert one.turns[0] == two.turns[0]
    assert one.turns[0].t != rigid.simulate(flexible.rigid_limit(TURNED)).turns[0].t
    assert one.steps > 0


def flexible_from(motion):
    """When its flexible segments begin."""
    return [piece.t_start for piece in motion.sample.pieces if piece.segment is not None]


@pytest.mark.parametrize("scene", [THROWN, CREEPING], ids=["thrown", "creeping"])
def test_where_a_run_to_a_time_ends_changes_nothing_before(scene):
    """Ends before the rigid pulse begins, just behind that, in it and far behind; the same, not to round-off but to the
    last bit, before the step that the end cuts. The flexible hoop was later by as much as the pulse was cut, or never.
    """
    stiff = flexible.rigid_limit(scene.replace(run=rigid.Run(until="pulse")))
    pulse = rigid.simulate(stiff).pulses[0]
    length = pulse.t_end - pulse.t_start
    early = [pulse.t_start - 0.05 * length, pulse.t_start + 0.01 * length, pulse.t_start + 0.3 * length]
    motions = [flexible.simulate(scene.replace(run=rigid.Run(t_end=t))) for t in early]
    far = flexible.simulate(scene.replace(run=rigid.Run(t_end=pulse.t_end + length)))
    t = np.linspace(0.0, pulse.t_start - 0.2 * length, 50)
    assert flexible_from(far)[0] < t[-1]
    for motion, t_end in zip(motions, early, strict=True):
        assert motion.t_end == pytest.approx(t_end, rel=1e-12)
        assert flexible_from(motion) == flexible_from(far)[:1]
        assert motion.at(t) == far.at(t)
    assert not motions[0].pulses or motions[0].pulses[0].t_start > t[-1]
    assert [pulse.cut for pulse in motions[-1].pulses] == [True]


def test_a_run_that_ends_before_its_pulse_has_none():
    """It has come as far as the flexible hoop takes over, and is the rigid one before that."""
    whole = flexible.simulate(THROWN)
    began = flexible_from(whole)[0]
    before, behind = (flexible.simulate(THROWN.replace(run=rigid.Run(t_end=began + d))) for d in (-1e-3, 1e-3))
    assert not flexible_from(before)
    assert flexible_from(behind) == [began]
    assert not before.pulses
    assert not behind.pulses
    times = np.linspace(0.0, began - 1e-3, 20)
    stiff = rigid.simulate(THROWN.replace(run=rigid.Run(t_end=2 * began)))
    assert before.at(times) == behind.at(times) == stiff.at(times)


def test_a_run_taken_up_behind_a_landing_is_the_long_one():
    """The shorter run, whose pulse was cut, had landed as a rigid hoop does, with another spin."""
    whole = flexible.simulate(THROWN)
    landing = next(phase.t_start for phase in rigid.simulate(THROWN).phases if phase.kind is Kind.IMPACT)
    part = flexible.simulate(THROWN.replace(run=rigid.Run(t_end=landing + 0.01)))
    assert part.ledger.landing_loss == 0
    on = flexible.simulate(THROWN, resume=part)
    assert repr(on.to_dict()) == repr(whole.to_dict())


@pytest.mark.parametrize("t_end", [1.0, 1e6])
def test_a_hoop_that_never_pulses_runs_to_its_time(t_end):
    """Upside down at rest the rigid hoop stands for ever, and looked for a pulse it would do so too."""
    motion = flexible.simulate(HOOP.replace(release={"phi0": 0.0}, run=rigid.Run(t_end=t_end)))
    assert motion.completed
    assert motion.t_end == t_end
    assert not motion.pulses
