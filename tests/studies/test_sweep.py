"""Sweeps: the product of what a file lists, safe against everything that can happen to a long run."""

from __future__ import annotations

import dataclasses
import errno
import io
import json
import math
import os
import pickle
import re
import resource
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from importlib import metadata
from multiprocessing.context import SpawnProcess
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from command_line import HANGS, SCENE, command, environment, is_one_sentence, process

from rigid import SceneError, load_scene, scene_from_dict, scene_to_dict
from rigid import simulate as rigid_motion
from rigid.output import whole
from studies import MEASURES, Measure, StudyError, Table, Unit, load_sweep, pool, run_sweep, sweep_from_dict
from studies.machine.build import build
from studies.machine.processes import Processes, WorkerDied
from studies.running.case import Case, run_case
from studies.running.measures import phase_sequence
from studies.running.runs import Estimate, run_cases
from studies.running.store import Store
from studies.running.workers import Here
from studies.sweepfile import MAX_CASES

KS = "[0.1, 0.15, 0.2, 0.25, 0.3, 0.35]"


THIRD = "third_solver:softened"


def sweep_file(folder: Path, **lists: str) -> Path:
    """A sweep over k (six values) and whatever else is given as ``hoop__r="[1.0, 1.02]"``, rigid unless told."""
    text = SCENE.format(k=lists.pop("k", KS)) + "[sweep]\nsolvers = ['rigid']\n"
    for name, values in lists.items():
        part, key = name.split("__")
        text = (
            text.replace(f"[{part}]\n", f"[{part}]\n{key} = {values}\n")
            if f"[{part}]" in text
            else text + f"[{part}]\n{key} = {values}\n"
        )
    file = folder / "many.toml"
    file.write_text(text)
    return file


def by(*solvers: str) -> list[str]:
    """Solvers as a command line names them."""
    return [word for name in solvers for word in ("--solver", name)]


def wait_for_rows(folder: Path, count: int) -> None:
    """Wait until a running sweep has kept so many cases."""
    deadline = time.monotonic() + HANGS
    while time.monotonic() < deadline:
        if (folder / "study.sqlite").exists() and len(Store(folder).done()) >= count:
            return
        time.sleep(0.05)
    raise AssertionError(f"no {count} rows in {HANGS} s")


def test_every_combination_is_a_row_for_each_solver(hoop, tmp_path):
    file = sweep_file(tmp_path, k="[0.1, 0.25]", contact__stiffness="[1e8, 1e9, 1e10]")
    line = ["study", "sweep", file, "--out", tmp_path / "out", "--workers", 1, "--json"]
    status, out, err = hoop(*line, *by("rigid", THIRD))
    assert (status, err) == (0, "")
    rows = json.loads(out)["rows"]
    assert len(rows) == 2 * 3 * 2
    seen = [(row["hoop.k"], row["contact.stiffness"], row["solver"]) for row in rows]
    assert seen == [(k, s, w) for k in (0.1, 0.25) for s in (1e8, 1e9, 1e10) for w in ("rigid", THIRD)]
    rigid = {row["impulse_ratio"] for row in rows if row["solver"] == "rigid" and row["hoop.k"] == 0.1}
    assert len(rigid) == 1  # the rigid hoop does not look at the contact
    third = [row["impulse_ratio"] for row in rows if row["solver"] != "rigid" and row["hoop.k"] == 0.1]
    assert third[0] > third[1] > third[2] > rigid.pop()


def test_the_table_is_a_data_frame_and_a_csv_of_the_same_numbers(tmp_path):
    pandas = pytest.importorskip("pandas")
    table = run_sweep(load_sweep(sweep_file(tmp_path, k="[0.1, 0.25]"), ["rigid", THIRD]), Here())
    frame = table.to_dataframe()
    assert list(frame["hoop.k"]) == [0.1, 0.1, 0.25, 0.25]
    (tmp_path / "table.csv").write_text(table.to_csv())
    read = pandas.read_csv(tmp_path / "table.csv", dtype={"friction_loss": str})
    assert [float(text) for text in read["friction_loss"]] == list(frame["friction_loss"])


def test_each_number_is_below_the_name_of_its_measure(tmp_path, monkeypatch):
    """Of rows that were kept before another measure was entered, too, and of a table that is older than one."""
    lists = {"sweep": {"scene": "paper-3.1", "solvers": ["rigid"]}, "run": {"until": "pulse"}}
    some, more = ({**lists, "hoop": {"k": ks}} for ks in ([0.1], [0.1, 0.2]))
    monkeypatch.setitem(MEASURES, "begins", Measure("begins", "t0", Unit.TIME, lambda motion, pulse: pulse.t_start))
    first = run_sweep(some, out=tmp_path)
    monkeypatch.delitem(MEASURES, "begins")
    monkeypatch.setitem(MEASURES, "angle", Measure("angle", "phi0", Unit.NUMBER, lambda motion, pulse: pulse.phi_start))
    second = run_sweep(more, out=tmp_path)
    assert "angle" not in first.to_dataframe()
    assert "begins" not in second.to_dataframe()
    together = Table((*first.rows, *second.rows))
    for table in (first, second, together):
        none = {"begins": ["nan"], "angle": ["nan"]}
        read = pd.read_csv(io.StringIO(table.to_csv()), keep_default_na=False, na_values=none)
        pd.testing.assert_frame_equal(read, table.to_dataframe(), check_exact=False, rtol=1e-14)
    frame = together.to_dataframe()
    assert frame["begins"].isna().tolist() == [False, True, True]
    assert frame["angle"].isna().tolist() == [True, False, False]
    assert list(frame)[-4:] == ["phases", "ended", "failure", "key"]


