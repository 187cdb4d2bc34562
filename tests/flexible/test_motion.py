"""Motions of the flexible hoop: order in time, bounce, sag, symmetry, units, hand-over, ledger, friction laws."""

from math import pi, sqrt

import numpy as np
import pytest
from scenes import HOOP, energy, flying, pose_at, steps_of

import flexible
import rigid
from flexible.contact.laws.patch import SLIDE_LEFT, SLIDE_RIGHT, STICK, Patch
from flexible.models.reduced import ReducedHoop
from flexible.pieces import on_clock
from flexible.start.equilibrium import equilibrium
from flexible.start.handover import hand_over
from flexible.start.pose import Pose
from flexible.time.adaptive import march, restart
from flexible.time.events import Ends
from flexible.time.methods import ESDIRK3, METHODS, TR_BDF2
from rigid.elastic import LAWS

#: just before its pulse, fast
PULSE = HOOP.replace(release={"phi0": 2.4, "omega0": 1.5})


def order(steps, errors):
    """Fitted exponent."""
    return np.polyfit(np.log(steps), np.log(np.abs(errors)), 1)[0]


@pytest.mark.parametrize("mass", [0.0, 0.1])
def test_order_in_time(mass):
    """Sliding in contact with equal steps: TR-BDF2 is of second order, and ESDIRK3 tens of times as accurate.

    With and without mass in the ring. What is left of the better method's errors, 1e-9 and less, is how often the
    points' forces are differentiable: its own order shows in free flight.

    A soft floor and two modes, so that the steps resolve what vibrates: damping the rest away is no error of an order.
    Fast and long enough that the errors, some 1e-9 of J_N, are above what Newton's method leaves at a tolerance of
    1e-6.
    """
    scene = HOOP.replace(
        hoop={"mass_ratio": mass}, release={"phi0": 1.5, "omega0": 2.0}, contact={"stiffness": 1e4},
        friction={"mu_s": 0.02, "mu": 0.02}, solve={"rtol": 1e-6, "elements": 240, "through": 1},
    )  # fmt: skip
    hoop = ReducedHoop(scene, modes=2, points=Patch.points)
    start = hand_over(hoop, rigid.simulate(scene), 0.0)
    assert start.mode != STICK
    steps = 0.1 / np.array([100, 200, 400, 3200])

    def ends_by(method):
        ends = []
        for step in steps:
            last, records, _ = steps_of(hoop, start, 0.1, step, method)
            ends.append([last.pos[2], records[-1].normal_impulse])
        return np.array(ends)

    second, third = ends_by(TR_BDF2), ends_by(ESDIRK3)
    errors = second[:-1] - third[-1]
    for column in errors.T:
        assert order(steps[:-1], column) == pytest.approx(2, abs=0.3)
    assert np.abs(third[0, 0] - third[-1, 0]) < 0.05 * np.abs(errors[0, 0])


@pytest.mark.parametrize("method", METHODS.values(), ids=lambda method: method.name)
def test_order_of_every_method(method):
    """A turning ring that vibrates in free flight: smooth, so each method has its own order."""
    hoop = ReducedHoop(HOOP.replace(ring={"bending_stiffness": 2.0}), modes=4)
    pos, vel = np.array([0.0, 0.5, 1.0, 0.03, -0.02, 0.01, 0.01]), np.array([0.3, 0.0, 2.0, 0.0, 0.1, 0.0, -0.1])
    start = restart(hoop, flying(hoop, pos, vel), 0)
    steps = 0.2 / np.array([100, 200, 400, 1600])  # the longest a fiftieth of the shortest period
    ends = np.array([steps_of(hoop, start, 0.2, step, method)[0].pos[2:] for step in steps])
    errors = np.abs(ends[:-1] - ends[-1]).max(axis=1)
    assert order(steps[:-1], errors) == pytest.approx(method.order, abs=0.3)


