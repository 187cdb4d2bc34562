"""The closing table of `hoop paper`: every number holds, or the reason why it does not is known and stated."""

from __future__ import annotations

import csv
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console
from scipy.optimize import brentq

from rigid import load_scene, simulate
from studies.paper import closing, reproduce, screen
from studies.paper.figures import FIGURES
from studies.paper.numbers import numbers, spike_width


@pytest.fixture(scope="module")
def verdicts():
    return closing()


def test_every_printed_number(verdicts):
    """All but five hold to their last printed digit (rounded or cut off); those five say why."""
    failing = [verdict for verdict in verdicts if verdict.agrees is False]
    assert all(verdict.why for verdict in failing)
    assert sorted({verdict.place[:3] for verdict in failing}) == ["2.2", "2.4", "3.4"]
    assert len(failing) == 5


#: as printed, by section; (9) in sec. 2.2, and no closed form
PRINTED = {
    "2.2": [0.045],
    "2.4": [0.04, 8.24, 0.0064, 0.2048, 0.0016, 0.0128, 0.1],
    "3.1": [0.71402, 3.18085, 3.20455, 4.54542, 2.49277, 5.74, 8.84, 318],
    "3.2": [0.80625, 3.21545, 3.37076, 4.61783, 32.4, 3.52, 1.3, 2.94, 0.5385],
    "3.3": [4.04, 5.425, 5.04],
    "3.4": [1.38862, 1.80266, 0.78],
}


def test_the_papers_numbers_are_those_that_it_prints():
    """Each to one unit of its last digit, or less."""
    found = {section: [] for section in PRINTED}
    for number in numbers():
        if number.place != "2.3":
            found[number.place[:3]].append(number.paper)
            assert number.unit <= 1.0001 * 10.0 ** -len(f"{number.paper:g}".partition(".")[2]), number.quantity
    assert found == PRINTED


@pytest.mark.parametrize("way", [1, -1])
def test_a_number_off_by_two_units_does_not_agree(way):
    for number in numbers():
        assert replace(number, ours=number.paper + 2 * way * number.unit).verdict.agrees is False
        assert replace(number, ours=number.paper + 0.99 * way * number.unit).verdict.agrees is True
        assert replace(number, ours=number.paper + 2 * way * number.unit).verdict.difference * way > 0


def test_our_own_values_where_the_paper_fails():
    """k = 1e-5: near 1.3892 and 1.8025 by an independent derivation; (9) gives 0.0742."""
    ours = {number.paper: number.ours for number in numbers()}
    assert abs(ours[1.38862] - 1.3892) < 5e-5
    assert abs(ours[1.80266] - 1.8025) < 5e-5
    assert abs(ours[0.045] - 0.0742) < 5e-5


def test_the_width_of_a_spike_is_where_its_flanks_are_at_half_its_height():
    """By bisection on both sides; a thousandth of the part that is sampled is left open at each."""
    motion = simulate(load_scene("paper-3.2-k0.75").replace(hoop={"k": 0.05}, friction={"mu_s": 50.0, "mu": 50.0}))
    pulse = motion.pulses[0]
    ends = brentq_half(motion, pulse)
    assert spike_width(motion) == pytest.approx(ends[1] - ends[0], rel=2e-3)


def brentq_half(motion, pulse):
    """Where N is half its peak on either side, by bisection."""
    t = np.linspace(pulse.t_start, pulse.t_end, 100_001)
    top = t[np.argmax(motion.at(t).normal_force)]

    def above(time):
        return float(motion.at(time).normal_force) - 0.5 * pulse.peak_normal_force

    return brentq(above, pulse.t_start, top), brentq(above, top, pulse.t_end)


def test_every_figure_is_in_the_table(verdicts):
    places = " ".join(verdict.place for verdict in verdicts) + " "
    for figure in FIGURES:
        assert f"fig. {figure.number} " in places


def test_the_table_fits_a_plain_screen(verdicts):
    """80 columns, and no cell cut off: every number and every word of the table is there whole."""
    console = Console(width=80, highlight=False)
    with console.capture() as capture:
        for thing in screen(verdicts):
            console.print(thing)
    text = capture.get()
    assert max(len(line) for line in text.splitlines()) <= 80
    assert "…" not in text
    for verdict in verdicts:
        assert verdict.paper in text
        assert all(word in text for word in f"{verdict.what} {verdict.ours}".split())


@pytest.mark.slow
def test_all_figures_and_the_table_are_written(tmp_path, verdicts):
    seen = []
    assert reproduce(tmp_path, ["png"], lambda done, total, what: seen.append((done, total))) == verdicts
    assert seen[-1] == (13, 13)
    names = [f"figure-{number:02d}" for number in range(2, 13)] + ["extra-inception", "extra-energy"]
    assert sorted(path.name for path in tmp_path.glob("*.png")) == sorted(f"{name}.png" for name in names)
    assert not list(tmp_path.glob("*.svg"))
    points = {path.name for path in tmp_path.glob("*.csv")} - {"table.csv"}
    assert points == {f"{name}-{side}.csv" for name in names for side in ("left", "right")}
    with (tmp_path / "table.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["ours"] for row in rows] == [verdict.ours for verdict in verdicts]
    assert "figure-12" in (tmp_path / "table.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_command_ends_with_the_table(hoop, tmp_path):
    status, out, _ = hoop("paper", "--out", tmp_path, "--format", "svg")
    assert status == 0
    assert "1.38862" in out
    assert "picks its modes" in " ".join(out.split())
    svg = (tmp_path / "figure-10.svg").read_text(encoding="utf-8")
    assert svg.lstrip().startswith("<?xml")
    assert not list(tmp_path.glob("*.png"))
    assert hoop("paper", "--out", tmp_path, "--format", "pdf")[0] == 2
