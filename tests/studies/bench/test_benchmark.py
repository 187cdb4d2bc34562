"""The benchmark: its references are independent and regenerable, its rows say what the README quotes."""

from __future__ import annotations

import json
import os

import numpy as np
import pytest
from command_line import is_one_sentence

from studies.bench import race as racing
from studies.bench import skipped
from studies.bench.peers import scipy_ivp as peers
from studies.bench.race import Claim, Contestant, exponent, race
from studies.bench.rigid import scene_of, worst
from studies.bench.truth import precision, precision_values, reference


@pytest.mark.parametrize("k", precision.DISKS)
def test_the_closed_form_has_the_digits_of_the_reference(k):
    """Turns within 1e-13, and the pulses' impulses and losses within 1e-12: three decades below what is asked."""
    from rigid import simulate

    motion = simulate(scene_of(k))
    assert worst(k, [(t.t, t.phi, t.slip_velocity, t.energy) for t in motion.turns]) < 1e-13
    for pulse, exact in zip(motion.pulses, precision_values.PULSES[k], strict=True):
        found = (pulse.normal_impulse, pulse.friction_impulse, pulse.friction_loss)
        assert found == pytest.approx([float(number) for number in exact], rel=1e-12)


def test_the_reference_holds_twenty_digits_and_more():
    for table in (precision_values.TURNS, precision_values.PULSES):
        for rows in table.values():
            assert all(len(number.strip("-0.").replace(".", "")) >= 20 for row in rows for number in row)


@pytest.mark.slow
@pytest.mark.parametrize("k", precision.DISKS)
def test_the_reference_is_found_again(k, monkeypatch):
    """With ten digits and twelve terms more, the stored ones come out the same."""
    mpmath = pytest.importorskip("mpmath")
    monkeypatch.setattr(precision, "DIGITS", 50)
    monkeypatch.setattr(precision, "ORDER", 60)
    trace = precision.integrate(k)
    for rows, exact in ((trace.turns, precision_values.TURNS[k]), (trace.pulses, precision_values.PULSES[k])):
        assert [[mpmath.nstr(number, 25) for number in row] for row in rows] == [list(row) for row in exact]


def test_the_peer_converges_to_the_reference():
    """scipy at rtol 1e-12 is right to 1e-11 at k = 0.1: the comparison is of the same problem."""
    turns = peers.scipy_turns(0.1, precision.MU_S, precision.MU, precision.PHI0, 2, "DOP853", 1e-12)
    assert worst(0.1, turns) < 1e-11


@pytest.mark.slow
def test_all_nodes_are_found_again():
    """One entry of the flexible reference, to the digits that another processor leaves."""
    key = (240, 1, 1e-4, 24)
    again = reference.run_all_nodes(*key)
    error, peak = reference.errors(again, reference.ALL_NODES[key])
    assert error < 1e-4
    assert peak < 1e-3


def test_the_limit_takes_off_what_steps_points_and_mesh_leave(monkeypatch):
    """Runs whose errors have the orders that are assumed, and a mesh that the finest alone does not feel."""
    true = np.array([2.0, -0.005, 0.01, 30.0])

    def run(around: int, through: int, rtol: float, points: int) -> reference.Measured:
        off = 0.3 * rtol / 1e-5 + 0.2 * (48 / points) ** 2 + 0.1 * (around < 720)
        return reference.Measured(*(true * (1 + off)))

    monkeypatch.setattr(reference, "ALL_NODES", {key: run(*key) for key in reference.ALL_NODES})
    np.testing.assert_allclose(reference._row(reference.limit()), true, rtol=1e-12)  # round-off


def test_the_limit_lies_near_the_peers():
    """J_N 2.149 ± .003, J_F/J_N -.0029 ± .0003, loss .0113 ± .0004 of three other codes (R0 = 1).

    J_F is what is left of friction to the right and to the left: it is held to what the three know J_N by, 0.0014 of
    J_N, and not to what they happen to differ by in it, which it misses by 0.0001 J_N.
    """
    true, R = reference.limit(), reference.R
    assert true.normal_impulse * R**0.5 == pytest.approx(2.149, abs=0.003)
    assert true.friction_impulse / true.normal_impulse == pytest.approx(-0.0029, abs=0.003 / 2.149)
    assert true.friction_loss * R == pytest.approx(0.0113, abs=0.0004)


