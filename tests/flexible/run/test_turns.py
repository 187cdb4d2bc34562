"""Where a hoop on a soft ring turns: where its momentum does, and not its vibrating disk."""

from math import pi, radians

import numpy as np
import pytest

import flexible
import rigid
from flexible.airborne import taken_over
from flexible.models.chain import ChainHoop
from flexible.models.reduced import ReducedHoop
from flexible.models.state import momentum, rotation
from flexible.start.handover import hand_over
from flexible.time.events import sight
from rigid import Friction, Hoop, Release, Run, Scene

SOFT = Scene(Hoop(0.1, 1.02, 0.05), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1)).replace(
    ring={"bending_stiffness": 20.0}, contact={"stiffness": 1e8}, solve={"rtol": 3e-3, "level": "chain"}
)


def on_the_floor(level):
    """A hoop, and a state in which disk and ring move at random; and the momenta of unit rates, (n, n)."""
    scene = SOFT.replace(ring={"bending_stiffness": 1e3}, solve={"level": "auto", "elements": 24})
    hoop = level(scene)
    motion = rigid.simulate(scene)
    state = hand_over(hoop, motion, motion.t_end / 3)
    units = np.eye(len(state.vel))
    random = np.random.default_rng(3).normal(size=(2, len(state.vel)))
    state = state._replace(vel=0.3 * random[0])
    mass = np.array([[momentum(hoop, state._replace(vel=b), a) for a in units] for b in units])
    return hoop, state, mass


@pytest.mark.parametrize("level", [ReducedHoop, ChainHoop])
def test_the_floor_turns_no_hoop_at_once(level):
    """An impulse of N, however the ring takes it, changes nothing of the rotation; one of F nothing of a hoop's that
    rolls. Of a rigid motion it is phidot.
    """
    hoop, state, mass = on_the_floor(level)
    pushed, pulled = np.linalg.solve(mass, np.eye(len(mass))[[1, 0]].T).T
    for rolls in (True, False):
        before = rotation(hoop, state.pos, state.vel, rolls, 0.0)
        assert rotation(hoop, state.pos, state.vel + 0.7 * pushed, rolls, 0.0) == pytest.approx(before, abs=1e-9)
    before = rotation(hoop, state.pos, state.vel, True, 0.0)
    assert rotation(hoop, state.pos, state.vel + 0.7 * pulled, True, 0.0) == pytest.approx(before, abs=1e-9)
    rates = 0 * state.vel
    rates[2] = -1.3
    assert rotation(hoop, state.pos, rates, True, 0.0) == pytest.approx(-1.3, abs=1e-9)
    rates[0] = 0.4
    # and so it is of one that rolls with a creep
    assert rotation(hoop, state.pos, rates, True, 0.4) == pytest.approx(-1.3, abs=1e-9)
    assert rotation(hoop, state.pos, rates, False, 0.0) == pytest.approx(-1.3, abs=1e-9)


@pytest.mark.parametrize("stuck", [1.0, 0.0])
@pytest.mark.parametrize("level", [ReducedHoop, ChainHoop])
def test_the_rigid_hoop_has_the_momenta_of_the_flexible_one(level, stuck):
    """Along phi, and along the floor where it slides: of a rigid hoop M (V' + (1 + e c) phidot) along the floor, and
    (1 + e c) times that and M (e^2 s^2 + K) phidot along phi.
    """
    hoop, state, _ = on_the_floor(level)
    state = state._replace(res=state.res._replace(stuck=stuck))
    omega, slip, _ = taken_over(hoop, state)
    scene, phi = hoop.scene.hoop, state.pos[2]
    M, lever = 1 + scene.mass_ratio, 1 + scene.e * np.cos(phi)
    along = M * (slip + lever * omega)
    about = lever * along + M * ((scene.e * np.sin(phi)) ** 2 + scene.K) * omega
    units = np.eye(len(state.vel))
    assert about == pytest.approx(momentum(hoop, state, units[2]), rel=1e-9)
    if stuck:
        assert slip == 0
    else:
        assert along == pytest.approx(momentum(hoop, state, units[0]), rel=1e-9)


