"""The command line: parse, call, print. What is computed lives elsewhere and is imported only when asked for.

Exit status: 0 done; 1 done, but a motion was given up before what was asked, it has no such fields, some case of a
study failed or a check of `bench --check`, `stress` or `validate` does not hold; 2 something the user can mend, in one
sentence; 130 interrupted; 141 nobody reads the output any more.
"""

from __future__ import annotations

import errno
import os
import shlex
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import click

from rigid import SceneError, load_scene

from ..running.files import StudyError, trouble
from .atlas import atlas
from .bench import bench, stress, validate
from .completion import completion
from .hop import hop
from .limit import limit
from .shared.options import Commands, Names, SceneName, Unread, as_json, field_names, out_folder, scene_argument
from .shared.results import begin_results, results_folder
from .shared.single import one_flexible, one_rigid
from .study import study
from .view import view

NEWCOMER = """\
A light hoop with a heavy disk inside its rim rolls on a rough floor. Each time the disk sweeps past the floor
the contact force spikes: an interaction pulse. `rigid` computes the motion in closed form, `flexible` with an
elastic hoop on a compliant floor, `study` what happens between the two as stiffness grows.

\b
Try, in this order:
  hoop rigid paper-3.1               the paper's example, phase by phase
  hoop flexible paper-3.3-massless   the same kind of hoop, elastic
  hoop study stiffness paper-3.3-massless --out study
                                     the limit; then open study/report.html
  hoop scenes                        what else is ready to run
  hoop view paper-3.1 --gif a.gif    a moving picture, with the extra [view]
  hoop COMMAND -h                    the options of a command

SCENE is the name of a shipped scene or a TOML file; `hoop scenes NAME` prints one to start from.
"""


CONTEXT = {"help_option_names": ["-h", "--help"], "max_content_width": 110}


@click.group(cls=Commands, invoke_without_command=True, help=NEWCOMER, context_settings=CONTEXT)
@click.option("--version", "show_version", is_flag=True, help="Show the version and exit.")
@click.pass_context
def hoop(ctx: click.Context, show_version: bool) -> None:
    if show_version:
        from ..machine.build import versions

        click.echo(", ".join(f"{package} {number}" for package, number in versions().items()))
    elif ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())


@hoop.command()
@scene_argument
@as_json
@out_folder()
def rigid(scene: str, as_json: bool, out: Path | None) -> int:
    """Motion of the rigid hoop: phases, turns, pulses."""
    return one_rigid(load_scene(scene), as_json, out)


@hoop.command()
@scene_argument
@as_json
@out_folder()
@click.option(
    "--fields", is_flag=True, help="With --out: also the ring's fields, a PVD series for ParaView, pyvista, hoop view."
)
@click.option(
    "--frames", type=click.IntRange(2, 100_000), metavar="N", help="Frames through the first pulse, 200 by default."
)
@click.option(
    "--times",
    metavar="T,T,...",
    help="Frames at these times instead, in sqrt(R/g), or in seconds where the scene is in SI units; between two steps "
    "of the march N and F of a frame can be some percent off their curves; so can those at the end of a pulse.",
)
@click.option(
    "--only",
    type=Names(field_names),
    metavar="NAME,NAME,...",
    help="Only these fields, von_mises,displacement for instance.",
)
@click.option(
    "--continue",
    "earlier",
    type=click.Path(path_type=Path, exists=True, file_okay=False),
    metavar="DIR",
    help="Go on from the run in this folder, as far as SCENE says now; results go there too without --out.",
)
def flexible(
    scene: str,
    as_json: bool,
    out: Path | None,
    fields: bool,
    frames: int | None,
    times: str | None,
    only: str | None,
    earlier: Path | None,
) -> int:
    """Motion of the flexible hoop, measured like the rigid one, and where the energy went.

    In --out, history.csv has the march's own steps: rows where the hoop is elastic alone, impulses and losses of these
    alone. motion.json has the ledger of all of it.

    Interrupted (Ctrl-C, SIGTERM) it keeps in --out what it has, and --continue goes on from there.
    """
    from .shared.output import field_wishes

    if fields and out is None and earlier is None:
        raise StudyError("--fields needs --out DIR: the fields are files.")
    if not fields and (frames, times, only) != (None, None, None):
        raise StudyError("--frames, --times and --only need --fields, which writes the frames.")
    described = load_scene(scene)
    wishes = field_wishes(frames, times, only, described.run.t_end) if fields else None
    return one_flexible(scene, described, as_json, out, earlier, wishes)


