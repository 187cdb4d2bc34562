"""The hand-over takes the phase that its forces belong to, and rates over a time that follows the pulse."""

from math import pi, radians

import numpy as np
import pytest
from scenes import HOOP, pose_at

import flexible
import rigid
from flexible.models.chain import ChainHoop
from flexible.models.reduced import ReducedHoop
from flexible.models.select import hoop_of
from flexible.start.equilibrium import equilibrium
from flexible.start.handover import hand_over
from flexible.time.adaptive import attempt, march
from flexible.time.course import Ends
from rigid import Contact, Friction, Hoop, Kind, Release, Ring, Run, Scene, Solve


def stiff(k):
    """A first pulse of a massless hoop whose ring all but stands still and whose patch is thin beside the disk."""
    scene = Scene(Hoop(k, 1.02), Friction(0.35, 0.3), Release(radians(10)), Run(until="pulse"))
    return scene.replace(ring={"bending_stiffness": 1e14}, contact={"stiffness": 1e10 * (0.1 / k) ** 2})


def test_a_pose_at_a_boundary_is_of_one_phase():
    """Phase and forces of the later one, or of the earlier where that is asked for."""
    motion = rigid.simulate(stiff(0.1))
    for before, after in zip(motion.phases[:-1], motion.phases[1:], strict=True):
        t = after.t_start
        for side, phase in (("left", before), ("right", after)):
            pose = pose_at(motion, t, side)
            assert pose.kind == phase.kind
            if phase.kind != Kind.ROLL:
                assert abs(pose.friction_force / pose.normal_force) == pytest.approx(0.3, rel=1e-9)
    assert pose_at(motion, after.t_start).kind == after.kind


@pytest.mark.parametrize("k", [0.1, 0.01, 1e-3])
@pytest.mark.parametrize("place", ["early", "late", "at a boundary"])
@pytest.mark.parametrize("damping", [0.0, 1.0])
def test_rate_of_the_patch(k, place, damping):
    """Under N = (4/3) eps d sqrt(2 d) a rigid ring sinks at d' = (2/3) d N'/N, with the rigid hoop's N'; where a damper
    bears a part of that by the springs' own N and N'.

    Its pulse takes k^2, and N jumps where its phases meet. The patch's 18 points ripple by parts of a thousand, the
    ring yields a little: 1 %.
    """
    scene = stiff(k).replace(contact={"damping": damping})
    motion = rigid.simulate(scene)
    pulse = motion.pulses[0]
    shares = {"early": 0.1, "late": 0.6}
    t = pulse.t_start + shares.get(place, 0) * (pulse.t_end - pulse.t_start)
    if place == "at a boundary":
        t = motion.phases[-1].t_start
        assert pulse.t_start < t < pulse.t_end
    state = hand_over(ReducedHoop(scene), motion, t)
    h = 1e-4 * k**2
    n = motion.at(t + h * np.arange(3)).normal_force
    rate = (-3 * n[0] + 4 * n[1] - n[2]) / (2 * h)
    if state.elastic_rate:
        assert damping > 0
        hoop = ReducedHoop(scene)
        assert state.res.elastic + hoop.relaxation * state.elastic_rate == pytest.approx(float(n[0]), rel=1e-9)
        rate, n[0] = state.elastic_rate, state.res.elastic
    assert state.vel[1] == pytest.approx(2 / 3 * state.pos[1] * rate / n[0], rel=1e-2)


@pytest.mark.parametrize(("k", "mass"), [(0.7, 0.0), (0.322, 0.632)])
@pytest.mark.parametrize(
    ("law", "damping", "share"), [("patch", 0.0, 0.01), ("patch", 1.0, 0.01), ("brush", 1.0, 0.05)]
)
def test_a_rolling_patch_goes_on_as_it_was_handed_over(law, damping, share, k, mass):
    """It creeps, and damper and bristles share F as they do in steady rolling: F stays that of the rigid hoop.

    For as long as a point takes through the patch, which all bristles that were handed over leave meanwhile. A brush,
    whose rear slides, carries 5/6 of what it can; a bristle of its 12 or so that breaks is 2 to 3 % of that.
    """
    scene = Scene(Hoop(k, 1.05, mass), Friction(0.4, 0.2), Release(1.35, 0.6), Run(until="pulse"))
    scene = scene.replace(contact={"stiffness": 2.4e7, "law": law, "damping": damping})
    scene = scene.replace(ring={"bending_stiffness": 1141.0})
    motion = rigid.simulate(scene)
    hoop = ReducedHoop(scene)
    start = hand_over(hoop, motion, 0.0)
    assert motion.phases[0].kind == Kind.ROLL
    assert abs(start.res.friction) > 0.2 * start.res.normal
    through = start.res.length / abs(start.vel[2])
    _, records, _, _, _ = march(hoop, start, Ends(t=through), 1e-5)
    expected = motion.at(np.array([r.t for r in records])).friction_force
    assert np.array([r.friction_force for r in records]) == pytest.approx(expected, rel=share)


