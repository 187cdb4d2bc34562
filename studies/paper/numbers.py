"""Every number that the paper prints, and ours.

Forces are over m g, times over sqrt(R/g), angles in radians.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import asin, cosh, floor, log10, pi, radians, sin, tan

import numpy as np

from rigid import Hoop, Motion, Release, inception_mu_s, load_scene, rolling_k, rolling_mu_s, simulate

from .sampling import bottoms, motion_of

RELEASE = Release(radians(10))
MOST_DIGITS = 7  # of a closed form of the paper, which has no last digit


@dataclass(frozen=True)
class Verdict:
    """A row of the closing table: what the paper prints, or says of a figure, what we have, and whether they agree."""

    place: str
    """Section and figure."""
    what: str
    paper: str
    ours: str
    agrees: bool | None
    """None where the paper has nothing to compare with."""
    why: str = ""
    """Where they do not: what is known about it."""
    difference: float | None = None
    """Ours less the paper's, of numbers."""


@dataclass(frozen=True)
class Number:
    """One printed number."""

    place: str
    """Section, and the figure that shows it."""
    quantity: str
    paper: float
    ours: float
    unit: float
    """One unit of the last digit that the paper prints."""
    why: str = ""
    """What is known about a printed value that does not hold."""

    @property
    def difference(self) -> float:
        """Ours less the paper's."""
        return self.ours - self.paper

    @property
    def verdict(self) -> Verdict:
        """As a row of the closing table: ours to two digits more than the paper's, which may be cut off or rounded."""
        digits = min(max(0, -floor(log10(self.unit) + 1e-9)), MOST_DIGITS)
        paper, ours = f"{self.paper:.{digits}f}", f"{self.ours:.{min(digits + 2, MOST_DIGITS)}f}"
        holds = bool(abs(self.difference) <= self.unit)
        return Verdict(self.place, self.quantity, paper, ours, holds, "" if holds else self.why, float(self.difference))


def inertia_ratio(hoop: Hoop) -> float:
    """Moment of inertia of the hoop over the disk's, each about its own centre, from e and K of the whole."""
    whole = (1 + hoop.mass_ratio) * (hoop.K - hoop.mass_ratio * hoop.e**2)
    return 2 * whole * (hoop.r / hoop.k) ** 2 - 1


def _section_2() -> Iterator[Number]:
    for k, r, ratio, mass, inertia in (
        (0.1, 1.02, 0.01, 0.04, 8.24),
        (0.25, 1.02, 0.01, 0.0064, 0.2048),
        (0.5, 1.02, 0.01, 0.0016, 0.0128),
        (0.1, 1.00025, 0.01, None, 0.1),
    ):
        ours = ratio * (r * r - 1) / k**2
        case = f"k = {k}, r = {r}, density ratio {ratio}"
        rounding = "the paper multiplies its rounded m_h/m by 2/k^2, as if r were 1"
        if mass is not None:
            unit = 0.01 if mass == 0.04 else 1e-4
            yield Number("2.4", f"m_h/m, {case}", mass, ours, unit)
        unit = {8.24: 0.01, 0.1: 0.05}.get(inertia, 1e-4)
        yield Number(
            "2.4",
            f"inertia, hoop over disk, {case}",
            inertia,
            inertia_ratio(Hoop(k, r, ours)),
            unit,
            rounding,
        )
    hoop = load_scene("paper-3.3-heavier").hoop
    why = "(9) itself gives this value, so mu_s = 0.09 is not twice the minimum"
    inception = inception_mu_s(hoop, RELEASE.phi0)
    yield Number("2.2", "mu_s at inception (9), k = 0.1, r = 1.02, m_h/m = 0.1", 0.045, inception, 0.001, why)


def _section_3_1() -> Iterator[Number]:
    motion = motion_of("paper-3.1", 2)
    ends = [phase.phi_end for phase in motion.phases]
    turns = [turn.phi for turn in motion.turns]
    printed = (0.71402, 3.18085, 3.20455, 4.54542, 2.49277)
    for i, (paper, ours) in enumerate(zip(printed, [*ends[:3], *turns], strict=True), 1):
        yield Number("3.1", f"phi_{i}, k = 0.1", paper, ours, 1e-5)
    yield Number("3.1, fig. 2", "time of the first pulse", 5.74, bottoms(motion)[0], 0.01)
    yield Number("3.1, fig. 2", "time of the first cycle", 8.84, motion.turns[1].t, 0.01)
    yield Number("3.1, fig. 3", "largest N, k = 0.1", 318.0, motion.pulses[0].peak_normal_force, 1.0)


