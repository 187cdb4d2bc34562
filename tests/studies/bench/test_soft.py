"""`hoop bench soft`: who is compared with whom, and a coarse ring through all of it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from flexible.models.select import hoop_of
from studies.bench import soft


def pulse(**measures: float) -> SimpleNamespace:
    """A motion of which a first pulse is all that is known."""
    known = {
        "impulse_ratio": 0.1, "normal_impulse": 2.0, "peak_normal_force": 50.0, "friction_loss": 0.3,
        "time_off_floor": 0.0,
    }  # fmt: skip
    return SimpleNamespace(pulses=[SimpleNamespace(**{**known, **measures})], steps=100)


def test_a_chain_is_judged_by_all_nodes_of_its_own_pulse():
    """Relative differences, those of N_max and of the time off the floor apart; none counts as LEAST_SCALE."""
    truth = soft.Truth()
    truth.judge("one", True, pulse())
    truth.judge("other", True, pulse(normal_impulse=1.0))
    error, more = truth.judge("one", False, pulse(normal_impulse=2.02, peak_normal_force=55.0, time_off_floor=0.004))
    assert error == pytest.approx(0.01)
    assert more["N_max off"] == pytest.approx(0.1)
    assert more["off floor off"] == pytest.approx(0.004 / soft.LEAST_SCALE)


def test_without_all_nodes_nothing_is_claimed():
    """A contestant that failed leaves no row to hold another to."""
    chain = soft.Row(soft.CHAIN, f"rtol {soft.USUAL:.0e}", "E I = 10, undamped", [1.0], more={"steps": 10.0})
    names = [claim.name for claim in soft._claims([chain], soft.softs(quick=True))]
    assert not any("off all nodes" in name for name in names)


@pytest.mark.slow
def test_the_chain_of_a_coarse_ring_is_its_mesh(monkeypatch):
    """Through the whole benchmark, on 80 elements: they stand on one mesh, so its coarseness does not part them.

    Damped, E I = 10, a wall of 3.5 %, which is no line to them: impulses, loss and hops to 1 % as is
    stated of 240 elements, the largest force to 2 %, of which steps at rtol 3e-4 leave one in either.
    """
    scene = soft.softs(quick=True)[0].scene.replace(hoop={"r": 1.035}, contact={"damping": 1.0, "stiffness": 1e6})
    coarse = soft.Soft("coarse", scene, around=80, through=1, off=soft.CLOSE, peak_off=0.02)
    monkeypatch.setattr(soft, "softs", lambda quick: [coarse])
    result = soft.bench(quick=True)
    assert all(row.note == "" for row in result.rows)
    stated = {claim.name: claim for claim in result.claims}
    assert stated["coarse: impulses and loss off all nodes"].holds
    assert stated["coarse: time off the floor"].holds
    assert stated["coarse: N_max off all nodes"].holds
    rows = {(row.solver, row.setting): row for row in result.rows}
    # one method at one tolerance on one motion: as many steps, of an eighth of the coordinates (117 of 950)
    chain, nodes = (rows[name, "rtol 3e-04"].more["steps"] for name in (soft.CHAIN, soft.NODES))
    assert chain == pytest.approx(nodes, rel=0.1)
    few, many = (hoop_of(coarse.on(level, soft.USUAL)).coordinates for level in ("chain", "exact"))
    assert 8 * few < many
