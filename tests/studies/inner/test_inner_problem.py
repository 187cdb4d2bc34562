"""The inner problem against closed forms, conservation laws, and the full equations at finite stiffness."""

from __future__ import annotations

from dataclasses import replace
from math import inf, pi, radians, sqrt

import numpy as np
import pytest

from flexible.contact.laws.brush import effective_mu_s
from rigid import Contact, Friction, Hoop, Release, Run, Scene, simulate
from rigid.kernel.compile import Patience
from studies.inner.creep import carried, creep, half_width, sticking_part, strongest_part
from studies.inner.events import REVERSAL, START, STOP, Event, passage
from studies.inner.layers import Layer, layer, outer_forces, period_of, slip_behind
from studies.inner.march.body import Body, accelerations, arms, body_of, contact_mobility, sliding_force
from studies.inner.march.bristles import bristles, brush_pull, set_stretch
from studies.inner.march.equations import (
    BRUSH,
    FRICTION_IMPULSE,
    HEIGHT,
    NORMAL_IMPULSE,
    OMEGA,
    PATCH,
    PSI,
    RATE,
    REGULARISED,
    SLIDE_LEFT,
    SLIDE_RIGHT,
    SLIP,
    STATE,
    STICK,
    ScaledContact,
    System,
)  # fmt: skip
from studies.inner.march.run import march
from studies.inner.scales import damping_of, epsilon, theta_of
from studies.inner.separate import separate_from
from studies.inner.stops.critical import critical_theta
from studies.limit.compliant import at_foundation


def scene_of(k: float, mass_ratio: float = 0.0, law: str = "patch", mu_s: float = 0.35, damping: float = 0.2) -> Scene:
    contact = Contact(law=law, damping=damping)
    return Scene(Hoop(k, 1.02, mass_ratio), Friction(mu_s, 0.3), Release(radians(10)), contact=contact)


@pytest.fixture(scope="module")
def end_of_spin():
    """k = 0.1, massless: the spin ends in a short roll."""
    way = passage(scene_of(0.1))
    return way.body, way.contact, way.events[0]


@pytest.mark.parametrize("law", ["patch", "regularised"])
def test_a_layer_is_the_same_to_the_last_bit_whether_compiled_or_not(law, monkeypatch):
    """The interpreter takes powers by another routine than compiled code; here there are none, but products."""
    way = passage(scene_of(0.25, 0.01, law))
    found = []
    for patience in (10**9, 0):
        monkeypatch.setattr("studies.inner.layers._patience", Patience(patience))
        found.append([layer(way.body, way.contact, event) for event in way.events])
    assert found[0]
    for one, other in zip(*found, strict=True):
        assert one.tau.tobytes() == other.tau.tobytes()
        assert one.normal_force.tobytes() == other.normal_force.tobytes()
        assert one.slip.tobytes() == other.slip.tobytes()


@pytest.mark.parametrize(("k", "mass_ratio"), [(0.1, 0.0), (0.1, 0.1), (0.25, 0.01)])
def test_events_have_the_rigid_motions_own_forces(k, mass_ratio):
    scene = scene_of(k, mass_ratio)
    way = passage(scene)
    motion = simulate(scene.replace(run=Run(until="pulse")))
    assert way.events
    for event in way.events:
        # an instant earlier and later; N and F change by their rates, 1e4 m g sqrt(g/R) at most
        for behind, t in ((False, event.t - 1e-10), (True, event.t + 1e-10)):
            now = motion.at(t)
            weight = 1 + mass_ratio
            expected = np.array([now.normal_force, now.friction_force]) / weight
            assert outer_forces(way.body, event, behind) == pytest.approx(expected, abs=1e-5)


def test_accelerations_are_those_of_a_rigid_body():
    """Newton and Euler for the mass centre, from the positions: y_G = y_C + e cos phi, x_G = x_C + e sin phi."""
    body = Body(0.8, 0.2, 0.05)
    psi, omega, normal, friction = 0.3, 4.0, 7.0, -1.5
    alpha, rise, slip = accelerations(*body, psi, omega, normal, friction)
    s, c = np.sin(psi + pi), np.cos(psi + pi)
    # of G: the contact point's, the rolling's, and what e turns by
    y_g = rise + body.e * (-s * alpha - c * omega**2)
    x_g = slip + alpha + body.e * (c * alpha - s * omega**2)
    assert y_g == pytest.approx(normal - 1, rel=1e-14)
    assert x_g == pytest.approx(friction, rel=1e-14)
    assert body.gyration * alpha == pytest.approx(normal * body.e * s - friction * (1 + body.e * c), rel=1e-13)


