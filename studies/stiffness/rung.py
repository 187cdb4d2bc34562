"""The flexible hoop at one stiffness of a study's ladder."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import Any

from ..running.case import Outcome
from ..running.measures import known


@dataclass(frozen=True, slots=True)
class Rung:
    """The flexible hoop at one stiffness.

    Attributes
    ----------
    bending_stiffness : float
        E I/(m g R^2).
    contact_stiffness : float
        Foundation, eps_n R^2/(m g).
    stiffness : float
        That of the two which the ladder raises.
    outcome : Outcome
        What the solver found there, or why it failed.
    """

    bending_stiffness: float
    contact_stiffness: float
    stiffness: float
    outcome: Outcome

    def measure(self, name: str, pulse: int = 0) -> float:
        """A measure of a pulse, NaN where there is no such pulse.

        Raises
        ------
        ValueError
            It is none of those that the study was made with.
        """
        pulses = self.outcome.pulses
        return known(pulses[pulse], name) if pulse < len(pulses) else nan

    def error(self, name: str, pulse: int = 0) -> float:
        """Numerical error of that measure, from its change when the tolerance was quartered."""
        errors = self.outcome.numerical_error
        return known(errors[pulse], name) if pulse < len(errors) else nan

    def to_dict(self) -> dict[str, Any]:
        """The rung as JSON prints it: the first pulse's measures at the top, all pulses below."""
        found = self.outcome
        stiffness = {"bending_stiffness": self.bending_stiffness, "contact_stiffness": self.contact_stiffness}
        if found.failure:
            return {**stiffness, "failure": found.failure}
        return {
            **stiffness,
            **found.pulses[0],
            "phases": found.phases[0],
            "numerical_error": found.numerical_error[0],
            "resolved": found.resolved,
            "rtol": found.rtol,
            "seconds": found.seconds,
            **({"stopped": found.stopped} if found.stopped else {}),
            "pulses": [{**pulse, "phases": phases} for pulse, phases in zip(found.pulses, found.phases, strict=True)],
        }
