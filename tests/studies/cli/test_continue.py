"""A flexible run that was interrupted leaves what it has, and goes on from there as if nothing had been."""

from __future__ import annotations

import json
import shlex
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import partial

import pytest
from command_line import SCENE, is_one_sentence

from rigid.kernel import interrupts
from studies.cli.shared import single

pytestmark = pytest.mark.usefixtures("undrawn")

MOTION = (
    SCENE.replace("{k}", "0.1").replace('until = "pulse"', "{run}")
    + """\
[contact]
stiffness = 1e7
damping = 1
[solve]
rtol = 1e-2
"""
)


@contextmanager
def interrupting(title: str, by: signal.Signals = signal.SIGINT) -> Iterator[Callable[[float], None]]:
    """A bar at which somebody types Ctrl-C a fifth of the way, once."""
    typed = []

    def told(fraction: float) -> None:
        if fraction > 0.2 and not typed:
            typed.append(fraction)
            signal.raise_signal(by)

    yield told


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
def test_who_stops_it_keeps_what_there_is_and_continue_goes_on(hoop, tmp_path, monkeypatch, by):
    """Ctrl-C, or the end of a batch job."""
    scene, out = tmp_path / "my scene.toml", tmp_path / "out"
    scene.write_text(MOTION.format(run="turns = 2"), encoding="utf-8")
    status, whole, _ = hoop("flexible", scene, "--json", "--out", tmp_path / "whole")
    assert status == 0
    before = signal.getsignal(by)
    with monkeypatch.context() as patched:
        patched.setattr(single, "bar", partial(interrupting, by=by))
        status, part, err = hoop("flexible", scene, "--json", "--out", out)
    assert status == 130
    assert not json.loads(part)["completed"]
    assert f"--continue {shlex.quote(str(out))}" in err
    assert signal.getsignal(by) is before
    status, rest, err = hoop("flexible", scene, "--json", "--continue", out)
    assert (status, err) == (0, "")
    assert rest == whole
    for name in ("motion.json", "history.csv"):
        assert (out / name).read_text() == (tmp_path / "whole" / name).read_text()


def test_ctrl_c_before_the_first_step_of_what_goes_on_leaves_what_is_there(hoop, tmp_path, monkeypatch):
    """While the motion is rebuilt: the status is that of an interrupt, and the way on is told."""
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(MOTION.format(run="turns = 2"), encoding="utf-8")
    with monkeypatch.context() as patched:
        patched.setattr(single, "bar", interrupting)
        hoop("flexible", scene, "--json", "--out", out)
    there = {path.name: path.read_bytes() for path in out.iterdir()}
    with monkeypatch.context() as patched:
        patched.setattr(single, "_interrupts", lambda caught: nullcontext(lambda: True))
        status, _, err = hoop("flexible", scene, "--json", "--continue", out)
    assert status == 130
    assert f"--continue {shlex.quote(str(out))} goes on" in err
    assert {path.name: path.read_bytes() for path in out.iterdir()} == there


def test_fields_are_left_to_what_goes_on(hoop, tmp_path, monkeypatch):
    """Who types Ctrl-C waits for no frames, is told how they come, and they do."""
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(MOTION.format(run="turns = 2"), encoding="utf-8")
    with monkeypatch.context() as patched:
        patched.setattr(single, "bar", interrupting)
        status, _, err = hoop("flexible", scene, "--json", "--out", out, "--fields", "--frames", 5)
    assert status == 130
    assert f"--continue {shlex.quote(str(out))} --fields goes on, and writes the fields." in err
    assert (out / "motion.npz").exists()
    assert not (out / "fields.pvd").exists()
    status, _, _ = hoop("flexible", scene, "--json", "--continue", out, "--fields", "--frames", 5)
    assert status == 0
    assert (out / "fields.pvd").exists()


def test_a_second_ctrl_c_interrupts_between_the_calls_of_compiled_code():
    """Both come while one runs: neither is lost, and neither raises where numba would crash."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with single._interrupts(True) as stop:
            with pytest.raises(KeyboardInterrupt), interrupts.between_calls():  # noqa: PT012
                signal.raise_signal(signal.SIGINT)
                interrupts.answer()
                assert stop()
                signal.raise_signal(signal.SIGINT)  # waits
                interrupts.answer()
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)


def test_fields_stay_where_nothing_is_left_to_do_and_are_said_to_go_where_there_is(hoop, tmp_path):
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(MOTION.format(run="turns = 1"), encoding="utf-8")
    assert hoop("flexible", scene, "--out", out, "--fields", "--frames", 2)[0] == 0
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    status, _, err = hoop("flexible", scene, "--continue", out)
    assert (status, err) == (0, "")
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before
    scene.write_text(MOTION.format(run="turns = 2"), encoding="utf-8")
    status, _, err = hoop("flexible", scene, "--continue", out)
    assert status == 0
    assert is_one_sentence(err)
    assert "--fields makes new ones" in err
    assert not (out / "fields.pvd").exists()


def test_a_run_can_go_further(hoop, tmp_path):
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(MOTION.format(run="turns = 1"), encoding="utf-8")
    assert hoop("flexible", scene, "--out", out)[0] == 0
    scene.write_text(MOTION.format(run="turns = 2"), encoding="utf-8")
    status, further, _ = hoop("flexible", scene, "--json", "--continue", out, "--out", tmp_path / "further")
    assert status == 0
    assert further == hoop("flexible", scene, "--json", "--out", tmp_path / "at-once")[1]


def test_a_longer_run_is_not_cut_short(hoop, tmp_path):
    """What it has beyond the end that is asked for would be lost; elsewhere there is room for the shorter one."""
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(MOTION.format(run="turns = 1"), encoding="utf-8")
    assert hoop("flexible", scene, "--out", out)[0] == 0
    before = {path: path.read_bytes() for path in out.iterdir()}
    scene.write_text(MOTION.format(run="t_end = 1.0"), encoding="utf-8")
    status, printed, err = hoop("flexible", scene, "--continue", out)
    assert (status, printed) == (2, "")
    assert is_one_sentence(err)
    assert before == {path: path.read_bytes() for path in out.iterdir()}
    assert hoop("flexible", scene, "--continue", out, "--out", tmp_path / "shorter")[0] == 0


@pytest.mark.parametrize("wrong", ["empty", "rigid", "other"])
def test_what_cannot_be_gone_on_from_is_one_sentence(hoop, tmp_path, wrong):
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(MOTION.format(run="turns = 1"), encoding="utf-8")
    if wrong == "empty":
        out.mkdir()
    else:
        hoop("rigid" if wrong == "rigid" else "flexible", scene, "--out", out)
    scene.write_text(MOTION.format(run="turns = 1").replace("0.35", "0.36"), encoding="utf-8")
    status, _, err = hoop("flexible", scene, "--continue", out, "--out", tmp_path / "new")
    assert status == 2
    assert is_one_sentence(err), err
