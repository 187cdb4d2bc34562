"""What a run tells: how far it has come, and in words why it ends."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import TypeAlias

from rigid import Motion, Run, Scene
from rigid.output.units import Unit
from rigid.solve import ended_in

from ..contact.laws.listing import LAWS
from ..time.course import Stop

Report = Callable[[float], object]
Fraction = Callable[[float, float], float]  # of time and angle of a step

Ending: TypeAlias = str | Stop | Motion
"""Why a run ends: in words; where it stopped early; or by the rigid motion that begins there, with its own reason."""


class Progress:
    """Fraction done, from the angle swept within the segment that runs."""

    def __init__(self, report: Report | None) -> None:
        self.report = report

    def watch(self, low: float, high: float, fraction: Fraction) -> Callable[[float, float], None] | None:
        """What is told of each step of a segment that takes the run from ``low`` to ``high``."""
        if (report := self.report) is None:
            return None

        def tell(t: float, phi: float) -> None:
            report(low + (high - low) * min(max(fraction(t, phi), 0.0), 1.0))

        return tell


def swept(span: tuple[float, float]) -> Fraction:
    """Fraction of an angle swept."""
    width = span[1] - span[0] or 1.0
    return lambda t, phi: (phi - span[0]) / width


def run_over(run: Run) -> str:
    """That the turns, or the time, asked for are done."""
    if run.turns is None:
        return "the time to run is over"
    return f"the last turn asked for is reached: number {run.turns}"


def pulse_over(back: bool) -> str:
    """That the first whole pulse is over, and whether the hoop turned ``back`` in it."""
    return "the first whole pulse is over" + (": the hoop turned back in it" if back else "")


def in_words(ending: Ending, scene: Scene) -> str:
    """The sentence, with its times in the units of ``scene``."""
    if isinstance(ending, Motion):
        return ended_in(ending, scene)
    if isinstance(ending, str):
        return ending
    told = ending.told() if scene.dimensionless else ending.told(Unit.TIME.of(scene), Unit.TIME.label(scene))
    return told + _advice(scene.to_dimensionless()) if ending.by_ring else told


def period_told(ending: Ending) -> float | None:
    """The period without units, where it is said that the motion rolls for ever: a run to a time does not ask."""
    return ending.period if isinstance(ending, Motion) and ending.scene.run.t_end is None else None


def _advice(scene: Scene) -> str:
    """What to say of a ring that may be too soft for its disk, if that may be; in the solver's units."""
    if LAWS[scene.contact.law].lost_when_soft and scene.contact.damping > 0:
        return (
            f'; under a damped contact of law = "{scene.contact.law}" a soft ring is hard to follow, under others less'
        )
    needed = 1.3 / scene.hoop.k if scene.hoop.k > 0 else inf
    if scene.ring.bending_stiffness >= 10 * needed:
        return ""
    return f"; the pulse of so small a disk wants ring.bending_stiffness well above 1.3/k = {needed:.3g}"
