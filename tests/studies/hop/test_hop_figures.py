"""Figures of a hop study on rolls whose hops are made up: mirrored releases, hoops of several radii, narrow ranges."""

from __future__ import annotations

import numpy as np
import pytest

from rigid import Scene, load_scene
from studies import HopStudy
from studies.hop.figures import hop_map
from studies.hop.maps import HEIGHTS, angle_ticks, first_digits, map_figure
from studies.hop.rolling.threshold import HopCase, Line, windows
from studies.running.case import Outcome

SCENE = load_scene("paper-3.3-heavier")


def line_of(scene: Scene, value: object = None, swept: float = 3.0, height=0.01, stiffness=(5.0, 50.0)) -> Line:
    """The softest stops halfway after a hop, the others hop once and go on."""
    down = -1 if np.sin(scene.release.phi0) < 0 else 1
    cases = []
    for n, each in enumerate(stiffness):
        flight = {"t": 1.0, "phi": scene.release.phi0 + down * swept, "duration": 0.1, "height": height,
                  "prominence": 2.0, "swept": swept, "energies": None}  # fmt: skip
        motion = {"flights": [flight], "completed": n > 0, "swept": 4.0, "scales": None, "t_end": 1.0}
        cases.append(HopCase(each, scene, Outcome("", "", {}, "", motion=motion)))
    return Line(value, scene, windows(scene), tuple(cases))


@pytest.mark.parametrize(("phi0", "hop", "stopped"), [(10, 182, 239), (-10, -182, -239), (350, 178, 121)])
def test_where_hops_begin_is_shown_of_a_mirrored_release_too(phi0, hop, stopped):
    """It comes down the other side: hops, the angles of its pulse and how far one came lie there, and are in view."""
    axes = hop_map(HopStudy(SCENE, None, (line_of(SCENE.replace(release={"phi0_deg": phi0})),))).axes[0]
    low, high = axes.get_ylim()
    assert (low, high) == ((-360, 0) if phi0 < 0 else (0, 360))
    assert list(axes.collections[0].get_offsets()[:, 1]) == pytest.approx([hop, hop], abs=1)
    (cross,) = [line for line in axes.lines if line.get_label() == "stopped early"]
    assert cross.get_ydata() == pytest.approx([stopped], abs=1)
    for band in axes.patches:
        assert low <= band.get_y() <= band.get_y() + band.get_height() <= high


def test_releases_to_both_sides_share_their_scale():
    lines = [line_of(SCENE.replace(release={"phi0_deg": phi0}), phi0) for phi0 in (-10.0, 10.0)]
    figure = hop_map(HopStudy(SCENE, "release.phi0_deg", tuple(lines)))
    assert [axes.get_ylim() for axes in figure.axes[:2]] == [(-360, 360)] * 2


def test_heights_are_over_the_radius_of_their_own_hoop():
    """Of 0.02 m a hoop of 4 m hops half as high over R as one of 2 m."""
    units = SCENE.replace(hoop={"R": 1.0, "m": 1.0, "g": 9.81})
    lines = tuple(line_of(units.replace(hoop={"R": R}), R, height=0.02) for R in (2.0, 4.0))
    study = HopStudy(units, "hoop.R", lines)
    shown = [list(axes.collections[0].get_array()) for axes in hop_map(study).axes[:2]]
    assert shown == [pytest.approx([0.01] * 2), pytest.approx([0.005] * 2)]
    (heights,) = [axes for axes in map_figure(study).axes if axes.get_title().startswith("height")]
    assert heights.collections[0].get_array().tolist() == [pytest.approx([0.01] * 2), pytest.approx([0.005] * 2)]
    assert HEIGHTS[0] < 0.005, "nothing is cut off"


