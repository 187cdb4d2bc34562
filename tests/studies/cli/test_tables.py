"""What stands on the screen: whole numbers, their names and their units, on any screen."""

from __future__ import annotations

import re
from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from rigid import Run, load_scene, simulate
from studies import MEASURES, Ladder, run_sweep, stiffness_study, sweep_from_dict
from studies.cli.shared.tables import motion_tables, show, study_tables, sweep_tables
from studies.plots.sheet import Column, Sheet
from studies.running.workers import Here
from studies.stiffness.told.rows import case_cells, limit_rows, rigid_cells
from studies.stiffness.told.sentences import law_sentence, verdict

WIDTHS = (60, 80, 200)
NUMBER = r"-|-?\d+(\.\d+)?(e[-+]\d+)?"


def table_of(out: str) -> dict[str, list[str]]:
    """Cells below each heading, over all tables of a screen; lines of a heading are joined."""
    columns: dict[str, list[str]] = {}
    headings: list[str] = []
    for line in out.splitlines():
        cells = [cell.strip() for cell in re.split("[┃│]", line)[1:-1]]
        if line.startswith("┏"):
            headings = []
        elif line.startswith("┃"):
            joined = zip(headings or [""] * len(cells), cells, strict=True)
            headings = [" ".join(filter(None, pair)) for pair in joined]
        elif line.startswith("│"):
            for heading, cell in zip(headings, cells, strict=True):
                columns.setdefault(heading, []).append(cell)
    return columns


@pytest.fixture
def screen(monkeypatch, capsys):
    """What stands on a screen of some width."""

    def shown(width: int, things) -> str:
        monkeypatch.setenv("COLUMNS", str(width))
        capsys.readouterr()
        show(*things)
        out = capsys.readouterr().out
        assert "…" not in out
        assert max(map(len, out.splitlines())) <= width
        return out

    return shown


@pytest.fixture(scope="module", params=[False, True], ids=["R = m = g = 1", "SI"])
def scene(request):
    scene = load_scene("paper-3.2-k0.25").replace(contact={"stiffness": 1e9})
    return request.param, scene.replace(hoop={"R": 0.3, "m": 2.0, "g": 9.81}) if request.param else scene


@pytest.fixture(scope="module")
def study(scene):
    return stiffness_study(scene[1], Ladder("contact", 1e7, 1e13, 5), solver="third_solver:softened")


@pytest.mark.parametrize("width", WIDTHS)
def test_the_ladder_keeps_every_number(study, scene, screen, width):
    out = screen(width, study_tables(study))
    found = table_of(out)
    assert found["foundation ε_n R²/(mg)"][:5] == ["1e+07", "3.16e+08", "1e+10", "3.16e+11", "1e+13"]
    ratio = [float(cell) for cell in found["J_F/J_N"][:5]]
    assert ratio == sorted(ratio, reverse=True)
    assert all(float(cell) < 1e-3 for cell in found["±"][:5])
    energy, impulse, force, time = ("J", "N s", "N", "s") if scene[0] else ("mgR", "m sqrt(gR)", "mg", "sqrt(R/g)")
    for name in (f"friction loss [{energy}]", f"J_N [{impulse}]", f"peak N [{force}]", f"off the floor [{time}]"):
        assert all(float(cell) >= 0 for cell in found[name][:6])
    assert all(re.fullmatch(r"[\d.e-]+( \*)?", cell) for cell in found["run [s]"])
    # the first table holds the name, the ratio and its uncertainty side by side
    assert re.search(r"│ +1e\+07 │.* \d\.\d{5} │ +[\d.e-]+ │", out)


@pytest.mark.parametrize(("R", "m"), [(0.02, 0.005), (2.0, 50.0)])
def test_in_joules_a_study_says_as_many_digits(R, m):
    """Five of m g R and six of a limit, be that a millijoule or a kilojoule; the sentences have the unit too."""
    scene = load_scene("paper-3.2-k0.25").replace(contact={"law": "brush"}, solve={"rtol": 1e-8})  # off in joules too
    scene = scene.replace(hoop={"R": R, "m": m, "g": 9.81})
    found = stiffness_study(scene, Ladder("contact", 1e7, 1e13, 5), solver="third_solver:softened")
    energy, impulse = m * 9.81 * R, m * sqrt(9.81 * R)
    for rung in found.rungs:
        assert float(case_cells(found, rung)[4]) == pytest.approx(rung.measure("friction_loss"), abs=5e-6 * energy)
    assert float(rigid_cells(found)[4]) == pytest.approx(found.reference.pulses[0]["friction_loss"], abs=5e-6 * energy)
    size = {"J_F/J_N": 1, "friction loss [J]": energy, "J_N [N s]": impulse}
    for row, limit in zip(limit_rows(found), found.limits.values(), strict=True):
        assert float(row[1]) == pytest.approx(limit.value, abs=5e-7 * size[row[0]])
        assert float(row[3]) == pytest.approx(limit.rigid, abs=5e-7 * size[row[0]])
        if row[0].endswith("[J]"):
            assert f"tends to {row[1]} ± {row[2]} J, and the rigid hoop has {row[3]}," in verdict(found)
    loss = re.search(r"friction loss of (\S+) J\.", law_sentence(found))
    assert float(loss[1]) == pytest.approx(found.rigid.pulses[0]["friction_loss"], abs=5e-6 * energy)


