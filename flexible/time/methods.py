"""The implicit Runge-Kutta methods of a step: diagonally implicit, the first stage explicit, L-stable.

All are of one form: stage i solves ``y_i = y_0 + h sum_j a_ij f_j`` with the same gamma = a_ii, the first stage is the
end of the step before, and the last one is the step's result. What a step does not resolve, the ring's and the
contact's own vibrations, they damp; so steps follow the motion and not the stiffness.
"""

from __future__ import annotations

from functools import cached_property
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Table(NamedTuple):
    """A method as the step takes it, see :class:`Method`."""

    a: Any  # (stages, stages)
    b: Any  # (stages,)
    c: Any  # (stages,)
    gamma: float
    error: Any  # (stages,)
    work: Any  # (stages, stages)
    end_rate: Any  # (stages,)
    trend: Any  # (stages,)
    span: Any  # (stages,) part of a step that is nearest to each stage
    order: Any  # (stages,) of the stages in time
    nearest: Any  # (stages, 2) to each stage in time, among those before it
    share: Any  # (stages,) of the change between the two at which a line through them is at the stage
    power: float  # 1/(that of the step with which the error falls)
    tolerance: float  # of a step's error


class Method:
    """A method by its table.

    Parameters
    ----------
    name : str
    a : rows of numbers
        Of all stages, each up to its diagonal; the first has none.
    companion : numbers
        Weights of the method by which the error is estimated.
    order : int
    estimates : int
        Power of h with which the estimate falls.
    share : float
        Tolerance of a step's error, over rtol to the power ``estimates``/``order``.
    """

    def __init__(
        self, name: str, a: list[list[float]], companion: list[float], order: int, estimates: int, share: float
    ) -> None:
        stages = len(companion)
        self.name, self.order, self.estimates, self._share = name, order, estimates, share
        self.a = np.zeros((stages, stages))
        for i, row in enumerate(a):
            self.a[i, : len(row)] = row
        self.b = self.a[-1]
        self.c = self.a.sum(axis=1)
        self.gamma = float(self.a[-1, -1])
        self.error = self.b - np.array(companion)

    def tolerance(self, rtol: float) -> float:
        """What the error of one step's velocities may be for a motion with the tolerance ``rtol``."""
        return float(self._share * rtol ** (self.estimates / self.order))

    def _through_stages(self, x: Array) -> tuple[Array, Array]:
        """Lagrange's polynomials of the stages over a step, and their derivatives, at ``x``: (stages, n) each.

        By products, which keep their digits where the coefficients of the polynomials would lose some.
        """
        stages = range(len(self.c))
        ways = x - self.c[:, None]
        values, rates = np.empty((2, len(self.c), len(x)))
        for i in stages:
            others = [k for k in stages if k != i]
            scale = np.prod(self.c[i] - self.c[others])
            values[i] = ways[others].prod(axis=0) / scale
            rates[i] = sum(ways[[k for k in others if k != j]].prod(axis=0) for j in others) / scale
        return values, rates

    @cached_property
    def work(self) -> Array:
        """(stages, stages) ``force @ work @ way`` is the work of a force along a way, polynomials through the stages.

        Exact for a spring however long the step: a force linear in the way does the work of its ends.
        """
        x, weights = np.polynomial.legendre.leggauss(len(self.c))  # exact for the product of the two
        values, rates = self._through_stages((x + 1) / 2)
        found: Array = (values * weights / 2) @ rates.T
        return found

    def _fitted_rate(self, degree: int) -> Array:
        """(stages,) Rate at the end of a step of unit length of the polynomial that comes nearest to the stages'."""
        found: Array = np.arange(degree + 1) @ np.linalg.pinv(np.vander(self.c, degree + 1, increasing=True))
        return found

    @cached_property
    def end_rate(self) -> Array:
        """(stages,) Rate at the end of a step of unit length of what is known at the stages.

        By a polynomial through up to four, and the cubic nearest to more. One through six has weights four times as
        large, of both signs: of a contact that rings within the step it tells nothing.
        """
        return self._through_stages(np.ones(1))[1][:, 0] if len(self.c) <= 4 else self._fitted_rate(3)

    @cached_property
    def trend(self) -> Array:
        """(stages,) The same by a parabola, for what is not smooth in a step."""
        return self._fitted_rate(2)

    @cached_property
    def span(self) -> Array:
        """(stages,) The part of a step of unit length that is nearest to each stage: for what is there or not, of which
        weights that are negative, as ``b`` may be, would make more than all of the step, or less than nothing."""
        order, within = np.argsort(self.c, kind="stable"), np.clip(np.sort(self.c), 0.0, 1.0)
        found = np.empty(len(self.c))
        found[order] = np.diff(np.concatenate([[0.0], (within[1:] + within[:-1]) / 2, [1.0]]))
        return found

    def table(self, tolerance: float = np.inf) -> Table:
        """All of it as named arrays, for steps of that tolerance."""
        nearest, share = np.zeros((len(self.c), 2), np.int64), np.zeros(len(self.c))
        for i in range(2, len(self.c)):
            near, next_near = np.argsort(np.abs(self.c[:i] - self.c[i]), kind="stable")[:2]
            nearest[i] = near, next_near
            share[i] = (self.c[i] - self.c[near]) / (self.c[near] - self.c[next_near])
        return Table(
            self.a, self.b.copy(), self.c, self.gamma, self.error, self.work, self.end_rate, self.trend, self.span,
            np.argsort(self.c), nearest, share, 1 / self.estimates, tolerance,
        )  # fmt: skip


