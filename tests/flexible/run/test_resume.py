"""A motion cut anywhere and taken up again is the undisturbed one, to the last bit."""

from __future__ import annotations

import dataclasses
import pickle
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scenes import HOOP

import rigid
from flexible import FlexibleMotion, load_motion, simulate, write_fields
from flexible.ring.choice import forget_rings
from meshes import SeriesError
from rigid import Scene

SCENES = {
    "pulses": HOOP.replace(run={"turns": 2}, contact={"damping": 1.0}),
    "throughout": HOOP.replace(
        run={"turns": 1}, ring={"bending_stiffness": 100.0}, contact={"stiffness": 1e7, "damping": 1.0},
        solve={"resolve": "all", "rtol": 3e-3},
    ),
    "brush": HOOP.replace(contact={"law": "brush", "damping": 1.0, "stiffness": 1e7}),
    "exact": HOOP.replace(
        hoop={"mass_ratio": 0.0}, ring={"bending_stiffness": 300.0}, contact={"stiffness": 1e5, "damping": 1.0},
        solve={"level": "exact", "rtol": 1e-2, "elements": 48},
    ),
    "chain": HOOP.replace(
        ring={"bending_stiffness": 30.0}, contact={"stiffness": 1e6, "damping": 1.0},
        solve={"level": "chain", "rtol": 1e-2},
    ),
}  # fmt: skip
WHOLE: dict[str, FlexibleMotion] = {}


def whole(name: str) -> FlexibleMotion:
    if name not in WHOLE:
        WHOLE[name] = simulate(SCENES[name], history=True)
    return WHOLE[name]


def told(motion: FlexibleMotion) -> dict[str, Any]:
    return {**motion.to_dict(), "scene": None}


def assert_same(one: FlexibleMotion, other: FlexibleMotion) -> None:
    """Bit for bit: lists, ledger, every step and every state of the ring; NaN is NaN."""
    assert repr(told(one)) == repr(told(other))
    assert one.history is not None
    assert other.history is not None
    for field in dataclasses.fields(one.history):
        np.testing.assert_array_equal(getattr(one.history, field.name), getattr(other.history, field.name), field.name)
    for mine, others in zip(one.kept, other.kept, strict=True):
        for a, b in zip(mine.states, others.states, strict=True):
            np.testing.assert_array_equal(a.pos, b.pos)
            np.testing.assert_array_equal(a.u, b.u)
            assert a.res == b.res


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("share", [0.03, 0.5, 0.9])
def test_a_run_that_was_stopped_by_its_steps(name: str, share: float) -> None:
    most = max(int(share * whole(name).steps), 1)
    part = simulate(SCENES[name], history=True, most_steps=most)
    assert not part.completed
    assert_same(simulate(SCENES[name], history=True, resume=part), whole(name))


@pytest.mark.parametrize("name", ["pulses", "throughout"])
@pytest.mark.parametrize("share", [0.2, 0.55, 0.8])
def test_a_run_that_came_to_its_time(name: str, share: float) -> None:
    """The step that its end made shorter is taken again."""
    early: Scene = SCENES[name].replace(run={"t_end": share * whole(name).t_end})
    part = simulate(early, history=True)
    assert part.completed
    assert_same(simulate(SCENES[name], history=True, resume=part), whole(name))


@pytest.mark.parametrize("behind", [1e-9, 1e-3])
def test_a_run_that_came_to_its_time_just_behind_a_turn(behind: float) -> None:
    """The end of the run cuts the step in which the turn is found, and with it the length at which it is found first.

    The swing up to the turn was taken as it was, other by its last bits.
    """
    scene = HOOP.replace(
        hoop={"k": 0.3, "mass_ratio": 0.0}, release={"phi0": 2.2}, ring={"bending_stiffness": 1e5},
        contact={"damping": 1.0}, solve={"resolve": "all"}, run={"turns": 1},
    )  # fmt: skip
    turn = simulate(scene).turns[0].t
    beyond = scene.replace(run={"turns": None, "t_end": turn + 0.5})
    part = simulate(scene.replace(run={"turns": None, "t_end": turn + behind}), history=True)
    assert_same(simulate(beyond, history=True, resume=part), simulate(beyond, history=True))