def sliding_patch(body, contact, event, raised):
    """A patch that slides, and is let go ``raised`` times its penetration too high."""
    normal = sliding_force(body, event.psi, event.omega, 0.3)
    state = np.zeros(STATE)
    state[PSI], state[OMEGA], state[SLIP] = event.psi, event.omega, -1e9
    state[HEIGHT] = -(half_width(normal) ** 2) / 2 * (1 - raised)
    return normal, state


def test_a_sliding_patch_vibrates_at_its_linearised_frequency(end_of_spin):
    """N' = -2 A H', so omega^2 = 2 A d(ddot h)/dN with F = mu N."""
    body, contact, event = end_of_spin
    normal, state = sliding_patch(body, contact, event, 1e-3)
    by_normal, across, _ = contact_mobility(body, event.psi)
    period = 2 * pi / sqrt(2 * half_width(normal) * (by_normal + 0.3 * across))
    undamped = contact._replace(theta=0.0)
    records = march(
        System(body, undamped, 0.0), state, SLIDE_RIGHT, bristles(), np.array([10.5 * period, inf, 0.05, 1.0, inf])
    )[0]
    tau, off = records[:, 0], records[:, 1] - normal
    i = np.flatnonzero((off[:-1] < 0) & (off[1:] >= 0))
    crossings = tau[i] - off[i] * (tau[i + 1] - tau[i]) / (off[i + 1] - off[i])
    # amplitude squared is 1e-6; a straight line misplaces a crossing by the step squared, 1e-4 of a period at most
    assert np.diff(crossings).mean() == pytest.approx(period, rel=1e-4)


@pytest.mark.parametrize("pull", [None, 0.3, -0.3])
def test_the_period_of_a_patch_is_that_of_its_height(end_of_spin, pull):
    """omega^2 = 2 A d(ddot h)/dN, by the difference that one more N makes of Newton's and Euler's equations."""
    body, _, event = end_of_spin
    behind = Event(STOP if pull is None else START, event.t, event.psi, event.omega, 0.3, pull)
    normal, friction = outer_forces(body, behind, True)
    more = 1.0, 0.0 if pull is None else pull
    rise = [
        accelerations(*body, event.psi, event.omega, normal + n * more[0], friction + n * more[1])[1] for n in (0, 1)
    ]
    square = 2 * half_width(normal) * (rise[1] - rise[0])
    assert period_of(body, behind) == pytest.approx(2 * pi / sqrt(square), rel=1e-9)


def test_a_damped_patch_loses_its_vibration_as_its_oscillator_does(end_of_spin):
    """H'' = -omega^2 (H + theta H') of small vibrations: from peak to peak N falls by exp(-theta omega^2 T/2)."""
    body, contact, event = end_of_spin
    normal, state = sliding_patch(body, contact, event, 1e-3)
    period = period_of(body, Event(START, event.t, event.psi, event.omega, None, 0.3))
    theta = 0.1 * period / (2 * pi)  # a twentieth of critical
    ends = np.array([6 * period, inf, 0.05, 1.0, inf])
    damped = contact._replace(theta=theta)
    records = march(System(body, damped, 0.0), state, SLIDE_RIGHT, bristles(), ends)[0]
    off = records[:, 1] - normal
    peaks = off[1:-1][(off[1:-1] > off[:-2]) & (off[1:-1] > off[2:]) & (off[1:-1] > 0)]
    damped_period = period / sqrt(1 - 0.05**2)
    # amplitude squared is 1e-6; a peak between steps of 1/80 of a period is too low by 1e-3 at most
    fall = theta * (2 * pi / period) ** 2 / 2 * damped_period
    assert np.log(peaks[:-1] / peaks[1:]) == pytest.approx(fall, abs=5e-3)


