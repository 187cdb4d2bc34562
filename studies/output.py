"""What a single run leaves in its folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rigid import Motion

from . import history
from .files import StudyError, to_json, write_text


def write_motion(motion: Motion, out: Path) -> None:
    """``motion.json``, ``history.csv`` and, where there is a pulse, ``pulse.png`` into ``out``."""
    write_text(out / "motion.json", to_json(motion.to_dict()))
    write_text(out / "history.csv", history.to_csv(history.whole(motion)))
    if not motion.pulses:
        return
    from . import figures

    through = history.dimensionless(history.through(motion, motion.pulses[0]), motion.scene)
    figures.save(figures.pulse([("", through, figures.RIGID)], "The first pulse"), out / "pulse.png")
    if (ledger := figures.energy(through, "Where the energy is during the first pulse")) is not None:
        figures.save(ledger, out / "energy.png")


def write_fields(motion: Motion, out: Path, progress: Callable[[float], None]) -> None:
    """The ring's displacement and stress through the motion as ``fields.pvd`` and its frames."""
    raise StudyError("--fields is not there yet.")
