"""Many scenes: the product of what a TOML file lists, through either solver or both, resumable at any
point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid import SceneError, scene_from_dict
from rigid.elastic import UNITS
from rigid.output.file import version
from rigid.scenefile import units_of_keys

from .running.case import Case, Outcome
from .running.history import records_to_csv
from .running.measures import MEASURES, units_of_measures
from .running.runs import run_cases
from .running.workers import Pool, as_pool
from .sweepfile import Sweep, load_sweep, sweep_from_dict

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a sweep's table: a scene and a solver, and what came of it."""

    values: dict[str, Any]
    """Values of the keys that vary."""
    solver: str
    """Who ran it."""
    outcome: Outcome
    """The result, or the reason why there is none."""

    @property
    def impossible(self) -> bool:
        """Whether no hoop can have these values: the reason says why, and nothing was run."""
        return not self.outcome.scene


@dataclass(frozen=True, slots=True, repr=False)
class Table:
    """The ``rows`` of a sweep, in the order of the product: each has its ``values``, ``solver`` and ``outcome``."""

    rows: tuple[Row, ...]

    @property
    def failures(self) -> int:
        """How many rows that were run have a reason instead of a result."""
        return sum(bool(row.outcome.failure) and not row.impossible for row in self.rows)

    @property
    def impossible(self) -> int:
        """How many rows are of values that no hoop can have; they have the reason, and are no failures."""
        return sum(row.impossible for row in self.rows)

    @property
    def units(self) -> dict[str, str]:
        """What the numbers are in, by column: SI units where any of the scenes is; of keys that vary, as in a file."""
        scenes = [row.outcome.scene for row in self.rows if row.outcome.scene]
        in_si = (scene for scene in scenes if any(scene["hoop"].get(name, 1.0) != 1.0 for name in UNITS))
        scene = next(in_si, scenes[0] if scenes else None)
        if scene is None:
            return {}
        one = scene_from_dict(scene)
        varied = {key for row in self.rows for key, value in row.values.items() if not isinstance(value, (str, bool))}
        keys = [key for key in self.rows[0].values if key in varied]
        return {**units_of_keys(keys, one), "pulse": "1", **units_of_measures(one)}

    def records(self) -> list[dict[str, Any]]:
        """One flat record for each pulse of each row, or one for a row without any."""
        records = []
        # those that the rows were made with: another may have been entered since
        names = dict.fromkeys(name for row in self.rows for pulse in row.outcome.pulses for name in pulse) or MEASURES
        empty: dict[str, float] = dict.fromkeys(names, float("nan"))
        for row in self.rows:
            found = row.outcome
            head = {**row.values, "solver": row.solver}
            tail = {"ended": found.ended, "failure": found.failure, "key": found.key}
            for number, pulse in enumerate(found.pulses or (empty,), 1):
                phases = " ".join(found.phases[number - 1]) if found.pulses else ""
                records.append(
                    {**head, "pulse": number if found.pulses else 0, **empty, **pulse, "phases": phases, **tail}
                )
        return records

    def to_dataframe(self) -> pandas.DataFrame:
        """The table as a pandas data frame."""
        import pandas

        return pandas.DataFrame.from_records(self.records())

    def __repr__(self) -> str:
        none = f", {self.impossible} no hoop" if self.impossible else ""
        return f"Table({len(self.rows)} rows, {self.failures} failed{none})"

    def _repr_html_(self) -> str:
        return str(self.to_dataframe().to_html(max_rows=20, index=False))

    def to_csv(self) -> str:
        """The table as text, numbers to the last bit."""
        return records_to_csv(self.records())


def as_sweep(source: Sweep | str | PathLike[str] | Mapping[str, Any]) -> Sweep:
    """A sweep from whatever says which.

    Raises
    ------
    SceneError
        As of :func:`load_sweep`, or none of these.
    """
    if isinstance(source, Sweep):
        return source
    if isinstance(source, Mapping):
        return sweep_from_dict(source)
    if isinstance(source, (str, PathLike)):
        return load_sweep(source)
    raise SceneError(f"{source!r} is not a sweep: it must be a Sweep, the path of a file, or a dict.")


def run_sweep(
    sweep: Sweep | str | PathLike[str] | Mapping[str, Any],
    pool: Pool | None = None,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
    say: Callable[[str], None] | None = None,
) -> Table:
    """Run a sweep and give its table.

    Combinations that no hoop can have (mu above mu_s) are rows with the reason; they are not run and have not failed.

    Parameters
    ----------
    sweep : Sweep, path or dict
        What to run, or the TOML file that says so (:func:`load_sweep`), or a dict as such a file gives it.
    pool : Pool, optional
        Where (:func:`studies.pool`); by default the cases run here, one after the other.
    out : path, optional
        A folder in which finished cases are kept and found again; see :func:`run_cases`.
    progress : callable, optional
        Told the fraction done.
    say : callable, optional
        Told, in sentences, what was found damaged and what the rest will take.

    Raises
    ------
    SceneError
        As of :func:`load_sweep`.
    StudyError
        ``pool`` is none, or ``out`` cannot be a folder.
    """
    sweep, place = as_sweep(sweep), as_pool(pool)
    asked: list[tuple[dict[str, Any], str, Case | str]] = []
    for values, scene in sweep.points:
        for name in sweep.solvers:
            what = scene if isinstance(scene, str) else Case(name, scene, histories=sweep.histories)
            asked.append((dict(zip(sweep.keys, values, strict=True)), name, what))
    cases = [case for _, _, case in asked if isinstance(case, Case)]
    outcomes = iter(run_cases(cases, place, out, progress, forget=True, say=say))
    rows = []
    for at, name, case in asked:
        outcome = next(outcomes) if isinstance(case, Case) else Outcome("", name, {}, version(), failure=case)
        rows.append(Row(at, name, outcome))
    return Table(tuple(rows))
