"""What is told of the limit, in rows and sentences; the screen and the page print the same."""

from __future__ import annotations

from math import degrees, isfinite

from ..running.measures import MEASURES
from ..stiffness.summary import number
from .study import OBSERVED, LimitStudy

EVENT_HEADING = ["event", "phi [deg]", "phidot", "N", "F", "largest |F|/N", "sticks from tau", "critical damping"]
TERM_HEADING = ["measure", "limit", "approach"]
SIGHT_HEADING = ["observed by", "foundation", "measure", "value", "distance / x^p", "predicted", "observed/predicted"]


def event_rows(study: LimitStudy) -> list[list[str]]:
    """Events, and what their layers do; forces before and behind, over the weight of the whole hoop."""
    rows = []
    for found in study.events:
        event, layer = found.event, found.layer
        forces = [f"{number(a, 5)} → {number(b, 5)}" for a, b in zip(found.before, found.behind, strict=True)]
        critical = "-" if found.critical_damping is None else number(found.critical_damping, 4)
        rows.append(
            [event.kind, f"{degrees(event.phi):.3f}", number(event.omega, 5), *forces, number(layer.peak_ratio, 4),
             number(layer.resticks, 4), critical]
        )  # fmt: skip
    return rows


def _symbol(study: LimitStudy) -> str:
    return "ε" if study.prediction.parameter == "eps" else "v_s"


def term_rows(study: LimitStudy) -> list[list[str]]:
    """The prediction."""
    rows = []
    for name, term in study.prediction.terms.items():
        powers = " ".join(f"{c:+.5g} {_symbol(study)}^{p:.3g}" for p, c in term.powers) or "0"
        rows.append([MEASURES[name].symbol, number(term.limit), powers])
    return rows


def sight_rows(study: LimitStudy) -> list[list[str]]:
    """Predicted and observed distances, over the leading power of the small parameter."""
    rows = []
    for sight in study.sights:
        if sight.failure:
            rows.append([sight.solver, number(sight.foundation, 3), sight.failure, "", "", "", ""])
            continue
        for name in OBSERVED:
            if name not in sight.values:
                continue
            scale = study.small(sight.foundation) ** study.prediction.terms[name].exponent
            found, foreseen = study.distance(name, sight)
            if scale == 0 or foreseen == 0:
                continue
            spread = sight.errors.get(name, 0.0) / scale
            shown = number(found / scale, 4) + (f" ± {number(spread, 2)}" if name in sight.errors else "")
            rows.append(
                [sight.solver, number(sight.foundation, 3), MEASURES[name].symbol, number(sight.values[name]), shown,
                 number(foreseen / scale, 4), f"{found / foreseen:.3f}"]
            )  # fmt: skip
    return rows


def verdict(study: LimitStudy) -> str:
    """The answer."""
    term = study.prediction.terms["impulse_ratio"]
    paper = study.others[0].impulse_ratio[0] if study.others else float("nan")
    same = abs(term.limit - paper) < 1e-12
    law = study.scene.contact.law
    words = (
        f"The {law} law tends to J_F/J_N = {term.limit:.6f}, "
        + ("the paper's pulse" if same else f"another pulse than the paper's {paper:.6f}")
        + f", like {term.coefficient:+.4g} {_symbol(study)}^{term.exponent:.3g}"
    )
    small = "ε the foundation ε_n R²/(m g) to the power −1/3" if study.prediction.parameter == "eps" else "v_s"
    told = f"{words}, {small}."
    if not study.prediction.complete:
        told += (
            " A slip that starts where a brush carries most comes late by that power; terms of order ε log ε behind it"
            " are the larger ones up to foundations of 1e13 and more, and are not predicted."
        )
    return told


def damping_sentences(study: LimitStudy) -> list[str]:
    """What damping is needed, and from where on the prediction holds."""
    critical = [e.critical_damping for e in study.events if e.critical_damping is not None]
    said = []
    if critical:
        largest = max(critical)
        ratio = study.scene.contact.damping
        if largest == 0:
            said.append("Its patch passes every event without breaking anew, even undamped.")
        else:
            above = "above" if ratio > largest else "below"
            said.append(
                f"Below a damping ratio of {number(largest, 4)} the transient breaks the patch again; this scene's "
                f"{number(ratio, 4)} is {above} it."
            )
    if study.separate == 0:
        pass
    elif isfinite(study.separate):
        said.append(f"The layers are over before the next event from a foundation of {number(study.separate, 2)} on.")
    else:
        said.append(
            "A layer does not settle: no limit is predicted without damping, and the numbers hold for the least of it."
        )
    return said


def other_sentences(study: LimitStudy) -> list[str]:
    """Which compliances tend where."""
    said = []
    for other in study.others:
        low, high = other.impulse_ratio
        said.append(
            f"{other.name}: {low:.5f}" if low == high else f"{other.name}: {low:.4f} to {high:.4f}, no limit seen"
        )
    return said
