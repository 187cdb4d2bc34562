"""Which pulses a flexible motion has, and what is measured of them, beside the rigid hoop's."""

from math import pi, radians

import numpy as np
import pytest
from scenes import HOOP

import flexible
import rigid
from flexible.output.body import whole
from rigid import Contact, Friction, Hoop, Kind, Release, Ring, Run, Scene, Solve


def near_the_bottom(k, mass_ratio, mu, run, *release):
    """A hoop that rocks, slips and turns back where its pulses are."""
    return Scene(
        Hoop(k, r=1.02, mass_ratio=mass_ratio), Friction(1.1 * mu, mu), Release(*release), run, solve=Solve(rtol=1e-3)
    )  # fmt: skip


TURNS, FIRST = Run(turns=3), Run(until="pulse")
SCENES = {
    "turns shortly before its pulses": near_the_bottom(0.1, 0.0, 0.3, TURNS, 2.922, 0.682),
    "the same, with a slip": near_the_bottom(0.1, 0.0, 0.716, TURNS, 2.0856, 0.5144, -1.1989),
    "released on the way up": near_the_bottom(0.1, 0.1, 0.599, TURNS, 3.0924, -0.6816, 0.2106),
    "turns inside a pulse": near_the_bottom(0.3, 0.0, 0.71, FIRST, 3.1512, -0.0995, 0.8943),
    "turns inside one, and comes back": near_the_bottom(0.3, 0.0, 0.2269, FIRST, 3.161206, -0.133504, 0.832638),
    "turns inside the rest of one": near_the_bottom(0.6, 0.0, 0.69908, TURNS, 2.232224, 0.189195, -0.512771),
    "on the way up, to the first": near_the_bottom(0.3, 0.1, 0.7, FIRST, 3.17367, 0.45069, -0.36776),
    "from the bottom": near_the_bottom(0.1, 0.0, 0.3, Run(t_end=1.5), pi, 0.5),
    "from the bottom, the other way": near_the_bottom(0.1, 0.0, 0.3, Run(t_end=1.5), pi, -0.5),
    "the paper's": rigid.load_scene("paper-3.2-k0.25").replace(run={"turns": 12}, solve={"rtol": 1e-3}),
}


@pytest.mark.parametrize("resolve", ["pulses", "all"])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_stiff_hoop_has_the_rigid_hoops_pulses(scene, resolve):
    """No more and none less, cut where those are; impulses differ as the patch's half-width, 1e-3, makes events."""
    exact, motion = rigid.simulate(scene), flexible.simulate(scene.replace(solve={"resolve": resolve}))
    assert motion.completed
    assert [pulse.cut for pulse in motion.pulses] == [pulse.cut for pulse in exact.pulses]
    for found, known in zip(motion.pulses, exact.pulses, strict=True):
        assert found.normal_impulse == pytest.approx(known.normal_impulse, abs=1e-2)
        assert found.t_start == pytest.approx(known.t_start, abs=2e-2)
    assert motion.t_end == pytest.approx(exact.t_end, abs=2e-2)


def test_a_pulse_with_a_turn_at_the_bottom():
    """There N = M g, and from there it goes back: the rigid hoop's one pulse, and the flexible one's."""
    scene = Scene(Hoop(0.1, r=1.02, mass_ratio=0.1), Friction(0.35, 0.3), Release(pi, slip0=1), Run(t_end=3.5))
    exact, motion = rigid.simulate(scene), flexible.simulate(scene.replace(solve={"rtol": 1e-3}))
    assert [pulse.cut for pulse in motion.pulses] == [pulse.cut for pulse in exact.pulses] == [False]
    for found, known in zip(motion.pulses, exact.pulses, strict=True):
        assert found.normal_impulse == pytest.approx(known.normal_impulse, rel=1e-3)
        assert found.friction_impulse == pytest.approx(known.friction_impulse, rel=1e-3)


def test_no_pulse_in_the_air():
    """Over the angles at which a rigid hoop on the floor had one this hoop flies, from a swing into the next."""
    scene = Scene(
        Hoop(0.3, r=1.02, mass_ratio=0.1), Friction(0.35, 0.3),
        Release(5.912483501685977, 0.9833534339803927, 0.6176876180693398), Run(t_end=5.4),
        solve=Solve(rtol=1e-3, resolve="all"),
    ).replace(ring={"bending_stiffness": 1e6})  # fmt: skip
    motion = flexible.simulate(scene)
    assert any(phase.kind == "flight" and phase.t_end - phase.t_start > 1 for phase in motion.phases)
    assert motion.pulses
    assert all(pulse.normal_impulse > 0 for pulse in motion.pulses)


