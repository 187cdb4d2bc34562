"""Folders of results: whose they are, one run's alone, and what an interrupted command says it left."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import click
import pytest
from command_line import SCENE, is_one_sentence, process

from studies import StudyError
from studies.bench.race import Result
from studies.cli import hoop as cli
from studies.cli.shared import results
from studies.running import progress
from studies.running.case import Case, Outcome, run_case

pytestmark = pytest.mark.usefixtures("undrawn")


def names(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def scene(tmp_path: Path) -> Callable[..., Path]:
    """A flexible hoop of few steps; without mass its ring keeps less."""

    def write(k: float = 0.1, more: str = "") -> Path:
        file = tmp_path / f"scene-{k}.toml"
        file.write_text(SCENE.format(k=k) + more + "[contact]\nstiffness = 1e7\n[solve]\nrtol = 1e-2\n")
        return file

    return write


@pytest.mark.parametrize(
    ("line", "file"),
    [
        (("rigid", "paper-3.1"), "history.csv"),
        (("rigid", "paper-3.1"), "command.txt"),
        (("paper",), "table.csv"),
        (("paper",), "figure-07-left.csv"),
        (("study", "atlas"), "atlas.json"),
        (("bench", "rigid"), "bench-rigid.json"),
    ],
)
def test_a_strangers_file_is_not_written_over(hoop, tmp_path, line, file):
    out = tmp_path / "d"
    out.mkdir()
    (out / file).write_text("mydata")
    status, printed, err = hoop(*line, "--out", out)
    assert (status, printed) == (2, "")
    assert is_one_sentence(err)
    assert file in err
    assert "--overwrite" in err
    assert names(out) == {file}
    assert (out / file).read_text() == "mydata"


def test_a_folder_with_other_files_is_taken_and_they_stay(hoop, tmp_path):
    (tmp_path / "notes.md").write_text("mine")
    (tmp_path / "my-pulse.png").write_text("mine")
    assert hoop("rigid", "paper-3.1", "--out", tmp_path)[0] == 0
    assert hoop("rigid", "paper-3.4-rough", "--out", tmp_path)[0] == 0
    assert (tmp_path / "notes.md").read_text() == (tmp_path / "my-pulse.png").read_text() == "mine"


def test_a_folder_whose_name_is_no_utf_8_is_known_again(hoop, tmp_path, scene):
    """As an archive of other times has them; the command line that it is marked with has the same bytes."""
    out = tmp_path / "caf\udce9"
    try:
        out.mkdir()
    except OSError:
        pytest.skip("names are UTF-8 here")
    file = scene()
    for _ in range(2):
        assert hoop("rigid", file, "--out", out)[0] == 0
    assert os.fsencode(out) in (out / results.MADE_BY).read_bytes()


def test_overwrite_of_nothing(hoop):
    status, out, err = hoop("rigid", "paper-3.1", "--overwrite")
    assert (status, out) == (2, "")
    assert err.startswith("hoop: --overwrite needs --out DIR")


def test_overwrite_takes_a_strangers_folder(hoop, tmp_path):
    (tmp_path / "history.csv").write_text("mydata")
    assert hoop("rigid", "paper-3.1", "--out", tmp_path, "--overwrite")[0] == 0
    assert (tmp_path / "history.csv").read_text().startswith("t,phi")


@pytest.mark.parametrize("line", [("rigid", "paper-3.1"), ("study", "stiffness", "paper-3.1"), ("stress", "--quick")])
def test_an_empty_name_is_no_folder(hoop, tmp_path, monkeypatch, line):
    monkeypatch.chdir(tmp_path)
    status, out, err = hoop(*line, "--out", "")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert "--out" in err
    assert os.listdir(tmp_path) == []


def test_a_link_that_leads_nowhere_is_called_that(hoop, tmp_path):
    """It was said to be a file in the way, which nobody finds."""
    (tmp_path / "out").symlink_to(tmp_path / "gone")
    status, out, err = hoop("rigid", "paper-3.1", "--out", tmp_path / "out")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert "a link that leads nowhere" in err
    assert not (tmp_path / "gone").exists()


def test_a_folder_holds_one_run(hoop, tmp_path, scene):
    """Fields and figures of the first do not stay beside the second, which has no pulse; somebody's notes do."""
    out = tmp_path / "p"
    assert hoop("flexible", scene(0.1), "--out", out, "--fields", "--frames", 3, "--only", "displacement")[0] == 0
    assert {"fields.pvd", "pulse.png", "fields/about.json"} <= names(out)
    (out / "fields" / "my notes").write_text("mine")
    short = tmp_path / "short.toml"
    short.write_text(scene(0.2).read_text().replace('until = "pulse"', "t_end = 0.5"))
    status, _, err = hoop("flexible", short, "--out", out)
    assert status == 0, err
    assert names(out) == {"command.txt", "motion.json", "motion.npz", "history.csv", "units.json", "fields/my notes"}
    assert "short.toml" in (out / "command.txt").read_text()


