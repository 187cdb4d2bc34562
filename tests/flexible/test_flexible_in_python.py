"""The flexible motion in a session or a notebook: what it takes, curves, tables, a few lines."""

from __future__ import annotations

import matplotlib as mpl
import pytest

from flexible import rigid_limit, simulate
from rigid import SceneError, load_scene, scene_to_dict

mpl.use("Agg")
SCENE = load_scene("paper-3.3-massless").replace(
    run={"until": "pulse"}, contact={"stiffness": 1e8}, solve={"rtol": 1e-3}
)


@pytest.fixture(scope="module")
def motion():
    return simulate(scene_to_dict(SCENE), history=True)


def test_a_dict_is_a_scene(motion):
    again = simulate(SCENE)
    assert again.scene == motion.scene == SCENE
    assert again.pulses == motion.pulses
    assert rigid_limit(SCENE).hoop == SCENE.hoop
    with pytest.raises(SceneError, match="neither a file nor the name of a scene"):
        simulate("paper-3.3")


def test_curves_and_tables(motion):
    from matplotlib import pyplot

    top = motion.plot("normal_force")[0].lines[-1].get_ydata().max()
    pulse = motion.pulses[0]
    # drawn straight to two thousandths of its range
    assert top == pytest.approx(pulse.peak_normal_force, rel=4e-3)
    t = pulse.plot()[0].lines[-1].get_xdata()
    assert (t[0], t[-1]) == (pulse.t_start, pulse.t_end)
    steps = motion.history.to_dataframe()
    assert len(steps) == len(motion.history.t)
    assert (steps["ring_strain"] == motion.history.ring_strain).all()
    assert set(motion.to_dataframe()["phase"]) >= {"roll", "spin"}
    pyplot.close("all")


def test_a_few_lines_say_what_it_is(motion):
    lines = repr(motion).splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 100
    assert "foundation 1e+08" in repr(motion)
    assert "lost to friction" in motion._repr_html_()
    assert len(repr(motion.history)) < 40
    assert "sample" not in str(motion.to_dict())