MEASURED = """\
import studies

def two(motion, pulse):
    return pulse.{what}

if {where}:
    studies.measure("t", studies.Unit.TIME)(two)

if __name__ == "__main__":
    import mine
    lists = {{"sweep": {{"scene": "paper-3.1", "solvers": ["rigid"]}}, "hoop": {{"k": [0.1, 0.2]}}}}
    with studies.pool(2) as place:
        table = studies.run_sweep({{**lists, "run": {{"until": "pulse"}}}}, place, "out")
    for row in table.rows:
        print(*(row.outcome.pulses[0][name] for name in ("one", "two", "duration")))
"""


@pytest.mark.slow
def test_workers_have_the_measures_of_modules_and_of_the_script(tmp_path):
    """One that is defined anew is measured anew; one that they cannot have ends the sweep."""
    of = "import studies\n\n@studies.measure('t', studies.Unit.TIME)\ndef one(motion, pulse): return pulse.t_start\n"
    (tmp_path / "mine.py").write_text(of)
    script = tmp_path / "script.py"

    def ended(what: str, where: str = "True") -> subprocess.CompletedProcess[str]:
        script.write_text(MEASURED.format(what=what, where=where))
        words = [sys.executable, script]
        return subprocess.run(words, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=HANGS)

    def rows(done: subprocess.CompletedProcess[str]) -> list[list[float]]:
        assert done.stderr == ""
        return [[float(word) for word in line.split()] for line in done.stdout.splitlines()]

    begun, over = rows(ended("t_start")), rows(ended("t_end"))
    assert len(begun) == len(over) == 2
    for (start, same, lasts), (start_too, end, _) in zip(begun, over, strict=True):
        assert start == same == start_too
        assert end == pytest.approx(start + lasts)
    refused = ended("t_start + 1", "__name__ == '__main__'")
    assert refused.returncode == 1
    assert "StudyError: The workers run" in refused.stderr
    assert "measures entered" in refused.stderr


def test_each_pulse_is_a_record_with_its_own_number_measures_and_phases():
    """As the motion itself has them; of a run that ends before its first pulse there is one, of no number."""
    scenes = {"turns": 3}, {"t_end": 0.1}
    for run in scenes:
        data = {"sweep": {"scene": "paper-3.3-light", "solvers": "rigid"}, "friction": {"mu": [0.1, 0.3]}, "run": run}
        records = run_sweep(data).records()
        expected = []
        for mu in (0.1, 0.3):
            motion = rigid_motion(load_scene("paper-3.3-light").replace(friction={"mu": mu}, run=run))
            whole_ones = [pulse for pulse in motion.pulses if not pulse.cut]
            for number, pulse in enumerate(whole_ones, 1):
                phases = " ".join(phase_sequence(motion, pulse))
                expected.append((mu, number, phases, pulse.normal_impulse, pulse.friction_loss))
            if not whole_ones:
                expected.append((mu, 0, "", None, None))
        names = ("friction.mu", "pulse", "phases", "normal_impulse", "friction_loss")
        found = [tuple(None if record[n] != record[n] else record[n] for n in names) for record in records]
        assert found == expected
        if "turns" in run:
            assert len({phases for _, _, phases, _, _ in expected}) > 1
            assert len(expected) > 2


def test_a_base_scene_by_name():
    sweep = sweep_from_dict({"sweep": {"scene": "paper-3.1", "solvers": "rigid"}, "friction": {"mu": [0.2, 0.3]}})
    assert sweep.keys == ("friction.mu",)
    scenes = [scene for _, scene in sweep.points]
    assert [scene.friction.mu for scene in scenes] == [0.2, 0.3]
    assert scenes[1] == scene_from_dict(scene_to_dict(load_scene("paper-3.1")))


def test_a_base_scene_is_looked_for_beside_the_sweep_and_then_here(tmp_path, monkeypatch):
    """As files that name files mostly mean it; where there is none beside, a scene in the current folder will do."""
    here, there = tmp_path / "here", tmp_path / "there"
    for folder, k in ((here, 0.2), (there, 0.3)):
        folder.mkdir()
        (folder / "base.toml").write_text(SCENE.format(k=k))
    monkeypatch.chdir(here)
    file = there / "sweep.toml"
    file.write_text('[sweep]\nscene = "base.toml"\nsolvers = "rigid"\n[friction]\nmu = [0.2, 0.3]\n')
    assert [scene.hoop.k for _, scene in load_sweep(file).points] == [0.3, 0.3]
    (there / "base.toml").unlink()
    assert [scene.hoop.k for _, scene in load_sweep(file).points] == [0.2, 0.2]
    file.write_text(file.read_text().replace("base.toml", "paper-3.1"))
    assert [scene.hoop for _, scene in load_sweep(file).points] == [load_scene("paper-3.1").hoop] * 2