def test_overwriting_another_commands_results_removes_them(hoop, tmp_path, scene):
    out = tmp_path / "p"
    assert hoop("flexible", scene(), "--out", out, "--fields", "--frames", 2, "--only", "displacement")[0] == 0
    assert hoop("study", "atlas", "--side", 16, "--out", out, "--overwrite")[0] == 0
    assert names(out) == {"command.txt", "atlas.png", "atlas.npz", "atlas.json"}
    assert not (out / "fields").exists()


def test_a_run_that_is_refused_leaves_the_earlier_one(hoop, tmp_path, scene):
    out = tmp_path / "p"
    assert hoop("flexible", scene(), "--out", out)[0] == 0
    before = {name: (out / name).read_bytes() for name in names(out)}
    thin = tmp_path / "thin.toml"
    thin.write_text(SCENE.format(k=0.1).replace("r = 1.02", "r = 1.0002"))
    assert hoop("flexible", thin, "--out", out)[0] == 2
    assert before == {name: (out / name).read_bytes() for name in names(out)}


def test_the_earlier_motion_stays_until_the_next_one_is_whole(hoop, tmp_path, scene, monkeypatch):
    """It may be the one that is gone on from, and the only one: whatever fails before it is replaced."""
    out = tmp_path / "p"
    assert hoop("flexible", scene(), "--out", out)[0] == 0
    before = (out / "motion.npz").read_bytes()

    def full(path: object, text: str) -> None:
        raise StudyError("the disk is full.")

    monkeypatch.setattr("studies.cli.shared.output.write_text", full)
    assert hoop("flexible", scene(), "--out", out)[0] == 2
    assert (out / "motion.npz").read_bytes() == before


@pytest.mark.slow
def test_what_a_command_writes_is_known(hoop, tmp_path, scene):
    """Or it would stay behind beside the next run's."""
    sweep = tmp_path / "two.toml"
    sweep.write_text(SCENE.format(k="[0.1, 0.2]") + '[sweep]\nsolvers = ["rigid"]\nhistories = true\n')
    study = ("study", "stiffness", scene(), "--count", 2, "--low", 1e6, "--high", 1e7, "--workers", 1)
    for line in (
        ("rigid", "paper-3.1"),
        ("flexible", scene(), "--fields", "--frames", 2),
        ("study", "sweep", sweep, "--workers", 1),
        ("study", "limit", "paper-3.3-massless", "--workers", 1),
        study,
    ):
        out = tmp_path / line[0] / Path(line[1]).stem
        assert hoop(*line, "--out", out)[0] == 0
        command = " ".join(["hoop", *map(str, line[: 2 if line[0] == "study" else 1])])
        known = {path for name in results.WRITTEN[command] for path in out.glob(name)}
        rest = {path.name for path in out.iterdir()} - {path.name for path in known}
        assert rest <= {"command.txt", "study.sqlite", "histories"}
        told = json.loads((out / "units.json").read_text(encoding="utf-8"))
        assert told["friction_loss"] == "mgR"  # all of these scenes are without units
        assert {path.name for path in (out / "fields").glob("*")} <= {path.name for path in known}


def test_figures_of_studies_are_among_what_is_known():
    from studies.stiffness.told.report import CAPTIONS

    assert {f"{name}.svg" for name in CAPTIONS} < set(results.WRITTEN["hoop study stiffness"])


def test_every_command_with_a_folder_is_known():
    def commands(group: click.Group, before: str) -> dict[str, click.Command]:
        found: dict[str, click.Command] = {}
        for name, one in group.commands.items():
            more = commands(one, f"{before} {name}") if isinstance(one, click.Group) else {f"{before} {name}": one}
            found |= more
        return found

    writing = {n for n, one in commands(cli.hoop, "hoop").items() if any(p.name == "out" for p in one.params)}
    assert writing == set(results.WRITTEN)


@pytest.mark.slow
@pytest.mark.parametrize("line", [("stress", "--quick"), ("bench", "rigid", "--quick"), ("paper",)])
def test_an_interrupted_command_says_only_what_is_true(hoop, tmp_path, monkeypatch, line):
    """Nothing is kept and no folder stays, made by the command or above it; one that was there is left."""

    def typed(title: str) -> None:
        raise KeyboardInterrupt  # a signal is ignored where the tests run in the background

    monkeypatch.setattr(progress, "bar", typed)
    for out in (tmp_path / "new" / "folder", tmp_path):
        status, _, err = hoop(*line, "--out", out)
        assert status == 130
        assert err.strip() == "hoop: Interrupted."
        assert os.listdir(tmp_path) == []


