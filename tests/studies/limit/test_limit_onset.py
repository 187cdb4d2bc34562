"""The start of a slip under a brush with mu_s > mu, against the rigid hoop on the brush's own law of steady creep.

That law, F/N as a function of v/eps, takes the place of the patch: it holds as long as nothing happens within a passage
of the patch, and at eps = 1e-8 and 1e-9 the powers of eps in it are told apart.
"""

from __future__ import annotations

from math import copysign, radians, sqrt

import pytest
from scipy.integrate import solve_ivp

from rigid import Contact, Friction, Hoop, Release, Scene
from studies.inner.body import accelerations, rolling_forces, sliding_force
from studies.inner.creep import creep, half_width
from studies.inner.events import START, Stretch, passage
from studies.limit.onset import brush_delay
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
