"""What is told of the map, in sentences and rows; the screen and the page print the same."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, isfinite
from typing import Any

from ..plots.sheet import Column, Sheet, number
from .rolling.rule import DECADE, DURATION_OVER_PERIOD, HEIGHT_OVER_DEPTH, HEIGHT_OVER_SAG
from .rolling.scaling import LEFT, SYMMETRIC, foreseen
from .rolling.threshold import SYMBOL, Bracket, HopCase, Line, rigid_hops
from .study import HopStudy

PLACES = {
    "anywhere": "anywhere on its way",
    "pulse": "within its first pulse",
    "bottom": "at φ = π with the contact under the disk",
}


def answer(study: HopStudy) -> str:
    """The answer, and how far its numbers hold."""
    if not any(case.hops for case in study.cases):
        return "No: released at rest, none of these elastic hoops was seen to hop."
    said = [f"{words} {_of_all_lines(study, where)}" for where, words in PLACES.items() if _lines_with(study, where)]
    over = f", depending on {study.second}" if study.second is not None else ""
    return (
        f"Yes: released at rest, an elastic hoop whose bending stiffness {SYMBOL} is low enough leaves the floor: "
        f"{', '.join(said)}{over}.{_doubt(study)}"
    )


def _lines_with(study: HopStudy, where: str) -> list[Line]:
    return [line for line in study.lines if where in line.windows]


def _of_all_lines(study: HopStudy, where: str) -> str:
    """Least and largest threshold over the lines of the map; the ends of all brackets where one is wide."""
    found = [line.threshold(where) for line in _lines_with(study, where)]
    values = sorted(value for value in (bracket.value for bracket in found) if value is not None)
    still = max((bracket.low for bracket in found if not isfinite(bracket.high)), default=0.0)
    told = []
    if any(bracket.value is not None and not bracket.is_close for bracket in found):
        closed = [bracket for bracket in found if bracket.value is not None]
        low, high = min(bracket.low for bracket in closed), max(bracket.high for bracket in closed)
        told.append(f"below a stiffness between {number(low, 3)} and {number(high, 3)}")
    elif values:
        least, largest = number(values[0], 3), number(values[-1], 3)
        told.append(f"below {least}" if least == largest else f"below {least} to {largest}")
    if still:
        told.append(f"still at {number(still, 3)}, the stiffest that was rolled")
    if not told:
        return max(found, key=lambda bracket: bracket.high).ends
    return " and ".join(told)


def _doubt(study: HopStudy) -> str:
    """How many thresholds a third of the tolerance moves."""
    said = [line.holds(where) for line in study.lines for where in line.windows]
    moved, known = said.count(False), len(said) - said.count(None)
    if not known:
        return ""
    if not moved:
        return " A third of the tolerance moves none of these thresholds."
    if known == 1:
        return " A third of the tolerance moves the only threshold out of its bracket."
    return f" A third of the tolerance moves {moved} of the {known} thresholds out of their brackets."


def verdict(study: HopStudy) -> list[str]:
    """The answer, a sentence for each line of the map."""
    return [_line_verdict(study, line) for line in study.lines]


def _line_verdict(study: HopStudy, line: Line) -> str:
    hoop = line.scene.hoop
    name = f"k = {hoop.k:.4g}, m_h/m = {hoop.mass_ratio:.4g}"
    if study.second not in (None, "hoop.k", "hoop.mass_ratio"):
        name += f", {study.second} = {line.value:.4g}"
    hopping = [case for case in (*line.mapped, *line.between) if case.hops]
    if not hopping:
        undecided = any(not case.motion["completed"] for case in line.mapped)
        return f"{name}: no hop was seen{', but some rolls stopped early' if undecided else ''}."
    stiffest = max(hopping, key=lambda case: case.bending_stiffness)
    said = [f"{words} {_below(line, where)}" for where, words in PLACES.items() if where in line.windows]
    first = f"The stiffest hoop that hops, {number(stiffest.bending_stiffness, 3)}, first does so at φ = "
    return f"{name}: leaves the floor {', '.join(said)}. {first}{degrees(stiffest.hops[0]['phi']):.0f}°."


def _below(line: Line, where: str) -> str:
    found = line.threshold(where)
    if line.holds(where) is not False:
        return found.told()
    finer = line.answers(where, cases=line.finer)
    return found.told(f"{'more' if finer[found.high] else 'less'} at a third of the tolerance")


def rule_sentence(study: HopStudy) -> str:
    """What counts as a hop, and that the rigid hoop has none."""
    flights = sum(rigid_hops(line.scene) for line in study.lines)
    beside = "never leaves the floor" if flights == 0 else f"leaves the floor {flights} times"
    return (
        f"A flight is a hop, and not chatter, if the rim's lowest point rises over {HEIGHT_OVER_DEPTH:g} times the "
        f"depth to which the floor gives way under the weight and over {HEIGHT_OVER_SAG:g} of the sag at rest, for "
        f"longer than {DURATION_OVER_PERIOD:g} of the ring's slowest period. The rigid hoop {beside}."
    )


def unfinished_sentences(study: HopStudy) -> list[str]:
    """How many rolls stopped early, and why the first of them did."""
    stopped = study.unfinished
    if not stopped:
        return []
    first = stopped[0]
    why = (first.outcome.failure or first.outcome.ended).rstrip(".")
    return [
        f"{len(stopped)} of {len(study.cases)} rolls stopped before their end; what they did until then counts. "
        f"At {SYMBOL} = {number(first.bending_stiffness, 3)}: {why}."
    ]


def threshold_sheet(study: HopStudy) -> Sheet:
    """Thresholds line by line, and between which values they move over a decade of the rule's constants."""
    keys = []
    if study.second is not None:
        keys = [Column(study.second.replace(".", ".\n"), [number(line.value) for line in study.lines])]
    keys = keys or [Column("scene", [f"k = {line.scene.hoop.k:g}" for line in study.lines], words=True)]
    columns = []
    for where in PLACES:
        lines = [line if where in line.windows else None for line in study.lines]
        columns += [
            Column(f"{where}\n", ["-" if line is None else line.threshold(where).ends for line in lines]),
            Column("rule over\na decade", ["-" if line is None else _span(line, where) for line in lines], joined=True),
            Column("rtol/3\nagrees", ["-" if line is None else _yes(line.holds(where)) for line in lines], joined=True),
        ]
        if where == "anywhere":
            columns.append(Column("fore-\nseen", [_number(foreseen(line.scene)) for line in study.lines], joined=True))
    return Sheet(f"{SYMBOL} below which the hoop hops (hops at the first, not at the second)", keys, columns)


