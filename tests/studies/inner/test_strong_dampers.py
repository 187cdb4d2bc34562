"""Layers of dampers that are far faster than all else in them: by scipy's stiff solver, and by what they tend to."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rigid import Scene, load_scene
from studies.inner.creep import half_width
from studies.inner.events import REVERSAL, STOP, Event, passage
from studies.inner.layers import Layer, layer, outer_forces, slip_behind
from studies.inner.march.body import accelerations
from studies.inner.march.equations import HEIGHT, PATCH, RATE, SLIP, STATE, STICK
from studies.inner.march.run import march
from studies.inner.separate import separate_from
from studies.limit.compliant import at_foundation, go_through
from studies.limit.prediction import predict

TURNS = load_scene("paper-3.3-massless").replace(
    hoop={"k": 0.1125, "r": 1.0853, "mass_ratio": 0.01},
    friction={"mu_s": 0.3435, "mu": 0.2837},
    release={"phi0_deg": 10.83, "omega0": 0.633},
)
"""Its slip reverses in the pulse, stops, and starts again."""
BRUSH = TURNS.replace(
    hoop={"k": 0.1154, "r": 1.138}, friction={"mu_s": 0.211, "mu": 0.211}, release={"phi0_deg": 13.49, "omega0": 0.51},
    contact={"law": "brush"},
)  # fmt: skip
SMOOTHED = TURNS.replace(
    hoop={"k": 0.14, "r": 1.155, "mass_ratio": 0.0},
    friction={"mu_s": 0.2258, "mu": 0.19},
    release={"phi0_deg": 28.15, "omega0": 0.665},
    contact={"law": "regularised"},
)


def damped(scene: Scene, damping: float) -> Scene:
    return scene.replace(contact={"damping": damping})


def reversal(scene: Scene):
    way = passage(scene)
    (event,) = [event for event in way.events if event.kind == REVERSAL]
    return way.body, way.contact, event


def by_radau(body, contact, event, duration):
    """(tau of the break, N and state over tau behind it) of a patch that is held, breaks and slides on, by scipy.

    It is held by bristles with mu p each, which have slipped by X since. Those that came in since have slipped by half
    of that on average, and are next to none as long as the stick is short.
    """
    normal, friction = outer_forces(body, event, False)
    first, omega = half_width(normal), abs(event.omega)
    held = np.sign(friction) * contact.mu / contact.kappa

    def forces(tau, y, mode):
        height, rate, slip, way = y
        half = np.sqrt(-2 * height)
        push = max(2 / 3 * half**3 - 2 * contact.theta * half * rate, 0.0)
        if mode:
            return push, mode * contact.mu * push
        ends = max(-half - omega * tau, -first), min(half - omega * tau, first)
        old = np.polyval([held / 6, 0.0, way - held * first**2 / 2, 0.0], ends)
        new = way / 2 * max(half + omega * tau - first, 0.0)
        return push, -contact.kappa * (old[1] - old[0] + new + contact.theta * 2 * half * slip)

    def rates(tau, y, mode):
        _, rise, slipping = accelerations(*body, event.psi, event.omega, *forces(tau, y, mode))
        return [y[1], rise, slipping, y[2]]

    def breaks(tau, y, mode):
        push, pull = forces(tau, y, mode)
        return abs(pull) - contact.mu_s * push

    breaks.terminal, breaks.direction = True, 1
    settings = {"method": "Radau", "rtol": 1e-9, "atol": 1e-16}
    stick = solve_ivp(rates, (0, duration), [-(first**2) / 2, 0, 0, 0], events=breaks, args=(0,), **settings)
    since, y = stick.t[-1], stick.y[:, -1]
    mode = np.sign(forces(since, y, 0)[1])
    slide = solve_ivp(rates, (since, duration), y, args=(mode,), dense_output=True, **settings)
    return since, lambda tau: (forces(tau, slide.sol(tau), mode)[0], slide.sol(tau))


@pytest.mark.parametrize("damping", [50.0, 1e3, 1e5, 1e7])
def test_a_patch_that_turns_round_does_so_as_by_a_stiff_solver(damping):
    """Times of switches to 1e-5 and forces to 1e-4 is what steps are chosen for."""
    body, contact, event = reversal(damped(TURNS, damping))
    found = layer(body, contact, event)
    since, behind = by_radau(body, contact, event, found.tau[-1])
    ((broke, _),) = found.switches
    assert broke == pytest.approx(since, rel=1e-5)
    for tau in (2 * since, 10 * since, 0.3, found.tau[-1]):
        at = np.searchsorted(found.tau, tau)
        assert found.normal_force[at] == pytest.approx(behind(found.tau[at])[0], rel=1e-4)
    height, rate, slip, _ = behind(found.tau[-1])[1]
    assert found.end[HEIGHT] == pytest.approx(height, rel=1e-4)
    assert found.end[RATE] == pytest.approx(rate, rel=1e-4)
    assert found.end[SLIP] == pytest.approx(slip, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "finer", "share"),
    [(TURNS, 0.01, 1e-4), (BRUSH, 0.1, 1 / 300), (SMOOTHED, 0.01, 1e-4)],
    ids=["patch", "brush", "regularised"],
)
def test_it_is_the_same_whether_steps_are_explicit_or_not(scene, finer, share, monkeypatch):
    """Strong, and not yet too strong for explicit steps; forces agree to 1e-4 of their jump, or a point of a brush."""
    where, found = reversal(damped(scene, 20.0)), []
    monkeypatch.setattr("studies.inner.layers._compiled", march.py_func)  # which sees another constant
    for stiff, fineness in ((10.0, 0.1), (1e9, finer)):
        monkeypatch.setattr("studies.inner.march.steps.STIFF", stiff)
        found.append(layer(*where, 0.05, fineness=fineness))
    implicit, explicit = found
    assert len(implicit.tau) < len(explicit.tau) / 2
    for name in ("normal_force", "friction_force"):
        dense = np.interp(implicit.tau, explicit.tau, getattr(explicit, name))
        away = getattr(implicit, name) - dense
        # right at a switch F is what it was or what it becomes
        away = away[[all(abs(tau - at) > 1e-4 for at, _ in explicit.switches) for tau in implicit.tau]]
        assert np.abs(away).max() < share * np.ptp(dense)


def test_a_smoothed_reversal_is_that_of_a_stiff_solver():
    """F is a function of N and V, so there are three unknowns; V less what steady sliding makes of it, and the damper
    has H' left, whose impulse is known."""
    body, contact, event = reversal(damped(SMOOTHED, 1e5))
    found = layer(body, contact, event)

    def rates(tau, y):
        half = np.sqrt(-2 * y[0])
        push = max(2 / 3 * half**3 - 2 * contact.theta * half * y[1], 0.0)
        pull = -contact.mu * push * y[2] / np.hypot(y[2], contact.slip_scale)
        return [y[1], *accelerations(*body, event.psi, event.omega, push, pull)[1:]]

    start = [found.height[0], 0.0, found.slip[0]]
    seen = solve_ivp(rates, (found.tau[0], found.tau[-1]), start, method="Radau", rtol=1e-9, atol=1e-14).y[:, -1]
    assert found.end[[HEIGHT, RATE]] == pytest.approx(seen[:2], rel=1e-4)
    assert abs(found.end[SLIP] - seen[2]) < 1e-4 * abs(slip_behind(body, contact, event))


