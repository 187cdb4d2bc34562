"""How results are printed on the screen."""

from __future__ import annotations

import dataclasses
import os
import shutil
import sys
from math import degrees
from typing import TYPE_CHECKING, Any, cast

from rich.console import Console

from rigid import Motion, Scene, scene_from_dict

from ...plots.sheet import Column, Sheet, number
from ...running.measures import MEASURES, Unit, measures, phase_sequence, shortened
from ...stiffness.told.rows import LIMIT_HEADING, case_cells, case_heading, limit_rows, rigid_cells
from ...stiffness.told.sentences import damping_sentence, law_sentence, notes, prediction_sentence, verdict
from .account import HEADING, account, remarks
from .letters import as_printed

if TYPE_CHECKING:
    from flexible import FlexibleMotion

    from ...stiffness.found import StiffnessStudy
    from ...sweep import Row
    from ...sweep import Table as SweepTable

STAR = "* The numerical error is more than a tenth of the distance to the rigid hoop, found or predicted."
_REASONS = 10
"""Failed cases whose reasons are printed; the table has all."""


def screen_width() -> int:
    """Columns of the terminal, or as many as ``COLUMNS`` says; many where stdout is neither."""
    told = "COLUMNS" in os.environ or sys.stdout.isatty()
    return shutil.get_terminal_size().columns if told else 150


def show(*things: Any) -> None:
    """Print tables and sentences on stdout, as wide as the screen."""
    width = screen_width()
    # what is in brackets is a unit, not a colour
    console = Console(width=width, highlight=False, markup=False, emoji=False)
    for thing in things:
        for part in _spelt(thing).tables(width) if isinstance(thing, Sheet) else [thing]:
            console.print(part)


def _spelt(sheet: Sheet) -> Sheet:
    """The same in the letters that stdout has, by whose number the columns are as wide as they are."""

    def spelt(column: Column) -> Column:
        cells = [as_printed(cell) for cell in column.cells]
        return dataclasses.replace(column, heading=as_printed(column.heading), cells=cells)

    keys, columns = map(spelt, sheet.keys), map(spelt, sheet.columns)
    return dataclasses.replace(sheet, title=as_printed(sheet.title), keys=list(keys), columns=list(columns))


def motion_tables(motion: Motion) -> list[Any]:
    """Phases, turns and pulses of a motion, and why it ended."""
    time = f"[{Unit.TIME.label(motion.scene)}]"
    speed = f"[{Unit.VELOCITY.label(motion.scene)}]"
    energy = f"[{Unit.ENERGY.label(motion.scene)}]"
    phases = motion.phases
    shown: list[Any] = [
        Sheet(
            "Phases",
            [Column("phase", [phase.kind.value for phase in phases], words=True)],
            [
                Column(f"from t\n{time}", [number(phase.t_start) for phase in phases]),
                Column(f"to t\n{time}", [number(phase.t_end) for phase in phases]),
                Column("from phi\n[deg]", [number(degrees(phase.phi_start)) for phase in phases]),
                Column("to phi\n[deg]", [number(degrees(phase.phi_end)) for phase in phases]),
            ],
        )
    ]
    if turns := motion.turns:
        shown.append(
            Sheet(
                "Turns of the hoop",
                [Column(f"t\n{time}", [number(turn.t) for turn in turns])],
                [
                    Column("phi\n[deg]", [number(degrees(turn.phi)) for turn in turns]),
                    Column(f"slip velocity\n{speed}", [number(turn.slip_velocity) for turn in turns]),
                    Column(f"energy\n{energy}", [number(turn.energy) for turn in turns]),
                ],
            )
        )
    if motion.pulses:
        headings = [f"pulse {i}{', cut' if pulse.cut else ''}" for i, pulse in enumerate(motion.pulses, 1)]
        shown.append(
            pulse_sheet([(h, measures(motion, p)) for h, p in zip(headings, motion.pulses, strict=True)], motion.scene)
        )
        for heading, pulse in zip(headings, motion.pulses, strict=True):
            shown.append(f"Phases of {heading}: {shortened(phase_sequence(motion, pulse)) or '-'}")
    if any(pulse.cut for pulse in motion.pulses):
        shown.append("cut: the run begins or ends inside this pulse; the measures are those of the part that was run.")
    if hasattr(motion, "ledger"):
        flexible = cast("FlexibleMotion", motion)
        entries = account(flexible)
        terms = Column("where the energy went", [name for name, _ in entries], words=True)
        shown += [Sheet(HEADING, [terms], [Column(energy, [value for _, value in entries])]), *remarks(flexible)]
    shown.append(f"Ended: {motion.ended}")
    return shown


