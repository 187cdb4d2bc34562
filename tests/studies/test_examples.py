"""Every example runs, writes its picture, and prints what the README of its package says of that case."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import matplotlib
import matplotlib.image
import pytest

from meshes.draw.display import renderer_problem
from studies.examples import (
    batch_map,
    hop_by_rule,
    own_friction_law,
    pulse,
    rigid_motion,
    slip_weakening,
    stiffness_study,
)

matplotlib.use("Agg")


def drawn(png: Path) -> bool:
    """Whether there is more than one colour in a picture, over more than a line of it."""
    pixels = matplotlib.image.imread(png)[..., :3]
    return bool(pixels.std(axis=(0, 1)).max() > 0.02)


def test_rigid_motion(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert drawn(rigid_motion.main(tmp_path))
    assert "phi = 4.54542" in capsys.readouterr().out  # section 3.1 of the paper, phi_4


def test_batch_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert drawn(batch_map.main(tmp_path, side=8))
    largest = float(re.findall(r"[\d.]+", capsys.readouterr().out)[-1])
    assert largest <= 7 / 6  # |F| <= mu_s N throughout, so that |J_F| <= mu_s J_N


def test_pulse(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert drawn(pulse.main(tmp_path))
    flexible, rigid = (float(ratio) for ratio in re.findall(r"J_F/J_N = ([\d.]+)", capsys.readouterr().out))
    assert abs(rigid - flexible) < 0.02 * rigid  # the patch's half-width at a foundation of 1e8 is 0.025 R at peak N


@pytest.mark.slow
def test_stiffness_study(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert drawn(stiffness_study.main(tmp_path))
    value, uncertainty, rigid = (float(x) for x in re.findall(r"\d\.\d+(?:e-\d+)?", capsys.readouterr().out))
    assert abs(value - rigid) <= uncertainty


@pytest.mark.slow
@pytest.mark.skipif(renderer_problem() is not None, reason="nothing to draw with")
def test_fields_in_pyvista(tmp_path: Path) -> None:
    from studies.examples import fields_in_pyvista  # VTK would be in every process of the tests

    assert drawn(fields_in_pyvista.main(tmp_path, frames=4))


@pytest.mark.slow
def test_slip_weakening(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert drawn(slip_weakening.main(tmp_path, foundations=(1e7, 1e8)))
    limits = [float(line.split()[-1]) for line in capsys.readouterr().out.splitlines()]
    assert limits == sorted(limits, reverse=True)  # of brush, longer and longer distances, patch, mu_s throughout


def test_hop_by_rule(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert drawn(hop_by_rule.main(tmp_path, count=2))
    falls, thresholds = capsys.readouterr().out.split("k, m_h/m: ")
    # as studies/README.md has them, the jump of N where slip begins, over k and over mu
    for written in ("k = 0.1, mu = 0.3: 9.7", "k = 0.25, mu = 0.3: 2.15", "mu = 0.1: 2.22"):
        assert written in falls
    rows = [[float(each) for each in line.split(": ")[1].split()] for line in thresholds.splitlines()[1:]]
    assert all(a > b for row in rows for a, b in pairwise(row))  # damping lowers every threshold
    undamped = [row[0] for row in rows[2:]]
    assert all(a > b for a, b in pairwise(undamped))  # and so does a heavier hoop


@pytest.mark.slow
def test_own_friction_law(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert drawn(own_friction_law.main(tmp_path))
    printed = capfd.readouterr().out
    ratio, limit = map(float, re.findall(r"^tanh .*?([\d.]+);.*?([\d.]+)$", printed, re.MULTILINE)[0])
    paper = float(re.findall(r"^patch .*?([\d.]+)$", printed, re.MULTILINE)[0])
    # a smooth law has no static coefficient: it comes to the hoop with mu_s = mu, and not to the paper's
    assert abs(ratio - limit) < abs(ratio - paper)
