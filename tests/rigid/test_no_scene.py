"""What is no scene at all, and numbers that no float holds: one sentence each, whatever the way in."""

import re

import pytest

import rigid
from rigid import Ring, SceneError, load_scene, scene_from_dict, scene_to_dict, simulate_batch

HUGE = 10**400


@pytest.mark.parametrize(
    "make",
    [
        lambda: scene_from_dict(None),
        lambda: scene_from_dict({1: 2}),
        lambda: simulate_batch({1: 2}),
        lambda: load_scene(None),
        lambda: scene_to_dict(None),
        lambda: Ring(weld_half_angle="3"),
        lambda: Ring(weld_half_angle=None),
        lambda: Ring(weld_half_angle=HUGE),
        lambda: load_scene("paper-3.1").replace(ring={"weld_half_angle": HUGE}),
        lambda: scene_from_dict({"release": {"phi0_deg": 10, "phi0": HUGE}}),
        lambda: scene_from_dict({"hoop": {"k": [0.1, 0.2]}}),
    ],
)
def test_it_is_refused_in_one_sentence(make):
    with pytest.raises(SceneError, match=r"\.$") as refused:
        make()
    assert "\n" not in str(refused.value)
    assert len(str(refused.value)) < 250


def test_a_list_of_values_is_sent_to_a_sweep():
    with pytest.raises(SceneError, match="hoop study sweep"):
        scene_from_dict({"hoop": {"k": [0.1, 0.2]}})


def test_a_file_that_is_not_text(tmp_path):
    file = tmp_path / "motion.npz"
    rigid.simulate("paper-3.1").save(file)
    with pytest.raises(SceneError, match=re.escape(str(file))):
        load_scene(file)


def test_a_scene_of_a_batch_is_told_by_its_place():
    with pytest.raises(SceneError, match=r"scene 1 of the batch: release\.phi0_deg"):
        simulate_batch(["paper-3.1", {"hoop": {"k": 0.2}, "friction": {"mu_s": 0.3, "mu": 0.3}}])
