"""`hoop bench`, `hoop stress`, `hoop validate`: run time against error, stability over all input, outside truth."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..running.files import StudyError, to_json, write_text
from .shared.options import as_json, out_folder
from .shared.results import begin_results, results_folder

if TYPE_CHECKING:
    from ..bench.race import Result


@click.command()
@click.argument("what", type=click.Choice(["rigid", "flexible", "mesh", "knobs", "contact", "soft", "scaling"]))
@as_json
@out_folder("Write table and figures into this folder.")
@click.option(
    "--peers",
    "peers_too",
    is_flag=True,
    help="Of rigid and flexible: also the other solvers that are installed (Exudyn; of rigid Siconos, solve_nivp).",
)
@click.option("--check", is_flag=True, help="Exit with status 1 if a stated ratio does not hold.")
@click.option("--quick", is_flag=True, help="Fewer settings, fewer repeats.")
@click.pass_context
def bench(
    ctx: click.Context, what: str, as_json: bool, out: Path | None, peers_too: bool, check: bool, quick: bool
) -> None:
    """Run time against error, peak memory, and the ratios that are stated.

    \b
    rigid     a first cycle against forty digits, beside scipy
    flexible  the pulse of a stiff ring against all nodes, knob by knob
    mesh      what elements leave by wall and stiffness, and what they are
              chosen by; 15 minutes, two with --quick
    knobs     what elements, modes, contact points and steps each leave at
              the tolerance that chose them; a quarter of an hour, a minute
              with --quick
    contact   what the places of points, the books and the force at an
              instant leave, steps by tolerance; four minutes, half
              a one with --quick
    soft      pulses of rings that bend far, beside all nodes of the exact
              ring; three quarters of an hour, six minutes with --quick
    scaling   cost against stiffness, turns, mesh, scenes and workers
    """
    from ..machine.kernels import prepare
    from ..machine.processes import Processes, WorkerDied
    from ..running.progress import bar

    if peers_too and what not in ("rigid", "flexible"):
        raise StudyError(f"--peers is not possible with {what}: other solvers are raced in rigid and flexible.")
    target = results_folder(out)
    apart = Processes(1)  # a process that has compiled holds memory, which is measured here
    try:
        apart.submit(prepare, "rigid", "reduced", *(["chain"] if what == "soft" else [])).result()
    except WorkerDied:
        raise StudyError("The process that compiles the solvers died, out of memory perhaps.") from None
    finally:
        apart.stop()
    run = importlib.import_module(f"studies.bench.{what}").bench
    with bar(f"bench {what}") as progress:
        result: Result = run(quick, peers_too, progress)
    if target is not None:
        from ..bench.shown.figures import draw

        begin_results(target)
        write_text(target / f"bench-{what}.json", to_json(result.to_dict()))
        draw(what, result, target)
    if as_json:
        click.echo(to_json(result.to_dict()))
    else:
        from ..bench.shown.tables import bench_tables
        from .shared.tables import show

        show(*bench_tables(result))
        if target is not None:
            click.echo(f"Table and figures are in {target}.")
    missed = [claim for claim in result.claims if not claim.holds]
    if check and missed:
        click.echo(f"hoop: {len(missed)} of {len(result.claims)} stated ratios do not hold.", err=True)
        ctx.exit(1)


@click.command()
@as_json
@out_folder("Write the map of margins here.")
@click.option(
    "--seed", type=click.IntRange(0, 2**31), default=0, metavar="N", help="The sequence of scenes; 0 by default."
)
@click.option(
    "--scenes",
    type=click.IntRange(1, 1_000_000),
    metavar="N",
    help="How many scenes, beside three hoops of many cycles; 3000 by default.",
)
@click.option(
    "--soft", type=click.IntRange(0, 100_000), default=0, metavar="N", help="N more, of any stiffness; 0 by default."
)
@click.option("--quick", is_flag=True, help="Fewer scenes, with fewer steps each: two or three minutes.")
@click.pass_context
def stress(
    ctx: click.Context, as_json: bool, out: Path | None, seed: int, scenes: int | None, soft: int, quick: bool
) -> None:
    """Numerical stability over everything a user can type."""
    from ..running.progress import bar
    from ..stress.run import run_stress

    target = results_folder(out)
    with bar("stress") as progress:
        report = run_stress(scenes, seed, quick, progress, soft)
    if target is not None:
        from ..stress.figures import draw

        begin_results(target)
        write_text(target / "stress.json", to_json(report.to_dict()))
        draw(report, target)
    if as_json:
        click.echo(to_json(report.to_dict()))
    else:
        click.echo(report.text())
    if report.failures:
        ctx.exit(1)


@click.command()
@as_json
@click.pass_context
def validate(ctx: click.Context, as_json: bool) -> None:
    """Everything published or provable, beside what the solvers find; status 1 if a row fails."""
    from ..running.progress import bar
    from ..validate import table

    with bar("validate") as progress:
        rows = table.validate(progress)
    if as_json:
        click.echo(to_json(table.to_dict(rows)))
    else:
        from .shared.tables import screen_width, show

        show(*table.fitted(rows, screen_width()), *table.notes(rows))
    if table.failed(rows):
        ctx.exit(1)
