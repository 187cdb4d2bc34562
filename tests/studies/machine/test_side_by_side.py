"""What is compiled for a machine: once, side by side, part by part."""

from __future__ import annotations

from concurrent.futures import Future
from pathlib import Path

import pytest

import rigid
from rigid.kernel import store
from studies.machine import kernels
from studies.machine.kernels import (
    CHAIN_STAGE,
    CONTACT,
    INERTIA,
    LAWS,
    LEVELS,
    STAGE,
    compile_alone,
    compile_on_all_cores,
    missing,
    prepare,
)
from studies.machine.processes import WorkerDied
from studies.running import workers
from studies.running.case import Case


@pytest.fixture
def cold(monkeypatch):
    """Modules for which this machine has no compiled code, as far as it is told: none of any level."""
    absent = {*kernels.APART, *LEVELS.values()}
    monkeypatch.setattr(kernels, "is_cold", absent.__contains__)
    return absent


@pytest.fixture
def asked(monkeypatch, cold):
    """What processes are asked for, in its order; what they compile is there at once."""
    tasks = []

    class Processes:
        def __init__(self, count):
            pass

        def submit(self, function, *arguments):
            compiles = function in (prepare, compile_alone)
            tasks.append((function, *arguments) if compiles else function)
            if function is compile_alone:
                cold.discard(LEVELS.get(arguments[0], arguments[0]))
            future = Future()
            future.set_result(None)
            return future

        def stop(self):
            tasks.append("stopped")

    for user in (kernels, workers):
        monkeypatch.setattr(user, "Processes", Processes)
    return tasks


def test_workers_compile_once_for_all_what_the_cases_need(asked):
    """What is called by address beside the steps of the level asked for first; the rest by one of them, when all are
    there."""
    place = workers.Machine(2)
    scene = rigid.load_scene("paper-3.3-massless")
    soft = scene.replace(ring={"bending_stiffness": 10.0})  # for which "auto" takes the chain
    for solver, hoop in (("rigid", soft), ("flexible", scene), ("flexible", scene), ("flexible", soft)):
        place.submit(Case(solver, hoop))
    run = workers.run_case
    first, *then = asked
    assert first == workers._awake  # both processes load, while this one is still busy with what they shall do
    linear = [(compile_alone, "reduced", False)]
    linear += [(compile_alone, part, True) for part in (CONTACT, STAGE, LAWS, INERTIA)]
    linear.append((prepare, "reduced"))
    exact = [(compile_alone, "chain", False), (compile_alone, CHAIN_STAGE, True), (prepare, "chain")]
    assert then == [first, run, *linear, run, run, *exact, run]


def test_a_single_motion_is_compiled_for_on_all_cores(asked, cold, monkeypatch):
    """In processes of their own, once; on one core they would be for nothing."""
    monkeypatch.setattr(kernels, "cores", lambda: 1)
    compile_on_all_cores(["chain"])
    assert not asked
    monkeypatch.setattr(kernels, "cores", lambda: 2)
    parts = [(compile_alone, "chain", False)]
    parts += [(compile_alone, part, True) for part in (CHAIN_STAGE, CONTACT, LAWS)]
    for _ in range(2):
        compile_on_all_cores(["chain"])
        assert asked == [*parts, "stopped"]
    cold.add(CHAIN_STAGE)  # it was killed in the middle, say
    compile_on_all_cores(["chain"])
    assert asked[5:] == [(compile_alone, CHAIN_STAGE, False), "stopped"]


def test_what_a_process_dies_compiling_is_left_to_whoever_calls_it(cold, monkeypatch):
    """Of want of memory beside the others, say: the case runs all the same."""

    class Processes:
        def __init__(self, count):
            pass

        def submit(self, function, *arguments):
            future = Future()
            if function in (prepare, compile_alone):
                future.set_exception(WorkerDied("its worker process died"))
            else:
                future.set_result("an outcome")
            return future

        def stop(self):
            pass

    for user in (kernels, workers):
        monkeypatch.setattr(user, "Processes", Processes)
    monkeypatch.setattr(kernels, "cores", lambda: 2)
    compile_on_all_cores(["rigid", "chain"])
    assert workers.Machine(2).submit(Case("flexible", rigid.load_scene("paper-3.3-massless"))).result() == "an outcome"


def test_each_level_is_known_to_be_compiled_by_its_own_step(monkeypatch):
    """A machine that has the steps of one level has still to compile those of the other, once for all its workers."""
    from flexible.time.advance import advance_reduced
    from flexible.time.chain_step import advance_chain

    step_of = {"reduced": advance_reduced, "chain": advance_chain}
    homes = {level: Path(step.py_func.__code__.co_filename).parent for level, step in step_of.items()}
    for level, other in (("reduced", "chain"), ("chain", "reduced")):
        monkeypatch.setattr(store, "is_compiled", lambda place, absent=homes[other]: place != absent)
        assert missing(LEVELS) == [other], level
