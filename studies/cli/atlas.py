"""`hoop study atlas`: a map of rigid hoops over two quantities."""

from __future__ import annotations

from pathlib import Path

import click

from rigid import load_scene

from ..running.files import to_json, write_text
from .shared.options import SceneKey, SceneName, as_json, atlas_keys, out_folder
from .shared.results import begin_results, results_folder


@click.command()
@click.argument("scene", default="paper-3.1", type=SceneName())
@as_json
@out_folder("Write atlas.png, atlas.npz and atlas.json here.")
@click.option(
    "--over",
    type=SceneKey(atlas_keys),
    multiple=True,
    metavar="KEY=A:B",
    help="A quantity and its range, twice: across and up. hoop.k=0.02:0.9 and friction.mu=0.02:1 by default; also "
    "hoop.r, hoop.mass_ratio, friction.mu_s, release.phi0_deg, release.omega0, release.slip0, landing.restitution. "
    "release.omega0 is in sqrt(g/R) and release.slip0 in sqrt(g R), of a SCENE in SI units too. "
    "Over two decades or more it runs evenly in the logarithm. One of mu and mu_s alone takes the other with it.",
)
@click.option(
    "--side",
    type=click.IntRange(16, 8192),
    default=1024,
    show_default=True,
    metavar="N",
    help="Squares along a side of the map, rounded up to a multiple of 16.",
)
def atlas(scene: str, as_json: bool, out: Path | None, over: tuple[str, ...], side: int) -> None:
    """A map of a million rigid hoops: what the contact does in the first pulse, and what the pulse takes.

    Hoops are run where neighbours differ; between neighbours that agree the map is filled. The paper's scenes that lie
    in the plane are marked.
    """
    from ..atlas.plane import parse_range, plane
    from ..atlas.study import OVER, atlas_of
    from ..running.progress import bar

    described = load_scene(scene)
    ranges = [parse_range(text) for text in over] or OVER
    plane(described, ranges)  # refused before a folder is made
    target = results_folder(out)
    with bar("atlas") as progress:
        found = atlas_of(described, ranges, side, progress)
    if target is not None:
        from ..plots.style import save

        begin_results(target)
        with bar("picture and data"):
            save(found.plot(), target / "atlas.png")
            found.save(target / "atlas.npz")
            write_text(target / "atlas.json", to_json(found.to_dict()))
    if as_json:
        click.echo(to_json(found.to_dict()))
        return
    from ..atlas.summary import atlas_sheets
    from .shared.tables import show

    show(*atlas_sheets(found))
    if target is not None:
        click.echo(f"The picture is {target / 'atlas.png'}, the data are in {target / 'atlas.npz'}.")
