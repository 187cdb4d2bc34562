"""Work-precision figures: lines that are envelopes, axes that can be read, scenes that are explained."""

from __future__ import annotations

import numpy as np
import pytest

from studies.bench import flexible
from studies.bench.race import Row
from studies.bench.shown.figures import envelope, work_precision
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


def test_the_scenes_of_the_flexible_benchmark_are_explained():
    assert {flexible.SCENE_A, flexible.SCENE_B, flexible.MASSLESS} == set(SCENES)
