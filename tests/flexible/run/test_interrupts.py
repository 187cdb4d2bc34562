"""What comes while compiled code runs is answered where Python may raise."""

import os
import signal
import subprocess
import sys
import threading

import pytest

import flexible
import rigid
from rigid.kernel import announce, interrupts

LONG = """
import signal, flexible, rigid

class Over(Exception):
    pass

def over(*_):
    raise Over

scene = rigid.load_scene("paper-3.3-light").replace(run={"turns": 20}, solve={"resolve": "all", "rtol": 1e-5})
flexible.simulate(scene.replace(run={"turns": None, "t_end": 0.1}))
signal.signal(signal.SIGPROF, over)
for i in range(20):
    signal.setitimer(signal.ITIMER_PROF, 0.02 + 0.0031 * i)
    try:
        flexible.simulate(scene)
    except Over:
        print("over")
    signal.setitimer(signal.ITIMER_PROF, 0.0)
assert signal.getsignal(signal.SIGPROF) is over
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timer of processor time")
def test_a_handler_that_raises_in_the_middle_of_a_step_crashes_nothing():
    """Nine tenths of a march are compiled code, whose answer numba makes unprepared for what a handler raises."""
    done = subprocess.run([sys.executable, "-c", LONG], capture_output=True, text=True, env=os.environ, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    assert done.stdout.split() == ["over"] * 20


def test_a_signal_waits_for_its_answer_but_not_for_a_compilation(monkeypatch):
    came = []
    before = signal.signal(signal.SIGINT, lambda *_: came.append("here"))
    try:
        with interrupts.between_calls(), interrupts.between_calls():
            signal.raise_signal(signal.SIGINT)
            assert came == []
            interrupts.answer()
            assert came == ["here"]
            monkeypatch.setattr(interrupts, "compiling", lambda: True)
            signal.raise_signal(signal.SIGINT)
            assert came == ["here"] * 2
            monkeypatch.undo()
            signal.raise_signal(signal.SIGINT)
            assert came == ["here"] * 2
        assert came == ["here"] * 3  # at the end at the latest
        signal.raise_signal(signal.SIGINT)
        assert came == ["here"] * 4
    finally:
        signal.signal(signal.SIGINT, before)
    assert not announce.compiling()


def test_another_thread_answers_nothing():
    """Python runs handlers in the main thread; what came is left for it, whatever else makes a motion meanwhile."""
    came = []
    before = signal.signal(signal.SIGINT, lambda *_: came.append(threading.current_thread()))
    try:
        with interrupts.between_calls():
            signal.raise_signal(signal.SIGINT)
            other = threading.Thread(target=interrupts.answer)
            other.start()
            other.join()
            assert came == []
            interrupts.answer()
            assert came == [threading.main_thread()]
    finally:
        signal.signal(signal.SIGINT, before)


def test_of_two_signals_that_wait_none_is_left_for_the_next_motion():
    """The handler of the first raises: the second must not come again where nobody sent it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt), interrupts.between_calls():
            [signal.raise_signal(number) for number in (signal.SIGINT, signal.SIGINT)]
        with interrupts.between_calls():
            interrupts.answer()
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_motion_that_is_interrupted_leaves_the_handlers_as_they_were():
    def stop():
        signal.raise_signal(signal.SIGINT)
        return False

    scene = rigid.load_scene("paper-3.3-light").replace(run={"until": "pulse"}, solve={"rtol": 1e-2})
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it would be ignored
    try:
        with pytest.raises(KeyboardInterrupt):
            flexible.simulate(scene, stop=stop)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
