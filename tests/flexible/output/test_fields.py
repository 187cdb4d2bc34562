"""A flexible motion as a series on disk: forces, energy, velocity, units and choices, read back from the files."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

import rigid
from flexible import simulate, write_fields
from flexible.output.fields import FIELDS
from flexible.segment import peak
from meshes import SeriesError, read
from meshes.draw import style
from rigid import Kind, load_scene

ROOT = Path(__file__).parents[3]


def scene(name="paper-3.3-light", **changes):
    return load_scene(name).replace(**{"run": {"until": "pulse"}, "solve": {"rtol": 1e-3}, **changes})


@pytest.fixture(scope="module")
def motion():
    return simulate(scene(), history=True)


@pytest.fixture(scope="module")
def at_steps(motion, tmp_path_factory):
    """Frames at accepted steps, and the history there; of two records at one instant the later counts."""
    history = motion.history
    chosen = np.flatnonzero(np.diff(history.t, append=np.inf) > 0)[5::10]
    directory = tmp_path_factory.mktemp("steps")
    write_fields(motion, directory, times=history.t[chosen])
    return list(read(directory)), chosen


def integral(rim, name):
    """Of a field of the rim around it, from the points' own positions."""
    points = np.asarray(rim.points, dtype=float)
    ends = rim.cells
    length = np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    value = np.asarray(rim.point_data[name], dtype=float)
    return float((value[ends].mean(axis=1) * length).sum())


