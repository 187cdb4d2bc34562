"""Published numbers of Lubarda, J. Mech. Mater. Struct. 4(6), 2009, each at the precision it is printed with.

The paper truncates some last digits instead of rounding them, so "printed precision" is one unit of the last digit.
"""

from __future__ import annotations

import pytest

from rigid import Kind, load_scene, simulate

ROLL, SPIN, SKID = Kind.ROLL, Kind.SPIN, Kind.SKID


@pytest.fixture(scope="module")
def section_3_1():
    return simulate(load_scene("paper-3.1"))


@pytest.fixture(scope="module")
def section_3_2():
    return simulate(load_scene("paper-3.2-k0.25"))


def test_section_3_1_phases(section_3_1):
    assert [phase.kind for phase in section_3_1.phases] == [ROLL, SPIN, ROLL, SKID]
    ends = [phase.phi_end for phase in section_3_1.phases[:3]]
    assert ends == pytest.approx([0.71402, 3.18085, 3.20455], abs=1e-5)
    assert [turn.phi for turn in section_3_1.turns] == pytest.approx([4.54542, 2.49277], abs=1e-5)


def test_section_3_1_times_and_force(section_3_1):
    first = section_3_1.pulses[0]
    assert first.t_start < 5.74 < first.t_end
    assert section_3_1.turns[1].t == pytest.approx(8.84, abs=0.01)
    assert first.peak_normal_force == pytest.approx(318.0, abs=1.0)


def test_section_3_1_second_pulse_slips_forward_throughout(section_3_1):
    second = section_3_1.pulses[1]
    assert section_3_1.phase_at(second.t_start) == section_3_1.phase_at(second.t_end)
    assert section_3_1.phase_at(second.t_start).kind == SKID


def test_section_3_2_quarter_disk(section_3_2):
    assert [phase.kind for phase in section_3_2.phases] == [ROLL, SPIN, ROLL, SKID]
    angles = [phase.phi_end for phase in section_3_2.phases[:3]] + [section_3_2.turns[0].phi]
    assert angles == pytest.approx([0.80625, 3.21545, 3.37076, 4.61783], abs=1e-5)
    assert section_3_2.pulses[0].peak_normal_force == pytest.approx(32.4, abs=0.1)
