"""What is read off the records of a march."""

import numpy as np
import pytest

from flexible.models.state import Record
from flexible.segment import Segment
from rigid import Hoop


def turning(t, phi, omega):
    """Records of a hoop that turns, and does nothing else."""
    nothing = dict.fromkeys(Record._fields, 0.0)
    rows = [{**nothing, "t": a, "phi": b, "omega": c, "mode": 0} for a, b, c in zip(t, phi, omega, strict=True)]
    return Segment([Record(**row) for row in rows], Hoop(k=0.1), 0.0)


def test_an_event_at_the_very_angle_is_no_crossing_of_its_own():
    """The two records of an event take no time; the steps before and behind it both end at the angle."""
    segment = turning([0.0, 1.0, 1.0, 2.0], [0.0, 1.0, 1.0, 2.0], [1.0] * 4)
    assert list(segment.crossings(1.0)) == pytest.approx([1.0, 1.0])
    assert segment.crossing(1.0, 0.5) == pytest.approx(1.0)
    assert segment.crossing(1.0, 1.5) is None


def test_a_hoop_thrown_back_passes_an_angle_once_each_way():
    """phi = t (2 - t), a parabola, which cubics between steps have exactly: 1/2 at 1 -+ sqrt(1/2)."""
    t = np.array([0.0, 0.3, 1.1, 1.1, 2.0])
    segment = turning(t, t * (2 - t), 2 - 2 * t)
    assert list(segment.crossings(0.5)) == pytest.approx([1 - 0.5**0.5, 1 + 0.5**0.5], abs=1e-14)


def test_a_hoop_that_rolls_does_so_between_the_steps():
    """x_C = phi = t (2 - t): a way straight between the steps would have the hoop slip there and back."""
    t = np.array([0.0, 0.3, 1.1, 2.0])
    segment = turning(t, t * (2 - t), 2 - 2 * t)
    segment.columns["x_C"] = segment["phi"].copy()
    between = np.linspace(0, 2, 23)
    assert segment.value("x_C", between) == pytest.approx(between * (2 - between), abs=1e-14)
