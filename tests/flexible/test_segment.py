"""What is read off the records of a march."""

import numpy as np
import pytest
from scenes import HOOP
from scipy.optimize import brentq

from flexible import simulate
from flexible.models.state import Record
from flexible.output.body import whole
from flexible.segment import Segment, peak

MASSLESS = HOOP.replace(hoop={"mass_ratio": 0.0})


def turning(t, phi, omega, scene=MASSLESS):
    """Records of a hoop that turns, and does nothing else."""
    nothing = dict.fromkeys(Record._fields, 0.0)
    rows = [{**nothing, "t": a, "phi": b, "omega": c, "mode": 0} for a, b, c in zip(t, phi, omega, strict=True)]
    return Segment([Record(**row) for row in rows], scene, 0.0)


def test_an_event_at_the_very_angle_is_no_crossing_of_its_own():
    """The two records of an event take no time; the steps before and behind it both end at the angle."""
    segment = turning([0.0, 1.0, 1.0, 2.0], [0.0, 1.0, 1.0, 2.0], [1.0] * 4)
    assert list(segment.crossings(1.0)) == pytest.approx([1.0, 1.0])
    assert segment.crossing(1.0, 0.5) == pytest.approx(1.0)
    assert segment.crossing(1.0, 1.5) is None


def test_a_hoop_thrown_back_passes_an_angle_once_each_way():
    """phi = t (2 - t), a parabola, which cubics between steps have exactly: 1/2 at 1 -+ sqrt(1/2)."""
    t = np.array([0.0, 0.3, 1.1, 1.1, 2.0])
    segment = turning(t, t * (2 - t), 2 - 2 * t)
    assert list(segment.crossings(0.5)) == pytest.approx([1 - 0.5**0.5, 1 + 0.5**0.5], abs=1e-14)


def test_a_hoop_that_rolls_does_so_between_the_steps():
    """x_C = phi = t (2 - t): a way straight between the steps would have the hoop slip there and back."""
    t = np.array([0.0, 0.3, 1.1, 2.0])
    segment = turning(t, t * (2 - t), 2 - 2 * t)
    segment.columns["x_C"] = segment["phi"].copy()
    between = np.linspace(0, 2, 23)
    assert segment.value("x_C", between) == pytest.approx(between * (2 - between), abs=1e-14)


def test_friction_takes_energy_between_steps_as_the_hoop_slips():
    """A slide that a constant F slows down, v = 1 - t: by t it has taken F (t - t^2/2)."""
    t = np.array([0.0, 0.25, 0.25, 0.9, 1.0])
    segment = turning(t, t, np.ones(5))
    segment.columns |= {"friction_force": np.full(5, -0.3), "slip_velocity": 1 - t}
    segment.columns["friction_loss"] = 0.3 * (t - t**2 / 2)
    between = np.linspace(0, 1, 23)
    for side in ("left", "right"):
        read = segment.value("friction_loss", between, side)
        assert read == pytest.approx(0.3 * (between - between**2 / 2), abs=1e-15)


def test_restitutions_are_those_of_the_mass_centre():
    """By velocity and height that the ring's own states give G: N's impulse is M (change of ydot_G + time), and its
    work M (change of ydot_G^2/2 + y_G), both split where G turns up. Between steps of 1e-2 that is known to 1e-3.
    """
    motion = simulate(HOOP.replace(contact={"damping": 1.0}, solve={"rtol": 1e-4}), history=True)
    (pulse,), (kept,) = motion.pulses, motion.kept
    t, found = np.array([s.t for s in kept.states]), [whole(kept.hoop, s) for s in kept.states]
    ends = [pulse.t_start, pulse.t_end]
    up, height = np.array([each.velocity[1] for each in found]), np.array([each.height for each in found])
    i = int(np.argmax(up > 0))
    turned, lowest = t[i] - up[i] * (t[i] - t[i - 1]) / (up[i] - up[i - 1]), height.min()
    (down, away), (high, late) = np.interp(ends, t, up), np.interp(ends, t, height)
    into, out = turned - ends[0] - down, away + ends[1] - turned
    absorbed, returned = down**2 / 2 + high - lowest, away**2 / 2 + late - lowest
    assert pulse.newton_restitution == pytest.approx(-away / down, rel=3e-3)
    assert pulse.poisson_restitution == pytest.approx(out / into, rel=3e-3)
    assert pulse.energetic_restitution == pytest.approx((returned / absorbed) ** 0.5, rel=3e-3)
    assert pulse.energetic_restitution**2 < 0.95, "its square is another number"


def test_restitutions_and_peak_of_a_force_that_jumps():
    """N = 1 + a t (1 - t) up to 0.4, where it is largest and jumps down to half of that; M = 1, ydot_G = -1 at first.

    Four steps: the impulse is a cubic in each, as it is kept between them, so what is read off has no error of the
    steps. The work is that of fifty thousand midpoints, good to 1e-8.
    """
    a, jump, down = 12.0, 0.4, -1.0

    def force(t, behind):
        return (1 + a * t * (1 - t)) * np.where(behind, 0.5, 1.0)

    def gained(t):
        rise = t + a * (t**2 / 2 - t**3 / 3)
        there = jump + a * (jump**2 / 2 - jump**3 / 3)
        return np.where(t <= jump, rise, there + (rise - there) / 2)

    t = np.array([0.0, 0.25, jump, jump, 0.7, 1.0])
    segment = turning(t, t, np.ones(6))
    segment.rise = down
    segment.columns |= {"normal_force": force(t, np.arange(6) > 2), "normal_impulse": gained(t)}
    pulse = segment.pulse(0.0, 1.0)

    edges = np.concatenate([np.linspace(0, jump, 20001), np.linspace(jump, 1, 30001)[1:]])
    middle, width = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    normal_force, velocity = force(middle, middle > jump), down + gained(middle) - middle
    pressed = velocity < 0
    turned = brentq(lambda t: down + gained(t) - t, 0.0, 1.0, xtol=1e-15)
    into, out = float(gained(turned)), float(gained(1.0) - gained(turned))
    absorbed, returned = (float((normal_force * velocity * width)[part].sum()) for part in (pressed, ~pressed))
    assert pulse.newton_restitution == pytest.approx(down + gained(1.0) - 1, rel=1e-14)
    assert pulse.poisson_restitution == pytest.approx(out / into, rel=1e-12)
    assert pulse.energetic_restitution == pytest.approx((-returned / absorbed) ** 0.5, rel=1e-7)
    assert pulse.peak_normal_force == pytest.approx(1 + a * jump * (1 - jump), rel=1e-14)


def test_energy_peaks_are_those_of_the_ring_and_of_the_floor():
    """Between steps nothing is larger; the foundation here is so soft that floor and ring differ."""
    motion = simulate(HOOP.replace(contact={"damping": 1.0}), history=True)
    (pulse,), steps = motion.pulses, motion.history
    inside = (steps.t >= pulse.t_start) & (steps.t <= pulse.t_end)
    peaks = pulse.ring_energy_peak, pulse.contact_energy_peak
    assert peaks == pytest.approx((steps.ring_strain[inside].max(), steps.contact_spring[inside].max()), rel=1e-12)
    assert not 0.5 < peaks[0] / peaks[1] < 2


@pytest.mark.parametrize("t", [[0.5, 0.8, 1.15, 1.2], [0.0, 0.3, 1.0, 1.2, 2.0]])
def test_the_peak_of_a_parabola_is_its_own(t):
    """Whatever the steps about it."""
    t = np.array(t)
    assert peak(t, 3 - 2 * (t - 0.93) ** 2) == pytest.approx(3.0, rel=1e-14)