@pytest.mark.parametrize("stiffer", [1.0, 40.0])
def test_a_hoop_that_rolls_is_not_made_to_slip_by_its_hand_over(stiffer):
    """The rigid hoop never needs more than 0.76 mu_s N; one that once slips, with a mu of 0.1, slips for long."""
    scene = Scene(Hoop(0.322, 1.05, 0.632), Friction(0.276, 0.1), Release(radians(20)), Run(until="pulse"))
    scene = scene.replace(ring={"bending_stiffness": 1141.0 * stiffer}, contact={"stiffness": 2.4e7 * stiffer})
    motion = rigid.simulate(scene)
    states = motion.at(np.linspace(0, motion.t_end, 1000))
    assert np.abs(states.friction_force / states.normal_force).max() < 0.76 * 0.276
    assert [phase.kind for phase in motion.phases] == [Kind.ROLL]
    assert [phase.kind for phase in flexible.simulate(scene).phases] == [Kind.ROLL]


@pytest.mark.parametrize("share", [0.97, 0.985, 0.993, 0.998, 0.9999])
@pytest.mark.parametrize(("phi0", "omega0"), [(2.0, 0.5), (1.35, 0.6)])
def test_a_brush_that_all_but_slips_creeps_no_more_than_one_that_does(phi0, omega0, share):
    """All of a parabolic patch of width 2 a slips from a creep of mu a phidot eps_n/eps_t on.

    Its dozen of points cannot carry the last of mu N, 2 to 3 %, and no creep will have them do it.
    """
    hoop, release, run = Hoop(0.1, 1.02, 0.1), Release(phi0, omega0), Run(until="pulse")
    start = rigid.simulate(Scene(hoop, Friction(9.0, 9.0), release, run)).at(0.0)
    mu = abs(float(start.friction_force / start.normal_force)) / share
    scene = Scene(hoop, Friction(mu, mu), release, run).replace(contact={"law": "brush"}, solve={"resolve": "all"})
    state = hand_over(ReducedHoop(scene), rigid.simulate(scene), 0.0)
    assert abs(state.slip_velocity) <= mu * state.res.length / 2 * omega0 / scene.contact.tangential_ratio
    assert abs(state.res.friction) == pytest.approx(abs(float(start.friction_force)), rel=0.03)
    ours, theirs = flexible.simulate(scene, states=False).pulses[0], rigid.simulate(scene).pulses[0]
    assert ours.normal_impulse == pytest.approx(theirs.normal_impulse, rel=1e-3)


def test_a_brush_is_handed_over_between_slips():
    """In the middle of a run, with F at 0.988 of what rolls."""
    release = Release(0.04728663778816866, 0.0, -0.6878798824644039)
    scene = Scene(
        Hoop(0.5637576790957322, 1.062140071386526), Friction(0.29712544, 0.29712544), release, Run(t_end=5.0)
    )
    scene = scene.replace(contact={"law": "brush"}, ring={"bending_stiffness": 1e5})
    motion = flexible.simulate(scene, states=False)
    assert abs(motion.ledger.hand_over) < 1e-3 * motion.ledger.initial
    (ours,), (theirs,) = motion.pulses, rigid.simulate(scene).pulses
    assert ours.normal_impulse == pytest.approx(theirs.normal_impulse, rel=1e-3)


@pytest.mark.parametrize("stiffness", [1e9, 1e12])
def test_a_brush_that_slides_as_it_is_handed_over_slides_on(stiffness):
    scene = Scene(Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(2.9, 3.0, 1.0), Run(t_end=0.3))
    scene = scene.replace(contact={"law": "brush", "stiffness": stiffness})
    assert [phase.kind for phase in flexible.simulate(scene, states=False).phases] == [Kind.SKID]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(16))
