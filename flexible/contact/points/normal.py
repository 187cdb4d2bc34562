"""The normal foundation: a Winkler energy over the gap, linear between points, and its exact derivatives.

The energy is eps_n/2 times the integral of the squared gap where it is negative; the edge of the patch is where the
line between two points crosses zero. Forces are the energy's gradient, so that the contact conserves it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rigid.kernel.compile import part


class Foundation(NamedTuple):
    """Normal forces of points, their derivatives, and the patch that they press."""

    force: Any  # normal force of each point
    diagonal: Any  # second derivative of the energy by the point's own gap
    coupling: Any  # by its gap and that of the next point
    energy: float
    length: float  # of the patch


@part
def _cell(ga: float, gb: float, unit: float, out: Any) -> None:
    """Energy of one cell with gap from ``ga`` to ``gb``, its gradient and second derivatives.

    ``out``: energy, -d/da, -d/db, aa, ab, bb; ``unit`` is eps_n times the spacing.
    """
    swapped = gb < 0 <= ga
    if swapped:
        ga, gb = gb, ga
    if ga >= 0:
        for i in range(6):
            out[i] = 0.0
    elif gb < 0:
        out[0] = unit * (ga * ga + ga * gb + gb * gb) / 6
        out[1] = -unit * (2 * ga + gb) / 6
        out[2] = -unit * (2 * gb + ga) / 6
        out[3] = out[5] = unit / 3
        out[4] = unit / 6
    else:
        q = ga / (gb - ga)
        out[0] = -unit * ga * ga * q / 6
        out[1] = unit * ga * (3 * q + q * q) / 6
        out[2] = -unit * ga * q * q / 6
        out[3] = -unit * (6 * q + 6 * q * q + 2 * q**3) / 6
        out[4] = unit * (3 * q * q + 2 * q**3) / 6
        out[5] = -unit * 2 * q**3 / 6
    if swapped:
        out[1], out[2] = out[2], out[1]
        out[3], out[5] = out[5], out[3]


@part
def press(gap: Any, last: Any, eps_n: float, spacing: float) -> Any:
    """Normal forces of points with these gaps; ``last`` marks points whose next one is no neighbour."""
    total = gap.shape[0]
    force, diagonal, coupling = np.zeros(total), np.zeros(total), np.zeros(total)
    energy, length = 0.0, 0.0
    out = np.empty(6)
    for i in range(total - 1):
        ga, gb = gap[i], gap[i + 1]
        if last[i] or (ga >= 0 and gb >= 0):
            continue
        _cell(ga, gb, eps_n * spacing, out)
        energy += out[0]
        force[i] += out[1]
        force[i + 1] += out[2]
        diagonal[i] += out[3]
        coupling[i] = out[4]
        diagonal[i + 1] += out[5]
        if ga < 0 and gb < 0:
            length += spacing
        else:
            length += spacing * (ga / (ga - gb) if ga < 0 else gb / (gb - ga))
    return Foundation(force, diagonal, coupling, energy, length)


@part
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


@part
def sum_by_gaps(factors: Any, foundation: Foundation) -> Any:
    """Derivative of the sum of the points' normal forces, each times its factor, by the gap of each point."""
    diagonal, coupling = foundation.diagonal, foundation.coupling
    total = diagonal.shape[0]
    result = np.empty(total)
    for i in range(total):
        result[i] = -factors[i] * diagonal[i]
        if i > 0:
            result[i] -= factors[i - 1] * coupling[i - 1]
        if i + 1 < total:
            result[i] -= factors[i + 1] * coupling[i]
    return result
