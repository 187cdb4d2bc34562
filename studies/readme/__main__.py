"""The pictures and numbers of the README and of the benchmark's page, each with the command that makes it.

    python -m studies.readme                    what there is, and which command makes it
    python -m studies.readme --pictures         make the pictures anew, into .images
    python -m studies.readme --check            run the commands of the numbers; exit 1 where a page says another
    python -m studies.readme --only distance.png --only brush ...

A command runs once, however many pictures and numbers it makes. For developers: it needs a checkout.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

from ..running.files import StudyError
from .again import ROOT, Bench, check, make, stated_text
from .stated import NUMBERS, PICTURES


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--pictures", is_flag=True, help="Make the pictures anew.")
@click.option("--check", "checking", is_flag=True, help="Compare the numbers stated with today's.")
@click.option("--only", multiple=True, metavar="NAME", help="Only this picture or table; may be given several times.")
@click.option("--folder", type=click.Path(path_type=Path), help="Where the commands run and leave their files.")
def main(pictures: bool, checking: bool, only: tuple[str, ...], folder: Path | None) -> None:
    """The pictures and numbers of the README and of the benchmark's page, and the commands that make them."""
    wanted = [picture for picture in PICTURES if not only or picture.name in only]
    numbers = [stated for stated in NUMBERS if not only or stated.table in only]
    if not wanted and not numbers:
        raise click.UsageError(f"{', '.join(only)} is no picture and no table of the pages.")
    if not (pictures or checking):
        for picture in wanted:
            click.echo(f"{picture.name:20} {' && '.join(picture.commands)}")
        for table in dict.fromkeys((stated.table, stated.command) for stated in numbers):
            click.echo("{:20} {}".format(*table))
        return
    if not (ROOT / "README.md").is_file():
        raise click.UsageError("There is no README to compare or to make pictures for: this is an installed package.")
    with tempfile.TemporaryDirectory(prefix="readme-") as temporary:
        place = folder or Path(temporary)
        place.mkdir(parents=True, exist_ok=True)
        bench = Bench(place)
        try:
            if pictures:
                make(wanted, bench)
            wrong = check(numbers, bench, stated_text()) if checking else 0
        except StudyError as error:
            raise click.ClickException(str(error)) from None
    if wrong:
        raise click.ClickException(f"{wrong} of {len(numbers)} numbers stated are not what is printed today.")


if __name__ == "__main__":
    main()