def _span(line: Line, where: str) -> str:
    found = [line.threshold(where, factor) for factor in reversed(DECADE)]
    told = [_middle(bracket) for bracket in found]
    return " to ".join(told)


def _middle(found: Bracket) -> str:
    if found.value is not None:
        return number(found.value, 3)
    return "none" if found.low == 0 else f">{number(found.low, 3)}"


def _number(value: float | None) -> str:
    return "-" if value is None else number(value, 3)


def _yes(holds: bool | None) -> str:
    return "-" if holds is None else "yes" if holds else "no"


def case_sheet(study: HopStudy) -> Sheet:
    """Each roll with its first hop and the highest one."""
    cases = study.cases
    time, length, energy = _units(study)
    firsts = [case.hops[0] if case.hops else None for case in cases]
    keys = [Column(f"{SYMBOL}\n", [number(case.bending_stiffness, 4) for case in cases])]
    if study.second is not None:
        values = [line.value for line in study.lines for _ in (*line.mapped, *line.between)]
        keys.append(Column(study.second.replace(".", ".\n"), [number(value) for value in values]))
    columns = [
        Column("hops", [str(len(case.hops)) for case in cases]),
        Column("chatter", [str(case.chatter) for case in cases]),
        Column("first at\nphi [deg]", ["-" if hop is None else f"{degrees(hop['phi']):.1f}" for hop in firsts]),
        Column(f"its height\n[{length}]", ["-" if hop is None else number(hop["height"], 3) for hop in firsts]),
        Column(f"duration\n[{time}]", ["-" if hop is None else number(hop["duration"], 3) for hop in firsts]),
        Column(f"stored\n[{energy}]", [_share(hop, "stored_in_ring", "stored_in_floor") for hop in firsts]),
        Column(f"of which to\nthe whole [{energy}]", [_share(hop, "mass_centre", "rolling") for hop in firsts]),
        Column(f"vibration at\nlift-off [{energy}]", [_share(hop, "vibration") for hop in firsts]),
        Column(f"friction and\ndamper [{energy}]", [_share(hop, "friction", "damping") for hop in firsts]),
        Column(f"landing\n[{energy}]", [_share(hop, "landing") for hop in firsts]),
        Column(f"highest\n[{length}]", [number(case.height, 3) for case in cases]),
        Column("whole\nroll", [_far(case) for case in cases]),
    ]
    return Sheet("Rolls from rest, softest first", keys, columns)