def test_a_section_goes_with_the_scene_from_which_a_sweep_starts():
    """E I/(m g R^2) and m_h/m of one section fall like 1/m, and E I/(m g R^2) rises like E."""
    own = load_scene("steel-strip")
    heavier = [scene for _, scene in swept({"scene": "steel-strip"}, hoop={"m": [0.2, 2.0]})]
    assert heavier[0] == own
    assert heavier[1].ring.bending_stiffness == pytest.approx(own.ring.bending_stiffness / 10)
    assert heavier[1].hoop.mass_ratio == pytest.approx(own.hoop.mass_ratio / 10)
    softer, stiffer = (scene.ring for _, scene in swept({"scene": "printed"}, ring={"youngs_modulus": [1e9, 2e9]}))
    assert stiffer.bending_stiffness == pytest.approx(2 * softer.bending_stiffness)


def test_numbers_without_units_are_laid_over_what_the_section_says_of_the_scenes_own():
    own = load_scene("steel-strip")
    stiffer = [scene for _, scene in swept({"scene": "steel-strip"}, ring={"bending_stiffness": [10.0]})]
    assert stiffer == [own.replace(ring={"bending_stiffness": 10.0})]
    with pytest.raises(SceneError, match=r"bending_stiffness and ring\.youngs_modulus cannot both"):
        swept({"scene": "steel-strip"}, ring={"bending_stiffness": [10.0]}, hoop={"m": 1.0})


def test_an_angle_in_degrees_is_laid_over_one_in_radians_beside_degrees(tmp_path):
    exact = "phi0_deg = 10\nphi0 = 0.17453292519943298"
    file = tmp_path / "exact.toml"
    file.write_text(SCENE.format(k=0.1).replace("phi0_deg = 10", exact))
    angles = [scene.release.phi0_deg for _, scene in swept({"scene": str(file)}, release={"phi0_deg": [20, 30]})]
    assert angles == pytest.approx([20, 30])


def swept(settings: dict[str, Any], **tables: dict[str, Any]) -> list[tuple[tuple[Any, ...], Any]]:
    """The points of a sweep from a dict."""
    return list(sweep_from_dict({"sweep": settings, **tables}).points)


def test_equal_values_of_a_list_are_run_once():
    sweep = sweep_from_dict({"sweep": {"scene": "paper-3.1", "solvers": "rigid"}, "hoop": {"k": [0.1, 0.2, 0.1]}})
    assert (sweep.choices, sweep.repeated) == (((0.1, 0.2),), 1)
    assert sweep.announcement() == "2 cases: 2 of hoop.k × 1 solver (of equal values one)"


def test_a_sweep_may_begin_with_an_editors_mark(tmp_path):
    file = sweep_file(tmp_path)
    file.write_text(file.read_text(), encoding="utf-8-sig")
    assert load_sweep(file).scenes == 6


@pytest.mark.parametrize(
    ("part", "key", "values"),
    [
        ("hoop", "k", [0.1, float("nan")]),
        ("hoop", "k", [0.1, "a"]),
        ("hoop", "k", [0.1, -0.1]),
        ("hoop", "k", [0.1, [0.2]]),
        ("hoop", "m", [1.0, 0.0]),
        ("friction", "mu", [0.1, -0.1]),
        ("friction", "mu_s", [0.4, float("inf")]),
        ("release", "phi0_deg", [10, "ten"]),
        ("release", "omega0", [0.0, 1e300]),
        ("contact", "law", ["patch", "brsh"]),
        ("ring", "youngs_modulus", [1e9, -1e9]),
        ("hoop", "kk", [0.1]),
    ],
)
def test_a_value_that_no_scene_can_have_is_refused_before_anything_runs(part, key, values):
    """What another key does not let be (mu above mu_s) is that row's failure: see above."""
    with pytest.raises(SceneError, match=rf"{part}\.{key} "):
        sweep_from_dict({"sweep": {"scene": "printed"}, part: {key: values}})


@pytest.mark.parametrize("scene", ["x" * 300, 3, {"hoop": {"k": 0.1}}])
def test_what_names_no_scene_is_refused(scene):
    with pytest.raises(SceneError, match=r"cannot be read|is not possible: it is the name of"):
        sweep_from_dict({"sweep": {"scene": scene}, "hoop": {"k": [0.1, 0.2]}})


def test_a_sweep_in_python_takes_a_scene_and_one_solver(tmp_path):
    """A word is one solver, and not its letters."""
    laid = {"hoop": {"k": [0.1, 0.2]}}
    named = sweep_from_dict({"sweep": {"scene": "paper-3.1", "solvers": "rigid"}, **laid})
    given = sweep_from_dict({"sweep": {"scene": load_scene("paper-3.1")}, **laid}, "rigid")
    assert given.solvers == ("rigid",)
    assert list(given.points) == list(named.points)
    (tmp_path / "sweep.toml").write_text('hoop.k = [0.1, 0.2]\nsweep.scene = "paper-3.1"')
    assert load_sweep(tmp_path / "sweep.toml", "rigid") == named


def test_a_case_that_fails_is_a_row_with_its_reason(hoop, tmp_path):
    file = sweep_file(
        tmp_path,
        k="[0.1]",
        contact__stiffness="[1e9, 1e11]",
        friction__mu_s="[0.2, 0.35]",
    )
    file.write_text(file.read_text().replace("mu_s = 0.35\n", ""))
    line = ["study", "sweep", file, "--out", tmp_path / "out", "--workers", 1, "--json"]
    status, out, err = hoop(*line, *by("third_solver:failing"))
    assert status == 1
    assert "1 of 2 cases failed" in err  # the other two are no hoop
    rows = {(row["friction.mu_s"], row["contact.stiffness"]): row for row in json.loads(out)["rows"]}
    assert rows[0.35, 1e9]["failure"] == ""
    assert "no step could be found at t = 4.2" in rows[0.35, 1e11]["failure"]
    assert "friction.mu = 0.3" in rows[0.2, 1e9]["failure"]  # mu > mu_s: this scene cannot be
    assert rows[0.35, 1e11]["impulse_ratio"] is None


