"""Every number and figure of the paper again: V. A. Lubarda, J. Mech. Mater. Struct. 4(6), 2009.

:func:`reproduce` writes figures 2 to 12 and a table that puts the paper's value beside ours to ten
digits, the difference, and in words whether the printed digits hold.
Forces are over m g, times over sqrt(R/g), angles in radians.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from math import asin, cosh, pi, radians, sin, tan
from pathlib import Path
from typing import Any

import numpy as np

from rigid import Hoop, Motion, Release, load_scene, simulate
from rigid.thresholds import inception_mu_s, rolling_k, rolling_mu_s

RELEASE = Release(radians(10))
Progress = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Row:
    """One printed number."""

    section: str
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
    def remark(self) -> str:
        """In words, whether the printed digits hold."""
        if abs(self.difference) <= 0.5000001 * self.unit:
            return "holds to all printed digits"
        if abs(self.difference) <= self.unit:
            return "holds; the paper's last digit is cut off, not rounded"
        return self.why or "does not hold to the last printed digits"


@cache
def _first_rotation(name: str) -> Motion:
    return simulate(load_scene(name))


def _section_2() -> Iterator[Row]:
    for k, r, ratio, mass, inertia in (
        (0.1, 1.02, 0.01, 0.04, 8.24),
        (0.25, 1.02, 0.01, 0.0064, 0.2048),
        (0.5, 1.02, 0.01, 0.0016, 0.0128),
        (0.1, 1.00025, 0.01, None, 0.1),
    ):
        ours = ratio * (r * r - 1) / k**2
        case = f"k = {k}, r = {r}, density ratio {ratio}"
        rounding = "does not hold: the paper multiplies its rounded m_h/m by 2/k^2, as if r were 1"
        if mass is not None:
            unit = 0.01 if mass == 0.04 else 1e-4
            yield Row("2.4", f"m_h/m, {case}", mass, ours, unit)
        unit = {8.24: 0.01, 0.1: 0.1}.get(inertia, 1e-4)
        yield Row(
            "2.4",
            f"inertia of the hoop over that of the disk, {case}",
            inertia,
            ours * (1 + r * r) / k**2,
            unit,
            rounding,
        )
    hoop = load_scene("paper-3.3-heavier").hoop
    why = "does not hold: (9) itself gives this value, so mu_s = 0.09 is not twice the minimum"
    inception = inception_mu_s(hoop, RELEASE.phi0)
    yield Row("2.2", "mu_s at inception (9), k = 0.1, r = 1.02, m_h/m = 0.1", 0.045, inception, 0.001, why)


def _section_3_1() -> Iterator[Row]:
    motion = _first_rotation("paper-3.1")
    ends = [phase.phi_end for phase in motion.phases]
    turns = [turn.phi for turn in motion.turns]
    printed = (0.71402, 3.18085, 3.20455, 4.54542, 2.49277)
    for i, (paper, ours) in enumerate(zip(printed, [*ends[:3], *turns], strict=True), 1):
        yield Row("3.1", f"phi_{i}, k = 0.1", paper, ours, 1e-5)
    yield Row("3.1", "time of the first pulse", 5.74, _bottom_time(motion), 0.01)
    yield Row("3.1", "time of the first cycle", 8.84, motion.turns[1].t, 0.01)
    yield Row("3.1", "largest N, k = 0.1", 318.0, motion.pulses[0].peak_normal_force, 1.0)


def _section_3_2() -> Iterator[Row]:
    motion = _first_rotation("paper-3.2-k0.25")
    ours = [*(phase.phi_end for phase in motion.phases[:3]), motion.turns[0].phi]
    for i, (paper, value) in enumerate(zip((0.80625, 3.21545, 3.37076, 4.61783), ours, strict=True), 1):
        yield Row("3.2", f"phi_{i}, k = 0.25", paper, value, 1e-5)
    edge = rolling_k(0.35, RELEASE)
    at_edge = simulate(load_scene("paper-3.2-k0.5385").replace(hoop={"k": edge * (1 + 1e-12)}))
    for name, paper, unit in (("k0.25", 32.4, 0.1), ("k0.5", 3.52, 0.01), ("k0.75", 1.3, 0.1)):
        pulse = _first_rotation(f"paper-3.2-{name}").pulses[0]
        yield Row("3.2", f"largest N, k = {name[1:]}", paper, pulse.peak_normal_force, unit)
    yield Row(
        "3.2",
        "largest N at the smallest k that rolls throughout",
        2.94,
        at_edge.pulses[0].peak_normal_force,
        0.01,
    )
    yield Row("3.2", "smallest k that rolls throughout", 0.5385, edge, 1e-4)


def _section_3_3() -> Iterator[Row]:
    motion = _first_rotation("paper-3.3-same-density")
    hoop = motion.scene.hoop
    yield Row("3.3", "m_h/m of one density, k = 0.1, r = 1.02", 4.04, (hoop.r**2 - 1) / hoop.k**2, 0.01)
    yield Row("3.3", "largest N, one density", 5.425, motion.pulses[0].peak_normal_force, 0.001)
    yield Row("3.3", "N at rest, one density", 5.04, 1 + hoop.mass_ratio, 0.01)


def _section_3_4() -> Iterator[Row]:
    tiny = (
        "does not hold: at k = 1e-5 the pulse takes 1e-10 of the time unit, "
        "and a run in t picks its modes from round-off"
    )
    for name, paper in (("tiny", 1.38862), ("tiny-rough", 1.80266)):
        motion = _first_rotation(f"paper-3.4-{name}")
        mu = motion.scene.friction.mu
        why = tiny
        if mu == 0.3:
            why += "; ours rolls for a moment inside the pulse, which the paper does not list"
        yield Row(
            "3.4",
            f"energy at the end of the first rotation, k = 1e-5, mu = {mu}",
            paper,
            motion.turns[0].energy,
            1e-5,
            why,
        )
    hoop = load_scene("paper-3.4-rough").hoop
    yield Row(
        "3.4", "smallest mu_s that rolls throughout, m_h/m = 0.1", 0.78, rolling_mu_s(hoop, RELEASE), 0.01
    )


def _point_mass() -> Iterator[Row]:
    motion = _first_rotation("paper-point-mass")
    phi0 = motion.scene.release.phi0
    t = 0.5 * motion.phases[0].t_end
    law = 2 * asin(sin(phi0 / 2) * cosh(t / 2))
    yield Row(
        "2.3",
        "phi of a point mass half way through its rolling, by its law",
        law,
        float(motion.at(t).phi),
        1e-14,
    )
    yield Row(
        "2.3",
        "mu_s at inception of a point mass, tan(phi0/2)",
        tan(phi0 / 2),
        inception_mu_s(motion.scene.hoop, phi0),
        1e-15,
    )


def table() -> list[Row]:
    """Every printed number beside ours."""
    sections = (_section_2, _point_mass, _section_3_1, _section_3_2, _section_3_3, _section_3_4)
    return [row for section in sections for row in section()]


def _bottom_time(motion: Motion) -> float:
    """When the disk first passes its lowest point: Newton on phi(t) = pi from the middle of the pulse."""
    pulse = motion.pulses[0]
    t = 0.5 * (pulse.t_start + pulse.t_end)
    for _ in range(20):
        here = motion.at(t)
        t = min(max(t - (float(here.phi) - pi) / float(here.omega), pulse.t_start), pulse.t_end)
    return t


def _instants(motion: Motion) -> Any:
    """Times that resolve the phases and, much more finely, the pulses."""
    spans = [(0.0, motion.t_end, 500), *((phase.t_start, phase.t_end, 80) for phase in motion.phases)]
    spans += [(pulse.t_start, pulse.t_end, 300) for pulse in motion.pulses]
    times = np.concatenate([np.linspace(*span) for span in spans])
    if motion.scene.hoop.k < 1e-3:
        # the pulse lives on k^2: grade towards the bottom from both sides
        close = np.geomspace(1e-13, 1, 400)
        bottom = _bottom_time(motion)
        times = np.concatenate([times, bottom - close, bottom + close])
    return np.unique(times[(times >= 0) & (times <= motion.t_end)])


@dataclass(frozen=True)
class _Figure:
    """One figure: a caption that says what is drawn, and what draws it."""

    number: int
    caption: str
    draw: Callable[[Any], None]


def _curves(
    names: dict[str, Any], quantity: str, label: str, *, against: str = "phi", log: bool = False
) -> Callable[[Any], None]:
    """A drawing of one quantity of several motions (by label), over phi or t."""

    def draw(axes: Any) -> None:
        for title, motion in names.items():
            motion = _first_rotation(motion) if isinstance(motion, str) else motion
            states = motion.at(_instants(motion))
            axes.plot(getattr(states, against), getattr(states, quantity), lw=1.2, label=title)
        axes.set_xlabel("phi, rad" if against == "phi" else "t, sqrt(R/g)")
        axes.set_ylabel(label)
        if log:
            axes.set_yscale("symlog", linthresh=1.0)
        if len(names) > 1:
            axes.legend(frameon=False)

    return draw


def _inception(axes: Any) -> None:
    angles = np.linspace(0.5, 179.5, 500)
    for title, hoop in {
        "point mass": Hoop(0.0),
        "k = 0.1, m_h = 0": Hoop(0.1),
        "k = 0.1, r = 1.02, m_h/m = 0.1": Hoop(0.1, 1.02, 0.1),
        "k = 0.25, m_h = 0": Hoop(0.25),
    }.items():
        axes.plot(angles, [inception_mu_s(hoop, radians(a)) for a in angles], lw=1.2, label=title)
    axes.set(xlabel="phi0, degrees", ylabel="mu_s at inception", ylim=(0, 2))
    axes.legend(frameon=False)


def _figures() -> list[_Figure]:
    pairs = {"smooth": "frictionless", "0.09 / 0.076": "slippery", "0.35 / 0.3": "", "1.2 / 1.0": "rough"}
    friction = {label: f"paper-3.4-{name}" if name else "paper-3.3-heavier" for label, name in pairs.items()}
    first = {"k = 0.1": "paper-3.1"}
    masses = {
        "m_h = 0": "paper-3.3-massless",
        "m_h/m = 0.01": "paper-3.3-light",
        "m_h/m = 0.1": "paper-3.3-heavier",
    }
    tiny = {"0.35 / 0.3": "paper-3.4-tiny", "0.7 / 0.6": "paper-3.4-tiny-rough"}
    larger = {f"k = {k}": f"paper-3.2-k{k}" for k in (0.25, 0.5, 0.75)}
    same = {"m_h/m = 4.04": "paper-3.3-same-density"}
    force, slip, energy = "N, m g", "v, sqrt(g R)", "E, m g R"
    slip_in_time = _curves(first, "slip_velocity", slip, against="t")
    return [
        _Figure(
            2, "Smallest mu_s at which a hoop released at rest begins to roll, (9), over phi0.", _inception
        ),
        _Figure(3, "3.1: angular velocity, first cycle.", _curves(first, "omega", "phidot, sqrt(g/R)")),
        _Figure(4, "3.1: normal force, linear below 1.", _curves(first, "normal_force", force, log=True)),
        _Figure(
            5, "3.1: friction force, linear within 1.", _curves(first, "friction_force", "F, m g", log=True)
        ),
        _Figure(6, "3.1: slip velocity in time; the second pulse slips forward throughout.", slip_in_time),
        _Figure(7, "3.2: normal force of larger disks.", _curves(larger, "normal_force", force, log=True)),
        _Figure(8, "3.3: slip velocity, light hoops, r = 1.02.", _curves(masses, "slip_velocity", slip)),
        _Figure(9, "3.3: normal force, one density.", _curves(same, "normal_force", force, against="t")),
        _Figure(
            10, "3.4: energy, k = 1e-5, two pairs mu_s/mu.", _curves(tiny, "energy", energy, against="t")
        ),
        _Figure(11, "3.4: slip velocity, four pairs.", _curves(friction, "slip_velocity", slip, against="t")),
        _Figure(12, "3.4: energy, four pairs mu_s/mu.", _curves(friction, "energy", energy, against="t")),
    ]


def reproduce(out: Path, progress: Progress | None = None) -> list[Row]:
    """Write ``figure-02.png`` to ``figure-12.png``, ``table.csv`` and ``table.md``; return the table.

    Parameters
    ----------
    out : Path
        A folder; made if it does not exist.
    progress : callable, optional
        Called as ``progress(done, total, what)`` after each piece.
    """
    from matplotlib.figure import Figure

    out.mkdir(parents=True, exist_ok=True)
    figures = _figures()
    rows = table()
    _write_table(rows, figures, out)
    for done, figure in enumerate(figures, 1):
        canvas = Figure(figsize=(6.4, 3.8), layout="constrained")
        figure.draw(canvas.add_subplot())
        canvas.savefig(out / f"figure-{figure.number:02d}.png", dpi=160)
        if progress is not None:
            progress(done, len(figures), f"figure {figure.number}")
    return rows


def _write_table(rows: list[Row], figures: list[_Figure], out: Path) -> None:
    header = ["section", "quantity", "paper", "ours", "difference", "remark"]
    cells = [
        [
            row.section,
            row.quantity,
            f"{row.paper:.10g}",
            f"{row.ours:.10g}",
            f"{row.difference:.2g}",
            row.remark,
        ]
        for row in rows
    ]
    with (out / "table.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([header, *cells])
    lines = ["| " + " | ".join(line) + " |" for line in [header, ["---"] * len(header), *cells]]
    captions = [f"* `figure-{figure.number:02d}.png`: {figure.caption}" for figure in figures]
    text = "\n".join(["# The paper's numbers and ours", "", *lines, "", "## Figures", "", *captions, ""])
    (out / "table.md").write_text(text, encoding="utf-8")
