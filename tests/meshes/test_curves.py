"""The curves of N and F below a picture."""

from itertools import product

import numpy as np
import pytest

from meshes.draw.layout import Layout
from meshes.draw.shots import Curves, MotionSource
from rigid import load_scene, simulate


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [(-130.0, 74.0, [-100, 0, 10]), (0.0, 300.0, [0, 10, 100]), (-20.0, 0.5, [-10, 0]), (-0.2, 50.0, [0, 1, 10])],
)
def test_a_logarithmic_axis_has_a_tick_wherever_a_decade_is(low, high, ticks):
    """On both sides of zero, of a usual force of 1: between a single one and zero nothing can be read."""
    t = np.linspace(0, 1, 1001)
    force = np.ones_like(t)
    force[500:510] = 300.0
    friction = np.where((t > 0.5) & (t < 0.505), high, 0.3)
    friction[(t > 0.51) & (t < 0.515)] = low
    layout = Layout((640, 480), Curves(t, force, friction), (0.0, 1.0), None, {}, "")
    of_normal, of_friction = [axes for axes in layout.figure.axes if axes.get_yscale() == "asinh"]
    assert of_friction.get_yticks() == pytest.approx(ticks)
    assert "log" in [text.get_text() for text in of_friction.texts]
    assert "log" in [text.get_text() for text in of_normal.texts]


@pytest.mark.parametrize(("size", "high"), [((1280, 900), 75.0), ((1280, 900), 300.0), ((640, 480), 75.0)])
def test_between_the_powers_of_a_logarithmic_axis_are_strokes_and_numbers(size, high):
    """Of every whole multiple from the usual force, 1, up to the end of the axis; no number of them lies over another,
    to the pixel by which letters are rounded.
    """
    t = np.linspace(0, 1, 1001)
    force = np.where(np.abs(t - 0.5) < 0.01, high, 1.0)
    layout = Layout(size, Curves(t, force, 0.3 * force), (0.0, 1.0), None, {}, "")
    axes = next(axes for axes in layout.figure.axes if axes.get_ylabel().startswith("N"))
    numbers, end = axes.get_yticks(), axes.get_ylim()[1]
    multiples = {digit * 10**power for power in range(3) for digit in range(1, 10) if digit * 10**power <= end}
    assert set(np.round([*axes.get_yticks(minor=True), *numbers], 9)) == multiples | {0}
    fixed, added = (
        [box for text in axes.yaxis.get_ticklabels(which=kind) if text.get_text() and (box := text.get_window_extent())]
        for kind in ("major", "minor")
    )
    assert (len(added) > 0) == (size[0] > 1000), "there is no room on a small page"
    for one, other in product(added, fixed + added):
        assert one is other or one.y0 >= other.y1 - 1 or one.y1 <= other.y0 + 1


def test_a_pulse_far_above_the_usual_force_gets_a_logarithm():
    t = np.linspace(0, 1, 2001)
    spike = 1 + 200 * np.exp(-(((t - 0.5) / 0.004) ** 2))
    assert Curves(t, spike, 0.3 * spike).usual == pytest.approx(1)  # the median does not see the spike
    assert Curves(t, 1 + t, t).usual is None
    assert Curves(t, 0 * t, 0 * t).usual is None  # skimming or flight: nothing to take a logarithm of
    assert Curves(np.empty(0), np.empty(0), np.empty(0)).usual is None


@pytest.mark.parametrize("name", ["paper-3.1", "paper-3.4-tiny", "paper-point-mass", "paper-3.3-light"])
def test_curves_of_the_papers_motions_reach_the_peaks_of_their_pulses(name):
    """Sampled peaks lie a little below the true one, too little to see: a hundredth is a pixel."""
    motion = simulate(load_scene(name))
    curves = MotionSource(motion).curves
    assert (np.diff(curves.t) > 0).all()
    for pulse in motion.pulses:
        inside = (curves.t >= pulse.t_start) & (curves.t <= pulse.t_end)
        assert curves.normal_force[inside].max() == pytest.approx(pulse.peak_normal_force, rel=0.01)


def test_each_force_is_drawn_on_the_axis_that_bears_its_name():
    t = np.linspace(0, 1, 11)
    forces = {"N": 1 + t, "F": -t}
    layout = Layout((640, 480), Curves(t, forces["N"], forces["F"]), (0, 1), None, {}, "forces")
    axes = {ax.get_ylabel().split()[0]: ax for ax in layout.figure.axes if ax.get_ylabel()}
    assert set(axes) == set(forces)
    for name, force in forces.items():
        (drawn,) = (line for line in axes[name].lines if len(line.get_xdata()) == len(t))
        np.testing.assert_array_equal(drawn.get_xdata(), t)
        np.testing.assert_array_equal(drawn.get_ydata(), force)
