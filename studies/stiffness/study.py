"""Does the compliant hoop become the paper's hoop as its stiffness grows, and how fast?

Method. (1) The rigid hoop gives the pulse, and the measures that the limit should have. (2) The flexible hoop
goes through the same pulse on every rung of a ladder of stiffness, each at a tolerance that keeps its numerical
error below a tenth of its distance from those measures, shown by a second run at half the tolerance. (3) The
rate of the distance is fitted, and the cases are extrapolated to infinite stiffness without knowing the rigid
value, by the law's own exponents where theory has them; then the two are compared. (4) Beside the cases stands
what :mod:`studies.limit` predicts of them from the rigid motion and the contact law alone.

The solvers are known here only by what every motion has: its pulses and their measures.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rigid import Run, Scene, scene_to_dict

from ..running.case import Case, Outcome
from ..running.files import StudyError
from ..running.runs import run_cases
from ..running.workers import Here, Pool
from .coefficient import Coefficient, coefficient
from .ladder import Ladder
from .limits import Limit, limit_of

if TYPE_CHECKING:
    from ..limit.prediction import Prediction

LIMITS = ("impulse_ratio", "friction_loss", "normal_impulse")
"""Measures whose limit is sought."""

TIED = ("impulse_ratio", "friction_loss")
"""Measures whose distance from the rigid value sets a case's tolerance."""


@dataclass(frozen=True, slots=True)
class Rung:
    """The flexible hoop at one stiffness."""

    bending_stiffness: float
    """E I/(m g R^2)."""
    contact_stiffness: float
    """Foundation, eps_n R^2/(m g)."""
    stiffness: float
    """That of the two which the ladder raises."""
    outcome: Outcome
    """What the solver found there, or why it failed."""

    def measure(self, name: str, pulse: int = 0) -> float:
        """A measure of a pulse, NaN where there is none."""
        pulses = self.outcome.pulses
        return pulses[pulse][name] if pulse < len(pulses) else nan

    def error(self, name: str, pulse: int = 0) -> float:
        """Numerical error of that measure, from its change when the tolerance was halved."""
        errors = self.outcome.numerical_error
        return errors[pulse][name] if pulse < len(errors) else nan

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
            "pulses": [{**pulse, "phases": phases} for pulse, phases in zip(found.pulses, found.phases, strict=True)],
        }


@dataclass(frozen=True, slots=True)
class StiffnessStudy:
    """What the study found."""

    scene: Scene
    """The scene, at its own stiffness."""
    ladder: Ladder
    """What was raised, over which range."""
    solver: str
    """Who ran the rungs."""
    rigid: Outcome
    """The rigid hoop of the scene: the paper's law."""
    reference: Outcome
    """The rigid hoop that the contact law is expected to tend to; another than ``rigid`` for some laws where
    mu_s > mu."""
    reference_mu_s: float
    """That hoop's static coefficient."""
    rungs: tuple[Rung, ...]
    """The flexible hoop, softest first."""
    limits: dict[str, Limit]
    """Limit of each measure in ``LIMITS``, first pulse."""
    prediction: Prediction | None = None
    """The approach to the limit as the rigid motion alone foresees it; None where it is not that of these cases: unless
    both stiffnesses are raised with the patch damped and run by the flexible solver, where the approach is told by more
    than the foundation (the regularised law), and where the pulse has more in it than rolling and sliding."""
    separate: float = 0.0
    """Foundation from which on the prediction, and any series in powers of it, holds: each event is over before the
    next one comes."""

    @property
    def failures(self) -> list[Rung]:
        """The rungs that have no result."""
        return [rung for rung in self.rungs if rung.outcome.failure]

    @property
    def rungs_through(self) -> list[Rung]:
        """The rungs that have one."""
        return [rung for rung in self.rungs if not rung.outcome.failure]

    def coefficient(self, name: str) -> Coefficient | None:
        """How fast a measure comes to its limit, observed and predicted; None where only the leading one of the powers
        down to the creep's is predicted, and with too few rungs through."""
        if self.prediction is None or not self.prediction.complete:
            return None
        rungs = [rung for rung in self.rungs_through if rung.contact_stiffness >= self.separate]
        foundation, values, errors = (
            np.array(column)
            for column in (
                [rung.contact_stiffness for rung in rungs],
                [rung.measure(name) for rung in rungs],
                [rung.error(name) for rung in rungs],
            )
        )
        return coefficient(self.prediction.terms[name], foundation, values, errors, self.prediction.rates)

    def to_dict(self) -> dict[str, Any]:
        """The study as JSON prints it."""
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
            "limit": {name: _limit_to_dict(limit) for name, limit in self.limits.items()},
            "prediction": self._foreseen(),
        }

    def _foreseen(self) -> dict[str, Any] | None:
        if self.prediction is None:
            return None
        told = {}
        for name in LIMITS:
            seen = self.coefficient(name)
            told[name] = self.prediction.terms[name].to_dict() | ({} if seen is None else seen._asdict())
        return {"complete": self.prediction.complete, "separate": self.separate, **told}


