"""Scenes over everything a user can type, from one point of a Sobol sequence each."""

from __future__ import annotations

from collections.abc import Iterator
from math import log10, pi, radians

from rigid import Contact, Friction, Hoop, Landing, Release, Ring, Run, Scene, Solve
from rigid.elastic import LAWS, TIGHTEST

THIN = 1.001  # r; a thinner wall is refused (flexible.ring.possible.THINNEST)
RIGID_NUMBERS, HOSTILE_NUMBERS, FLEXIBLE_NUMBERS, SOFT_NUMBERS = 10, 8, 14, 9


def sobol(count: int, numbers: int, seed: int) -> list[list[float]]:
    """Quasi-random points in the unit cube."""
    import warnings

    from scipy.stats import qmc

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that the count is no power of two
        points: list[list[float]] = qmc.Sobol(numbers, rng=seed).random(count).tolist()
    return points


def _beyond(x: float, share: float) -> float | None:
    """``x`` spread anew over (0, 1) beyond a share of it, None within the share."""
    return None if x < share else (x - share) / (1 - share)


def _power(x: float, low: float, high: float) -> float:
    """From ``low`` to ``high``, even in the logarithm."""
    return float(10 ** (log10(low) + x * (log10(high) - log10(low))))


def rigid_scene(x: list[float]) -> Scene:
    """k 1e-8 to 0.95, r 1 to 2, m_h/m 0 to 100, mu 0 to 3, mu_s/mu 1 to 5, any angle, omega0 within 5, any slip."""
    share = _beyond(x[0], 0.7)
    k = _power(x[0] / 0.7, 1e-8, 0.95) if share is None else max(0.95 * share, 1e-8)
    share = _beyond(x[1], 0.3)
    r = 1.0 if share is None else 1 + share
    share = _beyond(x[2], 0.3)
    mass = 0.0 if share is None else _power(share, 1e-4, 100)
    share = _beyond(x[3], 0.05)
    mu = 0.0 if share is None else 3 * share**2
    share = _beyond(x[4], 0.1)
    mu_s = mu * (1.0 if share is None else 1 + 4 * share) if mu else x[4]
    share = _beyond(x[6], 0.3)
    omega = 0.0 if share is None else 10 * share - 5
    share = _beyond(x[7], 0.4)
    slip = 0.0 if share is None else 4 * share - 2
    share = _beyond(x[8], 0.3)
    bounce = 0.0 if share is None else share
    runs = (Run(turns=2), Run(turns=4), Run(until="rest"), Run(until="pulse"), Run(t_end=20.0))
    return Scene(
        Hoop(k, r, mass),
        Friction(mu_s, mu),
        Release(3 * pi * x[5] - pi, omega, slip),
        runs[min(int(5 * x[9]), 4)],
        Landing(bounce),
    )


def flexible_scene(x: list[float]) -> Scene:
    """An elastic hoop within the range of its model, through its first pulse.

    k 0.01 to 0.9, r 1.001 to 1.5, m_h/m 0 to 1, mu 0.05 to 1, mu_s/mu 1 to 2, released at 2 to 60 degrees or moving;
    foundation 1e6 to 1e13, where the weight sinks in by less than 1e-3 R or so; bending from 13/k, ten times that from
    which on the wall does not give way inside the pulse, to 1e4 times as much; 48 to 480 elements, tolerance 1e-2 to
    1e-5, damping 0 to 2.
    """
    mu = _power(x[3], 0.05, 1.0)
    k = _power(x[0], 0.01, 0.9)
    mass = _beyond(x[2], 0.3)
    omega, damping = _beyond(x[6], 0.6), _beyond(x[10], 0.3)
    return Scene(
        Hoop(k, max(1.0 + 0.5 * x[1] ** 2, THIN), 0.0 if mass is None else _power(mass, 1e-3, 1.0)),
        Friction(mu * (1.0 + (_beyond(x[4], 0.2) or 0.0)), mu),
        Release(radians(2 + 58 * x[5]), 0.0 if omega is None else 2 * omega),
        Run(until="pulse"),
        ring=Ring(bending_stiffness=_power(x[7], 13 / k, 13e4 / k)),
        contact=Contact(
            LAWS[min(int(x[9] * len(LAWS)), len(LAWS) - 1)],
            stiffness=_power(x[8], 1e6, 1e13),
            damping=0.0 if damping is None else 2 * damping,
        ),
        solve=Solve(
            level="reduced",
            resolve="pulses" if x[13] < 0.9 else "all",
            rtol=_power(x[11] ** 2, 1e-2, 1e-5),
            elements=int(_power(x[12] ** 2, 48, 480)),
        ),
    )


