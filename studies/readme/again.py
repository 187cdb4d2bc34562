"""Run the commands of the README: pictures made anew, numbers compared with what is printed now."""

from __future__ import annotations

import json
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path

import click

from ..running.files import StudyError, write_whole
from .stated import Picture, Stated

ROOT = Path(__file__).parents[2]
IMAGES = ROOT / ".images"
PAGES = ("README.md", "studies/bench/README.md")
"""Where numbers are stated; of words on both the first counts."""


class Bench:
    """A folder in which commands run, each once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.printed = cache(self._run)

    def _run(self, command: str) -> str:
        """What a command prints.

        Raises
        ------
        StudyError
            It failed.
        """
        click.echo(f"$ {command}", err=True)
        program, *words = shlex.split(command)
        hoop = [] if program == "python" else ["-c", "from studies.cli import main; main()"]
        call = [sys.executable, *hoop, *words]
        done = subprocess.run(call, cwd=self.folder, stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode:
            raise StudyError(f"{command} ended with {done.returncode}.")
        return done.stdout


def make(pictures: Sequence[Picture], bench: Bench, into: Path = IMAGES) -> None:
    """Make pictures; each is replaced whole once it is there."""
    for picture in pictures:
        for command in picture.commands:
            bench.printed(command)
        made = bench.folder / picture.made
        if not made.is_file():
            raise StudyError(f"{picture.commands[-1]} left no {picture.made}.")
        write_whole(into / picture.name, partial(shutil.copyfile, made))
        click.echo(f"{picture.name}: made")


def stated_text() -> str:
    """All that states numbers, one page after the other."""
    return "\n".join((ROOT / page).read_text(encoding="utf-8") for page in PAGES)


def check(numbers: Sequence[Stated], bench: Bench, pages: str) -> int:
    """Print each number of the pages beside today's; how many differ or are no longer there."""
    wrong = 0
    for stated in numbers:
        written = stated.written(pages)
        if written is None:
            wrong += 1
            click.echo(f"{stated.table}: no page has anything like {stated.words}")
            continue
        try:
            now = stated.value(json.loads(bench.printed(stated.command)))
        except (StudyError, LookupError, StopIteration, TypeError, ValueError) as error:
            wrong += 1
            click.echo(f"{stated.table}: {written}, but not to be had today: {type(error).__name__} {error}")
            continue
        agrees = stated.agrees(written, now)
        wrong += not agrees
        click.echo(f"{stated.table}: {written}, now {now:.6g}{'' if agrees else ': DIFFERS'}")
    return wrong
