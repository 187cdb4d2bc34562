"""How results are printed on the screen."""

from __future__ import annotations

import shutil
import sys
from math import degrees
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table

from rigid import Motion, Scene

from ..running.measures import MEASURES, measures, phase_sequence
from ..stiffness.summary import (
    CASE_HEADING,
    case_cells,
    damping_sentence,
    law_sentence,
    limit_rows,
    number,
    rigid_cells,
    shortened,
    verdict,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..limit.damping import Spot
    from ..limit.study import LimitStudy
    from ..stiffness.study import StiffnessStudy
    from ..sweep import Table as SweepTable


def show(*things: Any) -> None:
    """Print tables and sentences on stdout, wide enough when it is not a terminal."""
    width = None if sys.stdout.isatty() else max(shutil.get_terminal_size().columns, 150)
    console = Console(width=width, highlight=False, soft_wrap=False)
    for thing in things:
        console.print(thing)


def motion_tables(motion: Motion) -> list[Any]:
    """Phases, turns and pulses of a motion, and why it ended."""
    shown: list[Any] = []
    phases = Table("phase", "from t", "to t", "from phi [deg]", "to phi [deg]", title="Phases", title_justify="left")
    for phase in motion.phases:
        ends = (
            number(phase.t_start),
            number(phase.t_end),
            number(degrees(phase.phi_start)),
            number(degrees(phase.phi_end)),
        )
        phases.add_row(phase.kind.value, *ends)
    shown.append(phases)
    if motion.turns:
        turns = Table(
            "t", "phi [deg]", "slip velocity", "energy", title="Turns, where phidot = 0", title_justify="left"
        )
        for turn in motion.turns:
            turns.add_row(number(turn.t), number(degrees(turn.phi)), number(turn.slip_velocity), number(turn.energy))
        shown.append(turns)
    if motion.pulses:
        shown.append(
            pulse_table(
                [
                    (f"pulse {i}", measures(motion, pulse), phase_sequence(motion, pulse))
                    for i, pulse in enumerate(motion.pulses, 1)
                ],
                motion.scene,
            )
        )
    books = motion.to_dict().get("energy_ledger")
    if books:
        ledger = Table("where the energy went", title="Energy ledger", title_justify="left")
        ledger.add_column(MEASURES["friction_loss"].unit_in(motion.scene), justify="right")
        for name, value in books.items():
            ledger.add_row(name.replace("_", " "), number(value))
        shown.append(ledger)
    shown.append(f"Ended: {motion.ended}")
    return shown


def pulse_table(columns: list[tuple[str, dict[str, float], list[str]]], scene: Scene) -> Table:
    """Measures of pulses side by side, one column for each ``(heading, measures, phases)``."""
    table = Table("measure", title="Pulses", title_justify="left")
    for heading, _, _ in columns:
        table.add_column(heading, justify="right", overflow="fold")
    for name, entry in MEASURES.items():
        unit = entry.unit_in(scene)
        table.add_row(
            f"{entry.symbol}, {unit}" if unit else entry.symbol,
            *(number(values.get(name)) for _, values, _ in columns),
        )
    table.add_row("phases", *(shortened(phases) or "-" for _, _, phases in columns))
    return table


def study_tables(study: StiffnessStudy) -> list[Any]:
    """The ladder rung by rung, the limits, and the answer in words."""
    ladder = Table(title="First pulse over the ladder of stiffness", title_justify="left")
    for heading in CASE_HEADING:
        ladder.add_column(heading, justify="right", no_wrap=True)
    for rung in study.rungs:
        ladder.add_row(*case_cells(rung))
    ladder.add_section()
    ladder.add_row(*rigid_cells(study))
    limits = Table("limit of", title="Limit for infinite stiffness", title_justify="left")
    for heading in ("value", "±", "rigid", "difference", "inside?", "rate", "95 % interval", "last distance"):
        limits.add_column(heading, justify="right", no_wrap=True)
    for row in limit_rows(study):
        limits.add_row(*row)
    failed = [f"Foundation {number(r.contact_stiffness, 3)} failed: {r.outcome.failure}" for r in study.failures]
    loose = any(not r.outcome.resolved for r in study.rungs if not r.outcome.failure)
    star = ["* The numerical error is more than a tenth of the distance to the rigid hoop."] if loose else []
    return [ladder, *star, *failed, limits, law_sentence(study), damping_sentence(study), verdict(study)]


def limit_tables(study: LimitStudy) -> list[Any]:
    """The answer, the events, the prediction and what is observed."""
    from ..limit import summary

    def table(title: str, heading: list[str], rows: list[list[str]]) -> Table:
        made = Table(*heading, title=title, title_justify="left")
        for row in rows:
            made.add_row(*row)
        return made

    return [
        summary.verdict(study),
        *summary.damping_sentences(study),
        "J_F/J_N by what is compliant: " + "; ".join(summary.other_sentences(study)) + ".",
        table("Events of the first pulse, their layers on the clock τ = (t − t*)/ε", summary.EVENT_HEADING,
              summary.event_rows(study)),
        table("Prediction", summary.TERM_HEADING, summary.term_rows(study)),
        table("Observed", summary.SIGHT_HEADING, summary.sight_rows(study)),
    ]  # fmt: skip


def map_table(spots: Sequence[Spot]) -> Table:
    """J_F/J_N, foundations across and damping ratios down."""
    foundations = sorted({spot.foundation for spot in spots})
    made = Table("damping", title="J_F/J_N over damping ratio and foundation", title_justify="left")
    for foundation in foundations:
        made.add_column(number(foundation, 3), justify="right")
    for ratio in sorted({spot.damping for spot in spots}):
        row = {spot.foundation: spot.impulse_ratio for spot in spots if spot.damping == ratio}
        made.add_row(number(ratio), *(f"{row[foundation]:.5f}" for foundation in foundations))
    return made


def sweep_table(sweep: SweepTable, most: int = 40) -> Table:
    """The first rows of a sweep's table and the measures one looks at first."""
    records = sweep.records()
    varied = list(sweep.rows[0].values) if sweep.rows else []
    shown = ["impulse_ratio", "friction_loss", "normal_impulse", "peak_normal_force"]
    table = Table(
        *varied,
        "solver",
        "pulse",
        *(MEASURES[name].symbol for name in shown),
        "",
        title=f"{len(records)} rows",
        title_justify="left",
        caption=f"the first {most}; all are in table.csv" if len(records) > most else None,
    )
    for record in records[:most]:
        values = [str(record[key]) for key in varied]
        table.add_row(
            *values,
            record["solver"],
            str(record["pulse"] or "-"),
            *(number(record[name]) for name in shown),
            record["failure"],
        )
    return table
