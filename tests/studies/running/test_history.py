"""Columns through a pulse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexible
from rigid import Contact, Friction, Hoop, Kind, Release, Ring, Run, Scene, Solve, load_scene, simulate
from studies import MEASURES, measures
from studies.plots.difference import impulses_along
from studies.running.history import accumulated, dimensionless, through

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


@pytest.fixture(scope="module")
def damped():
    """Two pulses of a hoop on a floor that takes energy, and the same in units that are powers of two."""
    scene = Scene(
        Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(phi0_deg=10), Run(turns=2), ring=Ring(bending_stiffness=1e3),
        contact=Contact(stiffness=1e6, damping=0.5), solve=Solve(rtol=1e-2, level="reduced"),
    )  # fmt: skip
    return [
        flexible.simulate(one, history=True) for one in (scene, scene.replace(hoop={"R": 4.0, "m": 2.0, "g": 16.0}))
    ]


def test_what_a_pulse_takes_is_what_is_taken_along_it(damped):
    """Whatever the pulse before it took; and its largest energies are the largest along it."""
    motion = damped[0]
    assert len(motion.pulses) == 2
    for pulse in motion.pulses:
        columns, told = through(motion, pulse), measures(motion, pulse)
        for name in motion.history.TOTALS:
            assert columns[name][0] == 0
            # running sums of some hundred steps
            assert columns[name][-1] == pytest.approx(told[name], rel=1e-12, abs=1e-14), name
        for name, energy in (("ring_energy_peak", "ring_strain"), ("contact_energy_peak", "contact_spring")):
            assert told[name] == pytest.approx(columns[energy].max(), rel=1e-12), name


def test_every_measure_and_every_column_has_the_unit_it_says(damped):
    """Powers of two leave every digit as it is."""
    one, other = damped
    scene = other.scene
    for own, same in zip(one.pulses, other.pulses, strict=True):
        here, there = measures(one, own), measures(other, same)
        expected = {name: here[name] * entry.unit.of(scene) for name, entry in MEASURES.items()}
        assert there == pytest.approx(expected, rel=1e-12, abs=1e-300)
        columns, scaled = through(one, own), dimensionless(through(other, same), scene)
        for name, values in columns.items():
            np.testing.assert_allclose(scaled[name], values, rtol=1e-12, atol=1e-14, err_msg=name)


def test_a_pulse_that_begins_at_a_step_has_it_once(damped):
    motion, pulse = damped[0], damped[0].pulses[1]
    times, records = np.unique(motion.history.t, return_counts=True)
    inside = times[(records == 1) & (times > pulse.t_start) & (times < pulse.t_end)]
    assert len(inside) > 5
    for start in inside:
        t = through(motion, replace(pulse, t_start=float(start)))["t"]
        assert np.count_nonzero(t == start) == 1
        assert t[0] == start


def test_what_is_accumulated_of_a_straight_line_is_its_parabola():
    """Whatever the times; of none, nothing."""
    t = np.array([1.0, 1.5, 1.5, 4.0])
    assert accumulated(t, 3 - 2 * t) == pytest.approx(3 * (t - 1) - (t**2 - 1), rel=1e-14)
    assert accumulated(t[:0], t[:0]).size == 0
