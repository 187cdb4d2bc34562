"""What must hold for any scene: mirror, restart, units, energy, friction's bound, and both machines alike."""

from __future__ import annotations

import pickle
import subprocess
import sys
from itertools import pairwise
from math import radians
from operator import attrgetter

import numpy as np
import pytest
from hypothesis import example, given, settings
from strategies import scenes

from rigid import Friction, Hoop, Kind, Landing, Release, Run, Scene, load_scene, simulate, simulate_batch, solve
from rigid.kernel.compile import Patience


@pytest.mark.parametrize("name", ["paper-3.1", "paper-3.3-light"])
def test_without_friction_nothing_is_lost_to_it(name):
    motion = simulate(load_scene(name).replace(friction={"mu_s": 0, "mu": 0}, run={"turns": 4}))
    assert len(motion.pulses) > 2
    assert [pulse.friction_loss for pulse in motion.pulses] == [0.0] * len(motion.pulses)


#: measures of a pulse, among them those of which one that is cut has none
MEASURED = [*simulate(load_scene("paper-3.1")).pulses[0].to_dict()]
KNOWN = [name for name in MEASURED if "restitution" not in name]


@settings(max_examples=60, deadline=None)
@given(scenes())
@example(Scene(Hoop(0.03125, 2.0, 0.0), Friction(0.5, 0.5), Release(0.0, 1.0, 0.0), Run(turns=2)))
def test_any_scene(scene):
    """Finite, in order, energy never grows, N >= 0, |F| <= mu_s N and the hoop above the floor."""
    motion = simulate(scene)
    assert motion.ended
    for before, after in pairwise(motion.phases):
        assert before.t_start <= before.t_end == after.t_start
    released = max(1.0, float(motion.at(0.0).energy))
    for pulses, names in (motion.pulses, KNOWN), ([pulse for pulse in motion.pulses if not pulse.cut], MEASURED):
        numbers = np.array([attrgetter(*names)(pulse) for pulse in pulses]).reshape(-1, len(names))  # of thousands
        assert np.isfinite(numbers[:, [name != "peak_normal_force" for name in names]]).all()
    # without bound where it jams, and only there
    jams = [phase.t_start for phase in motion.phases if phase.kind is Kind.IMPACT]
    for pulse in motion.pulses:
        assert np.isfinite(pulse.peak_normal_force) or any(pulse.t_start <= t <= pulse.t_end for t in jams)
    # the difference of two energies: round-off of either may show
    assert all(pulse.friction_loss >= -1e-10 * released for pulse in motion.pulses)
    states = motion.at(np.linspace(0, motion.t_end, 40))
    table = np.array([states.phi, states.omega, states.slip_velocity, states.normal_force, states.energy])
    assert np.isfinite(table).all()
    assert np.diff(states.energy).max() <= 1e-10 * max(1.0, states.energy.max())
    assert states.normal_force.min() >= -1e-10 * max(1.0, states.normal_force.max())
    bound = scene.friction.mu_s * states.normal_force
    assert (np.abs(states.friction_force) <= bound * (1 + 1e-9) + 1e-10).all()
    assert states.y_C.min() >= 1 - 1e-10


def test_a_roll_ends_where_it_is_listed():
    """After 463 sqrt(R/g), whose last digit takes the hoop over a millionth of a pulse of k = 1e-8."""
    scene = Scene(
        Hoop(k=1e-8), Friction(3.0, 3.0), Release(2.1197061638129258, 1.5, 0.1796875), Run(until="rest"),
        landing=Landing(1.2e-7),
    )  # fmt: skip
    motion = simulate(scene)
    rolls = [phase for phase in motion.phases if phase.kind == Kind.ROLL]
    assert len(rolls) > 100
    ends = motion.at(np.array([phase.t_end for phase in rolls]), side="left")
    lasting = np.array([phase.t_end > phase.t_start for phase in rolls])  # else that instant is another phase's
    assert (ends.phi[lasting] == np.array([phase.phi_end for phase in rolls])[lasting]).all()
    bound = scene.friction.mu_s * ends.normal_force[lasting]
    assert (np.abs(ends.friction_force[lasting]) <= bound * (1 + 1e-9) + 1e-10).all()


SCENE = Scene(Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(radians(10)), Run(turns=6))


def test_mirrored():
    """phi -> -phi mirrors everything; angles may differ by the round-off of one turn."""
    mirrored = simulate(SCENE.replace(release=Release(-SCENE.release.phi0)))
    motion = simulate(SCENE)
    assert len(motion.turns) == SCENE.run.turns
    assert motion.pulses
    for a, b in zip(motion.turns, mirrored.turns, strict=True):
        assert (a.t, a.phi, a.energy) == pytest.approx((b.t, -b.phi, b.energy), rel=1e-13)
        assert a.slip_velocity == pytest.approx(-b.slip_velocity, abs=1e-13)
    for p, q in zip(motion.pulses, mirrored.pulses, strict=True):
        assert p.impulse_ratio == pytest.approx(-q.impulse_ratio, rel=1e-12)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.7, 0.9])
