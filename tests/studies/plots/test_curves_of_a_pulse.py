"""Curves through a pulse as they are drawn: where their clock begins, and how far they are from a motion."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from rigid import Friction, Hoop, Release, Run, Scene, simulate
from studies.plots.difference import FORCES, at_the_same_angle, at_the_same_normal_impulse, impulses_along, passage_of
from studies.plots.distance import Distance, draw
from studies.plots.pulse import impulses, pulse
from studies.plots.style import RIGID
from studies.running.history import through


@pytest.mark.parametrize("turn", [0, 1, -2])
@pytest.mark.parametrize("way", [1, -1])
def test_time_counts_from_the_instant_at_which_the_disk_is_lowest(way, turn):
    """phi = pi mod 2 pi at t = 0.3, whichever way it turns and whatever turns it has behind it."""
    t = np.linspace(0.0, 1.0, 41)
    phi = (2 * turn + 1) * pi + way * np.sin(t - 0.3)
    columns = {"t": t, "phi": phi, **{name: np.cos(t) for name in FORCES}}
    figure = pulse([("rigid", columns, RIGID)])
    # straight between times that are 0.025 apart; the sine's bend over such a step is 1e-5
    assert figure.axes[0].lines[0].get_xdata() == pytest.approx(t - 0.3, abs=1e-5)


def test_the_axis_of_differences_is_that_of_what_is_seen():
    """Of what is left of the pulse at its end, 2e-4; before the hoops part it is small beyond measure."""
    normal = np.linspace(0.0, 1.0, 41)
    columns = {"t": normal, "normal_impulse": normal, "friction_impulse": 0.2 * normal}
    apart = np.where(normal < 0.8, 1e-9, 1e-4 * (1 + normal))
    axes = impulses([("1e9", columns, "0.5"), ("rigid", columns, RIGID)], 0.3, [apart]).axes[2]
    low, high = axes.get_ylim()
    assert 1e-5 < low < 1.8e-4 < 2e-4 < high < 1e-3


@pytest.mark.parametrize("way", [1, -1])
def test_a_motion_and_its_mirror_image_differ_from_themselves_by_nothing(way):
    """To either side; friction and slip change their sign in a mirror, and so does what is left of a larger force."""
    release = Release(way * np.deg2rad(10))
    motion = simulate(Scene(Hoop(0.25), Friction(0.35, 0.3), release, Run(until="pulse")))
    own = motion.pulses[0]
    assert np.sign(own.phi_end - own.phi_start) == way
    columns = through(motion, own)
    larger = {**columns, **{name: columns[name] + np.array(0.25) for name in FORCES}}
    apart = at_the_same_angle(larger, passage_of(motion, own))
    for name in FORCES:
        known = np.isfinite(apart[name])
        assert known.sum() > 0.9 * known.size
        assert np.median(apart[name][known]) == pytest.approx(0.25, abs=1e-9)
    beside = at_the_same_normal_impulse(columns, impulses_along(motion, own))
    assert np.isfinite(beside).all()
    assert np.abs(beside).max() < 1e-12


def test_the_cone_of_friction_is_drawn_at_its_slopes():
    columns = {
        "t": np.array([0.0, 1.0]),
        "normal_impulse": np.array([0.0, 4.0]),
        "friction_impulse": np.array([0, 1.0]),
    }
    axes = impulses([("rigid", columns, RIGID)], 0.3).axes[0]
    lines = [line.get_xydata() for line in axes.lines if line.get_linestyle() == "--"]
    assert [line[-1, 1] / line[-1, 0] for line in lines] == pytest.approx([0.3, -0.3])
    for text, slope in zip(axes.texts, (0.3, -0.3), strict=True):
        assert text.xy[1] / text.xy[0] == pytest.approx(slope)
        assert ("+" in text.get_text()) == (slope > 0)


def test_what_lies_above_the_rigid_value_is_filled_and_what_lies_below_is_open():
    s = np.geomspace(1e7, 1e10, 4)
    off = np.array([-3e-2, -1e-2, 2e-3, 1e-3])
    nothing = np.zeros(4)
    told = Distance(s, off, nothing, 1 / 3, (0.3, 0.4), "95 %", (0, 1, 2, 3), (s, off), None, "foundation")
    (axes,) = draw({"impulse_ratio": told})
    marks = {line.get_label(): line for line in axes.lines if line.get_marker() == "o"}
    above, below = marks["above the rigid value"], marks["below the rigid value"]
    assert above.get_xydata().tolist() == [[s[2], 2e-3], [s[3], 1e-3]]
    assert below.get_xydata().tolist() == [[s[0], 3e-2], [s[1], 1e-2]]
    assert above.get_markerfacecolor() == above.get_color()
    assert below.get_markerfacecolor() == "white"