@pytest.mark.parametrize("method", METHODS.values(), ids=lambda method: method.name)
def test_tables(method):
    """Order conditions up to the method's order (Hairer, Norsett and Wanner 1993, II.2), stiff accuracy, R(inf) = 0."""
    a, b, c = method.a, method.b, method.c
    conditions = {
        1: [b.sum() - 1],
        2: [b @ c - 1 / 2],
        3: [b @ c**2 - 1 / 3, b @ a @ c - 1 / 6],
        4: [b @ c**3 - 1 / 4, b @ (c * (a @ c)) - 1 / 8, b @ a @ c**2 - 1 / 12, b @ a @ a @ c - 1 / 24],
    }
    for order_, residuals in conditions.items():
        met = np.abs(residuals).max() < 1e-14
        assert met == (order_ <= method.order)
    assert c[-1] == pytest.approx(1, abs=1e-15)
    # the stability function's limit, from the implicit stages: 1 - b A^-1 1 of the reducible first stage
    lower = a[1:, 1:]
    limit = np.linalg.solve(lower, -a[1:, 0])[-1]
    assert limit == pytest.approx(0, abs=1e-12)
    # a force linear in the way does the work of its ends, whatever happens at the stages between: some thirty products,
    # of weights up to 5
    way = np.random.default_rng(1).standard_normal(len(c))
    way[0] = 0.0
    assert (2.0 + 3.0 * way) @ method.work @ way == pytest.approx(2 * way[-1] + 1.5 * way[-1] ** 2, rel=1e-12)


def test_frictionless_bounce():
    """Dropped on the disk's side, undamped: what the integrator loses falls with its step, at order two or better."""
    scene = HOOP.replace(
        friction={"mu_s": 0.0, "mu": 0.0},
        contact={"stiffness": 1e5},
        hoop={"mass_ratio": 0.0},
        ring={"bending_stiffness": 1e6},
    )
    hoop = ReducedHoop(scene)
    pos, vel = np.array([0.0, 1e-3, pi]), np.array([0.0, -0.1, 0.0])
    start = restart(hoop, flying(hoop, pos, vel), 0)
    steps = np.array([1e-3, 5e-4, 2.5e-4])
    drifts = []
    for step in steps:
        _, records, _ = steps_of(hoop, start, 0.2, step)
        assert max(r.normal_force for r in records) > 5  # it did bounce
        assert records[-1].normal_force == 0
        drifts.append(energy(records[0]) - energy(records[-1]))
        assert records[-1].friction_loss == pytest.approx(0, abs=1e-12)
    assert abs(drifts[-1]) < 1e-2 * 0.1**2 / 2
    assert order(steps, drifts) > 1.8


def test_static_sag():
    """On the disk, N = M g and the Winkler patch of a rigid ring, N = (4/3) eps delta sqrt(2 delta).

    The weld hardly yields where the disk is; what the patch's 24 points leave is 3e-3.
    """
    scene = HOOP.replace(ring={"bending_stiffness": 1e8}, contact={"stiffness": 1e6})
    hoop = ReducedHoop(scene, points=24)
    weight = 1 + scene.hoop.mass_ratio
    state = equilibrium(hoop, Pose(pi, 0.0, 0.0, weight, 0.0, rigid.Kind.ROLL))
    depth = -state.pos[1]
    assert 4 / 3 * 1e6 * depth * sqrt(2 * depth) == pytest.approx(weight, rel=3e-3)
    # and it stays at rest
    _, records, _, ended, _ = march(hoop, restart(hoop, state, 0), Ends(t=0.5), 1e-4)
    assert not ended
    forces = np.array([r.normal_force for r in records])
    assert np.abs(forces - weight).max() < 1e-6 * weight
    assert abs(records[-1].phi - pi) < 1e-9


def test_mirror():
    """phi -> 2 pi - phi: the same motion seen from behind; J_F changes its sign.

    Mesh and contact points are symmetric: to round-off, magnified by the motion, far below what the march resolves.
    """
    left = PULSE.replace(release={"phi0": 2 * pi - PULSE.release.phi0, "omega0": -PULSE.release.omega0})
    a, b = (flexible.simulate(scene).pulses[0] for scene in (PULSE, left))
    assert b.normal_impulse == pytest.approx(a.normal_impulse, rel=1e-6)
    assert b.friction_impulse == pytest.approx(-a.friction_impulse, rel=1e-5)
    assert b.friction_loss == pytest.approx(a.friction_loss, rel=1e-5, abs=1e-9)
    assert (b.phi_start, b.phi_end) == pytest.approx((2 * pi - a.phi_start, 2 * pi - a.phi_end))


