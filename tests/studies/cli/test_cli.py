"""The command line: what a newcomer sees, what a script gets, and one sentence for every mistake."""

from __future__ import annotations

import dataclasses
import io
import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from command_line import HANGS, SCENE, environment, is_one_sentence, process

import flexible
from flexible import Ledger, load_motion
from meshes import read
from rigid import load_scene, simulate
from studies.cli import run
from studies.cli.shared import single
from studies.cli.shared.letters import spell_out
from studies.running.files import to_json

HEAVY = ("skfem", "meshio", "pyvista", "vtk", "matplotlib", "pandas", "dask", "distributed", "jinja2")


@pytest.mark.parametrize("arguments", [(), ("-h",), ("--help",)])
def test_a_newcomer_is_told_what_to_do_next(hoop, arguments):
    status, out, err = hoop(*arguments)
    assert status == 0
    assert err == ""
    for word in ("hoop rigid paper-3.1", "hoop flexible", "hoop study stiffness", "hoop scenes"):
        assert word in out
    assert "..." not in out.partition("Commands:")[2].replace("(.msh, .vtu, ...)", "")  # nothing is cut off


def test_scenes_are_listed_and_printed(hoop, monkeypatch):
    status, out, _ = hoop("scenes")
    assert status == 0
    assert "paper-3.1 " in out
    assert "point-mass" in out
    monkeypatch.setenv("COLUMNS", "80")
    _, narrow, _ = hoop("scenes")
    assert max(map(len, narrow.splitlines())) <= 80
    assert narrow.split() == out.split()
    status, out, _ = hoop("scenes", "paper-3.1")
    assert status == 0
    assert "[friction]" in out


def test_json_has_the_keys_of_the_contract_and_nothing_beside(hoop):
    status, out, err = hoop("rigid", "paper-3.1", "--json")
    assert (status, err) == (0, "")
    found = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} is not JSON"))
    assert set(found) == {"scene", "phases", "turns", "pulses", "ended", "completed"}
    assert found["completed"] is True
    assert set(found["phases"][0]) == {"kind", "t_start", "t_end", "phi_start", "phi_end"}
    assert set(found["turns"][0]) == {"t", "phi", "slip_velocity", "energy"}
    asked = "t_start t_end phi_start phi_end normal_impulse friction_impulse impulse_ratio friction_loss"
    assert {*asked.split(), "peak_normal_force"} <= set(found["pulses"][0])


def test_rigid_prints_a_table_for_people(hoop):
    status, out, _ = hoop("rigid", "paper-3.1")
    assert status == 0
    assert "Phases" in out
    assert "J_F/J_N" in out
    assert "Ended:" in out


def test_out_leaves_the_motion_and_its_history(hoop, tmp_path):
    status, _, _ = hoop("rigid", "paper-3.1", "--out", tmp_path / "new" / "folder")
    assert status == 0
    out = tmp_path / "new" / "folder"
    assert json.loads((out / "motion.json").read_text())["phases"]
    header, *rows = (out / "history.csv").read_text().splitlines()
    assert header.startswith("t,phi,omega")
    peak = max(float(row.split(",")[header.split(",").index("normal_force")]) for row in rows)
    told = max(p["peak_normal_force"] for p in json.loads((out / "motion.json").read_text())["pulses"])
    assert peak == pytest.approx(told, rel=5e-3)  # the history is drawn to 2e-3 of the range of N
    assert [path.name for path in out.iterdir() if path.name.startswith(".")] == []


BAD_SCENES = {
    "k": ("k = 0.1", "k = 1.5", "hoop.k = 1.5"),
    "r": ("r = 1.02", "r = 0.9", "hoop.r = 0.9"),
    "mu": ("mu = 0.3", "mu = 0.4", "friction.mu = 0.4"),
    "nan": ("k = 0.1", "k = nan", "hoop.k = nan"),
    "word": ("k = 0.1", "k = 'tiny'", "hoop.k = 'tiny'"),
    "text": ("k = 0.1", "k = '0.1'", "hoop.k = '0.1' is not possible: it is text, not a number."),
    "key": ("mu_s = 0.35", "mus = 0.35", "friction.mus"),
    "part": ("[release]", "[releese]", "releese"),
    "toml": ("[release]", "[release", "is not TOML"),
    "angle": ("phi0_deg = 10", "phi0_deg = 1e300", "release.phi0_deg = 1e+300 is not possible"),
}


