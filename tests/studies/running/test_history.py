"""Columns through a pulse."""

from __future__ import annotations

import numpy as np
import pytest

from rigid import Friction, Hoop, Kind, Release, Run, Scene, load_scene, simulate
from studies.plots.difference import impulses_along
from studies.running.history import through

JAM = Scene(Hoop(0.0432, 1.52), Friction(0.538, 0.481), Release(phi0_deg=102.6, omega0=3.85, slip0=-2.41))
PULSES = {
    "a jam": JAM,
    "a jam, in SI units": JAM.replace(hoop={"R": 0.3, "m": 0.7, "g": 9.81}),
    "small": Scene(Hoop(0.001), Friction(0.35, 0.3), Release(phi0_deg=10)),
    "with mass": load_scene("paper-3.3-heavier"),
}


@pytest.mark.parametrize("name", PULSES)
def test_the_impulses_of_a_rigid_pulse_end_where_its_measures_do(name):
    """To the last bit at the end, and to round-off (of a phidot of 1/k) a millionth of a millionth of time before."""
    scene = PULSES[name].replace(run=Run(until="pulse"))
    motion = simulate(scene)
    pulse = motion.pulses[0]
    columns = through(motion, pulse)
    t = columns["t"]
    assert (t[0], t[-1]) == (pulse.t_start, pulse.t_end)
    assert t[-1] - t[-2] < 1e-11
    for force, impulse in (("normal_force", "normal_impulse"), ("friction_force", "friction_impulse")):
        assert columns[impulse][0] == 0
        assert columns[impulse][-1] == getattr(pulse, impulse)
        off = 1e-10 * scene.impulse_unit + np.abs(columns[force][-2:]).max() * (t[-1] - t[-2])
        assert abs(columns[impulse][-2] - columns[impulse][-1]) <= off


def test_the_impulses_of_a_jam_are_on_the_edge_of_the_cone_until_the_slip_stops():
    """It spins from the start of the pulse into the jam: J_F = mu J_N, whatever N; the jam itself takes the rest."""
    motion = simulate(JAM.replace(run=Run(until="pulse")))
    spin, jam = motion.phases[:2]
    assert (spin.kind, jam.kind) == (Kind.SPIN, Kind.IMPACT)
    columns = through(motion, motion.pulses[0])
    before, after = (columns["t"] < jam.t_start), (columns["t"] > jam.t_start)
    normal, friction = columns["normal_impulse"], columns["friction_impulse"]
    assert friction[before] == pytest.approx(JAM.friction.mu * normal[before], abs=1e-12)
    # over the 2e-12 of time between them goes what no bounded force could give
    assert normal[after][0] - normal[before][-1] > 0.1


def test_impulses_are_the_integrals_of_the_forces():
    motion = simulate(load_scene("paper-3.3-massless").replace(run={"until": "pulse"}))
    columns = through(motion, motion.pulses[0])
    normal, friction = impulses_along(motion, motion.pulses[0])
    t = columns["t"]
    for force, fine in (("normal_force", normal), ("friction_force", friction)):
        values = columns[force]
        trapezoids = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t))])
        # straight between the times to 2e-3 of the range
        off = 2e-3 * np.ptp(values) * (t - t[0])
        ours = columns[force.replace("force", "impulse")]
        assert np.all(np.abs(ours - trapezoids) <= off + 1e-12)
        assert ours == pytest.approx(fine[:: (len(fine) - 1) // (len(t) - 1)], abs=1e-12)