def test_a_turn_more_is_the_same_motion():
    """phi -> phi + 2 pi counts other contact points, so the same within what their distance leaves, 1e-3."""
    more = PULSE.replace(release={"phi0": PULSE.release.phi0 + 2 * pi})
    a, b = (flexible.simulate(scene).pulses[0] for scene in (PULSE, more))
    assert b.normal_impulse == pytest.approx(a.normal_impulse, rel=1e-3)
    assert b.friction_impulse == pytest.approx(a.friction_impulse, abs=1e-3 * a.normal_impulse)


def test_units():
    """The same scene in SI: every output in its unit."""
    si = PULSE.replace(
        hoop={"R": 0.3, "m": 2.5, "g": 9.81},
        release={"omega0": PULSE.release.omega0 * sqrt(9.81 / 0.3)},
    )
    a, b = (flexible.simulate(scene) for scene in (PULSE, si))
    p, q = a.pulses[0], b.pulses[0]
    assert q.normal_impulse == pytest.approx(p.normal_impulse * si.impulse_unit, rel=1e-6)
    assert q.peak_normal_force == pytest.approx(p.peak_normal_force * si.force_unit, rel=1e-6)
    assert q.friction_loss == pytest.approx(p.friction_loss * si.energy_unit, rel=1e-5, abs=1e-9)
    assert b.phases[-1].t_end == pytest.approx(a.phases[-1].t_end * si.time_unit, rel=1e-6)
    assert b.ledger.initial == pytest.approx(a.ledger.initial * si.energy_unit)


@pytest.mark.parametrize("R", [0.938, 0.292, 1.585])
def test_both_sides_of_an_event_are_had_in_any_units(R):
    """Its instant is told in seconds, and a division back may end on the other side of it."""
    scene = rigid.Scene(
        rigid.Hoop(k=0.33, r=1.02, mass_ratio=0.05), rigid.Friction(0.3, 0.25), rigid.Release(phi0_deg=20.0)
    ).replace(ring={"bending_stiffness": 4777.0}, contact={"stiffness": 3.6e6, "damping": 0.0}, run={"turns": 1})
    scene = scene.replace(solve={"rtol": 1e-3})
    plain = flexible.simulate(scene)
    heavy = flexible.simulate(scene.replace(hoop={"R": R, "m": 0.155, "g": 1.62}))
    here, there = ([phase.t_start for phase in motion.phases[1:]] for motion in (plain, heavy))
    assert len(here) == len(there) >= 3
    forces = {}
    for side in ("left", "right"):
        told = heavy.at(there, side)
        assert list(told.t) == there
        forces[side] = plain.at(here, side).friction_force
        assert told.friction_force / (0.155 * 1.62) == pytest.approx(forces[side], rel=1e-9, abs=1e-9)
    assert np.abs(forces["left"] - forces["right"]).max() > 1e-3
    t = np.linspace(0, heavy.t_end, 1001)
    assert np.array_equal(heavy.at(t).t, t)


def test_instants_keep_their_side_on_another_clock():
    """Whatever the reckoning back says: what is known is met to the last bit, and nothing passes it."""
    known = np.array([0.0, 0.1, 0.1, 0.7, 1.3])
    seen = known * 0.3333
    t = np.sort(np.concatenate([seen, np.nextafter(seen, 9), np.nextafter(seen, -9)]))
    for about in (t / 0.3333, t / 0.3333 * (1 + 1e-15), t / 0.3333 * (1 - 1e-15)):
        for side in ("left", "right"):
            own = on_clock(t, known, seen, about, side)
            for a, b in zip(known, seen, strict=True):
                assert np.array_equal(np.sign(own - a), np.sign(t - b))
    two = np.array([0.0, 1.0, 1.0 + 4e-16])
    at = np.array([51.0])
    assert 50 + two[1] == 50 + two[2] == at
    assert [on_clock(at, two, 50 + two, at - 50, side)[0] for side in ("left", "right")] == [two[1], two[2]]


