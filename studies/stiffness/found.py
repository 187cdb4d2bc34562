"""What a stiffness study found, rung by rung and in the limit; a table, a picture and a few lines of it."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigid import Scene, scene_to_dict
from rigid.output import summary

from ..running.case import SAME, SHARE, Outcome
from ..running.history import records_to_csv
from ..running.measures import MEASURES, OF_THE_MEASURE, known, units_of_measures
from .coefficient import Coefficient, coefficient
from .errors import errors_of
from .extrapolation.limits import CONFIDENCE, Limit, fitted_series
from .ladder import Ladder
from .rung import Rung

if TYPE_CHECKING:
    import pandas

    from ..inner.stops.hanging import Hanging
    from ..limit.prediction import Prediction
    from ..plots.distance import Distance

LIMITS = ("impulse_ratio", "friction_loss", "normal_impulse")
"""Measures whose limit is sought."""

_OF_MEASURES = ("value", "uncertainty", "rigid", "error", "last_distance", "limit", "coefficient", "observed")
_RATES = ("rate", "rate_interval", "exponent", "exponents")
_OF_STOPS = ("force_ratio", "critical_damping", "other_impulse_ratio", "holds")
_OF_SCENE = ("bending_stiffness", "contact_stiffness", "low", "high", "count", "separate", "stiff", "mu_s", "rtol")
_PURE = (*_OF_SCENE, *_RATES, *_OF_STOPS)


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class StiffnessStudy(summary.Summarised):
    """What the study found, rung by rung and in the limit.

    Attributes
    ----------
    scene : Scene
        The scene, at its own stiffness.
    ladder : Ladder
        What was raised, over which range.
    solver : str
        Who ran the rungs.
    rigid : Outcome
        The rigid hoop of the scene: the paper's law.
    reference : Outcome
        The rigid hoop that the contact law should tend to; another than ``rigid`` for some laws where mu_s > mu.
    reference_mu_s : float
        That hoop's static coefficient.
    rungs : tuple of Rung
        The flexible hoop, softest first.
    limits : dict of str to Limit
        Of "impulse_ratio", "friction_loss" and "normal_impulse" of the first pulse.
    prediction : Prediction or None
        The approach to the limit as the rigid motion alone foresees it; None where it is not that of these cases:
        unless both stiffnesses are raised with the patch damped and run by the flexible solver, where the approach is
        told by more than the foundation (the regularised law), and where the pulse has more in it than rolling and
        sliding.
    separate : float
        Foundation from which on the prediction, and any series in powers of it, holds: each event is over before the
        next one comes, and a stick on which the limit hangs is kept or lost as there.
    late : float
        The part of ``hanging`` in that; 0 where there is none.
    stiff : float
        That from which on the ring gives way by less than the patch where a slip ends or turns round; on softer ones it
        may break a stick that the prediction's rigid rim keeps, or leave the floor. 0 too where no case does otherwise.
    hanging : tuple of Hanging
        Stops of the pulse behind which a patch that breaks slides on at any stiffness, so that the limit may be another
        than ``reference``, whose stick is kept.
    lost : str
        Why there is no prediction where one was begun: something in a layer is too fast for it to be followed.
    """

    scene: Scene
    ladder: Ladder
    solver: str
    rigid: Outcome
    reference: Outcome
    reference_mu_s: float
    rungs: tuple[Rung, ...]
    limits: dict[str, Limit]
    prediction: Prediction | None = None
    separate: float = 0.0
    late: float = 0.0
    stiff: float = 0.0
    hanging: tuple[Hanging, ...] = ()
    lost: str = ""

    @property
    def failures(self) -> list[Rung]:
        """The rungs without a result."""
        return [rung for rung in self.rungs if rung.outcome.failure]

    @property
    def stopped(self) -> list[Rung]:
        """Those whose run stopped behind the pulses that are measured."""
        return [rung for rung in self.rungs if rung.outcome.stopped]

    @property
    def otherwise(self) -> list[Rung]:
        """Those whose ring gives way by more than the patch, and whose contact does otherwise than the rigid hoop's."""
        own = self.reference.phases[0]
        return [r for r in self.rungs_through if r.contact_stiffness < self.stiff and r.outcome.phases[0] != own]

    @property
    def rungs_through(self) -> list[Rung]:
        """The rungs that have one."""
        return [rung for rung in self.rungs if not rung.outcome.failure]

    def expected(self, name: str, contact_stiffness: float) -> float:
        """Distance to its limit that is predicted at a foundation; 0 where none is."""
        if self.prediction is None or not self.prediction.complete or contact_stiffness < self.separate:
            return 0.0
        term = self.prediction.terms[name]
        return abs(float(term.at(contact_stiffness ** (-1 / 3))) - term.limit)

    def loose(self, rung: Rung) -> tuple[str, ...]:
        """Measures of a rung whose numerical error is more than its share of the distance, found or predicted."""
        if rung.outcome.resolved or rung.outcome.failure:
            return ()
        distances = {
            name: max(abs(rung.measure(name) - self.limits[name].rigid), self.expected(name, rung.contact_stiffness))
            for name in LIMITS[:2]
        }
        least = {name: SAME * MEASURES[name].unit.of(self.scene) for name in distances}
        loose = (name for name, away in distances.items() if away > least[name] and rung.error(name) > SHARE * away)
        return tuple(loose) or LIMITS[:2]

    def coefficient(self, name: str) -> Coefficient | None:
        """How fast a measure comes to its limit, observed and predicted; None where only the leading one of the powers
        down to the creep's is predicted, and with too few rungs through."""
        if self.prediction is None or not self.prediction.complete:
            return None
        rungs = [rung for rung in self.rungs_through if rung.contact_stiffness >= self.separate]
        foundation, values = np.array([[rung.contact_stiffness, rung.measure(name)] for rung in rungs]).reshape(-1, 2).T
        errors = errors_of(rungs, name, self.scene)
        return coefficient(self.prediction.terms[name], foundation, values, errors, self.prediction.rates)

    def distance(self, name: str) -> Distance:
        """How far a measure of the rungs that came through is from the rigid value, for a picture."""
        from ..plots.distance import Distance

        limit, through = known(self.limits, name), self.rungs_through
        unit = MEASURES[name].unit.of(self.scene)
        stiffness = np.array([rung.stiffness for rung in through])
        values, errors = (np.array([of(rung, name) for rung in through]) for of in (Rung.measure, Rung.error))
        series = fitted_series(limit, stiffness, values, errors_of(through, name, self.scene))
        predicted = None
        softest, stiffest = max(through[0].contact_stiffness, self.separate), through[-1].contact_stiffness
        if self.prediction is not None and self.prediction.complete and softest < stiffest:
            foundation = np.geomspace(softest, stiffest, 60)
            term = self.prediction.terms[name]
            away = abs(term.at(foundation ** (-1 / 3)) - limit.rigid) / unit
            if away.any():
                predicted = foundation * stiffness[0] / through[0].contact_stiffness, away
        return Distance(
            stiffness,
            (values - limit.rigid) / unit,
            errors / unit,
            limit.rate,
            limit.rate_interval,
            f"{CONFIDENCE:.0%}",
            limit.rate_cases,
            None if series is None else (series[0], (series[1] - limit.rigid) / unit),
            predicted,
            self.ladder.formula,
        )

    def plot(self, *names: str, axes: Any = None) -> NDArray[np.object_]:
        """Distance to the rigid value over stiffness, a panel for each measure: impulse ratio and friction loss if none
        is named.

        Parameters
        ----------
        *names : str
            Of ``limits``.
        axes : matplotlib Axes or sequence of them, optional
            Where to draw; by default a new figure.

        Returns
        -------
        (n,) array of matplotlib Axes
        """
        from ..plots.distance import draw

        return draw({name: self.distance(name) for name in names or LIMITS[:2]}, axes)

    @property
    def units(self) -> dict[str, str]:
        """What the numbers of records and JSON are measured in, by name."""
        told = dict.fromkeys((*_OF_MEASURES, "predicted"), OF_THE_MEASURE) | dict.fromkeys(_PURE, "1")
        return {**told, **units_of_measures(self.scene), "seconds": "s"}

    def records(self) -> list[dict[str, Any]]:
        """A flat record for each rung: its stiffness, the first pulse's measures, or why there are none."""
        nothing: dict[str, float] = dict.fromkeys(self.reference.pulses[0], nan)
        return [
            {
                "bending_stiffness": rung.bending_stiffness,
                "contact_stiffness": rung.contact_stiffness,
                **nothing,
                **(rung.outcome.pulses[0] if rung.outcome.pulses else {}),
                "failure": rung.outcome.failure,
            }
            for rung in self.rungs
        ]

    def to_dataframe(self) -> pandas.DataFrame:
        """The records as a pandas data frame."""
        import pandas

        return pandas.DataFrame.from_records(self.records())

    def to_csv(self) -> str:
        """The records as text, numbers to the last bit."""
        told = [{name: "" if value != value else value for name, value in each.items()} for each in self.records()]
        return records_to_csv(told)  # NaN is empty

    def _table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        rows = [
            (f"{r.contact_stiffness:.3g}", f"{r.bending_stiffness:.3g}", *(f"{r.measure(name):.6g}" for name in LIMITS))
            for r in self.rungs
        ]
        return ("foundation", "E I/(m g R^2)", *LIMITS), rows

    def _title(self) -> str:
        return f"Stiffness study: {len(self.rungs)} rungs, {len(self.failures)} failed"

    def _lines(self) -> list[summary.Line]:
        lines = []
        for name, limit in self.limits.items():
            told = f"{limit.value:.6g} ± {limit.uncertainty:.2g} in the limit" if limit.extrapolated else "no limit"
            lines.append((name, f"{told}, {limit.rigid:.6g} of the rigid hoop"))
        return lines

    def to_dict(self) -> dict[str, Any]:
        """The study as JSON prints it, but for NaN and infinity, which are null there."""
        return {
            "scene": scene_to_dict(self.scene),
            "ladder": {
                "along": self.ladder.along,
                "low": self.ladder.low,
                "high": self.ladder.high,
                "count": self.ladder.count,
            },
            "solver": self.solver,
            "rigid": {**self.rigid.pulses[0], "phases": self.rigid.phases[0]},
            "reference": {
                "mu_s": self.reference_mu_s,
                **self.reference.pulses[0],
                "phases": self.reference.phases[0],
            },
            "cases": [rung.to_dict() for rung in self.rungs],
            "limit": {name: limit.to_dict() for name, limit in self.limits.items()},
            "prediction": self._foreseen(),
            "hanging": [stop.to_dict() for stop in self.hanging],
        }

    def _foreseen(self) -> dict[str, Any] | None:
        if self.prediction is None:
            return None
        told = {}
        for name in LIMITS:
            seen = self.coefficient(name)
            told[name] = self.prediction.terms[name].to_dict() | ({} if seen is None else seen._asdict())
        return {"complete": self.prediction.complete, "separate": self.separate, "stiff": self.stiff} | told
