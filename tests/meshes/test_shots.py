"""An instant as it is drawn: where the contact is."""

from dataclasses import replace

import numpy as np
import pytest

from meshes import Block, Placement
from meshes.draw.display import ViewError
from meshes.draw.scales import limits, scalar, scale_of, tidy, tidy_factor
from meshes.draw.shots import Curves, Shot
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


@pytest.mark.parametrize("field", ["stress", "stress zz", "strain"])
def test_a_ring_is_coloured_by_what_is_listed_and_by_nothing_else(field):
    """Of a tensor that are its components: its norm as that of a vector would count the shear once."""
    block = Block(np.zeros((1, 3)), np.zeros((1, 2), dtype=int), LINE, {"stress": np.ones((1, 3))})
    with pytest.raises(ViewError, match="the series holds: stress xx, stress yy, stress xy"):
        scalar(block, field)


def coloured(values):
    """An instant of a ring whose points have these values of a field."""
    block = Block(np.zeros((len(values), 3)), np.zeros((1, 2), dtype=int), LINE, {"hoop_stress": np.array(values)})
    return Shot(0.0, block, None, np.zeros(2), 1.0)


def test_colours_reach_from_the_least_to_the_largest_of_the_run():
    """But for the highest thousandth; of a signed field, whose middle colour is 0, as far to either side."""
    tension, pressure = coloured(np.linspace(0, 2, 10_001)), coloured(np.linspace(0, -5, 10_001))
    low, high = limits([tension, pressure], "hoop_stress", False)
    assert low == -5.0
    assert high == pytest.approx(2.0, abs=0.01)
    low, high = limits([tension, pressure], "hoop_stress", True)
    assert low == -high
    assert high == pytest.approx(5.0, abs=0.02)
    assert limits([tension], "hoop_stress", False)[0] == 0.0
    spike = coloured([*np.linspace(0, 2, 10_001), 1e6])
    assert limits([spike], "hoop_stress", False)[1] == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize("R", [1.0, 0.02])
def test_displacements_are_enlarged_to_a_share_of_the_radius(R):
    """Up to 0.06 R, and no less than two fifths of that, whatever the unit of length."""
    seen = []
    for size in (1e-5, 3e-4):
        moved = shot([0, 0, 0, 1, 0, 0, 0], moved=size * R)
        seen.append(replace(moved, ring=moved.rim, radius=R))
    factor = tidy_factor(seen)
    assert 0.4 * 0.06 < 3e-4 * factor <= 0.06 * (1 + 1e-12)
    assert tidy_factor([replace(seen[0], ring=coloured([1.0]).ring)]) == 1.0, "nothing moves"


def test_arrows_are_scaled_by_the_largest_resultant_and_slip():
    """Of N = 3 and F = -4 at one instant it is 5; slips count without their sign."""
    curves = Curves(np.arange(3.0), np.array([4.5, 3.0, 1.0]), np.array([0.0, -4.0, 1.0]))
    shots = [replace(coloured([0.0]), slip_velocity=v) for v in (None, -0.7, 0.2)]
    assert scale_of(curves, shots) == {"force": 5.0, "slip": 0.7, "usual": 0.0}