@pytest.mark.parametrize("mistake", BAD_SCENES)
@pytest.mark.parametrize("verb", [("rigid",), ("flexible",), ("study", "stiffness")])
def test_a_bad_scene_is_one_sentence(hoop, tmp_path, mistake, verb):
    right, wrong, told = BAD_SCENES[mistake]
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(k=0.1).replace(right, wrong))
    status, out, err = hoop(*verb, scene, "--json")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert told in err


@pytest.mark.parametrize("verb", [("flexible",), ("study", "stiffness"), ("study", "hop")])
@pytest.mark.parametrize("mistake", [("r = 1.02", "r = 1.0002"), ("k = 0.1\nr = 1.02", "k = 0")])
def test_a_hoop_that_cannot_be_flexible_is_one_sentence_and_leaves_nothing(hoop, tmp_path, mistake, verb):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(k=0.1).replace(*mistake))
    status, out, err = hoop(*verb, scene, "--json", "--out", tmp_path / "out")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert not [*(tmp_path / "out").glob("*")]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("rigd",), "rigid"),
        (("rigid",), "SCENE"),
        (("study",), "Missing command"),
        (("rigid", "paper-9.9"), "paper-9.9"),
        (("rigid", "paper-3.1", "--jsn"), "--json"),
        (("flexible", "paper-3.3-massless", "--fields"), "--out"),
        (("study", "sweep", "nowhere.toml"), "nowhere.toml"),
        (("study", "stiffness", "paper-3.1", "--count", "1"), "'--count': 1 "),
        (("study", "stiffness", "paper-3.1", "--count", "many"), "many"),
        (("study", "stiffness", "paper-3.1", "--low", "1e9", "--high", "1e5"), "range"),
        (("study", "stiffness", "paper-3.1", "--low", "nan"), "'--low': nan "),
        (("study", "stiffness", "paper-3.1", "--solver", "nobody"), "nobody"),
        (("study", "stiffness", "paper-3.1", "--solver", "no.such:solver"), "no.such"),
        (("study", "stiffness", "paper-3.1", "--workers", "0"), "workers"),
        *((("study", "stiffness", "paper-3.1", f"--rate={rate}"), "--rate") for rate in ("nan", "inf", "-1", "0")),
        (("study", "limit", "paper-3.1", "--damping", "nan"), "--damping"),
        (("study", "limit", "paper-3.1", "--flexible", "inf"), "--flexible"),
        (("study", "hop", "--rtol", "nan"), "--rtol"),
        (("scenes", "paper-9.9"), "paper-9.9"),
        (("view", "paper-9.9"), "paper-9.9"),
        (("view", "nowhere.pvd", "--png", "a.png"), "nowhere.pvd"),
        (("view", "paper-3.1", "--png", "a.gif"), ".png"),
        (("view", "paper-3.1", "--time", "1"), "--png"),
    ],
)
def test_a_mistake_on_the_command_line_is_one_sentence(hoop, arguments, told):
    status, out, err = hoop(*arguments)
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert told in err


def test_a_folder_that_cannot_be_is_one_sentence_before_anything_is_computed(hoop, tmp_path):
    (tmp_path / "file").write_text("in the way")
    for verb in (("rigid", "paper-3.1"), ("study", "stiffness", "paper-3.1")):
        status, out, err = hoop(*verb, "--out", tmp_path / "file")
        assert (status, out) == (2, "")
        assert is_one_sentence(err)
        status, _, err = hoop(*verb, "--out", tmp_path / "file" / "below")
        assert status == 2
        assert is_one_sentence(err)
    assert os.listdir(tmp_path) == ["file"]


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write anywhere")
def test_a_read_only_folder_is_one_sentence(hoop, tmp_path):
    tmp_path.chmod(0o500)
    status, _, err = hoop("rigid", "paper-3.1", "--out", tmp_path)
    tmp_path.chmod(0o700)
    assert status == 2
    assert is_one_sentence(err)
    assert "permission" in err


