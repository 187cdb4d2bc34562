"""Does the compliant hoop become the paper's hoop as its stiffness grows, and how fast?

Method. (1) The rigid hoop gives the pulse, and the measures that the limit should have. (2) :mod:`studies.limit`
predicts the approach from the rigid motion and the contact law alone. (3) The flexible hoop goes through the same pulse
on every rung of a ladder of stiffness, each at a tolerance that keeps its numerical error below a tenth of its distance
from those measures, or of the predicted one where that is more, shown by a second run at a quarter of the tolerance.
(4) The rate of the distance is fitted, and the cases are extrapolated to infinite stiffness without knowing the rigid
value, by the law's own exponents where theory has them; then the two are compared.

The solvers are known here only by what every motion has: its pulses and their measures.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from rigid import Run, Scene, SceneLike, as_scene
from rigid.allowed import require

from ..running.case import Case
from ..running.files import StudyError
from ..running.runs import run_cases
from ..running.solvers import ensure_accepts
from ..running.workers import Here, Pool, as_pool
from .errors import errors_of
from .extrapolation.limits import Limit, limit_of
from .found import LIMITS, StiffnessStudy
from .ladder import Ladder
from .rung import Rung

if TYPE_CHECKING:
    from ..inner.stops.hanging import Hanging
    from ..limit.prediction import Prediction

TIED = ("impulse_ratio", "friction_loss")
"""Measures whose distance from the rigid value sets a case's tolerance."""


def stiffness_study(
    scene: SceneLike,
    ladder: Ladder | None = None,
    *,
    solver: str = "flexible",
    all_pulses: bool = False,
    rate: float | None = None,
    pool: Pool | None = None,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
) -> StiffnessStudy:
    """Run the study.

    Parameters
    ----------
    scene : Scene, str, path or dict
        What is studied, or what says which (see :func:`rigid.simulate`); the ladder varies its stiffness. Its
        ``contact.damping`` should not be 0: the normal force jumps where slip ends or begins, and an undamped patch
        rings about it with an amplitude that does not fall with stiffness: it lifts off, slips early, and tends to
        another limit than the rigid hoop.
    ladder : Ladder, optional
        By default, ``Ladder()``, nine rungs over six decades of both stiffnesses.
    solver : str
        Who runs the rungs: "flexible" or ``module:function``.
    all_pulses : bool
        Go through all pulses of the scene's run instead of the first alone; the limit is that of the first. Of a run
        that stops on the way the pulses before that count.
    rate : float, optional
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
    SceneError
        What is no rate.
    StudyError
        No ladder, no pool, no such solver, a rigid hoop without a pulse to study, or no rung that came through. Of too
        few rungs a limit is NaN: a rate that is fitted takes five, known ones four, and two more than they are.
    """
    from flexible import rigid_limit

    from ..inner.separate import stiff_from
    from ..inner.stops.hanging import followed

    if rate is not None:
        rate = require("rate", rate, 0, inf, "a rate is above 0", open_low=True)
    scene = as_scene(scene)
    if not isinstance(ladder, Ladder | None):
        raise StudyError(f"ladder = {ladder!r} is not possible: it is a studies.Ladder.")
    ladder = (ladder or Ladder()).around(scene)
    ensure_accepts(solver, ladder.rungs(scene)[0])
    pool = as_pool(pool)
    if not all_pulses:
        scene = scene.replace(run=Run(until="pulse"))

    # 1. the rigid hoop, and the one that the contact law should tend to
    tended = rigid_limit(scene)
    rigid, reference = run_cases([Case("rigid", hoop, histories=True) for hoop in (scene, tended)], Here())
    for outcome in (rigid, reference):
        if outcome.failure or not outcome.pulses:
            raise StudyError(f"The rigid hoop has no pulse to study here: {outcome.failure or outcome.ended}.")

    # 2. what is foreseen of the rungs
    foreseen, separate, lost = _prediction(scene, ladder, solver)
    hangs = _hanging(scene, solver)
    late = 0.0 if foreseen is None else max([stop.holds for stop in hangs], default=0.0)
    separate = max(separate, late)

    import scipy.optimize  # noqa: F401  what the limits take, while other processes are still loading what cases take

    # 3. the flexible hoop on every rung, as finely as its distance from the rigid one asks for
    scenes = ladder.rungs(scene)
    pulse = reference.pulses[0]
    cases = [
        # of a run that stops behind the first pulse that one is a result
        Case(solver, rung, _against(rung, pulse, foreseen, separate), histories=True, cut=all_pulses)
        for rung in scenes
    ]
    outcomes = run_cases(cases[::-1], pool, out, progress)[::-1]  # the stiffest, which takes longest, first
    rungs = tuple(
        Rung(rung.ring.bending_stiffness, rung.contact.stiffness, stiffness, outcome)
        for rung, stiffness, outcome in zip(scenes, ladder.stiffness.tolist(), outcomes, strict=True)
    )

    if foreseen is not None and (above := _above_otherwise(foreseen, hangs, rungs)) > separate:
        separate = late = above

    # 4. rate and limit of the first pulse's measures over the rungs that came through
    through = [rung for rung in rungs if not rung.outcome.failure]
    if not through:
        raise StudyError(
            f"No rung of the ladder came through; the stiffest says: {rungs[-1].outcome.failure.rstrip('.')}."
        )
    rates: tuple[float, ...] | None = None if rate is None else (rate,)
    limits = _limits(scene, through, pulse, foreseen, rates, separate)
    stiff = 0.0
    # one that slides on does otherwise at any stiffness
    kept = foreseen is not None and not any(stop.broken for stop in hangs)
    if kept and any(rung.outcome.phases[0] != reference.phases[0] for rung in through):
        stiff = stiff_from(followed(scene), scenes[0])
    if foreseen is not None and foreseen.parameter != "eps":
        foreseen = None  # it is told by the foundation alone
    return StiffnessStudy(
        scene, ladder, solver, rigid, reference, tended.friction.mu_s, rungs, limits, foreseen,
        separate, late, stiff, hangs, lost,
    )  # fmt: skip


