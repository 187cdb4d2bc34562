"""The blocks of a frame: what their cells cover, and which way they are turned."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from meshes import (
    MeshError,
    Placement,
    SeriesError,
    disk_block,
    floor_block,
    rim_block,
    ring_block,
    ring_mesh,
    save_mesh,
)


def areas(block):
    """Of plane cells, positive where their corners go round counterclockwise."""
    x, y, _ = np.moveaxis(block.points[block.cells], -1, 0)
    return (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1) / 2


def test_a_disk_is_a_polygon_about_its_centre():
    """Of n corners: n triangles of r^2 sin(2 pi/n)/2 each, whose first corner is the centre."""
    disk = disk_block((3.0, -1.0), 0.5, 0.7, sectors=24)
    assert areas(disk) == pytest.approx(np.full(24, 0.125 * np.sin(2 * pi / 24)), rel=1e-12)
    assert disk.points[disk.cells[:, 0]] == pytest.approx(np.tile([3.0, -1.0, 0.0], (24, 1)))
    assert set(disk.cells[:, 1]) == set(disk.cells[:, 2]) == set(range(1, 25))


def test_what_blocks_share_nobody_writes_to():
    """One array serves all disks, rims and rings: who moves its numbers in place would move them everywhere."""
    ring = ring_mesh(0.9, 1.0, 8)
    for block in (
        disk_block((0.0, 0.0), 1.0, 0.0),
        rim_block(ring, ring.points[ring.rim_nodes]),
        ring_block(ring, ring.points),
    ):
        with pytest.raises(ValueError, match="read-only"):
            block.cells[0] += 1


@pytest.mark.parametrize("radius", [0.0, -1.0, float("nan"), float("inf")])
def test_bodies_that_cannot_be(radius):
    with pytest.raises(SeriesError, match="a disk of radius"):
        disk_block((0.0, 0.0), radius, 0.0)
    with pytest.raises(SeriesError, match="a floor from"):
        floor_block(-1.0, 1.0, radius)


def test_a_disk_is_somewhere():
    for centre, angle in (((0.0, float("nan")), 0.0), ((0.0, 0.0), float("inf"))):
        with pytest.raises(SeriesError, match="a disk of radius"):
            disk_block(centre, 1.0, angle)


@pytest.mark.parametrize("phi", [0.0, 0.4, pi / 2, 4.0])
def test_the_halves_of_a_disk_turn_clockwise_with_the_hoop(phi):
    """At phi = 0 the half 0 is above; it turns as what is fixed to the disk does: its middle is along y1."""
    centre = np.array([1.0, 2.0])
    disk = disk_block(centre, 0.5, phi)
    middle = disk.points[disk.cells].mean(axis=1)[:, :2]
    upper = (middle[disk.cell_data["half"] == 0] - centre).mean(axis=0)
    lower = (middle[disk.cell_data["half"] == 1] - centre).mean(axis=0)
    y1 = Placement(phi, 0.0, 0.0).axes[0]
    # the centroid of half a disk lies 4 r/(3 pi) from the centre, and the polygon's is as near as its corners are many
    assert upper == pytest.approx(4 * 0.5 / (3 * pi) * y1, abs=1e-3)
    assert lower == pytest.approx(-upper, abs=1e-12)


def test_the_floor_is_a_slab_below_nought():
    floor = floor_block(-1.0, 3.0, 0.25)
    assert areas(floor) == pytest.approx([1.0])
    assert floor.points[:, 1].max() == 0
    assert (floor.points.min(axis=0) == [-1.0, -0.25, 0.0]).all()


def test_the_line_of_the_rim_goes_once_round_it():
    """VTK has the ends of a quadratic edge first; three nodes of a parabola give its length by Simpson's rule.

    That of a circle they miss by less than (element)^4/100: 60 elements, 1.2e-6.
    """
    ring = ring_mesh(0.9, 1.0, 60)
    rim = rim_block(ring, ring.points[ring.rim_nodes])
    first, last, middle = np.moveaxis(rim.points[rim.cells], 1, 0)
    speeds = [-3 * first + 4 * middle - last, last - first, first - 4 * middle + 3 * last]
    lengths = np.array([1, 4, 1]) @ np.linalg.norm(speeds, axis=-1) / 6
    vertex = ring.rim_theta[::2]
    assert lengths == pytest.approx(np.diff(vertex, append=vertex[0] + 2 * pi), rel=1.2e-6)
    assert sorted(rim.cells[:, 0]) == sorted(rim.cells[:, 1]), "each element ends where another begins"


@pytest.mark.parametrize(
    "made",
    [
        lambda: disk_block((0,), 0.1, 0.2),
        lambda: disk_block((0, 1, 2), 0.1, 0.2),
        lambda: disk_block("ab", 0.1, 0.2),
        lambda: disk_block((0, 1), 0.1, 0.2, sectors=10.5),
        lambda: disk_block((0, 1), "a", 0.2),
        lambda: floor_block("a", 1.0, 0.1),
    ],
)
def test_what_makes_no_block_is_refused_in_a_sentence(made):
    """In the class that is documented, not by what numpy makes of it."""
    with pytest.raises(SeriesError, match=r"^a (disk|floor) .* is not possible\.$"):
        made()


@pytest.mark.parametrize(
    "wrong", [{"inner": "a"}, {"outer": None}, {"around": "40"}, {"weld_half_angle": "x"}, {"grading": "a"}]
)
def test_what_makes_no_ring_is_refused_in_a_sentence(wrong, tmp_path):
    with pytest.raises(MeshError, match=r"\.$"):
        ring_mesh(**({"inner": 0.9, "outer": 1.0, "around": 8} | wrong))
    with pytest.raises(MeshError, match="length = 'a' is not possible"):
        save_mesh(ring_mesh(0.9, 1.0, 8), tmp_path / "a.vtu", length="a")