@pytest.mark.parametrize(("slip", "way"), [(30.0, SLIDE_LEFT), (-30.0, SLIDE_RIGHT)])
def test_what_comes_down_is_pushed_against_its_slip(end_of_spin, slip, way):
    """From above the floor: J_F = -+ mu J_N as long as it slips, and friction takes energy."""
    body, contact, event = end_of_spin
    state = np.zeros(STATE)
    state[PSI], state[OMEGA], state[HEIGHT], state[RATE], state[SLIP] = event.psi, 0.0, 0.1, -1.0, slip
    ends = np.array([1.0, inf, 0.05, 1.0, inf])
    records, switches, end, _ = march(System(body, contact, 0.0), state, STICK, bristles(), ends)
    assert [mode for _, mode in switches] == [way]
    assert end[NORMAL_IMPULSE] > 0.1
    assert end[SLIP] * slip > 0, "it slips all the time"
    assert end[FRICTION_IMPULSE] == pytest.approx(way * contact.mu * end[NORMAL_IMPULSE], rel=1e-9)
    assert (records[:, 2] * slip <= 0).all()


def test_a_frictionless_bounce_keeps_its_energy(end_of_spin):
    """H'^2/2 + (1 + a^2/K) (2/15) (-2 H)^(5/2) - (the rest of ddot h) H, lift-off included: from thrice as deep."""
    body, contact, event = end_of_spin
    smooth = contact._replace(mu=0.0, mu_s=0.0, theta=0.0)
    _, state = sliding_patch(body, contact, event, -2.0)
    a, _, ec = arms(body.e, body.one_minus_e, event.psi)
    free = -1 + ec * event.omega**2

    def energy(height, rate):
        return rate**2 / 2 + (1 + a * a / body.gyration) * 2 / 15 * np.maximum(-2 * height, 0) ** 2.5 - free * height

    errors = []
    for fineness in (0.2, 0.1):
        ends = np.array([8.0, inf, fineness, 1.0, inf])
        records, _, end, _ = march(System(body, smooth, 0.0), state, SLIDE_RIGHT, bristles(), ends)
        assert records[:, 1].min() == 0.0
        errors.append(abs(energy(end[HEIGHT], end[RATE]) / energy(state[HEIGHT], 0.0) - 1))
    # order four but for the touch, where N has no third derivative: at least second order
    assert errors[1] < max(errors[0] / 3, 1e-9)
    assert errors[1] < 1e-5


@pytest.mark.parametrize("law", [PATCH, BRUSH, REGULARISED])
def test_a_layer_ends_in_steady_creep_and_its_impulses_are_those_of_the_change_of_slip(end_of_spin, law):
    """Whatever happens in between: dot h vanishes on both sides, and v changes by eps V."""
    body, contact, event = end_of_spin
    friction = 0.3 if law != PATCH else contact.mu_s
    contact = contact._replace(law=law, mu_s=friction, slip_scale=1.0)
    duration = 14.0
    history = layer(body, contact, event, duration, fineness=0.05)
    normal, pull = outer_forces(body, event, True)
    steady = creep(contact, normal, pull, event.omega)
    # a brush is summed over 300 points to the patch
    assert history.end[SLIP] == pytest.approx(steady.slip, rel=2e-3 if law == BRUSH else 1e-4)
    # it begins where all of mu N is there, -tau[0] before the event, with the slip that makes of it
    outer = np.array([normal, pull]) * duration - np.array(outer_forces(body, event, False)) * history.tau[0]
    excess = history.end[[NORMAL_IMPULSE, FRICTION_IMPULSE]] - outer
    # the rates of height and slip that are left when the run is cut are what the impulses may lack
    rest = abs(history.end[RATE]) + 1e-3
    by_normal, across, by_friction = contact_mobility(body, event.psi)
    impulses = np.linalg.solve([[by_normal, across], [across, by_friction]], [0.0, history.end[SLIP]])
    assert excess == pytest.approx(impulses, abs=3 * rest)
    assert history.friction_force[-1] == pytest.approx(pull, rel=1e-3)