def _section_3_2() -> Iterator[Number]:
    motion = motion_of("paper-3.2-k0.25")
    ours = [*(phase.phi_end for phase in motion.phases[:3]), motion.turns[0].phi]
    for i, (paper, value) in enumerate(zip((0.80625, 3.21545, 3.37076, 4.61783), ours, strict=True), 1):
        yield Number("3.2, fig. 6", f"phi_{i}, k = 0.25", paper, value, 1e-5)
    edge = rolling_k(0.35, RELEASE)
    at_edge = simulate(load_scene("paper-3.2-k0.5385").replace(hoop={"k": edge * (1 + 1e-12)}))
    for name, paper, unit in (("k0.25", 32.4, 0.1), ("k0.5", 3.52, 0.01), ("k0.75", 1.3, 0.1)):
        pulse = motion_of(f"paper-3.2-{name}").pulses[0]
        yield Number(
            "3.2, fig. 7" if name == "k0.25" else "3.2",
            f"largest N, k = {name[1:]}",
            paper,
            pulse.peak_normal_force,
            unit,
        )
    yield Number(
        "3.2",
        "largest N at the smallest k that rolls throughout",
        2.94,
        at_edge.pulses[0].peak_normal_force,
        0.01,
    )
    yield Number("3.2", "smallest k that rolls throughout", 0.5385, edge, 1e-4)


def _section_3_3() -> Iterator[Number]:
    motion = motion_of("paper-3.3-same-density")
    hoop = motion.scene.hoop
    at_rest = simulate(motion.scene.replace(release={"phi0": pi}))
    yield Number("3.3", "m_h/m of one density, k = 0.1, r = 1.02", 4.04, hoop.mass_ratio, 0.01)
    yield Number("3.3, fig. 9", "largest N, one density", 5.425, motion.pulses[0].peak_normal_force, 0.001)
    yield Number("3.3, fig. 9", "N at rest, one density", 5.04, float(at_rest.at(0.0).normal_force), 0.01)


def spike_width(motion: Motion) -> float:
    """How long N is half its peak or more in the first pulse (the full width at half maximum)."""
    pulse = motion.pulses[0]
    t = motion.times(pulse.t_start, pulse.t_end)
    for _ in range(2):  # the times of a drawing, then those around the peak alone
        high = np.flatnonzero(motion.at(t).normal_force >= 0.5 * pulse.peak_normal_force)
        first, last = t[max(high[0] - 1, 0)], t[min(high[-1] + 1, len(t) - 1)]
        t = np.linspace(first, last, 1001)
    high = np.flatnonzero(motion.at(t).normal_force >= 0.5 * pulse.peak_normal_force)
    return float(t[high[-1]] - t[high[0]])


def _section_3_4() -> Iterator[Number]:
    for name, paper in (("tiny", 1.38862), ("tiny-rough", 1.80266)):
        motion = motion_of(f"paper-3.4-{name}")
        mu = motion.scene.friction.mu
        width = spike_width(motion)
        why = f"N is half its peak or more for {width:.0e} of the time unit: a run in t picks its modes from round-off"
        if mu == 0.3:
            why += "; ours rolls for a moment inside the pulse, which the paper does not list"
        yield Number(
            "3.4, fig. 10",
            f"energy after the first rotation, k = 1e-5, mu = {mu}",
            paper,
            motion.turns[0].energy,
            1e-5,
            why,
        )
    hoop = load_scene("paper-3.4-rough").hoop
    yield Number("3.4", "smallest mu_s that rolls throughout, m_h/m = 0.1", 0.78, rolling_mu_s(hoop, RELEASE), 0.01)


def _point_mass() -> Iterator[Number]:
    motion = motion_of("paper-point-mass")
    phi0 = motion.scene.release.phi0
    t = 0.5 * motion.phases[0].t_end
    law = 2 * asin(sin(phi0 / 2) * cosh(t / 2))
    yield Number(
        "2.3",
        "phi half way through a point mass's rolling, by its law",
        law,
        float(motion.at(t).phi),
        1e-14,
    )
    yield Number(
        "2.3",
        "mu_s at inception of a point mass, tan(phi0/2)",
        tan(phi0 / 2),
        inception_mu_s(motion.scene.hoop, phi0),
        1e-15,
    )


def numbers() -> list[Number]:
    """Every printed number beside ours."""
    sections = (_section_2, _point_mass, _section_3_1, _section_3_2, _section_3_3, _section_3_4)
    return [row for section in sections for row in section()]
