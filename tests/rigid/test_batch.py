"""A batch against the motions of its scenes, one by one: with mass, in SI units, a point mass."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from rigid import Friction, Hoop, Release, Run, Scene, load_scene, simulate, simulate_batch

SCENES = {
    "without mass": load_scene("paper-3.1"),
    "with mass": load_scene("paper-3.3-heavier").replace(hoop={"mass_ratio": 1.5}),
    "thrown, in SI units": Scene(
        Hoop(0.2, 1.1, 0.3, R=0.4, m=0.7, g=9.81), Friction(0.4, 0.3), Release(phi0_deg=60, omega0=2.0, slip0=-0.5)
    ),
    "a point mass": Scene(Hoop(0.0, 1.0), Friction(0.5, 0.4), Release(phi0_deg=120)),
}


PULSE = (
    "t_start", "t_end", "phi_start", "phi_end", "normal_impulse", "friction_impulse", "friction_loss",
    "peak_normal_force", "newton_restitution", "poisson_restitution", "energetic_restitution",
)  # fmt: skip


def test_a_batch_is_its_scenes_one_by_one():
    """Turns and first pulses, in R, m and g, to round-off; compiled or interpreted differ in a last digit or two."""
    batch, told = simulate_batch(list(SCENES.values()), turns=2), set()
    for row, scene in enumerate(SCENES.values()):
        motion = simulate(scene.to_dimensionless().replace(run={"turns": 2}))
        assert batch.turn_count[row] == len(motion.turns)
        assert batch.pulse_count[row] == len(motion.pulses)
        for number, turn in enumerate(motion.turns):
            found = [getattr(batch, f"turn_{name}")[row, number] for name in ("t", "phi", "slip_velocity", "energy")]
            exact = [turn.t, turn.phi, turn.slip_velocity, turn.energy]
            assert found == pytest.approx(exact, rel=1e-11, abs=1e-11)
        for number, pulse in enumerate(motion.pulses[:2]):
            for name in PULSE:
                of_batch = getattr(batch, name.replace("_end", "_stop"))[row, number]
                assert of_batch == pytest.approx(getattr(pulse, name), rel=1e-10, abs=1e-11, nan_ok=True)
                told.add(name) if np.isfinite(of_batch) else None
    assert told == set(PULSE)
    assert np.nanmax(np.abs(batch.newton_restitution - batch.poisson_restitution)) > 1e-3, "they are not one column"


def test_a_batch_has_what_at_least_one_of_these_scenes_has():
    """Else the comparison above would be of nothing."""
    batch = simulate_batch(list(SCENES.values()), turns=2)
    assert (batch.turn_count > 0).any()
    assert np.isfinite(batch.normal_impulse).any(axis=1).sum() >= 3


def test_degrees_given_for_radians_are_questioned_once():
    """A scene in SI units when it is made, not when it is run; of arrays the first that looks so."""
    with pytest.warns(UserWarning, match="did you mean phi0_deg = 45"):
        scene = Scene(Hoop(0.3, R=0.3, m=0.7, g=9.81), Friction(0.3, 0.2), Release(45.0), Run(t_end=0.1))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(scene).at(0.05)
        simulate_batch([scene], t_end=0.1)
        simulate_batch({"k": 0.3, "mu_s": 0.3, "mu": 0.2, "phi0": np.radians([45.0, 370.0])}, t_end=0.1)
    with pytest.warns(UserWarning, match=r"scene 1 of the batch: .* did you mean phi0 = np.radians\(45.0\)") as told:
        simulate_batch({"k": 0.3, "mu_s": 0.3, "mu": 0.2, "phi0": [1.0, 45.0, 60.0]}, t_end=0.1)
    assert [one.filename for one in told] == [__file__]
