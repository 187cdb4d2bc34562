"""`hoop study hop`: does an elastic hoop hop?"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args, get_type_hints

import click

from rigid import Run, Scene, SceneError, load_scene
from rigid.elastic import LAWS

from ..machine.kernels import compile_side_by_side, levels_of, prepare
from ..running.files import to_json, write_text
from ..running.solvers import ensure_accepts
from .shared.options import Finite, SceneKey, SceneName, as_json, hop_keys, out_folder, scheduler, workers
from .shared.results import begin_results, results_folder

if TYPE_CHECKING:
    from ..hop.rolling.asked import HopMap
    from ..hop.study import HopStudy


@click.command()
@click.argument("scene", type=SceneName(), default="paper-3.3-heavier")
@as_json
@out_folder("Write hop.json, figures, a film and report.html here; finished rolls are kept and found again.")
@click.option(
    "--over",
    type=SceneKey(hop_keys),
    multiple=True,
    metavar="KEY=LOW:HIGH:COUNT",
    help="Range of ring.bending_stiffness (0.5:1e4:24 by default), and of one key more (hoop.k, hoop.mass_ratio, "
    "contact.stiffness, friction.mu, ...) for a map; evenly in the logarithm, evenly from 0. Or KEY=VALUE,VALUE,... "
    "hoop.R, m and g change units alone: E I/(m g R^2) and m_h/m stay, whatever they were given by.",
)
@click.option(
    "--bisections",
    type=click.IntRange(0, 30),
    metavar="N",
    help="Of each threshold, 4 by default; 0 is the map alone.",
)
@click.option(
    "--rtol",
    type=Finite(1e-8, 0.5),
    metavar="T",
    help="Tolerance of the rolls, 3e-4 by default; thresholds are held against a third of it.",
)
@click.option(
    "--turns",
    type=click.IntRange(1, 100),
    metavar="N",
    help="Roll to this turn; by default to the scene's own end, which is turn 2 where it says none.",
)
@click.option("--whole", is_flag=True, help="Roll every hoop to its end, also where all is decided before.")
@click.option("--law", type=click.Choice(LAWS), help="Friction law, in place of the scene's.")
@click.option(
    "--level",
    type=click.Choice(["auto", "reduced", "full", "exact", "chain"]),
    help="Level of the ring, in place of the scene's.",
)
@click.option(
    "--peers",
    "peers_too",
    is_flag=True,
    help="In place of a map: three hoops that hop beside Exudyn's ring, each code coarse to fine; some ten minutes.",
)
@workers
@scheduler
@click.pass_context
def hop(
    ctx: click.Context,
    scene: str,
    as_json: bool,
    out: Path | None,
    over: tuple[str, ...],
    bisections: int | None,
    rtol: float | None,
    turns: int | None,
    whole: bool,
    law: str | None,
    level: str | None,
    peers_too: bool,
    workers: int | None,
    scheduler: str | None,
) -> int:
    """The paper's footnote: does the energy stored in hoop and floor make the hoop hop?

    Hoops released at rest roll, flexible throughout, over a range of bending stiffness and one key more; every flight
    is listed with where it begins, how high it goes and where its energy came from.
    """
    if peers_too:
        return _beside(ctx, results_folder(out), as_json)
    from ..hop.study import hop_study
    from ..running.progress import announce, bar, complain
    from ..running.workers import pool

    described = load_scene(scene)
    if law is not None:
        described = described.replace(contact={"law": law})
    if turns is not None:
        described = described.replace(run=Run(turns=turns))
    asked = map_of(described, over, rtol=rtol, bisections=bisections, level=level, whole=whole)
    target = results_folder(out)
    say: Callable[[str], None] = (lambda sentence: None) if as_json else announce
    rolls = f"{asked.count} roll{'s' if asked.count > 1 else ''}"
    closing = asked.bisections and len(asked.stiffness) > 1  # between two stiffnesses
    say(f"{rolls}{f', and up to {3 * (asked.bisections + 2)} more for each threshold line' if closing else ''}.")
    with bar(rolls) as progress, pool(workers, scheduler) as place:
        if scheduler is None:
            prepare(*compile_side_by_side(levels_of(_ends_of(asked)), place.beside))  # once for all workers
        found = hop_study(asked, pool=place, out=target, progress=progress, say=say)
    left = "" if target is None else _write(found, target, ctx.obj)
    if as_json:
        click.echo(to_json(found.to_dict()))
    else:
        from ..hop.summary import hop_sheets
        from .shared.tables import show

        show(*hop_sheets(found))
        if target is not None:
            click.echo(f"{left} are in {target}; open {target / 'report.html'}.")
    early = len(found.unfinished)
    if early:
        complain(f"{early} of {len(found.cases)} rolls stopped before their end; the study says why the first did.")
    return 1 if early else 0


def _beside(ctx: click.Context, target: Path | None, as_json: bool) -> int:
    """Hoops of its own: what else is asked would be left undone."""
    from ..hop import peers
    from ..plots.style import save_both
    from ..running.progress import bar
    from .shared.tables import show

    given = click.core.ParameterSource.COMMANDLINE
    for name in ("scene", "over", "bisections", "rtol", "turns", "whole", "law", "level", "workers", "scheduler"):
        if ctx.get_parameter_source(name) == given:
            raise click.UsageError(f"--peers rolls hoops of its own: it goes without {name.replace('scene', 'SCENE')}.")
    with bar("hops beside other codes") as progress:
        found = peers.rolls(peers.CASES, progress=progress)
    if target is not None:
        begin_results(target)
        write_text(target / "peers.json", to_json(peers.peers_to_dict(found)))
        save_both(peers.peers_figure(found), target / "peers")
    if as_json:
        click.echo(to_json(peers.peers_to_dict(found)))
    else:
        show(*peers.peer_sheets(found))
        if target is not None:
            click.echo(f"Figure and table are in {target}.")
    return 0


def _ends_of(asked: HopMap) -> list[Scene]:
    """The softest and the stiffest roll, between which all others need the same compiled code."""
    ends = (min(asked.stiffness), max(asked.stiffness))
    return [asked.scenes[0].replace(ring={"bending_stiffness": stiffness}) for stiffness in ends]


def parse_over(text: str) -> tuple[str, tuple[Any, ...]]:
    """KEY=LOW:HIGH:COUNT or KEY=VALUE,VALUE,... as a key and its values.

    A range runs evenly in the logarithm; from 0 it runs evenly. Of keys that take whole numbers, a value that is one
    stays it, and a range has those next to its values.

    Raises
    ------
    SceneError
        One sentence on what is wrong.
    """
    import numpy as np

    key, equals, values = text.partition("=")
    key = key.strip()
    wrong = SceneError(f"--over {text} is not possible: it is KEY=LOW:HIGH:COUNT or KEY=VALUE,VALUE,... of numbers.")
    if not equals:
        raise wrong
    if "." not in key:
        raise SceneError(f"--over {text} is not possible: {key or 'KEY'} is a part and its key, such as hoop.k.")
    whole = _takes_whole_numbers(key)
    try:
        if ":" not in values:
            return key, tuple(_value(value, whole) for value in values.split(","))
        low, high, count = values.split(":")
        first, last, number = float(low), float(high), int(count)
    except ValueError:
        raise wrong from None
    if not (0 <= first < last < float("inf")) or not 2 <= number <= 10_000:
        raise SceneError(f"--over {text} is not possible: a range runs upward from 0 or above, in 2 to 10000 values.")
    run = np.linspace(first, last, number) if first == 0 else np.geomspace(first, last, number)
    return key, tuple(sorted({round(value) for value in run.tolist()}) if whole else run.tolist())


def _takes_whole_numbers(key: str) -> bool:
    part, _, name = key.partition(".")
    return int in get_args(get_type_hints(get_type_hints(Scene).get(part, object)).get(name))


def _value(text: str, whole: bool) -> float:
    """Of a list; what is no whole number where one is needed is refused by the scene."""
    value = float(text)
    return int(value) if whole and value.is_integer() else value


def map_of(scene: Scene, over: tuple[str, ...], **settings: Any) -> HopMap:
    """The study that a command line asks for; what it leaves out, or is None, is the map's own.

    Raises
    ------
    SceneError
        A key that no scene has, a value it cannot take, more than one key besides the bending stiffness, or hoops of
        which the flexible solver takes none.
    """
    from ..hop.rolling.asked import STIFFNESS, HopMap

    ranges = [parse_over(text) for text in over]
    keys = [key for key, _ in ranges]
    if len(set(keys)) < len(keys) or len(set(keys) - {STIFFNESS}) > 1:
        raise SceneError(f"--over takes {STIFFNESS} and one key more, each once: it was given {', '.join(keys)}.")
    for key, values in ranges:
        settings |= {"stiffness": values} if key == STIFFNESS else {"second": key, "values": values}
    asked = HopMap(scene, **{name: value for name, value in settings.items() if value is not None})
    refused = [error for line in asked.scenes if (error := _refusal(line)) is not None]
    if len(refused) == len(asked.scenes):
        raise refused[0]
    return asked


def _refusal(scene: Scene) -> SceneError | None:
    try:
        ensure_accepts("flexible", scene)
    except SceneError as error:
        return error
    return None


def _write(found: HopStudy, target: Path, line: str) -> str:
    """All that a study leaves, and what that is; where nothing hops there is no hop to draw."""
    from ..hop.figures import chosen, of_hop
    from ..hop.film import film
    from ..hop.report import hop_report
    from ..plots.style import save_both
    from ..running.progress import bar
    from .shared.output import write_frame

    begin_results(target)
    page = target / "report.html"
    numbers = [
        write_frame(found.to_dataframe(), target / "hop.csv"),
        write_text(target / "hop.json", to_json(found.to_dict())),
        write_text(target / "units.json", to_json(found.units)),
    ]
    with bar("figures, film and report") as progress:
        drawn = chosen(found)
        progress(0.3)
        images = {name: save_both(figure, target / name) for name, figure in of_hop(found, drawn).items()}
        progress(0.5)
        if drawn is not None:
            images["hop"] = film(drawn, target / "hop.gif")
        hop_report(found, images, line, page, numbers)
    return "Figures, table and report" if drawn is None else "Figures, film, table and report"
