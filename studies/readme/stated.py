"""What the README and the benchmark's page show and state, and the command behind each picture and number."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

STUDY = "hoop study stiffness paper-3.3-massless --json --out study"
BRUSH = "hoop study stiffness paper-3.3-massless --law brush --json"
UNDAMPED = "hoop study stiffness paper-3.3-massless --damping 0 --json"
PULSE = "hoop flexible paper-3.3-light --out first-pulse --fields"
FILM = "hoop view first-pulse --gif first-pulse.gif --field hoop_stress --frames 90"
ATLAS = "hoop study atlas --json --out atlas"
HOP = (
    "hoop study hop paper-3.3-heavier --law brush --over ring.bending_stiffness=0.5:1e4:24 "
    "--over hoop.k=0.05:0.5:12 --bisections 2 --json --out hop"
)
RIGID = "hoop bench rigid --peers --json --out bench"
FLEXIBLE = "hoop bench flexible --peers --json --out bench"
KNOBS = "hoop bench knobs --json --out bench"
SCALING = "hoop bench scaling --json --out bench"
STRESS = "hoop stress --scenes 1200 --seed 4 --json --out stress"
EXAMPLES = (
    "rigid-motion",
    "batch-map",
    "pulse",
    "stiffness-study",
    "fields-in-pyvista",
    "own-friction-law",
    "slip-weakening",
    "hop-by-rule",
)
"""Those of :mod:`studies.examples`, whose pictures stand in the README of this package."""


@dataclass(frozen=True)
class Picture:
    """A file of .images."""

    name: str
    commands: tuple[str, ...]
    """What makes it, in this order, in an empty folder."""
    made: str
    """Where they leave it."""


PICTURES = (
    Picture("hoop.svg", ("python -m studies.plots.sketch",), "hoop.svg"),
    Picture("pulse.png", (STUDY,), "study/pulse.png"),
    Picture("impulses.png", (STUDY,), "study/impulses.png"),
    Picture("distance.png", (STUDY,), "study/distance.png"),
    Picture("first-pulse.gif", (PULSE, FILM), "first-pulse.gif"),
    Picture("atlas.png", (ATLAS,), "atlas/atlas.png"),
    Picture("hop.png", (HOP,), "hop/map.png"),
    Picture("bench-rigid.png", (RIGID,), "bench/bench-rigid.png"),
    Picture("bench-knobs.png", (KNOBS,), "bench/bench-knobs.png"),
    Picture("bench-flexible.png", (FLEXIBLE,), "bench/bench-flexible.png"),
    Picture("bench-scaling.png", (SCALING,), "bench/bench-scaling.png"),
    Picture("margins.png", (STRESS,), "stress/stress.png"),
    *(
        Picture(f"example-{name}.png", (f"python -m studies.examples.{name.replace('-', '_')}",), f"{name}.png")
        for name in EXAMPLES
    ),
)


@dataclass(frozen=True)
class Stated:
    """A number that a page states."""

    table: str
    """The table or paragraph that it stands in."""
    words: str
    """A regular expression that finds it; its one group is the number as it is written."""
    command: str
    value: Callable[[Any], float]
    """The number, in what the command prints."""
    factor: float = 1.0
    """How many times more or less it may be, for what the machine's load moves; 1 is to the last digit stated."""

    def written(self, pages: str) -> str | None:
        """The number as it stands there; None where the words are not there."""
        found = re.search(self.words.replace(" ", r"\s+"), pages)  # lines may end between words
        return found[1] if found else None

    def agrees(self, written: str, now: float) -> bool:
        """Whether the number is what is printed now."""
        stated = plain_number(written)
        if self.factor > 1:
            return abs(stated) / self.factor <= abs(now) <= abs(stated) * self.factor
        return abs(stated - now) <= 0.5001 * last_digit(written)


_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def plain_number(written: str) -> float:
    """A number as the pages write them: 0.1701, 5·10⁻⁵, 10⁻⁴, −0.93."""
    text = written.replace("−", "-").strip()
    found = re.fullmatch(r"(?:(-?[\d.]+)·)?10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)", text)
    if found:
        return float(found[1] or 1) * 10.0 ** int(found[2].translate(_RAISED))
    return float(text)


