"""What bristles remember of a step in which their points came to the floor, of a wall whose dent changes meanwhile."""

import numpy as np
import pytest
from dented import OMEGA, SPACING, mean_velocity, place, step

from flexible.contact.points.data import UNDAMPED


def entered(theta, t):
    """When points that are on the floor at ``t`` came to it, 0 of those that were there before."""
    low, high = np.zeros_like(theta), np.full_like(theta, t)
    for _ in range(60):
        middle = (low + high) / 2
        off = place(theta, middle)[1] > 0
        low, high = np.where(off, middle, low), np.where(off, high, middle)
    return np.where(place(theta, 0.0)[1] > 0, high, 0.0)


@pytest.mark.parametrize("ratio", [1 / 0.4358665, 4.0])  # of the last stages of ESDIRK3 and of ESDIRK4
def test_bristles_of_points_that_enter_are_stretched_from_where_they_did(ratio):
    """But for the square of the step. A parabola in time of each point's own way, whose velocity at the end is what
    the patch as a whole lets one foresee, would leave an error like the step wherever the dent changes."""
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = []
    for t in steps:
        way_0, turning_0 = step(t).res.way - t * mean_velocity(t) / ratio, OMEGA * t * (1 - ratio)
        found = step(t, UNDAMPED._replace(ratio=ratio, way_0=way_0, turning_0=turning_0))
        theta = found.bristles.number * SPACING
        touches = place(theta, t)[1] < 0
        theta, stretch = theta[touches], found.bristles.stretch[touches]
        came = entered(theta, t)
        new = came > 0
        assert np.count_nonzero(new) > 20
        errors.append(np.abs(stretch - (place(theta, t)[0] - place(theta, came)[0]))[new].max())
    assert errors[0] < 0.1 * np.abs(place(theta, steps[0])[0] - place(theta, 0.0)[0]).max()
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 1.7