def test_steady_creep_of_a_brush_is_the_rolling_law():
    """F/(mu N) = 1 - (1 - xi)^3, xi = kappa gamma/(mu A): eps_t gamma a/(2 mu p_0) with p_0 = eps_n a^2/2."""
    contact = ScaledContact(BRUSH, 0.8, 0.3, 0.3, 0.0, 0.0)
    normal, omega = 12.0, 5.0
    for xi in (0.1, 0.5, 0.9):
        slip = xi * 0.3 * half_width(normal) / 0.8 * omega
        friction = 0.3 * normal * (1 - (1 - xi) ** 3)
        assert creep(contact, normal, friction, omega).slip == pytest.approx(-slip, rel=1e-12)
        assert creep(contact, normal, -friction, -omega).slip == pytest.approx(slip, rel=1e-12)
    assert sticking_part(0.35, 0.3, 0.29) == pytest.approx(
        max(np.roots([-3 * 0.35 + 2 * 0.3, 3 * 0.35 - 3 * 0.3, 0, 0.3 - 0.29]).real), rel=1e-9
    )


@pytest.mark.parametrize("mu", [0.0, 0.1, 0.3, 0.3499, 0.35])
def test_the_strongest_part_of_a_brush_carries_what_its_law_says(mu):
    assert carried(strongest_part(0.35, mu), 0.35, mu) == pytest.approx(effective_mu_s(0.35, mu), rel=1e-14)


@pytest.mark.parametrize("b", [0.5, 0.8])
def test_a_brush_that_rolls_steadily_carries_what_its_law_says(b):
    """Its leading part b sticks up to mu_s p and slides with mu p behind that: 300 bristles, and the closed form."""
    contact = ScaledContact(BRUSH, 0.8, 0.5, 0.3, 0.0, 0.0)
    half = 1.3
    slip = contact.mu_s * half * (1 - b) / contact.kappa  # over Omega
    kept = bristles(2 * half / 300)
    set_stretch(kept, half, np.zeros(3), True)
    step = 1.7 * kept.spacing
    pulls = []
    for i in range(1, 220):  # a passage takes 180 of them
        pulls.append(brush_pull(kept, contact, half, i * step, i * step * slip, 1.0, True)[0])
    exact = 3 * contact.mu_s * (b**2 - b**3) + contact.mu * (1 - 3 * b**2 + 2 * b**3)
    # a point more or less that sticks is 1/300 of what jumps there
    assert -np.mean(pulls[-20:]) / (2 / 3 * half**3) == pytest.approx(exact, abs=3e-3)
    normal = 2 / 3 * half**3
    assert creep(contact, normal, -exact * normal, 1.0).slip == pytest.approx(slip, rel=1e-9)


def test_the_inner_problem_has_no_stiffness_in_it(end_of_spin):
    """The full equations at eps and eps/10 are the inner problem but for terms of order eps."""
    body, contact, event = end_of_spin
    reference = layer(body, contact, event, 3.0)
    tau = np.linspace(0.0, 3.0, 50)

    def sampled(history, name):
        return np.interp(tau, history.tau, getattr(history, name))

    away = []
    for eps in (1e-4, 1e-5):
        history = layer(body, contact, event, 3.0, eps=eps)
        names = ("normal_force", "friction_force", "slip")
        away.append(max(np.abs(sampled(history, name) - sampled(reference, name)).max() for name in names))
    assert away[1] == pytest.approx(away[0] / 10, rel=0.1)


def test_the_mirrored_event_has_the_mirrored_layer(end_of_spin):
    body, contact, event = end_of_spin
    mirrored = Event(event.kind, event.t, -event.psi, -event.omega, -event.before, None)
    for law, mu_s in ((PATCH, 0.35), (BRUSH, 0.3)):
        here = layer(body, contact._replace(law=law, mu_s=mu_s), event, 3.0)
        there = layer(body, contact._replace(law=law, mu_s=mu_s), mirrored, 3.0)
        assert here.end[SLIP] == pytest.approx(-there.end[SLIP], rel=1e-7)
        # points enter at the table's other end, where its entries lie a little differently
        assert here.normal_force == pytest.approx(there.normal_force, rel=1e-7)


