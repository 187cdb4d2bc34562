"""Thresholds, ties, the point mass, and every way for a motion to end."""

from __future__ import annotations

from itertools import pairwise
from math import acosh, asin, atan, cos, cosh, inf, nan, pi, radians, sin, sqrt, tan

import numpy as np
import pytest

from rigid import (
    Friction,
    Hoop,
    Kind,
    Release,
    Run,
    Scene,
    SceneError,
    inception_mu_s,
    load_scene,
    rolling_k,
    rolling_mu_s,
    simulate,
    simulate_batch,
)  # fmt: skip
from rigid.kernel.compile import Patience

RELEASE = Release(radians(10))


def kinds(motion):
    return [phase.kind for phase in motion.phases]


def test_smallest_disk_that_rolls_throughout():
    """Section 3.2: k = 0.5385 for mu_s = 0.35; just below it slips, just above it never does."""
    with pytest.raises(SceneError, match="mu_s = nan is not possible"):
        rolling_k(nan, RELEASE)
    k = rolling_k(0.35, RELEASE)
    assert k == pytest.approx(0.5385, abs=1e-4)
    assert kinds(simulate(Scene(Hoop(k * (1 + 1e-10)), Friction(0.35, 0.3), RELEASE))) == [Kind.ROLL]
    assert len(kinds(simulate(Scene(Hoop(k * (1 - 1e-10)), Friction(0.35, 0.3), RELEASE)))) > 1


def test_smallest_friction_that_rolls_throughout():
    """Section 3.4: mu_s = 0.78 for k = 0.1, r = 1.02, m_h/m = 0.1."""
    hoop = load_scene("paper-3.4-rough").hoop
    mu_s = rolling_mu_s(hoop, RELEASE)
    assert mu_s == pytest.approx(0.78, abs=0.01)
    assert kinds(simulate(Scene(hoop, Friction(mu_s * (1 + 1e-10), 0.3), RELEASE))) == [Kind.ROLL]
    assert len(kinds(simulate(Scene(hoop, Friction(mu_s * (1 - 1e-10), 0.3), RELEASE)))) > 1


@pytest.mark.parametrize(
    ("hoop", "release"),
    [
        (Hoop(0.6), RELEASE),
        (Hoop(0.3, 1.02, 1.0), Release(radians(100))),
        (Hoop(0.3, 1.02, 1.0), Release(radians(150), 0.5)),
        (Hoop(0.3, 1.02, 8.0), Release(radians(100), 1.5)),
        (Hoop(0.6, 1.0, 2.0), Release(radians(200), -0.1)),
    ],
)
def test_the_friction_that_rolls_throughout_is_the_largest_ratio_of_the_swing(hoop, release):
    """|F|/N of a hoop that cannot slip, sampled over its swing, over the top too, to the square of the distance."""
    needed = rolling_mu_s(hoop, release)
    motion = simulate(Scene(hoop, Friction(1e3, 1e3), release, Run(t_end=15.0)))
    assert kinds(motion) == [Kind.ROLL]
    states = motion.at(np.linspace(0, motion.t_end, 50_001)[:-1])
    assert (np.abs(states.friction_force) / states.normal_force).max() == pytest.approx(needed, rel=1e-6)


def test_no_friction_rolls_where_n_would_vanish():
    """A tiny disk on a massless hoop cannot roll through: N of rolling falls below 0."""
    assert rolling_mu_s(Hoop(1e-3), RELEASE) == inf
    with pytest.raises(SceneError, match=r"release\.slip0 = 1\.0 is not possible here"):
        rolling_mu_s(Hoop(0.5), Release(1.0, 0.0, slip0=1.0))


@pytest.mark.parametrize("phi0", [0.2, 1.0, 2.5])
def test_inception(phi0):
    """(9): above mu_s of inception a release at rest starts rolling, below it slipping."""
    hoop = Hoop(0.1, 1.02, 0.1)
    mu_s = inception_mu_s(hoop, phi0)
    for factor, kind in ((1 - 1e-9, Kind.SPIN), (1 + 1e-9, Kind.ROLL)):
        motion = simulate(Scene(hoop, Friction(mu_s * factor, 0.5 * mu_s), Release(phi0), Run(t_end=1e-3)))
        assert motion.phases[0].kind == kind


def test_equal_coefficients():
    """mu_s = mu: the slip starts without acceleration, and is the limit of mu_s -> mu."""
    equal = simulate(Scene(Hoop(0.1), Friction(0.3, 0.3), RELEASE, Run(turns=2)))
    near = simulate(Scene(Hoop(0.1), Friction(0.3 * (1 + 1e-9), 0.3), RELEASE, Run(turns=2)))
    assert kinds(equal) == kinds(near)
    assert equal.turns[1].phi == pytest.approx(near.turns[1].phi, abs=1e-7)


