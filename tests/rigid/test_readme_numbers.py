"""Numbers that the README states about the rigid hoop and that no command of its own prints."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from rigid import Friction, Hoop, Release, Run, Scene, load_scene, simulate

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
MASSLESS = load_scene("paper-3.3-massless").replace(run={"until": "pulse"})


def stated(pattern: str) -> list[float]:
    found = re.search(pattern, README)
    assert found is not None, f"the README no longer says {pattern!r}: what it says instead needs a test"
    return [float(number) for number in found.groups()]


def test_the_rigid_row_of_the_table():
    """J_F/J_N and friction loss of the massless hoop's first pulse, to their last digit."""
    pulse = simulate(MASSLESS).pulses[0]
    assert stated(r"\| rigid \| ([\d.]+) \| ([\d.]+) \|") == pytest.approx(
        [pulse.impulse_ratio, pulse.friction_loss], abs=5e-6
    )


def test_the_ratio_over_mu():
    pulse = simulate(MASSLESS).pulses[0]
    assert stated(r"is ([\d.]+) μ here") == pytest.approx([pulse.impulse_ratio / 0.3], abs=5e-3)


def test_the_rigid_hoop_that_the_brush_tends_to():
    mu_s, ratio = stated(r"the rigid hoop with μ_s = ([\d.]+) instead of 0\.35: [\d.]+ ± [\d.]+ against (\d\.\d+)")
    # mu_eff of a rolling parabolic patch whose rear slides, for 0.35 over 0.3
    b = 2 * 0.05 / (3 * 0.35 - 2 * 0.3)
    effective = 3 * 0.35 * (b**2 - b**3) + 0.3 * (1 - 3 * b**2 + 2 * b**3)
    assert mu_s == pytest.approx(effective, abs=5e-5)
    pulse = simulate(MASSLESS.replace(friction={"mu_s": effective})).pulses[0]
    assert ratio == pytest.approx(pulse.impulse_ratio, abs=5e-6)


def test_energy_where_phidot_is_one_over_k():
    """Kept to 1e-13 of itself through pulses in which phidot is of the order 1e8."""
    motion = simulate(Scene(Hoop(1e-8), Friction(0, 0), Release(1.0, 0.3, 0.2), Run(turns=4)))
    t = np.concatenate([np.linspace(p.t_start, p.t_end, 9) for p in motion.pulses])
    states = motion.at(np.concatenate([t, np.linspace(0, motion.t_end, 50)]))
    assert np.abs(states.omega).max() > 1e7
    assert np.ptp([turn.energy for turn in motion.turns]) < 1e-13 * motion.turns[0].energy