def test_no_roll_is_broken_by_its_hand_over(seed):
    """Hoops of the model's range that keep 0.85 of mu_s N or less when rigid, on any floor, with a mu that is half."""
    draw = np.random.default_rng(seed).uniform
    hoop, release = Hoop(draw(0.1, 0.5), draw(1.01, 1.1), draw(0.0, 1.0)), Release(radians(draw(5, 50)))
    smooth = rigid.simulate(Scene(hoop, Friction(5.0, 5.0), release, Run(until="pulse")))
    states = smooth.at(np.linspace(0, smooth.t_end, 2000))
    mu_s = float(np.abs(states.friction_force / states.normal_force).max()) / 0.85
    scene = Scene(hoop, Friction(mu_s, mu_s / 2), release, Run(until="pulse"))
    scene = scene.replace(ring={"bending_stiffness": 10 ** draw(3, 5)}, contact={"stiffness": 10 ** draw(7, 9)})
    assert {phase.kind for phase in rigid.simulate(scene).phases} == {Kind.ROLL}
    assert {phase.kind for phase in flexible.simulate(scene).phases} == {Kind.ROLL}


@pytest.mark.slow
def test_a_soft_ring_rests_on_a_foundation_however_stiff():
    """The ring, a massless one at E I = 1.13, bends to that of a rigid floor as the foundation's compliance goes to 0.

    Its load turns the rim at the floor by 0.1, hundreds of lengths of the patch, which is no loss of equilibrium. The
    wall gives way more than the floor and in series with it, so that the patch keeps its length: per ten times the
    foundation the change falls by ten. Points are as far apart on all, so that where they lie is in no change; from
    1e10 to 1e12, some 160 to each patch, that left the ratio anything from 8 to 10.5.
    """
    scene = Scene(Hoop(0.25, 1.18), Friction(0.26, 0.25), Release(radians(8)), Run(until="pulse"))
    scene = scene.replace(ring={"bending_stiffness": 1.13})
    motion = rigid.simulate(scene)
    pose = pose_at(motion, 0.45 * motion.t_end)
    bent = []
    for stiffness in (2e9, 2e10, 2e11, 1e12):
        points = round(2700 * (2e11 / stiffness) ** (1 / 3))
        state = equilibrium(ChainHoop(scene.replace(contact={"stiffness": stiffness}), points=points), pose)
        assert state.normal_force == pytest.approx(pose.normal_force, rel=1e-6)
        bent.append(state.pos[3:])
    changes = np.abs(np.diff(bent, axis=0)).max(axis=1)
    assert changes[0] / changes[1] == pytest.approx(10, rel=0.02)


def test_acceleration_of_a_flexible_motion():
    """phiddot is the solver's own, the slope of its phidot: trapezoids add up to the change of phidot between events.

    Steps of second order that keep impulses to rtol = 1e-4 keep this to 1e-3 of the largest phidot.
    """
    scene = rigid.load_scene("paper-3.3-heavier").replace(run={"until": "pulse"})
    motion = flexible.simulate(scene, history=True)
    history = motion.history
    t, alpha, omega = history.t, history.alpha, history.omega
    change = np.concatenate([[0.0], np.cumsum((alpha[1:] + alpha[:-1]) / 2 * np.diff(t))])
    assert np.abs(omega - omega[0] - change).max() < 1e-3 * np.abs(omega).max()
    # and motion.at gives it, on both sides of an event, which left two records of one time
    twice = np.flatnonzero(np.diff(t) == 0)
    assert len(twice)
    for i in twice:
        assert float(motion.at(t[i], "left").alpha) == alpha[i]
        assert float(motion.at(t[i]).alpha) == alpha[i + 1]
    before = motion.at(t[0] / 2)
    assert float(before.alpha) == float(rigid.simulate(scene).at(t[0] / 2).alpha)


def test_what_the_last_hand_over_adds_is_told_too():
    """A soft hoop kicked at the bottom is in the equilibrium of its fast pulse, which holds some % more than the rigid
    hoop did: N^2 C/2 of the wall's springs, where it sinks by N C, of a wall that gives way by C under m g.

    The run ends before another pulse, at which it was asked before.
    """
    scene = Scene(Hoop(0.1, 1.02, 0.05), Friction(0.35, 0.3), Release(pi, omega0=1.5), Run(t_end=1.5))
    soft = {"ring": {"bending_stiffness": 10.0}, "contact": {"stiffness": 1e8}}
    motion = flexible.simulate(scene.replace(**soft, solve={"rtol": 3e-3}))
    assert not motion.completed
    assert "solve.resolve = 'all'" in motion.ended
    assert motion.t_end == motion.pulses[-1].t_end < motion.scene.run.t_end
    assert motion.ledger.hand_over < -0.01 * motion.ledger.initial


