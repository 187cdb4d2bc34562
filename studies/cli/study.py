"""`hoop study ...`: the limit of stiffness, observed and solved, and sweeps; `hop` is in a file of its own."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rigid import load_scene
from rigid.elastic import LAWS

from ..running.files import StudyError, to_json, write_text
from ..stiffness.ladder import ABOVE, ALONG, BELOW, Ladder
from .shared.options import (
    Commands,
    Finite,
    Unread,
    as_json,
    out_folder,
    scene_argument,
    scheduler,
    while_read,
    workers,
)
from .shared.results import begin_results, results_folder

if TYPE_CHECKING:
    from ..running.workers import Pool
    from ..stiffness.found import StiffnessStudy

LADDER = Ladder()  # whose defaults are those of the command

POSITIVE = Finite(0, min_open=True)

RAISED = "the foundation eps_n R^2/(m g), with --along bending E I/(m g R^2)"

CODE = (
    "The module is imported (PYTHONPATH says from where) and its function called in every worker as "
    "function(scene, *, history=False, progress=None), which gives a rigid.Motion or what has its attributes, "
    "with all that you may do: name only code that you trust."
)


@click.group(cls=Commands, no_args_is_help=False)
def study() -> None:
    """Both solvers over many scenes: the limit of stiffness, sweeps over anything."""


@study.command()
@scene_argument
@as_json
@out_folder("Write table, figures, report.html and the ring's fields here; finished cases are kept and found again.")
@click.option(
    "--along",
    type=click.Choice(ALONG),
    default=LADDER.along,
    help="What is raised: contact foundation, ring bending, or both in the scene's ratio (default).",
)
@click.option("--low", type=POSITIVE, metavar="S", help=f"Softest rung, {RAISED}; by default {BELOW:g} of the scene's.")
@click.option("--high", type=POSITIVE, metavar="S", help=f"Stiffest rung; by default {ABOVE:g} of the scene's.")
@click.option(
    "--count",
    type=click.IntRange(2, 1000),
    default=LADDER.count,
    metavar="N",
    help=f"Number of rungs, {LADDER.count} by default.",
)
@click.option("--law", type=click.Choice(LAWS), help="Friction law, in place of the scene's.")
@click.option(
    "--rate",
    type=POSITIVE,
    metavar="P",
    help="Rate of the extrapolation (1/3 is 0.3333), in place of the contact law's own or a fitted one.",
)
@click.option(
    "--damping",
    type=float,
    metavar="D",
    help="Damping ratio of the patch under the hoop's own weight; by default the scene's own, 0 included.",
)
@click.option(
    "--all-pulses",
    is_flag=True,
    help="Run all pulses of the scene's run, not the first alone; those behind it are in study.json, cases[].pulses.",
)
@click.option(
    "--solver",
    "solver_name",
    default="flexible",
    metavar="MODULE:FUNCTION",
    help="Another solver to compare. " + CODE,
)
@workers
@scheduler
@click.pass_context
def stiffness(
    ctx: click.Context,
    scene: str,
    as_json: bool,
    out: Path | None,
    law: str | None,
    along: str,
    low: float | None,
    high: float | None,
    count: int,
    rate: float | None,
    damping: float | None,
    all_pulses: bool,
    solver_name: str,
    workers: int | None,
    scheduler: str | None,
) -> None:
    """The flexible hoop against the rigid one as stiffness grows."""
    from ..running.progress import bar, complain
    from ..running.solvers import ensure_accepts
    from ..running.workers import pool
    from ..stiffness.study import stiffness_study

    described = load_scene(scene)
    contact = {"law": law, "damping": damping}
    described = described.replace(contact={key: value for key, value in contact.items() if value is not None})
    ladder = Ladder(along, low, high, count).around(described)
    with pool(workers, scheduler) as place:  # whose processes load what they take while this one does
        ensure_accepts(solver_name, described)
        target = results_folder(out)
        with bar(f"{ladder.count} cases") as progress:
            found = stiffness_study(
                described,
                ladder,
                solver=solver_name,
                all_pulses=all_pulses,
                rate=rate,
                pool=place,
                out=target,
                progress=progress,
            )
        write = partial(_write_study, found, target, ctx.obj, solver_name == "flexible", place)
        try:
            with while_read():
                _print_study(found, as_json)  # before the figures, which take a while
        except Unread:  # the files are for later
            write()
            raise
        lost = write()
    if not as_json and target is not None:
        click.echo(f"Figures, tables and report are in {target}; open {target / 'report.html'}.")
    if lost is not None:
        raise lost
    lacking = len(found.failures) + len(found.stopped)
    if lacking:
        complain(f"{lacking} of {len(found.rungs)} cases failed or stopped early; the study says why.")
        ctx.exit(1)


def _print_study(found: StiffnessStudy, as_json: bool) -> None:
    if as_json:
        click.echo(to_json(found.to_dict()))
    else:
        from .shared.tables import show, study_tables

        show(*study_tables(found))


def _write_study(found: StiffnessStudy, target: Path | None, line: str, fields: bool, place: Pool) -> StudyError | None:
    """Into a folder, if there is one; who interrupts it is told how the rest comes."""
    if target is None:
        return None
    try:
        return _write_all(found, target, line, fields, place)
    except KeyboardInterrupt as interrupt:
        interrupt.args = ("figures, fields or report are missing: the same command again makes them and runs no case",)
        raise


def _write_all(found: StiffnessStudy, target: Path, line: str, fields: bool, place: Pool) -> StudyError | None:
    """All that a study leaves, the page last: what it names is there. What kept the fields from being written.

    Figures and fields are made side by side, what takes longest first; a figure whose process dies is drawn here.
    """
    from ..machine.processes import WorkerDied
    from ..running.progress import bar
    from ..stiffness.told.report import CAPTIONS, stiffness_report, write_figure
    from .shared.output import write_first_pulse

    begin_results(target)
    page = target / "report.html"
    written = place.beside(write_first_pulse, found.scene, target) if fields else None
    drawn = {name: place.beside(write_figure, found, name, target) for name in CAPTIONS}
    numbers = [
        write_text(target / "study.csv", found.to_csv()),
        write_text(target / "study.json", to_json(found.to_dict())),
        write_text(target / "units.json", to_json(found.units)),
    ]
    images, lost, beside = {}, None, []
    with bar("figures and fields") as progress:
        for number, (name, figure) in enumerate(drawn.items(), 1):
            try:
                image = figure.result()
            except WorkerDied:
                image = write_figure(found, name, target)
            if image is not None:
                images[name] = image
            progress(number / (len(drawn) + fields))
        if written is not None:
            try:
                written.result()
                where = f"hoop view {target}, ParaView, pyvista"
                beside.append(f"fields.pvd: the ring at the scene's own stiffness; {where}")
            except StudyError as error:
                lost = error
            except WorkerDied:
                lost = StudyError("No fields were written: the process that made them died, out of memory perhaps.")
    stiffness_report(found, images, line, page, numbers, beside)
    return lost


@study.command()
@click.argument("file", type=click.Path(path_type=Path))
@as_json
@out_folder("Folder of the results, by default FILE without .toml; cases finished there are not run again.")
@click.option(
    "--max-cases",
    type=click.IntRange(min=1),
    metavar="N",
    help="Refuse a product of more cases than this, 100000 by default.",
)
@click.option(
    "--solver",
    "solver_names",
    multiple=True,
    metavar="MODULE:FUNCTION",
    help="Who runs the scenes in place of those that FILE names; may be given several times. " + CODE,
)
@workers
@scheduler
@click.pass_context
def sweep(
    ctx: click.Context,
    file: Path,
    as_json: bool,
    out: Path | None,
    max_cases: int | None,
    solver_names: tuple[str, ...],
    workers: int | None,
    scheduler: str | None,
) -> None:
    """The product of everything that FILE lists.

    FILE is a scene in which any value may be a list. A table [sweep] may name the `solvers` ("rigid",
    "flexible"; both by default), a `scene` from which all starts (a shipped one by its name, or a file by the
    path to it from FILE's folder), and ask for `histories = true`. FILE is data: it names no code.

    How many cases there are is said first, and what they will take once the first are done. Combinations that no
    hoop can have (mu above mu_s) are counted there; they are rows with the reason and no failures. A sweep of nothing
    else is refused.
    """
    from ..running.progress import announce, bar, complain
    from ..running.solvers import solver
    from ..running.workers import pool
    from ..sweep import run_sweep
    from ..sweepfile import MAX_CASES, load_sweep

    asked = load_sweep(file, solver_names, max_cases or MAX_CASES)
    for name in asked.solvers:
        solver(name)
    beside = file.with_suffix("") if file.suffix else Path(f"{file}-results")
    target = results_folder(out if out is not None else beside)
    assert target is not None
    if not as_json:
        why = f" No hoop: {asked.refusal}" if asked.refusal else ""
        announce(f"{asked.announcement(made=True)}, into {target}.{why}")
    with bar(f"{asked.cases - asked.impossible} cases") as progress, pool(workers, scheduler) as place:
        table = run_sweep(asked, place, target, progress, announce)
    begin_results(target)
    write_text(target / "table.csv", table.to_csv())
    write_text(target / "units.json", to_json(table.units))
    if as_json:
        click.echo(to_json({"rows": table.records(), "failures": table.failures, "impossible": table.impossible}))
    else:
        from .shared.tables import show, sweep_tables

        show(*sweep_tables(table))
        click.echo(f"The table is in {target / 'table.csv'}.")
    if table.failures:
        ran = len(table.rows) - table.impossible
        complain(f"{table.failures} of {ran} {'case' if ran == 1 else 'cases'} failed; their rows say why.")
        ctx.exit(1)