@pytest.mark.parametrize("phi0", [0.0, pi, -pi, 3 * pi, 2 * pi])
def test_at_rest_on_top_or_bottom(phi0):
    for friction in (Friction(0.3, 0.3), Friction(0, 0)):
        motion = simulate(Scene(Hoop(0.1), friction, Release(phi0), Run(until="rest")))
        assert motion.ended.startswith("rests")
        assert motion.at(0.0).omega == 0


def test_smooth_floor():
    """mu = 0: x of G is never pushed, energy is kept, and a run to rest says that it slides for ever."""
    motion = simulate(load_scene("paper-3.4-frictionless").replace(run={"until": "rest"}))
    assert motion.ended.startswith("slides for ever")
    states = motion.at(np.linspace(0, motion.t_end, 50))
    x = states.x_C + motion.scene.hoop.e * np.sin(states.phi)
    # round-off of one swing and a half
    assert np.ptp(x) < 1e-12
    assert np.ptp(states.energy) < 1e-11


def test_slide_at_a_steady_tilt():
    """Skidding with P = 0, e sin phi = -mu (1 + e cos phi), phi stays: the slip decays like v0 - mu t."""
    hoop, mu, v0 = Hoop(0.4), 0.2, 1.3
    # tan(x/2) from e sin x + mu e cos x = -mu
    e = hoop.e
    phi = pi + asin(mu / (e * sqrt(1 + mu * mu))) - atan(mu)
    motion = simulate(Scene(hoop, Friction(0.4, mu), Release(phi, 0.0, v0), Run(t_end=1.5 * v0 / mu)))
    assert motion.phases[0].kind == Kind.SKID
    assert motion.phases[0].t_end == pytest.approx(v0 / mu, rel=1e-9)
    assert motion.phases[0].phi_end == pytest.approx(phi, abs=1e-9)


def test_point_mass_law():
    """k = 0: sin(phi/2) = sin(phi0/2) cosh(t/2), N = 2 cos^2(phi/2) - cos^2(phi0/2), until tan(phi/2) = mu_s."""
    motion = simulate(load_scene("paper-point-mass"))
    roll = motion.phases[0]
    assert kinds(motion) == [Kind.ROLL, Kind.SKIM]
    assert roll.phi_end == pytest.approx(2 * atan(0.35), rel=1e-14)
    s0 = sin(radians(5))
    assert roll.t_end == pytest.approx(2 * acosh(sin(roll.phi_end / 2) / s0), rel=1e-13)
    states = motion.at(np.linspace(0, roll.t_end, 7)[:-1])
    assert states.phi == pytest.approx([2 * asin(s0 * cosh(t / 2)) for t in states.t], rel=1e-13)
    assert states.normal_force == pytest.approx(2 * np.cos(states.phi / 2) ** 2 - 1 + s0**2, abs=1e-13)
    assert states.friction_force == pytest.approx(states.normal_force * np.tan(states.phi / 2), abs=1e-13)
    assert motion.ended == "the point mass hits the floor"


def test_point_mass_skims_below_inception():
    """Below mu_s = tan(phi0/2) the hoop skims: N = F = 0 and the mass falls freely from 1 + cos phi0 to the floor."""
    phi0 = 1.0
    motion = simulate(Scene(Hoop(0.0), Friction(tan(0.5) * (1 - 1e-9), 0.1), Release(phi0)))
    assert kinds(motion) == [Kind.SKIM]
    assert motion.t_end == pytest.approx(sqrt(2 * (1 + np.cos(phi0))), rel=1e-14)
    states = motion.at(np.linspace(0, motion.t_end, 9)[:-1])
    assert np.ptp(states.x_C + np.sin(states.phi)) < 1e-14
    assert 1 + np.cos(states.phi) == pytest.approx(1 + np.cos(phi0) - states.t**2 / 2, abs=1e-14)
    assert not states.normal_force.any()


def test_runs_to_rest():
    """A lossy scene runs through all its cycles to a rolling that never slips, and says its period."""
    motion = simulate(load_scene("paper-3.1").replace(run={"until": "rest"}))
    assert motion.ended.startswith(("rolls for ever", "goes on all but for ever"))
    if motion.period is not None:
        last = motion.phases[-1]
        assert last.kind == Kind.ROLL
        assert last.t_end - last.t_start == pytest.approx(motion.period, rel=1e-9)
        assert motion.at(last.t_end).phi == pytest.approx(float(motion.at(last.t_start).phi), abs=1e-9)