@pytest.mark.parametrize("width", WIDTHS)
def test_a_motion_has_units_everywhere(scene, screen, width):
    found = table_of(screen(width, motion_tables(simulate(scene[1].replace(run=Run(turns=4))))))
    time, speed, energy = ("s", "m/s", "J") if scene[0] else ("sqrt(R/g)", "sqrt(gR)", "mgR")
    asked = {f"from t [{time}]", f"to t [{time}]", f"slip velocity [{speed}]", f"energy [{energy}]", "pulse 4"}
    assert asked <= set(found)
    names = " ".join(found["measure"])
    assert all(entry.heading(scene[1]).replace("\n", " ") in names for entry in MEASURES.values())
    assert all(re.fullmatch(NUMBER, cell) for cell in found["pulse 4"])


def test_what_stands_at_a_turn_is_the_motion_there(scene, screen):
    """To the six digits of the screen; phidot is nought in it."""
    motion = simulate(scene[1].replace(run=Run(turns=4)))
    found = table_of(screen(200, motion_tables(motion)))
    time, speed, energy = ("s", "m/s", "J") if scene[0] else ("sqrt(R/g)", "sqrt(gR)", "mgR")
    states = motion.at([turn.t for turn in motion.turns])
    assert len(states.t) == 4
    assert np.abs(states.omega).max() < 1e-6 * np.abs(motion.at(motion.times()).omega).max()
    shown = {f"energy [{energy}]": states.energy, f"slip velocity [{speed}]": states.slip_velocity}
    shown |= {f"t [{time}]": states.t, "phi [deg]": np.degrees(states.phi)}
    for heading, values in shown.items():
        cells = [float(cell) for cell in found[heading]]
        assert cells == pytest.approx(values, rel=1e-5, abs=1e-9), heading


def test_a_phase_begins_where_the_one_before_it_ends(scene, screen):
    """In time and in angle; and none of these ends where it began."""
    found = table_of(screen(200, motion_tables(simulate(scene[1]))))
    time = "s" if scene[0] else "sqrt(R/g)"
    for of, unit in (("t", time), ("phi", "deg")):
        starts, ends = found[f"from {of} [{unit}]"], found[f"to {of} [{unit}]"]
        assert starts[1:] == ends[:-1]
        assert all(start != end for start, end in zip(starts, ends, strict=True))


@pytest.fixture(scope="module")
def sweep():
    """24 scenes of four keys, of which one in three cannot be: mu is more than mu_s."""
    return run_sweep(
        sweep_from_dict(
            {
                "sweep": {"scene": "paper-3.2-k0.25", "solvers": "rigid"},
                "hoop": {"r": [1.0, 1.02], "mass_ratio": [0.0, 0.1]},
                "friction": {"mu": [0.3, 0.2, 0.5]},
                "contact": {"stiffness": [1e8, 1e9]},
                "run": {"until": "pulse"},
            }
        ),
        Here(),
    )


@pytest.mark.parametrize("width", WIDTHS)
def test_a_sweep_over_many_keys_keeps_its_numbers(sweep, screen, width):
    out = screen(width, sweep_tables(sweep))
    found = table_of(out)
    ratios = found["J_F/J_N"]
    assert len(ratios) == 24
    assert sum(cell == "-" for cell in ratios) == 8
    assert all(re.fullmatch(NUMBER, cell) for cell in ratios)
    assert "friction loss [mgR]" in found
    assert found["contact. stiffness"] == ["100000000.0", "1000000000.0"] * 12
    assert "friction.mu = 0.5" in " ".join(out.split())


def test_a_long_sweep_shows_its_first_rows_and_says_that_there_are_more(sweep, screen):
    out = screen(200, sweep_tables(sweep, 5))
    impulses = [f"{record['normal_impulse']:.6g}" for record in sweep.records()]
    assert len(set(impulses)) > 5
    assert table_of(out)["J_N [m sqrt(gR)]"] == [cell.replace("nan", "-") for cell in impulses[:5]]
    assert "the first 5 rows" in out


@pytest.mark.parametrize("times", [1, 2])
def test_ten_reasons_are_told_and_how_many_more_there_are(sweep, screen, times):
    """Of 8 failed cases all, of 16 the first ten; what no hoop can be has not failed, and is told once."""
    none = [row for row in sweep.rows if row.impossible]
    scene = next(row.outcome.scene for row in sweep.rows if not row.impossible)
    lost = [replace(row, outcome=replace(row.outcome, scene=scene)) for row in none] * times
    out = " ".join(screen(200, sweep_tables(replace(sweep, rows=tuple(lost + none + none)))).split())
    assert out.count("rigid at ") == min(8 * times, 10)
    assert out.count("no hoop at ") == 8
    assert re.findall(r"(\S+) more failed", out) == [[], ["6"]][times - 1]


@pytest.mark.parametrize("width", [24, 40, 60, 80, 200])
def test_a_sheet_stacks_what_does_not_fit(width):
    """Any screen that takes the widest column beside the row's name."""
    names = [f"quantity number {i} of a long name" for i in range(3)]
    columns = [Column(f"column {j}", [f"{0.1234 + j:.4f}"] * 3, joined=j % 2 == 1) for j in range(7)]
    blocks = Sheet("title", [Column("name", names, words=True)], columns[::2]).tables(width)
    assert [str(c.header) for table in blocks for c in table.columns[1:]] == [f"column {j}" for j in range(0, 7, 2)]
    assert (len(blocks) == 1) == (width >= 80)
    assert all(str(table.columns[0].header) == "name" for table in blocks)
    pairs = Sheet("title", [Column("name", names, words=True)], columns).tables(width)
    for table in pairs:
        shown = [str(column.header) for column in table.columns]
        assert all(f"column {j}" in shown for j in range(0, 6, 2) if f"column {j + 1}" in shown)
