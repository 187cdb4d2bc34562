"""Pressure and friction in the patch, read from the rim and drawn beside the hoop."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from meshes import Block, SeriesWriter, read
from meshes.draw.display import renderer_problem
from meshes.draw.patch import PatchPlot, patch_of
from meshes.draw.shots import SeriesSource
from meshes.draw.style import UNITS
from meshes.view.pictures import Camera
from meshes.view.setting import setting

SIZE = (640, 480)
TIMES = np.linspace(0, 1.2, 5)

needs_renderer = pytest.mark.skipif(renderer_problem() is not None, reason=str(renderer_problem()))


@pytest.fixture(scope="module")
def series(tmp_path_factory, ring, ovals):
    """A parabolic pressure of half-width 0.04 about the lowest point, friction 0.3 of it; nothing at the end."""
    directory = tmp_path_factory.mktemp("patch")
    with SeriesWriter(directory, title="oval") as writer:
        writer.history(**ovals.history(TIMES))
        for frame in ovals.frames(ring, TIMES):
            rim = frame.blocks["rim"]
            x = rim.points[:, 0] - frame.time
            low = rim.points[:, 1] < 0.5
            pressure = np.where(low, np.maximum(1 - (x / 0.04) ** 2, 0), 0.0) * (frame.time < 1.1)
            fields = {"displacement": rim.point_data["displacement"], "pressure": pressure, "traction": 0.3 * pressure}
            block = Block(rim.points, rim.cells, rim.cell_type, fields)
            writer.add(replace(frame, blocks={**frame.blocks, "rim": block}))
    return read(directory)


def test_the_patch_is_read_from_left_to_right_with_its_edges(series):
    x, pressure, traction = patch_of(SeriesSource(series).shot(0.3))
    assert (np.diff(x) >= 0).all()
    assert pressure[[0, -1]].tolist() == [0, 0]
    assert (pressure[1:-1] > 0).all()
    np.testing.assert_allclose(traction, 0.3 * pressure)
    assert np.abs(x).max() < 0.07
    assert all(len(column) == 0 for column in patch_of(SeriesSource(series).shot(1.2)))


def test_a_rim_without_pressure_has_no_patch(series):
    shot = SeriesSource(series).shot(0.3)
    assert all(len(column) == 0 for column in patch_of(replace(shot, rim=None)))


@pytest.mark.parametrize("known", [True, False])
def test_a_friction_that_is_not_known_is_not_drawn(series, known):
    """A series with the pressure alone says nothing of the friction: no curve of it along 0, no word."""
    shot = SeriesSource(series).shot(0.3)
    if not known:
        point_data = {name: value for name, value in shot.rim.point_data.items() if name != "traction"}
        shot = replace(shot, rim=replace(shot.rim, point_data=point_data))
    plot = PatchPlot(Figure().add_subplot(), [shot], UNITS, 8.0)
    plot.show(shot)
    assert [text.get_text() for text in plot.axes.texts] == ["pressure", "friction"][: 1 + known]
    highest = [curve.get_xy()[:, 1].max() for curve in plot.moving]
    assert highest == pytest.approx([1.0, 0.3][: 1 + known], rel=0.05)  # of the parabola, to a node beside its top
    assert len(patch_of(shot)[0]) > 3


@needs_renderer
def test_the_patch_is_drawn_clear_of_the_hoop(series):
    """Blue where the pressure is, in the axes at the left; the hoop begins to the right of them."""
    with Camera(setting(series), SIZE) as camera:
        assert camera.layout.aside > 0
        left, top, width, height = camera.layout.view_box
        pages = [camera.page(time).astype(int) for time in (0.3, 1.2)]
        box = (slice(top + height // 3, top + int(0.85 * height)), slice(left, left + camera.layout.aside))
        blue = [(page[box][..., 2] - page[box][..., 0] > 30).sum() for page in pages]
        assert blue[0] > 500
        assert blue[1] < 0.2 * blue[0]
        for time in TIMES:
            shot = camera.setting.source.shot(time)
            middle = camera._middle(shot)
            start = width / 2 + (shot.centre[0] - shot.radius - middle) * camera.scale
            assert start > camera.layout.aside


@needs_renderer
def test_an_enlarged_view_has_no_patch_beside_it(series):
    with Camera(setting(series, zoom=5), SIZE) as camera:
        assert camera.layout.aside == 0