def impossible(folder: Path, *mus: float) -> Path:
    """A sweep over mu_s = 0.35, 0.2 and these kinetic coefficients."""
    file = folder / "many.toml"
    lists = f"[friction]\nmu_s = [0.35, 0.2]\nmu = {list(mus)}\n"
    file.write_text(f"[sweep]\nscene = 'paper-3.1'\nsolvers = ['rigid']\n{lists}")
    return file


def test_combinations_that_no_hoop_can_have_are_counted_first_and_are_no_failures(hoop, tmp_path):
    """Of mu_s = 0.35, 0.2 with mu = 0.3, 0.4 kinetic friction exceeds static friction in three of four."""
    file, out = impossible(tmp_path, 0.3, 0.4), tmp_path / "out"
    status, printed, err = hoop("study", "sweep", file, "--out", out, "--workers", 1)
    assert status == 0
    assert len(err.splitlines()) == 1
    assert err.startswith("hoop: 4 cases, 3 of them no hoop: 2 of friction.mu_s × 2 of friction.mu × 1 solver, into")
    assert "No hoop: friction.mu = 0.4 is not possible" in err
    for mu_s, mu in ((0.35, 0.4), (0.2, 0.3), (0.2, 0.4)):
        assert f"no hoop at friction.mu_s = {mu_s}, friction.mu = {mu}:" in " ".join(printed.split())
    rows = pd.read_csv(out / "table.csv")
    why = rows["failure"].notna()
    assert list(why) == list(rows["friction.mu"] > rows["friction.mu_s"])
    assert rows["key"].notna().tolist() == [not each for each in why]
    status, printed, err = hoop("study", "sweep", file, "--out", out, "--workers", 1, "--json")
    told = json.loads(printed)
    assert (status, err, told["failures"], told["impossible"]) == (0, "", 0, 3)


def test_a_table_tells_failures_from_what_no_hoop_can_be(tmp_path):
    """For each solver; an outcome that there is not has no scene."""
    data = {"hoop": {"k": 0.1, "r": 1.02}, "friction": {"mu_s": [0.35, 0.2], "mu": 0.3}, "release": {"phi0_deg": 10},
            "run": {"until": "pulse"}, "contact": {"stiffness": [1e9, 1e11]}}  # fmt: skip
    sweep = sweep_from_dict(data, ["rigid", "third_solver:failing"])
    assert (sweep.cases, sweep.impossible) == (8, 4)
    table = run_sweep(sweep)
    assert (table.failures, table.impossible) == (1, 4)
    assert repr(table) == "Table(8 rows, 1 failed, 4 no hoop)"
    assert [row.impossible for row in table.rows] == [row.values["friction.mu_s"] < 0.3 for row in table.rows]


def test_a_sweep_in_which_no_hoop_can_be_is_refused_and_leaves_nothing(hoop, tmp_path):
    file, out = impossible(tmp_path, 0.4, 0.5), tmp_path / "out"
    status, printed, err = hoop("study", "sweep", file, "--out", out, "--workers", 1)
    assert (status, printed) == (2, "")
    assert is_one_sentence(err)
    assert "friction.mu = 0.4 is not possible" in err
    assert not out.exists()


def test_what_a_solver_prints_is_no_part_of_the_output(tmp_path):
    """With --json stdout is JSON and nothing else, whoever greets there; by two workers as by one."""
    file = sweep_file(tmp_path)
    for workers in (1, 2):
        done = process("study", "sweep", file, "--json", "--workers", workers, *by("third_solver:talking"))
        assert done.returncode == 0
        assert len(json.loads(done.stdout)["rows"]) == 6


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[hoop]\nk = [0.1]\n[sweep]\nsolvers = ['nobody']", "nobody"),
        ("[hoop]\nk = [0.1]\n[sweep]\nsolvers = ['os:abort']", "--solver module:function"),
        ("[hoop]\nk = [0.1]\n[sweep]\nsolvers = 'third_solver:softened'", "--solver module:function"),
        ("[hoop]\nk = [0.1]\n[sweep]\nworkers = 3", "sweep.workers"),
        ("[hoop]\nk = []\n[friction]\nmu = 1\nmu_s = 1\n[release]\nphi0_deg = 1", "hoop.k"),
        ("[hoop]\nkk = [0.1]\n[friction]\nmu = 1\nmu_s = 1\n[release]\nphi0_deg = 1", "hoop.kk"),
        ("[hoop]\nk = [1.5, 2]\n[friction]\nmu = 1\nmu_s = 1\n[release]\nphi0_deg = 1", "hoop.k = 1.5"),
        ("[hoop]\nk = [0.1]", "missing"),
        ("[hoop", "TOML"),
        ("hoop = [1, 2]", "table"),
    ],
)
def test_a_bad_sweep_is_one_sentence(hoop, tmp_path, text, told):
    (tmp_path / "many.toml").write_text(text)
    status, out, err = hoop("study", "sweep", tmp_path / "many.toml", "--out", tmp_path / "out")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert told in err