def last_digit(written: str) -> float:
    """What one unit of the last digit is worth."""
    mantissa, _, power = written.replace("−", "-").partition("·")
    digits = len(mantissa.partition(".")[2])
    return 10.0**-digits * (plain_number(power) if power else 1.0)


def _rung(power: int, name: str) -> Callable[[Any], float]:
    """A measure at the rung of foundation 10^power."""

    def value(study: Any) -> float:
        near = min(study["cases"], key=lambda case: abs(case["contact_stiffness"] / 10.0**power - 1))
        return float(near[name])

    return value


def _limit(measure: str, name: str, part: str = "limit") -> Callable[[Any], float]:
    return lambda study: float(study[part][measure][name])


def _outside(measure: str) -> Callable[[Any], float]:
    """By how much the rigid value is outside the interval of a limit."""
    return lambda study: abs(study["limit"][measure]["error"]) - float(study["limit"][measure]["uncertainty"])


def _row(of: str, solver: str, setting: str, scene: str = "") -> Callable[[Any], float]:
    """A column of the benchmark's row whose solver, setting and scene begin so."""

    def value(bench: Any) -> float:
        asked = {"solver": solver, "setting": setting, "scene": scene}
        row = next(row for row in bench["rows"] if all(row[name].startswith(words) for name, words in asked.items()))
        return float(row[of])

    return value


def _ratio(words: str) -> Callable[[Any], float]:
    """A stated ratio of a benchmark, by how its name begins."""
    return lambda bench: next(float(r["measured"]) for name, r in bench["ratios"].items() if name.startswith(words))


def _ends(pick: Callable[[list[float]], float]) -> Callable[[Any], float]:
    """Of J_F/J_N at foundations of 10^10 and more."""
    return lambda study: pick([c["impulse_ratio"] for c in study["cases"] if c.get("contact_stiffness", 0) > 0.99e10])


def _ladder() -> list[Stated]:
    """The table under "What the numbers mean"."""
    number = r"([\d.]+)"
    stated = []
    for power, label in (
        (7, r"flexible, foundation 10⁷[^|]*"),
        (10, r"flexible, 10¹⁰[^|]*"),
        (13, r"flexible, 10¹³[^|]*"),
    ):
        stated += [
            Stated("limit", rf"\| {label} \| {number} \|", STUDY, _rung(power, "impulse_ratio")),
            Stated("limit", rf"\| {label} \| [\d.]+ \| {number} \|", STUDY, _rung(power, "friction_loss")),
        ]
    fit, pair = r"\| limit, fitted[^|]*", r"[\d.]+ ± [\d.]+ \|"
    for place, name in ((f"{fit} \\| ", "impulse_ratio"), (f"{fit} \\| {pair} ", "friction_loss")):
        stated += [
            Stated("limit", rf"{place}{number} ±", STUDY, _limit(name, "value")),
            Stated("limit", rf"{place}[\d.]+ ± {number} \|", STUDY, _limit(name, "uncertainty")),
        ]
    stated += [
        Stated(
            "limit", r"95 % interval of J_N, ± ([\d·⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+),", STUDY, _limit("normal_impulse", "uncertainty")
        ),
        Stated("limit", r"the rigid value is ([\d·⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+) outside", STUDY, _outside("normal_impulse")),
        Stated("limit", rf"\| rigid \| {number} \|", STUDY, _limit("impulse_ratio", "rigid")),
        Stated("limit", rf"\| rigid \| [\d.]+ \| {number} \|", STUDY, _limit("friction_loss", "rigid")),
    ]
    return stated


IN_SHORT = r"ring with mass, E I/\(m g R²\) = 65"
"""A row of the README's own table."""
_POWER = r"((?:[\d.]+·)?10[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+|[\d.]+)"