def _against(
    rung: Scene, rigid: Mapping[str, float], foreseen: Prediction | None, separate: float
) -> tuple[tuple[str, float, float], ...]:
    """What a rung is compared with, and the distance from that to expect of it.

    Where a stick breaks the limit is another than the rigid value, and only the distance to that limit is small: a
    rung that is near the rigid hoop, since its steps are too long to see the stick break, is refined until it does.
    """
    tied = []
    for name in TIED:
        expected = 0.0
        if foreseen is not None and foreseen.complete and rung.contact.stiffness >= separate:
            term = foreseen.terms[name]
            expected = abs(float(term.at(rung.contact.stiffness ** (-1 / 3))) - term.limit)
        tied.append((name, rigid[name], expected))
    return tuple(tied)


def _prediction(scene: Scene, ladder: Ladder, solver: str) -> tuple[Prediction | None, float, str]:
    """The prediction, where it is that of the cases, the foundation from which on it holds, and why it was lost."""
    from ..inner.layers import TooLongError
    from ..inner.separate import separate_from
    from ..inner.stops.hanging import followed
    from ..limit.prediction import predict

    # a ring that is not stiffened keeps its own distance, an undamped patch rings at any stiffness
    if ladder.along != "both" or solver != "flexible" or scene.contact.damping == 0:
        return None, 0.0, ""
    try:
        return predict(scene), separate_from(followed(scene)), ""
    except TooLongError as error:
        return None, 0.0, str(error)
    except StudyError:  # the pulse has more in it than rolling and sliding
        return None, 0.0, ""


def _hanging(scene: Scene, solver: str) -> tuple[Hanging, ...]:
    """Stops on whose sticks the limit of the cases hangs, whether it is predicted or not."""
    from ..inner.stops.hanging import followed, hanging

    if solver != "flexible":
        return ()
    try:
        return hanging(scene, followed(scene))
    except StudyError:
        return ()


def _above_otherwise(foreseen: Prediction, hangs: Sequence[Hanging], rungs: Sequence[Rung]) -> float:
    """Foundation of the next rung above those whose pulses are nearer to the hoop that does otherwise at such a stop
    than to what is foreseen of them; 0 where none is. They are the softest: what a stiffer one does that its softer
    neighbour does not is not for its being too soft."""
    term, least = foreseen.terms["impulse_ratio"], 0.0
    step = rungs[1].contact_stiffness / rungs[0].contact_stiffness
    for rung in rungs:
        expected, ratio = float(term.at(rung.contact_stiffness ** (-1 / 3))), rung.measure("impulse_ratio")
        if not any(stop.is_otherwise(ratio, expected) for stop in hangs):
            break
        least = rung.contact_stiffness * step
    return least


def _limits(
    scene: Scene,
    through: Sequence[Rung],
    pulse: Mapping[str, float],
    foreseen: Prediction | None,
    rates: tuple[float, ...] | None,
    separate: float,
) -> dict[str, Limit]:
    """Limits of the measures of a pulse, by ``rates`` if they are given."""
    holds = 0.0
    # of a ring with a mass the vibrations of the ring itself come between: its rate is fitted
    if rates is None and foreseen is not None and scene.hoop.mass_ratio == 0:
        rates, holds = foreseen.rates, separate
    limits = {}
    for name in LIMITS:
        values, errors = [r.measure(name) for r in through], errors_of(through, name, scene)
        limits[name] = limit_of([r.stiffness for r in through], values, pulse[name], errors, rates, holds)
    return limits
