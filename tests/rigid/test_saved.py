"""A motion in a file: the same to the last bit when it comes back, and a sentence for what is no motion."""

from __future__ import annotations

import json
import zipfile

import numpy as np
import pytest

from rigid import (
    Friction,
    Hoop,
    Motion,
    MotionFileError,
    Release,
    Run,
    Scene,
    __version__,
    load_motion,
    load_scene,
    scene_names,
    scene_to_dict,
    simulate,
)
from rigid.output import file as files

CUT = load_scene("paper-3.1").replace(run=Run(t_end=5.72))  # ends within the pulse, whose restitutions are NaN
SMOOTH = Scene(Hoop(0.1), Friction(0, 0), Release(phi0_deg=10), Run(turns=300))


def same(one, two):
    """Phases, turns, pulses, words and every instant between."""
    assert two == one
    t = np.linspace(0, one.t_end, 200)
    for name in ("phi", "omega", "x_C", "normal_force", "friction_force", "energy"):
        assert (getattr(two.at(t), name) == getattr(one.at(t), name)).all()


SCENES = {**{name: load_scene(name) for name in scene_names()}, "smooth": SMOOTH, "cut": CUT}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_motion_comes_back(tmp_path, scene):
    motion = simulate(scene)
    motion.save(tmp_path / "motion")
    again = load_motion(tmp_path / "motion")
    same(motion, again)
    assert len(again.pulses) == len(motion.pulses)
    again.save(tmp_path / "again")
    same(motion, load_motion(str(tmp_path / "again")))


def test_the_file_says_what_it_is(tmp_path):
    motion = simulate("paper-3.1")
    motion.save(tmp_path / "motion.npz")
    with np.load(tmp_path / "motion.npz") as stored:
        header = json.loads(str(stored["header"]))
    assert header["version"] == __version__
    assert header["scene"] == scene_to_dict(motion.scene)
    assert [path.name for path in tmp_path.iterdir()] == ["motion.npz"]


def sentence(path):
    with pytest.raises(MotionFileError) as found:
        load_motion(path)
    said = str(found.value)
    assert said.startswith(str(path))
    assert said.endswith(".")
    assert "\n" not in said
    return said


def test_every_cut_and_every_flipped_byte_is_told_or_does_no_harm(tmp_path):
    """A zip has a checksum for each array: what is read after all is what was written."""
    motion = simulate("paper-3.1")
    good, bad = tmp_path / "good", tmp_path / "bad"
    motion.save(good)
    content = good.read_bytes()
    for length in (0, 1, 10, len(content) // 2, len(content) - 1):
        bad.write_bytes(content[:length])
        sentence(bad)
    told = 0
    for place in np.random.default_rng(0).integers(0, len(content), 120):
        changed = bytearray(content)
        changed[place] ^= 0x55
        bad.write_bytes(bytes(changed))
        try:
            same(motion, load_motion(bad))
        except MotionFileError:
            told += 1
    assert told > 60


def test_other_files_are_told(tmp_path):
    assert "cannot be read" in sentence(tmp_path / "nothing")
    assert "cannot be read" in sentence(tmp_path)
    text, other = tmp_path / "text", tmp_path / "other"
    text.write_text("[hoop]\nk = 0.1\n", "utf-8")
    assert "is not a saved motion" in sentence(text)
    np.savez(other, a=np.arange(3))
    assert "is not a saved motion" in sentence(tmp_path / "other.npz")
    with zipfile.ZipFile(other, "w") as archive:
        archive.writestr("header.npy", b"no array")
    assert "is not a saved motion" in sentence(other)


def test_a_file_of_a_later_version_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "FORMAT", files.FORMAT + 1)
    simulate("paper-3.1").save(tmp_path / "later")
    monkeypatch.undo()
    assert "in a format that" in sentence(tmp_path / "later")


def test_what_cannot_be_written_leaves_what_was_there(tmp_path, monkeypatch):
    path = tmp_path / "motion"
    simulate("paper-3.1").save(path)
    before = path.read_bytes()

    def full(*_, **__):
        raise OSError("no space left")

    monkeypatch.setattr(np, "savez_compressed", full)
    with pytest.raises(OSError, match="no space left"):
        simulate("paper-3.2-k0.25").save(path)
    assert path.read_bytes() == before
    assert [found.name for found in tmp_path.iterdir()] == ["motion"]


def test_a_motion_of_another_solver_says_that_it_cannot(tmp_path):
    found = simulate("paper-3.1")
    foreign = Motion(
        found.scene, found.phases, found.turns, found.pulses, found.ended, lambda t, side: found.at(t, side)
    )
    with pytest.raises(ValueError, match="cannot be saved"):
        foreign.save(tmp_path / "motion")
    assert not list(tmp_path.iterdir())
