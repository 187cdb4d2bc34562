"""The motion against independent integrations of the same equations: in time by scipy, over phi by mpmath.

In units R = g = M = 1 rolling obeys (1 + e^2 + K + 2 e c) phidd = e s (1 + w), slipping
D phidd = (e s + mu^ (1 + e c)) (1 - e c w) with D = K + e s (e s + mu^ (1 + e c)), w = phidot^2.
"""

from __future__ import annotations

from itertools import pairwise
from math import cos, radians, sin

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rigid import Friction, Hoop, Kind, Release, Run, Scene, simulate
from rigid.phases.rolling.closed_form import rolling_time


def right_hand_side(hoop, mu_hat):
    """d(phi, phidot, slip velocity)/dt in one phase; mu_hat None is rolling."""
    e, gyr = hoop.e, hoop.K

    def slope(_, y):
        phi, omega = y[:2]
        s, c = sin(phi), cos(phi)
        if mu_hat is None:
            return [omega, e * s * (1 + omega**2) / (1 + e * e + gyr + 2 * e * c), 0.0]
        arm = e * s + mu_hat * (1 + e * c)
        normal = gyr * (1 - e * c * omega**2) / (gyr + e * s * arm)
        alpha = arm * normal / gyr
        return [omega, alpha, -mu_hat * normal + e * s * omega**2 - (1 + e * c) * alpha]

    return slope


SCENES = {
    "section 3.1": (Hoop(0.1), Friction(0.35, 0.3), Release(radians(10))),
    "section 3.3, m_h/m = 0.1": (Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(radians(10))),
    "half disk": (Hoop(0.5, 1.1, 0.3), Friction(0.2, 0.1), Release(radians(40), 0.3, 0.1)),
    "released skidding backwards": (Hoop(0.3, 1.0, 0.05), Friction(0.6, 0.5), Release(2.0, -1.0, -0.4)),
}


@pytest.mark.parametrize("name", SCENES)
def test_each_phase_against_integration_in_time(name):
    """From the state at the start of a phase, DOP853 at rtol 1e-13 arrives at the state at its end.

    Its global error over a phase is some 1e-12 of the state; conditioning near the pulse costs a decade or two.
    """
    motion = simulate(Scene(*SCENES[name], run=Run(turns=4)))
    mu = motion.scene.friction.mu
    hats = {Kind.ROLL: None, Kind.SKID: mu, Kind.SPIN: -mu}
    assert len(motion.phases) >= 2
    for phase in motion.phases:
        eps = 1e-9 * (phase.t_end - phase.t_start)
        start, end = motion.at(phase.t_start), motion.at(phase.t_end - eps)
        span = (phase.t_start, phase.t_end - eps)
        y0 = [float(start.phi), float(start.omega), float(start.slip_velocity)]
        run = solve_ivp(
            right_hand_side(motion.scene.hoop, hats[phase.kind]), span, y0, "DOP853", rtol=1e-13, atol=1e-14
        )
        ours = np.array([end.phi, end.omega, end.slip_velocity])
        assert np.abs(run.y[:, -1] - ours) / np.maximum(1, np.abs(ours)) == pytest.approx(0, abs=2e-11)


@pytest.mark.parametrize("k", [0.1, 1e-3, 1e-5, 1e-8])
def test_slip_against_its_closed_form(k):
    """phidot at the end of the first spin from its closed form with one quadrature, at 40 digits.

    w = [D0 w0 + 2 int P E dphi]/(D E), E = exp(mu^ e int (e + c)/D dphi), the inner integral in closed form from the
    four roots of q(u) = K (1 + u^2)^2 + 2 e u [mu^ (1 - e) u^2 + 2 e u + mu^ (1 + e)], u = tan(phi/2).
    """
    motion = simulate(Scene(Hoop(k), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1)))
    spin = motion.phases[1]
    assert spin.kind == Kind.SPIN
    mp = mpmath.mp
    with mpmath.workdps(50):
        kk = mp.mpf(k)
        e, gyr, mu = 1 - kk, kk * kk / 2, -mp.mpf(0.3)
        roots = mpmath.polyroots(
            [gyr, 2 * e * mu * (1 + e), 2 * gyr + 4 * e * e, 2 * e * mu * (1 - e), gyr],
            asc=True,
            maxsteps=500,
            extraprec=400,
        )

        def d(x):
            return gyr + e * mp.sin(x) * (e * mp.sin(x) + mu * (1 + e * mp.cos(x)))

        # (e + c)/D dphi = 2 [(e + 1) + (e - 1) u^2]/q(u) du, in partial fractions
        weights = []
        for i, root in enumerate(roots):
            others = mp.mpf(1)
            for j, other in enumerate(roots):
                if j != i:
                    others *= root - other
            weights.append(2 * ((e + 1) + (e - 1) * root**2) / (gyr * others))

        def log_e(x):
            u = mp.tan(x / 2)
            return mu * e * mp.re(mp.fsum(a * mp.log(u - root) for a, root in zip(weights, roots, strict=True)))

        start, end = mp.mpf(spin.phi_start), mp.mpf(spin.phi_end)
        # stay below phi = pi, where u is infinite: compare where the sweep is still short of the bottom
        state = motion.at(spin.t_start + 0.9 * (spin.t_end - spin.t_start))
        assert float(state.phi) < 3.1
        end = mp.mpf(float(state.phi))
        w0 = mp.mpf(float(motion.at(spin.t_start).omega)) ** 2
        zero = log_e(start)
        integral = mp.quad(
            lambda x: (e * mp.sin(x) + mu * (1 + e * mp.cos(x))) * mp.exp(log_e(x) - zero),
            mp.linspace(start, end, 8),
        )
        w = (d(start) * w0 + 2 * integral) / (d(end) * mp.exp(log_e(end) - zero))
        exact = float(mp.sqrt(w))
    # the branch of the logarithms is the same along u > 0: no root is real and positive there
    assert float(state.omega) == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize("k", [0.7, 0.1, 1e-4, 1e-8])