def test_below_the_critical_damping_the_patch_breaks_again(end_of_spin):
    body, contact, event = end_of_spin
    scene = scene_of(0.1)
    theta = critical_theta(body, contact, event)
    # the ratio at which the flexible solver's sequence changes, 0.05 to 0.2 at foundations of 1e11 and 1e13
    assert 0.05 < damping_of(scene, theta) < 0.2
    above, below = (layer(body, contact._replace(theta=theta * factor), event) for factor in (1.01, 0.99))
    assert above.faithful
    assert above.peak_ratio < 0.35
    assert above.resticks == 0.0
    assert not below.faithful
    assert below.peak_ratio == pytest.approx(0.35, rel=1e-6)  # it breaks there
    assert below.resticks > 0


def test_a_reversal_hands_over_the_slip_that_its_layer_leaves():
    """v of the outer sliding behind it, extrapolated to the event, does not depend on where the layer is left."""
    way = passage(scene_of(0.1, 0.1))
    event = way.events[0]
    assert event.kind == REVERSAL
    history = layer(way.body, way.contact, event, 40.0)
    normal, friction = outer_forces(way.body, event, True)
    rate = accelerations(*way.body, event.psi, event.omega, normal, friction)[2]
    late = history.tau > 30
    extrapolated = history.slip[late] - rate * history.tau[late]
    assert np.ptp(extrapolated) < 1e-6 * abs(rate * 40)
    assert slip_behind(way.body, way.contact, event) == pytest.approx(extrapolated[-1], abs=1e-6 * abs(rate * 40))


def test_what_a_weakly_damped_reversal_hands_over_does_not_wait_for_its_ringing():
    """What is left of N's vibration has an impulse to come, that of H': with it ten periods say what a hundred do."""
    way = passage(scene_of(0.1, 0.1, damping=0.02))
    event = way.events[0]
    assert event.kind == REVERSAL
    early, late = layer(way.body, way.contact, event), layer(way.body, way.contact, event, 150.0)
    normal, friction = outer_forces(way.body, event, True)
    rate = accelerations(*way.body, event.psi, event.omega, normal, friction)[2]
    settled = late.end[SLIP] - rate * 150.0
    without = early.end[SLIP] - rate * early.tau[-1]
    off = slip_behind(way.body, way.contact, event) - settled
    assert abs(off) < 0.01 * abs(without - settled)


def test_a_slip_that_starts_needs_no_damper():
    """The patch slides before its layer and behind it, and N rings about a force that stays positive."""
    way = passage(scene_of(0.1))
    event = way.events[-1]
    assert event.kind == START
    assert layer(way.body, way.contact._replace(theta=0.0), event).faithful
    assert critical_theta(way.body, way.contact, event) == 0.0


def test_a_brush_breaks_away_from_what_it_carries_at_the_most():
    """mu_s > mu: its layer begins at the F of the rigid hoop before."""
    way = passage(scene_of(0.1, law="brush"))
    event = way.events[-1]
    assert event.kind == START
    found = layer(way.body, way.contact, event, 0.5)
    normal, friction = outer_forces(way.body, event, False)
    # of the part that sticks a twentieth is let go: by the law above it carries less by a few times that squared
    assert found.friction_force[0] / found.normal_force[0] == pytest.approx(friction / normal, rel=0.02)


