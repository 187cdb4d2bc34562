"""A pulse in which the run begins or ends is listed as far as it was run, and told from a whole one."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import isnan, pi

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from rigid import Friction, Hoop, Release, Run, Scene, load_scene, simulate, simulate_batch
from studies.running.case import Case, run_case

SCENE = load_scene("paper-3.1")


@pytest.fixture(scope="module")
def whole():
    return simulate(SCENE).pulses[0]


def quadrature(motion, pulse):
    """Integrals of N and F by Gauss over the phases within a pulse."""
    nodes, weights = np.polynomial.legendre.leggauss(30)
    edges = {pulse.t_start, pulse.t_end} | set(np.linspace(pulse.t_start, pulse.t_end, 20))
    edges |= {p.t_start for p in motion.phases if pulse.t_start < p.t_start < pulse.t_end}
    sums = np.zeros(2)
    for a, b in zip(sorted(edges), sorted(edges)[1:], strict=False):
        states = motion.at(0.5 * (a + b) + 0.5 * (b - a) * nodes)
        sums += 0.5 * (b - a) * np.array([weights @ states.normal_force, weights @ states.friction_force])
    return sums


@pytest.mark.parametrize("t_end", [5.70, 5.75])
def test_cut_by_the_end(whole, t_end):
    """Before the bottom (passed at 5.74) and behind it: listed up to the end, with its own impulses."""
    assert whole.t_start < t_end < whole.t_end
    motion = simulate(SCENE.replace(run={"t_end": t_end}))
    (pulse,) = motion.pulses
    assert pulse.cut
    assert (pulse.t_start, pulse.t_end) == (whole.t_start, t_end)
    # two ways to the same integral; Gauss with 30 nodes on smooth panels leaves round-off
    assert quadrature(motion, pulse) == pytest.approx([pulse.normal_impulse, pulse.friction_impulse], rel=1e-9)
    assert isnan(pulse.newton_restitution)
    assert motion.to_dict()["pulses"][0]["cut"] is True


@pytest.mark.parametrize("offset", [-0.05, 0.05])
def test_cut_by_the_release(offset):
    """Released inside the pulse, before its bottom and behind it."""
    scene = Scene(Hoop(0.1), Friction(0.5, 0.4), Release(pi + offset, 5.0), Run(turns=2))
    motion = simulate(scene)
    assert float(motion.at(0.0).normal_force) > 1
    assert motion.pulses[0].cut
    assert motion.pulses[0].t_start == 0
    assert not any(pulse.cut for pulse in motion.pulses[1:])
    first = motion.pulses[0]
    assert quadrature(motion, first) == pytest.approx([first.normal_impulse, first.friction_impulse], rel=1e-9)


def test_the_two_halves_of_a_pulse_add_up_to_it(whole):
    """Cut anywhere and released again there: the impulses and the loss of the halves add up to the whole."""
    t = 5.74
    state = simulate(SCENE).at(t)
    first = simulate(SCENE.replace(run={"t_end": t})).pulses[0]
    release = Release(float(state.phi), float(state.omega), float(state.slip_velocity))
    second = simulate(SCENE.replace(release=release, run={"turns": 1})).pulses[0]
    assert first.cut
    assert second.cut
    for name in ("normal_impulse", "friction_impulse", "friction_loss"):
        # a restart carries the round-off of phi ~ 1e-16 into forces that change over k ~ 0.1
        assert getattr(first, name) + getattr(second, name) == pytest.approx(getattr(whole, name), rel=1e-9)


@pytest.mark.parametrize(
    "scene",
    [
        # on the way down, at 1.97, N is largest where the run ends; at 2.1, on the way up, at the bottom
        Scene(Hoop(0.3), Friction(9, 9), Release(phi0_deg=90), Run(t_end=1.97)),
        Scene(Hoop(0.3), Friction(9, 9), Release(phi0_deg=90), Run(t_end=2.1)),
        # comes down from a flight and skids over the bottom: N has its peak between that and the end of the skid
        Scene(
            Hoop(0.44781469193473705, mass_ratio=0.1), Friction(0.119127058399771, 0.08869228363016206),
            Release(5.437209478259936, 1.430481507294281), Run(t_end=5.9),
        ),
    ],
    ids=["down", "up", "skid"],
)  # fmt: skip
def test_the_peak_is_the_largest_force(scene):
    """Nowhere in the listed part of a pulse is N larger."""
    motion = simulate(scene)
    pulse = motion.pulses[-1]
    assert pulse.cut
    t = np.linspace(pulse.t_start, pulse.t_end, 2001)
    normal = motion.at(t).normal_force
    best = int(np.argmax(normal))
    around = t[max(best - 1, 0)], t[min(best + 1, 2000)]
    found = minimize_scalar(
        lambda time: -float(motion.at(time).normal_force), bounds=around, method="bounded", options={"xatol": 1e-10}
    )
    # the peak is flat: a place known to 1e-8 gives its height to round-off
    assert pulse.peak_normal_force == pytest.approx(max(-found.fun, normal[best]), rel=1e-10)
    batch = simulate_batch([scene], t_end=scene.run.t_end)
    assert batch.peak_normal_force[0, len(motion.pulses) - 1] == pytest.approx(pulse.peak_normal_force, rel=1e-14)


def test_what_is_unknown_alike_is_the_same():
    """NaN is no number's equal, and no reason for a motion not to be its own copy's; all that is known counts."""
    scene = SCENE.replace(run={"t_end": 5.72})
    (pulse,) = simulate(scene).pulses
    for other in (simulate(scene).pulses[0], pickle.loads(pickle.dumps(replace(pulse, sample=None)))):
        assert isnan(other.newton_restitution)
        assert other == pulse
        assert len({other, pulse}) == 1
    for name in ("t_end", "friction_loss", "newton_restitution"):
        assert replace(pulse, **{name: 1.0}) != pulse
    assert pulse != "a pulse"


def test_whole_pulses_are_not_marked(whole):
    assert not whole.cut
    assert not any(pulse.cut for pulse in simulate(SCENE.replace(run={"turns": 4})).pulses)


@pytest.mark.parametrize(
    ("scene", "cuts"),
    [
        (Scene(Hoop(0.3), Friction(0.5, 0.4), Release(pi, 0.5)), [True, False]),  # at the bottom
        (Scene(Hoop(0.3), Friction(0.35, 0.3), Release(phi0_deg=178, omega0=2.0)), [True, False]),  # on the way to it
        (Scene(Hoop(0.3), Friction(0.35, 0.3), Release(phi0_deg=182, omega0=2.0)), [True, False]),  # behind it
        (Scene(Hoop(0.3), Friction(0.35, 0.3), Release(phi0_deg=10)), [False]),
    ],
)
def test_a_run_to_a_pulse_goes_on_to_the_first_whole_one(scene, cuts):
    """What is left of a pulse in which the hoop is released does not end it, be it over the bottom or not."""
    motion = simulate(scene.replace(run={"until": "pulse"}))
    assert [pulse.cut for pulse in motion.pulses] == cuts
    assert motion.t_end == motion.pulses[-1].t_end
    longer = simulate(scene.replace(run={"t_end": motion.t_end + 0.5}))
    assert longer.pulses[: len(cuts)] == motion.pulses
    batch = simulate_batch([scene], until="pulse")
    assert batch.pulse_count[0] == len(cuts)
    assert batch.t_end[0] == pytest.approx(motion.t_end, rel=1e-13)
    assert batch.impulse_ratio[0, len(cuts) - 1] == pytest.approx(motion.pulses[-1].impulse_ratio, rel=1e-12)


def test_a_batch_marks_them_too():
    batch = simulate_batch([SCENE], t_end=5.75)
    assert batch.pulse_count[0] == 1
    assert batch.cut[0, 0] == 1
    assert batch.normal_impulse[0, 0] == simulate(SCENE.replace(run={"t_end": 5.75})).pulses[0].normal_impulse
    assert simulate_batch([SCENE], turns=2).cut[0, 0] == 0


def test_studies_measure_whole_pulses_only():
    cut = run_case(Case("rigid", SCENE.replace(run={"t_end": 5.75})))
    assert cut.failure == ""
    assert cut.pulses == ()
    assert cut.motion["pulses"][0]["cut"] is True


def test_energy_gained_in_a_pulse_would_show():
    """The loss is the difference of two energies and nothing hides its sign: rolling leaves round-off, either way."""
    scene = load_scene("paper-3.2-k0.75").replace(run={"turns": 40})
    losses = np.array([pulse.friction_loss for pulse in simulate(scene).pulses])
    assert np.abs(losses).max() < 1e-14


@pytest.mark.parametrize("turned", [181, 172, -179])
def test_cut_at_both_ends(turned):
    """Released on its way up from the bottom, as down to it, and looked at no further than in the pulse."""
    omega = 2.0 if turned > 0 else -2.0
    scene = Scene(Hoop(0.1, 1.02), Friction(0.35, 0.3), Release(np.radians(turned), omega), Run(t_end=0.05))
    motion = simulate(scene)
    (pulse,) = motion.pulses
    assert (pulse.t_start, pulse.t_end, pulse.cut) == (0, 0.05, True)
    assert quadrature(motion, pulse) == pytest.approx([pulse.normal_impulse, pulse.friction_impulse], rel=1e-9)
    of_batch = simulate_batch([scene], t_end=0.05, pulses=1)
    assert of_batch.normal_impulse[0, 0] == pytest.approx(pulse.normal_impulse, rel=1e-12)