@pytest.mark.parametrize("name", ["pulses", "throughout"])
@pytest.mark.parametrize("less", [{"t_end": 3.0}, {"t_end": 5.84}, {"t_end": "behind"}, {"until": "pulse"}])
def test_a_run_that_ends_earlier(name: str, less: dict[str, Any]) -> None:
    """Before the march of a pulse, inside it, a hundredth of a step behind the first turn, or at the pulse's end."""
    if less == {"t_end": "behind"}:
        less = {"t_end": whole(name).turns[0].t + 1e-4}
    scene = SCENES[name].replace(run=rigid.Run(**less))
    assert_same(simulate(scene, history=True, resume=whole(name)), simulate(scene, history=True))


def test_a_motion_with_its_states_is_copied() -> None:
    """As a pool of processes does: the hoop is made anew, and fields and a run that goes on are the same."""
    motion = whole("pulses")
    copy = pickle.loads(pickle.dumps(motion))
    assert copy == motion
    assert_same(copy, motion)
    first, second = (each.kept[0].hoop.displacement(each.kept[0].states[-1], (0, 5)) for each in (motion, copy))
    np.testing.assert_array_equal(first, second)
    longer = SCENES["pulses"].replace(run={"turns": 3})
    assert_same(simulate(longer, history=True, resume=copy), simulate(longer, history=True, resume=motion))


def test_progress_ends_with_the_whole() -> None:
    seen: list[float] = []
    simulate(SCENES["pulses"], progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_a_run_that_came_to_its_end_is_itself() -> None:
    assert_same(simulate(SCENES["pulses"], history=True, resume=whole("pulses")), whole("pulses"))


@pytest.mark.parametrize("name", ["pulses", "chain"])
def test_through_a_file(name: str, tmp_path: Any) -> None:
    part = simulate(SCENES[name], history=True, most_steps=whole(name).steps // 2)
    part.save(tmp_path / "part.npz")
    loaded = load_motion(tmp_path / "part.npz")
    assert isinstance(loaded, FlexibleMotion)
    assert_same(loaded, part)
    assert loaded == part
    assert_same(simulate(SCENES[name], history=True, resume=loaded), whole(name))


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_a_history_without_states_is_that_with_them(name: str) -> None:
    """Many steps in one call of compiled code, and each in one of its own, whose state is kept; cut, and gone on."""
    motion = simulate(SCENES[name], history=True, states=False)
    assert repr(told(motion)) == repr(told(whole(name)))
    assert motion.history is not None
    assert whole(name).history is not None
    for field in dataclasses.fields(motion.history):
        np.testing.assert_array_equal(
            getattr(motion.history, field.name), getattr(whole(name).history, field.name), field.name
        )
    assert not motion.kept
    with pytest.raises(SeriesError, match="no states"):
        write_fields(motion, "nowhere")
    part = simulate(SCENES[name], most_steps=whole(name).steps // 3)
    assert repr(told(simulate(SCENES[name], resume=part))) == repr(told(motion))


def test_what_cannot_be_resumed_is_refused() -> None:
    part = simulate(SCENES["pulses"], most_steps=20)
    with pytest.raises(ValueError, match="of another scene"):
        simulate(SCENES["brush"], resume=part)
    with pytest.raises(ValueError, match="did not keep its states"):
        simulate(SCENES["pulses"], history=True, resume=part)
    with pytest.raises(ValueError, match="none of the flexible hoop, but Motion"):
        simulate(SCENES["pulses"], resume=rigid.simulate(SCENES["pulses"]))  # type: ignore[arg-type]


def test_a_motion_goes_on_with_rings_of_which_nothing_is_known_yet(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a new process, say: what the rim yields by where the patch was is known before it is asked for.

    Of columns that nobody asked for a ring has whatever stood in its memory: here ones.
    """
    scene = SCENES["brush"].replace(hoop={"r": 1.2}, solve={"resolve": "all"})
    motion = simulate(scene, history=True)
    for share in (0.8, 0.85):
        cut = simulate(scene.replace(run={"t_end": share * motion.t_end, "until": None}), history=True)
        stored = pickle.dumps(cut)
        forget_rings()
        monkeypatch.setattr(np, "empty", _ones)
        assert_same(simulate(scene, history=True, resume=pickle.loads(stored)), motion)
        monkeypatch.undo()


def _ones(*of: Any, **how: Any) -> NDArray[Any]:
    return np.ones(*of, **how)