def test_rolling_time_against_quadrature(k):
    """The elliptic time from the bottom to the turn, and to an angle before it, against mpmath at 30 digits."""
    phi0 = 2.0
    with mpmath.workdps(30):
        kk = mpmath.mpf(k)
        e, gyr = 1 - kk, kk * kk / 2
        zeta = (gyr + kk * kk) / e
        amplitude = mpmath.cos(mpmath.mpf(phi0) / 2)

        def rate(u):
            x = amplitude * mpmath.sin(u)
            return mpmath.sqrt(zeta + 4 * x * x) / mpmath.sqrt(1 - x * x)

        cuts = sorted({mpmath.mpf(0), kk / 100, kk, mpmath.sqrt(kk), mpmath.pi / 4, mpmath.pi / 2})
        whole = float(mpmath.quad(rate, cuts))
        part = float(mpmath.quad(rate, [cut for cut in cuts if cut <= mpmath.pi / 4]))
        height = [float(2 * (amplitude * mpmath.sin(u)) ** 2) for u in (mpmath.pi / 2, mpmath.pi / 4)]
        rest = float(height[0] - 2 * (amplitude * mpmath.sin(mpmath.pi / 4)) ** 2)
    g = height[0]
    assert rolling_time(float(zeta), g, g, 2 - g, 0.0) == pytest.approx(whole, rel=2e-15)
    assert rolling_time(float(zeta), g, height[1], 2 - height[1], rest) == pytest.approx(part, rel=2e-15)


def test_impulses_against_quadrature():
    """The momentum identities give the same impulses as the integrals of N and F."""
    motion = simulate(Scene(*SCENES["section 3.1"], run=Run(turns=2)))
    nodes, weights = np.polynomial.legendre.leggauss(40)
    assert motion.pulses
    for pulse in motion.pulses:
        edges = {pulse.t_start, pulse.t_end}
        edges |= {p.t_start for p in motion.phases if pulse.t_start < p.t_start < pulse.t_end}
        edges |= set(np.linspace(pulse.t_start, pulse.t_end, 30))
        normal = friction = loss = 0.0
        for a, b in zip(sorted(edges), sorted(edges)[1:], strict=False):
            states = motion.at(0.5 * (a + b) + 0.5 * (b - a) * nodes)
            weight = 0.5 * (b - a) * weights
            normal += weight @ states.normal_force
            friction += weight @ states.friction_force
            loss += weight @ np.abs(states.friction_force * states.slip_velocity)
        assert normal == pytest.approx(pulse.normal_impulse, rel=1e-11)
        assert friction == pytest.approx(pulse.friction_impulse, rel=1e-10)
        assert loss == pytest.approx(pulse.friction_loss, rel=1e-10)


@pytest.mark.parametrize("name", ["section 3.1", "section 3.3, m_h/m = 0.1"])
def test_restitutions_against_quadrature(name):
    """Newton's by ydot_G = -e sin(phi) phidot; Poisson's and Stronge's by integrals of N and N ydot_G to its zero and
    from there.
    """
    motion = simulate(Scene(*SCENES[name], run=Run(turns=2)))
    e = motion.scene.hoop.e
    nodes, weights = np.polynomial.legendre.leggauss(40)

    def taken(start, end):
        """Impulse and work of N."""
        edges = {start, end, *(p.t_start for p in motion.phases if start < p.t_start < end)}
        edges = sorted(edges | set(np.linspace(start, end, 30)))
        total = np.zeros(2)
        for a, b in pairwise(edges):
            now = motion.at((a + b) / 2 + (b - a) / 2 * nodes)
            up = -e * np.sin(now.phi) * now.omega
            total += (b - a) / 2 * np.array([weights @ now.normal_force, weights @ (now.normal_force * up)])
        return total

    for pulse in motion.pulses:
        turned = brentq(lambda t: float(np.sin(motion.at(t).phi)), pulse.t_start, pulse.t_end, xtol=1e-15)
        (into, absorbed), (out, returned) = taken(pulse.t_start, turned), taken(turned, pulse.t_end)
        ends = motion.at(np.array([pulse.t_start, pulse.t_end]))
        before, behind = -e * np.sin(ends.phi) * ends.omega
        assert pulse.newton_restitution == pytest.approx(-behind / before, rel=1e-10)
        assert pulse.poisson_restitution == pytest.approx(out / into, rel=1e-9)
        assert pulse.energetic_restitution == pytest.approx((-returned / absorbed) ** 0.5, rel=1e-9)
