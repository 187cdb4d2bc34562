"""A series of fields: bit-exact round trip, other readers, damaged files, a writer that is killed."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from meshes import Block, Frame, Placement, SeriesError, SeriesWriter, disk_block, floor_block, read, vtu
from meshes.fields import QUADRATIC_EDGE
from meshes.vtu import Encoder, read_vtu

TIMES = np.array([0.1, 0.1 + 1e-16 + 2**-50, 1 / 3, 2.0])  # two that differ in the last bits


@pytest.fixture(scope="module")
def written(tmp_path_factory, ring, ovals):
    directory = tmp_path_factory.mktemp("series")
    frames = list(ovals.frames(ring, TIMES))
    with SeriesWriter(directory, units={"von_mises": "m g/R²"}, title="oval") as writer:
        writer.history(**ovals.history(TIMES))
        for frame in frames:
            writer.add(frame)
    return directory, frames


def assert_same_block(got, expected):
    assert got.cell_type == expected.cell_type
    np.testing.assert_array_equal(got.points.view(np.uint64), expected.points.view(np.uint64))
    np.testing.assert_array_equal(got.cells, expected.cells)
    for kind in ("point_data", "cell_data", "field_data"):
        theirs, ours = getattr(got, kind), getattr(expected, kind)
        assert list(theirs) == list(ours)
        for name, value in ours.items():
            assert theirs[name].dtype == value.dtype
            assert theirs[name].shape == value.shape
            assert theirs[name].tobytes() == value.tobytes(), name


def test_round_trip_is_exact_to_the_bit(written, ovals):
    directory, frames = written
    series = read(directory)
    assert len(series) == len(frames)
    np.testing.assert_array_equal(series.times.view(np.uint64), TIMES.view(np.uint64))
    for got, expected in zip(series, frames, strict=True):
        assert got.time == expected.time
        assert list(got.blocks) == list(expected.blocks) == ["ring", "rim", "disk", "floor"]
        for name, block in expected.blocks.items():
            assert_same_block(got.blocks[name], block)
    assert series.about == {"title": "oval", "units": {"von_mises": "m g/R²"}}
    for name, value in ovals.history(TIMES).items():
        np.testing.assert_array_equal(series.history[name], value)
    assert series.nearest(0.4).time == 1 / 3
    assert series.nearest(-np.inf).time == TIMES[0]
    assert series.nearest(np.inf).time == TIMES[-1]
    for none in (np.nan, "x", None, [1, 2]):
        with pytest.raises(SeriesError, match="no frame is near t = "):
            series.nearest_index(none)
    assert repr(series[0]) == "Frame(t = 0.1: ring, rim, disk, floor)"
    assert re.fullmatch(r"Block\(\d+ points, \d+ cells\)", repr(series[0].blocks["ring"]))
    with pytest.raises(TypeError, match="integer"):
        series[0:2]


def test_odd_numbers_survive(tmp_path):
    odd = np.array([np.nan, -0.0, np.inf, 5e-324])
    block = Block(
        np.zeros((4, 2)),
        np.array([[0, 1, 2, 3]]),
        9,
        {"odd": odd, "vector": np.arange(8.0).reshape(4, 2), "single": odd.astype(np.float32)},
        {"flag": np.array([-3], dtype=np.int32)},
        {"display_factor": 250.0, 'a < "b"': np.arange(3)},
    )
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(-1.5, {"ring": block}))
    got = read(tmp_path)[0].blocks["ring"]
    assert_same_block(got, block)
    assert got.point_data["vector"].shape == (4, 3)  # padded, VTK warps nothing else


def test_pyvista_opens_it(written):
    pyvista = pytest.importorskip("pyvista")
    directory, frames = written
    reader = pyvista.get_reader(directory / "fields.pvd")
    assert reader.time_values == TIMES.tolist()
    reader.set_active_time_value(TIMES[2])
    blocks = reader.read()
    expected = list(frames[2].blocks.values())
    assert len(blocks) == 4
    for mesh, block in zip(blocks, expected, strict=True):
        np.testing.assert_array_equal(mesh.points, block.points)
        np.testing.assert_array_equal(mesh.cells_dict[block.cell_type], block.cells)
        for name, value in block.point_data.items():
            np.testing.assert_array_equal(mesh.point_data[name], value)
    assert blocks[0].celltypes[0] == pyvista.CellType.BIQUADRATIC_QUAD
    assert blocks[0].field_data["TimeValue"] == TIMES[2]
    warped = blocks[0].warp_by_vector("displacement", factor=3.0)
    ring = expected[0]
    np.testing.assert_allclose(warped.points, ring.points + 3 * ring.point_data["displacement"], atol=1e-15)


def test_meshio_opens_a_frame(written):
    meshio = pytest.importorskip("meshio")
    directory, frames = written
    mesh = meshio.read(directory / "fields" / "ring-00002.vtu")
    ring = frames[2].blocks["ring"]
    np.testing.assert_array_equal(mesh.points, ring.points)
    np.testing.assert_array_equal(mesh.cells_dict["quad9"], ring.cells)
    assert {name: value.shape for name, value in mesh.point_data.items()} == {
        name: value.shape for name, value in ring.point_data.items()
    }
    for name, value in ring.point_data.items():
        np.testing.assert_array_equal(mesh.point_data[name], value)
    for name, value in ring.cell_data.items():
        assert mesh.cell_data[name][0].shape == value.shape


def test_meshio_opens_every_frame(tmp_path, monkeypatch):
    """Also where an array would begin, in bytes, at the number at which meshio has put one before it, in base64: one
    frame in fifty or so has such a place, which the one before it is made longer for."""
    meshio, pyvista = pytest.importorskip("meshio"), pytest.importorskip("pyvista")
    rng, path, longer = np.random.default_rng(5), tmp_path / "frame.vtu", []

    def counted(raw, strategy, flushes=0, coded=vtu._coded):
        longer.extend([flushes] * (flushes > 0))
        return coded(raw, strategy, flushes)

    monkeypatch.setattr(vtu, "_coded", counted)
    for count in range(3, 2000):
        points = np.column_stack([rng.random((count, 2)), np.zeros(count)])
        cells = np.column_stack([np.arange(count - 2), np.arange(1, count - 1), np.arange(2, count)])
        fields = {f"{i}": rng.random((count, 3)) if i % 2 else np.zeros(count) for i in range(12)}
        block = Block(points, cells, QUADRATIC_EDGE, fields)
        path.write_bytes(Encoder().encode(block, 1.0))
        mesh = meshio.read(path)
        np.testing.assert_array_equal(mesh.points, points)
        for name, values in fields.items():
            np.testing.assert_array_equal(mesh.point_data[name], values)
        np.testing.assert_array_equal(read_vtu(path).point_data["11"], fields["11"])
        if len(longer) > 3:
            np.testing.assert_array_equal(pyvista.read(path).point_data["11"], fields["11"])
            return
    raise AssertionError("no frame of two thousand had such a place")


def test_a_file_alone_says_which_block_it_is_and_in_which_units(tmp_path, ring, ovals):
    """As VTK's own reader finds it; our own reader gives the block back as it was."""
    vtk = pytest.importorskip("pyvista")
    units = {"displacement": "R", "stress": "m g/R²"}
    frame = next(iter(ovals.frames(ring, [0.0])))
    with SeriesWriter(tmp_path, units) as writer:
        writer.add(frame)
    for name, block in read(tmp_path)[0].blocks.items():
        known = set(vtk.read(next((tmp_path / "fields").glob(f"{name}-*.vtu"))).field_data.keys())
        assert f"block: {name}" in known
        assert {f"unit of {field}: {unit}" for field, unit in units.items() if field in block.point_data} <= known
        assert set(block.field_data) == set(frame.blocks[name].field_data)


