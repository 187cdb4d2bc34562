"""Least squares for a limit and all coefficients of its series, the sizes of these and of errors inferred as well.

The coefficients are of one common size beforehand, the errors of the cases in part common to all. What is asked of
them is linear; it is weighed over all choices of that size and of how much the errors are understated.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

Array = NDArray[np.float64]

_UNDERSTATED = (1, 2, 4, 8)  # by what the cases may understate their errors, each half as likely as the one before
_ROUND_OFF = 3e-11  # of the largest size


class Extrapolated(NamedTuple):
    """What is inferred of a stiffness beyond those that were seen."""

    value: float
    uncertainty: float
    """Half width of its interval."""


class _Posterior(NamedTuple):
    """For each choice of the coefficients' size and the errors'."""

    evidence: Array  # (cases,) logarithm, up to a constant
    mean: Array  # (cases, m)
    deviation: Array  # (cases, m)


def inferred(y: Array, error: Array, sizes: Array, powers: Array, functional: Array, confidence: float) -> Extrapolated:
    """A linear functional of L and the coefficients, over all sizes of these and of the errors; where L is not in it, L
    is known and 0."""
    from scipy.optimize import brentq  # by whoever infers, and not by every process that is told

    origin = float(y[-1]) if functional[0] else 0.0
    likely, several, spread = weighed(y - origin, error, sizes, powers, functional[None])
    means, deviations = several[:, 0], spread[:, 0]
    middle = float(likely @ means)

    def outside(half: float) -> float:
        above, below = (middle + half - means) / deviations, (middle - half - means) / deviations
        return float(likely @ (ndtr(-above) + ndtr(below))) - (1 - confidence)

    widest = float(np.max(np.abs(means - middle) + 10 * deviations))
    return Extrapolated(middle + origin, float(brentq(outside, 0.0, widest, rtol=1e-6)))


def weighed(
    y: Array, error: Array, sizes: Array, powers: Array, functionals: Array
) -> tuple[Array, Array, Array]:  # fmt: skip
    """How likely each choice of sizes is, (cases,), and what each makes of linear functionals (m, 1 + TERMS): means and
    deviations, (cases, m)."""
    understated, size = (grid.ravel() for grid in np.meshgrid(_UNDERSTATED, sizes))
    common = understated[:, None] * error
    own = np.hypot(common, _ROUND_OFF * float(np.ptp(sizes)))
    weighed = np.repeat(functionals[None], size.size, axis=0)
    weighed[:, :, 1:] *= size[:, None, None]
    evidence, means, deviations = _posterior(y, common, own, size[:, None, None] * powers, weighed)
    weights = evidence - np.log(understated)
    likely = np.exp(weights - weights.max())
    return likely / likely.sum(), means, deviations


def _posterior(y: Array, common: Array, own: Array, powers: Array, functionals: Array) -> _Posterior:
    """Least squares for L, the coefficients and the common error, the latter two of unit size beforehand.

    ``common`` and ``own`` are (cases, n) errors, ``powers`` (cases, n, TERMS), ``functionals`` (cases, m, 1 + TERMS); a
    case is one choice of sizes. L is no unknown where the functionals do not have it.
    """
    cases, n, count = powers.shape
    free = int(bool(functionals[0, 0, 0]))
    unknowns = free + count + 1
    design = np.zeros((cases, n + count + 1, unknowns))
    if free:
        design[:, :n, 0] = 1 / own
    design[:, :n, free:-1] = powers / own[:, :, None]
    design[:, :n, -1] = common / own
    design[:, n:] = np.eye(unknowns)[free:]
    right = np.concatenate([y / own, np.zeros((cases, count + 1))], axis=1)[..., None]
    orthogonal, upper = np.linalg.qr(design)
    along = np.swapaxes(orthogonal, 1, 2) @ right
    asked = np.zeros((cases, unknowns, functionals.shape[1]))
    asked[:, :-1] = np.swapaxes(functionals[:, :, 1 - free :], 1, 2)
    reach = np.linalg.solve(np.swapaxes(upper, 1, 2), asked)
    left = np.square(right - orthogonal @ along).sum(axis=(1, 2))
    sizes = np.log(np.abs(np.diagonal(upper, axis1=1, axis2=2))).sum(axis=1) + np.log(own).sum(axis=1)
    return _Posterior(-left / 2 - sizes, (reach * along).sum(axis=1), np.linalg.norm(reach, axis=1))
