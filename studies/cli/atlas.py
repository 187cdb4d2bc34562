"""`hoop study atlas`: a map of a million rigid hoops."""

from __future__ import annotations

from pathlib import Path

import click

from rigid import SceneError, load_scene

from ..running.files import folder, to_json, write_text


@click.command()
@click.argument("scene", default="paper-3.1")
@click.option("--json", "as_json", is_flag=True, help="Print JSON on stdout and nothing else.")
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="DIR", help="Write atlas.png, atlas.npz and atlas.json here."
)
@click.option(
    "--over",
    multiple=True,
    metavar="KEY=A:B",
    help="A quantity and its range, twice: across and up. hoop.k=0.02:0.9 and friction.mu=0.02:1 by default; also "
    "hoop.r, hoop.mass_ratio, friction.mu_s, release.phi0_deg, release.omega0, release.slip0, landing.restitution. "
    "Over two decades or more it runs evenly in the logarithm. One of mu and mu_s alone takes the other with it.",
)
@click.option(
    "--side",
    type=click.IntRange(16, 8192),
    default=1024,
    show_default=True,
    metavar="N",
    help="Squares along a side of the map, a multiple of 16.",
)
def atlas(scene: str, as_json: bool, out: Path | None, over: tuple[str, ...], side: int) -> None:
    """A map of a million rigid hoops: what the contact does in the first pulse, and what the pulse takes.

    Hoops are run where neighbours differ; between neighbours that agree the map is filled. The paper's scenes that lie
    in the plane are marked.
    """
    from ..atlas.plane import plane
    from ..atlas.study import OVER, atlas_of
    from ..running.progress import bar

    described = load_scene(scene)
    ranges = [parse_range(text) for text in over] or OVER
    plane(described, ranges)  # refused before a folder is made
    target = folder(out) if out is not None else None
    with bar("atlas") as progress:
        found = atlas_of(described, ranges, side, progress)
    if target is not None:
        from ..plots.style import save

        with bar("picture and data"):
            save(found.plot(), target / "atlas.png")
            found.save(target / "atlas.npz")
            write_text(target / "atlas.json", to_json(found.to_dict()))
    if as_json:
        click.echo(to_json(found.to_dict()))
        return
    from ..plots.sheet import Column, Sheet
    from .tables import show

    told = [region for region in found.regions if region.share >= 5e-5]
    across, up = found.plane.keys
    count, run = f"{found.sequence.size:,}".replace(",", " "), f"{found.found.runs:,}".replace(",", " ")
    show(
        Sheet(
            f"The first pulse over {across} and {up}",
            [Column("phases", [region.phases for region in told], words=True)],
            [Column("of the map [%]", [f"{100 * region.share:.2f}" for region in told])],
        )
    )
    click.echo(f"{count} hoops in {found.seconds:.1f} s by {run} runs, boundaries to a quarter of a square.")
    if target is not None:
        click.echo(f"The picture is {target / 'atlas.png'}, the data are in {target / 'atlas.npz'}.")


def parse_range(text: str) -> tuple[str, float, float]:
    """KEY=A:B as a key and two numbers.

    Raises
    ------
    SceneError
        It is none.
    """
    key, _, ends = text.partition("=")
    try:
        low, high = map(float, ends.split(":"))
    except ValueError:
        raise SceneError(f"--over {text} is not possible: it is KEY=A:B, as hoop.k=0.02:0.9.") from None
    return key.strip(), low, high