@pytest.mark.parametrize("phi0_deg", [60, 170])
def test_a_hoop_that_whirls_goes_once_round(phi0_deg):
    """From before its pulse that one; released within one, the rest of it and the next, whole as any other."""
    scene = Scene(Hoop(0.3, 1.02, 1.0), Friction(0.6, 0.6), Release(phi0_deg * pi / 180, 1.2))
    exact, motion = rigid.simulate(scene), flexible.simulate(scene.replace(solve={"rtol": 1e-3}))
    assert motion.ended.partition(";")[0] == exact.ended.partition(";")[0]
    assert motion.t_end > 0.95 * exact.t_end
    last = motion.pulses[-1]
    assert [pulse.cut for pulse in motion.pulses] == [pulse.cut for pulse in exact.pulses[:-1]] + [False]
    further = rigid.simulate(scene.replace(run={"until": "pulse"}))  # the first whole one
    assert last.normal_impulse == pytest.approx(further.pulses[-1].normal_impulse, rel=1e-3)


def test_what_regularised_friction_creeps_before_a_pulse_is_of_it():
    """It slips before the rigid hoop does: rigid till half a pulse before, v_s changed J_F the other way. It is held to
    a hundredth of what v_s changes, as the rolling up to 0.3 mu N creeps at a third of v_s and less.
    """
    scene = Scene(Hoop(0.1, 1.02, 0.05), Friction(0.3, 0.3), Release(pi / 18), Run(until="pulse"))
    creeping = scene.replace(solve={"rtol": 1e-4}, contact={"law": "regularised", "slip_velocity_scale": 1e-2})
    between, throughout = (
        flexible.simulate(creeping.replace(solve={"resolve": resolve})).pulses[0] for resolve in ("pulses", "all")
    )
    changed = throughout.friction_impulse - rigid.simulate(scene).pulses[0].friction_impulse
    assert between.friction_impulse == pytest.approx(throughout.friction_impulse, abs=0.01 * changed)


@pytest.mark.parametrize("law", ["patch", "brush"])
def test_the_pulse_of_a_thrown_hoop_is_over_the_rigid_ones_angles(law):
    """All points of a brush slide at the release: in its first instant it may look like one that sticks."""
    thrown = Scene(Hoop(0.2, 1.02, 1.0), Friction(0.3, 0.3), Release(150 * pi / 180, slip0=0.6), Run(until="pulse"))
    flexibly = thrown.replace(solve={"rtol": 1e-3, "resolve": "all"}, contact={"law": law})
    (known,), (found,) = (motion.pulses for motion in (rigid.simulate(thrown), flexible.simulate(flexibly)))
    assert (found.phi_start, found.phi_end) == pytest.approx((known.phi_start, known.phi_end), abs=1e-9)
    assert found.friction_impulse == pytest.approx(known.friction_impulse, abs=1e-3 * known.normal_impulse)


@pytest.mark.parametrize("resolve", ["pulses", "all"])
def test_the_totals_of_a_history_go_on(resolve):
    """Through all segments: what friction takes in them is what the ledger has, or less by what the rigid hoop lost."""
    scene = HOOP.replace(run={"turns": 3}, contact={"damping": 1.0}, solve={"resolve": resolve})
    motion = flexible.simulate(scene, history=True)
    steps, ledger = motion.history, motion.ledger
    assert steps is not None
    assert (np.diff(steps.normal_impulse) >= 0).all()
    assert steps.damping_loss[-1] == pytest.approx(ledger.damping_loss, rel=1e-12)
    if resolve == "all":
        assert steps.friction_loss[-1] == pytest.approx(ledger.friction_loss, rel=1e-12)
        # at rest and at a turn G neither rises nor falls: the floor has carried the weight
        weight = (1 + scene.hoop.mass_ratio) * motion.t_end
        assert steps.normal_impulse[-1] == pytest.approx(weight, rel=1e-3)
    else:
        pulses = sum(pulse.friction_loss for pulse in motion.pulses)
        assert pulses <= steps.friction_loss[-1] <= ledger.friction_loss


def test_the_restitution_of_a_soft_heavy_ring():
    """By the velocity of the mass centre, of the bent ring as it is: where its parts are taken to stand on a circle
    Newton's number comes out a tenth off."""
    scene = HOOP.replace(
        hoop={"mass_ratio": 1.0}, ring={"bending_stiffness": 5.0}, contact={"stiffness": 1e7, "damping": 1.0},
        solve={"level": "auto", "resolve": "all"},
    )  # fmt: skip
    motion = flexible.simulate(scene, history=True)
    (pulse,), (kept,) = motion.pulses, motion.kept
    t = np.array([state.t for state in kept.states])
    rises = []
    for end in (pulse.t_start, pulse.t_end):
        near = np.flatnonzero(np.abs(t - end) <= np.sort(np.abs(t - end))[3])
        rise = [whole(kept.hoop, kept.states[i]).velocity[1] for i in near]
        rises.append(np.interp(end, t[near], rise))
    # straight between steps, of which a pulse has hundreds
    assert pulse.newton_restitution == pytest.approx(-rises[1] / rises[0], rel=5e-3)


