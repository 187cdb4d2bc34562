"""An instant as it is drawn: where the contact is."""

from dataclasses import replace

import numpy as np
import pytest

from meshes import Block, Placement
from meshes.draw.scales import scalar, tidy
from meshes.draw.shots import Shot
from meshes.fields import LINE

THETA = np.array([-0.5, -0.2, -0.1, 0.0, 0.1, 0.2, 0.7])  # denser where it touches, as a rim is


def shot(pressure, moved=0.0):
    """A rim that lies on the floor, x = theta, displaced sideways."""
    points = np.column_stack([THETA, 0 * THETA, 0 * THETA])
    displacement = np.column_stack([0 * THETA + moved, 0 * THETA, 0 * THETA])
    data = {"theta": THETA, "pressure": np.array(pressure, dtype=float), "displacement": displacement}
    lines = np.column_stack([np.arange(6), np.arange(1, 7)])
    ring = Block(points, lines, LINE, {})
    return Shot(0.0, ring, None, np.array([3.0, 1.0]), 1.0, rim=Block(points, lines, LINE, data))


def test_the_contact_is_where_the_pressure_is():
    """Its middle, whatever the rim's points are apart, and displaced as the rim is drawn."""
    assert shot([0, 0, 0, 2, 0, 0, 0]).contact(1.0) == pytest.approx(0.0)
    even = shot([0, 0, 1, 2, 1, 0, 0], moved=0.4)
    assert even.contact(1.0) == pytest.approx(0.4), "symmetric about 0 before it moved"
    assert even.contact(10.0) == pytest.approx(4.0)
    # a point that stands for three times as much of the rim weighs as much
    assert shot([0, 0, 0, 0, 1, 1, 0]).contact(1.0) == pytest.approx((0.1 * 0.1 + 0.3 * 0.2) / 0.4)


def test_without_a_pressure_it_is_below_the_centre():
    """Off the floor, or where the rim has no such field, or none is there."""
    off = shot(0 * THETA)
    assert off.contact(1.0) == 3.0
    assert replace(off, rim=None).contact(1.0) == 3.0
    assert replace(off, rim=off.ring).contact(1.0) == 3.0


@pytest.mark.parametrize(
    ("factor", "tidied"), [(0.3, 1), (1, 1), (1.99, 1), (2, 2), (4.9, 2), (5, 5), (20, 20), (999, 500)]
)
def test_a_tidy_factor_is_the_next_one_below(factor, tidied):
    """1, 2 or 5 times a power of ten, which are their own."""
    assert tidy(factor) == pytest.approx(tidied, rel=1e-12)


@pytest.mark.parametrize(("phi", "pulled"), [(np.pi / 2, "xx"), (np.pi, "yy")])
def test_a_component_of_the_stress_is_that_of_the_world(phi, pulled):
    """A pull of 3 along y1, to the disk: sideways it is sigma_xx, upright sigma_yy."""
    stress = Placement(phi, 0.0, 0.0).stress(np.array([[3.0, 0.0, 0.0]]))
    block = Block(np.zeros((1, 3)), np.zeros((1, 2), dtype=int), LINE, {"stress": stress})
    told = {component: float(scalar(block, f"stress {component}")[0]) for component in ("xx", "yy", "xy")}
    assert told == pytest.approx({"xx": 0.0, "yy": 0.0, "xy": 0.0} | {pulled: 3.0}, abs=1e-15)