def test_until_the_first_pulse():
    whole, first = simulate(load_scene("paper-3.1")), simulate(load_scene("paper-3.1").replace(run={"until": "pulse"}))
    assert first.pulses == whole.pulses[:1]
    assert first.t_end == first.pulses[0].t_end
    assert first.at(first.t_end).normal_force == pytest.approx(1, abs=1e-10)


def test_until_a_time():
    for t_end in (0.3, 4.5, 5.745, 6.5, 100.0):
        motion = simulate(load_scene("paper-3.1").replace(run={"t_end": t_end}))
        assert motion.t_end == t_end


def test_rotation_without_turns():
    """Rolling over the top in every revolution: the energy is kept, and no run waits for a turn that never comes."""
    motion = simulate(Scene(Hoop(0.9, 1.0, 5.0), Friction(3, 2), Release(1.0, 2.0), Run(turns=2)))
    assert "over the top" in motion.ended
    turned = motion.at(motion.t_end).phi - motion.at(0.0).phi
    assert turned == pytest.approx(2 * pi, abs=1e-11)


def test_batch_is_many_single_motions():
    ks = np.array([0.05, 0.1, 0.2, 0.7])
    batch = simulate_batch({"k": ks, "mu_s": 0.35, "mu": 0.3, "phi0": RELEASE.phi0}, turns=2)
    for i, k in enumerate(ks):
        motion = simulate(Scene(Hoop(float(k)), Friction(0.35, 0.3), RELEASE, Run(turns=2)))
        assert batch.turn_phi[i] == pytest.approx([turn.phi for turn in motion.turns], rel=1e-12)
        assert batch.impulse_ratio[i] == pytest.approx([p.impulse_ratio for p in motion.pulses], abs=1e-11)
        assert batch.turn_count[i] == 2
    with pytest.raises(SceneError, match=r"scene 2 of the batch: hoop\.k"):
        simulate_batch({"k": [0.1, 0.2, 1.5], "mu_s": 0.35, "mu": 0.3, "phi0": 0.1})
    with pytest.raises(SceneError, match="phi0 is missing"):
        simulate_batch({"k": 0.1, "mu_s": 0.35, "mu": 0.3})


def test_slip_that_ends_on_the_edge_of_holding_rolls_on():
    """mu = 0 < mu_s: a pass is its own mirror image, so the slip ends where it began, at |F| = mu_s N to round-off.

    Each pass goes roll, slip, roll.
    """
    scene = Scene(Hoop(7.9e-8), Friction(0.6, 0.0), Release(1.0), Run(t_end=40.0))
    found = kinds(simulate(scene))
    rolls = [i for i, kind in enumerate(found) if kind == Kind.ROLL]
    assert len(rolls) > 3
    assert len({after - before for before, after in pairwise(rolls)}) == 1


@pytest.mark.parametrize(
    ("hoop", "friction", "release"),
    [
        (
            Hoop(1.531767533623547e-08, 1.6181974387062448),
            Friction(1.6053665170731655, 0.37055021177456093),
            Release(-0.6730584926392402, -3.1027420104614323, -1.9532793996234736),
        ),
        (
            Hoop(1.201013238678522e-08, 1.6245642179357156),
            Friction(1.9628089489546119, 0.7595783739056603),
            Release(3.784249587310647, -3.767514529504946),
        ),
    ],
)
@pytest.mark.parametrize("units", [1.0, 0.3])
def test_rolling_that_ends_with_no_force_slips_the_right_way(hoop, friction, release, units):
    """K ~ 1e-17: N and F die out together, and the slip that follows has the sign of sin phi (where D > 0)."""
    scene = Scene(hoop, friction, release, Run(t_end=20.0))
    si = scene.replace(hoop={"R": units, "g": 9.81})
    time = si.time_unit
    si = si.replace(
        release={"omega0": release.omega0 / time, "slip0": release.slip0 * si.velocity_unit}, run={"t_end": 20 * time}
    )
    motion = simulate(si)
    assert motion.completed
    slips = [
        after
        for before, after in pairwise(motion.phases)
        if before.kind == Kind.ROLL and float(motion.at(before.t_end).normal_force) < 1e-12 * si.force_unit
    ]
    assert slips
    for phase in slips:
        assert phase.kind == (Kind.SKID if sin(phase.phi_start) > 0 else Kind.SPIN)