def test_a_race_times_everyone_and_tells_who_failed():
    def stumble() -> None:
        raise ValueError("no such thing")

    fine, fell = race([Contestant("a", "", "", lambda: 1.0, lambda x: x), Contestant("b", "", "", stumble)], repeats=3)
    assert (len(fine.seconds), fine.error, fell.seconds) == (3, 1.0, [])
    assert fell.note == "no such thing"
    assert exponent([1, 10, 100], [2, 200, 20000]) == pytest.approx(2)


def test_a_time_is_that_of_one_call(monkeypatch):
    """By a clock that goes on by half a second at every call."""
    now = [0.0]
    monkeypatch.setattr(racing, "_clock", lambda entry: lambda: now[0])

    def run() -> None:
        now[0] += 0.5

    once, eight = race([Contestant(str(n), "", "", run, calls=n, memory=False) for n in (1, 8)], repeats=2)
    assert once.seconds == eight.seconds == [0.5, 0.5]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_peak_memory_is_in_MB():
    """Of eight million numbers 64, beside a process that holds nothing: a quarter is left to what else it holds."""
    runs = (lambda: 0.0, lambda: np.ones(8_000_000).sum())
    nothing, numbers = race([Contestant("", "", "", run) for run in runs], repeats=1)
    assert numbers.peak_memory - nothing.peak_memory == pytest.approx(64, abs=16)


def test_a_claim_holds_or_does_not():
    assert Claim("", 120, 100).holds
    assert not Claim("", 80, 100).holds
    assert not Claim("", 3, 2, at_most=True).holds
    assert Claim("", float("nan"), 100, why_not="not installed").holds


def test_what_a_plain_installation_lacks_is_not_imported(monkeypatch):
    """pyvista comes with an extra; the benchmark ended with a traceback behind all its work."""
    asked = []
    monkeypatch.setattr(skipped, "installed", lambda name: name not in ("pyvista", "scipy"))
    monkeypatch.setattr(skipped, "wall_of", lambda command: asked.append(" ".join(command)) or 1.0)
    assert len(skipped.cold_starts(1)) == 4
    assert any("skfem" in command for command in asked)
    assert not any("pyvista" in command or "scipy" in command for command in asked)


@pytest.mark.slow
def test_bench_rigid_as_json_with_its_figure(hoop, tmp_path):
    status, out, err = hoop("bench", "rigid", "--quick", "--json", "--out", tmp_path)
    assert (status, err) == (0, "")
    found = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} is not JSON"))
    assert {"solver", "setting", "seconds_median", "seconds_min", "error", "peak_memory"} <= set(found["rows"][0])
    assert all({"measured", "stated", "holds"} <= set(claim) for claim in found["ratios"].values())
    # of what is measured here, load changes all but the errors
    error = next(claim for name, claim in found["ratios"].items() if "error" in name)
    assert error["holds"]
    ours = [row["error"] for row in found["rows"] if row["solver"] == "hoop-pulse"]
    assert max(ours) < 1e-13  # as in the test of the closed form
    assert (tmp_path / "bench-rigid.png").stat().st_size > 10_000


def test_check_ends_with_one_when_a_ratio_does_not_hold(hoop, monkeypatch):
    from studies.bench import rigid as bench_rigid
    from studies.bench.race import Result

    monkeypatch.setattr("studies.machine.kernels.prepare", max)  # nothing is raced, so that nothing need be compiled
    monkeypatch.setattr(bench_rigid, "bench", lambda *_: Result(claims=[Claim("faster", 80, 100)]))
    status, _, err = hoop("bench", "rigid", "--check")
    assert status == 1
    assert is_one_sentence(err)
    assert hoop("bench", "rigid")[0] == 0


@pytest.mark.parametrize("what", ["mesh", "knobs", "soft", "scaling"])
def test_peers_are_refused_where_there_are_none(hoop, what):
    """And not left out without a word."""
    status, out, err = hoop("bench", what, "--peers")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
