"""The figures of a stiffness study: its pulse at several stiffnesses, and how far it is from the rigid one."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from rigid import simulate

from ..plots.difference import at_the_same_angle, at_the_same_normal_impulse, impulses_along
from ..plots.pulse import Curve, energy, impulses, pulse
from ..plots.style import RIGID, STYLE, blank, colours, power_of_ten
from ..running.history import dimensionless
from .found import Rung, StiffnessStudy


def of_study(study: StiffnessStudy) -> dict[str, Figure]:
    """All figures of a stiffness study by name."""
    rungs = chosen(study.rungs)
    through = [dimensionless(rung.outcome.histories[0], study.scene) for rung in rungs]
    curves: list[Curve] = [
        (power_of_ten(rung.contact_stiffness), columns, colour)
        for rung, columns, colour in zip(rungs, through, colours(len(rungs)), strict=True)
    ]
    curves.append(("rigid", dimensionless(study.reference.histories[0], study.scene), RIGID))
    motion = simulate(study.reference.scene)
    whole = next(pulse for pulse in motion.pulses if not pulse.cut)
    own = [rung.outcome.histories[0] for rung in rungs]
    forces = [dimensionless(at_the_same_angle(columns, motion, whole), study.scene) for columns in own]
    unit = study.scene.impulse_unit
    along = impulses_along(motion, whole)
    friction = [at_the_same_normal_impulse(columns, along) / unit for columns in own]
    mu = study.scene.friction.mu
    drawn = {
        "pulse": pulse(curves, "Through the first pulse", forces),
        "impulses": impulses(curves, mu, friction),
        "distance": distances(study),
    }
    if rungs:
        middle = len(rungs) // 2
        words = f"Where the energy is, foundation {power_of_ten(rungs[middle].contact_stiffness)}"
        if (ledger := energy(through[middle], words)) is not None:
            drawn["energy"] = ledger
    return drawn


def chosen(rungs: Sequence[Rung], most: int = 5) -> list[Rung]:
    """At most so many rungs, evenly over those that came through with histories."""
    through = [rung for rung in rungs if rung.outcome.histories]
    if len(through) <= most:
        return through
    return [through[round(i)] for i in np.linspace(0, len(through) - 1, most)]


def distances(study: StiffnessStudy) -> Figure:
    """Distance to the rigid value against stiffness, with the fitted rate and each case's numerical error."""
    with matplotlib.rc_context(STYLE):
        figure = blank(10.4, 5.2)
        study.plot(axes=figure.subplots(1, 2))
        return figure