def test_a_block_that_does_not_change_is_written_once(written):
    directory, _ = written
    assert [path.name for path in (directory / "fields").glob("floor-*")] == ["floor-00000.vtu"]
    assert len(list((directory / "fields").glob("disk-*"))) == len(TIMES)


def test_200_frames_in_50_megabytes(tmp_path, ring, ovals):
    with SeriesWriter(tmp_path) as writer:
        for frame in ovals.frames(ring, np.linspace(0, 1, 200)):
            writer.add(frame)
    size = sum(path.stat().st_size for path in tmp_path.rglob("*") if path.is_file())
    assert size < 50e6
    assert len(read(tmp_path)) == 200


HANGS = 600  # seconds after which a process is taken to hang; a busy machine may take minutes
KILLED = """
import sys, itertools
sys.path.insert(0, {tests!r})
from conftest import oval_frames
from meshes import SeriesWriter, ring_mesh
writer = SeriesWriter({out!r})
for frame in oval_frames(ring_mesh(0.98, 1.0, 48), (0.001 * i for i in itertools.count())):
    writer.add(frame)
"""


def test_a_killed_run_leaves_whole_frames(tmp_path):
    code = KILLED.format(tests=str(Path(__file__).parent), out=str(tmp_path))
    process = subprocess.Popen([sys.executable, "-c", code], cwd=Path(__file__).parents[2])
    deadline = time.monotonic() + HANGS
    while len(list(tmp_path.glob("fields/ring-*.vtu"))) < 150:
        assert process.poll() is None, "it ended by itself"
        assert time.monotonic() < deadline, "it hangs"
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    series = read(tmp_path)
    assert len(series) >= 145  # the PVD lags a hundredth of the frames behind
    for frame in series:
        assert list(frame.blocks) == ["ring", "rim", "disk", "floor"]


