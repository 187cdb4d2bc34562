"""The slip velocity of a patch: the rate of its way in a step, and what its points have, weighed by their pressure."""

import numpy as np
from dented import mean_velocity, step


def test_the_slip_velocity_is_the_mean_of_the_points():
    """The rate of the way at the end of a step is their mean but for the step's square.

    A way along the dent as it was alone, and weights of the end of the step alone, leave an error like the step. Of a
    rate that points 2e-5 apart know to 1e-6 of it.
    """
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = []
    for t in steps:
        by = 1e-3 * t
        rate = (step(t + by).res.way - step(t - by).res.way) / (2 * by)
        errors.append(abs(rate - mean_velocity(t)))
    assert errors[0] < 1e-2 * abs(mean_velocity(steps[0]))
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 1.7
