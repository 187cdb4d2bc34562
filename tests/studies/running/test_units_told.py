"""A motion says what each number in it, and each column of its history, is measured in."""

from __future__ import annotations

from math import isnan

import pytest

import flexible
import rigid
from rigid import load_scene
from studies.running import history

SCENE = load_scene("paper-3.3-light").replace(solve={"rtol": 1e-2}, run=rigid.Run(turns=1))
HEAVY = SCENE.replace(hoop={"R": 0.5, "m": 2.0, "g": 9.81})
SIZES = {"s": (0.5 / 9.81) ** 0.5, "N": 2 * 9.81, "J": 2 * 9.81 * 0.5, "m": 0.5}
SIZES |= {"m/s": SIZES["m"] / SIZES["s"], "N s": SIZES["N"] * SIZES["s"], "1/s": 1 / SIZES["s"], "1": 1.0}
SIZES |= {"1/s²": 1 / SIZES["s"] ** 2}


def numbers_of(told) -> dict[str, list[float]]:
    """Numbers of a motion's dictionary by the name of their field, in their order."""
    found: dict[str, list[float]] = {}
    for name in ("phases", "turns", "pulses"):
        for item in told[name]:
            for key, value in item.items():
                if isinstance(value, float):
                    found.setdefault(key, []).append(value)
    for key, value in told.get("energy_ledger", {}).items():
        found.setdefault(key, []).append(value)
    return found


@pytest.mark.parametrize("simulate", [rigid.simulate, flexible.simulate])
def test_each_number_is_in_the_unit_that_is_told(simulate):
    """The same hoop in the paper's scaling and in SI differs by that unit's size, number for number."""
    plain, heavy = simulate(SCENE), simulate(HEAVY)
    units = heavy.units
    one, other = numbers_of(plain.to_dict()), numbers_of(heavy.to_dict())
    assert set(one) == set(other) <= set(units)
    assert {"t", "energy", "t_start", "friction_loss", "normal_impulse", "peak_normal_force"} <= set(one)
    for name, values in one.items():
        size = SIZES[units[name]]
        for value, si in zip(values, other[name], strict=True):
            # what is a small difference of energies has the round-off of these, which are of the order of m g R
            assert (isnan(value) and isnan(si)) or si / size == pytest.approx(value, rel=1e-6, abs=1e-9), name


@pytest.mark.parametrize("simulate", [rigid.simulate, flexible.simulate])
def test_every_column_of_a_history_has_its_unit(simulate):
    motion = simulate(SCENE)
    units = motion.units
    assert set(history.whole(motion)) <= set(units)
    assert (units["t"], units["normal_force"], units["phi"]) == ("sqrt(R/g)", "mg", "1")
