"""Where N is next to nothing: no last digit of it makes or ends a phase, and hops without loss are counted on."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rigid import Aloft, Friction, Hoop, Kind, Landing, Release, Run, Scene, simulate

MIRROR = {Kind.SKID: Kind.SPIN, Kind.SPIN: Kind.SKID}
#: on a hoop that is all but even, too rough to slip before N of its whirl is a thousandth of the weight
WHIRL = Scene(
    Hoop(0.99, 1.0284448231394232, 1.890018455859946), Friction(1416.328813568469, 1416.328813568469),
    Release(-1.836046560289249, 20.0, -0.2598241012992317), Run(t_end=0.5),
)  # fmt: skip
#: a tiny disk set moving on top, where cos phi phidot^2 = 1 is the edge of lift-off, on the roughest of floors
FALL = Scene(Hoop(5.05e-5, 1.0000047), Friction(12829.0, 6815.4), Release(0.0, 1.0, 7.76e-5), Run(turns=4))


def mirrored(scene):
    release = scene.release
    return scene.replace(release=Release(-release.phi0, -release.omega0, -release.slip0))


@pytest.mark.parametrize("scene", [WHIRL, FALL], ids=["whirl", "fall"])
def test_the_mirror_image_goes_through_the_same_phases(scene):
    motion, image = simulate(scene), simulate(mirrored(scene))
    assert motion.completed
    assert image.completed
    first, second = motion.phases[:6], image.phases[:6]
    assert [MIRROR.get(phase.kind, phase.kind) for phase in second] == [phase.kind for phase in first]
    # 1e-12 of round-off, which the tiny disk's pass over the bottom multiplies by no more than 1/k
    for name, sign in (("t_end", 1), ("phi_end", -1)):
        ends = [[factor * getattr(p, name) for p in of] for of, factor in ((first, 1), (second, sign))]
        assert ends[1] == pytest.approx(ends[0], rel=1e-12 / scene.hoop.k)


def test_a_slip_begins_where_n_is_a_thousandth_of_the_weight():
    """With mu_s = mu it begins without acceleration, to the round-off of 1 - e c phidot^2 and not of its value: no less
    than the whole slip is there, to where the equations of motion of a slip, integrated, lift off.
    """
    e, gyr, mu = WHIRL.hoop.e, WHIRL.hoop.K, WHIRL.friction.mu
    motion = simulate(WHIRL)
    assert [phase.kind for phase in motion.phases[1:4]] == [Kind.ROLL, Kind.SPIN, Kind.FLIGHT]
    slip = motion.phases[2]
    start = motion.at(slip.t_start, side="left")
    # the roll ends where all of the friction is used
    assert float(start.friction_force) == pytest.approx(mu * float(start.normal_force), rel=1e-9)

    def rates(_, state):
        """Spinning, F = mu N: N from the contact point that stays on the floor, y'' = N - 1 + e (s phi')' = 0."""
        phi, omega = state
        s, c = sin(phi), cos(phi)
        # K omega' = N e s - F (1 + e c), and N - 1 + e s omega' + e c omega^2 = 0
        turn = (e * s - mu * (1 + e * c)) / gyr
        normal = (1 - e * c * omega * omega) / (1 + e * s * turn)
        return [omega, normal * turn]

    def lifts(_, state):
        return 1 - e * cos(state[0]) * state[1] ** 2

    lifts.terminal = True
    found = solve_ivp(
        rates, (0.0, 1.0), [float(start.phi), float(start.omega)], method="Radau", rtol=1e-11, atol=1e-13, events=lifts
    )
    # N comes down from 1e-3 in 8e-5: rtol of its terms, which are of the order 1, is 1e-8 of that time
    assert found.t_events[0][0] == pytest.approx(slip.t_end - slip.t_start, rel=1e-6)
    assert found.y[0, -1] == pytest.approx(slip.phi_end, abs=1e-9)


def test_a_disk_that_falls_from_the_top_is_not_thrown_up():
    """Where 1 - e c phidot^2 = 0 it grows by e s phidot^3: a skid that comes down from the top cannot lift off. So N,
    of the order of K over what it takes to turn the hoop, stays above 0, and the disk falls as a free one.
    """
    motion = simulate(FALL)
    first = motion.phases[0]
    assert first.kind is Kind.SKID
    assert first.phi_end > 0.99 * pi  # to where its skid can stop, next to the floor
    states = motion.at(np.linspace(0, 0.9 * first.t_end, 50))
    assert (states.normal_force >= 0).all()
    # what is not free is the disk's own size, k
    fallen = FALL.hoop.e * (1 - np.cos(states.phi))
    assert fallen == pytest.approx(states.t**2 / 2, abs=10 * FALL.hoop.k)
    assert (fallen <= states.t**2 / 2 + 1e-12).all()


def test_thousands_of_hops_without_loss():
    """A hoop let fall on a smooth floor that gives all back: energy and the place of G stay, however often it lands."""
    scene = Scene(Hoop(0.99, 1.146, 1.525), Friction(0, 0), Release(pi / 2), Run(t_end=80.0), landing=Landing(1.0))
    motion = simulate(scene, Aloft(2e-5))
    assert motion.completed
    landings = sum(phase.kind is Kind.IMPACT for phase in motion.phases)
    assert landings > 2500
    states = motion.at(np.linspace(0, motion.t_end, 50))
    # round-off of each landing
    assert np.ptp(states.energy) < 1e-15 * landings
    assert np.ptp(states.x_C + scene.hoop.e * np.sin(states.phi)) < 1e-15 * landings
