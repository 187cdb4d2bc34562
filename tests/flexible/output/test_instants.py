"""Frames by default: at steps of the march, where N is that of the curves."""

import numpy as np
import pytest

from flexible import simulate
from flexible.output.instants import instants_at, times_of
from meshes import frame_times
from rigid import load_scene


@pytest.fixture(scope="module")
def thick():
    """A thick wall: its modes above the steps are damped by them, and ring in a shorter one."""
    own = {"hoop": {"r": 1.2, "mass_ratio": 0.1, "R": 0.4, "m": 0.2, "g": 9.81}, "run": {"until": "pulse"}}
    return simulate(load_scene("paper-3.3-massless").replace(**own), history=True)


@pytest.mark.parametrize("frames", [20, 200])
def test_frames_have_the_curves_force(thick, frames):
    when = times_of(thick, frames, None, 0)
    assert len(when) == frames
    assert (np.diff(when) > 0).all()
    instants, states = instants_at(thick, when), thick.at(when)
    at_steps = np.array([frame.state is frame.before or frame.state is frame.after for frame in instants])
    normal = np.array([frame.state.res.normal for frame in instants]) * thick.scene.force_unit
    np.testing.assert_allclose(normal[at_steps], states.normal_force[at_steps], rtol=1e-12)
    # most are steps; of the others one right behind a jump of N may be off by 8 % of its peak, which one is by chance
    assert np.sqrt(np.mean((normal - states.normal_force) ** 2)) < 0.01 * thick.pulses[0].peak_normal_force
    # one between two steps has its nearest taken by a frame that is nearer to it
    steps = np.unique(thick.history.t)
    steps = steps[(steps >= when[0]) & (steps <= when[-1])]
    for t in when[~at_steps]:
        nearest = steps[np.abs(steps - t).argmin()]
        assert np.abs(when[at_steps] - nearest).min() < 1e-12
    assert at_steps.mean() > (0.9 if frames == 20 else 0.5)


@pytest.mark.parametrize("frames", [2, 3, 7, 50])
def test_frames_of_a_whole_motion_begin_and_end_with_it(frames):
    """Between its marches a motion is in closed form, where no frame is moved to a step."""
    scene = load_scene("paper-3.3-massless").replace(
        ring={"bending_stiffness": 200}, contact={"stiffness": 1e7}, run={"turns": 2}, solve={"rtol": 1e-2}
    )
    motion = simulate(scene, history=True)
    when = times_of(motion, frames, None, None)
    assert len(when) == frames
    assert when[0] == 0
    assert when[-1] == motion.t_end
    assert (np.diff(when) > 0).all()
    spans = [np.array([kept.states[0].t, kept.states[-1].t]) * scene.time_unit for kept in motion.kept]
    between = [t for t in frame_times(0.0, motion.t_end, frames, motion.history.t, motion.history.normal_force)
               if not any(a <= t <= b for a, b in spans)]  # fmt: skip
    assert set(between) <= set(when)


def test_frames_span_what_was_asked(thick):
    pulse, when = thick.pulses[0], times_of(thick, 200, None, 0)
    margin = 0.25 * (pulse.t_end - pulse.t_start)
    longest = np.diff(when).max()
    assert pulse.t_start - margin <= when[0] <= pulse.t_start - margin + longest
    assert when[-1] >= min(thick.t_end, pulse.t_end + margin) - longest
