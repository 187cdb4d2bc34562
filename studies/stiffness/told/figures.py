"""The figures of a stiffness study: its pulse at several stiffnesses, and how far it is from the rigid one."""

from __future__ import annotations

from collections.abc import Callable

import matplotlib
from matplotlib.figure import Figure

from rigid import Motion, Pulse, simulate

from ...plots.difference import at_the_same_angle, at_the_same_normal_impulse, impulses_along, passage_of
from ...plots.pulse import Curve, energy, impulses, pulse
from ...plots.style import RIGID, STYLE, blank, colours, power_of_ten
from ...running.history import dimensionless
from ..found import StiffnessStudy
from ..ladder import spread
from ..rung import Rung


def forces(study: StiffnessStudy) -> Figure:
    """The first pulse over time at some of the stiffnesses, and what is left between each and the rigid hoop."""
    passage = passage_of(*_rigid_pulse(study))
    own = [rung.outcome.histories[0] for rung in _drawn(study)]
    left = [dimensionless(at_the_same_angle(columns, passage), study.scene) for columns in own]
    return pulse(_curves(study), "Through the first pulse", left, study.ladder.raised)


def impulse_space(study: StiffnessStudy) -> Figure | None:
    """The same in impulse space; None without friction."""
    if study.scene.friction.mu_s == 0:
        return None
    along = impulses_along(*_rigid_pulse(study))
    own = [rung.outcome.histories[0] for rung in _drawn(study)]
    left = [at_the_same_normal_impulse(columns, along) / study.scene.impulse_unit for columns in own]
    return impulses(_curves(study), study.scene.friction.mu, left, study.ladder.raised)


def energies(study: StiffnessStudy) -> Figure | None:
    """Where the energy is at a stiffness in the middle."""
    rungs = _drawn(study)
    if not rungs:
        return None
    middle = rungs[len(rungs) // 2]
    words = f"Where the energy is, {study.ladder.raised} {power_of_ten(middle.stiffness)}"
    return energy(dimensionless(middle.outcome.histories[0], study.scene), words)


def _rigid_pulse(study: StiffnessStudy) -> tuple[Motion, Pulse]:
    motion = simulate(study.reference.scene)
    return motion, next(pulse for pulse in motion.pulses if not pulse.cut)


def _curves(study: StiffnessStudy) -> list[Curve]:
    rungs = _drawn(study)
    through = [dimensionless(rung.outcome.histories[0], study.scene) for rung in rungs]
    curves: list[Curve] = [
        (power_of_ten(rung.stiffness), columns, colour)
        for rung, columns, colour in zip(rungs, through, colours(len(rungs)), strict=True)
    ]
    return [*curves, ("rigid", dimensionless(study.reference.histories[0], study.scene), RIGID)]


def _drawn(study: StiffnessStudy) -> list[Rung]:
    return spread([rung for rung in study.rungs if rung.outcome.histories])


def distances(study: StiffnessStudy) -> Figure:
    """Distance to the rigid value against stiffness, with the fitted rate and each case's numerical error."""
    with matplotlib.rc_context(STYLE):
        figure = blank(10.4, 5.2)
        study.plot(axes=figure.subplots(1, 2))
        return figure


FIGURES: dict[str, Callable[[StiffnessStudy], Figure | None]] = {
    "pulse": forces,
    "impulses": impulse_space,
    "distance": distances,
    "energy": energies,
}
"""The figures by the name of their file, in the order of the page."""
