"""The answer of a stiffness study in words, and how it was found."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from ...plots.sheet import number, power_of
from ...running.measures import MEASURES
from ..extrapolation.cases import FEWEST
from ..extrapolation.limits import CLEAR
from .rows import fixed

if TYPE_CHECKING:
    from rigid import Scene

    from ..extrapolation.limits import Limit
    from ..found import StiffnessStudy


_MEANING = {
    "impulse_ratio": "J_F/J_N (friction impulse over normal impulse, of the first whole pulse)",
    "friction_loss": "the friction loss (energy that sliding takes in it)",
}

_RAISED = {"both": "ring and floor are", "contact": "the floor is", "bending": "the ring is"}


def verdict(study: StiffnessStudy) -> str:
    """The answer in words, and in the numbers that it stands on."""
    tied = {name: study.limits[name] for name in _MEANING}
    inside = [limit.rigid_inside for limit in tied.values()]
    hoop = "the rigid one" if study.reference_mu_s == study.scene.friction.mu_s else "a rigid one"
    question = f"as {_RAISED[study.ladder.along]} made stiffer, the flexible hoop"
    if _too_soft(study):
        why = "these rungs are too soft to say, as a stick is not yet that of the limit"
        answer = f"Open: whether, {question} becomes {hoop}, {why}"
    elif any(limit.rigid_excluded for limit in tied.values()):
        answer = f"No: {question} does not become {hoop} within the uncertainty of its limit"
    elif not all(limit.extrapolated for limit in tied.values()):
        answer = f"Open: whether, {question} becomes {hoop}, too few rungs say"
    elif None in inside:
        answer = f"Open: whether, {question} becomes {hoop}, these rungs do not say"
    elif False in inside:
        answer = f"Open: whether, {question} becomes {hoop}, a smaller rtol or more rungs decide"
    elif _rings_on(study):
        answer = f"Open: whether, {question} becomes {hoop}, its rungs cannot show with an undamped contact"
    else:
        answer = f"Yes: {question} becomes {hoop}"
    told = [_told(study, name, limit) for name, limit in tied.items()]
    said = [f"{answer}: {'; '.join(told)}."]
    other = study.limits["normal_impulse"]
    if other.rigid_inside is False:
        off = number(abs(other.error) - other.uncertainty, 2)
        said.append(f"J_N (normal impulse) {_tends(study, 'normal_impulse', other)}, outside that interval by {off}.")
    if study.failures:
        said.append(f"{len(study.failures)} of {len(study.rungs)} cases failed.")
    return " ".join(said)


def _too_soft(study: StiffnessStudy) -> bool:
    """Whether the rungs are too few, or none, at which a stick on which the limit hangs is kept or lost as there."""
    stiff = [rung for rung in study.rungs_through if rung.contact_stiffness >= study.late]
    return study.late > 0 and len(stiff) < FEWEST


def _rings_on(study: StiffnessStudy) -> bool:
    """Whether a slip that begins or ends leaves the patch ringing as far at any stiffness."""
    return study.scene.contact.damping == 0 and set(study.reference.phases[0]) != {"roll"}


def _told(study: StiffnessStudy, name: str, limit: Limit) -> str:
    if not limit.extrapolated:
        last, rigid = (fixed(study, name, value, 5) for value in (study.rungs_through[-1].measure(name), limit.rigid))
        return (
            f"{_MEANING[name]} is {last}{_unit(study, name)} at the stiffest rung and {rigid} for the rigid hoop, "
            "too few rungs for an interval"
        )
    if limit.rigid_inside is None and limit.uncertainty <= limit.span:
        where = "inside that interval, but the stiffest rungs go away from it, by less than it is wide: a longer ladder"
    elif limit.rigid_inside is None:
        where = "but this interval is wider than all that was measured: a longer ladder or a smaller rtol"
    elif limit.rigid_inside:
        where = "inside that interval"
    elif limit.rigid_excluded:
        where = f"outside that interval, {number(limit.half_widths, 3)} of its half widths off"
    elif limit.half_widths > CLEAR:
        where = f"outside that interval, {number(limit.half_widths, 3)} of its half widths off, not of a fitted rate's"
    else:
        where = f"at the edge of that interval, {number(limit.half_widths, 3)} of its half widths off"
    return f"{_MEANING[name]} {_tends(study, name, limit)}, {where}"


def _tends(study: StiffnessStudy, name: str, limit: Limit) -> str:
    value, rigid = (fixed(study, name, value, 6) for value in (limit.value, limit.rigid))
    uncertainty = number(limit.uncertainty, 2)
    return f"tends to {value} ± {uncertainty}{_unit(study, name)}, and the rigid hoop has {rigid}"


def _unit(study: StiffnessStudy, name: str) -> str:
    unit = MEASURES[name].unit.label(study.scene)
    return f" {unit}" if unit else ""


def ladder_sentence(study: StiffnessStudy) -> str:
    """What was raised, from where to where, and what the friction law ties to it."""
    from flexible.contact.laws.listing import LAWS

    ladder, contacts = study.ladder, [rung.contact for rung in study.ladder.rungs(study.scene)]
    law = LAWS[study.scene.contact.law]
    names = law.stiffened(study.scene.contact, 1.0) if ladder.along != "bending" else {}
    tied = [
        f"contact.{name} goes with it, from {number(getattr(contacts[0], name), 3)} to "
        f"{number(getattr(contacts[-1], name), 3)}; "
        for name in names
    ]
    along = {"both": "Both stiffnesses are raised in the scene's ratio", "contact": "The floor alone is stiffened",
             "bending": "The ring alone is stiffened"}[ladder.along]  # fmt: skip
    low, high = ladder.stiffness[[0, -1]].tolist()
    return (
        f"{along}: {ladder.count} cases, the {ladder.label} from {number(low, 3)} to {number(high, 3)}; "
        f"{''.join(tied)}all else is as the scene below says."
    )


def notes(study: StiffnessStudy) -> list[str]:
    """Of rungs that have no result why, and of those whose run stopped behind its first pulse where."""
    raised, told = study.ladder.raised.capitalize(), []
    for rung in (r for r in study.rungs if r.outcome.failure or r.outcome.stopped):
        why = f"failed: {rung.outcome.failure}" if rung.outcome.failure else (
            f"did not end: {rung.outcome.stopped.rstrip('.')}. Its pulses before that are measured."
        )  # fmt: skip
        told.append(f"{raised} {number(rung.stiffness, 3)} {why}")
    return told


def extrapolation_sentence(study: StiffnessStudy) -> str:
    """How the limits were found."""
    found = {name: limit for name, limit in study.limits.items() if limit.extrapolated}
    if not found:
        return "Too few rungs: no limit was extrapolated."
    known = [limit for limit in found.values() if limit.known]
    others = [MEASURES[name].symbol for name, limit in found.items() if not limit.known]
    s = f"s the {study.ladder.label}"
    said = []
    if known:
        powers = " + ".join(
            f"c{i + 1} s^-{p:.3g}" + (" log s" if p in known[0].exponents[:i] else "")
            for i, p in enumerate(known[0].exponents)
        )
        holds = known[0].holds
        since = f" from the cases above {number(holds, 2)}" if holds > study.ladder.stiffness[0] else ""
        said.append(
            f"The limit is L in L + {powers} + ..., {s}, its exponents known and L and all c inferred{since} "
            "without knowing the rigid value. Its uncertainty ± holds what the terms not seen and the cases' numerical "
            "error may do."
        )
    if others:
        whose = f"That of {', '.join(others)}, of which too few cases are of one series," if known else "The limit"
        said.append(
            f"{whose} is L in L + c s^-p, {s}, fitted to the stiffest cases without knowing the rigid value, p for "
            "each measure. Its uncertainty ± covers the scatter about that fit, the choice of the fitted cases and "
            "their numerical error."
        )
    return " ".join(said)


def law_sentence(study: StiffnessStudy) -> str:
    """Which rigid hoop the limit is compared with, and why."""
    from flexible.contact.laws.listing import LAWS

    friction = study.scene.friction
    explained = LAWS[study.scene.contact.law].explanation(friction) + _wall_sentence(study.scene)
    if study.reference_mu_s == friction.mu_s:
        return explained
    ratio, loss = (fixed(study, name, study.rigid.pulses[0][name], 5) for name in ("impulse_ratio", "friction_loss"))
    return (
        f"{explained} The paper's law, mu_s = {friction.mu_s:g}, would give "
        f"J_F/J_N = {ratio} and a friction loss of {loss}{_unit(study, 'friction_loss')}."
    )


def damping_sentence(study: StiffnessStudy) -> str:
    """How the contact was damped, and what an undamped one does."""
    damping = study.scene.contact.damping
    # where nothing is predicted it is said here of which sticks the limit hangs
    more = "" if study.prediction is not None else _hanging_words(study)
    if damping > 0:
        return (
            f"The patch is damped, at {damping:g} of critical for the hoop that stands on it under its own weight; "
            f"under a larger load the ratio is larger, like N^(1/6).{more}"
        )
    return (
        "The contact is undamped: where slip ends or begins the normal force jumps, and the patch then rings "
        f"with an amplitude that no stiffness makes smaller, so the limit need not be the rigid hoop.{more}"
    )


def prediction_sentence(study: StiffnessStudy) -> str:
    """What is predicted without any of the cases, and what the cases show of that."""
    if study.prediction is None:
        return f"Nothing is predicted: {study.lost}" if study.lost else ""
    told = []
    for name in ("impulse_ratio", "friction_loss"):
        term = study.prediction.terms[name]
        powers = " ".join(f"{c:+.4g} {power_of('ε', p)}" for p, c in term.powers if c)
        if not powers:
            # one that slides one way throughout has J_F = mu J_N; J_N and the loss change at a higher order
            exact = name == "impulse_ratio" or study.scene.friction.mu_s == 0
            powers = "at any stiffness" if exact else "without a term of the order of ε"
        seen = study.coefficient(name)
        heading = MEASURES[name].heading(study.scene).replace("\n", " ")
        words = f"{heading} = {number(term.limit)} {powers}"
        if seen is not None and term.coefficient:
            beside = f"{seen.observed:.4g} ± {seen.uncertainty:.2g} observed, {seen.predicted:.4g} predicted"
            words += f" (at the stiffest case, over {power_of('ε', term.exponent)}: {beside})"
        told.append(words)
    said = f"Predicted without a fit, ε the foundation to the power −1/3: {'; '.join(told)}."
    if not study.prediction.complete:
        said += " This is the leading power alone; those behind it are the larger ones at any stiffness within reach."
    said += _hanging_words(study)
    if 0 < study.late == study.separate:
        which = f"below a foundation of {number(study.separate, 2)}" if isfinite(study.separate) else "as soft as these"
        said += f" Cases {which} are not described by it."
    elif not isfinite(study.separate):
        said += " A patch of so little damping does not come to rest between the events, and it holds at none of these."
    elif study.separate > study.ladder.stiffness[0]:
        said += (
            f" A series in powers of ε, of which this is the beginning, describes cases from a foundation of"
            f" {number(study.separate, 2)} on, where terms behind may still be the larger ones: at softer ones an event"
            " happens before the patch has come to rest from the one before it."
        )
    if study.otherwise:
        said += (
            f" It is of a rigid rim: below a foundation of {number(study.stiff, 2)} the ring gives way by more than the"
            f" patch that should damp it, and at {len(study.otherwise)} of these cases the contact does something else"
            " in the pulse than that of the rigid hoop, which it does not foresee."
        )
    return said


def _hanging_words(study: StiffnessStudy) -> str:
    from ...limit.summary import hanging_sentences

    # a ring that is not stiffened keeps its own distance
    limit = "the limit" if study.ladder.along == "both" else "the limit of a stiff ring on a stiff floor"
    return "".join(f" {said}" for said in hanging_sentences(study.hanging, study.scene.friction, limit=limit))


def _wall_sentence(scene: Scene) -> str:
    """Of a hoop that has a mass and no thickness, whose elastic ring has one: that they do not turn alike."""
    if scene.hoop.r > 1 or scene.hoop.mass_ratio == 0:
        return ""
    lacks = 100 * (1 - (1 + (1 - scene.wall) ** 2) / 2)
    return (
        f" The hoop has r = 1 and a mass: its elastic wall, {scene.wall:g} R thick, turns with {lacks:.2g} % less"
        " inertia than the rigid one without thickness, which no stiffness makes up; with r > 1 both have the wall."
    )
