"""What stands on the screen: whole numbers, their names and their units, on any screen."""

from __future__ import annotations

import re

import pytest
from command_line import SCENE

from studies.plots.sheet import Column, Sheet
from studies.running.measures import MEASURES

THIRD = ("--solver", "third_solver:softened", "--workers", 1)
WIDTHS = (60, 80, 200)
SI = SCENE.format(k=0.25).replace("r = 1.02", "r = 1.02\nR = 0.3\nm = 2.0\ng = 9.81")


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


def fits(out: str, width: int) -> None:
    assert "…" not in out
    assert max(map(len, out.splitlines())) <= width


@pytest.mark.parametrize("width", WIDTHS)
def test_the_ladder_keeps_every_number(hoop, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", str(width))
    _, out, _ = hoop("study", "stiffness", "paper-3.3-massless", *THIRD, "--count", 5)
    fits(out, width)
    found = table_of(out)
    assert found["foundation εR²/(mg)"][:5] == ["1e+07", "3.16e+08", "1e+10", "3.16e+11", "1e+13"]
    ratio = [float(cell) for cell in found["J_F/J_N"][:5]]
    assert ratio == sorted(ratio, reverse=True)
    assert all(float(cell) < 1e-3 for cell in found["±"][:5])
    for heading in ("friction loss [mgR]", "J_N [m sqrt(gR)]", "peak N [mg]", "off the floor [sqrt(R/g)]", "run [s]"):
        assert all(float(cell) >= 0 for cell in found[heading][:6])
    # the first screen holds the name, the ratio and its uncertainty side by side
    assert re.search(r"│ +1e\+07 │.* 0\.\d{5} │ +[\d.e-]+ │", out)


@pytest.mark.parametrize("width", WIDTHS)
def test_the_ladder_in_si_units(hoop, monkeypatch, tmp_path, width):
    monkeypatch.setenv("COLUMNS", str(width))
    (tmp_path / "si.toml").write_text(SI)
    _, out, _ = hoop("study", "stiffness", tmp_path / "si.toml", *THIRD, "--count", 5)
    fits(out, width)
    assert {"friction loss [J]", "J_N [N s]", "peak N [N]", "off the floor [s]"} <= set(table_of(out))


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("si", [False, True])
def test_a_motion_has_units_everywhere(hoop, monkeypatch, tmp_path, width, si):
    monkeypatch.setenv("COLUMNS", str(width))
    (tmp_path / "scene.toml").write_text((SI if si else SCENE.format(k=0.25)).replace('until = "pulse"', "turns = 4"))
    _, out, _ = hoop("rigid", tmp_path / "scene.toml")
    fits(out, width)
    found = table_of(out)
    time, speed, energy = ("s", "m/s", "J") if si else ("sqrt(R/g)", "sqrt(gR)", "mgR")
    asked = {f"from t [{time}]", f"to t [{time}]", f"slip velocity [{speed}]", f"energy [{energy}]", "pulse 4"}
    assert asked <= set(found)
    names = " ".join(found["measure"])
    for entry in MEASURES.values():
        assert entry.symbol in names
    assert all(cell == "-" or float(cell) is not None for cell in found["pulse 4"])


@pytest.mark.parametrize("width", WIDTHS)
def test_a_sweep_over_many_keys_keeps_its_numbers(hoop, monkeypatch, tmp_path, width):
    monkeypatch.setenv("COLUMNS", str(width))
    text = SCENE.format(k="[0.1, 0.25]").replace("r = 1.02", "r = [1.0, 1.02]\nmass_ratio = [0.0, 0.1]")
    text = text.replace("mu = 0.3", "mu = [0.3, 0.2, 0.5]")
    (tmp_path / "many.toml").write_text(text + "[contact]\nstiffness = [1e8, 1e9]\n[sweep]\nsolvers = 'rigid'\n")
    status, out, _ = hoop("study", "sweep", tmp_path / "many.toml", "--workers", 1)
    assert status == 1  # mu = 0.5 is more than mu_s
    fits(re.sub(r"The table is in .*", "", out, flags=re.DOTALL), width)
    found = table_of(out)
    ratios = found["J_F/J_N"]
    assert len(ratios) == 40
    assert sum(cell != "-" for cell in ratios) == 27  # of every three rows one cannot be
    assert all(re.fullmatch(r"-|-?\d+(\.\d+)?(e[-+]\d+)?", cell) for cell in ratios)
    assert "friction loss [mgR]" in found
    assert len(found["hoop. k"]) == 40
    assert "friction.mu = 0.5" in " ".join(out.split())


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