def _limit_to_dict(limit: Limit) -> dict[str, Any]:
    return {
        "value": limit.value,
        "uncertainty": limit.uncertainty,
        "rate": limit.rate,
        "rate_interval": list(limit.rate_interval),
        "exponents": list(limit.exponents),
        "exponents_known": limit.known,
        "rigid": limit.rigid,
        "error": limit.error,
        "rigid_inside": limit.rigid_inside,
        "last_distance": limit.distance,
    }


def stiffness_study(
    scene: Scene,
    ladder: Ladder | None = None,
    *,
    solver: str = "flexible",
    all_pulses: bool = False,
    exponent: float | None = None,
    pool: Pool | None = None,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
) -> StiffnessStudy:
    """Run the study.

    Parameters
    ----------
    scene : Scene
        What is studied; the ladder varies its stiffness. Its ``contact.damping`` should not be 0: the normal force
        jumps where slip ends or begins, and an undamped patch rings about it with an amplitude that does not
        fall with stiffness: it lifts off, slips early, and tends to another limit than the rigid hoop.
    ladder : Ladder, optional
        By default nine rungs over six decades of both stiffnesses.
    solver : str
        Who runs the rungs: "flexible" or ``module:function``.
    all_pulses : bool
        Go through all pulses of the scene's run instead of the first alone; the limit is that of the first.
    exponent : float, optional
        Rate of the extrapolation, in place of the contact law's own, or of the fitted one where it has none: with
        another solver than "flexible", along "bending" or "contact" alone, undamped, or with a pulse that rolling and
        sliding do not cover.
    pool : Pool, optional
        Where the rungs run; by default here.
    out : path, optional
        A folder in which finished rungs are kept and found again.
    progress : callable, optional
        Told the fraction done.

    Raises
    ------
    StudyError
        The rigid hoop has no pulse to study, or too few rungs came through to speak of a limit.
    """
    from flexible import rigid_limit

    ladder = ladder or Ladder.around(scene)
    pool = pool or Here()
    if not all_pulses:
        scene = scene.replace(run=Run(until="pulse"))

    # 1. the rigid hoop, and the one that the contact law should tend to
    tended = rigid_limit(scene)
    rigid, reference = run_cases([Case("rigid", hoop, histories=True) for hoop in (scene, tended)], Here())
    for outcome in (rigid, reference):
        if outcome.failure or not outcome.pulses:
            raise StudyError(f"The rigid hoop has no pulse to study here: {outcome.failure or outcome.ended}.")

    # 2. what is foreseen of the rungs
    foreseen, separate = _prediction(scene, ladder, solver)

    # 3. the flexible hoop on every rung, as finely as its distance from the rigid one asks for
    scenes = ladder.rungs(scene)
    pulse = reference.pulses[0]
    cases = [Case(solver, rung, _against(rung, pulse, foreseen, separate), histories=True) for rung in scenes]
    outcomes = run_cases(cases, pool, out, progress)
    rungs = tuple(
        Rung(rung.ring.bending_stiffness, rung.contact.stiffness, stiffness, outcome)
        for rung, stiffness, outcome in zip(scenes, ladder.stiffness.tolist(), outcomes, strict=True)
    )

    # 4. rate and limit of the first pulse's measures over the rungs that came through
    through = [rung for rung in rungs if not rung.outcome.failure]
    if not through:
        raise StudyError(f"No rung of the ladder came through; the stiffest says: {rungs[-1].outcome.failure}.")
    rates: tuple[float, ...] | None = None if exponent is None else (exponent,)
    holds = 0.0
    # of a ring with a mass the vibrations of the ring itself come between: its rate is fitted
    if rates is None and foreseen is not None and scene.hoop.mass_ratio == 0:
        rates, holds = foreseen.rates, separate
    limits = {}
    for name in LIMITS:
        values, errors = [r.measure(name) for r in through], [r.error(name) for r in through]
        limits[name] = limit_of([r.stiffness for r in through], values, pulse[name], errors, rates, holds)
    if foreseen is not None and foreseen.parameter != "eps":
        foreseen = None  # it is told by the foundation alone
    return StiffnessStudy(
        scene, ladder, solver, rigid, reference, tended.friction.mu_s, rungs, limits, foreseen, separate
    )


def _against(
    rung: Scene, rigid: Mapping[str, float], foreseen: Prediction | None, separate: float
) -> tuple[tuple[str, float, float], ...]:
    """What a rung is compared with, and the distance from that to expect of it."""
    tied = []
    for name in TIED:
        expected = 0.0
        if foreseen is not None and foreseen.complete and rung.contact.stiffness >= separate:
            term = foreseen.terms[name]
            expected = abs(float(term.at(rung.contact.stiffness ** (-1 / 3))) - term.limit)
        tied.append((name, rigid[name], expected))
    return tuple(tied)


def _prediction(scene: Scene, ladder: Ladder, solver: str) -> tuple[Prediction | None, float]:
    """The prediction, where it is that of the cases, and the foundation from which on it holds."""
    from ..inner.events import passage
    from ..inner.separate import separate_from
    from ..limit.prediction import predict

    # a ring that is not stiffened keeps its own distance, an undamped patch rings at any stiffness
    if ladder.along != "both" or solver != "flexible" or scene.contact.damping == 0:
        return None, 0.0
    try:
        return predict(scene), separate_from(passage(scene))
    except StudyError:
        return None, 0.0