@hoop.command()
@click.argument("name", type=SceneName(), required=False)
def scenes(name: str | None) -> None:
    """List the shipped scenes, or print one as TOML to start your own from."""
    from rigid import scene_names
    from rigid.scenefile import scene_text

    from .shared.tables import screen_width

    if name:
        click.echo(scene_text(name), nl=False)
        return
    firsts = {each: scene_text(each).splitlines()[0] for each in scene_names()}  # a comment that says what it is
    listing = click.HelpFormatter(width=screen_width())
    listing.write_dl([(each, first.lstrip("# ") if first.startswith("#") else "") for each, first in firsts.items()])
    click.echo(listing.getvalue(), nl=False)


@hoop.command()
@scene_argument
@click.argument("file", type=click.Path(path_type=Path))
def mesh(scene: str, file: Path) -> None:
    """Write the ring's mesh; the suffix of FILE says in which format (.msh, .vtu, ...).

    Lengths are in R, or in metres where the scene is in SI units. Cells are numbered ("boundary", in .msh the physical
    group): 0 the quads, 1 lines of the outer rim, 2 of the inner one, 3 of the weld, which lie along the inner one's.
    """
    from .shared.output import write_mesh

    click.echo(write_mesh(load_scene(scene), file))


@hoop.command("compile")
@click.option("--shared", is_flag=True, help="Keep it beside the installation too, for all who use that.")
def compile_(shared: bool) -> None:
    """Compile both solvers for this machine now, not at their first use."""
    from rigid.kernel.store import keeps, share

    from ..machine.kernels import LEVELS, compile_on_all_cores, prepare

    start = time.perf_counter()
    compile_on_all_cores(("rigid", *LEVELS))
    place = prepare("rigid", *LEVELS)
    if not keeps():
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(place))
    kept = share() if shared else place
    click.echo(f"Both solvers are compiled, in {kept}: it took {time.perf_counter() - start:.0f} s.")


study.add_command(limit)
study.add_command(atlas)
study.add_command(hop)
hoop.add_command(study)
hoop.add_command(view)


@hoop.command()
@out_folder()
@click.option(
    "--format",
    "chosen",
    type=click.Choice(["png", "svg", "both"]),
    default="both",
    show_default=True,
    help="What the figures are written as.",
)
def paper(out: Path | None, chosen: str) -> None:
    """The paper's figures 2 to 12 with their points as CSV, and a table of all its numbers beside ours.

    DIR is out-paper unless --out says otherwise. The same table is in table.csv and table.md.
    """
    from ..paper import reproduce, screen
    from ..running.progress import announce, bar
    from .shared.tables import show

    target = results_folder(out if out is not None else Path("out-paper"))
    begin_results(target)
    formats = ("png", "svg") if chosen == "both" else (chosen,)
    with bar("paper") as told:
        verdicts = reproduce(target, formats, progress=lambda done, total, _: told(done / total))
    show(*screen(verdicts))
    announce(f"The paper's figures and numbers are in {target}.")


hoop.add_command(bench)
hoop.add_command(stress)
hoop.add_command(validate)
hoop.add_command(completion)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit status; what a user can mend is one sentence on stderr."""
    line = list(arguments) if arguments is not None else sys.argv[1:]
    if sys.stdout is None:
        return _say("Output cannot be written: stdout is closed.", 2)
    try:
        status: Any = hoop.main(line, prog_name="hoop", standalone_mode=False, obj=shlex.join(["hoop", *line]))
        sys.stdout.flush()
        return status if isinstance(status, int) else 0
    except (SceneError, StudyError) as error:
        return _say(str(error), 2)
    except click.ClickException as error:
        context = getattr(error, "ctx", None)
        hint = f" See {context.command_path} -h." if context is not None else ""
        sentence = " ".join(error.format_message().split())
        return _say((sentence if sentence.endswith((".", "?")) else sentence + ".") + hint, 2)
    except (KeyboardInterrupt, click.Abort) as interrupt:
        kept = "; ".join(["Interrupted", *map(str, (interrupt.__cause__ or interrupt).args)])
        return _say(f"{kept}.", 130)
    except ImportError as error:
        return _say(f"A part of hoop cannot be loaded: {error}.", 2)
    except (Unread, OSError) as error:
        _forget_stdout()
        if isinstance(error, Unread | BrokenPipeError):
            return 141
        return _say(trouble(error), 2)


def _say(sentence: str, status: int) -> int:
    with suppress(OSError):  # nobody can be told
        click.echo(f"hoop: {sentence}", err=True)
    return status


def _forget_stdout() -> None:
    """Stop the interpreter from trying, and failing, to flush stdout once more as it leaves."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