def test_restarted(share):
    """A motion restarted from any instant goes on as before, up to the conditioning of a pulse (some 1/k)."""
    motion = simulate(SCENE)
    t = share * motion.t_end
    state = motion.at(t)
    later = [turn for turn in motion.turns if turn.t > t]
    release = Release(float(state.phi), float(state.omega), float(state.slip_velocity))
    again = simulate(SCENE.replace(release=release, run={"turns": len(later)}))
    assert [turn.t + t for turn in again.turns] == pytest.approx([turn.t for turn in later], rel=1e-12)
    assert [turn.phi for turn in again.turns] == pytest.approx([turn.phi for turn in later], rel=1e-12)


def test_in_si_units():
    """R, m, g in metres, kilograms: every output scales with its dimension, angles and ratios stay."""
    R, m, g = 0.25, 0.7, 9.81
    plain, si = simulate(SCENE), simulate(SCENE.replace(hoop={"R": R, "m": m, "g": g}))
    time, impulse, energy = (R / g) ** 0.5, m * (g * R) ** 0.5, m * g * R
    assert plain.pulses
    for p, q in zip(plain.pulses, si.pulses, strict=True):
        assert q.t_start == pytest.approx(p.t_start * time, rel=1e-14)
        assert q.normal_impulse == pytest.approx(p.normal_impulse * impulse, rel=1e-13)
        assert q.friction_loss == pytest.approx(p.friction_loss * energy, rel=1e-12)
        assert q.peak_normal_force == pytest.approx(p.peak_normal_force * m * g, rel=1e-13)
        assert q.impulse_ratio == pytest.approx(p.impulse_ratio, rel=1e-12)


def test_energy_ledger():
    """What is lost between two turns is the work of friction, by quadrature over the phases."""
    motion = simulate(SCENE)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    lost = 0.0
    first, last = motion.turns[:2]
    edges = {first.t, last.t} | {p.t_start for p in motion.phases if first.t < p.t_start < last.t}
    for a, b in pairwise(sorted(edges | set(np.linspace(first.t, last.t, 60)))):
        states = motion.at(0.5 * (a + b) + 0.5 * (b - a) * nodes)
        lost -= 0.5 * (b - a) * weights @ (states.friction_force * states.slip_velocity)
    assert lost == pytest.approx(first.energy - last.energy, rel=1e-11)


def test_a_thousand_cycles_without_drift():
    """Rolling for ever: after 2000 turns the angle and the energy are those of the first, the time exact multiples."""
    motion = simulate(load_scene("paper-3.2-k0.75").replace(run={"turns": 2000}))
    half = motion.period / 2
    assert motion.turns[-1].t == pytest.approx(2000 * half, rel=1e-12)
    assert motion.turns[-1].phi == pytest.approx(motion.turns[1].phi, abs=1e-15)


def test_a_smooth_floor_without_drift():
    """Two hundred cycles, each computed anew from the turn that ends the one before: nothing is lost."""
    scene = load_scene("paper-3.4-frictionless").replace(run={"turns": 2})
    first = turn = simulate(scene).turns[1]
    for _ in range(200):
        scene = scene.replace(release=Release(turn.phi, 0.0, turn.slip_velocity))
        turn = simulate(scene).turns[1]
    assert turn.energy == pytest.approx(first.energy, rel=1e-13)
    assert turn.phi == pytest.approx(first.phi, rel=1e-12)


def test_interpreted_and_compiled_agree(monkeypatch):
    """One source, two machines: turns and pulses agree to round-off, batch and single call exactly."""
    monkeypatch.setattr(solve, "patience", Patience(10**9))
    slow = simulate(SCENE)
    monkeypatch.setattr(solve, "patience", Patience(0))
    fast = simulate(SCENE)
    assert [t.t for t in fast.turns] == pytest.approx([t.t for t in slow.turns], rel=1e-13)
    assert [p.friction_impulse for p in fast.pulses] == pytest.approx(
        [p.friction_impulse for p in slow.pulses], rel=1e-11
    )
    batch = simulate_batch([SCENE, SCENE], turns=6)
    assert list(batch.turn_phi[1]) == [t.phi for t in fast.turns]
    assert np.array_equal(batch.friction_impulse[0], [p.friction_impulse for p in fast.pulses[:2]])


def test_a_motion_is_a_plain_value():
    motion = simulate(SCENE)
    copy = pickle.loads(pickle.dumps(motion))
    assert copy == motion
    assert np.array_equal(copy.at([1.0, 2.0]).phi, motion.at([1.0, 2.0]).phi)
    assert motion.at(np.ones((2, 3))).energy.shape == (2, 3)
    with pytest.raises(ValueError, match="the motion goes from 0 to"):
        motion.at(-1.0)


def test_a_cold_call_imports_nothing_heavy():
    code = (
        "import sys, rigid; rigid.simulate(rigid.load_scene('paper-3.1'));"
        "heavy = {'numba', 'scipy', 'skfem', 'matplotlib', 'pyvista', 'meshio', 'pandas'};"
        "sys.exit(len(heavy & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
