"""Times of a spike that is 1e-10 wide."""

import numpy as np
import pytest

import rigid

STRAIGHT = 2e-3  # of the range of N, as Motion.times says


@pytest.mark.parametrize("k", [1e-4, 1e-5, 1e-6])
def test_times_resolve_the_pulse_of_a_tiny_disk(k):
    """A floor of 4e-12 of the run left the chord a tenth of the range off, and the peak as much too low."""
    scene = rigid.load_scene("paper-3.4-tiny").replace(hoop={"k": k})
    motion = rigid.simulate(scene)
    pulse = motion.pulses[0]
    times = motion.times()
    force = motion.at(times).normal_force
    middle = (times[1:] + times[:-1]) / 2
    inside = (middle > times[:-1]) & (middle < times[1:]) & (np.diff(times) > 64 * np.spacing(motion.t_end))
    edges = np.array([phase.t_start for phase in motion.phases])
    inside &= np.searchsorted(edges, times[1:]) == np.searchsorted(edges, times[:-1])  # N jumps from phase to phase
    off = np.abs(motion.at(middle).normal_force - (force[1:] + force[:-1]) / 2)
    assert off[inside].max() < 2 * STRAIGHT * np.ptp(force)
    apart = 32 * np.spacing(motion.t_end)  # what times cannot tell: the spike is k^2 wide
    assert force.max() > (1 - STRAIGHT - (apart / k**2) ** 2) * pulse.peak_normal_force