def test_resultants_on_the_rim_are_n_and_f(motion, at_steps):
    frames, chosen = at_steps
    normal, friction = motion.history.normal_force[chosen], motion.history.friction_force[chosen]
    found = np.array([[integral(frame.blocks["rim"], name) for name in ("pressure", "traction")] for frame in frames])
    # chords for arcs of the rim: 1e-5 of an element's length, far less between contact points
    np.testing.assert_allclose(found[:, 0], normal, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(found[:, 1], friction, rtol=0, atol=1e-7 * (1 + normal.max()))


def test_pressure_is_the_foundation_times_the_penetration(motion, at_steps):
    """At the deformed rim points of the file; round-off of y near 0 is 1e-16 times the foundation.

    The damper, a relaxation time of the foundation, adds a share that is the same at every point of a patch.
    """
    frames, _ = at_steps
    stiffness = motion.scene.contact.stiffness
    damped = set()
    for frame in frames:
        rim = frame.blocks["rim"]
        height = rim.points[:, 1] + rim.point_data["displacement"][:, 1]
        nodes = np.isin(rim.point_data["theta"], frame_nodes(frame))  # between contact points the gap is not linear
        pressure = rim.point_data["pressure"]
        expected = np.where(pressure > 0, np.maximum(-stiffness * height, 0), 0.0)
        deepest = np.argmax(np.where(nodes, 0.0, expected))
        share = pressure[deepest] / expected[deepest]
        damped.add(share > 1)
        np.testing.assert_allclose(pressure[~nodes], share * expected[~nodes], rtol=1e-6, atol=2e-6 * pressure.max())
    assert damped == {False, True}  # N grows, and falls


def frame_nodes(frame):
    """Material angles of the rim's mesh nodes, as the longest run of equal spacing cannot tell: from the ring."""
    ring, rim = frame.blocks["ring"].points, frame.blocks["rim"]
    known = {tuple(point) for point in ring.tolist()}
    return rim.point_data["theta"][[tuple(point) in known for point in rim.points.tolist()]]


def test_energy_of_the_elements_is_the_ring_strain_of_the_ledger(motion, at_steps):
    frames, chosen = at_steps
    energy = [frame.blocks["ring"].cell_data["strain_energy"].sum() for frame in frames]
    known = motion.history.ring_strain[chosen]
    np.testing.assert_allclose(energy, known, rtol=1e-6, atol=1e-9 * known.max())


def test_stick_says_what_the_phase_says(motion, at_steps):
    frames, _ = at_steps
    seen = set()
    for frame in frames:
        kind = str(motion.phase_at(frame.time).kind)
        flags = set(np.unique(frame.blocks["rim"].point_data["stick"]).tolist()) - {0}
        assert flags == {"roll": {1}, "spin": {-1}, "skid": {-1}, "flight": set()}[kind]
        seen.add(kind)
    assert {"roll", "spin", "skid"} <= seen


def test_the_rim_sticks_or_slips_where_the_floor_presses_and_nowhere_else(at_steps):
    """At the contact's points and at the mesh's nodes among and beside them."""
    for frame in at_steps[0]:
        rim = frame.blocks["rim"].point_data
        np.testing.assert_array_equal(rim["stick"] != 0, rim["pressure"] > 0)


def test_the_line_of_the_rim_is_closed(at_steps):
    """From every point to the next, and from the last to the first; chords of 2 pi."""
    for frame in at_steps[0]:
        rim = frame.blocks["rim"]
        for end in rim.cells.T:
            np.testing.assert_array_equal(np.sort(end), np.arange(len(rim.points)))
        ends = np.asarray(rim.points, dtype=float)[rim.cells]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        # a chord lacks a 24th of its square
        assert length.sum() == pytest.approx(2 * np.pi, rel=length.max() ** 2 / 24)


def test_velocity_is_the_rate_of_the_position(motion, tmp_path):
    """Central differences of the deformed points over 2e-6 of time, in the middle of a smooth stretch."""
    pulse = motion.pulses[0]
    middle = pulse.t_start + 0.4 * (pulse.t_end - pulse.t_start)
    write_fields(motion, tmp_path, times=middle + 1e-6 * np.array([-1, 0, 1]), fields=("displacement", "velocity"))
    before, now, after = (frame.blocks["ring"] for frame in read(tmp_path))
    first, last = ((b.points + b.point_data["displacement"]).astype(float) for b in (before, after))
    rate = (last - first) / 2e-6
    velocity = now.point_data["velocity"]
    assert np.abs(velocity).max() > 1
    np.testing.assert_allclose(velocity, rate, atol=2e-3 * np.abs(velocity).max())


def test_points_of_a_sticking_patch_hardly_move(motion, at_steps):
    """The rim rolls off the floor: below a hundredth of the velocity of the hoop's top."""
    frames, _ = at_steps
    sticking = [f for f in frames if (f.blocks["rim"].point_data["stick"] == 1).any()]
    assert sticking
    for frame in sticking:
        rim = frame.blocks["rim"]
        stuck = rim.point_data["stick"] == 1
        speed = np.linalg.norm(rim.point_data["velocity"], axis=1)
        assert np.median(speed[stuck]) < 0.01 * speed.max()


def test_an_instant_between_two_steps_is_in_equilibrium_too(motion, tmp_path):
    """N there lies between its neighbours'; the frame has the time that was asked for."""
    history = motion.history
    i = int(np.argmax(history.normal_force)) - 40
    between = history.t[i] + 0.37 * (history.t[i + 1] - history.t[i])
    write_fields(motion, tmp_path, times=[between], fields=("pressure",))
    (frame,) = read(tmp_path)
    assert frame.time == between
    normal = integral(frame.blocks["rim"], "pressure")
    low, high = sorted(history.normal_force[[i, i + 1]])
    assert low * (1 - 1e-6) < normal < high * (1 + 1e-6)


def test_the_default_times_are_dense_where_the_force_changes(motion, tmp_path):
    write_fields(motion, tmp_path, frames=40, fields=("displacement",))
    series = read(tmp_path)
    pulse = motion.pulses[0]
    assert len(series) == 40
    assert series.times[0] < pulse.t_start
    assert series.times[-1] == pytest.approx(pulse.t_end, rel=1e-9)  # the flexible segment ends there
    rising = np.interp(series.times, motion.history.t, motion.history.normal_force)
    steepest = np.argmax(np.abs(np.diff(rising) / np.diff(series.times)))
    assert np.diff(series.times)[steepest] < 0.5 * np.diff(series.times).max()
    history = series.history
    assert history["t"][0] == series.times[0]
    assert history["t"][-1] == series.times[-1]
    assert (np.diff(history["t"]) >= 0).all()
    assert peak(history["t"], history["normal_force"]) == pytest.approx(motion.pulses[0].peak_normal_force, rel=1e-6)
    assert set(history["phase_kind"]) >= {"spin", "roll", "skid"}


def test_only_what_was_asked_for_is_there(motion, tmp_path):
    write_fields(motion, tmp_path, frames=2, fields=("von_mises", "energy_density"))
    ring = read(tmp_path)[1].blocks["ring"]
    assert set(ring.point_data) == {"von_mises", "energy_density"}
    assert set(ring.cell_data) == {"strain_energy"}
    assert "rim" not in read(tmp_path)[1].blocks
    write_fields(motion, tmp_path, frames=2)
    blocks = read(tmp_path)[1].blocks
    assert list(blocks) == ["ring", "rim", "disk", "floor"]
    assert set(blocks["ring"].point_data) | set(blocks["rim"].point_data) == {*FIELDS, "theta"}


def test_the_display_factor_is_kept_and_never_baked_in(motion, at_steps):
    """Undeformed points are a circle about the hoop's centre; what deforms them is of its true size."""
    frames, chosen = at_steps
    largest = 0.0
    for frame, x, y in zip(frames, motion.history.x_C[chosen], motion.history.y_C[chosen], strict=True):
        ring = frame.blocks["ring"]
        factor = float(ring.field_data["display_factor"][0])
        largest = max(largest, float(np.linalg.norm(ring.point_data["displacement"], axis=1).max()))
        radius = np.linalg.norm(ring.points[:, :2] - [x, y], axis=1)
        assert radius.max() == pytest.approx(1, abs=1e-12)
    assert 0.02 < factor * largest <= 0.07
    mantissa = factor / 10 ** np.floor(np.log10(factor) + 1e-9)
    assert min(abs(mantissa - m) for m in (1, 2, 5)) < 1e-9


def test_between_the_pulses_the_hoop_is_rigid(motion, tmp_path):
    time_ = 0.5 * motion.kept[0].states[0].t
    write_fields(motion, tmp_path, times=[time_, motion.pulses[0].t_end])
    frame = read(tmp_path)[0]
    state = motion.at(time_)
    ring = frame.blocks["ring"]
    assert not ring.point_data["displacement"].any()
    assert not ring.point_data["von_mises"].any()
    middle = (ring.points.min(axis=0) + ring.points.max(axis=0)) / 2
    np.testing.assert_allclose(middle[:2], [state.x_C, state.y_C], atol=1e-4)
    # rolling: the lowest point stands still, the top moves at twice the centre's velocity
    speed = np.linalg.norm(ring.point_data["velocity"], axis=1)
    assert speed[ring.points[:, 1].argmin()] < 0.02 * speed.max()
    assert speed.max() == pytest.approx(2 * float(state.omega), rel=1e-3)


@pytest.mark.parametrize("now", [0.05, 0.7, 1.36])
def test_the_velocity_of_a_flight_is_the_rate_of_the_position(tmp_path, now):
    """Thrown up by its turning at release it comes down at t = 1.37, with no floor under it till then."""
    thrown = simulate(scene(release={"phi0": 0.1, "omega0": 3.0}, run={"t_end": 1.4}), history=True)
    assert thrown.phase_at(now).kind is Kind.FLIGHT
    write_fields(thrown, tmp_path, times=now + 1e-3 * np.array([-1, 0, 1]), fields=("velocity",))
    before, at, after = (frame.blocks["ring"] for frame in read(tmp_path))
    rate = (after.points.astype(float) - before.points) / 2e-3
    # points are floats of four bytes: 1e-7 of some R over 2e-3
    np.testing.assert_allclose(at.point_data["velocity"], rate, atol=5e-4)


def test_the_velocity_just_before_a_landing_is_that_of_the_fall(tmp_path):
    """One-sided differences, which see nothing of what comes after it: 3 x - 4 x_1 + x_2 over 2 h."""
    thrown = simulate(scene(release={"phi0": 0.1, "omega0": 3.0}, run={"t_end": 1.4}), history=True)
    end = next(phase.t_end for phase in thrown.phases if phase.kind is Kind.FLIGHT)
    write_fields(thrown, tmp_path, times=end - 2e-4 - 1e-3 * np.array([2, 1, 0]), fields=("velocity",))
    second, first, last = (frame.blocks["ring"] for frame in read(tmp_path))
    rate = (3 * last.points.astype(float) - 4 * first.points.astype(float) + second.points) / 2e-3
    np.testing.assert_allclose(last.point_data["velocity"], rate, atol=2e-3)


def test_si_units(motion, tmp_path):
    """R = 0.5 m, m = 3 kg, g = 9.81: every field scales as its dimension says."""
    si = simulate(scene(hoop={"R": 0.5, "m": 3.0, "g": 9.81}), history=True)
    time_ = motion.pulses[0].t_start + 0.3 * (motion.pulses[0].t_end - motion.pulses[0].t_start)
    unit = si.scene.time_unit
    write_fields(motion, tmp_path / "one", times=[time_])
    write_fields(si, tmp_path / "si", times=[time_ * unit])
    one, other = (read(tmp_path / name)[0].blocks for name in ("one", "si"))
    velocity, stress = np.sqrt(9.81 * 0.5), 3 * 9.81 / 0.5**2
    scales = {
        "displacement": 0.5, "velocity": velocity, "stress": stress, "von_mises": stress, "hoop_stress": stress,
        "bending_stress": stress, "energy_density": stress,
    }  # fmt: skip
    for name, scale in scales.items():
        first, second = (np.asarray(blocks["ring"].point_data[name]) for blocks in (one, other))
        np.testing.assert_allclose(second, scale * first, atol=1e-5 * scale * np.abs(first).max(), err_msg=name)
    np.testing.assert_allclose(other["ring"].points, 0.5 * one["ring"].points, atol=1e-6)
    energy = [blocks["ring"].cell_data["strain_energy"].sum() for blocks in (one, other)]
    assert energy[1] == pytest.approx(3 * 9.81 * 0.5 * energy[0], rel=1e-5)
    # the force of an SI pressure on the rim of a hoop of width R
    force = integral(other["rim"], "pressure") * 0.5
    assert force == pytest.approx(3 * 9.81 * integral(one["rim"], "pressure"), rel=1e-5)
    assert read(tmp_path / "si").about["units"]["stress"] == "Pa (b = R)"


def test_stresses_are_those_of_a_wall_as_wide_as_the_scene_says(motion, tmp_path):
    """In a strip R/40 wide every force is shared by a fortieth of the width; energies and motions stay."""
    when = [motion.pulses[0].t_start + 0.3 * (motion.pulses[0].t_end - motion.pulses[0].t_start)]
    strip = replace(motion, scene=motion.scene.replace(ring={"section_width": 1 / 40}))
    write_fields(motion, tmp_path / "one", times=when)
    write_fields(strip, tmp_path / "strip", times=when)
    one, narrow = (read(tmp_path / name) for name in ("one", "strip"))
    for block, name in [("ring", "von_mises"), ("ring", "energy_density"), ("rim", "pressure"), ("rim", "traction")]:
        wide, found = (np.asarray(series[0].blocks[block].point_data[name]) for series in (one, narrow))
        np.testing.assert_allclose(found, 40 * wide, rtol=1e-6, err_msg=name)
    energies = [series[0].blocks["ring"].cell_data["strain_energy"] for series in (one, narrow)]
    np.testing.assert_array_equal(*energies)
    assert [series.about["units"]["von_mises"] for series in (one, narrow)] == ["m g/R²"] * 2


@pytest.mark.slow  # a series of its own is in tests/meshes
def test_200_frames_in_50_megabytes(motion, tmp_path):
    write_fields(motion, tmp_path)
    size = sum(path.stat().st_size for path in tmp_path.rglob("*") if path.is_file())
    assert len(read(tmp_path)) == 200
    assert size < 50e6


@pytest.mark.slow
def test_a_killed_run_leaves_whole_frames(tmp_path):
    code = (
        "import sys; from flexible import simulate; from flexible import write_fields\n"
        "from rigid import load_scene\n"
        "scene = load_scene('paper-3.3-massless').replace(run={'until': 'pulse'}, solve={'rtol': 1e-2})\n"
        "motion = simulate(scene, history=True)\n"
        "write_fields(motion, sys.argv[1], frames=5000, progress=lambda done: print(done, flush=True))\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    options = {"env": environment, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], **options) as run:
        run.stdout.readline()  # fifty frames are there
        time.sleep(0.1)
        run.send_signal(signal.SIGKILL)
    series = read(tmp_path)
    assert 0 < len(series) < 5000
    for frame in series:
        assert "displacement" in frame.blocks["ring"].point_data
    assert series.history["t"].size


@pytest.mark.parametrize(
    ("wishes", "words"),
    [
        ({"fields": ("colour",)}, "fields = colour"),
        ({"fields": ()}, "fields"),
        ({"times": [-1.0]}, "times = -1.0 is not possible: the motion goes from 0 to"),
        ({"times": [1e9]}, "times = 1000000000.0 is not possible: the motion goes from 0 to"),
        ({"times": [np.nan]}, "times = nan is not possible: the motion goes from 0 to"),
        ({"times": []}, "times are not possible: none is given"),
        ({"frames": 1}, "frames = 1"),
        ({"frames": 2.5}, "frames = 2.5"),
        ({"frames": float("nan")}, "frames = nan"),
        ({"frames": "5"}, "frames = '5'"),
        ({"pulse": 7}, "the motion has 1"),
        ({"pulse": "0"}, "pulse = '0'"),
        ({"pulse": 0.5}, "pulse = 0.5"),
        ({"fields": "displaced"}, "fields = displaced"),
        ({"fields": None}, "fields = none"),
        ({"fields": [1]}, "fields = 1"),
        ({"fields": 5}, "fields = 5"),
    ],
)
def test_bad_wishes_are_one_sentence(motion, tmp_path, wishes, words):
    with pytest.raises(SeriesError, match=words) as caught:
        write_fields(motion, tmp_path / "out", **wishes)
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_a_rigid_motion_has_no_fields(tmp_path):
    with pytest.raises(SeriesError, match="fields are of a flexible motion"):
        write_fields(rigid.simulate("paper-3.1"), tmp_path)


def test_a_motion_without_states_is_one_sentence(tmp_path):
    with pytest.raises(SeriesError, match="history=True"):
        write_fields(simulate(scene("paper-3.3-massless")), tmp_path)


def test_a_pulse_that_never_came_about_is_one_sentence(motion, tmp_path):
    """Where the solver gave up at once, its own words say why."""
    stuck = replace(motion.pulses[0], t_end=motion.pulses[0].t_start)
    kept = replace(motion.kept[0], states=motion.kept[0].states[:1])
    gone = replace(motion, pulses=(stuck,), kept=(kept,), ended="stopped for a reason")
    with pytest.raises(SeriesError, match="stopped for a reason"):
        write_fields(gone, tmp_path)


def test_a_motion_without_a_pulse_is_drawn_rigid(tmp_path):
    short = simulate(scene(run={"t_end": 0.5}), history=True)
    write_fields(short, tmp_path, frames=3, fields=("displacement", "pressure"))
    series = read(tmp_path)
    np.testing.assert_allclose(series.times, [0, 0.25, 0.5])
    assert not series[2].blocks["ring"].point_data["displacement"].any()


@pytest.mark.parametrize("level", ["full", pytest.param("exact", marks=pytest.mark.slow)])
def test_every_level_of_the_hoop_has_its_fields(level, tmp_path):
    """The elements' energy is the level's own ring strain; of a stiff ring the levels' stresses agree to 1 %."""
    found = []
    for one in ("reduced", level):
        motion = simulate(scene(solve={"rtol": 1e-3, "level": one}), history=True)
        write_fields(motion, tmp_path / one, times=[5.8, 5.83], fields=("von_mises", "velocity", "energy_density"))
        found.append([frame.blocks["ring"] for frame in read(tmp_path / one)])
    for reduced, nodal in zip(*found, strict=True):
        energies = [block.cell_data["strain_energy"].sum() for block in (reduced, nodal)]
        assert energies[0] > 0
        assert energies[0] == pytest.approx(energies[1], rel=0.02)
        for name in ("von_mises", "velocity"):
            first, second = (block.point_data[name] for block in (reduced, nodal))
            np.testing.assert_allclose(second, first, atol=0.01 * np.abs(first).max())
    history = motion.history
    steps = np.flatnonzero(np.diff(history.t, append=np.inf) > 0)[10::20]
    write_fields(motion, tmp_path, times=history.t[steps], fields=("energy_density",))
    energy = [frame.blocks["ring"].cell_data["strain_energy"].sum() for frame in read(tmp_path)]
    np.testing.assert_allclose(energy, history.ring_strain[steps], rtol=1e-6, atol=1e-9 * max(energy))


def test_every_field_that_is_written_has_a_name_and_a_unit():
    """The stress is drawn by its components; where the contact sticks is no quantity."""
    drawn = {*FIELDS, "stress xx", "stress yy", "stress xy"} - {"stress", "stick"}
    assert drawn == set(style.FIELDS)
    assert all(style.unit(field, {}) and style.unit(field, style.SI_UNITS) for field in drawn)


@pytest.mark.slow
@pytest.mark.parametrize(("r", "bending", "within"), [(1.2, 300, 1e-3), (1.1, 20, 0.1)])
def test_the_displaced_rim_is_as_deep_in_the_floor_as_it_is_pressed(tmp_path, r, bending, within):
    """Undamped, at every point of the contact the pressure over that of the foundation, of a patch narrower than an
    element too, where the nodes of a thick wall know less of its dent. To a thousandth of the deepest: the ring's
    displacement, a hundred times that, is known inside and to the contact to some 1e-5 of itself. Of a chain, whose
    mesh is only carried along with its sections, to a tenth; without the dent both are off by 0.4 and more.
    """
    stiffness = 1e9
    scene = load_scene("paper-3.3-light").replace(
        hoop={"r": r, "mass_ratio": 0.2}, contact={"stiffness": stiffness, "damping": 0},
        ring={"bending_stiffness": bending}, solve={"rtol": 1e-2}, run={"until": "pulse"},
    )  # fmt: skip
    write_fields(simulate(scene, history=True), tmp_path, frames=4, fields=("displacement", "pressure"))
    rims = [frame.blocks["rim"] for frame in read(tmp_path)]
    nodes = reduce(np.intersect1d, [rim.point_data["theta"] for rim in rims])  # the mesh's, on lines between points
    seen = 0
    for rim in rims:
        pressed = rim.point_data["pressure"] / stiffness
        inside = (pressed > 0) & ~np.isin(rim.point_data["theta"], nodes)
        depth = -(rim.points[:, 1] + rim.point_data["displacement"][:, 1])
        assert depth[inside] == pytest.approx(pressed[inside], abs=within * pressed.max())
        # nor is it in the floor where nothing presses: at the edges of the patch, and at nodes beside them
        assert depth[pressed == 0].max() < 0.1 * pressed.max()
        seen += inside.any()
    assert seen >= 3