def test_a_rigid_hoop_stands_in_for_a_soft_one():
    """A plastic hula hoop sags by a sixtieth of its radius, and its disk vibrates: rigid between pulses it keeps all
    but the energy of that, of the order of the sag, and its pulses are those of the ring by itself.

    That one rolls to and fro, as the rigid one does, and stays on the floor.
    """
    scene = rigid.load_scene("hula-hoop").replace(solve={"rtol": 1e-3})
    between = flexible.simulate(scene.replace(solve={"resolve": "pulses"}))
    assert between.completed, between.ended
    assert abs(between.ledger.hand_over) < between.ledger.initial / 60
    motion = flexible.simulate(scene)
    assert motion.completed, motion.ended
    assert len(between.turns) == len(motion.turns)
    for one, other in zip(between.pulses, motion.pulses, strict=True):
        assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=1 / 60)


@pytest.mark.parametrize(
    ("bending", "share"),
    [pytest.param(20.0, 0.02, marks=pytest.mark.slow), (40.0, 1e-3), pytest.param(60.0, 1e-3, marks=pytest.mark.slow)],
)
def test_the_rigid_hoop_takes_over_what_the_rotation_has(bending, share):
    """Not the disk's own phidot, which vibrates on a ring with mass: by that it lost 27, 4 and 2 % of the energy. Now
    what is lost is the vibration's, and the first turn is the ring's by itself within what that amounts to.
    """
    scene = Scene(Hoop(0.1, 1.02, 0.05), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1))
    scene = scene.replace(
        ring={"bending_stiffness": bending}, contact={"stiffness": 1e8}, solve={"rtol": 1e-3, "level": "chain"}
    )
    motion = flexible.simulate(scene)
    assert motion.completed, motion.ended
    assert abs(motion.ledger.hand_over) < share * motion.ledger.initial
    by_itself = flexible.simulate(scene.replace(solve={"resolve": "all"}))
    lacking = share * motion.ledger.initial + 0.005  # and what the ring holds of it where it turns
    assert motion.turns[0].energy == pytest.approx(by_itself.turns[0].energy, abs=lacking)


def test_a_soft_ring_that_stays_by_itself_on_the_floor_rolls_to_and_fro():
    """The hula hoop again, as it comes."""
    scene = rigid.load_scene("hula-hoop").replace(solve={"rtol": 1e-3})
    motion = flexible.simulate(scene)
    assert [turn.phi for turn in motion.turns] == pytest.approx(
        [2 * np.pi - scene.release.phi0, scene.release.phi0], abs=0.02
    )
    assert all(phase.kind != Kind.FLIGHT for phase in motion.phases)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("law", ["patch", "brush", "regularised"])
def test_a_hoop_that_stands_on_its_head_is_handed_over_without_a_friction(law):
    """The disk straight above the floor pulls no way, and bristles that are to pull nothing have no stretch."""
    scene = Scene(Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(0.0), Run(t_end=1.0))
    motion = flexible.simulate(scene.replace(contact={"law": law}, solve={"rtol": 1e-3, "resolve": "all"}))
    assert motion.completed
    # it stands there, but for what round-off grows to: exp(t) at most, sqrt(e/K) < 1.1
    assert abs(float(motion.at(1.0).phi)) < 1e-6


def test_behind_a_pulse_the_rigid_hoop_goes_on_from_where_it_is():
    """To a turn: its centre does not jump, and all that it holds there is its height, and sliding along by then.

    Over 1e-9 to either side of the hand-over the centre goes by less than 1e-8.
    """
    motion = flexible.simulate(HOOP.replace(run={"turns": 1}))
    over = motion.pulses[0].t_end
    assert over < motion.t_end - 0.1
    before, behind = motion.at(over + np.array([-1e-9, 1e-9])).x_C
    assert behind == pytest.approx(before, abs=1e-8)
    assert abs(before) > 1
    end, M = motion.at(motion.t_end), 1 + HOOP.hoop.mass_ratio
    assert motion.ledger.gravity == pytest.approx(M * (1 + HOOP.hoop.e * np.cos(end.phi)), rel=1e-9)
    assert motion.ledger.kinetic == pytest.approx(M * end.slip_velocity**2 / 2, rel=1e-9)
    assert motion.ledger.ring_strain == motion.ledger.contact_spring == 0