def test_one_key_for_one_scene():
    data = {"hoop": {"k": 0.5}, "friction": {"mu_s": 1, "mu": 1}, "release": {"phi0_deg": 10}}
    one = Case("rigid", scene_from_dict(data))
    data["friction"] = {"mu_s": 1.0, "mu": 1.0}
    assert Case("rigid", scene_from_dict(data)).key == one.key
    data["hoop"] = {"k": 0.5000000000000001}
    others = [
        Case("rigid", scene_from_dict(data)),
        Case("flexible", one.scene),
        Case("rigid", one.scene, (("peak", 1.0),)),
    ]
    assert len({one.key, *(other.key for other in others)}) == 4


def test_a_result_of_another_version_is_not_taken_for_ours(monkeypatch):
    case = Case("rigid", load_scene("paper-3.1"))
    before = case.key
    monkeypatch.setattr("studies.machine.build.version", lambda: "99.0")
    build.cache_clear()
    assert Case("rigid", load_scene("paper-3.1")).key != before
    build.cache_clear()


@pytest.mark.parametrize("package", ["numpy", "numba"])
def test_a_result_of_other_packages_is_not_taken_for_ours(monkeypatch, package):
    """The last digits of a result are those of the packages that it was computed with."""
    case = Case("rigid", load_scene("paper-3.1"))
    there = metadata.version
    monkeypatch.setattr(metadata, "version", lambda name: "99.0" if name == package else there(name))
    build.cache_clear()
    assert Case("rigid", load_scene("paper-3.1")).key != case.key
    build.cache_clear()


def test_the_store_gives_back_what_it_was_given(tmp_path):
    outcome = run_case(Case("third_solver:softened", load_scene("paper-3.1"), histories=True))
    store = Store(tmp_path)
    store.add(outcome)
    back = Store(tmp_path).get(outcome.key)
    assert back is not None
    assert back.pulses == outcome.pulses
    assert back.motion == outcome.motion
    assert len(back.histories) == len(outcome.histories) > 0
    for mine, theirs in zip(outcome.histories, back.histories, strict=True):
        assert all(np.array_equal(mine[name], theirs[name]) for name in mine)


def test_the_store_keeps_an_infinite_force_of_a_jam_and_what_is_not_known(tmp_path):
    """JSON has neither."""
    outcome = run_case(Case("rigid", load_scene("paper-3.1")))
    entry = {
        "peak_normal_force": math.inf,
        "impulse_ratio": -math.inf,
        "friction_loss": math.nan,
        "normal_impulse": 1.5,
    }
    Store(tmp_path).add(dataclasses.replace(outcome, pulses=(entry,), numerical_error=(entry,)))
    back = Store(tmp_path).get(outcome.key)
    for (found,) in (back.pulses, back.numerical_error):
        assert found == pytest.approx(entry, nan_ok=True)


def test_a_row_is_never_there_without_its_arrays(tmp_path, monkeypatch):
    """The process dies between the arrays and the row, or in the middle of the arrays."""
    outcome = run_case(Case("rigid", load_scene("paper-3.1"), histories=True))
    store = Store(tmp_path)

    def die(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    for moment in ("os.replace", "sqlite3.connect"):
        monkeypatch.setattr(moment, die)
        with pytest.raises(KeyboardInterrupt):
            store.add(outcome)
        monkeypatch.undo()
        assert store.get(outcome.key) is None
        assert [path for path in (tmp_path / "histories").iterdir() if path.name.startswith(".part")] == []
    store.add(outcome)
    assert store.get(outcome.key) is not None


def test_a_file_that_is_no_study_is_one_sentence(hoop, tmp_path):
    (tmp_path / "study.sqlite").write_text(
        "not a database, though it has the name of one, and is long enough to tell" * 20
    )
    status, _, err = hoop("study", "sweep", sweep_file(tmp_path), "--out", tmp_path, "--workers", 1, "--json")
    assert status == 2
    assert is_one_sentence(err)
    assert "study.sqlite" in err


def test_a_full_disk_is_one_sentence_and_the_rest_is_kept(tmp_path):
    """A limit on the size of files stands in for the disk: SQLite's file reaches it after some rows."""
    file = sweep_file(tmp_path, k=str([round(0.1 + 0.005 * i, 3) for i in range(60)]))
    out = tmp_path / "out"
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))  # noqa: E731
    own = environment(PYTHONDONTWRITEBYTECODE="1")  # a module's would be cut off too, and break whoever comes next
    done = process("study", "sweep", file, "--out", out, "--workers", 1, "--json", preexec_fn=limit, env=own)
    assert done.returncode == 2
    assert is_one_sentence(done.stderr)
    kept = len(Store(out).done())
    assert 0 < kept < 60
    again = process("study", "sweep", file, "--out", out, "--workers", 1)
    assert again.returncode == 0
    assert len(Store(out).done()) >= 60


