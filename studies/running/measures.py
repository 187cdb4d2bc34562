"""What is measured on a pulse, the same for every solver; a new measure is one function.

Each takes a motion and one of its pulses and returns a number in the units of the scene.
What a solver does not have (a rigid hoop stores no strain energy) is 0.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TypeVar

from rigid import Kind, Motion, Phase, Pulse, Scene
from rigid.allowed import shown
from rigid.output.units import Unit

from ..machine.build import digest_of


@dataclass(frozen=True, slots=True)
class Measure:
    """One measure of a pulse.

    Attributes
    ----------
    name : str
        Key in tables and JSON.
    symbol : str
        How figures and tables call it.
    unit : Unit
        Its unit; a pure number says so.
    of : callable
        The measure itself, of a motion and one of its pulses.
    """

    name: str
    symbol: str
    unit: Unit
    of: Callable[[Motion, Pulse], float]

    def heading(self, scene: Scene) -> str:
        """Symbol and, in brackets on a second line, unit."""
        unit = self.unit.label(scene)
        return f"{self.symbol}\n[{unit}]" if unit else self.symbol

    def named(self, scene: Scene) -> str:
        """The same on one line."""
        return self.heading(scene).replace("\n", " ")

    def formula(self, scene: Scene) -> str:
        """The same for a figure: symbols as formulas, words as they are."""
        name = re.sub(r"\b([JN])_([NF])\b", r"$\1_\2$", self.symbol)
        if not self.unit.formula:
            return name
        unit = f"${self.unit.formula}$" if scene.dimensionless else self.unit.si
        return f"{name} [{unit}]"


T = TypeVar("T")

MEASURES: dict[str, Measure] = {}


def measure(symbol: str, unit: Unit) -> Callable[[Callable[[Motion, Pulse], float]], Callable[[Motion, Pulse], float]]:
    """Enter a function of a motion and a pulse among the measures, by its own name.

    Results that are kept know the function by its code, with the functions and plain numbers of its module that it
    names: where that has changed, or a measure was not there, a case is run again. Workers import the script or the
    module that enters it; a cell of a notebook they cannot.

    Parameters
    ----------
    symbol : str
        How figures and tables call it.
    unit : Unit
        Of the number that it returns, which is in the units of the scene.

    Raises
    ------
    TypeError
        A unit that is none.
    """
    if not isinstance(unit, Unit):
        names = ", ".join(each.name for each in Unit)
        raise TypeError(f"unit = {shown(unit)} is not possible: it is one of studies.Unit: {names}.")

    def enter(function: Callable[[Motion, Pulse], float]) -> Callable[[Motion, Pulse], float]:
        MEASURES[function.__name__] = Measure(function.__name__, symbol, unit, function)
        return function

    return enter


@measure("J_N", Unit.IMPULSE)
def normal_impulse(motion: Motion, pulse: Pulse) -> float:
    """Integral of the normal force over the pulse."""
    return pulse.normal_impulse


@measure("J_F", Unit.IMPULSE)
def friction_impulse(motion: Motion, pulse: Pulse) -> float:
    """Integral of the friction force over the pulse, positive to the right."""
    return pulse.friction_impulse


@measure("J_F/J_N", Unit.NUMBER)
def impulse_ratio(motion: Motion, pulse: Pulse) -> float:
    """Friction impulse over normal impulse."""
    return pulse.impulse_ratio


@measure("J_F/(μ J_N)", Unit.NUMBER)
def impulse_ratio_over_mu(motion: Motion, pulse: Pulse) -> float:
    """The same over the kinetic coefficient: Whittaker, and Kane and Levinson, have it ±1."""
    mu = motion.scene.friction.mu
    return pulse.impulse_ratio / mu if mu > 0 else float("nan")


@measure("friction loss", Unit.ENERGY)
def friction_loss(motion: Motion, pulse: Pulse) -> float:
    """Integral of |F v|: what friction takes from the energy during the pulse."""
    return pulse.friction_loss


@measure("damping loss", Unit.ENERGY)
def damping_loss(motion: Motion, pulse: Pulse) -> float:
    """What the contact's damper takes; the ring has none."""
    return getattr(pulse, "damping_loss", 0.0)


@measure("numerical loss", Unit.ENERGY)
def numerical_loss(motion: Motion, pulse: Pulse) -> float:
    """What the time integrator takes."""
    return getattr(pulse, "numerical_loss", 0.0)


@measure("peak N", Unit.FORCE)
def peak_normal_force(motion: Motion, pulse: Pulse) -> float:
    """Largest normal force in the pulse; infinite if it jams."""
    return pulse.peak_normal_force


