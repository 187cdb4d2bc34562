"""Fields and pictures from the command line."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from command_line import is_one_sentence, process

from meshes import read
from meshes.draw.display import renderer_problem
from rigid import load_scene, simulate
from studies import StudyError
from studies.cli import hoop as cli
from studies.cli.view import _ensure_frames

SCENE = """\
[hoop]
k = 0.1
r = 1.02
mass_ratio = 0.01
[friction]
mu_s = 0.35
mu = 0.3
[release]
phi0_deg = 10
[run]
until = "pulse"
[solve]
rtol = 1e-3
"""

needs_renderer = pytest.mark.skipif(renderer_problem() is not None, reason=str(renderer_problem()))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder that `hoop flexible SCENE --out DIR --fields --frames 12` leaves."""
    folder = tmp_path_factory.mktemp("view")
    file = folder / "scene.toml"
    file.write_text(SCENE)
    assert cli.run(["flexible", str(file), "--out", str(folder / "out"), "--fields", "--frames", "12"]) == 0
    return folder / "out"


def test_flexible_writes_a_series(run):
    series = read(run)
    assert len(series) == 12
    ring = series[6].blocks["ring"].point_data
    assert {"displacement", "velocity", "stress", "von_mises", "hoop_stress", "energy_density"} <= set(ring)


@pytest.mark.usefixtures("undrawn")
def test_frames_at_listed_times_with_listed_fields(hoop, run, tmp_path):
    status, _, err = hoop(
        "flexible", run.parent / "scene.toml", "--json", "--out", tmp_path, "--fields",
        "--times", "5.8,1,5.85", "--only", "von_mises,displacement",
    )  # fmt: skip
    assert status == 0, err
    series = read(tmp_path)
    np.testing.assert_array_equal(series.times, [1, 5.8, 5.85])
    assert set(series[1].blocks["ring"].point_data) == {"von_mises", "displacement"}


@pytest.mark.slow
@needs_renderer
def test_view_draws_a_picture_and_an_animation(hoop, run, tmp_path):
    from PIL import Image

    png, gif = tmp_path / "a.png", tmp_path / "a.gif"
    times = read(run).times
    nearest = f"{times[np.abs(times - 5.85).argmin()]:.6g}"
    assert nearest != "5.85"
    done = process("view", run, "--png", png, "--time", 5.85, "--field", "hoop_stress", "--zoom", 4)
    assert (done.returncode, done.stdout) == (0, "")
    assert is_one_sentence(done.stderr)
    assert f"t = {nearest}, the frame nearest to 5.85" in done.stderr
    for exact in (("--time", nearest), ()):
        assert hoop("view", run, "--png", png, *exact) == (0, "", "")
    with Image.open(png) as image:
        assert len(image.convert("RGB").getcolors(maxcolors=10**7)) > 100
    assert hoop("view", run, "--gif", gif, "--frames", 3, "--fps", 5, "--pace", "time", "--factor", 100) == (0, "", "")
    with Image.open(gif) as image:
        assert image.n_frames == 3