def pulse_sheet(columns: list[tuple[str, dict[str, float]]], scene: Scene) -> Sheet:
    """Measures of pulses side by side, one column for each ``(heading, measures)``."""
    names = [entry.heading(scene).replace("\n", " ") for entry in MEASURES.values()]
    return Sheet(
        "Pulses",
        [Column("measure", names, words=True)],
        [Column(heading, [number(values.get(name)) for name in MEASURES]) for heading, values in columns],
    )


def study_tables(study: StiffnessStudy) -> list[Any]:
    """The ladder rung by rung, the limits, and the answer in words."""
    heading = case_heading(study)
    rows = [case_cells(study, rung) for rung in study.rungs] + [rigid_cells(study)]
    # a rung that failed has a stiffness and nothing more
    filled = [row + ["-"] * (len(heading) - len(row)) for row in rows]
    cells = list(zip(*filled, strict=True))
    columns = [Column(name, column, joined=name == "±") for name, column in zip(heading, cells, strict=True)]
    ladder = Sheet("First pulse over the ladder of stiffness", columns[:1], columns[1:], rules=[len(study.rungs)])
    beside = ("±", "difference", "inside?", "95 %\ninterval")
    limit_columns = [
        Column(name, column, words=name == LIMIT_HEADING[0], joined=name in beside)
        for name, column in zip(LIMIT_HEADING, zip(*limit_rows(study), strict=True), strict=True)
    ]
    limits = Sheet("Limit for infinite stiffness", limit_columns[:1], limit_columns[1:])
    loose = any(not r.outcome.resolved for r in study.rungs if not r.outcome.failure)
    star = [STAR] if loose else []
    foreseen = [prediction_sentence(study)] if study.prediction is not None else []
    return [
        ladder,
        *star,
        *notes(study),
        limits,
        *foreseen,
        law_sentence(study),
        damping_sentence(study),
        verdict(study),
    ]


def sweep_tables(sweep: SweepTable, most: int = 40) -> list[Any]:
    """The first rows of a sweep's table, the measures one looks at first, and why there is none where there is none."""
    records = sweep.records()
    first = records[:most]
    varied = list(sweep.rows[0].values) if sweep.rows else []
    names = ("impulse_ratio", "friction_loss", "normal_impulse", "peak_normal_force")
    keys = [
        *(Column(key.replace(".", ".\n"), [str(record[key]) for record in first]) for key in varied),
        Column("solver", [str(record["solver"]) for record in first], words=True),
        Column("pulse", [str(record["pulse"] or "-") for record in first]),
    ]
    columns = [Column(_heading(sweep, name), [number(record[name]) for record in first]) for name in names]
    shown: list[Any] = [Sheet(f"{len(records)} rows", keys, columns)]
    if len(records) > most:
        shown.append(f"These are the first {most} rows; all are in table.csv.")
    failed = [row for row in sweep.rows if row.outcome.failure and not row.impossible]
    none = {_at(row): row.outcome.failure for row in sweep.rows if row.impossible}  # each once, for all its solvers
    shown += [f"{row.solver}{_at(row)}: {row.outcome.failure}" for row in failed[:_REASONS]]
    if len(failed) > _REASONS:
        shown.append(f"{len(failed) - _REASONS} more failed; table.csv says why.")
    shown += [f"no hoop{where}: {why}" for where, why in [*none.items()][:_REASONS]]
    if len(none) > _REASONS:
        shown.append(f"{len(none) - _REASONS} more are no hoop; table.csv says why.")
    return shown


def _at(row: Row) -> str:
    """The values of a row, as they follow a word."""
    told = ", ".join(f"{key} = {value}" for key, value in row.values.items())
    return f" at {told}" if told else ""


def _heading(sweep: SweepTable, name: str) -> str:
    """A measure with its unit, where all scenes have the same."""
    scenes = [scene_from_dict(row.outcome.scene) for row in sweep.rows if row.outcome.scene]
    headings = {MEASURES[name].heading(scene) for scene in scenes} or {MEASURES[name].symbol}
    return headings.pop() if len(headings) == 1 else f"{MEASURES[name].symbol}\n[its scene's]"
