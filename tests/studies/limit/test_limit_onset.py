"""The start of a slip under laws without a jump there, against the rigid hoop on the law's own steady creep.

That law, F/N as a function of v/eps (or v/v_s), takes the place of the patch: it holds as long as nothing happens
within a passage of the patch, and at eps = 1e-8 and 1e-9 the powers of eps in it are told apart.
"""

from __future__ import annotations

from math import copysign, radians, sqrt

import pytest
from scipy.integrate import solve_ivp

from rigid import Contact, Friction, Hoop, Release, Scene
from studies.inner.creep import creep, half_width
from studies.inner.events import START, Stretch, passage
from studies.inner.march.body import accelerations, rolling_forces, sliding_force
from studies.limit.onset import brush_delay, brush_lag, regularised_gain
from studies.limit.outer import slide_along


@pytest.mark.slow
def test_a_brush_breaks_late_by_the_two_thirds_power():
    contact = Contact(law="brush")
    way = passage(Scene(Hoop(0.1, 1.02, 0.01), Friction(0.35, 0.3), Release(radians(10)), contact=contact))
    body, scaled = way.body, way.contact
    event = next(event for event in way.events if event.kind == START)
    sigma = copysign(1.0, event.behind)
    first, last = event.psi - 0.02, event.psi + 0.02

    def pull(slip: float, normal: float, omega: float) -> float:
        b = 1 + scaled.kappa * sigma * slip / (scaled.mu_s * half_width(normal) * omega)
        b = min(max(b, 0.0), 1.0)
        return sigma * (3 * scaled.mu_s * (b**2 - b**3) + scaled.mu * (1 - 3 * b**2 + 2 * b**3))

    def rates(psi: float, w: float, share) -> list[float]:
        omega = sqrt(w)
        normal = rolling_forces(body, psi, omega)[0]
        for _ in range(40):  # N and the width of the patch, which decides on F/N, together
            before, normal = normal, sliding_force(body, psi, omega, share(normal, omega))
            if abs(normal - before) < 1e-14 * normal:
                break
        alpha, _, slipping = accelerations(*body, psi, omega, normal, share(normal, omega) * normal)
        return [2 * alpha, slipping / omega]

    def rolling(psi: float, y) -> list[float]:
        return [2 * rolling_forces(body, psi, sqrt(y[0]))[2]]

    w = solve_ivp(rolling, (event.psi, first), [event.omega**2], "DOP853", rtol=1e-12).y[0, -1]
    normal, friction, _ = rolling_forces(body, first, sqrt(w))
    slow = creep(scaled, normal, friction, sqrt(w)).slip
    rigid = solve_ivp(
        lambda psi, y: rates(psi, y[0], lambda n, o: event.behind), (event.psi, last), [event.omega**2, 0.0],
        "DOP853", rtol=1e-12, atol=1e-14,
    ).y[1, -1]  # fmt: skip

    def behind(eps: float) -> float:
        found = solve_ivp(
            lambda psi, y: rates(psi, y[0], lambda n, o: pull(y[1] / eps, n, o)), (first, last), [w, eps * slow],
            "Radau", rtol=1e-9, atol=[1e-12, 1e-11 * eps],
        )  # fmt: skip
        return found.y[1, -1] - rigid

    # d = c eps^(2/3) + c_1 eps
    stiff, stiffer = (behind(eps) / eps for eps in (1e-8, 1e-9))
    observed = (stiff - stiffer) / (1e-8 ** (-1 / 3) - 1e-9 ** (-1 / 3))
    delay = brush_delay(body, scaled, event, way.scene.friction.mu_s)
    shift, _ = slide_along(body, Stretch(event.psi, last, event.omega, event.behind), delay)
    # the next powers, eps^(4/3) and eps log eps, are some hundredths
    assert observed == pytest.approx(shift.slip, rel=0.03)


REACH = 0.01
"""Angle before and behind the start of a slip."""


def starting(law: str):
    """A hoop whose slip starts on its way, mu_s = mu, and where that is."""
    contact = Contact(law=law)
    way = passage(Scene(Hoop(0.1, 1.02, 0.01), Friction(0.3, 0.3), Release(radians(10)), contact=contact))
    return way.body, way.contact, next(event for event in way.events if event.kind == START)


