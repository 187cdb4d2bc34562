"""How the flexible pulse comes to its limit: J_F/J_N = L + c eps + O(eps^2), eps = foundation^(-1/3).

L and c follow from the rigid motion alone (:mod:`studies.limit.prediction`); here they stand beside two runs.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from flexible import simulate
from rigid import load_scene

from ..limit.prediction import predict
from .row import Row

FOUNDATIONS = (1e11, 1e12)
RTOL = 1e-7


def rows() -> Iterator[Row]:
    """The coefficient for the massless hoop, under the law of the paper and without mu_s > mu."""
    eps = np.array(FOUNDATIONS) ** (-1 / 3)
    for mu_s in (0.35, 0.3):
        scene = load_scene("paper-3.3-massless").replace(friction={"mu_s": mu_s}, run={"until": "pulse"})
        term = predict(scene).terms["impulse_ratio"]
        away = []
        for foundation in FOUNDATIONS:
            stiff = {"contact": {"stiffness": foundation}, "ring": {"bending_stiffness": 1e-5 * foundation}}
            found = simulate(scene.replace(**stiff, solve={"rtol": RTOL})).pulses[0].impulse_ratio
            away.append(found - term.limit)
        # a eps + b eps^2 through both
        first = float(np.linalg.solve(np.array([eps, eps**2]).T, np.array(away))[0])
        yield Row(
            "derived, studies/README.md, the limit of infinite stiffness",
            f"c of J_F/J_N, k = 0.1, r = 1.02, m_h = 0, {mu_s}/0.3",
            term.coefficient,
            first,
            RTOL * float(1 / eps[1] + 1 / eps[0]) + 0.02 * abs(term.coefficient),
            "foundations 1e11 and 1e12 without their eps^2: the tolerance over eps, and 2 % for eps^3",
        )
