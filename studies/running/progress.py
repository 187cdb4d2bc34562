"""Progress on stderr: a bar on a terminal, silence elsewhere, never a word on stdout."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_quiet: ContextVar[bool] = ContextVar("quiet", default=False)


@contextmanager
def quietly() -> Iterator[None]:
    """Meanwhile no bars and no announcements, of compiling neither: stderr is left to what went wrong."""
    logger = logging.getLogger("hoop-pulse")
    level, token = logger.level, _quiet.set(True)
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)
        _quiet.reset(token)


def announce(sentence: str) -> None:
    """Say on stderr what a script need not read."""
    if not _quiet.get():
        complain(sentence)


def complain(sentence: str) -> None:
    """Say on stderr what went wrong, to those too who asked for quiet."""
    import click

    click.echo(f"hoop: {sentence}", err=True)


@contextmanager
def bar(title: str) -> Iterator[Callable[[float], None]]:
    """A bar that is told the fraction done, 0 to 1; it shows itself only if stderr is a terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    hidden = _quiet.get() or not console.is_terminal
    with Progress(*columns, console=console, transient=True, disable=hidden) as progress:
        task = progress.add_task(title, total=1.0)
        yield lambda fraction: progress.update(task, completed=min(max(fraction, 0.0), 1.0))
