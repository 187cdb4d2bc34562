"""The exit of a jam, D -> 0+, against a floor that gives way, of growing stiffness (README.md of ``rigid``).

The compliant floor is integrated here by itself: penetration d, N = kappa d, F = -mu N while the contact point skids,
R = g = M = 1. Rigid contact is kappa -> infinity. Near D = 0 the penetration obeys d'' = -kappa D d/K with D falling
through zero linearly in time, so the transition takes a time ~ kappa^(-1/3): the result has a series in kappa^(-1/3).
"""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rigid import Friction, Hoop, Kind, Release, Run, Scene, simulate, simulate_batch


def skid_on_compliant_floor(hoop, mu, release, kappa):
    """phidot where the skid stops on a floor of stiffness kappa, from quasi-static equilibrium."""
    e, gyr, root = hoop.e, hoop.K, sqrt(kappa)

    def slope(_, y):
        phi, omega, _, normal, sink = y  # sink: rate of penetration times sqrt(kappa)
        s, c = sin(phi), cos(phi)
        alpha = (e * s + mu * (1 + e * c)) * normal / gyr
        return [omega, alpha, -mu * normal, root * sink, root * (1 - normal - e * s * alpha - e * c * omega**2)]

    def slip(_, y):
        return y[2] - y[1] * (1 + e * cos(y[0]))

    def off(_, y):
        return y[3]

    slip.terminal = off.terminal = True
    s, c = sin(release.phi0), cos(release.phi0)
    d = gyr + e * s * (e * s + mu * (1 + e * c))
    start = [
        release.phi0,
        release.omega0,
        release.slip0 + release.omega0 * (1 + e * c),
        gyr * (1 - e * c * release.omega0**2) / d,
        0.0,
    ]
    # an error of 1e-9 per step, some 1e4 steps; the differences that are extrapolated are 1e-2 and more
    run = solve_ivp(slope, (0, 1), start, "LSODA", rtol=1e-9, atol=1e-10, events=(slip, off))
    assert len(run.t_events[0]) == 1, "it skids until the slip stops, pressed to the floor"
    return run.y[1, -1]


def extrapolated(stiffnesses, values):
    """Limit of a series in kappa^(-1/3), as many terms as values."""
    powers = [[kappa ** (-j / 3) for j in range(len(values))] for kappa in stiffnesses]
    return float(np.linalg.solve(powers, values)[0])


SOFT = (3e6, 3e7, 3e8, 3e9)
JAMS = {
    # skid with c > 0 and omega s < 0: D decays 96 times faster than b, N -> infinity on the way to b = D = 0
    "leaves with b < 0": (Hoop(0.1), 0.5, Release(radians(-60), 1.0, 2.0)),
    # c < 0: N speeds the rotation up through zero and past the speed it came with, turned round
    "reverses": (Hoop(0.05, 2.0), 0.45, Release(pi + 0.666, -2.0, 5.0)),
    "stops before it reverses": (Hoop(0.05, 2.0), 0.45, Release(pi + 0.666, -2.0, 1.5)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", JAMS)
def test_limit_of_a_stiff_floor(name):
    """The rigid skid slides on to v = 0 with the configuration frozen, as ever stiffer floors do."""
    hoop, mu, release = JAMS[name]
    motion = simulate(Scene(hoop, Friction(mu, mu), release, Run(t_end=1.0)))
    assert motion.phases[0].kind == Kind.SKID
    assert motion.phases[1].kind == Kind.IMPACT
    state = motion.at(motion.phases[0].t_end)
    ours = float(state.omega)
    if name == "leaves with b < 0":
        assert 1 - hoop.e * cos(state.phi) * ours**2 < 0
        assert motion.phases[2].kind == Kind.FLIGHT
    if name == "reverses":
        assert ours > -release.omega0
    values = [skid_on_compliant_floor(hoop, mu, release, kappa) for kappa in SOFT]
    distance = np.abs(np.array(values) - ours)
    assert (np.diff(distance) < 0).all()
    # the softest floor's part in the extrapolation is its error, but for a factor; other exits (at b = 0, or where a
    # strict solution would turn round) lie ten times as far off as the stiffest floor
    limit, before = extrapolated(SOFT, values), extrapolated(SOFT[1:], values[1:])
    allowed = 3 * abs(limit - before)
    assert allowed < 0.2 * distance[-1]
    assert abs(ours - limit) < allowed


def test_where_b_decays_faster_than_d_the_hoop_lifts_off():
    """rho = e^2 s^2 (c - mu^ s)/(2 c K) - 1/2 below 1, c > 0, omega s < 0: N stays finite, b reaches 0 before D.

    The ratio of the two decay rates at b = D = 0 (README.md); half a disk has such a place, where rho = 0.61.
    """
    hoop, mu, release = Hoop(0.5), 0.548, Release(radians(-58), 1.5, 20.0)
    motion = simulate(Scene(hoop, Friction(mu, mu), release, Run(t_end=5.0)))
    skid = motion.phases[0]
    assert skid.kind == Kind.SKID
    assert motion.phases[1].kind == Kind.FLIGHT
    state = motion.at(skid.t_end)
    assert hoop.e * cos(state.phi) * float(state.omega) ** 2 == pytest.approx(1, abs=1e-9)
    e, s, c = hoop.e, sin(state.phi), cos(state.phi)
    assert 0 < (hoop.K + e * s * (e * s + mu * (1 + e * c))) / hoop.K < 0.01, "on the brink of a jam"
    assert 0 < (e * s) ** 2 * (c - mu * s) / (2 * c * hoop.K) - 0.5 < 1
    normal = motion.at(skid.t_end * np.linspace(0, 1, 50)).normal_force
    assert np.diff(normal).max() < 0, "N falls all the way to 0, where D -> 0 alone would make it grow"


def test_a_pulse_that_jams_has_no_largest_force():
    """N = K b/D with D -> 0: the peak is infinite in a motion and in a batch; not if it jams at release, before its
    pulse.
    """
    jams = Scene(Hoop(0.0432, 1.52), Friction(0.538, 0.481), Release(phi0_deg=102.6, omega0=3.85, slip0=-2.41))
    # a skid released where D < 0 (Painleve)
    hoop, mu, phi = Hoop(0.1), 0.9, radians(-60)
    e, gyr, s, c = hoop.e, hoop.K, sin(phi), cos(phi)
    assert gyr + e * s * (e * s + mu * (1 + e * c)) < 0
    before = Scene(hoop, Friction(mu, mu), Release(phi, 0.0, 0.5))
    for scene, peak_is_bounded in ((jams, False), (before, True)):
        motion = simulate(scene.replace(run=Run(turns=2)))
        pulse = next(pulse for pulse in motion.pulses if not pulse.cut)
        assert np.isfinite(pulse.peak_normal_force) == peak_is_bounded
        assert np.isfinite(list(pulse.to_dict().values())).all() == peak_is_bounded
        assert motion.phases[0 if peak_is_bounded else 1].kind == Kind.IMPACT
        assert str(motion)
        batch = simulate_batch([scene], turns=2, pulses=len(motion.pulses))
        assert batch.peak_normal_force[0].tolist() == [pulse.peak_normal_force for pulse in motion.pulses]
        assert np.isinf(batch.to_dataframe()["peak_normal_force"]).any() != peak_is_bounded