@measure("off the floor", Unit.TIME)
def time_off_floor(motion: Motion, pulse: Pulse) -> float:
    """Time without contact: hopping, footnote 1 of the paper."""
    if hasattr(pulse, "time_off_floor"):
        return pulse.time_off_floor
    return sum(phase.t_end - phase.t_start for phase in inside(motion, pulse) if phase.kind in (Kind.FLIGHT, Kind.SKIM))


@measure("peak ring energy", Unit.ENERGY)
def ring_energy_peak(motion: Motion, pulse: Pulse) -> float:
    """Largest strain energy of the ring in the pulse."""
    return getattr(pulse, "ring_energy_peak", 0.0)


@measure("peak contact energy", Unit.ENERGY)
def contact_energy_peak(motion: Motion, pulse: Pulse) -> float:
    """Largest energy of the contact's springs in the pulse."""
    return getattr(pulse, "contact_energy_peak", 0.0)


@measure("e Newton", Unit.NUMBER)
def newton_restitution(motion: Motion, pulse: Pulse) -> float:
    """Vertical velocity of the mass centre after over before, sign changed."""
    return pulse.newton_restitution


@measure("e Poisson", Unit.NUMBER)
def poisson_restitution(motion: Motion, pulse: Pulse) -> float:
    """Normal impulse of restitution over that of compression."""
    return pulse.poisson_restitution


@measure("e energetic", Unit.NUMBER)
def energetic_restitution(motion: Motion, pulse: Pulse) -> float:
    """Square root of the work of restitution over that of compression."""
    return pulse.energetic_restitution


@measure("duration", Unit.TIME)
def duration(motion: Motion, pulse: Pulse) -> float:
    """Length of the pulse in time."""
    return pulse.t_end - pulse.t_start


OF_THE_MEASURE = "that of the measure"
"""Unit of what is told of one measure after the other, as limits are."""


def known(of: Mapping[str, T], name: str) -> T:
    """What there is of a measure by name.

    Raises
    ------
    ValueError
        Nothing; one sentence with all names of which there is.
    """
    if not isinstance(name, str) or name not in of:
        raise ValueError(f"{name!r} is not a measure of this study: known are {', '.join(of)}.")
    return of[name]


def units_of_measures(scene: Scene) -> dict[str, str]:
    """What each is measured in by name; "1" for a pure number."""
    return {name: entry.unit.label(scene) or "1" for name, entry in MEASURES.items()}


def measures(motion: Motion, pulse: Pulse) -> dict[str, float]:
    """Every measure of a pulse by name."""
    return {name: float(entry.of(motion, pulse)) for name, entry in MEASURES.items()}


def _own() -> list[Measure]:
    """Those that were entered elsewhere than here, by name."""
    return [MEASURES[name] for name in sorted(MEASURES) if MEASURES[name].of.__module__ != __name__]


def entered() -> str:
    """The measures of one's own, each with a digest of what it computes; part of a case's build."""
    return "".join(f"+{each.name}:{digest_of(each.of)}" for each in _own())


def homes() -> tuple[str, ...]:
    """The modules that enter them, for other processes; a script these import by themselves."""
    return tuple({entry.of.__module__: None for entry in _own() if entry.of.__module__ != "__main__"})


def enter_from(modules: tuple[str, ...]) -> None:
    """Import modules that enter measures, as far as they are to be had here."""
    for name in modules:
        try:
            import_module(name)
        except Exception:  # what is missing then is told by the case's build
            continue


def inside(motion: Motion, pulse: Pulse) -> list[Phase]:
    """The phases within a pulse, those at its ends cut to it; a landing with which it begins comes before it."""
    own = getattr(pulse, "phases", None)
    if own is not None:
        return list(own)
    cut = []
    for phase in motion.phases:
        start, end = max(phase.t_start, pulse.t_start), min(phase.t_end, pulse.t_end)
        if end > start or (phase.kind is Kind.IMPACT and pulse.t_start < phase.t_start <= pulse.t_end):
            phi_start = phase.phi_start if phase.t_start >= pulse.t_start else pulse.phi_start
            phi_end = phase.phi_end if phase.t_end <= pulse.t_end else pulse.phi_end
            cut.append(Phase(phase.kind, start, end, phi_start, phi_end))
    return cut


def phase_sequence(motion: Motion, pulse: Pulse) -> list[str]:
    """What the contact does in the pulse, in order."""
    return [str(phase.kind.value) for phase in inside(motion, pulse)]


def shortened(phases: list[str], most: int = 6) -> str:
    """Phases in a row, the middle of a long row told by its number."""
    if len(phases) <= most:
        return " ".join(phases)
    left_out = len(phases) - most
    return f"{' '.join(phases[: most - 1])}, {left_out} more, {phases[-1]}"