def test_a_folder_that_another_run_of_the_command_marks_meanwhile_is_shared(hoop, tmp_path, monkeypatch):
    """The other one makes its mark when this one has just looked whose the folder is."""
    look = results._held

    def then_marked(path: Path) -> str:
        seen = look(path)
        (tmp_path / "command.txt").write_text("hoop rigid paper-3.1\n")
        return seen

    monkeypatch.setattr(results, "_held", then_marked)
    status, _, err = hoop("rigid", "paper-3.1", "--json", "--out", tmp_path)
    assert (status, err) == (0, "")


@pytest.mark.slow
def test_who_interrupts_the_drawing_of_a_study_has_its_table_and_is_told_how_to_go_on(
    hoop, scene, tmp_path, monkeypatch
):
    """Two cases are run and kept; at the figures somebody types Ctrl-C. The same again draws them, and runs none."""
    real = progress.bar

    def typed(title: str):
        if title == "figures and fields":
            raise KeyboardInterrupt
        return real(title)

    out = tmp_path / "out"
    line = ("study", "stiffness", scene(), "--count", 2, "--low", 1e6, "--high", 1e7, "--workers", 1, "--out", out)
    with monkeypatch.context() as patch:
        patch.setattr(progress, "bar", typed)
        status, told, err = hoop(*line)
    assert status == 130
    assert "First pulse over the ladder of stiffness" in told
    assert not (out / "report.html").exists()
    (last,) = [sentence for sentence in err.splitlines() if "Interrupted" in sentence]
    assert "2 finished cases are kept" in last
    assert "the same command again" in last
    monkeypatch.setattr("studies.running.workers.run_case", _not_again)
    assert hoop(*line)[0] == 0
    assert (out / "report.html").exists()


def _typed(*_: object, **__: object) -> None:
    raise KeyboardInterrupt


def _not_again(case: Case) -> Outcome:
    """What stands in for running a case, where the flexible ones are kept."""
    assert case.solver == "rigid", "it was run again"
    return run_case(case)


def test_who_interrupts_a_limit_is_told_what_is_kept_and_how_to_go_on(hoop, tmp_path, monkeypatch):
    """At the map, behind a flexible case that is not run again; at a figure; and there without such a case."""
    line = ("study", "limit", "paper-3.3-massless", "--flexible", 1e7, "--workers", 1)
    kept = f"hoop: Interrupted; 1 finished case is kept in {tmp_path}; the same command again takes it from there."
    with monkeypatch.context() as patch:
        patch.setattr("studies.limit.damping.damping_map", _typed)
        status, out, err = hoop(*line, "--map", "--out", tmp_path)
        assert (status, out, err.strip()) == (130, "", kept)
    monkeypatch.setattr("studies.limit.figures.of_limit", _typed)
    monkeypatch.setattr("studies.running.workers.run_case", _not_again)
    status, out, err = hoop(*line, "--out", tmp_path)
    assert (status, out, err.strip()) == (130, "", kept)
    written = f"what was written is in {tmp_path / 'new'}; the same command again writes all of it"
    status, out, err = hoop(*line[:3], "--workers", 1, "--out", tmp_path / "new")
    assert (status, out, err.strip()) == (130, "", f"hoop: Interrupted; {written}.")
    assert names(tmp_path / "new") == {"command.txt", "limit.csv", "limit.json", "units.json"}


def test_who_interrupts_the_figure_of_a_benchmark_is_told_what_is_there(hoop, tmp_path, monkeypatch):
    monkeypatch.setattr("studies.bench.rigid.bench", lambda *_: Result())
    monkeypatch.setattr("studies.bench.shown.figures.draw", _typed)
    written = f"what was written is in {tmp_path}; the same command again writes all of it"
    status, out, err = hoop("bench", "rigid", "--out", tmp_path)
    assert (status, out, err.strip()) == (130, "", f"hoop: Interrupted; {written}.")
    assert names(tmp_path) == {"command.txt", "bench-rigid.json"}


@pytest.mark.slow
def test_a_study_whose_table_nobody_reads_leaves_its_files(scene, tmp_path):
    """As ``| head -1`` does: the reader is gone before the table is printed, which comes before the figures."""
    out = tmp_path / "out"
    line = ("study", "stiffness", scene(), "--count", 2, "--solver", "third_solver:softened", "--out", out)
    read, write = os.pipe()
    os.close(read)
    done = process(*line, capture_output=False, stdout=write, stderr=subprocess.PIPE)
    os.close(write)
    assert done.returncode == 141
    assert (out / "report.html").is_file()