@pytest.mark.parametrize(("slip", "way"), [(30.0, SLIDE_LEFT), (-30.0, SLIDE_RIGHT)])
def test_a_brush_that_slides_throughout_is_pushed_against_its_slip(end_of_spin, slip, way):
    """So fast that no bristle holds: F = -+ mu N, to round-off of the sum over the bristles."""
    body, contact, event = end_of_spin
    normal, state = sliding_patch(body, contact, event, 0.0)
    state[OMEGA], state[SLIP], half = 0.0, slip, half_width(normal)
    kept = bristles(2 * half / 100)
    set_stretch(kept, half, np.zeros(3), True)
    brush = contact._replace(law=BRUSH)
    records = march(System(body, brush, 0.0), state, STICK, kept, np.array([0.5, inf, 0.1, 1.0, inf]))[0]
    late = records[len(records) // 2 :]
    assert (late[:, 3] * slip > 0).all(), "it slips all the time"
    assert late[:, 2] == pytest.approx(way * contact.mu * late[:, 1], rel=1e-9)
    assert (late[:, 5] == way).all(), "and is said to"


def test_when_a_layer_is_over_is_read_off_its_history():
    """N = n (1 + exp(-tau) cos(9 tau)) is within 2 % behind the last swing beyond; a patch that breaks twice."""
    tau = np.linspace(0, 10, 10001)
    swing = np.exp(-tau) * np.cos(9 * tau)
    mode = np.where((tau >= 1) & (tau < 2) | (tau >= 3) & (tau < 4), SLIDE_RIGHT, STICK)
    event = Event(STOP, 0.0, 0.1, 1.0, 0.3, None)
    height = -((1.5 * 5) ** (2 / 3)) / 2 + 0 * tau  # whose springs carry it
    found = Layer(event, PATCH, 0.0, tau, 5 * (1 + swing), 0 * tau, 0 * tau, height, mode, (), np.zeros(STATE), 1.0)
    last = tau[np.flatnonzero(np.abs(swing) > 0.02)[-1]]
    assert np.log(50) - 2 * pi / 9 < last < np.log(50), "the envelope, and a swing"
    assert found.settled(5.0) == pytest.approx(last, abs=2e-3)
    assert found.settled(6.0) is None
    assert found.resticks == pytest.approx(4.0, abs=2e-3)


def test_events_are_the_same_in_si_units_and_a_turn_further():
    """All of a passage is dimensionless; a disk that has gone round once more is where it was."""
    scene = scene_of(0.1, 0.1)
    here = passage(scene)
    si = passage(scene.replace(hoop={"R": 0.5, "m": 0.3, "g": 9.81}))
    further = passage(scene.replace(release={"phi0": scene.release.phi0 + 2 * pi}))
    for there in (si, further):
        for one, other in zip(here.events, there.events, strict=True):
            assert (other.t, other.psi, other.omega) == pytest.approx((one.t, one.psi, one.omega), rel=1e-9, abs=1e-12)
        assert there.edges == pytest.approx(here.edges, abs=1e-12)


@pytest.mark.parametrize("mass_ratio", [0.0, 0.1])
def test_layers_are_separate_where_the_longest_takes_the_time_to_the_next_event(mass_ratio):
    """N = n (1 + exp(-tau)) behind each event is within 2 % after tau = ln 50, and a layer takes eps tau."""
    scene = scene_of(0.1, mass_ratio)
    way = passage(scene)
    tau = np.linspace(0, 6, 60001)
    layers = []
    for event in way.events:
        normal = outer_forces(way.body, event, True)[0] * (1 + np.exp(-tau))
        rest, height = 0 * tau, -((1.5 * normal) ** (2 / 3)) / 2
        layers.append(Layer(event, PATCH, 0.0, tau, normal, rest, rest, height, rest, (), np.zeros(STATE), 1.0))
    events = [event.t for event in way.events]
    if len(events) < 2:
        assert separate_from(way, layers) == 0.0
        events.append(events[0] + 0.01)
        later = Event(START, events[1], 0.1, way.events[0].omega, None, 0.3)
        way = replace(way, events=(*way.events, later))
        layers.append(layers[0])
    least = separate_from(way, layers)
    assert epsilon(at_foundation(scene, least)) * np.log(50) == pytest.approx(np.diff(events).min(), rel=1e-3)


def test_a_slip_that_starts_rings_without_a_net_impulse():
    way = passage(scene_of(0.1))
    event = way.events[-1]
    assert event.kind == START
    history = layer(way.body, way.contact, event, 20.0)
    normal = outer_forces(way.body, event, True)[0]
    assert history.end[NORMAL_IMPULSE] == pytest.approx(20.0 * normal, rel=1e-5)
    assert event.kind != STOP


def test_scales_of_a_scene():
    """h = 3 N/(2 eps_n) etc. in the unit of the whole mass; the damper's time is eps theta."""
    from flexible.models.rim_contact import relaxation_time

    scene = scene_of(0.1, 0.5, damping=0.3).replace(contact={"stiffness": 3e7})
    assert epsilon(scene) ** -3 == pytest.approx(3e7 / 1.5, rel=1e-12)
    assert theta_of(scene) * epsilon(scene) == pytest.approx(relaxation_time(scene), rel=1e-12)
    assert damping_of(scene, theta_of(scene)) == pytest.approx(0.3, rel=1e-12)
    assert body_of(scene.hoop).e == scene.hoop.e


@pytest.mark.slow
def test_the_flexible_solver_has_the_same_history(end_of_spin):
    """Every stiffness on one clock: tau = (t - t*)/eps from the instant at which the flexible patch sticks.

    An elastic ring's N, F and V are the inner problem's but for a term of order eps, ten times less at a foundation of
    1e13 than at 1e10, and that term is what the disk's going on makes of it.
    """
    from flexible import simulate as flexible

    body, contact, event = end_of_spin
    away = []
    for foundation in (1e10, 1e13):
        scene = scene_of(0.1).replace(
            contact={"stiffness": foundation},
            ring={"bending_stiffness": 1e12},
            run=Run(until="pulse"),
            solve={"rtol": 1e-6},
        )
        eps = epsilon(scene)
        kept = flexible(scene, history=True).history
        first = int(np.argmax((kept.phi > event.phi - 0.02) & (kept.slip_velocity >= -1e-12)))
        tau = (kept.t - kept.t[first]) / eps
        inside = (tau > 0.0) & (tau < 3.0)
        assert inside.sum() > 50
        seen = np.array([kept.normal_force[inside], kept.friction_force[inside], kept.slip_velocity[inside] / eps])

        def expected(eps: float, tau=tau[inside]) -> np.ndarray:
            found = layer(body, contact, event, 3.0, eps=eps)
            columns = (found.normal_force, found.friction_force, found.slip)
            return np.array([np.interp(tau, found.tau, column) for column in columns])

        size = np.array([30.0, 40.0, 10.0])  # of the jumps of N and F, and of V
        away.append((np.abs(seen - expected(0.0)).max(axis=1) / size).max())
        # what is left: the layer begins with H' = 0, where the spin has eps dH/dt = eps 1e4/(2 A) of it
        assert (np.abs(seen - expected(eps)).max(axis=1) < (0.01 + 150 * eps) * size).all()
    assert away[1] < 0.05
    assert away[0] == pytest.approx(10 * away[1], rel=0.2)


def test_the_laws_of_the_scaled_problem_are_those_of_the_flexible_solver():
    from flexible.contact.laws.listing import LAWS

    codes = {"patch": PATCH, "brush": BRUSH, "regularised": REGULARISED}
    assert {name: law.code for name, law in LAWS.items()} == codes
    for name, code in codes.items():
        assert passage(scene_of(0.1, law=name)).contact.law == code


def test_bristles_and_damper_together_carry_the_friction():
    """A patch 2a long that creeps with v: its damper drags with theta kappa 2a v, its bristles, stretched in proportion
    to the way from the leading edge, pull with kappa v (2a)^2/(2 |omega|).
    """
    contact = passage(scene_of(0.25, damping=1.0)).contact
    normal, friction, omega = 3.0, 0.4, -1.3
    found, length = creep(contact, normal, friction, omega), 2 * half_width(normal)
    assert found.drag == pytest.approx(-contact.theta * contact.kappa * length * found.slip, rel=1e-13)
    pulled = -contact.kappa * found.slip * length**2 / (2 * abs(omega))
    assert found.drag + pulled == pytest.approx(friction, rel=1e-13)


def test_a_slip_that_ends_near_a_jam_wants_a_strong_damper():
    """N falls from thousands to 14; what is as strong as the strongest that is tried keeps the stick as well."""
    scene = scene_of(0.0695, 0.0).replace(
        hoop={"r": 1.2452}, friction={"mu_s": 0.7542, "mu": 0.5936}, release={"phi0_deg": 12.157}
    )
    way = passage(scene)
    event = way.events[0]
    before, behind = (outer_forces(way.body, event, side)[0] for side in (False, True))
    assert before > 100 * behind
    theta = critical_theta(way.body, way.contact, event)
    for over, kept in ((0.99, False), (1.01, True), (1e3, True), (1e7, True)):
        assert layer(way.body, way.contact._replace(theta=over * theta), event).faithful is kept