def _hears_interrupts() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.slow
@pytest.mark.parametrize("ends", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_keeps_what_was_finished_and_the_same_command_goes_on(tmp_path, ends):
    """And so does what a batch system ends a job with."""
    file, slow = sweep_file(tmp_path), by("third_solver:slow")
    out = tmp_path / "out"
    line = command("study", "sweep", file, "--out", out, "--workers", 2, *slow)
    # tests that were started in the background hand down a Ctrl-C that is ignored
    running = subprocess.Popen(
        line, env=environment(), stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=_hears_interrupts
    )
    wait_for_rows(out, 1)
    os.killpg(running.pid, ends)  # as a terminal does: to the workers too
    _, err = running.communicate(timeout=HANGS)
    assert running.returncode == 130
    announced, interrupted = filter(None, err.splitlines())
    assert "6 cases" in announced
    assert is_one_sentence(interrupted)
    assert 1 <= len(Store(out).done()) < 6
    assert process("study", "sweep", file, "--out", out, "--workers", 1, *slow, env=at_once(file)).returncode == 0
    assert_same_as_undisturbed(file, slow, out, tmp_path)


def assert_same_as_undisturbed(file: Path, solvers: list[str], out: Path, tmp_path: Path) -> None:
    """The table in ``out`` is, to the last bit, that of the same sweep run at once."""
    calm = tmp_path / "undisturbed"
    line = ("study", "sweep", file, "--out", calm, "--workers", 1, *solvers)
    assert process(*line, env=at_once(file)).returncode == 0
    assert written(calm) == written(out)


def at_once(file: Path) -> dict[str, str]:
    """An environment in which no solver of the tests waits, and none dies of what ``file`` stands for."""
    return environment(HOOP_TEST_MARK=str(file), HOOP_TEST_PAUSE="0")


def written(folder: Path) -> list[str]:
    """Lines of a sweep's table but for the key, the last column, which changes with the sources of a checkout."""
    return [line.rpartition(",")[0] for line in (folder / "table.csv").read_text().splitlines()]


def test_a_number_of_thousands_of_digits_is_no_toml(tmp_path):
    """Python refuses to read it, by another error than that of a wrong line."""
    with pytest.raises(SceneError, match="is not TOML"):
        load_sweep(sweep_file(tmp_path, k="1" * 5000))


@pytest.mark.slow
def test_kill_9_loses_no_finished_case_and_leaves_no_worker_behind(tmp_path):
    file, slow = sweep_file(tmp_path), by("third_solver:slow")
    file.write_text(file.read_text() + "histories = true\n")
    out = tmp_path / "out"
    line = command("study", "sweep", file, "--out", out, "--workers", 2, *slow)
    running = subprocess.Popen(line, env=environment(), start_new_session=True)
    wait_for_rows(out, 2)
    running.kill()
    running.wait(timeout=HANGS)
    deadline = time.monotonic() + HANGS
    while alive(running.pid):
        assert time.monotonic() < deadline, "a worker outlived the sweep"
        time.sleep(0.1)
    kept = Store(out).done()
    assert len(kept) >= 2
    for key in kept:
        found = Store(out).get(key)
        assert found is not None
        assert len(found.histories) == len(found.pulses)
    assert process("study", "sweep", file, "--out", out, "--workers", 1, *slow, env=at_once(file)).returncode == 0
    assert kept <= Store(out).done()
    assert_same_as_undisturbed(file, slow, out, tmp_path)


def alive(group: int) -> bool:
    """Whether any process of the group still runs (a dead one that nobody has waited for does not count)."""
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = entry.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[2]) == group and fields[0] != "Z":
            return True
    return False


def test_two_runs_in_one_folder_agree(tmp_path):
    file, solvers = sweep_file(tmp_path), by("rigid", THIRD)
    out = tmp_path / "out"
    line = command("study", "sweep", file, "--out", out, "--workers", 1, "--json", *solvers)
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    both = [subprocess.Popen(line, env=environment(), **quiet) for _ in range(2)]
    for running in both:
        _, err = running.communicate(timeout=HANGS)
        assert (running.returncode, err) == (0, "")
    with sqlite3.connect(out / "study.sqlite") as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert len(Store(out).done()) >= 12
    assert_same_as_undisturbed(file, solvers, out, tmp_path)


def test_a_case_that_kills_its_worker_takes_no_other_with_it(tmp_path):
    sweep = load_sweep(sweep_file(tmp_path), ["third_solver:deadly"])
    with pool(2) as place:
        table = run_sweep(sweep, place)
    reasons = {row.values["hoop.k"]: row.outcome.failure for row in table.rows}
    assert "died" in reasons.pop(0.3)
    assert set(reasons.values()) == {""}


def test_an_unreachable_scheduler_is_one_sentence(hoop, tmp_path):
    pytest.importorskip("distributed")
    for address in ("nonsense", "carrier-pigeon://loft", "carrier-pigeon://loft:8786"):
        line = ("study", "sweep", sweep_file(tmp_path), "--out", tmp_path / "out", "--json", "--scheduler", address)
        status, _, err = hoop(*line)
        assert status == 2
        assert is_one_sentence(err)
        assert address in err


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_gives_the_same_table(tmp_path, monkeypatch):
    """A real cluster of two worker processes; the first that gets k = 0.3 is killed under it."""
    distributed = pytest.importorskip("distributed")
    mark = tmp_path / "died"
    monkeypatch.setenv("HOOP_TEST_MARK", str(mark))
    for name, value in environment().items():
        monkeypatch.setenv(name, value)
    file, solvers = sweep_file(tmp_path), by("third_solver:deadly_once")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=tmp_path
    )
    with cluster:
        line = ("study", "sweep", file, "--out", tmp_path / "out", "--scheduler", cluster.scheduler_address, *solvers)
        done = process(*line, env=environment(HOOP_TEST_MARK=str(mark)))
    assert done.returncode == 0, done.stderr
    assert mark.exists()
    assert_same_as_undisturbed(file, solvers, tmp_path / "out", tmp_path)


