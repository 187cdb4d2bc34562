"""What a run tells: how far it has come, and in words why it ends."""

from __future__ import annotations

import re
from collections.abc import Callable
from math import inf

from rigid import Run, Scene
from rigid.output.units import Unit

from ..time.adaptive import AS_ASKED

Report = Callable[[float], object]
Fraction = Callable[[float, float], float]  # of time and angle of a step

_TIME = re.compile(r"(?<=\bt = )[-+.\de]*\d")


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


def with_advice(scene: Scene, trouble: str) -> str:
    """What to say of a run that stopped: one that was not asked to may have a ring too soft for its disk."""
    needed = 1.3 / scene.hoop.k if scene.hoop.k > 0 else inf
    if trouble.endswith(AS_ASKED) or scene.ring.bending_stiffness >= 10 * needed:
        return trouble
    return f"{trouble}; the pulse of so small a disk wants ring.bending_stiffness well above 1.3/k = {needed:.3g}"


def run_over(run: Run) -> str:
    """That the turns, or the time, asked for are done."""
    if run.turns is None:
        return "the time to run is over"
    return f"the last turn asked for is reached: number {run.turns}"


def pulse_over(back: bool) -> str:
    """That the first whole pulse is over, and whether the hoop turned ``back`` in it."""
    return "the first whole pulse is over" + (": the hoop turned back in it" if back else "")


def in_time_of(scene: Scene, sentence: str) -> str:
    """A sentence of the solver, whose times are in sqrt(R/g), with those of the scene."""
    if scene.dimensionless:
        return sentence
    unit = Unit.TIME.of(scene)
    return _TIME.sub(lambda found: f"{float(found[0]) * unit:.6g} {Unit.TIME.label(scene)}", sentence)