@pytest.mark.parametrize(("low", "high"), [(15.0, 80.0), (20.0, 60.0), (2.0, 2.2), (0.5, 70.0), (0.3, 2e4), (1.4, 1.6)])
def test_a_scale_of_stiffness_has_two_numbers_or_more(low, high):
    """However narrow its range: one number alone is no scale."""
    ticks = [m * 10.0**n for n in range(-12, 13) for m in first_digits(low, high, 6)]
    assert 2 <= sum(low <= tick <= high for tick in ticks) <= 12


@pytest.mark.parametrize(("low", "high"), [(100.0, 130.0), (181.0, 184.0), (-300.0, -20.0), (171.9, 172.3)])
def test_a_scale_of_angles_has_two_numbers_or_more(low, high):
    ticks = angle_ticks(np.array([[low, np.nan], [high, low]]))
    assert 2 <= len(ticks) <= 8
    assert low <= min(ticks) <= max(ticks) <= high
    assert angle_ticks(np.array([[90.0, np.nan]])) == [90.0], "there is but one"
    assert angle_ticks(np.array([[np.nan]])) == []


def test_a_narrow_map_has_these_scales():
    lines = [line_of(SCENE.replace(hoop={"k": k}), k, s, stiffness=(20.0, 30.0)) for k, s in ((0.1, 3.0), (0.2, 3.2))]
    figure = map_figure(HopStudy(SCENE, "hoop.k", tuple(lines)))
    for axes in figure.axes[:2]:
        low, high = axes.get_xlim()
        assert [tick for tick in axes.get_xticks() if low <= tick <= high] == [20, 30]
    bar = next(axes for axes in figure.axes if axes.get_label() == "<colorbar>")
    assert list(bar.get_yticks()) == [185, 190]


def test_a_map_over_releases_names_none_of_them():
    lines = [line_of(SCENE.replace(release={"phi0_deg": phi0}), phi0) for phi0 in (10.0, 20.0)]
    title = map_figure(HopStudy(SCENE, "release.phi0_deg", tuple(lines))).axes[0].get_title(loc="left")
    assert title.endswith("released at rest")


def test_each_threshold_is_told_from_the_others():
    """Hops in the pulse alone and at the bottom alone: three lines, each with words and a look of its own."""
    scenes = [SCENE.replace(hoop={"k": k}) for k in (0.1, 0.2)]
    angles = {10.0: np.pi - SCENE.release.phi0, 20.0: windows(SCENE)["pulse"].high - 1e-3, 40.0: 4.5, 80.0: None}
    lines = []
    for scene in scenes:
        rolls = [line_of(scene, swept=3.0 if swept is None else swept, stiffness=(1.0, stiffness)).mapped[1]
                 for stiffness, swept in angles.items()]  # fmt: skip
        rolls[-1].motion["flights"].clear()
        lines.append(Line(scene.hoop.k, scene, windows(scene), tuple(rolls)))
    axes = map_figure(HopStudy(SCENE, "hoop.k", tuple(lines))).axes[0]
    shown = [line for line in axes.lines if line.get_label().startswith("threshold")]
    assert [line.get_xdata()[0] for line in shown] == pytest.approx([56.6, 28.3, 14.1], rel=0.01), "between two rolls"
    assert len({(line.get_marker(), line.get_linestyle(), str(line.get_markerfacecolor())) for line in shown}) == 3
    (legend,) = [each for each in (axes.get_legend(), *axes.figure.legends) if each is not None]
    told = {text.get_text() for text in legend.get_texts()}
    assert {line.get_label() for line in shown} <= told
    assert len(shown) == 3


def test_colours_of_heights_say_that_some_are_beyond():
    """A hop of 0.3 R has the colour of 0.1 R: the bar shows that there is more, and less."""
    study = HopStudy(SCENE, "hoop.k", tuple(line_of(SCENE.replace(hoop={"k": k}), k, height=0.3) for k in (0.1, 0.2)))
    for figure in (hop_map(study), map_figure(study)):
        bars = [axes._colorbar for axes in figure.axes if axes.get_label() == "<colorbar>"]
        assert [bar.extend for bar in bars if tuple(bar.mappable.get_clim()) == HEIGHTS] == ["both"]
