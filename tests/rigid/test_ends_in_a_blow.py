"""A motion that ends with an impact that turns the hoop: what is behind the blow can be had at its end."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rigid import Kind, Motion, Scene, States, scene_from_dict, simulate


def thrown(number: int, restitution: float = 0.0, turns: int = 1) -> Scene:
    """A hoop that is thrown fast enough to hop before it turns."""
    k, mu, more, phi0, omega0, slip0 = np.random.default_rng(number).uniform(
        [0.1, 0.1, 1.0, -60.0, 1.0, -1.0], [0.5, 0.6, 1.4, 60.0, 3.0, 3.0]
    )
    return scene_from_dict({
        "hoop": {"k": k, "r": 1.05}, "friction": {"mu": mu, "mu_s": more * mu}, "run": {"turns": turns},
        "release": {"phi0_deg": phi0, "omega0": omega0, "slip0": slip0}, "landing": {"restitution": restitution},
    })  # fmt: skip


def ended_in_a_blow(restitution: float) -> list[tuple[int, Motion]]:
    motions = [(number, simulate(thrown(number, restitution))) for number in range(150)]
    return [(number, motion) for number, motion in motions if motion.phases[-1].kind == Kind.IMPACT]


def same(one: States, other: States) -> None:
    for field in dataclasses.fields(States):
        np.testing.assert_allclose(getattr(one, field.name), getattr(other, field.name), rtol=1e-12, atol=1e-12)


def thrown_point_mass(number: int, turns: int = 1) -> Scene:
    mu, more, phi0, omega0, slip0 = np.random.default_rng(number).uniform([0.1, 1, -80, -1, 0.5], [2, 1.4, 80, 1, 4])
    return scene_from_dict({
        "hoop": {"k": 0.0}, "friction": {"mu": mu, "mu_s": more * mu}, "run": {"turns": turns},
        "release": {"phi0_deg": phi0, "omega0": omega0, "slip0": slip0},
    })  # fmt: skip


def test_a_point_mass_that_is_caught_and_turned_rolls_or_skims():
    kinds = set()
    for number in range(400):
        motion = simulate(thrown_point_mass(number))
        if motion.phases[-1].kind == Kind.IMPACT:
            longer = simulate(thrown_point_mass(number, 2))
            for side in ("right", "left"):
                same(motion.at(motion.t_end, side), longer.at(motion.t_end, side))
            kinds.add(longer.phase_at(motion.t_end).kind)
    assert kinds >= {Kind.ROLL, Kind.SKIM}  # and some longer runs that end there as well


@pytest.mark.parametrize("number", range(3))
def test_a_release_in_a_jam_that_turns_the_hoop_has_both_sides(number):
    """The blow is all of the motion."""
    scene = scene_from_dict({
        "hoop": {"k": 0.106}, "friction": {"mu": 1.82, "mu_s": 2.0}, "run": {"turns": 1},
        "release": {"phi0_deg": 130.0 + number, "omega0": 0.28, "slip0": -2.36},
    })  # fmt: skip
    motion, longer = simulate(scene), simulate(scene.replace(run={"turns": 2}))
    assert [phase.kind for phase in motion.phases] == [Kind.IMPACT]
    for side in ("right", "left"):
        same(motion.at(0.0, side), longer.at(0.0, side))
    assert motion.at(0.0, "left").omega == pytest.approx(0.28)
    assert motion.at(0.0).omega < 0


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_behind_the_last_blow_is_what_a_longer_run_goes_on_with(restitution):
    """State, forces and energy; before it what it was in flight."""
    found = ended_in_a_blow(restitution)
    assert len(found) >= 10
    kinds = set()
    for number, motion in found:
        end = motion.t_end
        longer = simulate(thrown(number, restitution, 2))
        same(motion.at(end), longer.at(end))
        same(motion.at(end, "left"), longer.at(end, "left"))
        assert motion.at(end).energy == pytest.approx(motion.turns[-1].energy, rel=1e-12)
        assert motion.at(end).energy < motion.at(end, "left").energy
        assert motion.at(end, "left").normal_force == 0
        kinds.add(longer.phase_at(end).kind)
    assert len(kinds) > 1 if restitution == 0 else Kind.FLIGHT in kinds


def test_the_table_ends_behind_the_blow():
    _, motion = ended_in_a_blow(0.0)[0]
    assert motion.to_dataframe().energy.iloc[-1] == pytest.approx(motion.turns[-1].energy, rel=1e-12)


def test_compiled_and_interpreted_agree():
    """Hundreds of instants at once are compiled."""
    _, motion = ended_in_a_blow(0.0)[0]
    many = motion.at(np.full(100_000, motion.t_end))
    one = motion.at(motion.t_end)
    assert np.ptp(many.normal_force) == 0
    assert many.normal_force[0] == pytest.approx(float(one.normal_force), rel=1e-12)