def test_hand_over_does_not_ring():
    """Handed over while it rolls, N stays with the rigid hoop's N; started undeformed, it swings by all of N."""
    scene = HOOP.replace(release={"phi0": 1.5, "omega0": 1.0}, solve={"resolve": "all"})
    motion = rigid.simulate(scene)
    hoop = ReducedHoop(scene)
    swing = []
    for chosen in (scene, scene.replace(solve={"start": "undeformed"})):
        start = hand_over(hoop, rigid.simulate(chosen), 0.0)
        _, records, _, _, _ = march(hoop, start, Ends(t=0.05), 1e-5)
        t = np.array([r.t for r in records])
        swing.append(np.abs(np.array([r.normal_force for r in records]) - motion.at(t).normal_force).max())
    assert swing[0] < 0.03
    assert swing[1] > 0.3


@pytest.mark.parametrize("mass", [0.0, 0.1])
def test_patch_law(mass):
    """While the patch sticks |F| <= mu_s N, while it slides |F| = mu N; both happen in this pulse."""
    scene = PULSE.replace(hoop={"mass_ratio": mass}, release={"phi0": 10 * pi / 180, "omega0": 0.0})
    history = flexible.simulate(scene, history=True).history
    normal, friction = history.normal_force, np.abs(history.friction_force)
    touching = normal > 0
    assert 0 <= history.stick_fraction.min() < history.stick_fraction.max() <= 1
    sticks = touching & (history.stick_fraction > 0)
    slides = touching & (history.stick_fraction == 0)
    assert sticks.any()
    assert (friction[sticks] <= 0.35 * normal[sticks] * (1 + 1e-6) + 1e-9).all()
    if mass == 0:
        assert slides.any()
    assert friction[slides] == pytest.approx(0.3 * normal[slides], rel=1e-9)


def test_brush_law_stays_within_its_bound():
    """Pointwise |tau| <= mu_s p: so is the sum."""
    history = flexible.simulate(PULSE.replace(contact={"law": "brush"}), history=True).history
    assert (np.abs(history.friction_force) <= 0.35 * history.normal_force * (1 + 1e-9) + 1e-12).all()


def test_sticking_is_kept_until_the_threshold():
    """F jumps from mu_s N to mu N when sliding starts: at the last sticking record |F| = mu_s N."""
    scene = PULSE.replace(hoop={"mass_ratio": 0.0}, release={"phi0": 10 * pi / 180, "omega0": 0.0})
    history = flexible.simulate(scene, history=True).history
    ratio = np.abs(history.friction_force) / np.maximum(history.normal_force, 1e-300)
    starts = [
        i for i in range(len(ratio) - 1)
        if history.stick_fraction[i] > 0 and history.stick_fraction[i + 1] == 0 and history.normal_force[i + 1] > 0
    ]  # fmt: skip
    assert starts
    assert ratio[starts[0]] == pytest.approx(0.35, rel=1e-6)


def test_flexible_throughout_or_in_the_pulses_only():
    """Both see the same first pulse; the way there differs by the patch, half-width (1.5/eps)^(1/3) = 0.003."""
    scene = HOOP.replace(
        release={"phi0": 1.5, "omega0": 1.0}, ring={"bending_stiffness": 1e5}, contact={"stiffness": 1e8}
    )
    a, b = (
        flexible.simulate(scene.replace(solve={"resolve": resolve}), history=True).pulses[0]
        for resolve in ("pulses", "all")
    )
    reach = (1.5 / 1e8) ** (1 / 3)
    assert b.normal_impulse == pytest.approx(a.normal_impulse, rel=3 * reach)
    assert b.friction_impulse == pytest.approx(a.friction_impulse, abs=3 * reach * a.normal_impulse)
    assert b.peak_normal_force == pytest.approx(a.peak_normal_force, rel=0.05)


