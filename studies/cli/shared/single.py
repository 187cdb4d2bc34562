"""One motion for the command line: run, interrupted where the user asks, written, printed."""

from __future__ import annotations

import shlex
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any

import click

from rigid import Motion, Scene

from ...running.files import StudyError, to_json
from ...running.progress import bar
from ...running.solvers import ensure_accepts, solver
from .results import begin_results, results_folder

if TYPE_CHECKING:
    from flexible import FlexibleMotion

SAVED = "motion.npz"


def one_rigid(scene: Scene, as_json: bool, out: Path | None) -> int:
    """Run, write, print; the exit status is 1 for a motion that stops before what was asked."""
    target = results_folder(out)
    motion = solver("rigid")(scene, history=target is not None)
    return _told(motion, target, as_json, None)


def one_flexible(
    name: str, scene: Scene, as_json: bool, out: Path | None, earlier: Path | None, wishes: dict[str, Any] | None
) -> int:
    """The same of the flexible hoop; interrupted, with a folder, it leaves there what it has and can be gone on from.

    Parameters
    ----------
    name : str
        Of the scene, as it was typed.
    earlier : Path, optional
        Folder of an earlier run to go on from; also where to write, if ``out`` says nothing else.
    wishes : dict, optional
        What fields are wanted.
    """
    from flexible import simulate

    from ...machine.kernels import compile_on_all_cores, levels_of

    resume = None if earlier is None else _earlier(earlier)
    ensure_accepts("flexible", scene)
    target = results_folder(out if out is not None else earlier)
    compile_on_all_cores(levels_of([scene]))
    with bar("flexible hoop") as progress, _interrupts(target is not None) as stop:
        try:
            motion = simulate(scene, history=target is not None, progress=progress, resume=resume, stop=stop)
        except ValueError as error:
            if resume is None:
                raise
            raise StudyError(f"--continue {earlier} is not possible: {error}") from None
    if resume is not None and target == earlier and motion.t_end < resume.t_end:
        raise StudyError(
            f"--continue {earlier} is not possible: the run there ends at t = {resume.t_end:g}, behind"
            f" {motion.t_end:g} where {name} ends; --out DIR writes the shorter one elsewhere."
        )
    cut = target is not None and stop()
    stays = resume is not None and motion == resume and target == earlier and (cut or wishes is None)
    had = resume is not None and target is not None and (target / "fields.pvd").exists()
    # nothing was left to do, or nothing done yet: what is there stays
    status = _told(motion, None, as_json, None) if stays else _told(motion, target, as_json, None if cut else wishes)
    if had and wishes is None and not stays:
        click.echo(f"hoop: The fields in {target} were of the motion before, and are gone; --fields makes new ones.",
                   err=True)  # fmt: skip
    if cut:
        fields = "" if wishes is None else " --fields"
        onward = f"hoop flexible {shlex.quote(name)} --continue {shlex.quote(str(target))}{fields}"
        click.echo(f"hoop: {onward} goes on{', and writes the fields' if fields else ''}.", err=True)
        return 130
    return status


def _earlier(folder: Path) -> FlexibleMotion:
    from flexible import FlexibleMotion, load_motion
    from rigid import MotionFileError

    try:
        found = load_motion(folder / SAVED)
    except MotionFileError as error:
        raise StudyError(f"--continue {folder} is not possible: {error}") from None
    if not isinstance(found, FlexibleMotion):
        raise StudyError(f"--continue {folder} is not possible: it holds a motion of the rigid hoop.")
    return found


@contextmanager
def _interrupts(caught: bool) -> Iterator[Callable[[], bool]]:
    """Ctrl-C, or what a batch system ends a job with, asks the motion to stop, once; a second one is as usual. Whether
    it was asked is what comes out.

    What takes both stays in place: signals wait while compiled code runs, and one put in its place would not.
    """
    asked = threading.Event()
    if not caught or threading.current_thread() is not threading.main_thread():
        yield asked.is_set
        return

    def note(number: int, frame: FrameType | None) -> None:
        handler = before[signal.Signals(number)]
        if asked.is_set() and callable(handler):
            handler(number, frame)
        elif asked.is_set():
            signal.signal(number, handler)
            signal.raise_signal(signal.Signals(number))
        asked.set()

    before = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield asked.is_set
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _told(motion: Motion, target: Path | None, as_json: bool, wishes: dict[str, Any] | None) -> int:
    lost = ""
    if target is not None:
        from .output import write_fields, write_motion

        begin_results(target)
        write_motion(motion, target)
        if wishes is not None:
            try:
                with bar("fields") as progress:
                    write_fields(motion, target, progress, **wishes)
            except StudyError as error:  # the motion is there all the same
                lost = f"No fields were written{' at --times' if 'times' in wishes else ''}: {error}"
    if as_json:
        click.echo(to_json(motion.to_dict()))
    else:
        from .tables import motion_tables, show

        show(*motion_tables(motion))
    if lost:
        click.echo(f"hoop: {lost}", err=True)
    if not motion.completed:
        click.echo(f"hoop: {motion.ended}.", err=True)
    return 0 if motion.completed and not lost else 1
