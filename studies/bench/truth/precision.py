"""The rigid hoop once more, to forty digits: Taylor series in time by mpmath, sharing nothing with :mod:`rigid`.

In units R = g = m = 1 for the massless hoop with r = 1, so e = 1 - k and K = k^2/2, with w = phidot^2, s = sin(phi),
c = cos(phi): rolling obeys (1 + e^2 + K + 2 e c) phidd = e s (1 + w), slipping with friction -mu^ N
D phidd = (e s + mu^ (1 + e c)) (1 - e c w), D = K + e s (e s + mu^ (1 + e c)), N = K (1 - e c w)/D.

Its numbers are kept in :mod:`studies.bench.truth.precision_values`; ``python -m studies.bench.truth.precision`` prints
that module anew.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from math import radians
from typing import Any

MU_S, MU, PHI0 = 0.35, 0.3, radians(10)
DISKS = (0.1, 0.25, 1e-5)
DIGITS = 40
ORDER = 48
CHECKS = 8  # points of a step at which an event is looked for
Series = list[Any]


def times(a: Series, b: Series, n: int) -> Any:
    """Coefficient n of a product."""
    from mpmath import fdot

    return fdot(zip(a[: n + 1], b[n::-1], strict=True))


def over(top: Series, bottom: Series, known: Series, n: int) -> Any:
    """Coefficient n of a quotient whose lower ones are known."""
    from mpmath import fdot

    return (top[n] - fdot(zip(known[:n], bottom[n:0:-1], strict=True))) / bottom[0]


@dataclass
class Step:
    """Series about one instant: angle, its rate, slip velocity, normal and friction force."""

    phi: Series
    omega: Series
    slip: Series
    normal: Series
    friction: Series
    length: Any


@dataclass
class Trace:
    """What the integration found: turns as (t, phi, slip velocity, energy), pulses as (J_N, J_F, loss)."""

    turns: list[tuple[Any, ...]] = field(default_factory=list)
    pulses: list[tuple[Any, ...]] = field(default_factory=list)
    steps: int = 0


class Hoop:
    """A disk of radius k in a massless hoop of no wall."""

    def __init__(self, k: float) -> None:
        from mpmath import mpf

        self.e = 1 - mpf(k)
        self.K = mpf(k) ** 2 / 2
        self.mu_s, self.mu = mpf(MU_S), mpf(MU)

    def step(self, phi: Any, omega: Any, slip: Any, mode: int) -> Step:
        """Series of one phase; ``mode`` is 0 for rolling, otherwise the sign of the slip velocity."""
        from mpmath import cos, mp, mpf, sin

        e, K, mu = self.e, self.K, mode * self.mu
        p, o, v = [phi], [omega], [slip]
        s, c = [sin(phi)], [cos(phi)]
        w: Series = []
        cw: Series = []
        sw: Series = []
        top: Series = []
        bottom: Series = []
        arm: Series = []
        alpha: Series = []
        free: Series = []
        quotient: Series = []
        normal: Series = []
        friction: Series = []
        for n in range(ORDER):
            unit = 1 if n == 0 else 0
            w.append(times(o, o, n))
            cw.append(times(c, w, n))
            sw.append(times(s, w, n))
            if mode == 0:
                top.append(e * (s[n] + sw[n]))
                bottom.append((1 + e * e + K) * unit + 2 * e * c[n])
                alpha.append(over(top, bottom, alpha, n))
                normal.append(unit - e * (cw[n] + times(s, alpha, n)))
                friction.append(alpha[n] + e * times(c, alpha, n) - e * sw[n])
                v.append(mpf(0))
            else:
                arm.append(e * s[n] + mu * (unit + e * c[n]))
                bottom.append(K * unit + e * times(s, arm, n))
                free.append(unit - e * cw[n])
                quotient.append(over(free, bottom, quotient, n))
                alpha.append(times(arm, quotient, n))
                normal.append(K * quotient[n])
                friction.append(-mu * normal[n])
                v.append((friction[n] + e * sw[n] - alpha[n] - e * times(c, alpha, n)) / (n + 1))
            p.append(o[n] / (n + 1))
            s.append(times(c, o, n) / (n + 1))
            c.append(-times(s[: n + 1], o, n) / (n + 1))
            o.append(alpha[n] / (n + 1))
        tiny = mpf(10) ** -(mp.dps - 4)
        lengths = []
        for series in (p, o, v, normal):
            for n in (len(series) - 2, len(series) - 1):
                if series[n] != 0:
                    lengths.append((tiny / abs(series[n])) ** (mpf(1) / n))
        return Step(p, o, v, normal, friction, min([*lengths, mpf(1) / 4]))

    def velocity(self, phi: Any, omega: Any, slip: Any) -> tuple[Any, Any]:
        """Of the centre of mass."""
        from mpmath import cos, sin

        return slip + omega * (1 + self.e * cos(phi)), -self.e * sin(phi) * omega

    def energy(self, phi: Any, omega: Any, slip: Any) -> Any:
        """Kinetic and potential, 0 with G at floor level."""
        from mpmath import cos

        x, y = self.velocity(phi, omega, slip)
        return (x * x + y * y + self.K * omega * omega) / 2 + 1 + self.e * cos(phi)


def value(series: Series, x: Any) -> Any:
    """A series at ``x``."""
    total = series[-1] * 0
    for coefficient in reversed(series):
        total = total * x + coefficient
    return total


def root(function: Any, low: Any, high: Any) -> Any:
    """Where a function changes sign, by bisection to the last digit."""
    positive = function(low) > 0
    for _ in range(4 * DIGITS):
        middle = (low + high) / 2
        if (function(middle) > 0) == positive:
            low = middle
        else:
            high = middle
    return high


def integrate(k: float, turns: int = 2) -> Trace:
    """From rest at ten degrees through so many turns."""
    from mpmath import mpf, pi, sign, workdps

    with workdps(DIGITS):
        hoop, trace = Hoop(k), Trace()
        t, phi, omega, slip, mode = mpf(0), mpf(PHI0), mpf(0), mpf(0), 0
        heading = 1  # sign of phidot until the next turn
        opened: tuple[Any, ...] | None = None
        while len(trace.turns) < turns:
            step = hoop.step(phi, omega, slip, mode)
            trace.steps += 1
            if mode == 0 and abs(step.friction[0]) > hoop.mu_s * step.normal[0]:
                mode = -int(sign(step.friction[0]))
                continue

            def excess(x: Any, step: Step = step, mode: int = mode) -> Any:
                if mode:
                    return -mode * value(step.slip, x)
                return abs(value(step.friction, x)) - hoop.mu_s * value(step.normal, x)

            def back(x: Any, step: Step = step, heading: int = heading) -> Any:
                return -heading * value(step.omega, x)

            length, event = step.length, ""
            for number in range(1, CHECKS + 1):
                x = step.length * number / CHECKS
                found = [
                    (root(f, x - step.length / CHECKS, x), name)
                    for f, name in ((excess, "contact"), (back, "turn"))
                    if f(x) > 0
                ]
                if found:
                    length, event = min(found)
                    break

            def pulse_edge(x: Any, step: Step = step) -> Any:
                return value(step.normal, x) - 1

            marks = [length * number / CHECKS for number in range(CHECKS + 1)]
            edges = [mpf(0)] if (pulse_edge(marks[0]) > 0) != (opened is not None) else []
            for low, high in pairwise(marks):
                if (pulse_edge(low) > 0) != (pulse_edge(high) > 0):
                    edges.append(root(pulse_edge, low, high))
            for x in edges:
                at = tuple(value(series, x) for series in (step.phi, step.omega, step.slip))
                now = (t + x, at[0], *hoop.velocity(*at), hoop.energy(*at))
                if opened is None:
                    opened = now
                    continue
                if (opened[1] - pi) * (now[1] - pi) < 0:
                    normal = now[3] - opened[3] + now[0] - opened[0]
                    trace.pulses.append((normal, now[2] - opened[2], opened[4] - now[4]))
                opened = None
            t += length
            phi, omega, slip = (value(series, length) for series in (step.phi, step.omega, step.slip))
            if event == "turn":
                omega, heading = mpf(0), -heading
                trace.turns.append((t, phi, slip, hoop.energy(phi, omega, slip)))
            elif event == "contact":
                if mode == 0:
                    mode = -int(sign(value(step.friction, length)))
                else:
                    rolling = hoop.step(phi, omega, mpf(0), 0)
                    sticks = abs(rolling.friction[0]) <= hoop.mu_s * rolling.normal[0]
                    mode = 0 if sticks else -mode
                slip = mpf(0)
        return trace


def module_text(traces: dict[float, Trace]) -> str:
    """The source of :mod:`studies.bench.truth.precision_values`."""
    from mpmath import nstr

    lines = [
        '"""Turns (t, phi, slip velocity, energy) and pulses (J_N, J_F, friction loss) by disk radius k.',
        "",
        "Massless hoop, r = 1, mu_s = 0.35, mu = 0.3, from rest at 10 degrees; R = m = g = 1. Printed by",
        "``python -m studies.bench.truth.precision``, which integrates with forty digits.",
        '"""',
        "",
    ]
    for name in ("turns", "pulses"):
        lines.append(f"{name.upper()}: dict[float, tuple[tuple[str, ...], ...]] = {{")
        for k, trace in traces.items():
            lines.append(f"    {k!r}: (")
            for row in getattr(trace, name):
                lines.append("        (")
                lines += [f'            "{nstr(number, 25)}",' for number in row]
                lines.append("        ),")
            lines.append("    ),")
        lines.append("}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(module_text({k: integrate(k) for k in DISKS}), end="")
