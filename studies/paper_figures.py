"""The paper's figures 2 to 12, drawn from the closed form; each caption says what is drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import pi, radians
from typing import Any

import numpy as np

from rigid import Hoop, Motion, load_scene, simulate
from rigid.thresholds import inception_mu_s


@cache
def first_rotation(name: str) -> Motion:
    """The motion of a shipped scene."""
    return simulate(load_scene(name))


def bottom_time(motion: Motion) -> float:
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
        bottom = bottom_time(motion)
        times = np.concatenate([times, bottom - close, bottom + close])
    return np.unique(times[(times >= 0) & (times <= motion.t_end)])


@dataclass(frozen=True)
class Drawing:
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
            motion = first_rotation(motion) if isinstance(motion, str) else motion
            states = motion.at(_instants(motion))
            axes.plot(getattr(states, against), getattr(states, quantity), label=title)
        axes.set_xlabel(r"$\varphi$, rad" if against == "phi" else r"time $t/\sqrt{R/g}$")
        axes.set_ylabel(label)
        if log:
            axes.set_yscale("symlog", linthresh=1.0)
        if len(names) > 1:
            axes.legend()

    return draw


def _inception(axes: Any) -> None:
    angles = np.linspace(0.5, 179.5, 500)
    for title, hoop in {
        "point mass": Hoop(0.0),
        "k = 0.1, m_h = 0": Hoop(0.1),
        "k = 0.1, r = 1.02, m_h/m = 0.1": Hoop(0.1, 1.02, 0.1),
        "k = 0.25, m_h = 0": Hoop(0.25),
    }.items():
        axes.plot(angles, [inception_mu_s(hoop, radians(a)) for a in angles], label=title)
    axes.set(xlabel=r"$\varphi_0$, degrees", ylabel=r"$\mu_s$ at inception", ylim=(0, 2), xlim=(0, 180))
    axes.legend()


def drawings() -> list[Drawing]:
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
    force, slip, energy = "normal force $N/(mg)$", r"slip velocity $v/\sqrt{gR}$", "energy $E/(mgR)$"
    slip_in_time = _curves(first, "slip_velocity", slip, against="t")
    return [
        Drawing(2, "Smallest mu_s at which a hoop released at rest begins to roll, (9), over phi0.", _inception),
        Drawing(
            3,
            "3.1: angular velocity, first cycle.",
            _curves(first, "omega", r"angular velocity $\dot\varphi/\sqrt{g/R}$"),
        ),
        Drawing(4, "3.1: normal force, linear below 1.", _curves(first, "normal_force", force, log=True)),
        Drawing(
            5,
            "3.1: friction force, linear within 1.",
            _curves(first, "friction_force", "friction force $F/(mg)$", log=True),
        ),
        Drawing(6, "3.1: slip velocity in time; the second pulse slips forward throughout.", slip_in_time),
        Drawing(7, "3.2: normal force of larger disks.", _curves(larger, "normal_force", force, log=True)),
        Drawing(8, "3.3: slip velocity, light hoops, r = 1.02.", _curves(masses, "slip_velocity", slip)),
        Drawing(9, "3.3: normal force, one density.", _curves(same, "normal_force", force, against="t")),
        Drawing(10, "3.4: energy, k = 1e-5, two pairs mu_s/mu.", _curves(tiny, "energy", energy, against="t")),
        Drawing(11, "3.4: slip velocity, four pairs.", _curves(friction, "slip_velocity", slip, against="t")),
        Drawing(12, "3.4: energy, four pairs mu_s/mu.", _curves(friction, "energy", energy, against="t")),
    ]
