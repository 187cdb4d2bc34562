"""A hoop that turns right at the bottom, where N comes down to M g and goes up again; peaks of N behind a turn."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from rigid import Friction, Hoop, Kind, Release, Run, Scene, simulate


@settings(max_examples=60, deadline=None)
@given(
    k=st.floats(0.04, 0.6), r=st.sampled_from([1.0, 1.02, 1.3]), mass_ratio=st.sampled_from([0.0, 0.1, 1.0]),
    mu=st.sampled_from([0.05, 0.1, 0.2, 0.3]), rougher=st.sampled_from([1.0, 1.2]), slip0=st.floats(0.1, 3.0),
)  # fmt: skip
def test_a_hoop_set_slipping_at_the_bottom_has_the_pulses_of_its_mirror_image(k, r, mass_ratio, mu, rougher, slip0):
    """While it slips one way F/N is constant, and each swing ends where it began: at the bottom, with N = M g."""
    scene = Scene(Hoop(k, r, mass_ratio), Friction(rougher * mu, mu), Release(pi, 0.0, slip0), Run(t_end=20.0))
    one, other = simulate(scene), simulate(scene.replace(release=Release(-pi, 0.0, -slip0)))
    found = [[(p.t_start, p.t_end, p.normal_impulse, p.friction_loss) for p in m.pulses] for m in (one, other)]
    assert len(found[0]) == len(found[1])
    assert np.ravel(found[0]) == pytest.approx(np.ravel(found[1]), abs=1e-6)  # round-off, times what landings amplify


@settings(max_examples=60, deadline=None)
@given(
    k=st.floats(0.04, 0.6), mass_ratio=st.sampled_from([0.0, 0.1, 1.0]), mu=st.sampled_from([0.05, 0.1, 0.2, 0.3]),
    omega0=st.floats(0.2, 2.0), slip0=st.floats(-3.0, 3.0),
)  # fmt: skip
@example(k=0.32289992160383607, mass_ratio=1.0, mu=0.3, omega0=0.6496012296634079, slip0=-2.5313912836412946)
@example(k=0.445210658981842, mass_ratio=0.1, mu=0.1, omega0=1.4863934346321335, slip0=-2.764675976760058)
def test_the_disk_comes_to_the_bottom_within_a_pulse(k, mass_ratio, mu, omega0, slip0):
    """Set going there and slipping, it comes back there after a turn, where a step of the solver ends: whichever side
    of the bottom round-off lets it end on. The other way round too.
    """
    scene = Scene(Hoop(k, 1.1, mass_ratio), Friction(mu, mu), Release(pi, omega0, slip0), Run(t_end=8.0))
    motions = simulate(scene), simulate(scene.replace(release=Release(-pi, -omega0, -slip0)))
    assert len(motions[0].pulses) == len(motions[1].pulses)
    t = np.linspace(0, 8, 4001)
    for motion in motions:
        side = np.sign(np.cos(motion.at(t).phi / 2))
        (before,) = np.nonzero(side[1:-1] * side[2:] < 0)
        for i in before + 1:
            around = motion.at(t[[i, i + 1]])
            if around.normal_force.min() > 1:  # neither in flight nor where a pulse ends
                assert sum(p.t_start <= t[i] and t[i + 1] <= p.t_end for p in motion.pulses) == 1


def test_a_turn_at_the_bottom_is_within_one_pulse():
    """A pulse as any other: in and out on the same side, the same angle, N and time there and back."""
    motion = simulate(Scene(Hoop(0.1, 1.2, 0.1), Friction(0.65 / 3, 0.1), Release(pi, 0.0, -2.0), Run(until="pulse")))
    pulse, turn = motion.pulses[-1], motion.turns[-1]
    assert [phase.kind for phase in motion.phases] == [Kind.SPIN]
    assert not pulse.cut
    assert turn.phi == pytest.approx(pi, abs=1e-12)
    assert pulse.phi_start == pytest.approx(pulse.phi_end, abs=1e-12)
    assert turn.t - pulse.t_start == pytest.approx(pulse.t_end - turn.t, rel=1e-9)
    for name in ("newton", "poisson", "energetic"):
        assert getattr(pulse, f"{name}_restitution") == pytest.approx(1, rel=1e-9)


@pytest.mark.parametrize(
    ("hoop", "friction", "release"),
    [
        (Hoop(0.9254, 1.02), Friction(0.35, 0.3189), Release(1.5838868388043148, 0.0, -0.942893019712814)),
        (Hoop(0.7535, 1.02, 30.0), Friction(0.11667, 0.1), Release(1.6650732608228633, 0.0, -0.5351865366993119)),
    ],
)
def test_a_peak_right_behind_a_start_from_rest_is_found(hoop, friction, release):
    """N changes there like the square of the time, so that its slope at the start says nothing."""
    motion = simulate(Scene(hoop, friction, release, Run(until="pulse")))
    pulse = motion.pulses[0]
    times = np.linspace(pulse.t_start, pulse.t_end, 20001)
    best = int(np.argmax(motion.at(times).normal_force))
    around = (times[max(best - 1, 0)], times[min(best + 1, len(times) - 1)])
    found = minimize_scalar(lambda t: -motion.at(t).normal_force, bounds=around, options={"xatol": 1e-10})
    assert pulse.peak_normal_force == pytest.approx(-found.fun, rel=1e-13)
