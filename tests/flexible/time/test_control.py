"""Lengths of steps from the errors of the last two."""

from itertools import pairwise

import pytest

from flexible.time.control import AFRESH, MOST, Pace, longer, shorter

ORDER = 3


def marched(scale, steps=60, t=0.0):
    """Errors (h/scale(t))^3 over the tolerance: accepted steps (t, h, error), and how many were not."""
    h, before, taken, rejected = scale(t) / 10, AFRESH, [], 0
    while len(taken) < steps:
        error = (h / scale(t)) ** ORDER
        if error > 1:
            h, rejected = shorter(h, error, 1 / ORDER), rejected + 1
            continue
        now = Pace(h, error)
        taken.append((t, h, error))
        t, h, before = t + h, longer(before, now, 1 / ORDER), now
    return taken, rejected


def test_steps_that_shrink_by_a_constant_factor_are_foreseen():
    """Towards t = 1 the time in which things change is a fifth of what is left; the last error alone always
    asks for too much."""
    taken, rejected = marched(lambda t: (1 - t) / 5)
    assert rejected <= 1  # where the pattern begins
    assert taken[-1][2] == pytest.approx(0.9**ORDER, rel=0.05)  # the safety of a step that is foreseen


def test_steps_that_grow_are_bounded():
    """From a tenth of what there is to resolve the step grows to it, no faster than said; none is tried in vain."""
    taken, rejected = marched(lambda t: 1.0, 20)
    assert rejected == 0
    lengths = [h for _, h, _ in taken]
    assert max(b / a for a, b in pairwise(lengths)) <= MOST * (1 + 1e-12)
    assert lengths[-1] == pytest.approx(0.9, rel=0.1)  # its fixed point, where the error is as foreseen


def test_a_step_that_could_not_be_solved_is_tried_shorter():
    assert shorter(1.0, float("inf"), 1 / ORDER) == pytest.approx(0.2)
