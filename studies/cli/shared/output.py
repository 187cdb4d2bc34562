"""What a single run leaves in its folder."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid import Motion, Run, Scene
from rigid.output.units import Unit
from rigid.output.whole import try_out

from ...running import history
from ...running.files import StudyError, to_json, trouble, write_text

if TYPE_CHECKING:
    import pandas


def write_motion(motion: Motion, out: Path) -> None:
    """``motion.json``, ``motion.npz`` (``load_motion``), ``history.csv``, ``units.json``; ``pulse.png`` of a pulse."""
    write_text(out / "motion.json", to_json(motion.to_dict()))
    write_text(out / "units.json", to_json(motion.units))
    motion.save(out / "motion.npz")
    write_text(out / "history.csv", history.to_csv(history.whole(motion)))
    if not motion.pulses:
        return
    from ...plots import pulse as figures

    first = motion.pulses[_shown(motion)]
    which = "first whole" if motion.pulses[0].cut and not first.cut else "first"
    title = "A pulse cut by the run" if first.cut else f"The {which} pulse"
    through = history.dimensionless(history.through(motion, first), motion.scene)
    figures.save(figures.pulse([("", through, figures.RIGID)], title), out / "pulse.png")
    if (ledger := figures.energy(through, f"Where the energy is during the {which} pulse")) is not None:
        figures.save(ledger, out / "energy.png")


def _shown(motion: Motion) -> int:
    """Number of the pulse that pictures and fields show: the first whole one, if there is one."""
    return next((number for number, pulse in enumerate(motion.pulses) if not pulse.cut), 0)


def write_frame(table: pandas.DataFrame, path: Path) -> Path:
    """A data frame as CSV, numbers to the last bit."""
    return write_text(path, table.to_csv(index=False, lineterminator="\n"))


def field_wishes(
    frames: int | None = None, times: str | None = None, only: str | None = None, end: float | None = None
) -> dict[str, Any]:
    """What a user typed about fields as arguments of :func:`write_fields`, checked before anything runs.

    ``end`` is the time to which the scene is to be run, where that is known.

    Raises
    ------
    StudyError
        Times that are none, or fields that do not exist.
    """
    from flexible.output.fields import FIELDS

    wishes: dict[str, Any] = {}
    if frames is not None:
        wishes["frames"] = frames
    if times is not None:
        if frames is not None:
            raise StudyError("--frames and --times cannot both be: the times say how many frames there are.")
        try:
            listed = [float(entry) for entry in times.split(",")]
        except ValueError:
            raise StudyError(f"--times {times} is not possible: it takes numbers with commas between them.") from None
        if not all(0 <= time < inf for time in listed):
            raise StudyError(f"--times {times} is not possible: times after the release are finite and from 0.")
        if end is not None and max(listed) > end:
            raise StudyError(f"--times {times} is not possible: the run goes from 0 to run.t_end = {end:g}.")
        wishes["times"] = listed
    if only is not None:
        names = [name.strip() for name in only.split(",") if name.strip()]
        unknown = [name for name in names if name not in FIELDS]
        if unknown or not names:
            raise StudyError(f"--only {only} is not possible: the fields are {', '.join(FIELDS)}.")
        wishes["fields"] = names
    return wishes


def write_fields(motion: Motion, out: Path, progress: Callable[[float], None] | None = None, **wishes: Any) -> None:
    """The ring's displacement, stress and the rest as ``fields.pvd`` and its frames.

    Parameters
    ----------
    motion : Motion
        A flexible motion with its history.
    out : Path
        Folder of the series.
    progress : callable, optional
        Told the fraction done.
    **wishes
        From :func:`field_wishes`; by default all fields through the first whole pulse.

    Raises
    ------
    StudyError
        No such instants, or a folder that cannot be written to.
    """
    from flexible import FlexibleMotion
    from flexible import write_fields as write
    from meshes import SeriesError

    if not isinstance(motion, FlexibleMotion):
        raise StudyError("Only a flexible motion has fields.")
    try:
        write(motion, out, progress=progress, pulse=_shown(motion), **wishes)
    except SeriesError as error:
        raise StudyError(str(error)) from None
    except OSError as error:
        raise StudyError(trouble(error, out)) from None


def write_first_pulse(scene: Scene, out: Path) -> None:
    """Run the scene to its first whole pulse, at the scene's own stiffness, and write its fields."""
    from flexible import simulate

    motion = simulate(scene.replace(run=Run(until="pulse")), history=True)
    write_fields(motion, out)


def write_mesh(scene: Scene, path: Path) -> str:
    """Write the mesh of a scene's ring, in units of R or, of a scene in SI units, in m; say so and how good it is.

    Raises
    ------
    StudyError
        A format that cannot be written.
    """
    from flexible.models.select import ring_for
    from meshes import MeshError, save_mesh

    if not path.parent.is_dir():
        raise StudyError(f"{path} cannot be written: there is no folder {path.parent}.")
    try:
        try_out(path)
        ring = ring_for(scene.to_dimensionless()).mesh
        save_mesh(ring, path, scene.hoop.R)
    except MeshError as error:
        raise StudyError(str(error)) from None
    except OSError as error:
        raise StudyError(trouble(error, path)) from None
    quality = ring.quality()
    return (
        f"{path}: {quality.elements} nine-node quads, {quality.nodes} nodes, lengths in {Unit.LENGTH.label(scene)}.\n"
        f"Area off by {quality.area_error:.1e}, outer length by {quality.outer_length_error:.1e}.\n"
        f"Elements up to {quality.aspect:.2f} times longer than wide."
    )