def _far(case: HopCase) -> str:
    if not case.motion["completed"]:
        return "no"
    if case.whole:
        return "yes"
    return "to its pulse" if case.motion.get("whole", True) else "till decided"


def _share(hop: dict[str, Any] | None, *names: str) -> str:
    if hop is None or hop["energies"] is None:
        return "-"
    return number(sum(hop["energies"][name] for name in names), 3)


def _units(study: HopStudy) -> tuple[str, str, str]:
    from ..running.measures import Unit

    time, length, energy = (unit.label(study.scene) for unit in (Unit.TIME, Unit.LENGTH, Unit.ENERGY))
    return time, length, energy


def scaling_sentences(study: HopStudy) -> list[str]:
    """The power of k with which the thresholds fall, where the map is over k; and how sudden the pulse is at them."""
    return [*_power_of_k(study), *_suddenness(study)]


def _power_of_k(study: HopStudy) -> list[str]:
    if study.second != "hoop.k":
        return []
    import numpy as np

    said = []
    for where in PLACES:
        found = [(line.value, line.threshold(where)) for line in study.lines if where in line.windows]
        known = np.array([(k, bracket.value) for k, bracket in found if bracket.is_close])
        if len(known) < 3:
            continue
        k, value = np.log(known).T
        power, constant = np.polyfit(k, value, 1)
        scatter = float(np.exp(np.abs(value - power * k - constant).max()))
        said.append(f"{where}: {np.exp(constant):.3g} k^{power:.2f} (within a factor {scatter:.2f})")
    if not said:
        return []
    return [f"Over k the threshold goes like: {'; '.join(said)}. The wall gives way inside the pulse below 1.3/k."]


def _suddenness(study: HopStudy) -> list[str]:
    turning = _in_all_lines(study, lambda line, where: line.turning(where))
    duration = _in_all_lines(study, lambda line, where: line.times_duration(where))
    said = []
    if duration:
        said.append(f"At the thresholds {SYMBOL} times τ²g/R, τ the time of the rigid pulse, is {duration}.")
    if turning:
        said.append(
            f"ω₁t* is {turning} there: ω₁ the slowest vibration of the ring about its weld, exp(-ω₁t*) how much of it "
            "is in the pulse of the rigid hoop."
        )
    if any(foreseen(line.scene) for line in study.lines):
        said.append(
            "Foreseen, for k up to 0.2, is where the vibration that the pulse leaves exceeds the least N of the rigid "
            f"hoop behind it: ω_s t* = {LEFT:g} + ln(N_max/N_min), ω_s = {SYMMETRIC:.2g} ω₁."
        )
    return said


def _in_all_lines(study: HopStudy, value: Callable[[Line, str], float | None]) -> str:
    """Least and largest value at the thresholds of each place."""
    said = []
    for where in PLACES:
        found = [value(line, where) for line in study.lines if where in line.windows]
        known = [number(each, 3) for each in sorted(each for each in found if each is not None)]
        if known:
            said.append(f"{' to '.join([*known[:1], *known[1:][-1:]])} {where}")
    return ", ".join(said)


def hop_sheets(study: HopStudy) -> list[Any]:
    """All of it, as the screen shows it."""
    return [
        answer(study), *verdict(study), *scaling_sentences(study), rule_sentence(study), threshold_sheet(study),
        case_sheet(study), *unfinished_sentences(study),
    ]  # fmt: skip


__all__ = ["HopCase", "answer", "hop_sheets", "verdict"]
