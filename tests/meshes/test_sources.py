"""What is drawn of a series and of a motion: bodies where they are, forces and phases of that instant, and units."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from meshes import Block, Frame, SeriesWriter, read
from meshes.draw.scales import field_names
from meshes.draw.shots import Curves, MotionSource, SeriesSource
from meshes.draw.style import SI_UNITS, UNITS
from meshes.view.pictures import _liveliest
from meshes.view.timing import Timing, instants
from rigid import load_scene, simulate

TIMES = np.linspace(0, 1.2, 7)
SCENE = load_scene("paper-3.3-light").replace(run={"until": "pulse"})
METRES = SCENE.replace(hoop={"R": 0.3, "m": 0.7, "g": 9.81})


@pytest.fixture(scope="module")
def series(tmp_path_factory, ring, ovals):
    directory = tmp_path_factory.mktemp("sources")
    history = ovals.history(TIMES)
    with SeriesWriter(directory, title="oval") as writer:
        writer.history(**history, slip_velocity=-0.2 * history["t"])
        for frame in ovals.frames(ring, TIMES):
            writer.add(frame)
    return read(directory)


def test_a_frame_has_the_forces_and_the_slip_of_its_instant(series):
    """Those of the ovals are 1 + cos^2 t, 0.3 sin 2t and -0.2 t, drawn through 200 points: off by 1e-5.

    In a roll, up to 0.4, what the patch creeps by is no slip.
    """
    for time in TIMES[[1, 3]]:
        shot = SeriesSource(series).shot(time + 0.01)
        assert shot.time == time
        assert shot.normal_force == pytest.approx(1 + np.cos(time) ** 2, abs=1e-4)
        assert shot.friction_force == pytest.approx(0.3 * np.sin(2 * time), abs=1e-4)
        assert shot.slip_velocity == pytest.approx(0.0 if time < 0.4 else -0.2 * time, abs=1e-12)
        assert shot.radius == pytest.approx(1.0, rel=1e-3)
        np.testing.assert_allclose(shot.centre, [time, 1.0], atol=1e-3)


def test_a_phase_is_named_from_its_start_to_its_end(series):
    curves = SeriesSource(series).curves
    assert [curves.phase(time) for time in (0.0, 0.39, 0.41, 0.79, 0.81, 1.2)] == [
        "roll", "roll", "spin", "spin", "flight", "flight",
    ]  # fmt: skip
    assert curves.phase(1.3) is None
    struck = Curves(*[np.zeros(0)] * 3, phases=(("flight", 0.0, 1.0), ("impact", 1.0, 1.0), ("roll", 1.0, 2.0)))
    assert struck.phase(1.5) == "roll"
    assert replace(struck, phases=struck.phases[1:]).phase(1.0) == "impact"


@pytest.mark.parametrize(("scene", "units"), [(SCENE, UNITS), (METRES, SI_UNITS)])
def test_a_motion_is_drawn_in_its_units(scene, units):
    """The disk touches the inner rim from within, on the side that phi says; forces are those of the instant."""
    motion = simulate(scene)
    source = MotionSource(motion)
    assert source.units == units
    assert source.span == (0.0, motion.t_end)
    time = 0.7 * motion.t_end
    shot, state, R = source.shot(time), motion.at(time), scene.hoop.R
    ring, disk = (block.points[:, :2] - [float(state.x_C), float(state.y_C)] for block in (shot.ring, shot.disk))
    inner = R / scene.hoop.r
    assert np.linalg.norm(ring, axis=1).max() == pytest.approx(R, rel=1e-12)
    assert np.linalg.norm(ring, axis=1).min() == pytest.approx(inner, rel=1e-12)
    toward = np.array([np.sin(state.phi), np.cos(state.phi)])
    np.testing.assert_allclose(disk[0], inner * (1 - scene.hoop.k) * toward, atol=1e-12 * R)
    assert np.linalg.norm(disk[1:] - disk[0], axis=1) == pytest.approx(scene.hoop.k * inner, rel=1e-12)
    assert (shot.normal_force, shot.friction_force) == (state.normal_force, state.friction_force)
    assert shot.slip_velocity == state.slip_velocity


#: powers of m, kg and s in what units are made of
SCALED = {"R": (1, 0, 0), "√(R/g)": (0, 0, 1), "m g": (1, 1, -2), "√(g R)": (1, 0, -1), "m g/R²": (-1, 1, -2)}
SI = {"m": (1, 0, 0), "s": (0, 0, 1), "N": (1, 1, -2), "m/s": (1, 0, -1), "Pa": (-1, 1, -2), "J/m³": (-1, 1, -2)}


def test_units_with_and_without_a_scale_are_of_the_same_kind():
    assert {kind: SI.get(unit) for kind, unit in SI_UNITS.items()} == {k: SCALED[unit] for k, unit in UNITS.items()}


def test_a_particle_is_drawn_as_a_disk_that_can_be_seen():
    shot = MotionSource(simulate(load_scene("paper-point-mass"))).shot(0.5)
    assert np.ptp(shot.disk.points[:, 0]) == pytest.approx(2 * 0.025, rel=1e-3)


def test_a_picture_without_a_time_is_of_the_largest_normal_force():
    """And not of the largest friction, here at another instant; one that is before the frames is their first."""
    t = np.linspace(0, 3, 31)
    curves = Curves(t, 1 + np.exp(-((t - 1.0) ** 2)), np.exp(-((t - 2.0) ** 2)))
    assert _liveliest(SimpleNamespace(curves=curves, span=(0.0, 3.0))) == pytest.approx(1.0)
    assert _liveliest(SimpleNamespace(curves=curves, span=(1.5, 3.0))) == 1.5


def test_an_animation_runs_in_slow_motion_through_a_pulse_or_evenly():
    """More than a third of its pictures are of the pulse, a twentieth of the time; the ends are as asked."""
    source = MotionSource(simulate(SCENE))
    end = source.span[1]
    even = instants(source, Timing(frames=9, pace="time"), 60)
    np.testing.assert_array_equal(even, np.linspace(0, end, 9))
    slow = instants(source, Timing(start=0.1 * end), 60)
    assert (slow[0], slow[-1], len(slow)) == (0.1 * end, end, 60)
    (pulse,) = source.motion.pulses
    assert pulse.t_end - pulse.t_start < 0.05 * end
    assert (slow > pulse.t_start).sum() > 60 / 3


def test_stress_comes_first_and_what_is_seen_anyway_last(series):
    names = field_names(series[0].blocks["ring"])
    assert names[0] == "von_mises"
    assert set(names[-2:]) == {"displacement", "velocity"}


def test_a_block_of_which_one_field_changes_is_written_again(tmp_path):
    """Though its points are the very same array."""
    points, cells = np.eye(4, 3), np.array([[0, 1, 2, 3]])
    blocks = [Block(points, cells, 9, {"u": np.full(4, value)}) for value in (1.0, 2.0)]
    with SeriesWriter(tmp_path) as writer:
        for time, block in enumerate(blocks):
            writer.add(Frame(float(time), {"ring": block}))
    assert [frame.blocks["ring"].point_data["u"][0] for frame in read(tmp_path)] == [1.0, 2.0]