def soft_scene(x: list[float]) -> Scene:
    """A damped hoop of any stiffness through its first pulse, at the default level and tolerance.

    k 0.03 to 0.6, r 1.001 to 1.2, m_h/m 0 to 0.3, mu 0.05 to 0.8, mu_s/mu 1 to 1.5, at rest at 2 to 60 degrees;
    foundation 1e6 to 1e12, bending 1 to 1e7, the two laws that stick.
    """
    mu, mass = _power(x[3], 0.05, 0.8), _beyond(x[2], 0.2)
    return Scene(
        Hoop(_power(x[0], 0.03, 0.6), max(1.0 + 0.2 * x[1], THIN), 0.0 if mass is None else 0.3 * mass),
        Friction(mu * (1.0 + 0.5 * x[4]), mu),
        Release(radians(2 + 58 * x[5])),
        Run(until="pulse"),
        ring=Ring(bending_stiffness=_power(x[6], 1.0, 1e7)),
        contact=Contact(LAWS[x[8] >= 0.5], stiffness=_power(x[7], 1e6, 1e12), damping=1.0),
    )


def hostile_scene(x: list[float], y: list[float]) -> Scene:
    """What a user can type, range of the model or not, for the elastic ring, to the first pulse or a moment in time.

    Bending 1e1 to 1e8, foundation 1e1 to 1e14 (no softer than a hoop can stand on), 24 to 960 elements, tolerance 1e-2
    to 1e-8, damping 0 to 2.
    """
    base = rigid_scene(x)
    share = _beyond(y[4], 0.3)
    tolerance = max(_power(y[3] ** 3, 1e-2, 1e-10), TIGHTEST)  # the sharp ones are dear, so they are fewer
    return base.replace(
        run=Run(until="pulse") if y[5] < 0.7 else Run(t_end=0.5 + 2 * x[9]),
        ring=Ring(bending_stiffness=_power(y[0], 1e1, 1e8)),
        contact=Contact(
            LAWS[min(int(y[6] * len(LAWS)), len(LAWS) - 1)],
            stiffness=max(_power(y[1], 1e1, 1e14), 2 * (1 + base.hoop.mass_ratio)),
            damping=0.0 if share is None else 2 * share,
        ),
        solve=Solve(
            level="reduced",
            resolve="pulses" if y[7] < 0.7 else "all",
            rtol=tolerance,
            elements=int(_power(y[2] ** 2, 24, 960)),
        ),
    )


def rigid_scenes(count: int, seed: int) -> Iterator[Scene]:
    """A seeded sequence."""
    return map(rigid_scene, sobol(count, RIGID_NUMBERS, seed))


def flexible_scenes(count: int, seed: int) -> Iterator[Scene]:
    """A seeded sequence."""
    return map(flexible_scene, sobol(count, FLEXIBLE_NUMBERS, seed))


def soft_scenes(count: int, seed: int) -> Iterator[Scene]:
    """A seeded sequence."""
    return map(soft_scene, sobol(count, SOFT_NUMBERS, seed))


def hostile_scenes(count: int, seed: int) -> Iterator[Scene]:
    """A seeded sequence."""
    points = sobol(count, RIGID_NUMBERS + HOSTILE_NUMBERS, seed)
    return (hostile_scene(p[:RIGID_NUMBERS], p[RIGID_NUMBERS:]) for p in points)
