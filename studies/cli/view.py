"""`hoop view ...`: pictures and animations of a run, or a window to look around in."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rigid import Motion, Scene, SceneError, load_scene

from ..running.files import StudyError
from .shared.options import Finite, Names, SceneName, colour_names

if TYPE_CHECKING:
    from meshes import Series

FILE = click.Path(path_type=Path, dir_okay=False)

TIME = "in sqrt(R/g), or in seconds where the scene is in SI units"
SHOWN = "by default so much that the largest displacement is 2 to 6 % of R, not at all where it is more"


@click.command()
@click.argument("path", type=SceneName())
@click.option("--png", type=FILE, metavar="FILE", help="Draw one instant, at --time or else at the peak of N.")
@click.option(
    "--time",
    type=Finite(0),
    metavar="T",
    help=f"The instant of --png, {TIME}; of fields the nearest frame, from their first to their last.",
)
@click.option("--gif", type=FILE, metavar="FILE", help="Animate the run.")
@click.option("--mp4", type=FILE, metavar="FILE", help="Animate the run.")
@click.option("--html", type=FILE, metavar="FILE", help="Animate the run in a page with a slider.")
@click.option("--field", type=Names(colour_names), metavar="NAME", help="What is coloured; von_mises by default.")
@click.option("--factor", type=Finite(0), metavar="X", help=f"How much the deformation is exaggerated; {SHOWN}.")
@click.option("--zoom", type=Finite(1), metavar="X", help="Enlarge what is about the contact, X from 1, the default.")
@click.option("--start", type=Finite(0), metavar="T", help=f"Begin the animation at this time, {TIME}.")
@click.option(
    "--stop", type=Finite(0, min_open=True), metavar="T", help="End it at this time; by default it is the whole run."
)
@click.option(
    "--frames", type=click.IntRange(2, 100_000), metavar="N", help="Frames of the animation, 60 by default, of mp4 150."
)
@click.option("--fps", type=click.IntRange(1, 120), metavar="N", help="Frames per second, 20 by default.")
@click.option(
    "--pace",
    type=click.Choice(["force", "time"]),
    help="Slow motion where N changes (default), or even in time.",
)
def view(
    path: str,
    png: Path | None,
    time: float | None,
    gif: Path | None,
    mp4: Path | None,
    html: Path | None,
    field: str | None,
    factor: float | None,
    zoom: float | None,
    start: float | None,
    stop: float | None,
    frames: int | None,
    fps: int | None,
    pace: str | None,
) -> None:
    """Look at a run.

    PATH is the folder of `hoop flexible ... --out DIR --fields` or of `hoop rigid ... --out DIR`, or a scene, whose
    rigid motion is shown.
    Without a file to draw into, a window opens: space plays, [ and ] change the factor, c the field.
    """
    films = [file for file in (gif, mp4, html) if file is not None]
    given = {"start": start, "stop": stop, "frames": frames, "fps": fps, "pace": pace}
    pacing: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    if pacing and not films:
        raise StudyError(f"--{next(iter(pacing))} needs --gif, --mp4 or --html: it is about an animation.")
    for file, suffix in ((png, ".png"), (gif, ".gif"), (mp4, ".mp4"), (html, ".html")):
        if file is not None and file.suffix.lower() != suffix:
            raise StudyError(f"{file} is not possible: a file for --{suffix[1:]} ends in {suffix}.")
    if time is not None and png is None:
        raise StudyError("--time needs --png FILE: it is the instant that is drawn.")
    if start is not None and stop is not None and start >= stop:
        raise StudyError(f"--start {start:g} is not possible: it must lie before --stop {stop:g}.")

    from meshes import Series, SeriesError
    from meshes.view import Timing, ViewError, animate, picture, require_folder, window

    from ..running.progress import announce, bar

    look: dict[str, Any] = {"field": field, "factor": factor, "zoom": 1.0 if zoom is None else zoom}
    asked = {"time": time, "start": start, "stop": stop}
    files = [file for file in (png, *films) if file is not None]
    drawn: list[Path] = []
    try:
        for file in files:
            require_folder(file)
        thing = _thing(path, asked, field)
        if isinstance(thing, Series):
            _ensure_frames(thing, asked)
        if png is not None:
            picture(thing, png, time, **look)
            drawn.append(png)
            if time is not None and isinstance(thing, Series) and (shown := _shown(thing, time)) != f"{time:.6g}":
                announce(f"{png} shows t = {shown}, the frame nearest to {time:.6g}.")
        for file in films:
            with bar(file.name) as told:
                animate(thing, file, **look, timing=Timing(**pacing), progress=partial(_fraction, told))
            drawn.append(file)
        if not files:
            window(thing, **look)
    except (ViewError, SeriesError) as error:
        raise StudyError(str(error)) from None
    except KeyboardInterrupt as interrupt:
        interrupt.args = _left(files, drawn)
        raise


def _left(files: Sequence[Path], drawn: Sequence[Path]) -> tuple[str, ...]:
    """What there is of some files, for those who broke off: a file is there whole or not at all."""
    lacking = [file for file in files if file not in drawn]
    if not lacking:
        return ()
    said = [
        f"{' and '.join(map(str, some))} {'is' if len(some) == 1 else 'are'} {how}"
        for some, how in ((drawn, "written"), (lacking, "not written"))
        if some
    ]
    return (", ".join(said), f"the same command again draws {'them all' if drawn else 'from the start'}")


def _ensure_frames(series: Series, asked: Mapping[str, float | None]) -> None:
    """Fields may be those of a part of a run: what is asked for must lie in it."""
    from meshes.view import as_told

    first, last = series.times[0], series.times[-1]
    for name, value in asked.items():
        if value is not None and not first <= as_told(value, (first, last)) <= last:
            raise StudyError(f"--{name} {value:g} is not possible: the frames go from {_told(first)} to {_told(last)}.")


def _told(time: float) -> str:
    return f"{time:.6g}"


def _shown(series: Series, time: float) -> str:
    return _told(series.times[series.nearest_index(time)])


def _fraction(told: Callable[[float], None], done: int, total: int) -> None:
    told(done / max(total, 1))


def _thing(path: str, asked: Mapping[str, float | None], field: str | None) -> Series | Motion:
    """The field series at ``path``, the rigid motion that is kept there, or that of the scene that it names.

    The motion is run when what is asked of it can be, as far as the scene knows.
    """
    place = Path(path)
    kept = place / "motion.npz"
    if kept.is_file() and not (place / "fields.pvd").exists():
        return _kept(place, kept, field)
    if place.is_dir() or place.suffix in (".pvd", ".vtu", ".vtk", ".vtp"):
        from meshes import read

        return read(place)
    from ..running.solvers import solver

    try:
        scene = load_scene(path)
    except SceneError as error:
        if place.exists():
            raise
        raise StudyError(f"There is no folder {path!r}, and {error}") from None
    _ensure_no_field(path, field)
    _ensure_run(scene, asked)
    return solver("rigid")(scene)


def _kept(folder: Path, file: Path, field: str | None) -> Motion:
    """The rigid motion that `hoop rigid` left in a folder."""
    from flexible import FlexibleMotion, load_motion
    from rigid import MotionFileError

    try:
        motion = load_motion(file)
    except MotionFileError as error:
        raise StudyError(str(error)) from None
    if isinstance(motion, FlexibleMotion):
        raise StudyError(
            f"{folder} holds a flexible motion and no fields of it: `hoop flexible ... --out {folder} --fields` "
            "writes them."
        )
    _ensure_no_field(str(folder), field)
    return motion


def _ensure_no_field(path: str, field: str | None) -> None:
    if field is not None:
        raise StudyError(f"--field {field} is not possible: the rigid motion of {path} has no fields.")


def _ensure_run(scene: Scene, asked: Mapping[str, float | None]) -> None:
    """A run to a time ends there at the latest, and every run begins at 0."""
    from meshes.view import as_told

    end = scene.run.t_end
    for name, value in asked.items():
        if value is None or end is None:
            continue
        told = as_told(value, (end,))
        if told > end or (told == end and name == "start"):
            raise StudyError(f"--{name} {value:g} is not possible: the run goes from 0 to run.t_end = {_told(end)}.")