def test_a_new_series_replaces_the_old_one(tmp_path, ring, ovals):
    for count in (3, 1):
        with SeriesWriter(tmp_path) as writer:
            for frame in ovals.frames(ring, np.arange(count) * 1.0):
                writer.add(frame)
    assert len(read(tmp_path)) == 1
    assert not list(tmp_path.glob("fields/*-00002.vtu"))
    assert read(tmp_path).history == {}


def test_a_time_that_is_text_is_refused(tmp_path):
    with SeriesWriter(tmp_path) as writer, pytest.raises(SeriesError, match="t = 'a' cannot follow"):
        writer.add(Frame("a", {"disk": disk_block((0.0, 1.0), 0.2, 0.3)}))


def test_files_of_others_outlive_a_new_series(tmp_path, ring, ovals):
    """Removed is what the writer named itself, of other blocks and of runs that were killed too."""
    block = disk_block((0.0, 1.0), 0.2, 0.3)
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"ring": block, "tread-2": block}))
    folder = tmp_path / "fields"
    left, others = folder / "rim-00007.vtu", [folder / name for name in ("mine-1.vtu", "ring-1.vtu", "my-00001.vtu")]
    for path in (left, *others):
        path.write_bytes(b"")
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"disk": block}))
    assert {path.name for path in folder.glob("*.vtu")} == {"disk-00000.vtu", *(path.name for path in others)}


def test_a_damaged_series_is_replaced(tmp_path):
    """Its PVD names nothing; frames of hoops are known by their names."""
    block = disk_block((0.0, 1.0), 0.2, 0.3)
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"ring": block}))
    (tmp_path / "fields.pvd").write_bytes(b"<VTKFile>")
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"disk": block}))
    assert {path.name for path in (tmp_path / "fields").glob("*.vtu")} == {"disk-00000.vtu"}


