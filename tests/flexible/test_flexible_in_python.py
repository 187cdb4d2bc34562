"""The flexible motion in a session or a notebook: what it takes, curves, tables, a few lines."""

from __future__ import annotations

import dataclasses
import json

import matplotlib as mpl
import numpy as np
import pytest

import rigid
from flexible import ensure_possible, load_motion, rigid_limit, simulate
from rigid import MotionFileError, SceneError, load_scene, scene_to_dict

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


@pytest.mark.parametrize("kept", [True, False])
def test_tables_and_curves_of_a_hoop_that_bounces(kept):
    """A soft one chatters: its forces are back where they were before the next of a hundred instants. The march knows
    them at its steps, and a table, a picture and that of a pulse have every one, whether the motion kept them or not.
    """
    from matplotlib import pyplot

    soft = {"hoop": {"mass_ratio": 0.1}, "ring": {"bending_stiffness": 5.0}, "contact": {"stiffness": 1e6}}
    motion = simulate(SCENE.replace(**soft), history=kept)
    steps = np.unique(np.concatenate([piece.segment["t"] for piece in motion.sample.pieces if piece.segment]))
    between, table = (steps[1:] + steps[:-1]) / 2, motion.to_dataframe()
    # two that are 1e-13 apart, where the patch jumps, and a time between them is told to 1e-15
    straight = 1e-6 + 2 * np.spacing(between) / np.diff(steps)
    assert len(table) < 1.2 * motion.steps + 500
    pulse, names = motion.pulses[0], ("normal_force", "friction_force", "slip_velocity", "omega")
    inside = (between > pulse.t_start) & (between < pulse.t_end)
    drawn = pulse.plot(*names)
    for name, axes in zip(names, drawn, strict=True):
        for these, (x, y) in ((slice(None), (table["t"], table[name])), (inside, axes.lines[-1].get_xydata().T)):
            off = np.interp(between[these], x, y) - getattr(motion.at(between[these]), name)
            assert (np.abs(off) < straight[these] * np.ptp(y)).all()
    jump = motion.sample.pieces[1].t_start  # where the flexible hoop takes over
    for name in ("normal_force", "y_C"):
        for side, when in (("left", jump - 1e-11), ("right", jump)):
            expected = getattr(motion.at(jump, side), name)
            assert np.interp(when, table["t"], table[name]) == pytest.approx(expected, rel=1e-6)
    pyplot.close("all")


def test_a_few_lines_say_what_it_is(motion):
    lines = repr(motion).splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 100
    assert "foundation 1e+08" in repr(motion)
    assert dict(motion._lines())["lost to"].startswith("friction ")
    assert "lost to" in motion._repr_html_()
    assert len(repr(motion.history)) < 40
    assert "sample" not in str(motion.to_dict())


def test_states_at_one_time_are_numbers(motion):
    """In the rigid stretches and in the flexible one, as of the rigid hoop; arrays have the shape of their times."""
    pulse = motion.pulses[0]
    for t in (pulse.t_start / 2, (pulse.t_start + pulse.t_end) / 2):
        now = dataclasses.asdict(motion.at(t))
        assert {type(value) for value in now.values()} == {np.float64}
        assert json.loads(json.dumps(now)) == now
        for name, value in dataclasses.asdict(motion.at([[t, t]])).items():
            assert value.shape == (1, 2)
            assert (value == now[name]).all()


def test_a_pulse_in_a_few_lines(motion):
    pulse = motion.pulses[0]
    lines = str(pulse).splitlines()
    assert len(lines) <= 10
    assert max(map(len, lines)) <= 100
    assert f"J_F/J_N = {pulse.impulse_ratio:.6g}" in str(pulse)
    assert ", ".join(str(phase.kind) for phase in pulse.phases) in str(pulse)
    assert f"contact {pulse.contact_energy_peak:.6g} mgR" in str(pulse)


def test_a_motion_comes_back_from_its_file(tmp_path, motion):
    """To the last bit, in units of its own too; the ring's states are in the file if the motion has them."""
    units = {"hoop": {"R": 0.4, "m": 0.2, "g": 9.81}, "run": {"turns": 1}}
    for number, found in enumerate((motion, simulate(SCENE.replace(**units)))):
        path = tmp_path / f"motion{number}"
        found.save(path)
        again = load_motion(path)
        assert again == found
        assert again != dataclasses.replace(found, steps=found.steps + 1)
        assert (again.scene, again.ended, again.steps) == (found.scene, found.ended, found.steps)
        assert again.ledger == found.ledger
        assert again.phases == found.phases
        assert again.turns == found.turns
        assert again.pulses == found.pulses
        t = np.linspace(0, found.t_end, 300)
        for name in ("phi", "x_C", "slip_velocity", "normal_force", "friction_force", "energy", "alpha"):
            assert (getattr(again.at(t), name) == getattr(found.at(t), name)).all()
        assert (again.history is None) == (found.history is None)
        assert [len(kept.states) for kept in again.kept] == [len(kept.states) for kept in found.kept]
        with pytest.raises(MotionFileError, match=r"flexible\.load_motion reads it"):
            rigid.load_motion(path)
    steps, read = motion.history.to_dataframe(), load_motion(tmp_path / "motion0").history.to_dataframe()
    assert (steps == read).all().all()
    whole = (tmp_path / "motion0").read_bytes()
    (tmp_path / "motion0").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(MotionFileError, match="is not a saved motion, or damaged"):
        load_motion(tmp_path / "motion0")


def test_a_rigid_motion_comes_back_too(tmp_path):
    found = rigid.simulate("paper-3.1")
    found.save(tmp_path / "rigid")
    assert load_motion(tmp_path / "rigid") == found


def test_what_takes_a_scene_takes_its_name():
    assert rigid_limit("paper-3.3-light") == load_scene("paper-3.3-light")
    with pytest.raises(SceneError, match=r"hoop\.k = 0 is not possible here"):
        ensure_possible({**scene_to_dict("paper-3.1"), "hoop": {"point_mass": True}})