@pytest.mark.parametrize(
    ("scene", "power"), [(TURNS, 1), (BRUSH, 0), (SMOOTHED, 0)], ids=["patch", "brush", "regularised"]
)
def test_what_an_ever_stronger_damper_makes_of_a_reversal(scene, power):
    """A patch is held by it until it slides the other way, and has slipped by 1/theta; bristles that are held by
    nothing else, or smoothed friction, turn round under the N of a hoop that the floor lets neither rise nor fall."""
    turned = [slip_behind(*reversal(damped(scene, damping))) * damping**power for damping in (1e4, 1e6)]
    assert turned[0] == pytest.approx(turned[1], rel=1e-3)


def test_a_strong_damper_has_a_prediction_like_its_inverse():
    """All at order eps is a creep against the damper or the end of a layer in it; A/(theta Omega) is left out, 1e-3."""
    terms = {damping: predict(damped(TURNS, damping)).terms for damping in (1e4, 1e9)}
    for name in ("impulse_ratio", "normal_impulse", "friction_impulse"):
        some, more = (found[name].coefficient * damping for damping, found in terms.items())
        assert some == pytest.approx(more, rel=2e-3)
        assert terms[1e4][name].limit == terms[1e9][name].limit


def test_a_damper_that_nothing_moves_makes_the_rigid_hoop_at_any_foundation():
    """It gives way by 1e-9 of what it did; its pulse is that of the rigid hoop, as it slips where that does."""
    stuck = damped(TURNS, 1e9)
    limit = predict(stuck).terms["impulse_ratio"].limit
    assert go_through(at_foundation(stuck, 1e11)).impulse_ratio == pytest.approx(limit, rel=1e-7)


@pytest.mark.slow
def test_a_rigid_ring_with_a_strong_damper_comes_as_predicted():
    """What is behind c eps is of order (eps theta)^2: a tenth of it where eps is."""
    strong = damped(TURNS, 30.0)
    term, missed = predict(strong).terms["impulse_ratio"], []
    for foundation in (1e13, 1e15):
        seen = (go_through(at_foundation(strong, foundation)).impulse_ratio - term.limit) * foundation ** (1 / 3)
        missed.append(seen / term.coefficient - 1)
    assert abs(missed[1]) < min(abs(missed[0]) / 3, 0.05)


def test_springs_behind_a_strong_damper_take_its_time():
    """N = n at once, and N_el/n = 1 + exp(-tau/theta)/2: within a fifth after theta log(5/2), beyond the end or not."""
    event = Event(STOP, 0.0, 0.1, 1.0, 0.3, None)
    for end in (0.3, 5.0):
        tau = np.linspace(0, 40 * end, 20001)
        height = -((1.5 * 7 * (1 + np.exp(-tau / 40) / 2)) ** (2 / 3)) / 2
        rest = 0 * tau
        mode = np.full(tau.size, STICK)
        found = Layer(event, PATCH, 40.0, tau, 7 + rest, rest, rest, height, mode, (), np.zeros(STATE), 1.0)
        assert found.settled(7.0) == pytest.approx(40 * np.log(2.5), abs=0.02)


def test_layers_of_a_damper_ten_times_as_strong_are_separate_a_thousand_times_later():
    """They take theta, and eps theta of the rigid motion."""
    some, more = (separate_from(passage(damped(TURNS, damping))) for damping in (100.0, 1000.0))
    assert more == pytest.approx(1000 * some, rel=0.01)
