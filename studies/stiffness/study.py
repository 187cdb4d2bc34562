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

from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid import Run, Scene, scene_to_dict

from ..running.case import Case, Outcome
from ..running.files import StudyError
from ..running.runs import run_cases
from ..running.workers import Here, Pool
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
    """The approach to the limit as the rigid motion alone foresees it; None where the foundation is not raised, and
    where the pulse has more in it than that covers."""

    @property
    def failures(self) -> list[Rung]:
        """The rungs that have no result."""
        return [rung for rung in self.rungs if rung.outcome.failure]

    @property
    def rungs_through(self) -> list[Rung]:
        """The rungs that have one."""
        return [rung for rung in self.rungs if not rung.outcome.failure]

    def coefficients(self, name: str) -> tuple[float, float, float] | None:
        """(observed, predicted, numerical error) of a distance over its leading power; the stiffest rung resolved."""
        resolved = [rung for rung in self.rungs_through if rung.outcome.resolved]
        if self.prediction is None or not resolved:
            return None
        term, rung = self.prediction.terms[name], resolved[-1]
        small = rung.contact_stiffness ** (-1 / 3)
        scale = small**term.exponent
        off, foreseen = rung.measure(name) - term.limit, float(term.at(small)) - term.limit
        return off / scale, foreseen / scale, rung.error(name) / scale

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
            seen = self.coefficients(name)
            told[name] = self.prediction.terms[name].to_dict() | (
                {} if seen is None else dict(zip(("observed", "predicted", "numerical_error"), seen, strict=True))
            )
        return {"complete": self.prediction.complete, **told}


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

    # 2. the flexible hoop on every rung, as finely as its distance from the rigid one asks for
    against = tuple((name, reference.pulses[0][name]) for name in TIED)
    scenes = ladder.rungs(scene)
    outcomes = run_cases([Case(solver, rung, against, histories=True) for rung in scenes], pool, out, progress)
    rungs = tuple(
        Rung(rung.ring.bending_stiffness, rung.contact.stiffness, stiffness, outcome)
        for rung, stiffness, outcome in zip(scenes, ladder.stiffness.tolist(), outcomes, strict=True)
    )

    # 3. rate and limit of the first pulse's measures over the rungs that came through
    through = [rung for rung in rungs if not rung.outcome.failure]
    if not through:
        raise StudyError(f"No rung of the ladder came through; the stiffest says: {rungs[-1].outcome.failure}.")
    foreseen = _prediction(scene, ladder)
    rates: tuple[float, ...] | None = None if exponent is None else (exponent,)
    # of a ring with a mass the vibrations of the ring itself come between: its rate is fitted
    stiffened = ladder.along == "both" and solver == "flexible" and scene.hoop.mass_ratio == 0
    known = foreseen is not None and stiffened and scene.contact.damping > 0
    if rates is None and foreseen is not None and known:
        rates = foreseen.rates
    limits = {}
    for name in LIMITS:
        values, errors = [r.measure(name) for r in through], [r.error(name) for r in through]
        limits[name] = limit_of([r.stiffness for r in through], values, reference.pulses[0][name], errors, rates)
    if foreseen is not None and foreseen.parameter != "eps":
        foreseen = None  # it is told by the foundation alone
    return StiffnessStudy(scene, ladder, solver, rigid, reference, tended.friction.mu_s, rungs, limits, foreseen)


def _prediction(scene: Scene, ladder: Ladder) -> Prediction | None:
    """Of a rigid ring, or one that is stiffened with its foundation."""
    from ..limit.prediction import predict

    if ladder.along == "bending":
        return None
    try:
        return predict(scene)
    except StudyError:
        return None
