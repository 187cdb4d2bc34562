"""Which instants become frames: as many before a jump of the force as behind it."""

import numpy as np
import pytest

from meshes import frame_times

#: a force that jumps at 0.3 and twice at 0.6, and is known every tenth
T = np.array([0.0, 0.1, 0.2, 0.3, 0.3, 0.4, 0.5, 0.6, 0.6, 0.6, 0.7, 0.8, 0.9, 1.0])
FORCE = np.array([1.0, 1.0, 1.5, 2.0, 7.0, 6.0, 6.0, 5.0, 0.0, 3.0, 3.0, 2.0, 2.0, 2.0])


def test_what_follows_a_jump_is_shared_by_both_sides():
    """A jump of 10 is all that changes, between times 0.02 apart: nine tenths of the 1000 frames follow it, half of
    them within 0.02 before and half behind, and each side has the evenly spaced ones of that stretch too; to a frame,
    as a boundary lies between two.
    """
    t = np.sort(np.append(np.linspace(0, 1, 51), 0.5))
    when = frame_times(0, 1, 1001, t, np.where(np.arange(52) > 25, 10.0, 0.0), 0.9)
    for low, high in ((0.48, 0.5), (0.5, 0.52)):
        assert ((low < when) & (when < high)).sum() == pytest.approx(450 + 2, abs=1)


@pytest.mark.parametrize(("start", "stop"), [(0.0, 1.0), (0.25, 0.85), (0.3, 0.6)])
def test_a_run_backward_has_its_frames_mirrored(start, stop):
    """Nothing in the choice goes with time, at jumps of the ends too; to round-off of times of the order of one."""
    there = frame_times(start, stop, 41, T, FORCE, 0.7)
    back = frame_times(1 - stop, 1 - start, 41, 1 - T[::-1], FORCE[::-1], 0.7)
    np.testing.assert_allclose(there, 1 - back[::-1], atol=1e-12)
    assert np.diff(there).min() > 0