def test_nothing_that_can_be_run_is_said_at_once():
    with pytest.raises(SceneError, match=r"hoop\.k"):
        sweep_from_dict({"sweep": {"scene": "paper-3.1"}, "hoop": {"k": [1.5, 2.0]}})
    with pytest.raises((StudyError, SceneError), match="nobody"):
        sweep_from_dict({"sweep": {"scene": "paper-3.1", "solvers": ["nobody"]}})


def of_lists(count: int, keys: int) -> dict[str, object]:
    """A sweep file's data with so many values of each of so many keys."""
    names = ["mass_ratio", "r", "R", "m", "g"][: keys - 1]
    lists = {name: [1.01 + 0.01 * i for i in range(count)] for name in names}
    return {"sweep": {"scene": "paper-3.1"}, "hoop": {"k": [0.1 + 0.001 * i for i in range(count)], "g": 9.81} | lists}


def test_a_product_too_large_is_refused_before_it_is_made():
    """113 values of each of five keys, twice: 3.7e10 scenes would be made for hours, and fill any memory."""
    with pytest.raises(SceneError, match=r"36848703586 cases.*more than 100000"):
        sweep_from_dict(of_lists(113, 5))
    assert sweep_from_dict(of_lists(7, 5), max_cases=2 * 7**5).cases == 2 * 7**5
    with pytest.raises(SceneError, match="--max-cases"):
        sweep_from_dict(of_lists(7, 5), max_cases=2 * 7**5 - 1)


def test_in_a_program_values_come_as_a_range_or_a_column_too():
    base = {"sweep": {"scene": "paper-3.1"}}
    degrees = [list(sweep_from_dict(base | {"release": {"phi0_deg": each}}).points) for each in (
        [10, 20, 30], range(10, 40, 10), pd.Series([10, 20, 30]))]  # fmt: skip
    assert degrees[0] == degrees[1] == degrees[2]


@pytest.mark.parametrize("kind", [tuple, np.array])
def test_in_a_program_values_come_as_an_array_too(kind):
    lists = {"sweep": {"scene": "paper-3.1"}, "hoop": {"k": [0.1, 0.2, 0.3]}, "friction": {"mu": [0.1, 0.2]}}
    arrays = lists | {"hoop": {"k": kind([0.1, 0.2, 0.3])}, "friction": {"mu": kind([0.1, 0.2])}}
    assert list(sweep_from_dict(arrays).points) == list(sweep_from_dict(lists).points)
    with pytest.raises(SceneError, match=r"hoop\.k = \[\] is not possible"):
        sweep_from_dict({"sweep": {"scene": "paper-3.1"}, "hoop": {"k": kind([])}})
    with pytest.raises(SceneError, match=r"hoop\.k = \[0\.1, 0\.2\] is not possible"):
        sweep_from_dict({"sweep": {"scene": "paper-3.1"}, "hoop": {"k": kind([[0.1, 0.2]])}})
    with pytest.raises(SceneError, match=r"hoop\.k is a list of lists"):
        sweep_from_dict({"sweep": {"scene": "paper-3.1"}, "hoop": {"k": kind([[0.1, 0.2]])}})


def test_the_bound_is_an_option_and_nothing_is_left_of_a_refused_sweep(hoop, tmp_path):
    line = ("study", "sweep", sweep_file(tmp_path), "--workers", 1, "--out", tmp_path / "out", "--max-cases")
    status, out, err = hoop(*line, 5)
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert not (tmp_path / "out").exists()
    status, _, err = hoop(*line, 6)
    assert (status, err) == (0, f"hoop: 6 cases: 6 of hoop.k × 1 solver, into {tmp_path / 'out'}.\n")
    assert f"{MAX_CASES} by default" in " ".join(hoop("study", "sweep", "-h")[1].split())


def test_what_a_long_sweep_takes_is_told_from_its_first_cases(tmp_path):
    """240 cases of 10 s on two workers: the first 24 tell of the other 216, 18 minutes; the dearest two compiled."""
    outcome = run_case(Case("rigid", load_scene("paper-3.1")))
    store = Store(tmp_path)
    estimate = Estimate(240, 2, store)
    said = []
    for number in range(240):
        now = dataclasses.replace(outcome, key=f"{number:032}", seconds=60.0 if number < 2 else 10.0)
        store.add(now)
        said.append(estimate.after(now))
    assert [number for number, sentence in enumerate(said) if sentence is not None] == [23]
    assert "the other 216 take some 18 minutes and" in said[23]
    size = float(re.search(r"and ([\d.]+) kB", said[23])[1])
    assert size == pytest.approx(store.size() / 1e3, rel=0.3)  # SQLite's file grows by pages of 4 kB


def test_what_a_part_of_the_work_takes_is_said_of_that():
    """A map of two rolls of 80 s, whose thresholds are closed in on behind it."""
    estimate = Estimate(2, 1, None, " of the map")
    outcome = run_case(Case("rigid", load_scene("paper-3.1")))
    assert "the other 1 of the map take some 80 seconds" in estimate.after(dataclasses.replace(outcome, seconds=80.0))