def rolled_to(body, event, psi: float) -> tuple[float, float, float]:
    """(phidot^2, N, F) where the hoop rolls, on the way through the event."""
    w = solve_ivp(
        lambda at, y: [2 * rolling_forces(body, at, sqrt(y[0]))[2]], (event.psi, psi), [event.omega**2], rtol=1e-12
    ).y[0, -1]
    return float(w), *rolling_forces(body, psi, sqrt(w))[:2]


def slip_behind_start(body, event, pull, slow: float, scale: float) -> float:
    """v at ``REACH`` behind the start of a slip, less the rigid hoop's, under F/N = ``pull(v, N, phidot)``.

    From as much before it, where the hoop rolls but for ``slow``; what is marched are phidot^2 and v, over psi.
    """
    first, last = event.psi - REACH, event.psi + REACH

    def rates(psi: float, y, share) -> list[float]:
        omega = sqrt(y[0])
        normal = rolling_forces(body, psi, omega)[0]
        for _ in range(40):  # N and the share that depends on it, together
            before, normal = normal, sliding_force(body, psi, omega, share(y[1], normal, omega))
            if abs(normal - before) < 1e-14 * normal:
                break
        alpha, _, slipping = accelerations(*body, psi, omega, normal, share(y[1], normal, omega) * normal)
        return [2 * alpha, slipping / omega]

    rigid = solve_ivp(
        lambda psi, y: rates(psi, y, lambda *_: event.behind), (event.psi, last), [event.omega**2, 0.0],
        rtol=1e-12, atol=1e-14,
    ).y[1, -1]  # fmt: skip
    found = solve_ivp(
        lambda psi, y: rates(psi, y, pull), (first, last), [rolled_to(body, event, first)[0], slow], "Radau",
        rtol=1e-7, atol=[1e-12, 1e-8 * scale],
    )  # fmt: skip
    return float(found.y[1, -1] - rigid)


def test_a_regularised_slip_runs_ahead_by_the_four_fifths_power():
    """d = c v_s^(4/5) + c_1 v_s; the next power is eps^(6/5)."""
    body, scaled, event = starting("regularised")
    _, normal, friction = rolled_to(body, event, event.psi - REACH)
    used = friction / (scaled.mu * normal)
    off = []
    for v_s in (1e-8, 1e-9):

        def pull(slip: float, normal: float, omega: float, v_s: float = v_s) -> float:
            return -scaled.mu * slip / sqrt(slip**2 + v_s**2)

        off.append(slip_behind_start(body, event, pull, -v_s * used / sqrt(1 - used**2), v_s) / v_s)
    observed = (off[0] - off[1]) / (1e-8 ** (-1 / 5) - 1e-9 ** (-1 / 5))
    gain = regularised_gain(body, scaled, event)
    shift, _ = slide_along(body, Stretch(event.psi, event.psi + REACH, event.omega, event.behind), gain)
    assert observed == pytest.approx(shift.slip, rel=0.03)


def test_a_brush_lags_by_the_six_fifths_power():
    """mu_s = mu: d = c_1 eps + c eps^(6/5); the next power is eps^(7/5)."""
    body, scaled, event = starting("brush")
    sigma = copysign(1.0, event.behind)
    w, normal, friction = rolled_to(body, event, event.psi - REACH)
    slow = creep(scaled, normal, friction, sqrt(w)).slip
    off = []
    for eps in (1e-8, 1e-9):

        def pull(slip: float, normal: float, omega: float, eps: float = eps) -> float:
            b = 1 + scaled.kappa * sigma * slip / eps / (scaled.mu * half_width(normal) * omega)
            return sigma * scaled.mu * (1 - min(max(b, 0.0), 1.0) ** 3)

        off.append(slip_behind_start(body, event, pull, eps * slow, eps) / eps)
    observed = (off[0] - off[1]) / (1e-8 ** (1 / 5) - 1e-9 ** (1 / 5))
    lag = brush_lag(body, scaled, event)
    shift, _ = slide_along(body, Stretch(event.psi, event.psi + REACH, event.omega, event.behind), lag)
    assert observed == pytest.approx(shift.slip, rel=0.05)
