"""Other programs on the rigid pulse: what they are given and what is read off them; those that are installed, run."""

from __future__ import annotations

import json

import numpy as np
import pytest

from rigid import Run, load_scene, simulate
from studies.bench.peers import approach, mujoco_roll
from studies.bench.peers.rigid_pulse import States, impulse_ratio, start_of
from studies.limit.prediction import predict

SCENE = load_scene("paper-3.3-massless")
ONE = SCENE.replace(friction={"mu_s": SCENE.friction.mu})  # of most programs the only coefficient


@pytest.mark.parametrize("scene", [SCENE, ONE, load_scene("paper-3.2-k0.25"), load_scene("paper-3.3-light")])
def test_the_rigid_motion_gives_its_own_impulses(scene):
    """From the states alone, by momentum; lines between 20 000 steps are off by far less than 1e-6."""
    start = start_of(scene)
    motion = simulate(scene.replace(run=Run(until="pulse")))
    pulse = motion.pulses[0]
    now = motion.at(np.linspace(pulse.t_start - 0.1 * (pulse.t_end - pulse.t_start), pulse.t_end, 20_001))
    time, speed, unit = (getattr(scene, f"{name}_unit") for name in ("time", "velocity", "time"))
    states = States(now.t / time, now.phi, now.omega * unit, now.slip_velocity / speed + now.omega * unit, 0 * now.t)
    # the last step may end a rounding before the edge
    states = states._replace(phi=np.append(states.phi[:-1], states.phi[-1] + 1e-12))
    assert impulse_ratio(start, states) == pytest.approx(pulse.impulse_ratio, rel=1e-6)


def test_a_program_that_does_not_come_through_has_no_ratio():
    start = start_of(SCENE)
    still = np.zeros(5)
    assert np.isnan(impulse_ratio(start, States(still, still, still, still, still)))


@pytest.mark.parametrize("program", ["mujoco", "exudyn"])
def test_one_coefficient_tends_to_the_rigid_hoop_with_that(program):
    """Their error is of first order in the step (MuJoCo) or the slip velocity (Exudyn): a fourth and a tenth at least,
    less what the steps themselves leave."""
    pytest.importorskip(program)
    task = next(t for t in approach.tasks() if t.package == program and not t.static)
    start = start_of(ONE)
    limit = simulate(ONE.replace(run=Run(until="pulse"))).pulses[0].impulse_ratio
    off = [
        abs(impulse_ratio(start, task.run(start, setting)) - limit) for setting in (task.settings[0], task.settings[-1])
    ]
    assert off[1] < 0.1 * off[0]


def test_a_static_coefficient_over_a_slip_velocity_tends_to_the_paper():
    """Exudyn alone has one: it comes nearer to the paper's pulse than to that of mu_s = mu, and ever nearer."""
    pytest.importorskip("exudyn")
    task = next(t for t in approach.tasks() if t.static)
    start = start_of(SCENE)
    paper, one = (simulate(s.replace(run=Run(until="pulse"))).pulses[0].impulse_ratio for s in (SCENE, ONE))
    first, last = (impulse_ratio(start, task.run(start, v)) for v in (task.settings[0], task.settings[-1]))
    assert abs(last - paper) < abs(first - paper) < 0.05 * abs(one - paper)


@pytest.mark.slow
def test_drake_regularises_as_predicted():
    """The leading power of v_s; the next is smaller by v_s^(1/5), which is 0.25 at 1e-3."""
    pytest.importorskip("pydrake")
    task = next(t for t in approach.tasks() if t.known)
    start = start_of(ONE)
    term = predict(ONE.replace(contact={"law": "regularised"}), 1.0).terms["impulse_ratio"]
    for setting in task.settings[:2]:
        off = impulse_ratio(start, task.run(start, setting)) - term.limit
        assert off == pytest.approx(float(term.at(setting)) - term.limit, rel=setting**0.2)


@pytest.mark.slow
def test_what_is_not_installed_says_so(hoop, monkeypatch):
    monkeypatch.setattr(approach, "installed", lambda name: False)
    status, out, _ = hoop("study", "limit", "paper-3.3-massless", "--peers", "--json")
    assert status == 0
    rows = json.loads(out)["peers"]
    assert {row["program"] for row in rows} >= {"MuJoCo", "Drake SAP", "Exudyn ConvexRoll", "ipctk"}
    assert all("not installed" in row["note"] and not row["ratios"] for row in rows)
    assert tuple(rows[0]["settings"]) == mujoco_roll.STEPS
