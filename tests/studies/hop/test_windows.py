"""Where a lift-off counts, of disks that are large beside their hoop, and of releases near the bottom."""

from __future__ import annotations

from math import degrees, radians

import numpy as np
import pytest

from rigid import load_scene
from studies import hop_study
from studies.cli.hop import map_of
from studies.hop.rolling.limit import rigid_motion
from studies.hop.rolling.roll import from_rest
from studies.hop.rolling.threshold import windows
from studies.running.case import Outcome

SCENE = "paper-3.4-slippery"


def scene_of(k: float, phi0_deg: float):
    return from_rest(load_scene(SCENE).replace(hoop={"k": k}, release={"phi0": radians(phi0_deg)}))


@pytest.mark.parametrize(("k", "phi0_deg"), [(0.3, 10), (0.3, 120), (0.47, 10), (0.6, 10), (0.6, 110), (0.8, 80)])
def test_the_bottom_is_where_the_disk_presses_over_the_contact(k, phi0_deg):
    """At every angle of it, by the rigid motion itself, N exceeds the weight and the disk, k to either side of its
    centre, is over the point that touches; at its ends to the last digits of the instants at which the pulse begins
    and is over.
    """
    scene = scene_of(k, phi0_deg)
    motion, window = rigid_motion(scene), windows(scene)["bottom"]
    pulse = motion.pulses[0]
    at = motion.at(np.linspace(pulse.t_start, pulse.t_end, 2001))
    swept = np.abs(at.phi - scene.release.phi0)
    inside = (window.low <= swept) & (swept <= window.high)
    assert inside.sum() > 500
    assert window.low > 0
    assert np.all(at.normal_force[inside] > (1 + scene.hoop.mass_ratio) * (1 - 1e-6))
    assert np.all(np.abs((1 - k) * np.sin(at.phi[inside])) <= k + 1e-6)
    ends = np.abs(np.array([pulse.phi_start, pulse.phi_end]) - scene.release.phi0)
    assert ends[0] <= window.low < window.high <= ends[1]


@pytest.mark.parametrize("k", [0.5, 0.6, 0.8])
def test_a_disk_of_half_the_hoop_is_over_the_contact_throughout_its_pulse(k):
    """N exceeds the weight only where the disk hangs below the hoop's centre, where one that reaches past it, 2k >= 1,
    covers all of the floor that the hoop can touch.
    """
    found = windows(scene_of(k, 10))
    assert found["bottom"] == found["pulse"]


@pytest.mark.parametrize(("k", "early", "late"), [(0.3, 150, 265), (0.6, 150, 265), (0.8, 150, 265), (0.6, 150, 250)])
def test_what_has_passed_its_pulse_is_decided_of_the_bottom_too(monkeypatch, k, early, late):
    """Rolls by construction: below 5 they hop in the pulse, below 50 behind it, and none stops early. So all brackets
    close, on one threshold in the pulse and at the bottom, and two bisections of a decade leave 10^(1/4).
    """
    lifts = {early: 5.0, late: 50.0}

    def rolls(cases, *_, **__):
        return [outcome(case.scene) for case in cases]

    def outcome(scene):
        motion = rigid_motion(scene)
        swept = float(np.abs(motion.at(np.linspace(0, scene.run.t_end, 500)).phi - scene.release.phi0).max())
        flights = [
            {"t": 1.0, "phi": 1.0, "duration": 1.0, "height": 0.1, "prominence": 9.0, "swept": radians(at)}
            for at, stiffest in lifts.items()
            if scene.ring.bending_stiffness < stiffest and at < degrees(swept)
        ]
        told = {"flights": flights, "completed": True, "swept": swept, "scales": None, "t_end": scene.run.t_end}
        return Outcome("", "", {}, "", motion=told)

    monkeypatch.setattr("studies.hop.study.run_cases", rolls)
    over = ("ring.bending_stiffness=1:1000:4", f"hoop.k={k}")
    (line,) = hop_study(map_of(load_scene(SCENE), over, bisections=2)).lines
    for where in ("pulse", "bottom"):
        found = line.threshold(where)
        assert (found.low < 5.0 < found.high, found.open) == (True, 0), where
        assert found.high / found.low == pytest.approx(10**0.25)
        assert line.holds(where)