@pytest.mark.parametrize("foundation", [1e3, 1e4])
def test_a_roll_is_handed_over_with_the_slip_of_its_patch(foundation):
    """Deep in a soft floor the rim is not where it rolls: the slip told is that with which the first step begins, to
    what it changes in 1e-5.
    """
    scene = HOOP.replace(
        hoop={"k": 0.25, "mass_ratio": 0.01}, ring={"bending_stiffness": 1e4}, run=Run(turns=1),
        contact={"stiffness": foundation, "damping": 0.0}, solve={"rtol": 1e-5},
    )  # fmt: skip
    hoop, motion = hoop_of(scene), rigid.simulate(scene)
    phase = motion.phases[0]
    assert phase.kind == Kind.ROLL
    state = hand_over(hoop, motion, phase.t_start + 0.8 * (phase.t_end - phase.t_start))
    after = attempt(hoop, state, 1e-5)
    assert after.slip_velocity == pytest.approx(state.slip_velocity, rel=5e-3)


@pytest.mark.parametrize(("damping", "stiffness"), [(1.0, 1e4), (3.0, 1e4), (3.0, 1e7)])
@pytest.mark.parametrize("omega0", [5.0, -5.0])
@pytest.mark.parametrize("integrator", ["esdirk3", "esdirk4"])
def test_a_damped_floor_bears_from_the_first_what_the_rigid_hoop_does(damping, stiffness, omega0, integrator):
    """N = N_el + theta dN_el/dt: a hoop thrown where N falls fast (behind the bottom) or rises (before it).

    With springs pressed by all of N it began with 0.3 of that, or left the floor at once; by rates at a step's end that
    follow six stages by a quintic one that slides began with a stick. The patch is some hundredths of R wide, and
    N of the rigid hoop changes by a few of its hundredths over that.
    """
    scene = Scene(
        Hoop(0.1, 1.02), Friction(0.35, 0.3), Release(radians(185), omega0), Run(t_end=1e-3),
        ring=Ring(stiffness), contact=Contact(stiffness=1e7, damping=damping),
        solve=Solve(resolve="all", rtol=1e-5, integrator=integrator),
    )  # fmt: skip
    motion, limit = flexible.simulate(scene, history=True), rigid.simulate(scene)
    assert [phase.kind for phase in motion.phases] == [phase.kind for phase in limit.phases]
    expected = limit.at(motion.history.t).normal_force
    assert motion.history.normal_force == pytest.approx(expected, rel=0.03)


def test_a_release_that_creeps_is_not_thrown():
    """Rolling an elastic hoop creeps; the rigid one takes that slip for a jam, and is stopped, which takes 1e-7 mgR."""
    creeping = Scene(
        Hoop(k=0.0345, r=1.19), Friction(0.734, 0.734), Release(1.0, 0.08, -2e-3), Run(t_end=0.05),
        ring=Ring(bending_stiffness=3060.0), contact=Contact("regularised", 7.5e11, slip_velocity_scale=1e-3),
        solve=Solve(resolve="all", rtol=1e-3),
    )  # fmt: skip
    assert rigid.simulate(creeping).phases[0].kind is Kind.IMPACT
    motion = flexible.simulate(creeping)
    assert Kind.FLIGHT not in [phase.kind for phase in motion.phases]
    thrown = flexible.simulate(creeping.replace(release={"slip0": -0.2}))
    assert Kind.FLIGHT in [phase.kind for phase in thrown.phases]


@pytest.mark.parametrize("t_end", [1e-3, 1e-9, 1e-20, 1e-69])
def test_a_start_of_a_phase_that_is_over_at_once_moves_as_the_rigid_hoop(t_end):
    """Its rates are differences over the phase, or left out where these would be round-off: the kinetic energy is the
    rigid hoop's to what it gives way, 1e-3 of R, and the disk has no velocity that would be out of this world.
    """
    scene = Scene(
        Hoop(0.3, 1.1, 0.3), Friction(0.7, 0.7), Release(phi0_deg=150, omega0=1.3), Run(t_end=t_end),
        ring=Ring(1e4), contact=Contact(stiffness=1e6), solve=Solve(elements=120),
    )  # fmt: skip
    hoop, motion = hoop_of(scene), rigid.simulate(scene)
    e, c = scene.hoop.e, np.cos(radians(150))  # about the point of contact, from which G is so far
    moving = (1 + scene.hoop.mass_ratio) * (scene.hoop.K + 1 + 2 * e * c + e**2) * 1.3**2 / 2
    assert hoop.energies(hand_over(hoop, motion, 0.0))[0] == pytest.approx(moving, rel=1e-2)
