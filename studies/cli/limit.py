"""`hoop study limit`: where stiffness tends to, solved, and what other programs make of it."""

from __future__ import annotations

from pathlib import Path

import click

from rigid import load_scene
from rigid.elastic import LAWS

from ..running.files import to_json, write_text
from .shared.options import Finite, as_json, out_folder, scene_argument, scheduler, workers
from .shared.results import begin_results, results_folder


@click.command()
@scene_argument
@as_json
@out_folder("Write limit.json and limit.csv with their units, figures and report.html here.")
@click.option("--law", type=click.Choice(LAWS), help="Friction law, in place of the scene's.")
@click.option(
    "--damping",
    type=Finite(0),
    metavar="D",
    help="Damping ratio of the patch under the hoop's own weight; by default the scene's own, 0 included.",
)
@click.option(
    "--flexible",
    "foundations",
    type=Finite(0, min_open=True),
    multiple=True,
    metavar="S",
    help="Observe the flexible solver at this foundation, eps_n R^2/(m g), too; may be given several times.",
)
@click.option("--map", "mapped", is_flag=True, help="J_F/J_N over damping ratio and foundation too; a minute or two.")
@click.option(
    "--peers",
    "peers_too",
    is_flag=True,
    help="What MuJoCo, Drake, Exudyn and ipctk tend to, those that are installed; a minute or two.",
)
@workers
@scheduler
@click.pass_obj
def limit(
    line: str,
    scene: str,
    as_json: bool,
    out: Path | None,
    law: str | None,
    damping: float | None,
    foundations: tuple[float, ...],
    mapped: bool,
    peers_too: bool,
    workers: int | None,
    scheduler: str | None,
) -> int:
    """The limit of infinite stiffness solved, not fitted: events, critical damping, and how fast a pulse gets there."""
    from ..limit.damping import damping_map
    from ..limit.study import limit_study
    from ..limit.summary import limit_sheets, map_sheet
    from ..running.progress import bar, complain
    from ..running.workers import pool

    described = load_scene(scene)
    contact = {"law": law, "damping": damping}
    described = described.replace(contact={key: value for key, value in contact.items() if value is not None})
    target = results_folder(out)
    with bar("inner problems") as progress, pool(workers, scheduler) as place:
        found = limit_study(described, flexible=foundations, pool=place, out=target, progress=progress)
        spots = damping_map(found.scene) if mapped else []
    told = found.to_dict() | ({"map": [spot.to_dict() for spot in spots]} if mapped else {})
    more = [map_sheet(spots)] if mapped else []
    if peers_too:
        from ..bench.peers.approach import approach_sheet, approaches

        with bar("other programs") as progress:
            others = list(approaches(found.scene, progress))
        told["peers"] = [other.to_dict() for other in others]
        more.append(approach_sheet(others))
    if target is not None:
        from ..limit.figures import damping_figure, of_limit
        from ..limit.report import limit_report
        from ..plots.style import save_both
        from .shared.output import write_frame

        begin_results(target)
        page = target / "report.html"
        numbers = [
            write_frame(found.to_dataframe(), target / "limit.csv"),
            write_text(target / "limit.json", to_json(told)),
            write_text(target / "units.json", to_json(found.units)),
        ]
        drawn = of_limit(found) | ({"damping": damping_figure(spots)} if mapped else {})
        images = {name: save_both(figure, target / name) for name, figure in drawn.items()}
        limit_report(found, tuple(more), images, line, page, numbers)
    if as_json:
        click.echo(to_json(told))
    else:
        from .shared.tables import show

        show(*limit_sheets(found), *more)
        if target is not None:
            click.echo(f"Figures and limit.json are in {target}; open {target / 'report.html'}.")
    failed = [sight.foundation for sight in found.sights if sight.failure]
    if failed:
        complain(f"{len(failed)} of {len(found.sights)} pulses beside the prediction failed; the study says why.")
    return 1 if failed else 0
