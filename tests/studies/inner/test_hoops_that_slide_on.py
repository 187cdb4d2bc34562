"""A hoop that slides on where a stick breaks, and comes to no end of its pulse: it is refused in one sentence."""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians

import pytest

from flexible import rigid_limit
from rigid import Kind, Run, load_scene, simulate
from studies import StudyError
from studies.inner.events import _Part, _slid_on, _until, passage


@pytest.fixture(scope="module")
def stop():
    """A hoop from rest that rolls with more than mu N behind its slip: its motion up to the end of the pulse, and the
    phase behind which it sticks."""
    hanging = {"hoop": {"k": 0.28}, "friction": {"mu_s": 0.41, "mu": 0.302}, "release": {"phi0_deg": 83.4}}
    scene = rigid_limit(load_scene("paper-3.3-massless").replace(**hanging))
    motion = simulate(scene.replace(run=Run(until="pulse")))
    pulse = motion.pulses[0]
    parts = [_Part(motion, phase, 0.0) for phase in motion.phases]
    (number,) = [
        i
        for i, (before, behind) in enumerate(zip(motion.phases, motion.phases[1:], strict=False))
        if before.kind is not Kind.ROLL and behind.kind is Kind.ROLL and behind.t_start > pulse.t_start
    ]
    return scene, parts, number, pulse


def test_it_slides_on_to_the_end_of_its_pulse(stop):
    scene, parts, number, pulse = stop
    found = _slid_on(scene, parts, number, pulse)
    assert found[: number + 1] == parts[: number + 1]
    assert found[number + 1].phase.kind is not Kind.ROLL
    last = found[-1]
    assert float(last.motion.at(last.phase.t_start).phi) < pulse.phi_end <= float(last.motion.at(_until(last)).phi)


def test_one_that_turns_round_before_the_end_is_refused(stop):
    """It has fallen from rest, so it turns before its disk is as high again: here an end beyond that is asked for."""
    scene, parts, number, pulse = stop
    end = radians(355)
    assert scene.release.omega0 == 0
    assert cos(end) > cos(scene.release.phi0)
    with pytest.raises(StudyError, match=r"^The hoop that slides on turns round in its pulse: there is no limit"):
        _slid_on(scene, parts, number, replace(pulse, phi_end=end))


def test_one_that_is_far_from_the_end_after_twenty_pulses_is_refused(stop):
    """A pulse is said to take a hundredth of the time from the stop to its end."""
    scene, parts, number, pulse = stop
    short = replace(pulse, t_start=pulse.t_end - (pulse.t_end - parts[number + 1].phase.t_start) / 100)
    with pytest.raises(
        StudyError, match=r"^The hoop that slides on does not come to the end of its pulse: there is no"
    ):
        _slid_on(scene, parts, number, short)


def test_a_passage_with_that_stick_broken_has_its_pulse_between_the_same_angles(stop):
    scene, _, _, pulse = stop
    way = passage(scene)
    (number,) = [i for i, event in enumerate(way.events) if event.behind is None and event.psi > way.edges[0]]
    broken = passage(scene, None, [number])
    assert broken.edges == way.edges
    assert broken.events[number].kind.endswith("stick breaks")
    assert broken.pulse.friction_impulse != pulse.friction_impulse
