"""Motions on a smooth floor: released next to the top, right above or below the contact, or sliding for ever."""

from __future__ import annotations

from math import asinh, cosh, pi, sin, sinh, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from rigid import Friction, Hoop, Release, Run, Scene, simulate

SMOOTH = Friction(0.0, 0.0)


def from_top(hoop, phi0, omega0, phi):
    """Time from phi0 to phi: the energy integral, whose height 2 sin^2(phi/2) loses no digit near the top.

    With phi = a sinh u, or a cosh u from rest: phidot is then all but proportional to dphi/du.
    """

    def inertia(phi):
        return hoop.K + (hoop.e * sin(phi)) ** 2

    if omega0:
        a = omega0 * sqrt(hoop.K / hoop.e)  # where the height is the energy, for a release right on top

        def pace(u):
            at = a * sinh(u)
            omega = sqrt((hoop.K * omega0**2 + 4 * hoop.e * sin(at / 2) ** 2) / inertia(at))
            return a * cosh(u) / omega

        return quad(pace, 0, asinh(phi / a), epsabs=0, epsrel=1e-13, limit=500)[0]

    def from_rest(u):
        at, beyond = phi0 * cosh(u), phi0 * sinh(u / 2) ** 2  # half of what it is farther than phi0
        omega = sqrt(4 * hoop.e * sin(beyond + phi0) * sin(beyond) / inertia(at)) if u else 0.0
        return phi0 * sinh(u) / omega if u else sqrt(hoop.K / hoop.e)

    return quad(from_rest, 0, 2 * asinh(sqrt((phi / phi0 - 1) / 2)), epsabs=0, epsrel=1e-13, limit=500)[0]


@pytest.mark.parametrize("phi0", [1e-12, 1e-9, 1e-7, 1e-4, 0.1])
def test_a_hoop_let_go_next_to_the_top_turns_next_to_it(phi0):
    """It has to get within phi0 of the top again, on the other side, where an energy of round-off of the whole would
    take it over. Each time is that of the energy integral, to what a time of ninety can tell."""
    hoop = Hoop(0.3, 1.0, 1.0)
    motion = simulate(Scene(hoop, SMOOTH, Release(phi0), Run(turns=4)))
    half = 2 * from_top(hoop, phi0, 0.0, pi)
    assert [turn.t for turn in motion.turns] == pytest.approx(half * np.arange(1, 5), rel=1e-12)
    ends = [2 * pi - phi0, phi0, 2 * pi - phi0, phi0]
    assert [turn.phi for turn in motion.turns] == pytest.approx(ends, abs=2e-15 if phi0 < 0.1 else 1e-13)


@pytest.mark.parametrize("omega0", [1e-9, -1e-8, 1e-6, 1e-3])
def test_a_hoop_pushed_off_the_top_comes_over_it_again_and_again(omega0):
    """With phidot = omega0 there, where the slip comes to 0 and goes on with the same sign: one phase."""
    hoop = Hoop(0.3, 1.0, 1.0)
    period = 2 * from_top(hoop, 0.0, abs(omega0), pi)
    motion = simulate(Scene(hoop, SMOOTH, Release(0.0, omega0), Run(t_end=3.5 * period)))
    assert len([phase for phase in motion.phases if phase.t_end > phase.t_start]) == 1
    over = motion.at(period * np.arange(1, 4))
    assert over.omega == pytest.approx(omega0, rel=1e-9)
    assert over.phi == pytest.approx(np.copysign(2 * pi, omega0) * np.arange(1, 4), abs=1e-12)
    starts = [pulse.t_start for pulse in motion.pulses[:3]]
    assert np.diff(starts) == pytest.approx(period, rel=1e-12)


@settings(max_examples=60, deadline=None)
@given(
    k=st.floats(0.05, 0.95), r=st.sampled_from([1.0, 1.02, 1.3]), mass_ratio=st.sampled_from([0.0, 0.1, 1.0]),
    phi0=st.sampled_from([0.0, pi]), omega0=st.floats(-0.9, 0.9), slip0=st.sampled_from([0.0, 0.0, 0.3]),
)  # fmt: skip
def test_what_is_listed_is_where_the_motion_is(k, r, mass_ratio, phi0, omega0, slip0):
    """Turns and pulses against any instant: the same motion, followed twice, to what it adds up of round-off.

    Set going with the disk right above or below the contact, the slip comes to 0 once in every period and goes on.
    """
    hoop = Hoop(k, r, mass_ratio)
    motion = simulate(Scene(hoop, SMOOTH, Release(phi0, omega0, slip0), Run(t_end=20.0)))
    listed = [(turn.t, turn.phi) for turn in motion.turns]
    listed += [(pulse.t_start, pulse.phi_start) for pulse in motion.pulses if pulse.t_start > 0]
    for t, phi in listed:
        assert motion.at(t).phi == pytest.approx(phi, abs=1e-9)
    energy = motion.at(np.linspace(0, motion.t_end, 200)).energy
    assert np.ptp(energy) < 1e-11 * energy[0]