@pytest.mark.parametrize("workers", [1, 2])
def test_a_solver_that_leaves_is_a_failed_case(tmp_path, workers):
    with pool(workers) as place:
        table = run_sweep(load_sweep(sweep_file(tmp_path), ["third_solver:leaving"]), place)
    reasons = {row.values["hoop.k"]: row.outcome.failure for row in table.rows}
    assert reasons.pop(0.3) == "SystemExit: enough of it"
    assert set(reasons.values()) == {""}


def rewritten(row: str) -> Callable[[Path], None]:
    """Damage to a row of the table."""

    def damage(folder: Path) -> None:
        with sqlite3.connect(folder / "study.sqlite") as connection:
            (key,) = connection.execute("SELECT key FROM cases ORDER BY key").fetchone()
            connection.execute(f"UPDATE cases SET {row} WHERE key = ?", (key,))
        connection.close()

    return damage


def overwritten(content: bytes | None) -> Callable[[Path], None]:
    """Damage to a file of arrays; None removes it."""

    def damage(folder: Path) -> None:
        file = sorted((folder / "histories").iterdir())[0]
        file.unlink()
        if content is not None:
            file.write_bytes(content)

    return damage


DAMAGE = {
    "no JSON": rewritten("outcome = '{'"),
    "no text": rewritten("outcome = x'00ff'"),
    "no UTF-8": rewritten("outcome = cast(x'7bff' as text)"),
    "a digit": rewritten("""outcome = replace(outcome, '"impulse_ratio": 0.1', '"impulse_ratio": 0.2')"""),
    "no histories": rewritten("histories = '[]'"),
    "no checksum": rewritten("checksum = ''"),
    "arrays missing": overwritten(None),
    "arrays empty": overwritten(b""),
    "arrays random": overwritten(np.random.default_rng(1).bytes(5000)),
}


@pytest.mark.parametrize("how", DAMAGE)
def test_a_damaged_result_is_run_again_and_that_is_said(hoop, tmp_path, how):
    file = sweep_file(tmp_path, k="[0.1, 0.15, 0.2]")
    file.write_text(file.read_text() + "histories = true\n")
    line = ("study", "sweep", file, "--out", tmp_path / "out", "--workers", 1, "--json")
    first = hoop(*line)
    assert (first[0], first[2]) == (0, "")
    DAMAGE[how](tmp_path / "out")
    assert hoop(*line) == (0, first[1], f"hoop: 1 damaged result in {tmp_path / 'out'}: run again.\n")
    assert hoop(*line) == first


def test_the_folder_of_another_version_is_one_sentence(hoop, tmp_path):
    (tmp_path / "out").mkdir()
    with sqlite3.connect(tmp_path / "out" / "study.sqlite") as connection:
        connection.execute("CREATE TABLE cases (key TEXT PRIMARY KEY, outcome TEXT)")
    connection.close()
    line = ("study", "sweep", sweep_file(tmp_path), "--out", tmp_path / "out", "--workers", 1, "--json")
    status, out, err = hoop(*line)
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert "another version" in err


def test_parts_of_files_that_dead_processes_left_are_removed(tmp_path):
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    histories = tmp_path / "histories"
    histories.mkdir()
    host = whole.host()
    dead, alive = (histories / f".part-{host}-{process}-abc_d.npz" for process in (gone.pid, os.getpid()))
    old, young = (histories / f".part-else-where-{process}-abc.npz" for process in (1, 2))
    for part in (dead, alive, old, young):
        part.touch()
    os.utime(old, (0, 0))
    Store(tmp_path)
    assert {path.name for path in histories.iterdir()} == {alive.name, young.name}


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_workers_of_other_sources_end_the_sweep(workers):
    case = Case("rigid", load_scene("paper-3.1"), build="0.0+of-another-checkout")
    with pool(workers) as place, pytest.raises(StudyError, match="of-another-checkout: they must agree"):
        run_cases([case], place)


def test_a_solver_that_was_edited_is_another_case(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    module = tmp_path / "edited_solver.py"
    keys = []
    for text in ("def solve(): pass\n", "def solve(): return 1\n"):
        module.write_text(text)
        build.cache_clear()
        keys.append(Case("edited_solver:solve", load_scene("paper-3.1")).key)
    assert keys[0] != keys[1]


def test_workers_that_hang_or_die_are_ended_and_replaced():
    processes = Processes(2)
    hanging = processes.submit(time.sleep, 1000)
    dying = processes.submit(os._exit, 3)
    assert processes.submit(abs, -2).result(timeout=HANGS) == 2
    with pytest.raises(WorkerDied):
        dying.result(timeout=HANGS)
    with pytest.raises(ZeroDivisionError):
        processes.submit(divmod, 1, 0).result(timeout=HANGS)
    with pytest.raises((AttributeError, pickle.PicklingError), match=r"local object .*lambda"):  # by Python's version
        processes.submit(lambda: 0).result(timeout=HANGS)
    assert processes.submit(abs, -3).result(timeout=HANGS) == 3
    processes.stop()
    assert hanging.exception(timeout=0) is not None


def test_a_worker_that_cannot_be_started_is_said_to_be_none(monkeypatch):
    """As where no more processes are allowed, or the current folder is gone."""

    def refused(worker):
        raise OSError(errno.EAGAIN, "resource temporarily unavailable")

    monkeypatch.setattr(SpawnProcess, "start", refused)
    processes = Processes(1)
    with pytest.raises(WorkerDied, match="could not be started: resource temporarily unavailable"):
        processes.submit(abs, -2).result(timeout=HANGS)
    processes.stop()
