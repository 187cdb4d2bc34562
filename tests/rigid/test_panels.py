"""Slip by panels against slip by series: two ways to integrate, on the same events."""

from math import acos

import numpy as np
import pytest

from rigid import Friction, Hoop, Landing, Release, Run, Scene, simulate, solve
from rigid.kernel.compile import Patience
from rigid.phases import flight
from rigid.phases.slipping import phase
from rigid.phases.slipping.stride import NOT_TAKEN


def drawn(seed: int) -> Scene:
    """A scene with slip in it: damped by friction from the start, some spinning, some with a hop."""
    rng = np.random.default_rng(seed)
    mu = rng.uniform(0.05, 0.6)
    return Scene(
        Hoop(10 ** rng.uniform(-3, -0.2), r=rng.choice([1.0, 1.02, 1.3]), mass_ratio=rng.choice([0.0, 0.05, 1.0])),
        Friction(mu * rng.choice([1.0, 1.17, 1.5]), mu),
        Release(rng.uniform(-3, 3), omega0=rng.choice([0.0, rng.normal()]), slip0=rng.choice([0.0, rng.normal()])),
        Run(turns=2),
        Landing(rng.choice([0.0, 0.5])),
    )


def by_series(scene: Scene, monkeypatch: pytest.MonkeyPatch):
    """The motion with the panels switched off, interpreted."""
    with monkeypatch.context() as patch:
        patch.setattr(phase, "stride", lambda *_: NOT_TAKEN)
        patch.setattr(solve, "patience", Patience(10**9))
        motion = simulate(scene)
        return motion, (list(motion.phases), list(motion.turns), list(motion.pulses))


@pytest.mark.parametrize("seed", range(24))
def test_panels_and_series_agree(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Phases in the same order at the same times, turns and pulses alike."""
    scene = drawn(seed)
    _, (phases, turns, pulses) = by_series(scene, monkeypatch)
    with monkeypatch.context() as patch:
        patch.setattr(solve, "patience", Patience(10**9))
        motion = simulate(scene)
        assert [p.kind for p in motion.phases] == [p.kind for p in phases]
        # a hundred steps to 1e-15 each; where slip and roll follow upon one another errors grow, by 1e4 in some
        tight = {"rel": 1e-9, "abs": 1e-9}
        assert [p.t_start for p in motion.phases] == pytest.approx([p.t_start for p in phases], **tight)
        assert [x for t in motion.turns for x in (t.t, t.phi, t.energy)] == pytest.approx(
            [x for t in turns for x in (t.t, t.phi, t.energy)], **tight
        )
        for mine, other in zip(motion.pulses, pulses, strict=True):
            assert mine.normal_impulse == pytest.approx(other.normal_impulse, **tight)
            assert mine.friction_impulse == pytest.approx(other.friction_impulse, **tight)
            # towards a jam N grows beyond bounds: how far is a matter of where the steps end
            if other.peak_normal_force < 1e8 / scene.hoop.k**2:
                assert mine.peak_normal_force == pytest.approx(other.peak_normal_force, rel=1e-9)


def test_a_run_ends_at_the_time_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Times on both sides of a turn in a skid: the state there is that of the longer run."""
    scene = Scene(Hoop(0.1), Friction(0.35, 0.3), Release(phi0_deg=10), Run(turns=2))
    whole = simulate(scene)
    skid = next(p for p in whole.phases if p.kind == "skid")
    for t in np.linspace(skid.t_start, whole.turns[0].t + 1.0, 7)[1:]:
        cut = simulate(scene.replace(run={"t_end": float(t)}))
        assert cut.t_end == t
        assert cut.phases[-1].phi_end == pytest.approx(float(whole.at(t).phi), abs=1e-12)


def test_a_way_back_over_the_height_of_the_centre_keeps_its_turn() -> None:
    """A swing that turns above the hoop's centre comes back to where it was, not a turn further on."""
    scene = Scene(Hoop(0.02592), Friction(0.05607, 0.03054), Release(1.387, omega0=-0.8277, slip0=-3.566), Run(turns=3))
    phi = [turn.phi for turn in simulate(scene).turns]
    assert abs(phi[2] - phi[0]) < 0.1


def test_lift_off_is_a_flight() -> None:
    """Where e c phidot^2 exceeds 1 by its round-off and grows, the contact point is off for more than an instant.

    Its height is of third order, e |s| phidot^3 t^3/6, against the curvature that gravity and the rotation leave later.
    """
    e, omega = 0.9, 2.0
    bound = 1 + e * omega**2
    a = -acos((1 + 3e-14 * bound) / (e * omega**2))
    assert flight.touch_down(e, 0.0, 0.0, omega, a, 1.0) > 0.1


@pytest.mark.parametrize(
    ("k", "r", "mu_s", "mu", "phi0"), [(1.4e-7, 1.011, 0.683, 0.572, 0.517), (3.7e-7, 1.001, 0.972, 0.972, 0.997)]
)
def test_a_jam_of_a_hoop_without_inertia_ends(k: float, r: float, mu_s: float, mu: float, phi0: float) -> None:
    """D is round-off of its terms when a jam is handed to the impact: it must be taken for zero there too."""
    motion = simulate(Scene(Hoop(k, r=r), Friction(mu_s, mu), Release(phi0), Run(turns=3)))
    assert len(motion.turns) == 3
    assert len(motion.phases) < 50
