"""Finite, sane and near its neighbours at any stiffness: foundation 1e6...1e14, bending stiffness 1e1...1e8."""

import dataclasses

import numpy as np
import pytest
from scenes import HOOP

import flexible
import rigid
from rigid.elastic import LAWS

SCENE = HOOP.replace(solve={"rtol": 3e-3})


def sound(motion):
    """Finite everywhere; nothing gained but the integrator's error; energies that cannot be negative are not."""
    pulse, ledger = motion.pulses[0], motion.ledger
    numbers = [v for v in dataclasses.asdict(pulse).values() if isinstance(v, float)]
    assert np.isfinite(numbers).all()
    assert np.isfinite(dataclasses.astuple(ledger)).all()
    assert "could not" not in motion.ended
    assert "no step" not in motion.ended
    assert ledger.ring_strain >= 0
    assert ledger.contact_spring >= 0
    assert ledger.friction_loss > -1e-6 * ledger.initial
    # rtol is 3e-3; every term is an integral of its own
    assert abs(ledger.numerical_loss) < 6e-3 * ledger.initial
    assert abs(ledger.residual) < 3e-3 * ledger.initial
    return pulse


@pytest.mark.parametrize("mass", [0.0, 0.1])
@pytest.mark.parametrize("foundation", [1e6, 1e10, 1e14])
def test_any_foundation(foundation, mass):
    """On a ring near rigid the normal impulse is that of the rigid pulse within the way of the patch, and 1 %."""
    scene = SCENE.replace(contact={"stiffness": foundation}, hoop={"mass_ratio": mass}, ring={"bending_stiffness": 1e6})
    pulse = sound(flexible.simulate(scene))
    exact = rigid.simulate(scene).pulses[0].normal_impulse
    reach = (1.5 * pulse.peak_normal_force / foundation) ** (1 / 3)
    assert pulse.normal_impulse == pytest.approx(exact, rel=3 * reach + 0.01)


@pytest.mark.parametrize("damping", [0.0, 1.0])
@pytest.mark.parametrize("bending", [1e2, 1e5, 1e8])
def test_any_bending_stiffness(bending, damping):
    """The linear ring, whatever it is worth when soft."""
    scene = SCENE.replace(ring={"bending_stiffness": bending}, contact={"stiffness": 1e9, "damping": damping})
    pulse = sound(flexible.simulate(scene))
    assert pulse.normal_impulse > 1


@pytest.mark.slow
@pytest.mark.parametrize("mass", [0.0, 0.1])
def test_smooth_in_the_foundation(mass):
    """J_N at decades from 1e6 to 1e14: steps from one to the next that do not grow toward the stiff end."""
    impulses = []
    for foundation in 10.0 ** np.arange(6, 15):
        scene = SCENE.replace(
            contact={"stiffness": foundation},
            hoop={"mass_ratio": mass},
            ring={"bending_stiffness": 1e5},
            solve={"rtol": 1e-3},
        )
        impulses.append(sound(flexible.simulate(scene)).normal_impulse)
    steps = np.abs(np.diff(impulses))
    assert steps[3:].max() < 0.02 * impulses[-1]
    assert steps[-3:].max() < 0.005 * impulses[-1]


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
def test_any_bending_stiffness_in_decades(law):
    """1e1 to 1e8 for every law of friction."""
    for bending in 10.0 ** np.arange(1, 9):
        scene = SCENE.replace(ring={"bending_stiffness": bending}, contact={"law": law, "stiffness": 1e9})
        sound(flexible.simulate(scene))


@pytest.mark.parametrize("mass", [0.0, 2.0])
def test_a_floor_on_which_no_hoop_stands_is_refused(monkeypatch, mass):
    """A parabola of half-width R bears 2/3 eps_n R^3: a floor that does not bear the weight is told before all work."""
    monkeypatch.setattr("flexible.run.solve.hoop_of", lambda _: pytest.fail("it was built"))
    scene = SCENE.replace(hoop={"mass_ratio": mass})
    for stiffness in (1e-12, 0.1, 0.999 * 1.5 * (1 + mass)):
        with pytest.raises(rigid.SceneError, match=r"contact\.stiffness = .* is not possible here"):
            flexible.simulate(scene.replace(contact={"stiffness": stiffness}))
    flexible.ensure_possible(scene.replace(contact={"stiffness": 1.001 * 1.5 * (1 + mass)}))
