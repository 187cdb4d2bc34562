"""The smallest disk that rolls throughout, where larger ones may slip again."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from rigid import Friction, Hoop, Kind, Release, Run, Scene, rolling_k, rolling_mu_s, simulate

#: thrown into its swing beside the bottom a hoop with mass asks for most friction where the disk is large or small
THROWN = Release(2.942788496114802, omega0=1.5)


def needed(k: float) -> float:
    return rolling_mu_s(Hoop(k, mass_ratio=1.0), THROWN)


def rolls(k: float, mu_s: float) -> bool:
    scene = Scene(Hoop(k, mass_ratio=1.0), Friction(mu_s, mu_s / 2), THROWN, Run(until="rest"))
    return {phase.kind for phase in simulate(scene).phases} == {Kind.ROLL}


@pytest.mark.parametrize("mu_s", [0.0165, 0.01681, 0.02])
def test_all_smaller_disks_slip(mu_s):
    """Of 0.01681 the largest size at which rolling ends and begins, 0.844, was found, and 0.65 rolls."""
    k = rolling_k(mu_s, THROWN, mass_ratio=1.0)
    assert not any(rolls(share * k, mu_s) for share in np.linspace(0.01, 0.999, 40))
    assert rolls(1.0001 * k, mu_s)


def test_a_window_narrower_than_any_grid():
    """With a part in a million more than the least that sizes from 0.6 to 0.7 ask for, next to none of them roll."""
    least = minimize_scalar(needed, bounds=(0.6, 0.7), method="bounded", options={"xatol": 1e-12})
    assert needed(0.6) > least.fun < needed(0.7)
    mu_s = least.fun * (1 + 1e-6)
    k = rolling_k(mu_s, THROWN, mass_ratio=1.0)
    assert k == pytest.approx(least.x, abs=1e-2)
    assert rolls(least.x, mu_s)
    assert rolling_k(least.fun * (1 - 1e-6), THROWN, mass_ratio=1.0) > 0.7


def test_where_none_is_the_smallest():
    with pytest.raises(ValueError, match="every disk slips"):
        rolling_k(1e-9, THROWN, mass_ratio=1.0)
    with pytest.raises(ValueError, match="the smallest disks roll"):
        rolling_k(0.3, THROWN, mass_ratio=1.0)
