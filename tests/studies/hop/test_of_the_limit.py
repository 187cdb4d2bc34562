"""What a hop study has of the rigid hoop is of the one to which the flexible one tends."""

from __future__ import annotations

import pytest

import rigid
from flexible import rigid_limit
from rigid import Scene
from studies import HopMap, hop_study
from studies.hop.rolling.drop import drop
from studies.hop.rolling.roll import from_rest, through_the_pulse
from studies.hop.rolling.scaling import duration, relief
from studies.hop.rolling.threshold import windows


def wide(law: str) -> Scene:
    """A static coefficient that is far above the other."""
    scene = rigid.load_scene("paper-3.3-heavier")
    return scene.replace(friction={"mu_s": 0.5, "mu": 0.3}, contact={"law": law}, run={"turns": 2})


@pytest.mark.parametrize("law", ["brush", "regularised"])
def test_times_windows_and_forces_are_of_the_limit(law):
    """A brush breaks away from its rear, and smoothed friction has no static coefficient."""
    scene = wide(law)
    limit = rigid_limit(scene)
    assert limit.friction.mu_s < 0.4
    assert from_rest(scene).run.t_end == rigid.simulate(limit).t_end
    limit = limit.replace(contact={"law": "patch"})
    assert through_the_pulse(from_rest(scene)).run == through_the_pulse(from_rest(limit)).run
    for of in (windows, drop, duration, relief):
        assert of(scene) == of(limit)
        assert of(scene) != of(scene.replace(contact={"law": "patch"}))


@pytest.mark.slow
def test_progress_never_goes_back_and_comes_to_its_end():
    """Rolls that are not decided behind the pulse are rolled on, in the same part of it."""
    for bisections in (0, 1):
        told: list[float] = []
        scene = rigid.load_scene("paper-3.3-heavier").replace(run={"turns": 1})
        asked = HopMap(scene, (30.0, 3e5), None, (None,), rtol=1e-2, bisections=bisections)
        hop_study(asked, progress=told.append)
        assert told == sorted(told)
        assert told[-1] == pytest.approx(1)