def test_times_must_increase(tmp_path):
    writer = SeriesWriter(tmp_path)
    floor = {"floor": floor_block(0, 1, 0.1)}
    writer.add(Frame(1.0, floor))
    for bad in (1.0, 0.5, np.nan, np.inf):
        with pytest.raises(SeriesError, match="cannot follow"):
            writer.add(Frame(bad, floor))


@pytest.mark.parametrize("cut", [0.02, 0.3, 0.6, 0.999])
def test_a_truncated_frame_is_one_sentence(written, tmp_path, cut):
    whole = (written[0] / "fields" / "ring-00000.vtu").read_bytes()
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"disk": disk_block((0, 1), 0.2, 0.0)}))
    (tmp_path / "fields" / "disk-00000.vtu").write_bytes(whole[: int(cut * len(whole))])
    with pytest.raises(SeriesError, match=r"disk-00000.vtu is (damaged|not a frame)"):
        read(tmp_path)[0]


def test_flipped_bytes_never_read_as_something_else(written, tmp_path):
    """zlib checksums every array: damage is found, or it hit a byte that means nothing."""
    whole = (written[0] / "fields" / "disk-00001.vtu").read_bytes()
    expected = written[1][1].blocks["disk"]
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"disk": expected}))
    start = whole.index(b"AppendedData") + 30
    for place in np.linspace(start, len(whole) - 40, 60).astype(int):
        damaged = bytearray(whole)
        damaged[place] ^= 0xFF
        (tmp_path / "fields" / "disk-00000.vtu").write_bytes(bytes(damaged))
        try:
            got = read(tmp_path)[0].blocks["disk"]
        except SeriesError:
            continue
        assert_same_block(got, expected)


@pytest.mark.parametrize("left", ["[1", "[1, 2]", None])
def test_units_that_are_not_there_are_said_to_be(written, tmp_path, left):
    """None would be taken for those of a scene without units."""
    shutil.copytree(written[0], tmp_path / "copy")
    about = tmp_path / "copy/fields/about.json"
    about.unlink()
    if left is not None:
        about.write_text(left, encoding="utf-8")
    with pytest.raises(SeriesError, match=r"about.json is missing or damaged"):
        _ = read(tmp_path / "copy").about


def test_damaged_curves_are_said_to_be(tmp_path):
    """Every byte of the archive, flipped: an error of this kind, or the same curves."""
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"floor": floor_block(0, 1, 0.1)}))
    path, curve = tmp_path / "fields" / "history.npz", np.sin(np.arange(5.0))
    np.savez_compressed(path, t=curve)
    whole = path.read_bytes()
    assert read(tmp_path).history["t"].tolist() == curve.tolist()
    for place in range(len(whole)):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
        try:
            got = read(tmp_path).history
        except SeriesError:
            continue
        assert [values.tolist() for values in got.values()] == [curve.tolist()]


def test_foreign_and_missing_files(tmp_path):
    with pytest.raises(SeriesError, match="holds no series"):
        read(tmp_path)
    with pytest.raises(SeriesError, match="cannot be read"):
        read(tmp_path / "nowhere.pvd")
    for content in (b"", b"<a/>", b"\x00\xff", b"<VTKFile><Collection><DataSet/></Collection></VTKFile>"):
        (tmp_path / "fields.pvd").write_bytes(content)
        with pytest.raises(SeriesError):
            read(tmp_path)
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"floor": floor_block(0, 1, 0.1)}))
    (tmp_path / "fields" / "history.npz").write_bytes(b"no zip")
    with pytest.raises(SeriesError, match="damaged"):
        _ = read(tmp_path).history
    (tmp_path / "fields" / "floor-00000.vtu").unlink()
    with pytest.raises(SeriesError, match="cannot be read"):
        read(tmp_path)[0]


def test_a_directory_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(SeriesError, match="cannot hold a series"):
        SeriesWriter(tmp_path / "file")