@pytest.mark.parametrize("resolve", ["pulses", "all"])
def test_a_hoop_that_goes_over_the_top_for_ever_has_no_turn_to_wait_for(resolve):
    """Neither solver waits: each goes round once, and says the same."""
    scene = Scene(
        Hoop(0.1, r=1.02, mass_ratio=0.5), Friction(0.777, 0.518), Release(4.869, 0.927), Run(turns=2),
        solve=Solve(rtol=1e-2, resolve=resolve),
    )  # fmt: skip
    exact, motion = rigid.simulate(scene), flexible.simulate(scene)
    assert motion.completed
    assert not motion.turns
    assert motion.ended.split(";")[0] == exact.ended.split(";")[0]  # then comes the period
    assert len(motion.pulses) == len(exact.pulses) == 1


@pytest.mark.parametrize("resolve", ["pulses", "all"])
def test_nor_has_one_whose_patch_creeps(resolve):
    """A brush hands back a slip, that of its creep, which takes 6e-9 of the energy: it was waited for over sixty
    revolutions, in which the hand-overs added a hundredth.
    """
    scene = Scene(
        Hoop(0.1, r=1.05, mass_ratio=0.45), Friction(0.9, 0.8), Release(0.087, -0.356), Run(turns=1),
        ring=Ring(bending_stiffness=415.0), contact=Contact("brush", 1e8), solve=Solve(rtol=1e-3, resolve=resolve),
    )  # fmt: skip
    exact, motion = rigid.simulate(scene), flexible.simulate(scene)
    assert motion.completed
    assert motion.ended.split(";")[0] == exact.ended.split(";")[0]
    assert len(motion.pulses) <= 2


def test_a_pulse_on_the_floor_has_no_time_off_it():
    """However long the hoop was off it before: let go undeformed it bounces at first. Of sums of thousandths some are
    off by round-off, in some releases or others.
    """
    for degrees in range(8, 20):
        scene = rigid.load_scene("paper-3.3-massless").replace(
            release={"phi0": radians(degrees)}, run={"until": "pulse"},
            solve={"resolve": "all", "start": "undeformed", "rtol": 1e-3},
        )  # fmt: skip
        motion = flexible.simulate(scene)
        pulse = motion.pulses[0]
        assert any(phase.kind == Kind.FLIGHT for phase in motion.phases)
        assert all(phase.kind != Kind.FLIGHT for phase in pulse.phases)
        assert pulse.time_off_floor == 0


@pytest.mark.slow
@pytest.mark.parametrize(("stiffness", "bending"), [(1e9, 1e5), (2.5e10, 413.0)])
def test_a_blow_that_turns_the_hoop_is_gone_through(stiffness, bending):
    """It comes in against the way of its pulse, and the pulse goes back over the angles at which the segment began.

    A smooth floor bears C alone: J_N and the weight over the pulse are the momentum that the two ways agree about. The
    hoop was handed back in the blow's first instant, with a whole pulse of J_N = -2.5e-7.
    """
    scene = Scene(
        Hoop(k=0.15842745674856212, r=1.1539877488724264), Friction(0.0, 0.0),
        Release(radians(2.5014167546741914), -2.1161309509262187), Run(until="pulse"),
        ring=Ring(bending_stiffness=bending), contact=Contact(stiffness=stiffness),
    )  # fmt: skip
    exact = rigid.simulate(scene).pulses[0]
    one, other = (flexible.simulate(scene.replace(solve={"resolve": way})).pulses[0] for way in ("pulses", "all"))
    assert one.t_start == pytest.approx(exact.t_start, abs=1e-4)  # the hoop falls on a patch 1e-4 deep or less
    assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=1e-4)
    assert one.peak_normal_force == pytest.approx(other.peak_normal_force, rel=1e-3)


@pytest.mark.parametrize("turned", [0.0, 2e-9])
def test_a_hoop_thrown_from_the_bottom_comes_to_rest_as_its_mirror_image(turned):
    """A swing that begins at the bottom has not gone over it, whichever way it goes: that one ended the run."""
    ends, rtol = [], 1e-3
    for way in (1, -1):
        scene = Scene(
            Hoop(0.667, r=1.02), Friction(2.0, 2.0), Release(way * (pi - turned), way * 1.2), Run(until="rest"),
            solve=Solve(rtol=rtol, resolve="all"),
        )  # fmt: skip
        motion = flexible.simulate(scene)
        ends.append((motion.t_end, len(motion.pulses)))
    assert ends[0][0] == pytest.approx(ends[1][0], rel=rtol)
    assert ends[0][1] == ends[1][1]
