"""The normal foundation: a Winkler energy over the gap, linear between points, and its exact derivatives.

The energy is eps_n/2 times the integral of the squared gap where it is negative; the edge of the patch is where the
line between two points crosses zero. Forces are the energy's gradient, so that the contact conserves it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from rigid.kernel.compile import loop


class Foundation(NamedTuple):
    """Normal forces of points, their derivatives, and the patch that they press."""

    force: Any  # normal force of each point
    diagonal: Any  # second derivative of the energy by the point's own gap
    coupling: Any  # by its gap and that of the next point
    energy: float
    length: float  # of the patch


def half_width(normal_force: float, eps_n: float) -> float:
    """Of the patch of a rigid rim, in R: N = (2/3) eps_n a^3."""
    return float((1.5 * normal_force / eps_n) ** (1 / 3))


@loop
def _cell(ga: float, gb: float, unit: float) -> tuple[float, float, float, float, float, float]:
    """Energy of one cell with gap from ``ga`` to ``gb``, its gradient and second derivatives.

    Returned: energy, -d/da, -d/db, aa, ab, bb; ``unit`` is eps_n times the spacing.
    """
    if ga >= 0 and gb >= 0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if ga < 0 and gb < 0:
        energy = unit * (ga * ga + ga * gb + gb * gb) / 6
        return energy, -unit * (2 * ga + gb) / 6, -unit * (2 * gb + ga) / 6, unit / 3, unit / 6, unit / 3
    low, high = min(ga, gb), max(ga, gb)
    q = low / (high - low)
    energy = -unit * low * low * q / 6
    at_low, at_high = unit * low * (3 * q + q * q) / 6, -unit * low * q * q / 6
    by_low, both = -unit * (6 * q + 6 * q * q + 2 * q**3) / 6, unit * (3 * q * q + 2 * q**3) / 6
    by_high = -unit * 2 * q**3 / 6
    if ga < gb:
        return energy, at_low, at_high, by_low, both, by_high
    return energy, at_high, at_low, by_high, both, by_low


@loop
def press(gap: Any, last: Any, eps_n: float, spacing: float, to: Any) -> tuple[float, float]:
    """Normal forces of points with these gaps; ``last`` marks points whose next one is no neighbour.

    Fills in the arrays of a :class:`Foundation`, and returns its energy and length.
    """
    force, diagonal, coupling = to.force, to.diagonal, to.coupling
    energy, length = 0.0, 0.0
    for i in range(gap.shape[0] - 1):
        ga, gb = gap[i], gap[i + 1]
        if last[i] or (ga >= 0 and gb >= 0):
            continue
        stored, at_a, at_b, aa, ab, bb = _cell(ga, gb, eps_n * spacing)
        energy += stored
        force[i] += at_a
        force[i + 1] += at_b
        diagonal[i] += aa
        coupling[i] = ab
        diagonal[i + 1] += bb
        if ga < 0 and gb < 0:
            length += spacing
        else:
            length += spacing * (ga / (ga - gb) if ga < 0 else gb / (gb - ga))
    return energy, length


@loop
def force_by_gaps(by_gap: Any, factor: float, foundation: Foundation) -> None:
    """Add ``factor`` times the derivatives of the points' normal forces by the gaps around them.

    ``by_gap`` is that of :class:`flexible.contact.points.data.PointForces`.
    """
    diagonal, coupling = foundation.diagonal, foundation.coupling  # no coupling with what is no neighbour
    for i in range(diagonal.shape[0]):
        by_gap[i, 2] -= factor * diagonal[i]
        by_gap[i, 3] -= factor * coupling[i]
        if i > 0:
            by_gap[i, 1] -= factor * coupling[i - 1]


@loop
def sum_by_gaps(factors: Any, foundation: Foundation, to: Any) -> None:
    """Derivative of the sum of the points' normal forces, each times its factor, by the gap of each point."""
    diagonal, coupling = foundation.diagonal, foundation.coupling
    total = diagonal.shape[0]
    for i in range(total):
        to[i] = -factors[i] * diagonal[i]
        if i > 0:
            to[i] -= factors[i - 1] * coupling[i - 1]
        if i + 1 < total:
            to[i] -= factors[i + 1] * coupling[i]