def test_a_hundred_slips_are_not_the_end():
    """What a hundred slips take tells that a motion goes on all but for ever, not their number: this one loses 8 %."""
    hoop, friction = Hoop(8.295377577318604e-07, 1.2005810607224703, 0.00921034699542735), Friction(2.21228, 0.814857)
    motion = simulate(Scene(hoop, friction, Release(9.7434557621, 5.2531078461), Run(turns=1)))
    assert "hundred" not in motion.ended
    slips = sum(kind in (Kind.SKID, Kind.SPIN) for kind in kinds(motion))
    assert slips > 100


SETTLING = {
    "it hops and lands in every revolution of a smooth floor": Scene(
        Hoop(0.0011212358571186737, 1.02, 0.16369416060025233),
        Friction(0, 0),
        Release(1.1377356011343958, 26.925531473868567 * sqrt(0.3 / 9.81)),
        Run(until="rest"),
    ),
    "it slips all the time": Scene(Hoop(0.3), Friction(1e-9, 1e-9), Release(phi0_deg=60), Run(until="rest")),
}


@pytest.mark.parametrize("name", SETTLING)
def test_what_is_said_of_a_motion_that_loses_next_to_nothing_is_true(name):
    """Neither rolls, and the landings of the first take energy: all that is said of both is what they do."""
    motion = simulate(SETTLING[name])
    assert Kind.ROLL not in kinds(motion)
    assert not any(word in motion.ended for word in ("roll", "smooth", "takes no energy"))
    assert "hundred slips" in motion.ended
    energy = motion.at(np.array([0.0, motion.t_end])).energy
    assert energy[1] < energy[0]


def test_a_smooth_whirl_has_no_turn_to_wait_for():
    motion = simulate(Scene(Hoop(0.5), Friction(0.0, 0.0), Release(0.1, 1.0), Run(turns=2)))
    assert motion.ended.startswith("slides for ever")


@pytest.mark.parametrize("omega0", [1e-200, -1e-200, 1e-313])
@pytest.mark.parametrize("phi0", [0.0, 1.0])
def test_a_rate_whose_square_is_no_number_is_no_rate(monkeypatch, omega0, phi0):
    """Interpreted, where a division by zero is an error, and compiled, what hardly turns slips like what does not."""
    release = Release(phi0, 0.0, 0.5)
    scene = Scene(Hoop(0.1), Friction(0.3, 0.3), release, Run(turns=2))
    for steps in (10**9, 0):
        monkeypatch.setattr("rigid.solve.patience", Patience(steps))
        rest, hardly = simulate(scene), simulate(scene.replace(release={"omega0": omega0}))
        assert kinds(hardly) == kinds(rest)
        if phi0:  # at the top it is the sign of the rate that says where it falls
            ends = np.array([[phase.t_end, phase.phi_end] for phase in hardly.phases])
            assert ends == pytest.approx(np.array([[phase.t_end, phase.phi_end] for phase in rest.phases]), rel=1e-12)


@pytest.mark.parametrize(("phi0", "omega0"), [(1e-130, 0.5), (1e-130, -0.5), (-1e-130, 0.5), (1e-17, -0.5)])
def test_a_smooth_slip_next_to_the_top_goes_where_the_disk_goes(phi0, omega0):
    """The contact slips against the disk's turning."""
    motion = simulate(Scene(Hoop(0.5), Friction(0, 0), Release(phi0, omega0), Run(t_end=0.5)))
    assert motion.t_end == 0.5
    assert motion.phases[0].kind == (Kind.SPIN if omega0 > 0 else Kind.SKID)
    assert float(motion.at(0.01).slip_velocity) * omega0 < 0


@pytest.mark.parametrize("phi0", [radians(110), radians(-110), radians(250), radians(470)])
def test_a_point_mass_that_rolls_below_the_centre(phi0):
    """sin(phi/2) = sin(phi0/2) cosh(t/2) + cos(phi0/2) omega0 sinh(t/2), and F = N tan(phi/2): no moment about C."""
    omega0 = -0.4 if sin(phi0 / 2) * cos(phi0 / 2) > 0 else 0.4  # up again, where N grows
    motion = simulate(Scene(Hoop(0.0), Friction(4, 4), Release(phi0, omega0), Run(t_end=0.3)))
    t = np.linspace(0.01, motion.t_end, 7)
    states = motion.at(t)
    expected = sin(phi0 / 2) * np.cosh(t / 2) + cos(phi0 / 2) * omega0 * np.sinh(t / 2)
    assert motion.phases[0].kind == Kind.ROLL
    assert np.sin(states.phi / 2) == pytest.approx(expected, abs=1e-12)
    assert states.friction_force == pytest.approx(states.normal_force * np.tan(states.phi / 2), rel=1e-10)
