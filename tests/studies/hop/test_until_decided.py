"""Rolls that end where it is decided where the hoop hops: the beginnings of whole ones, with the same answers."""

from __future__ import annotations

import dataclasses

import pytest

from rigid import Run, Scene, load_scene
from studies.hop.rolling.roll import from_rest, roll, roll_until_decided
from studies.hop.rolling.rule import DECADE
from studies.hop.rolling.threshold import hops_in, windows


def scene_of(bending_stiffness: float, turns: int) -> Scene:
    """What is compared are two runs of one scene, so the tolerance may be loose."""
    return from_rest(
        load_scene("paper-3.3-heavier").replace(
            hoop={"k": 0.2}, ring={"bending_stiffness": bending_stiffness}, contact={"law": "brush", "stiffness": 1e7},
            run=Run(turns=turns), solve={"rtol": 3e-3, "elements": 120},
        )
    )  # fmt: skip


@pytest.mark.slow
def test_a_roll_that_has_hopped_ends_early_and_says_what_the_whole_one_says():
    scene = scene_of(6.0, 1)
    early, late = roll_until_decided(scene), roll(scene)
    assert early.completed
    assert (early.whole, late.whole) == (False, True)
    assert early.t_end < late.t_end
    assert early.flights, "it has hopped"
    # the last step and a flight that goes on behind it are the only differences
    over = [flight for flight in early.flights if flight.t + flight.duration < early.t_end]
    told = [dataclasses.replace(flight, energies=None) for flight in over]
    assert told == [dataclasses.replace(flight, energies=None) for flight in late.flights[: len(over)]]
    for where, window in windows(scene).items():
        for least in (1.0, *DECADE):
            decided = hops_in(early.to_dict(), window, least, early.whole)
            assert decided is hops_in(late.to_dict(), window, least), where


def test_a_roll_without_a_hop_goes_on_to_its_end():
    """To the last bit: it is looked at twice on the way, and resumed."""
    scene = scene_of(300.0, 2)
    looked_at, whole = roll_until_decided(scene), roll(scene)
    assert looked_at.whole
    assert looked_at.flights == whole.flights == ()
    assert looked_at.t_end == pytest.approx(scene.run.t_end)
    assert (looked_at.steps, looked_at.swept) == (whole.steps, whole.swept)
