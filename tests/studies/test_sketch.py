"""The sketch at the top of the README says of signs what the solver does."""

from __future__ import annotations

import numpy as np
import pytest

from rigid import simulate
from studies.plots.sketch import CONTACTS, sketch


@pytest.mark.parametrize(("name", "words", "slip", "friction"), CONTACTS)
def test_signs_are_those_of_the_motion(name, words, slip, friction):
    motion = simulate("paper-3.3-massless")
    found = [phase for phase in motion.phases if str(phase.kind) == name]
    assert found
    mu, mu_s = motion.scene.friction.mu, motion.scene.friction.mu_s
    for phase in found:
        t = np.linspace(phase.t_start, phase.t_end, 9)[1:-1]
        states = motion.at(t)
        assert np.all(np.sign(states.slip_velocity) == slip)
        if friction:
            assert states.friction_force == pytest.approx(friction * mu * states.normal_force, rel=1e-9)
        else:
            assert np.all(np.abs(states.friction_force) <= mu_s * states.normal_force * (1 + 1e-9))
        # v = x_C' - R phi', the positions by central differences over a time that leaves 1e-8 of either
        step = 1e-5 * (phase.t_end - phase.t_start)
        after, before = motion.at(t + step), motion.at(t - step)
        moved = (after.x_C - before.x_C) - motion.scene.hoop.R * (after.phi - before.phi)
        assert moved / (2 * step) == pytest.approx(states.slip_velocity, abs=1e-6)


def test_the_sketch_is_the_same_file_each_time(tmp_path):
    from studies.plots.style import save

    one, two = (save(sketch(), tmp_path / f"{i}" / "hoop.svg").read_bytes() for i in _folders(tmp_path))
    assert one == two


def _folders(path):
    for i in range(2):
        (path / f"{i}").mkdir()
        yield i
