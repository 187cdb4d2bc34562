"""Tables of a stiffness study: its cases, its limits, all measures side by side."""

from __future__ import annotations

from math import floor, isfinite, log10
from typing import TYPE_CHECKING

from ...plots.sheet import number
from ...running.measures import MEASURES, shortened

if TYPE_CHECKING:
    from ..found import StiffnessStudy
    from ..rung import Rung


REST = ("normal_impulse", "peak_normal_force", "time_off_floor")
"""Measures of a rung beside the tied ones that one looks at first."""


def fixed(study: StiffnessStudy, name: str, value: float, decimals: int) -> str:
    """A measure with so many decimals in the paper's scaling, and in the units of the scene with as many digits; a dash
    for none."""
    if not isfinite(value):
        return "-"
    places = min(max(decimals - floor(log10(MEASURES[name].unit.of(study.scene))), 0), 300)
    return f"{round(value, places) + 0.0:.{places}f}"  # the other zero has no sign


def case_heading(study: StiffnessStudy) -> list[str]:
    """Columns of the ladder, each with its unit on a second line."""
    ratio, loss, *rest = (MEASURES[name].heading(study.scene) for name in ("impulse_ratio", "friction_loss", *REST))
    return ["foundation\nε_n R²/(mg)", "bending\nEI/(mgR²)", ratio, "±", loss, "±", *rest, "run\n[s]"]


def case_cells(study: StiffnessStudy, rung: Rung) -> list[str]:
    """The row of a rung: its stiffness, the tied measures with their error, starred where that is more than its share
    of the distance, and what else one looks at first."""
    stiffness = [number(rung.contact_stiffness, 3), number(rung.bending_stiffness, 3)]
    if rung.outcome.failure:
        return stiffness
    cells, loose = [], study.loose(rung)
    for name in ("impulse_ratio", "friction_loss"):
        cells += [
            fixed(study, name, rung.measure(name), 5),
            number(rung.error(name), 2) + ("*" if name in loose else ""),
        ]
    rest = [number(rung.measure(name), 5) for name in REST]
    return [*stiffness, *cells, *rest, f"{rung.outcome.seconds:.2f}"]


def rigid_cells(study: StiffnessStudy) -> list[str]:
    """The row of the rigid hoop that the limit should be."""
    p = study.reference.pulses[0]
    rest = [number(p[name], 5) for name in REST]
    return [
        "rigid",
        "",
        fixed(study, "impulse_ratio", p["impulse_ratio"], 5),
        "",
        fixed(study, "friction_loss", p["friction_loss"], 5),
        "",
        *rest,
        f"{study.reference.seconds:.2f}",
    ]


LIMIT_HEADING = [
    "limit of",
    "value",
    "±",
    "rigid",
    "difference",
    "inside?",
    "rate",
    "95 %\ninterval",
    "last\ndistance",
]


def limit_rows(study: StiffnessStudy) -> list[list[str]]:
    """One row for each limit."""
    rows = []
    for name, limit in study.limits.items():
        low, high = limit.rate_interval
        rows.append(
            [
                MEASURES[name].heading(study.scene).replace("\n", " "),
                fixed(study, name, limit.value, 6),
                number(limit.uncertainty, 2),
                fixed(study, name, limit.rigid, 6),
                number(limit.error, 2),
                {True: "yes", False: "no", None: "-"}[limit.rigid_inside],
                number(limit.rate, 3),
                f"{number(low, 3)} to {number(high, 3)}" if isfinite(high) else "-",
                number(limit.distance, 2),
            ]
        )
    return rows


def side_heading(study: StiffnessStudy) -> list[str]:
    """Columns of the side-by-side table: the rigid hoop, then every rung that came through."""
    return [
        "measure",
        "rigid",
        *(number(r.stiffness, 3) for r in study.rungs if not r.outcome.failure),
    ]


def side_rows(study: StiffnessStudy) -> list[list[str]]:
    """Every measure of the first pulse, rigid and at each rung."""
    columns = [study.reference, *(r.outcome for r in study.rungs if not r.outcome.failure)]
    rows = []
    for name, entry in MEASURES.items():
        unit = entry.unit.label(study.scene)
        rows.append(
            [
                f"{entry.symbol}, {unit}" if unit else entry.symbol,
                *(number(c.pulses[0].get(name), 5) for c in columns),
            ]
        )
    rows.append(["phases", *(shortened(c.phases[0]) for c in columns)])
    return rows
