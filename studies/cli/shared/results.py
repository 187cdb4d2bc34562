"""The folder that a command writes into: whose it is, what of an earlier run goes, what an interruption leaves."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import overload

import click

from ...running.files import StudyError, folder, trouble, write_text

MADE_BY = "command.txt"
"""What a folder of results says of itself: the command line that wrote it."""

OVERWRITE = "studies.cli.overwrite"
_BEGUN = "studies.cli.begun"


def _drawn(*names: str) -> tuple[str, ...]:
    return tuple(f"{name}.{suffix}" for name in names for suffix in ("png", "svg"))


_MOTION = ("motion.json", "motion.npz", "history.csv", "units.json", "pulse.png", "energy.png")
_FIELDS = ("fields.pvd", "fields/*-*.vtu", "fields/history.npz", "fields/about.json", "fields")
_PAPER = ("figure-[01][0-9]", "extra-inception", "extra-energy")

WRITTEN: dict[str, tuple[str, ...]] = {
    "hoop rigid": _MOTION,
    "hoop flexible": (*_MOTION, *_FIELDS),
    "hoop paper": (*_drawn(*_PAPER), *(f"{name}-*.csv" for name in _PAPER), "table.csv", "table.md"),
    "hoop study stiffness": (
        *("report.html", "study.csv", "study.json", "units.json"),
        *_drawn("pulse", "impulses", "distance", "energy", "series"),
        *_FIELDS,
    ),
    "hoop study limit": (
        "report.html",
        "limit.csv",
        "limit.json",
        "units.json",
        *_drawn("approach", "layers", "damping"),
    ),
    "hoop study hop": (
        *("report.html", "hop.csv", "hop.json", "units.json", "hop.gif", "peers.json"),
        *_drawn("map", "where", "energies", "liftoff", "peers"),
    ),
    "hoop study atlas": ("atlas.png", "atlas.npz", "atlas.json"),
    "hoop study sweep": ("table.csv", "units.json"),
    "hoop bench": ("bench-{what}.json", "bench-{what}.png"),
    "hoop stress": ("stress.json", "stress.png"),
}
"""What a command writes, besides the cases of a study, which any study finds again: they are no scene's results."""

_REPLACED = "motion.npz"
"""Replaced whole by the next run of the same command, which may go on from it: until then it is the only one."""


@overload
def results_folder(path: Path) -> Path: ...
@overload
def results_folder(path: None) -> None: ...
@overload
def results_folder(path: Path | None) -> Path | None: ...
def results_folder(path: Path | None) -> Path | None:
    """The folder of ``--out``, made if need be and marked with the command that writes into it.

    The same command may write into it again, and finds there what it had finished; its earlier results stay until
    :func:`begin_results`.

    Raises
    ------
    StudyError
        --overwrite without a folder; one that holds the results of another command, or files of somebody's that this
        command would write over; nothing can be written into it.
    """
    ctx = click.get_current_context()
    if path is None:
        if ctx.meta.get(OVERWRITE):
            raise StudyError("--overwrite needs --out DIR: without it nothing is written.")
        return None
    files = [*_found(path, ctx.command_path, ctx.params), *path.glob(MADE_BY)]
    held = _held(path)  # after the files: what another run of this command leaves meanwhile comes after its mark
    if not ctx.meta.get(OVERWRITE):
        if held and not _is_of(held, ctx.command_path):
            raise StudyError(f"{path} holds the results of `{held}`: name another folder, or add --overwrite.")
        if not held and files:
            what = files[0].relative_to(path)
            raise StudyError(
                f"{path} holds {what}, which `{ctx.command_path}` would write over and did not write: "
                "name another folder, or add --overwrite."
            )
    made = [place for place in (path, *path.parents) if not place.exists()]
    ctx.with_resource(_left(path, made))
    target = folder(path)
    if not held:
        _mark(target, ctx)
    return target


def begin_results(target: Path) -> None:
    """Remove from a folder what its command's earlier run wrote there, and mark it with this one."""
    ctx = click.get_current_context()
    held = _held(target)
    stale = [
        place
        for command in WRITTEN
        if _is_of(held, command)
        for place in _found(target, command, ctx.params if command == ctx.command_path else {})
        if command != ctx.command_path or place.name != _REPLACED
    ]
    try:
        for place in stale:
            if place.is_dir():
                with suppress(OSError):  # somebody's file in it
                    place.rmdir()
            else:
                place.unlink(missing_ok=True)
    except OSError as error:
        raise StudyError(trouble(error)) from None
    _mark(target, ctx)
    ctx.meta[_BEGUN] = True


def _held(path: Path) -> str:
    """The command line that a folder is marked with, or nothing."""
    try:
        line = (path / MADE_BY).read_text(encoding="utf-8", errors="surrogateescape").strip()
    except OSError:
        return ""
    return line if line.startswith("hoop ") else ""


def _is_of(line: str, command: str) -> bool:
    return f"{line} ".startswith(f"{command} ")


def _found(path: Path, command: str, params: dict[str, object]) -> list[Path]:
    """Files in a folder that have the names of those that a command writes."""
    what = params.get("what", "*")
    return [place for name in WRITTEN.get(command, ()) for place in sorted(path.glob(name.format(what=what)))]


def _mark(target: Path, ctx: click.Context) -> None:
    write_text(target / MADE_BY, f"{ctx.obj or ctx.command_path}\n")


def _is_empty(path: Path) -> bool:
    return [place.name for place in path.iterdir()] == [MADE_BY]


@contextmanager
def _left(path: Path, made: list[Path]) -> Iterator[None]:
    """A command that ends before its first file leaves no folder; an interrupted one says what it left."""
    ctx = click.get_current_context()
    try:
        yield
    except KeyboardInterrupt as interrupt:
        from ...running.store import finished  # SQLite is nothing that a single motion loads

        if cases := finished(path):
            which, them = ("case is", "it") if cases == 1 else ("cases are", "them")
            onward = f"the same command again takes {them} from there"
            interrupt.args = (f"{cases} finished {which} kept in {path}", *(interrupt.args or (onward,)))
        elif ctx.meta.get(_BEGUN) and not _is_empty(path):
            written = f"what was written is in {path}"
            interrupt.args = (written, *(interrupt.args or ("the same command again writes all of it",)))
        raise
    finally:
        with suppress(OSError):
            if _is_empty(path):
                (path / MADE_BY).unlink()
        with suppress(OSError):  # the first that is not empty ends it
            for place in made:
                place.rmdir()
