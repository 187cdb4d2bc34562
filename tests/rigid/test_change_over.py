"""A motion that goes over from interpreted to compiled code on its way: nothing of it says where."""

from __future__ import annotations

import numpy as np
import pytest

from rigid import Friction, Hoop, Release, Run, Scene, simulate, solve
from rigid.kernel.compile import Patience

SMOOTH = Friction(0.0, 0.0)
SCENES = {
    "whirls on a smooth floor, to turns that never come": Scene(
        Hoop(0.5), SMOOTH, Release(0.1, 1.0), Run(turns=2)
    ),
    "swings on a smooth floor until nothing is lost": Scene(
        Hoop(0.3, 1.1, 2.0), SMOOTH, Release(2.0), Run(until="rest")
    ),
    "swings on a smooth floor, coming round": Scene(
        Hoop(0.1), SMOOTH, Release(phi0_deg=180, omega0=0.7, slip0=0.3), Run(t_end=60.0)
    ),
    "rolls and slips": Scene(Hoop(0.1, 1.02), Friction(0.35, 0.3), Release(phi0_deg=10), Run(turns=4)),
    "slips through a near jam": Scene(Hoop(0.1), Friction(0.7, 0.6), Release(phi0_deg=10), Run(until="rest")),
    "slips on a tie": Scene(Hoop(0.25), Friction(0.3, 0.3), Release(phi0_deg=10), Run(turns=6)),
    "hardly loses anything": Scene(Hoop(0.3), Friction(1e-3, 1e-3), Release(phi0_deg=60), Run(turns=150)),
}  # fmt: skip


class Piecemeal(Patience):
    """Interpreted throughout, in pieces of so many steps."""

    def __init__(self, steps):
        super().__init__(steps)

    def left(self, instants=0):
        return self._limit


def records(scene):
    """All that is kept of a motion, and why it ends."""
    motion = simulate(scene)
    return motion.sample.log.records, motion.ended


@pytest.mark.slow
@pytest.mark.parametrize("steps", [1, 2, 7])
@pytest.mark.parametrize("name", SCENES)
def test_a_run_in_pieces_is_the_run_in_one(monkeypatch, name, steps):
    """To the last bit: what a slip needs of its past is kept where it is cut."""
    monkeypatch.setattr(solve, "patience", Patience(10**9))
    whole, why = records(SCENES[name])
    monkeypatch.setattr(solve, "patience", Piecemeal(steps))
    parts, why_parts = records(SCENES[name])
    assert why_parts == why
    assert np.array_equal(parts, whole, equal_nan=True)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_where_a_motion_goes_over_to_compiled_code_is_not_seen(monkeypatch, name):
    """Compiled throughout, interpreted throughout, and over on the way: as many records, the same to round-off."""
    monkeypatch.setattr(solve, "patience", Patience(0))
    compiled, why = records(SCENES[name])
    for steps in (1, 3, 10, 30, 10**9):
        monkeypatch.setattr(solve, "patience", Patience(steps))
        other, why_other = records(SCENES[name])
        assert why_other == why
        assert other.shape == compiled.shape
        assert other == pytest.approx(compiled, rel=1e-9, abs=1e-9, nan_ok=True)