def test_a_file_that_outgrows_its_place_leaves_nothing_behind(tmp_path):
    """A limit on the size of files stands in for a full disk: the write fails in the middle either way."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))  # noqa: E731
    own = environment(PYTHONDONTWRITEBYTECODE="1")  # a module's would be cut off too, and break whoever comes next
    done = process("rigid", "paper-3.1", "--out", tmp_path, preexec_fn=limit, env=own)
    assert done.returncode == 2
    assert is_one_sentence(done.stderr)
    assert os.listdir(tmp_path) == []


def in_a_process(encoding: str, *line: str) -> tuple[int, str, str]:
    """Status, stdout and stderr of a command whose streams have that encoding."""
    done = process(*line, env=environment(PYTHONIOENCODING=encoding), encoding=encoding, errors="replace")
    return done.returncode, done.stdout, done.stderr


def in_this_one(encoding: str, *line: str) -> tuple[int, str, str]:
    """The same by streams that stand in for those of a process."""
    with pytest.MonkeyPatch.context() as patch:
        streams = [io.TextIOWrapper(io.BytesIO(), encoding=encoding) for _ in range(2)]
        for name, stream in zip(("stdout", "stderr"), streams, strict=True):
            patch.setattr(sys, name, stream)
        spell_out()
        status = run(line)
        for stream in streams:
            stream.flush()
        out, err = (stream.buffer.getvalue().decode(encoding, "replace") for stream in streams)
    return status, out, err


@pytest.mark.parametrize(
    ("encoding", "told"),
    [("ascii", in_a_process), ("latin-1", in_this_one), ("cp1252", in_this_one), ("utf-8", in_this_one)],
)
def test_any_encoding_of_stdout_will_do(encoding, told):
    """What it has not is spelled out; what a file or a pipe of UTF-8 gets is as ever."""
    status, out, err = told(encoding, "rigid", "paper-3.1")
    assert (status, err) == (0, "")
    assert ("J_F/(μ J_N)" if encoding == "utf-8" else "J_F/(mu J_N)") in out
    assert "?" not in out
    framed = [line for line in out.splitlines() if line.startswith(("|", "│", "┃"))]
    title = next(i for i, line in enumerate(framed) if "measure" in line)
    assert len(set(map(len, framed[title:]))) == 1  # of the pulses' table all edges stand in one column
    # click takes an ASCII stream for a mistake of the environment, and its sentences are UTF-8 there
    status, _, err = told(encoding, "rigid", "μ.toml")
    assert status == 2
    assert is_one_sentence(err)


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_a_closed_stdout_is_one_sentence(more):
    done = process("rigid", "paper-3.1", *more, capture_output=False, stderr=subprocess.PIPE, preexec_fn=close_stdout)
    assert done.returncode == 2
    assert is_one_sentence(done.stderr)
    assert "closed" in done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
@pytest.mark.parametrize("how", ["closed", "full"])
def test_what_nobody_can_be_told_has_its_status(how):
    with open("/dev/full", "w") as full:
        closed = {"preexec_fn": lambda: os.close(2)} if how == "closed" else {"stderr": full}
        done = process("rigid", "no-scene", capture_output=False, stdout=subprocess.PIPE, **closed)
    assert (done.returncode, done.stdout) == (2, "")


def close_stdout() -> None:
    """As ``>&-`` does in a shell."""
    os.close(1)


def test_an_interruption_while_a_command_is_loaded_is_one_sentence():
    """A hook into the first import of click stands in for the key, which would have to be pressed in time."""
    code = """if True:
        import sys
        class Pressed:
            def find_spec(self, name, path=None, target=None):
                if name == "click":
                    raise KeyboardInterrupt
        from studies.cli import main
        sys.meta_path.insert(0, Pressed())
        main()"""
    done = subprocess.run([sys.executable, "-c", code], env=environment(), capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "hoop: Interrupted.\n")


def test_a_mesh_into_no_folder_is_told_which(hoop, tmp_path):
    status, out, err = hoop("mesh", "paper-3.3-light", tmp_path / "nodir" / "ring.msh")
    assert (status, out) == (2, "")
    assert f"there is no folder {tmp_path / 'nodir'}." in err


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no folder there that takes no file of anybody's")
def test_a_folder_that_takes_no_file_is_told_before_the_work(hoop, monkeypatch):
    def work(*_, **__):
        raise AssertionError("it was run")

    monkeypatch.setattr("studies.running.solvers.solver", work)
    monkeypatch.setattr("flexible.models.select.ring_for", work)
    for command in (("view", "paper-3.1", "--png", "/proc/a.png"), ("mesh", "paper-3.3-light", "/proc/a.msh")):
        status, out, err = hoop(*command)
        assert (status, out) == (2, "")
        assert is_one_sentence(err)
        assert command[-1] in err


@pytest.mark.parametrize("name", ["", ".", "/"])
def test_a_mesh_by_the_name_of_a_folder_is_one_sentence(hoop, name):
    status, out, err = hoop("mesh", "paper-3.3-light", name)
    assert (status, out) == (2, "")
    assert is_one_sentence(err)


@pytest.mark.parametrize(("units", "length", "unit"), [("", 1.0, "R"), ("R = 0.1\nm = 0.2\ng = 9.81\n", 0.1, "m")])
def test_a_mesh_has_the_lengths_of_its_scene(hoop, tmp_path, units, length, unit):
    """In metres where R, m and g are in SI units, as the fields of the same scene are; which is said."""
    (tmp_path / "scene.toml").write_text(SCENE.format(k=0.25).replace("[friction]", f"{units}[friction]"))
    status, out, _ = hoop("mesh", tmp_path / "scene.toml", tmp_path / "ring.vtu")
    assert status == 0
    assert f"lengths in {unit}." in out
    points = meshio.read(tmp_path / "ring.vtu").points
    assert np.linalg.norm(points, axis=1).max() == pytest.approx(length, rel=1e-12)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_disk_under_stdout_is_one_sentence():
    with open("/dev/full", "w") as full:
        options = {"capture_output": False, "stdout": full, "stderr": subprocess.PIPE}
        done = process("rigid", "paper-3.1", "--json", **options)
    assert done.returncode == 2
    assert is_one_sentence(done.stderr)
    assert "full" in done.stderr


@pytest.mark.parametrize("line", [("rigid", "paper-3.1", "--json"), ("rigid", "paper-3.1"), ("-h",)])
def test_a_reader_that_leaves_early_is_no_trouble(line):
    """Nor a failure: it is told apart by its status, whether Python, click or rich finds the pipe broken."""
    nobody, out = os.pipe()
    os.close(nobody)
    try:
        done = process(*line, capture_output=False, stdout=out, stderr=subprocess.PIPE)
    finally:
        os.close(out)
    assert (done.returncode, done.stderr) == (141, "")


def test_the_backend_that_the_environment_names_is_no_matter(tmp_path):
    """No window is opened: one that matplotlib has given up years ago, in a profile, stays unused."""
    done = process("rigid", "paper-3.1", "--out", tmp_path, "--quiet", env=environment(MPLBACKEND="Qt4Agg"))
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "pulse.png").is_file()


def test_the_rigid_command_imports_nothing_heavy():
    code = (
        "import sys; from studies.cli import run; run(['rigid', 'paper-3.1', '--json']); "
        f"print([name for name in {HEAVY!r} if name in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment(), capture_output=True, text=True, timeout=HANGS
    )
    assert done.stderr.strip() == "[]"


def test_a_flexible_run_leaves_motion_ledger_and_fields(hoop, tmp_path):
    """The soft hoop of a short scene: history, figures and a series that the mesh layer reads back."""
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(k=0.25) + "[contact]\nstiffness = 1e8\ndamping = 1\n[solve]\nrtol = 1e-3\n")
    status, out, err = hoop("flexible", scene, "--json", "--out", tmp_path / "out", "--fields", "--frames", 11)
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert {"time_off_floor", "ring_energy_peak", "contact_energy_peak"} <= set(found["pulses"][0])
    books = found["energy_ledger"]
    assert {field.name for field in dataclasses.fields(Ledger)} == set(books)
    assert abs(books["residual"]) < 1e-3 * books["initial"]  # rtol; every other term is an integral of its own
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"motion.json", "motion.npz", "history.csv", "pulse.png", "energy.png", "fields.pvd"} <= names
    again = load_motion(tmp_path / "out" / "motion.npz")
    assert json.loads(to_json(again.to_dict())) == found
    assert json.loads((tmp_path / "out" / "units.json").read_text()) == again.units
    assert len(read(tmp_path / "out")) == 11


@pytest.mark.parametrize("form", [(), ("--json",)])
def test_a_motion_that_stops_early_is_told_and_leaves_with_1(tmp_path, hoop, form):
    """More than a million periods on a smooth floor are not listed: the work bound, a sentence, status 1."""
    file = tmp_path / "long.toml"
    file.write_text("[hoop]\nk = 0.1\n[friction]\nmu_s = 0\nmu = 0\n[release]\nphi0_deg = 10\n[run]\nt_end = 1e9\n")
    assert not simulate(load_scene(file)).completed
    # the same ending without its million phases on the screen
    ended = "the work bound is reached after 9.6: the motion goes on"
    early = dataclasses.replace(simulate(load_scene("paper-3.1")), completed=False, ended=ended)
    for name in ("rigid", "flexible"):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(single, "solver", lambda _: lambda scene, **_: early)
            patch.setattr(flexible, "simulate", lambda scene, **_: early)
            status, out, err = hoop(name, file, *form)
        assert status == 1
        assert is_one_sentence(err)
        assert "work bound" in err
        if form:
            assert json.loads(out)["completed"] is False
        else:
            assert "Phases" in out


def test_a_cut_pulse_is_marked_on_the_screen_and_in_json(tmp_path, hoop):
    file = tmp_path / "cut.toml"
    file.write_text(
        "[hoop]\nk = 0.1\n[friction]\nmu_s = 0.35\nmu = 0.3\n[release]\nphi0_deg = 10\n[run]\nt_end = 5.75\n"
    )
    assert "pulse 1, cut" in hoop("rigid", file)[1]
    (pulse,) = json.loads(hoop("rigid", file, "--json")[1])["pulses"]
    assert pulse["cut"] is True
    assert pulse["newton_restitution"] is None


def test_fields_and_picture_are_of_the_first_whole_pulse(hoop, tmp_path):
    """Of a hoop released inside a pulse, that is not the first which is listed."""
    scene = tmp_path / "inside.toml"
    scene.write_text(
        "[hoop]\nk = 0.1\nr = 1.02\n[friction]\nmu_s = 0.35\nmu = 0.3\n[release]\nphi0_deg = 175\nomega0 = 2\n"
        '[run]\nuntil = "pulse"\n[solve]\nrtol = 1e-2\n'
    )
    assert hoop("flexible", scene, "--out", tmp_path / "out", "--fields", "--frames", 2)[0] == 0
    cut, whole = json.loads((tmp_path / "out" / "motion.json").read_text(encoding="utf-8"))["pulses"]
    assert (cut["cut"], whole["cut"]) == (True, False)
    first, last = (frame.time for frame in read(tmp_path / "out" / "fields.pvd"))
    assert cut["t_end"] < first <= whole["t_start"]
    assert last == pytest.approx(whole["t_end"], abs=1e-9)
