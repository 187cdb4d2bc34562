"""Many scenes: the product of what a TOML file lists, through either solver or both, resumable at any
point."""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid import Scene, SceneError, load_scene, scene_from_dict, scene_to_dict

from .running.case import Case, Outcome
from .running.files import trouble
from .running.history import rows_to_csv
from .running.measures import MEASURES
from .running.runs import run_cases
from .running.solvers import version
from .running.workers import Pool

if TYPE_CHECKING:
    import pandas

BOTH = ("rigid", "flexible")


@dataclass(frozen=True, slots=True)
class Sweep:
    """What a sweep runs: for every combination a scene, or why it cannot be.

    Attributes
    ----------
    keys : tuple of str
        The keys that vary, "hoop.k" for instance.
    points : tuple
        Their values in every combination, and the scene there or the sentence that says why there is none.
    solvers : tuple of str
        Who runs each scene.
    histories : bool
        Whether the forces through each pulse are kept too.
    """

    keys: tuple[str, ...]
    points: tuple[tuple[tuple[Any, ...], Scene | str], ...]
    solvers: tuple[str, ...]
    histories: bool = False


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a sweep's table: a scene and a solver, and what came of it."""

    values: dict[str, Any]
    """Values of the keys that vary."""
    solver: str
    """Who ran it."""
    outcome: Outcome
    """The result, or the reason why there is none."""


@dataclass(frozen=True, slots=True)
class Table:
    """The rows of a sweep, in the order of the product."""

    rows: tuple[Row, ...]

    @property
    def failures(self) -> int:
        """How many rows have a reason instead of a result."""
        return sum(bool(row.outcome.failure) for row in self.rows)

    def records(self) -> list[dict[str, Any]]:
        """One flat record for each pulse of each row, or one for a row without any."""
        records = []
        for row in self.rows:
            found = row.outcome
            head = {**row.values, "solver": row.solver}
            tail = {"ended": found.ended, "failure": found.failure, "key": found.key}
            empty: dict[str, float] = dict.fromkeys(MEASURES, float("nan"))
            for number, pulse in enumerate(found.pulses or (empty,), 1):
                phases = " ".join(found.phases[number - 1]) if found.pulses else ""
                records.append({**head, "pulse": number if found.pulses else 0, **pulse, "phases": phases, **tail})
        return records

    def to_dataframe(self) -> pandas.DataFrame:
        """The table as a pandas data frame."""
        import pandas

        return pandas.DataFrame.from_records(self.records())

    def to_csv(self) -> str:
        """The table as text, numbers to the last bit."""
        records = self.records()
        return rows_to_csv(list(records[0]), (record.values() for record in records)) if records else ""


def load_sweep(path: str | Path) -> Sweep:
    """A sweep from a TOML file: a scene in which any value may be a list, and a table [sweep].

    ``[sweep]`` may name ``scene`` (a shipped scene or file from which all starts), ``solvers`` and
    ``histories``.

    Raises
    ------
    SceneError
        Not a file, not TOML, an unknown key, or no combination that can be.
    """
    path = Path(path)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SceneError(trouble(error, path)) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise SceneError(f"{path} is not TOML: {error}.") from None
    return sweep_from_dict(data)


def sweep_from_dict(data: Mapping[str, Any]) -> Sweep:
    """The sweep that a parsed TOML file describes; see :func:`load_sweep`."""
    settings = data.get("sweep", {})
    if not isinstance(settings, Mapping):
        raise SceneError(f"sweep = {settings!r} is not possible: it is a table, [sweep].")
    for key in settings:
        if key not in ("scene", "solvers", "histories"):
            raise SceneError(f"sweep.{key} is not a key of [sweep]: known are scene, solvers, histories.")
    solvers = settings.get("solvers", list(BOTH))
    solvers = [solvers] if isinstance(solvers, str) else solvers
    if (
        not isinstance(solvers, list)
        or not solvers
        or not all(isinstance(name, str) and (name in BOTH or ":" in name) for name in solvers)
    ):
        raise SceneError(f"sweep.solvers = {solvers!r} is not possible: it lists 'rigid', 'flexible' or both.")
    histories = settings.get("histories", False)
    if not isinstance(histories, bool):
        raise SceneError(f"sweep.histories = {histories!r} is not possible: it is true or false.")
    base = scene_to_dict(load_scene(str(settings["scene"]))) if "scene" in settings else {}
    keys, choices, tables = _varied({part: table for part, table in data.items() if part != "sweep"}, base)
    points: list[tuple[tuple[Any, ...], Scene | str]] = []
    first: SceneError | None = None
    for values in itertools.product(*choices):
        try:
            points.append((values, scene_from_dict(_filled(tables, keys, values))))
        except SceneError as error:
            if " is not a " in str(error) or " is missing" in str(error):
                raise
            first = first or error
            points.append((values, str(error)))
    if first is not None and all(isinstance(scene, str) for _, scene in points):
        raise first
    return Sweep(tuple(keys), tuple(points), tuple(solvers), histories)


def _varied(data: Mapping[str, Any], base: Mapping[str, Any]) -> tuple[list[str], list[list[Any]], dict[str, Any]]:
    """Keys given as lists, their values, and the tables of the scene over which they are laid."""
    keys, choices = [], []
    tables: dict[str, Any] = {part: dict(table) for part, table in base.items()}
    for part, table in data.items():
        if not isinstance(table, Mapping):
            raise SceneError(f"{part} = {table!r} is not possible: {part} is a table, [{part}].")
        if part == "run":
            tables["run"] = {}  # how far to run is said anew, not added to
        for key, value in table.items():
            if isinstance(value, list):
                if not value:
                    raise SceneError(f"{part}.{key} = [] is not possible: a list needs a value.")
                keys.append(f"{part}.{key}")
                choices.append(value)
            tables.setdefault(part, {})[key] = value
    return keys, choices, tables


def _filled(tables: Mapping[str, Any], keys: list[str], values: tuple[Any, ...]) -> dict[str, Any]:
    filled = {part: dict(table) for part, table in tables.items()}
    for key, value in zip(keys, values, strict=True):
        part, _, name = key.partition(".")
        filled[part][name] = value
    return filled


def run_sweep(
    sweep: Sweep, pool: Pool, out: str | Path | None = None, progress: Callable[[float], None] | None = None
) -> Table:
    """Run a sweep and give its table; see :func:`run_cases` for what is kept in ``out``."""
    asked: list[tuple[dict[str, Any], str, Case | str]] = []
    for values, scene in sweep.points:
        for name in sweep.solvers:
            what = scene if isinstance(scene, str) else Case(name, scene, histories=sweep.histories)
            asked.append((dict(zip(sweep.keys, values, strict=True)), name, what))
    outcomes = iter(
        run_cases([case for _, _, case in asked if isinstance(case, Case)], pool, out, progress, forget=True)
    )
    rows = []
    for at, name, case in asked:
        outcome = next(outcomes) if isinstance(case, Case) else Outcome("", name, {}, version(), failure=case)
        rows.append(Row(at, name, outcome))
    return Table(tuple(rows))