def test_damping_is_not_a_rolling_resistance():
    """A damped patch rolls as far as an undamped one, to the tolerance of the march (1e-4 of the way of 0.1)."""
    scene = HOOP.replace(release={"phi0": 1.5, "omega0": 1.0}, solve={"resolve": "all"})
    ends = []
    for ratio in (0.0, 1.0):
        damped = scene.replace(contact={"damping": ratio})
        hoop = ReducedHoop(damped)
        start = hand_over(hoop, rigid.simulate(damped), 0.0)
        last, records, _, ended, _ = march(hoop, start, Ends(t=0.1), 1e-4)
        assert not ended
        assert last.res.normal > 0
        ends.append([last.pos[2], records[-1].damping_loss, energy(records[0])])
    assert ends[1][0] == pytest.approx(ends[0][0], abs=1e-5 + 1e-4 * 0.2)
    assert 0 <= ends[1][1] < 1e-5 * ends[1][2]


@pytest.mark.parametrize("t_end", [0.02, 0.1, 0.3])
def test_ends_at_the_instant_asked_for(t_end):
    """The last step is cut to it, not taken whole."""
    motion = flexible.simulate(HOOP.replace(run={"t_end": t_end}, solve={"resolve": "all"}), history=True)
    assert motion.history.t[-1] == pytest.approx(t_end, abs=1e-8)