def test_whether_a_hoop_rolls_is_asked_once_in_a_step():
    """A patch that slides has bristles that stick at one instant and none at the next: its rotation does not jump so.

    A turn was found at such a jump, in steps of 1e-12, for ever.
    """
    hoop, state, _ = on_the_floor(ReducedHoop)
    law = hoop.law.parameters
    some, none = (state._replace(res=state.res._replace(stuck=stuck)) for stuck in (0.5, 0.0))
    rolling, sliding = (rotation(hoop, state.pos, state.vel, rolls, 0.0) for rolls in (True, False))
    assert rolling != pytest.approx(sliding, rel=1e-3)
    assert [sight(hoop, law, there, some, 0.0).rotation for there in (some, none)] == [rolling, rolling]
    assert [sight(hoop, law, there, none, 0.0).rotation for there in (some, none)] == [sliding, sliding]


def test_a_disk_that_vibrates_does_not_turn():
    """Let go of undeformed, the disk falls on its ring and is turned back a little at first; the hoop goes."""
    scene = SOFT.replace(solve={"resolve": "all", "start": "undeformed"}, contact={"damping": 0.0})
    motion = flexible.simulate(scene.replace(run={"t_end": 0.4}), history=True)
    assert motion.completed, motion.ended
    omega = motion.history.omega
    assert omega.min() < -1e-3
    assert omega[-1] > 1e-2
    assert not motion.turns


@pytest.mark.slow
def test_a_soft_hoop_let_go_undeformed_turns_beyond_the_bottom():
    """Where friction lets the rigid hoop come to, but for what its vibrations keep of its energy: the sag's work, of
    the order of 1/(E I) or .05, where 1 - cos of the way up is worth that.
    """
    scene = SOFT.replace(solve={"resolve": "all", "start": "undeformed"}, contact={"damping": 1.0})
    (turn,) = flexible.simulate(scene).turns
    (other,) = rigid.simulate(scene).turns
    assert turn.phi > 1.5 * pi
    assert np.cos(turn.phi) == pytest.approx(np.cos(other.phi), abs=0.05)


def test_a_hoop_that_creeps_turns_where_one_does_that_sticks():
    """Smoothed friction lets it roll with a creep, whose momentum is none of a rotation; the disk vibrates backward at
    first. Beside the patch law's: a turn of the same hoop, within what its creep slides, v_s/sqrt(1 - (F/mu N)^2).
    """
    scene = SOFT.replace(
        hoop={"r": 1.05, "mass_ratio": 1.0},
        friction={"mu_s": 0.4, "mu": 0.4},
        release={"phi0_deg": 140},
        ring={"bending_stiffness": 10.0, "poisson": 0.0},
        contact={"stiffness": 1e7},
        solve={"resolve": "all"},
    )
    creeps, sticks = (flexible.simulate(scene.replace(contact={"law": law})) for law in ("regularised", "patch"))
    (turn,), (other,) = creeps.turns, sticks.turns
    slid = scene.contact.slip_velocity_scale * other.t
    assert turn.t > 5
    assert turn.phi == pytest.approx(other.phi, abs=3 * slid)


@pytest.mark.slow
@pytest.mark.parametrize("angle", [-2.0, -1.2, 1.2])
def test_a_patch_that_bears_next_to_nothing_tells_of_no_turn(angle):
    """Let go undeformed a hoop without mass falls freely at first; its rim's friction is as small as N is."""
    scene = SOFT.replace(
        hoop={"r": 1.03, "mass_ratio": 0.0},
        release={"phi0": angle},
        run={"t_end": 0.02},
        ring={"bending_stiffness": 3.0},
        contact={"stiffness": 2.6e8, "damping": 0.0},
        solve={"resolve": "all", "start": "undeformed", "rtol": 1e-3, "level": "auto"},
    )
    assert not flexible.simulate(scene).turns


def test_a_hoop_that_begins_pressed_on_the_floor_turns_however_little_it_bears():
    """Of a ring in equilibrium the momentum tells which way it goes from the first: it bears 0.06 mg until it turns."""
    scene = rigid.load_scene("paper-3.3-heavier").replace(
        hoop={"k": 0.15105, "mass_ratio": 0.0}, friction={"mu": 0.52937, "mu_s": 0.55292},
        release={"phi0": 3.52851, "omega0": 0.33621, "slip0": -2.13025}, ring={"bending_stiffness": 1e5},
        run={"t_end": 0.3}, solve={"resolve": "all"},
    )  # fmt: skip
    (turn,), (other,) = flexible.simulate(scene).turns, rigid.simulate(scene).turns
    assert turn.t == pytest.approx(other.t, rel=scene.contact.stiffness ** (-1 / 3))
