"""Options that several commands have, and what a shell completes of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import click
from click.shell_completion import CompletionItem

from ...running.progress import quietly
from .results import OVERWRITE

F = TypeVar("F", bound=Callable[..., Any])


class Folder(click.Path):
    """The name of a folder: an empty one, which a script's unset variable leaves, is not the current folder."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The name as a path."""
        if not os.fspath(value):
            self.fail("it takes the name of a folder, and this one is empty.", param, ctx)
        return super().convert(value, param, ctx)


class Finite(click.FloatRange):
    """A number of a range, which neither infinity nor what is no number belongs to."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number."""
        number = super().convert(value, param, ctx)
        if not isfinite(number):
            self.fail(f"{number} is not a finite number.", param, ctx)
        return number


class SceneName(click.ParamType):
    """The name of a shipped scene, or a file; with ``places`` also a folder of results."""

    name = "scene"

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """Shipped scenes and the TOML files beside; files and folders where neither begins so."""
        from rigid import scene_names

        here = [path.name for path in sorted(Path().glob("*.toml"))]
        names = [name for name in (*scene_names(), *here) if name.startswith(incomplete)]
        return [CompletionItem(name) for name in names] or [CompletionItem(incomplete, type="file")]


class SceneKey(click.ParamType):
    """KEY=..., of which the shell completes the key: one of ``keys``."""

    name = "key"

    def __init__(self, keys: Callable[[], list[str]]) -> None:
        self._keys = keys

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The keys that begin so."""
        return [CompletionItem(f"{key}=") for key in self._keys() if key.startswith(incomplete)]


class Names(click.ParamType):
    """NAME,NAME,...: any text, of which the shell completes the last name."""

    name = "names"

    def __init__(self, names: Callable[[], list[str]]) -> None:
        self._names = names

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The names that begin like what stands behind the last comma."""
        before, comma, begun = incomplete.rpartition(",")
        return [CompletionItem(f"{before}{comma}{name}") for name in self._names() if name.startswith(begun)]


_ANGLES = ("release.phi0", "ring.weld_half_angle")


def number_keys() -> list[str]:
    """``part.key`` of everything in a scene's file that is a number; angles are in degrees there."""
    from rigid import Scene

    keys = []
    for part, kind in get_type_hints(Scene).items():
        hints = get_type_hints(kind)
        keys += [f"{part}.{field.name}" for field in fields(kind) if hints[field.name] in (int, float, float | None)]
    return [f"{key}_deg" if key in _ANGLES else key for key in keys]


def hop_keys() -> list[str]:
    """Those over which hoops released at rest can be rolled."""
    refused = ("release.omega0", "release.slip0", "run.t_end", "solve.rtol")
    return [key for key in number_keys() if key not in refused]


def atlas_keys() -> list[str]:
    """Those that an atlas can vary."""
    from ...atlas.plane import SYMBOLS

    return list(SYMBOLS)


def field_names() -> list[str]:
    """Fields that a flexible run writes."""
    from flexible.output.fields import FIELDS

    return list(FIELDS)


def colour_names() -> list[str]:
    """Those of them that colour the ring, each a word: of the stress there are its components, "stress xx"."""
    from flexible.output.fields import RING_FIELDS

    return [name for name in RING_FIELDS if name != "stress"]


scene_argument = click.argument("scene", type=SceneName())

as_json = click.option("--json", "as_json", is_flag=True, help="Print JSON on stdout and nothing else.")

workers = click.option(
    "--workers",
    type=click.IntRange(1, 1024),
    metavar="N",
    help="Processes side by side; by default one for each core.",
)


def _address(_: click.Context, __: click.Parameter, value: str | None) -> str | None:
    if value is not None:
        from ...running.workers import ensure_address

        ensure_address(value)
    return value


scheduler = click.option(
    "--scheduler",
    metavar="ADDRESS",
    callback=_address,
    help="Run on the Dask cluster of this scheduler, tcp://host:8786.",
)


def _remember(ctx: click.Context, _: click.Parameter, value: bool) -> None:
    ctx.meta[OVERWRITE] = value


def out_folder(help: str = "Write results into this folder.") -> Callable[[F], F]:
    """``--out DIR``, and ``--overwrite`` for a folder that holds another command's results."""

    def decorate(function: F) -> F:
        out = click.option("--out", type=Folder(), metavar="DIR", help=help)
        overwrite = click.option(
            "--overwrite",
            is_flag=True,
            expose_value=False,
            callback=_remember,
            help="Write into DIR even if it holds another command's results, which go, or files of these names.",
        )
        return out(overwrite(function))

    return decorate


def _hush(ctx: click.Context, _: click.Parameter, value: bool) -> None:
    if value:
        ctx.with_resource(quietly())


class Unread(Exception):
    """The reader of our output has seen enough."""


@contextmanager
def while_read() -> Iterator[None]:
    """click and rich leave with 1 where nobody reads what they print, as after a failure; this comes before that."""
    try:
        yield
    except BrokenPipeError as gone:
        raise Unread from gone
    except SystemExit as left:
        if isinstance(left.__context__, BrokenPipeError):
            raise Unread from left
        raise


class Commands(click.Group):
    """Commands in the order a newcomer meets them, each with ``--quiet``."""

    def make_context(self, *args: Any, **extra: Any) -> click.Context:
        """As usual, but for a help that nobody reads."""
        with while_read():
            return super().make_context(*args, **extra)

    def invoke(self, ctx: click.Context) -> Any:
        """As usual, but for output that nobody reads."""
        with while_read():
            return super().invoke(ctx)

    def list_commands(self, ctx: click.Context) -> list[str]:
        """As they were added."""
        return list(self.commands)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Each with all of its first sentence, over as many lines as that takes."""
        with formatter.section("Commands"):
            formatter.write_dl(
                [(name, command.get_short_help_str(limit=1000)) for name, command in self.commands.items()]
            )

    def add_command(self, cmd: click.Command, name: str | None = None) -> None:
        """Add a command; one that computes gets the option that silences it."""
        if not isinstance(cmd, click.Group) and not any(param.name == "quiet" for param in cmd.params):
            option = click.Option(
                ["--quiet"],
                is_flag=True,
                expose_value=False,
                callback=_hush,
                help="On stderr only what went wrong: no progress, no announcements.",
            )
            cmd.params.append(option)
        super().add_command(cmd, name)
