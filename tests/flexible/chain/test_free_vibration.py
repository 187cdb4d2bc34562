"""A soft ring that vibrates far in flight: its frequency falls with the square of its amplitude, in closed form."""

from math import pi, sqrt

import numpy as np
import pytest
from scenes import HOOP, flying, steps_of
from scipy.interpolate import CubicSpline

from flexible.chain.whole import sections
from flexible.models.chain import ChainHoop
from flexible.time.adaptive import restart

HEAVY = 1e3
"""Mass of the ring over the disk's, which is held by it and hardly slows it down."""


class Vibration:
    """The slow motion of an inextensible ring, E I = rho A = a = 1, whose tangent turns by b sin(n s) + c sin(2 n s).

    Its velocity is the integral of i (d/dt turn) exp(i (s + turn)) over s. With the turn taken to third order, b as
    first and c as second order, the mean of the squared velocity is a sum over Fourier coefficients (Parseval):

        4 T/pi = p1 b'^2 (1 - 3 b^2/4) + d1 b' (b c' + c b') + p2 (c'^2 + b^2 b'^2/4) - d2 b b' c' + b^2 b'^2
        4 V/pi = 2 n^2 b^2 + 8 n^2 c^2
        p1, d1 = 1/(n - 1)^2 +- 1/(n + 1)^2,   p2, d2 = 1/(2 n - 1)^2 +- 1/(2 n + 1)^2.

    b = B cos(w t), c = B^2 (c0 + c2 cos(2 w t)) make the mean of T - V over a period stationary (Whitham) for

        c0 = d1 w^2/(32 n^2),   c2 = w^2 (d1/4 - d2/2)/(8 n^2 - 4 p2 w^2),   w/w_n = 1 - share B^2 + O(B^4),
        share n^2 = w^2 (1/8 + (p2 - 3 p1)/32) + d1 w^2 c0/4 + w^2 (d1/8 - d2/4) c2,

    with w_n^2 = 2 n^2/p1 = n^2 (n^2 - 1)^2/(n^2 + 1), the ring's own; share = 89/1200 for n = 2. The radial amplitude
    is n/(n^2 - 1) B.
    """

    def __init__(self, n):
        self.n = n
        p1, d1, p2, d2 = (1 / (m - 1) ** 2 + sign / (m + 1) ** 2 for m in (n, 2 * n) for sign in (1, -1))
        square = 2 * n**2 / p1
        c0, c2 = d1 * square / (32 * n**2), square * (d1 / 4 - d2 / 2) / (8 * n**2 - 4 * p2 * square)
        at_rest = square * (1 / 8 + (p2 - 3 * p1) / 32) + d1 * square * c0 / 4 + square * (d1 / 8 - d2 / 4) * c2
        self.frequency, self.second, self.share = sqrt(square), c0 + c2, at_rest / n**2

    def turn(self, amplitude, s):
        """Of the tangent, at the largest deflection."""
        return amplitude * np.sin(self.n * s) + amplitude**2 * self.second * np.sin(2 * self.n * s)

    def place(self, amplitude, s):
        """Positions then, complex, by the Fourier series of the tangent."""
        even = np.linspace(0, 2 * pi, 513)[:-1]
        series = np.fft.fft(1j * np.exp(1j * (even + self.turn(amplitude, even)))) / len(even)
        order = np.fft.fftfreq(len(even), 1 / len(even))
        kept = (np.abs(series) > 1e-14) & (order != 0)
        return np.exp(1j * np.outer(s, order[kept])) @ (series[kept] / (1j * order[kept]))


def test_the_share_of_an_ellipse():
    assert Vibration(2).share == pytest.approx(89 / 1200, rel=1e-14)
    assert Vibration(2).frequency == pytest.approx(sqrt(36 / 5), rel=1e-14)


def let_go(ring, amplitude, elements):
    """A hoop at rest, turned and far off the floor, its ring bent so; the disk where the bending does not change.

    Returns
    -------
    hoop, pos, s, frequency
        ``s`` is the arc of each section, ``frequency`` that of small vibrations of a thin ring.
    """
    held = {"bending_stiffness": 100 * HEAVY, "weld_half_angle_deg": 1.0}
    hoop = ChainHoop(HOOP.replace(ring=held, hoop={"mass_ratio": HEAVY}, solve={"elements": elements}))
    rod = hoop.ring.chain.rod
    radius = np.hypot(*rod.place[1])
    weld = np.array([pi / 2 / ring.n])
    s = rod.theta + weld
    turn = ring.turn(amplitude, weld)
    bent = (ring.place(amplitude, s) - ring.place(amplitude, weld)) * np.exp(-1j * (weld + turn))
    u = radius * (bent - np.exp(1j * rod.theta) + 1)
    pos = np.zeros(3 + hoop.coordinates)
    pos[1:3] = 5.0, 0.4
    pos[3:] = np.column_stack([u.real, u.imag, ring.turn(amplitude, s) - turn])[1:-1].ravel()
    return hoop, pos, s, ring.frequency * sqrt(100 * 2 * pi / radius**3)


def frequency(ring, amplitude, elements, periods=3, per_period=80):
    """Of the vibration over that of a thin ring: by the passages of its shape through zero."""
    hoop, pos, s, thin = let_go(ring, amplitude, elements)
    period = 2 * pi / thin
    start = restart(hoop, flying(hoop, pos, np.zeros_like(pos)), 0)
    _, _, states = steps_of(hoop, start, (periods + 0.5) * period, period / per_period)
    even = np.linspace(0, 2 * pi, 241)[:-1] + s[0]
    bends = [np.interp(even, s, sections(state.pos)[:, 2], period=2 * pi) @ np.sin(ring.n * even) for state in states]
    passages = CubicSpline([state.t for state in states], bends).roots(extrapolate=False)
    assert len(passages) >= 2 * periods
    return pi / np.polyfit(np.arange(len(passages)), passages, 1)[0] / thin


def softening(ring, elements):
    """Frequency of small vibrations, and by which share of the squared amplitude it falls, from three amplitudes."""
    squares = np.array([0.1, 0.15, 0.2]) ** 2
    found = [frequency(ring, sqrt(square), elements) for square in squares]
    small, slope, _ = np.linalg.solve(np.vander(squares, 3, increasing=True), found)
    return small, -slope / small


@pytest.mark.parametrize("n", [2, 3])
def test_a_free_ring_is_slower_the_further_it_swings(n):
    """The shift of the frequency, on a ring of a thousand times its disk's mass and 120 parts.

    Parts see a wave to the square of the share of it that they are long, (2 pi n/120)^2. Of the rest, thickness
    (h^2/12, 3e-5), disk (1e-3), steps (1e-6) and what the parabola in B^2 leaves of its next power (0.2^4) are smaller.
    """
    ring = Vibration(n)
    small, share = softening(ring, 240)
    assert small == pytest.approx(1, abs=2e-3)
    assert share == pytest.approx(ring.share, rel=(2 * pi * n / 120) ** 2)