def _tr_bdf2() -> Method:
    """Bank et al. 1985; its companion is of third order (Hosea and Shampine 1996)."""
    beta, w = 1 - sqrt(2) / 2, sqrt(2) / 4
    a = [[], [beta, beta], [w, w, beta]]
    return Method("tr-bdf2", a, [(1 - w) / 3, (3 * w + 1) / 3, beta / 3], 2, 3, 3.0)


def _esdirk3() -> Method:
    """ARK3(2)4L[2]SA's implicit half (Kennedy and Carpenter 2003); its companion is of second order."""
    gamma = 1767732205903 / 4055673282236
    third = [2746238789719 / 10658868560708, -640167445237 / 6845629431997, gamma]
    last = [1471266399579 / 7840856788654, -4482444167858 / 7529755066697, 11266239266428 / 11593286722821, gamma]
    companion = [
        2756255671327 / 12835298489170, -10771552573575 / 22201958757719, 9247589265047 / 10645013368117,
        2193209047091 / 5459859503100,
    ]  # fmt: skip
    return Method("esdirk3", [[], [gamma, gamma], third, last], companion, 3, 3, 0.1)


def _esdirk4() -> Method:
    """ARK4(3)6L[2]SA's implicit half (Kennedy and Carpenter 2003); its companion is of third order."""
    last = [82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211, 0.25]
    a = [
        [],
        [0.25, 0.25],
        [8611 / 62500, -1743 / 31250, 0.25],
        [5012029 / 34652500, -654441 / 2922500, 174375 / 388108, 0.25],
        [15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912, 0.25],
        last,
    ]
    companion = [
        4586570599 / 29645900160, 0.0, 178811875 / 945068544, 814220225 / 1159782912, -3700637 / 11593932,
        61727 / 225920,
    ]  # fmt: skip
    return Method("esdirk4", a, companion, 4, 4, 0.2)


TR_BDF2, ESDIRK3, ESDIRK4 = _tr_bdf2(), _esdirk3(), _esdirk4()
METHODS = {method.name: method for method in (TR_BDF2, ESDIRK3, ESDIRK4)}
FOURTH = 2e-5  # rtol below which steps are of fourth order


class Tables(NamedTuple):
    """The methods of steps of a patch that stays on the floor, and of a hoop that lands, leaves it or is off it."""

    calm: Table
    lively: Table


class Methods(NamedTuple):
    """The same as methods."""

    calm: Method
    lively: Method

    def tables(self, rtol: float, share: float = 1.0) -> Tables:
        """For a motion with the tolerance ``rtol``, of which its steps have a ``share``."""
        return Tables(*(method.table(share * method.tolerance(rtol)) for method in self))


def alike(method: Method) -> Methods:
    """The same one everywhere."""
    return Methods(method, method)


def chosen(integrator: str, rtol: float, vibrates: bool) -> Methods:
    """What a scene's ``solve.integrator`` asks for at its ``rtol``.

    By itself that is ESDIRK3, and of a hoop that ``vibrates``, a linear ring with mass, where ``rtol`` is small ESDIRK4
    as long as the patch stays. Of steps in which it does not nothing is smooth; and off the floor the third order damps
    what rings in a light ring, and would bring it down again and again.
    """
    if integrator != "auto":
        return alike(METHODS[integrator])
    return Methods(ESDIRK4 if vibrates and rtol < FOURTH else ESDIRK3, ESDIRK3)