@pytest.mark.parametrize("phi0", [0.0, pi])
@pytest.mark.parametrize("slip0", [1.0, -0.5])
def test_right_above_or_below_the_contact_a_hoop_slides_for_ever(phi0, slip0):
    """Nothing acts along a smooth floor, and nothing turns the hoop: x_C = v t, N = M g, however long."""
    scene = Scene(Hoop(0.6), SMOOTH, Release(phi0, 0.0, slip0), Run(t_end=1e5))
    motion = simulate(scene)
    assert motion.completed
    assert motion.t_end == 1e5
    states = motion.at(np.array([0.0, 1.0, 777.7, 1e5]))
    assert states.x_C == pytest.approx(slip0 * states.t, rel=1e-14)
    assert np.all(states.normal_force == 1)
    assert np.all(states.phi == phi0)
    for run in ({"turns": 3}, {"until": "rest"}, {"until": "pulse"}):
        ended = simulate(scene.replace(run=Run(**run)))
        assert ended.completed
        assert ended.ended.startswith("slides for ever")


@pytest.mark.parametrize(
    ("hoop", "phi0", "omega0"),
    [
        (Hoop(0.6892258359842568, 1.0, 0.1), -pi, 0.8291159957313206),
        (Hoop(0.7522816663411553, 1.0, 1.0), -pi, -0.4894890035500934),
        (Hoop(0.3139639303637802, 1.02, 1.0), 0.0, 0.8478472954053691),
        (Hoop(0.18076201989489357, 1.3, 0.0), 0.0, -0.8709023358764897),
        (Hoop(0.569986413771392, 1.3, 0.1), 0.0, 0.7497705631936926),
    ],
)
def test_a_slip_that_touches_0_is_one_phase_in_any_units(hoop, phi0, omega0):
    """Released without slip right above or below the contact, it is 0 there in every period, by round-off beyond or
    not. The motion, its mirror image and the same in other units have as many phases, each longer than round-off."""
    scene = Scene(hoop, SMOOTH, Release(phi0, omega0), Run(t_end=300.0))
    R, g = 0.3, 9.81
    units = {"R": R, "m": 0.7, "g": g}
    rate = {"omega0": omega0 * sqrt(g / R)}
    motions = [
        simulate(scene),
        simulate(scene.replace(release=Release(-phi0, -omega0))),
        simulate(scene.replace(hoop=units, release=rate, run={"t_end": 300.0 * sqrt(R / g)})),
    ]
    lasting = [[p for p in m.phases if p.t_end - p.t_start > 1e-12 * m.scene.time_unit] for m in motions]
    assert len({len(phases) for phases in lasting}) == 1
    for motion, phases in zip(motions, lasting, strict=True):
        assert min(p.t_end - p.t_start for p in phases) > 1e-3 * motion.scene.time_unit


@pytest.mark.parametrize("mass_ratio", [0.0, 0.1])
@pytest.mark.parametrize("mu_s", [0.0, 0.1, 0.3, 0.6, 9.0])
def test_what_slides_on_no_friction_or_rolls_loses_nothing(mu_s, mass_ratio):
    """Rolling held by mu_s, sliding on mu = 0: what rounding leaves of two energies is no loss, nor a gain."""
    scene = Scene(Hoop(0.1, 1.02, mass_ratio), Friction(mu_s, 0.0), Release(pi / 18), Run(turns=2))
    pulses = simulate(scene).pulses
    assert len(pulses) == 2
    assert [pulse.friction_loss for pulse in pulses] == [0.0, 0.0]


@pytest.mark.parametrize("phi0", [0.0, pi, -pi])
@pytest.mark.parametrize("omega0", [0.7, -0.7])
def test_what_turns_on_a_smooth_floor_rolls_for_no_time(phi0, omega0):
    """Released without slip where friction would have nothing to do, for that instant: it slips from there on."""
    motion = simulate(Scene(Hoop(0.3, 1.1), SMOOTH, Release(phi0, omega0), Run(t_end=0.05)))
    assert [(phase.kind, phase.t_start) for phase in motion.phases] == [(motion.phases[0].kind, 0.0)]
    # G keeps its velocity along the floor
    states, e, c = motion.at(0.05), motion.scene.hoop.e, np.cos(phi0)
    slip = omega0 * (1 + e * c) - states.omega * (1 + e * np.cos(states.phi))
    assert states.slip_velocity == pytest.approx(slip, rel=1e-9)
    assert (str(motion.phases[0].kind) == "skid") == (slip > 0)


@pytest.mark.parametrize(("k", "mass_ratio", "omega0"), [(0.9, 100.0, 5.0), (0.999, 0.0, -3.0), (0.5, 1e6, 8.0)])
def test_a_disk_next_to_the_centre_is_followed_turn_by_turn(k, mass_ratio, omega0):
    """Against phidot as the energy has it, (K + e^2 s^2) phidot^2/2 + e c, integrated over the time."""
    scene = Scene(Hoop(k, 1.0, mass_ratio), SMOOTH, Release(pi / 2, omega0, -omega0), Run(t_end=33.0))
    motion, e, gyr = simulate(scene), scene.hoop.e, scene.hoop.K
    assert e < 2e-3

    def omega(_, phi):
        energy = (gyr + e * e) * omega0**2 / 2 - e * np.cos(phi)
        return np.copysign(np.sqrt(2 * energy / (gyr + (e * np.sin(phi)) ** 2)), omega0)

    way = solve_ivp(omega, (0.0, 33.0), [pi / 2], rtol=1e-11, atol=1e-10, dense_output=True, method="DOP853")
    t = np.linspace(0, 33, 12)
    assert motion.at(t).phi == pytest.approx(way.sol(t)[0], abs=1e-7)
    assert motion.phases[-1].phi_end == pytest.approx(way.y[0, -1], abs=1e-7)