NUMBERS: tuple[Stated, ...] = (
    *_ladder(),
    Stated("coefficient", r"ladder shows ([\d.]+) ±", STUDY, _limit("impulse_ratio", "observed", "prediction")),
    Stated("brush", r"instead of 0.35: ([\d.]+) ±", BRUSH, _limit("impulse_ratio", "value")),
    Stated("brush", r"instead of 0.35: [\d.]+ ± ([\d.]+) against", BRUSH, _limit("impulse_ratio", "uncertainty")),
    Stated("brush", r"± [\d.]+ against ([\d.]+\d)", BRUSH, _limit("impulse_ratio", "rigid")),
    Stated("brush", r"hoop with μ_s = ([\d.]+) instead", BRUSH, lambda study: float(study["reference"]["mu_s"])),
    Stated("undamped", r"stays between ([\d.]+) and [\d.]+ from", UNDAMPED, _ends(min)),
    Stated("undamped", r"stays between [\d.]+ and ([\d.]+) from", UNDAMPED, _ends(max)),
    Stated("rigid", r"\| one call, compiled \| ([\d.]+) ms", RIGID,
           lambda b: 1e3 * _row("seconds_median", "hoop-pulse", "one call", "k = 0.1")(b), 2.0),
    Stated("rigid", r"both cores \| ([\d.]+) ms", RIGID,
           lambda b: 1e3 * _row("seconds_median", "hoop-pulse", "batch", "k = 0.1")(b), 2.0),
    Stated("rigid", r"first cycle, one call \| ([\d.]+) ms", RIGID,
           lambda b: 1e3 * _row("seconds_median", "hoop-pulse", "one call", "k = 0.1")(b), 2.0),
    Stated("rigid", r"per scene of a batch of 10⁴ \| ([\d.]+) ms", RIGID,
           lambda b: 1e3 * _row("seconds_median", "hoop-pulse", "batch", "k = 0.1")(b), 2.0),
    Stated("rigid", rf"\| one call, compiled \| [\d.]+ ms \| {_POWER} \|", RIGID,
           _row("error", "hoop-pulse", "one call", "k = 0.1"), 3.0),
    Stated("rigid", r"One call is ([\d.]+) times as fast", RIGID, _ratio("rigid: faster than scipy"), 1.5),
    Stated("rigid", r"a batch ([\d.]+) times per scene", RIGID, _ratio("rigid: faster per scene in a batch"), 1.5),
    Stated("rigid", r"costs ([\d.]+) times", RIGID, _ratio("rigid: cost of k = 1e-5"), 1.3),
    *(Stated("flexible", rf"\| {place}, rtol 10⁻³ \| ([\d.]+) s \|", FLEXIBLE,
             _row("seconds_median", "hoop-pulse reduced", "rtol 1e-03"), 2.0) for place in ("reduced", IN_SHORT)),
    Stated("flexible", rf"\| {IN_SHORT}, rtol 10⁻³ \| [\d.]+ s \| {_POWER} \|", FLEXIBLE,
           _row("error", "hoop-pulse reduced", "rtol 1e-03"), 2.0),
    Stated("flexible", rf"\| reduced, rtol 10⁻³ \| [\d.]+ s \| {_POWER} \|", FLEXIBLE,
           _row("error", "hoop-pulse reduced", "rtol 1e-03"), 2.0),
    Stated("knobs", rf"brush\) [^\n]*\n[^\n]*\n\| rtol 10⁻³ \| {_POWER} \|", KNOBS,
           _row("elements", "", "rtol 1e-03", "scene B"), 1.5),
    Stated("knobs", rf"\n\| rtol 10⁻⁵ (?:\| [^|]+){{2}}\| [^|]+\| [^|]+\| {_POWER} \|", KNOBS,
           _row("error", "", "rtol 1e-05", "scene B"), 1.5),
    Stated("knobs", rf"massless, patch, rtol 10⁻⁴ (?:\| [^|]*){{4}}\| {_POWER} \|", KNOBS,
           _row("error", "", "rtol 1e-04", "massless, patch"), 1.5),
    Stated("knobs", rf"r = 1.2, rtol 10⁻⁴ \| {_POWER} \|", KNOBS,
           _row("elements", "", "rtol 1e-04", "scene B, r = 1.2"), 1.5),
    Stated("scaling", r"elements\^([\d.]+)", SCALING, lambda b: float(b["exponents"]["elements"]), 1.5),
    Stated("scaling", r"workers\^−([\d.]+)", SCALING, lambda b: -float(b["exponents"]["workers"]), 1.3),
)  # fmt: skip
"""Numbers that are held to what is printed. Of tables of times the ones that the text draws on."""
