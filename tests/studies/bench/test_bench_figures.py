"""Work-precision figures: lines that are envelopes, axes that can be read, scenes that are explained."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.text import Text

from studies.bench import flexible
from studies.bench.race import Row
from studies.bench.shown.figures import _apart, envelope, work_precision
from studies.bench.truth.reference import SCENES


def test_an_envelope_has_the_settings_that_none_beats_in_both():
    errors, seconds = [1e-4, 1e-4, 4e-5, 3e-4, 8e-4], [0.5, 3.0, 0.1, 0.08, 0.04]
    assert envelope(errors, seconds) == [(8e-4, 0.04), (3e-4, 0.08), (4e-5, 0.1)]
    rng = np.random.default_rng(3)
    points = rng.random((50, 2))
    best = envelope(*points.T.tolist())
    for error, time in points:
        assert any(e <= error and t <= time for e, t in best)
    for one in best:
        assert not any(e < one[0] and t < one[1] for e, t in points)


def rows(scene: str, errors: list[float]) -> list[Row]:
    return [Row("hoop-pulse reduced", f"rtol {e:g}", scene, [1e-3 / e, 1.1e-3 / e], error=e) for e in errors]


@pytest.mark.parametrize("errors", [[1e-6, 1e-4, 1e-3], [2e-4, 3e-4, 6e-4]])
def test_every_axis_has_two_numbers_at_least(errors):
    scene = next(iter(SCENES))
    figure = work_precision(rows(scene, errors), "flexible")
    figure.draw_without_rendering()
    (axes,) = figure.axes
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
        told = [t for t in ticks if t.label1.get_text() and low <= t.get_loc() <= high]
        assert len(told) >= 2
    assert SCENES[scene] in axes.get_title()


def test_settings_of_one_error_are_named_beside_their_points():
    """As they say what they are of, and clear of one another and of all points; a point for each tolerance has none."""
    took = {"first": 5e-3, "one": 5e-5, "batch, one core": 1.1e-5, "batch, all cores": 1e-5}
    ours = [
        Row("hoop-pulse", name, "k", [t, t], error=2e-16, note="per scene" if "batch" in name else "")
        for name, t in took.items()
    ]
    others = [Row("scipy", f"rtol {e:g}", "k", [1e-3 / e**0.1], error=e) for e in (1e-12, 1e-8, 1e-4)]
    figure = work_precision(ours + others, "rigid")
    figure.draw_without_rendering()
    (axes,) = figure.axes
    renderer = figure.canvas.get_renderer()
    boxes = {text.get_text(): Text.get_window_extent(text, renderer) for text in axes.texts}  # without its line
    assert set(boxes) == {"first", "one", "batch, one core, per scene", "batch, all cores, per scene"}
    within = axes.get_window_extent(renderer)
    for row in ours:
        (name,) = (name for name in boxes if name.startswith(row.setting))
        box, (x, y) = boxes[name], axes.transData.transform((row.error, row.median))
        assert 4 < box.x0 - x < 20
        assert abs((box.y0 + box.y1) / 2 - y) < 1.5 * box.height
        assert box.x1 < within.x1
        assert not any(box.overlaps(other) for its, other in boxes.items() if its != name)
    points = axes.transData.transform([(row.error, row.median) for row in ours + others])
    assert not any(box.contains(x, y) for box in boxes.values() for x, y in points)
    assert (
        boxes["batch, all cores, per scene"].y1 < boxes["batch, one core, per scene"].y0
    )  # in the order of the points


@pytest.mark.parametrize("heights", [[0.1, 0.5, 0.9], [0.3, 0.3, 0.3], [0.1, 0.11, 0.14, 0.15, 0.9]])
def test_names_are_moved_apart_no_more_than_they_need(heights):
    moved = np.array(_apart(heights, 0.05))
    assert np.diff(moved).min() >= 0.05 - 1e-12
    assert moved.mean() == pytest.approx(np.mean(heights), rel=1e-12)
    if np.diff(heights).min() >= 0.05:
        np.testing.assert_allclose(moved, heights)


def test_the_scenes_of_the_flexible_benchmark_are_explained():
    assert {flexible.SCENE_A, flexible.SCENE_B, flexible.MASSLESS} == set(SCENES)


def test_every_panel_says_of_what_its_errors_are():
    """The massless pulse is measured by its impulse ratio alone, the others by impulses and loss over J_N."""
    drawn = work_precision([*rows("scene B, pulse", [1e-4, 1e-3]), *rows(flexible.MASSLESS, [1e-4, 1e-3])], "flexible")
    assert [axes.get_xlabel() for axes in drawn.axes] == [
        "error of $J_N$, $J_F$ and the loss, over $J_N$",
        "error of $J_F/J_N$",
    ]