@pytest.mark.parametrize("full_at", ["about.json", "history.npz", "disk-00000.vtu", "fields.pvd"])
def test_a_disk_that_is_full_is_a_sentence(tmp_path, monkeypatch, written, full_at):
    """Whichever of its files does not fit."""
    replace = os.replace

    def full(part, path):
        if Path(path).name == full_at:
            raise OSError(28, "No space left on device", str(part))
        replace(part, path)

    def write() -> None:
        with SeriesWriter(tmp_path) as writer:
            writer.history(t=TIMES)
            writer.add(written[1][0])

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(SeriesError, match=f"{full_at} cannot be written: No space left"):
        write()
    assert not list(tmp_path.rglob(".part-*"))


def test_arrays_that_do_not_fit():
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), np.array([[0, 1, 2, 3]])
    with pytest.raises(SeriesError, match="point field u"):
        Block(*square, 9, {"u": np.zeros(3)})
    with pytest.raises(SeriesError, match="cell field p"):
        Block(*square, 9, {}, {"p": np.zeros(4)})
    with pytest.raises(SeriesError, match="cell type"):
        Block(*square, 28)
    with pytest.raises(SeriesError, match="no points"):
        Block(np.zeros(4), square[1], 9)
    for number in (4, -1, 1.5):
        with pytest.raises(SeriesError, match="whole numbers of points, 0 to 3"):
            Block(square[0], [[0, 1, 2, number]], 9)
    with pytest.raises(SeriesError, match="without a block"):
        Frame(0.0, {})


def test_a_curve_whose_name_the_writer_needs(tmp_path):
    with SeriesWriter(tmp_path) as writer, pytest.raises(SeriesError, match="history file cannot"):
        writer.history(t=[0.0, 1.0], file=[1.0, 2.0])
    assert not (tmp_path / "fields" / "history.npz").exists()


@pytest.mark.parametrize("name", ["../ring", "a/b", "", "a\\b"])
def test_a_block_is_written_into_the_folder_of_its_series(tmp_path, name):
    with SeriesWriter(tmp_path / "run") as writer, pytest.raises(SeriesError, match="a block named"):
        writer.add(Frame(0.0, {name: disk_block((0.0, 0.0), 1.0, 0.0)}))
    assert [path.name for path in tmp_path.rglob("*.vtu")] == []


def test_cells_that_are_changed_between_frames_are_written_as_they_are(tmp_path):
    """Nothing is remembered of an array that can be written to."""
    points, cells = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), np.array([[0, 1, 2]])
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"one": Block(points, cells, 5)}))
        cells[:] = [[1, 2, 3]]
        writer.add(Frame(1.0, {"one": Block(points, cells, 5)}))
    first, second = (frame.blocks["one"].cells.tolist() for frame in read(tmp_path))
    assert (first, second) == ([[0, 1, 2]], [[1, 2, 3]])


def test_other_programs_are_told_which_component_of_the_stress_is_which(tmp_path):
    """(xx, yy, xy), the order that :meth:`meshes.Placement.stress` has: of a pull along y alone the second is not 0."""
    stress = Placement(0.0, 0.0, 1.0).stress(np.array([[7.0, 0.0, 0.0]]))  # y1 points up
    block = Block(np.zeros((4, 2)), np.array([[0, 1, 2, 3]]), 9, {"stress": np.repeat(stress, 4, axis=0)})
    with SeriesWriter(tmp_path) as writer:
        writer.add(Frame(0.0, {"ring": block}))
    (file,) = (tmp_path / "fields").glob("ring-*.vtu")
    names = [re.search(rf'ComponentName{i}="(..)"', file.read_bytes().decode("latin-1"))[1] for i in range(3)]
    assert dict(zip(names, stress[0], strict=True)) == pytest.approx({"xx": 0.0, "yy": 7.0, "xy": 0.0})


def test_a_name_that_is_too_long_names_no_series():
    with pytest.raises(SeriesError, match="cannot be read"):
        read("x" * 300)