@pytest.mark.parametrize("breaks", ["png", "gif", "html", "window"])
def test_who_breaks_off_is_told_which_files_there_are(hoop, tmp_path, monkeypatch, breaks):
    """Nothing is drawn here: a file is touched, or Ctrl-C typed in its place."""

    def draw(thing: object, file: Path, *_: object, **__: object) -> None:
        if file.suffix == f".{breaks}":
            raise KeyboardInterrupt
        file.touch()

    def window(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    for name, stands_in in (("picture", draw), ("animate", draw), ("window", window)):
        monkeypatch.setattr(f"meshes.view.{name}", stands_in)
    png, gif, html = files = [tmp_path / f"a.{suffix}" for suffix in ("png", "gif", "html")]
    asked = [] if breaks == "window" else ["--png", png, "--gif", gif, "--html", html]
    said = {
        "png": f"; {png} and {gif} and {html} are not written; the same command again draws from the start",
        "gif": f"; {png} is written, {gif} and {html} are not written; the same command again draws them all",
        "html": f"; {png} and {gif} are written, {html} is not written; the same command again draws them all",
        "window": "",
    }
    status, out, err = hoop("view", "paper-3.1", *asked)
    assert (status, out, err.strip()) == (130, "", f"hoop: Interrupted{said[breaks]}.")
    if asked:
        there = ["png", "gif", "html"].index(breaks)
        assert [file.exists() for file in files] == [True] * there + [False] * (3 - there)


@pytest.mark.parametrize("number", [0, -1])
def test_the_ends_that_are_told_are_taken(run, number):
    """The frames go from 5.81573, it said, and 5.81573 was refused: they begin some 1e-6 later."""
    series = read(run)
    end = series.times[number]
    for digits in (float(f"{end:.6g}"), end):
        _ensure_frames(series, {"time": digits})
    beyond = float(f"{end:.6g}") + (1e-4 if number else -1e-4)
    with pytest.raises(StudyError, match="the frames go from"):
        _ensure_frames(series, {"start": beyond})


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--png", "a.jpg"), ".png"),
        (("--time", 5.8), "--png"),
        (("--pace", "time", "--png", "a.png"), "animation"),
        (("--frames", 5), "animation"),
        (("--gif", "a.gif", "--pace", "odd"), "odd"),
        (("--png", "a.png", "--time", 99), "the frames go from"),
        (("--png", "a.png", "--time", 1.3), "the frames go from"),
        (("--png", "a.png", "--time", "nan"), "--time"),
        (("--gif", "a.gif", "--start", 1.3), "the frames go from"),
        (("--png", "a.png", "--zoom", 0.1), "zoom"),
        (("--png", "a.png", "--factor", -1), "factor"),
        (("--png", "a.png", "--field", "colour"), "there is no field 'colour'"),
        (("--gif", "a.gif", "--start", 3, "--stop", 2), "is not possible"),
    ],
)
def test_bad_wishes_are_one_sentence(hoop, run, arguments, words):
    status, out, err = hoop("view", run, *arguments)
    assert (status, out) == (2, "")
    assert words in err
    assert is_one_sentence(err)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--png", "a.png", "--time", "nan"), "--time"),
        (("--png", "a.png", "--time", -1), "--time"),
        (("--png", "a.png", "--time", 0.95), "--time 0.95 is not possible: the run goes from 0 to run.t_end = 0.9"),
        (("--gif", "a.gif", "--start", "inf"), "--start"),
        (("--gif", "a.gif", "--start", 0.9), "--start 0.9 is not possible"),
        (("--gif", "a.gif", "--start", 0.3, "--stop", 0.3), "--start 0.3 is not possible"),
        (("--gif", "a.gif", "--stop", -1), "--stop"),
        (("--gif", "a.gif", "--stop", 0), "--stop"),
        (("--png", "a.png", "--factor", "nan"), "--factor"),
        (("--png", "a.png", "--zoom", 0.5), "--zoom"),
        (("--png", "a.png", "--field", "von_mises"), "--field von_mises"),
        (("--png", "nowhere/a.png"), "nowhere"),
    ],
)
def test_what_needs_no_motion_is_refused_before_it_is_run(hoop, tmp_path, monkeypatch, arguments, words):
    """The scene "printed" runs to 0.9 s."""

    def run(*_: object) -> None:
        raise AssertionError("it ran")

    monkeypatch.setattr("studies.running.solvers.solver", run)
    monkeypatch.chdir(tmp_path)
    status, out, err = hoop("view", "printed", *arguments)
    assert (status, out) == (2, "")
    assert words in err
    assert is_one_sentence(err)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--fields",), "--out"),
        (("--out", "o", "--frames", 5), "--fields"),
        (("--out", "o", "--fields", "--times", "1,x"), "1,x"),
        *(
            (("--out", "o", "--fields", f"--times={times}"), "--times")
            for times in ("-1", "1,-1e-9", "nan", "1,inf", "")
        ),
        (("--out", "o", "--fields", "--times", "1", "--frames", 5), "cannot both be"),
        (("--out", "o", "--fields", "--only", "colour"), "colour"),
        (("--out", "o", "--fields", "--frames", 1), "1"),
    ],
)
def test_bad_wishes_about_fields_are_one_sentence(hoop, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    status, out, err = hoop("flexible", "paper-3.3-massless", *arguments)
    assert (status, out) == (2, "")
    assert words in err
    assert is_one_sentence(err)
    assert not (tmp_path / "o" / "motion.json").exists()  # it was seen before anything ran


def test_times_after_the_end_are_refused_before_a_run_to_a_time(hoop, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, out, err = hoop("flexible", "printed", "--out", "o", "--fields", "--times", "0.1,0.95")
    assert (status, out) == (2, "")
    assert "--times 0.1,0.95" in err
    assert "run.t_end = 0.9" in err
    assert is_one_sentence(err)
    assert not (tmp_path / "o").exists()


@pytest.mark.usefixtures("undrawn")
def test_a_run_that_ends_before_the_times_is_told_all_the_same(hoop, run, tmp_path):
    status, out, err = hoop(
        "flexible", run.parent / "scene.toml", "--json", "--out", tmp_path, "--fields", "--times", 1e9
    )
    assert status == 1
    assert json.loads(out)["completed"] is True
    assert err.startswith("hoop: No fields were written at --times: times = 1000000000.0 is not possible")
    assert is_one_sentence(err)
    assert (tmp_path / "motion.npz").exists()


def test_folders_and_files_that_are_no_series(hoop, tmp_path):
    for path in (tmp_path, tmp_path / "nothing.pvd"):
        status, _, err = hoop("view", path, "--png", tmp_path / "a.png")
        assert status == 2
        assert is_one_sentence(err)
    foreign = tmp_path / "other.vtu"
    foreign.write_text("<VTKFile/>")
    status, _, err = hoop("view", foreign, "--png", tmp_path / "a.png")
    assert status == 2
    assert is_one_sentence(err)


@pytest.mark.usefixtures("undrawn")
def test_the_folder_of_a_rigid_run_is_its_motion(hoop, tmp_path, monkeypatch):
    """What `hoop rigid --out` left is drawn as it is, not run again; it has no fields."""
    monkeypatch.setattr("meshes.view.picture", lambda thing, *_, **__: seen.append(thing))
    seen = []
    folder = tmp_path / "r1"
    assert hoop("rigid", "paper-3.1", "--json", "--out", folder)[0] == 0
    monkeypatch.setattr("studies.running.solvers.solver", lambda _: pytest.fail("it was run again"))
    assert hoop("view", folder, "--png", tmp_path / "a.png") == (0, "", "")
    (shown,) = seen
    assert shown.phases == simulate(load_scene("paper-3.1")).phases
    status, _, err = hoop("view", folder, "--png", tmp_path / "a.png", "--field", "von_mises")
    assert (status, is_one_sentence(err)) == (2, True)
    (folder / "motion.npz").write_bytes(b"no motion")
    status, _, err = hoop("view", folder, "--png", tmp_path / "a.png")
    assert (status, is_one_sentence(err)) == (2, True)


def test_a_flexible_run_without_fields_is_told_how_to_get_them(hoop, run, tmp_path):
    shutil.copy(run / "motion.npz", tmp_path)
    status, _, err = hoop("view", tmp_path, "--png", tmp_path / "a.png")
    assert (status, is_one_sentence(err)) == (2, True)
    assert "--fields" in err


def test_a_folder_that_is_not_there_is_told_as_one(hoop):
    status, _, err = hoop("view", "nofolder")
    assert (status, is_one_sentence(err)) == (2, True)
    assert "folder" in err.replace("nofolder", "")