def test_a_motion_ends_with_the_steps_it_may_take():
    """What was reached by then is whole: what its books leave unexplained is a tenth of the tolerance at most.
    Progress only tells: whatever it answers, the motion goes on."""
    told = []

    def tell(fraction):
        told.append(fraction)
        return True

    scene = rigid.load_scene("paper-3.1").replace(run={"until": "pulse"}, solve={"rtol": 1e-2})
    assert flexible.simulate(scene, progress=tell).completed
    motion = flexible.simulate(scene, most_steps=len(told) // 2)
    assert not motion.completed
    assert "steps" in motion.ended
    assert motion.steps == len(told) // 2
    books = motion.ledger
    assert abs(books.residual) < 1e-3 * books.initial
    assert abs(books.numerical_loss) < 1e-2 * books.initial  # rtol


@pytest.mark.parametrize("mass", [0.0, 0.1])
@pytest.mark.parametrize("phi0", [0.4, -0.5])
def test_a_rolling_hoop_is_handed_over_with_its_forces(mass, phi0):
    """The ring gives way to the friction, and still N, F and the accelerations are those of the rigid hoop."""
    scene = HOOP.replace(hoop={"mass_ratio": mass}, release={"phi0": phi0, "omega0": 1.0})
    motion = rigid.simulate(scene)
    assert motion.phases[0].kind == rigid.Kind.ROLL
    hoop = ReducedHoop(scene)
    start = hand_over(hoop, motion, 0.0)
    now = motion.at(0.0)
    assert start.res.normal == pytest.approx(float(now.normal_force), rel=1e-8)  # Newton stops at 1e-9
    assert start.res.friction == pytest.approx(float(now.friction_force), abs=1e-8)
    pose = pose_at(motion, 0.0)
    # the forces act a little beside the contact point of a rigid hoop, by parts of the half-width 1e-3 of the patch
    assert start.acc[2] == pytest.approx(pose.accelerations(hoop)[-1], rel=1e-2)


def test_a_skidding_hoop_is_handed_over_skidding():
    """Also where the floor is smooth and F has no sign."""
    for slip, mode in ((0.5, SLIDE_LEFT), (-0.5, SLIDE_RIGHT)):
        for mu in (0.0, 0.3):
            scene = HOOP.replace(friction={"mu": mu}, release={"phi0": 2.0, "omega0": 0.0, "slip0": slip})
            assert hand_over(ReducedHoop(scene), rigid.simulate(scene), 0.0).mode == mode


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("damping", [0.0, 0.5])
def test_losses_of_a_wide_patch(law, damping):
    """On a foundation so soft that the patch is a quarter of the radius, its points slip by different amounts.

    The integrals of the losses still leave little of the energy unexplained, and no loss is negative. The regularised
    law is smoothed over a slip velocity of 0.03, a fiftieth of phidot R or so: at the default 0.001 its friction turns
    within steps ten times as short, which proves no more.
    """
    scene = PULSE.replace(
        contact={"law": law, "stiffness": 700.0, "damping": damping, "slip_velocity_scale": 0.03},
        ring={"bending_stiffness": 1e5},
        solve={"rtol": 1e-4},
    )
    ledger = flexible.simulate(scene).ledger
    assert ledger.friction_loss > 0
    assert ledger.damping_loss >= -1e-9
    # rtol is 1e-4
    assert abs(ledger.numerical_loss) < 1e-4 * ledger.initial
    assert abs(ledger.residual) < 1e-4 * ledger.initial


@pytest.mark.parametrize("integrator", ["esdirk3", "esdirk4"])
def test_a_tight_tolerance_is_met_in_finite_time(integrator):
    """Steps of third order grow like rtol^(-1/3), 2.2 times a decade, of fourth 1.8 times; contact's kinks, at which
    the order is the first, like rtol^(-1/2), 3.2 times. Attempts that fail come on top.
    """
    scene = rigid.load_scene("paper-3.4-rough").replace(run={"until": "pulse"}, solve={"integrator": integrator})
    coarse, fine = (flexible.simulate(scene.replace(solve={"rtol": rtol})) for rtol in (1e-4, 1e-5))
    assert fine.completed
    assert coarse.steps < fine.steps < 4 * coarse.steps
    assert fine.pulses[0].normal_impulse == pytest.approx(coarse.pulses[0].normal_impulse, rel=1e-4)


@pytest.mark.parametrize("most", [0, -1, 1.5, "many"])
def test_steps_are_counted_in_whole_numbers(most):
    with pytest.raises(ValueError, match=r"most_steps = .* must be a whole number"):
        flexible.simulate("paper-3.3-massless", most_steps=most)


@pytest.mark.slow
def test_a_thick_hoop_gains_by_friction_what_the_rigid_one_does():
    """Rolling on a wall of r = 1.3 in steps longer than its patch: points that come in follow the dent as it is.

    F from step to step and at a step's end is what the rigid hoop has at the same angle and speed, to 1e-3 of N and on
    average to 1e-4 (flexible/README, 4), from the middle of the pulse, where no hand-over rings.
    """
    scene = rigid.Scene(
        rigid.Hoop(k=0.6, r=1.3, mass_ratio=2.0), rigid.Friction(0.2, 0.2), rigid.Release(phi0_deg=40),
        rigid.Run(until="pulse"), ring=rigid.Ring(bending_stiffness=500.0), contact=rigid.Contact(stiffness=1e7),
        solve=rigid.Solve(rtol=1e-4),
    )  # fmt: skip
    motion = flexible.simulate(scene, history=True)
    h, e, mass = motion.history, scene.hoop.e, 1 + scene.hoop.mass_ratio

    def rolled(phi, omega):
        """F of the rolling rigid hoop, from M times the acceleration of its mass centre."""
        s, c = np.sin(phi), np.cos(phi)
        lever = 1 + e * c
        alpha = e * s * (1 - e * c * omega**2 + omega**2 * lever) / (scene.hoop.K + (e * s) ** 2 + lever**2)
        return mass * (lever * alpha - e * s * omega**2)

    span = motion.pulses[0].t_end - motion.pulses[0].t_start
    inside = np.abs(h.t - motion.pulses[0].t_start - span / 2) < 0.4 * span
    t, phi, omega, normal = h.t[inside], h.phi[inside], h.omega[inside], h.normal_force[inside]
    assert np.median(np.diff(t) * omega[1:] / h.patch_length[inside][1:]) > 1
    rate = np.diff(h.friction_impulse[inside]) / np.diff(t)
    between = rolled((phi[1:] + phi[:-1]) / 2, (omega[1:] + omega[:-1]) / 2)
    assert np.abs((rate - between) / normal[1:]).max() < 1e-3
    misses = (h.friction_force[inside] - rolled(phi, omega)) / normal
    assert np.abs(misses).max() < 1e-3
    assert abs(misses.mean()) < 1e-4
