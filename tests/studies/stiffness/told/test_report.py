"""Figures and the page: what a browser shows of them."""

from __future__ import annotations

import re
import shutil
import subprocess

import numpy as np
import pytest
from command_line import HANGS
from images import pixels

from rigid import load_scene
from studies.plots import pulse as figures
from studies.plots.style import power_of_ten
from studies.running import history
from studies.running.solvers import solver

SCENE = load_scene("paper-3.3-massless")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
QUIET = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    from studies.cli import hoop as cli

    out = tmp_path_factory.mktemp("study")
    arguments = [
        "study",
        "stiffness",
        "paper-3.3-massless",
        "--solver",
        "third_solver:softened",
        "--workers",
        "1",
    ]
    assert cli.run([*arguments, "--out", str(out)]) == 0
    return out


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here to open the page in")
def test_a_browser_shows_the_figures(folder, tmp_path):
    """The page's own images, decoded by the browser, have a size; and the screenshot holds their ink."""
    page = (folder / "report.html").read_text()
    widths_of_images = "[...document.images].map(i => i.complete ? i.naturalWidth : 0).join(' ')"
    probe = f"<script>onload = () => {{ document.title = {widths_of_images} }}</script></body>"
    (tmp_path / "probe.html").write_text(page.replace("</body>", probe))
    line = [CHROMIUM, *QUIET, f"--user-data-dir={tmp_path / 'profile'}"]
    address = (tmp_path / "probe.html").as_uri()
    dom = subprocess.run(
        [*line, "--virtual-time-budget=5000", "--dump-dom", address],
        capture_output=True,
        text=True,
        timeout=HANGS,
    )
    widths = re.search(r"<title>([\d ]+)</title>", dom.stdout)
    assert widths is not None, dom.stderr[-2000:]
    assert len(widths[1].split()) >= 3
    assert all(int(width) > 600 for width in widths[1].split())

    shot = tmp_path / "page.png"
    subprocess.run(
        [*line, "--window-size=1100,3600", f"--screenshot={shot}", address], capture_output=True, timeout=HANGS
    )
    image = pixels(shot)
    off = 15
    blue = ((image <= [off, 0x72 + off, 0xB2 + off]) & (image >= [0, 0x72 - off, 0xB2 - off])).all(axis=2)
    assert blue.sum() > 100  # the points and the line of the fitted rate
    half = image.shape[0] // 2
    assert (image[:half] < 128).any(axis=2).mean() > 0.003


def test_a_history_is_straight_between_its_times():
    """Between two of its times N and F of the history are straight to 2e-3 of their range."""
    motion = solver("rigid")(SCENE)
    pulse = motion.pulses[0]
    columns = history.through(motion, pulse)
    t = columns["t"]
    assert t[0] == pulse.t_start
    assert t[-1] == pulse.t_end
    middle = 0.5 * (t[1:] + t[:-1])[np.diff(t) > 1e-9]  # not across the jump of F at a change of phase
    true = motion.at(middle)
    for name in ("normal_force", "friction_force"):
        off = np.abs(getattr(true, name) - np.interp(middle, t, columns[name]))
        assert off.max() <= 2e-3 * np.ptp(columns[name])
    assert columns["normal_impulse"][-1] == pytest.approx(pulse.normal_impulse, rel=1e-3)


def test_a_scene_in_si_units_draws_the_same_curves():
    """A hoop of 0.3 m and 2 kg: the same numbers as R = m = g = 1 once divided by R, m and g."""
    curves = []
    for scene in (SCENE, SCENE.replace(hoop={"R": 0.3, "m": 2.0, "g": 9.81})):
        motion = solver("rigid")(scene)
        columns = history.through(motion, motion.pulses[0])
        curves.append((history.dimensionless(columns, scene), motion.pulses[0].friction_loss / scene.energy_unit))
    (one, loss), (other, other_loss) = curves
    assert other_loss == pytest.approx(loss, rel=1e-9)
    for name in ("normal_force", "friction_impulse", "slip_velocity", "energy", "omega"):
        grid = np.linspace(0.0, one["t"][-1] - one["t"][0], 50)
        mine = np.interp(grid, one["t"] - one["t"][0], one[name])
        theirs = np.interp(grid, other["t"] - other["t"][0], other[name])
        assert theirs == pytest.approx(mine, abs=5e-3 * np.ptp(one[name])), name  # as fine as both are drawn


def test_the_energy_ledger_is_drawn_where_there_is_one():
    t = np.linspace(0.0, 1.0, 50)
    columns = {
        "t": t,
        "kinetic": 1 - t,
        "gravity": 1 + 0 * t,
        "friction_loss": t,
        "ring_strain": 1e-3 * np.sin(3 * t) ** 2,
    }
    assert figures.energy(columns) is not None
    assert figures.energy({"t": t, "phi": t}) is None


def test_stiffness_is_written_as_people_write_it():
    assert power_of_ten(1e7) == "$10^{7}$"
    assert power_of_ten(3.16e8) == r"$3.2\cdot 10^{8}$"
