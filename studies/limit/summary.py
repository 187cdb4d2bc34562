"""What is told of the limit, in rows and sentences; the screen and the page print the same."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, inf, isfinite
from typing import Any

from rigid import Friction

from ..inner.stops.hanging import Hanging
from ..plots.sheet import Column, Sheet, number, power_of
from ..running.measures import MEASURES
from .damping import Spot
from .study import FOUNDATIONS, OBSERVED, SOLVERS, LimitStudy

_LEAST = 1e6
"""The softest foundation within the range of the model: what holds from there on holds."""


def event_sheet(study: LimitStudy) -> Sheet:
    """Events, and what their layers do; forces before and behind, over the weight of the whole hoop."""
    found = study.events
    return Sheet(
        "Events of the first whole pulse and on the way to it, their layers on the clock τ = (t − t*)/ε",
        [Column("event", [e.event.kind for e in found], words=True)],
        [
            Column("phi\n[deg]", [f"{degrees(e.event.phi):.3f}" for e in found]),
            Column("phidot\n[sqrt(g/R)]", [number(e.event.omega, 5) for e in found]),
            Column("N before\n[Mg]", [number(e.before[0], 5) for e in found]),
            Column("behind\n[Mg]", [number(e.behind[0], 5) for e in found], joined=True),
            Column("F before\n[Mg]", [number(e.before[1], 5) for e in found]),
            Column("behind\n[Mg]", [number(e.behind[1], 5) for e in found], joined=True),
            Column("largest\n|F|/N", [number(e.layer.peak_ratio if e.layer else None, 4) for e in found]),
            Column("sticks\nfrom τ", [number(e.layer.resticks if e.layer else None, 4) for e in found]),
            Column("critical\ndamping", [number(e.critical_damping, 4) for e in found]),
        ],
    )


_SYMBOLS = {"eps": "ε", "v_s": "v_s"}


def _symbol(study: LimitStudy) -> str:
    return _SYMBOLS[study.prediction.parameter]


def term_sheet(study: LimitStudy) -> Sheet:
    """The prediction."""
    terms = study.prediction.terms
    symbol = _symbol(study)
    powers = [
        " ".join(f"{c:+.5g} {power_of(symbol, p)}" for p, c in term.powers if c) or "0" for term in terms.values()
    ]
    names = [MEASURES[name].named(study.scene) for name in terms]
    return Sheet(
        "Prediction: limit and approach",
        [Column("measure", names, words=True)],
        [
            Column("limit", [number(term.limit) for term in terms.values()]),
            Column("approach", powers, words=True),
        ],
    )


def sight_sheet(study: LimitStudy) -> Sheet:
    """Predicted and observed distances, over the leading power of the small parameter."""
    rows = []
    for sight in study.sights:
        for name in OBSERVED:
            scale = study.small(sight.foundation) ** study.prediction.terms[name].exponent
            if name not in sight.values or scale == 0:
                continue
            found, foreseen = study.distance(name, sight)
            error = f"{sight.errors[name] / scale:.2g}" if name in sight.errors else "-"
            share = f"{found / foreseen:.3f}" if foreseen and not study.otherwise(sight) else "-"
            rows.append(
                (sight.solver, number(sight.foundation, 3), MEASURES[name].symbol, number(sight.values[name]),
                 number(found / scale, 4), error, number(foreseen / scale, 4), share)
            )  # fmt: skip
    heads = (
        "observed by",
        "foundation",
        "measure",
        "value",
        "distance\nover power",
        "±",
        "predicted",
        "observed/\npredicted",
    )
    columns = [
        Column(head, cells, words=head in ("observed by", "measure"), joined=head == "±")
        for head, cells in zip(heads, zip(*rows, strict=True) if rows else [()] * len(heads), strict=True)
    ]
    return Sheet("Distance to the limit, observed and predicted", columns[:3], columns[3:])


def map_sheet(spots: Sequence[Spot]) -> Sheet:
    """J_F/J_N, foundations across and damping ratios down."""
    ratios = sorted({spot.damping for spot in spots})
    columns = []
    for foundation in sorted({spot.foundation for spot in spots}):
        row = {spot.damping: spot.impulse_ratio for spot in spots if spot.foundation == foundation}
        columns.append(Column(number(foundation, 3), [f"{row[ratio]:.5f}" for ratio in ratios]))
    return Sheet(
        "J_F/J_N over damping ratio and foundation", [Column("damping", [number(ratio) for ratio in ratios])], columns
    )


def limit_sheets(study: LimitStudy) -> list[Any]:
    """The answer in words, the events, the prediction and what is observed."""
    return [
        verdict(study),
        *damping_sentences(study),
        "J_F/J_N by what is compliant, approached so with this scene's damping: "
        + "; ".join(other_sentences(study))
        + ".",
        *([event_sheet(study)] if study.events else []),
        term_sheet(study),
        sight_sheet(study),
        *unlike_sentences(study),
        *failures(study),
    ]


def unlike_sentences(study: LimitStudy) -> list[str]:
    """Where what is seen is not as predicted even at the stiffest foundation, a sentence for each solver."""
    said = []
    for solver, name in zip(SOLVERS, ("rigid ring", "flexible solver"), strict=True):
        foundation, off = study.unlike(solver)
        told = ", ".join(f"in {MEASURES[each].symbol} by {number(times, 3)}" for each, times in off.items())
        layers = foundation < study.separate
        why = "its layers are not separate" if layers else "terms behind the first are not small"
        at = f"At a foundation of {number(foundation, 3)}, the stiffest here, the {name} is off {told}"
        said += [f"{at} times what is predicted: {why} there yet."] if off else []
    return said


def failures(study: LimitStudy) -> list[str]:
    """Which layers and runs there are not, and why."""
    layers = [f"Not followed: {found.failure}" for found in study.events if found.failure]
    runs = [sight for sight in study.sights if sight.failure]
    return layers + [f"Foundation {number(s.foundation, 3)}, {s.solver}, failed: {s.failure}" for s in runs]


def verdict(study: LimitStudy) -> str:
    """The answer."""
    term = study.prediction.terms["impulse_ratio"]
    paper = study.others[0].impulse_ratio[0] if study.others else float("nan")
    same = abs(term.limit - paper) < 1e-12
    law = study.scene.contact.law
    becomes = "becomes the paper's rigid hoop" if same else "does not become the paper's rigid hoop"
    least = ", with the least of damping" if study.scene.contact.damping == 0 and study.separate == inf else ""
    lead = (
        f"Made ever stiffer{least}, the hoop on a floor with the {law} law {becomes}: J_F/J_N (friction impulse over"
        " normal impulse, of the first whole pulse)"
    )
    frictionless = study.scene.friction.mu_s == 0
    if same and not term.coefficient and study.prediction.parameter != "eps" and not frictionless:
        order = power_of(_symbol(study), term.exponent)
        return f"{lead} tends to {term.limit:.6f}, without a term of the order of {order}: what is left falls faster."
    if same and not term.coefficient:
        why = "there is no friction" if frictionless else "nothing in it depends on the stiffness"
        return f"{lead} is {number(term.limit)} at any stiffness: {why}."
    words = (
        f"{lead} tends to {term.limit:.6f}"
        + ("" if same else f" and not to {paper:.6f}")
        + f", and is off by {term.coefficient:+.4g} {power_of(_symbol(study), term.exponent)} before"
    )
    small = (
        "ε the foundation ε_n R²/(m g) to the power −1/3"
        if study.prediction.parameter == "eps"
        else "v_s its slip velocity scale over sqrt(gR), which falls with the foundation as the patch's width does"
    )
    told = f"{words}, {small}."
    if not study.prediction.complete:
        told += (
            " The slip starts where friction has no jump, which gives that power; the terms behind it, of the order of"
            " the creep, are not predicted, and may be the larger ones at any stiffness within reach."
        )
    return told


def damping_sentences(study: LimitStudy) -> list[str]:
    """What damping is needed, and from where on the prediction holds."""
    hang = {stop.phi for stop in study.hanging}  # told below
    critical = [e.critical_damping for e in study.events if e.critical_damping is not None and e.event.phi not in hang]
    said = []
    if critical and not (hang and max(critical) == 0):
        largest = max(critical)
        ratio = study.scene.contact.damping
        if largest == 0:
            said.append("The layer of no event breaks the patch anew, even undamped.")
            if not all(other.tends for other in study.others):
                said.append(
                    "But undamped it rings on, and no limit of J_F/J_N is seen: the stick may break early by that."
                )
        else:
            above = "above" if ratio > largest else "below"
            said.append(
                f"Below a damping ratio of {number(largest, 4)} the transient breaks the patch again, for the time of"
                " the layer: with any damping at all the limit is the same below it; this scene's "
                f"{number(ratio, 4)} is {above} it."
            )
    softer = [sight.foundation for sight in study.sights if study.otherwise(sight)]
    said += hanging_sentences(study.hanging, study.scene.friction, max(softer, default=0.0))
    if study.stiff > max(study.separate, _LEAST):
        said.append(
            f"All this is of a rigid rim: below a foundation of {number(study.stiff, 2)} a ring in the"
            " scene's proportion gives way by more than the patch that should damp it: a stick may break in it."
        )
    if study.separate == 0:
        pass
    elif isfinite(study.separate):
        said.append(f"The layers are over before the next event from a foundation of {number(study.separate, 2)} on.")
    elif study.scene.contact.damping == 0:
        said.append(
            "A layer does not settle: no limit is predicted without damping, and the numbers hold for the least of it."
        )
    else:
        said.append(
            "A layer takes more than a thousand of its periods to settle: the numbers hold for far stiffer floors than"
            " these."
        )
    return said


def hanging_sentences(
    stops: Sequence[Hanging], friction: Friction, softer: float = 0.0, limit: str = "the limit"
) -> list[str]:
    """Which sticks are lost for good if they break, whether they do, and what that makes of the limit.

    ``softer`` is the largest foundation at which a pulse was seen to be that of the other hoop, 0 if none was;
    ``limit`` what it is the rigid hoop of.
    """
    said = []
    for stop in stops:
        told = (
            f"Behind the slip that stops at {degrees(stop.phi):.1f}° rolling takes |F|/N = {number(stop.ratio, 4)},"
            f" more than mu = {number(friction.mu)} and less than mu_s = {number(friction.mu_s)}: a patch that breaks"
            " there slides on, at any stiffness"
        )
        least = ""
        if stop.damping is not None:
            least = (
                f" below a damping ratio of {number(stop.damping, 4)}" if isfinite(stop.damping) else " at any damping"
            )
        if stop.broken:
            kept = (
                f"; above {number(stop.damping, 4)} it is that of the hoop that sticks"
                if stop.damping and isfinite(stop.damping)
                else ""
            )
            told += f". With this damping it does, and {limit} is that of the rigid hoop that slides on there{kept}."
        else:
            told += f". With this damping it does not, but{least or ' with another'} it may."
        said.append(told + _softer_sentence(stop, softer))
    return said


def _softer_sentence(stop: Hanging, softer: float) -> str:
    """What becomes of a stick on floors that are too soft for the limit."""
    does = "keeps its stick" if stop.broken else "breaks"
    if stop.holds == inf:
        return f" On softer floors the critical ratio is another, and it still {does} at all within reach."
    if stop.holds > max(softer, _LEAST):
        return (
            f" On softer floors the critical ratio is another, and it still {does} below a foundation of about"
            f" {number(stop.holds, 1)}."
        )
    if softer:
        return f" The pulses observed up to a foundation of {number(softer, 2)} are still those of one that {does}."
    return ""


def other_sentences(study: LimitStudy) -> list[str]:
    """Which compliances tend where."""
    said = []
    for other in study.others:
        low, high = other.impulse_ratio
        if not other.tends:
            said.append(f"{other.name}: {low:.4f} to {high:.4f}, no limit seen{_out_of_sight(study)}")
            continue
        words = f"{other.name}: {low:.5f}"
        if other.prediction is not None:
            term = other.prediction.terms["impulse_ratio"]
            symbol = _SYMBOLS[other.prediction.parameter]
            if term.coefficient:
                words += f", like {term.coefficient:+.3g} {power_of(symbol, term.exponent)}"
        said.append(words)
    return said


def _out_of_sight(study: LimitStudy) -> str:
    """That a limit would not be seen either, where the layers run into each other at all foundations that are tried."""
    tried = max(FOUNDATIONS)
    if not tried < study.separate < inf:
        return ""
    return f", nor would one be: up to {number(tried, 2)}, the largest foundation tried, the layers are not separate"
