"""Many scenes: the product of what a TOML file lists, through either solver or both, resumable at any
point."""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid import Scene, SceneError, load_scene, scene_from_dict, scene_to_dict

from .running.case import Case, Outcome
from .running.files import trouble
from .running.history import rows_to_csv
from .running.measures import MEASURES
from .running.runs import run_cases
from .running.solvers import version
from .running.workers import Here, Pool

if TYPE_CHECKING:
    import pandas

BOTH = ("rigid", "flexible")

MAX_CASES = 100_000
"""Cases of a sweep unless more are asked for: a product of lists soon has more than anyone wants to run."""


@dataclass(frozen=True, slots=True)
class Sweep:
    """What a sweep runs: the product of its lists, made one combination after the other when it is asked for."""

    keys: tuple[str, ...]
    """The keys that vary, "hoop.k" for instance."""
    choices: tuple[tuple[Any, ...], ...]
    """The values of each."""
    tables: Mapping[str, Mapping[str, Any]]
    """The scene over which they are laid, as its TOML file would say."""
    solvers: tuple[str, ...]
    """Who runs each scene."""
    histories: bool = False
    """Whether the forces through each pulse are kept too."""

    @property
    def scenes(self) -> int:
        """Number of combinations."""
        return prod(map(len, self.choices))

    @property
    def cases(self) -> int:
        """Number of combinations times solvers."""
        return self.scenes * len(self.solvers)

    @property
    def points(self) -> Iterator[tuple[tuple[Any, ...], Scene | str]]:
        """The values in every combination, and the scene there or the sentence that says why there is none."""
        for values in itertools.product(*self.choices):
            try:
                yield values, scene_from_dict(_filled(self.tables, self.keys, values))
            except SceneError as error:
                yield values, str(error)

    def announcement(self) -> str:
        """How many cases there are, and of what."""
        lists = [f"{len(values)} of {key}" for key, values in zip(self.keys, self.choices, strict=True)]
        factors = [*lists, f"{len(self.solvers)} {'solver' if len(self.solvers) == 1 else 'solvers'}"]
        return f"{self.cases} {'case' if self.cases == 1 else 'cases'}: {' × '.join(factors)}"


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a sweep's table: a scene and a solver, and what came of it."""

    values: dict[str, Any]
    """Values of the keys that vary."""
    solver: str
    """Who ran it."""
    outcome: Outcome
    """The result, or the reason why there is none."""


@dataclass(frozen=True, slots=True, repr=False)
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

    def __repr__(self) -> str:
        return f"Table({len(self.rows)} rows, {self.failures} failed)"

    def _repr_html_(self) -> str:
        return str(self.to_dataframe().to_html(max_rows=20, index=False))

    def to_csv(self) -> str:
        """The table as text, numbers to the last bit."""
        records = self.records()
        return rows_to_csv(list(records[0]), (record.values() for record in records)) if records else ""


def load_sweep(path: str | PathLike[str], solvers: Sequence[str] = (), max_cases: int = MAX_CASES) -> Sweep:
    """A sweep from a TOML file: a scene in which any value may be a list, and a table [sweep].

    ``[sweep]`` may name ``scene`` (a shipped scene or file from which all starts), ``solvers`` ("rigid", "flexible" or
    both) and ``histories``.

    Parameters
    ----------
    path : path
        The file. It is data: whatever it holds, no code of its choice is run.
    solvers : sequence of str, optional
        Who runs each scene in place of those that the file names; here ``module:function`` is possible too.
    max_cases : int
        More cases than this are refused, before any of them is made.

    Raises
    ------
    SceneError
        Not a file, not TOML, an unknown key, no combination that can be, or too many of them.
    """
    path = Path(path)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SceneError(trouble(error, path)) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise SceneError(f"{path} is not TOML: {error}.") from None
    return sweep_from_dict(data, solvers, max_cases)


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


def sweep_from_dict(data: Mapping[str, Any], solvers: Sequence[str] = (), max_cases: int = MAX_CASES) -> Sweep:
    """The sweep that a parsed TOML file describes; see :func:`load_sweep`."""
    settings = data.get("sweep", {})
    if not isinstance(settings, Mapping):
        raise SceneError(f"sweep = {settings!r} is not possible: it is a table, [sweep].")
    for key in settings:
        if key not in ("scene", "solvers", "histories"):
            raise SceneError(f"sweep.{key} is not a key of [sweep]: known are scene, solvers, histories.")
    histories = settings.get("histories", False)
    if not isinstance(histories, bool):
        raise SceneError(f"sweep.histories = {histories!r} is not possible: it is true or false.")
    named = _named(settings.get("solvers", list(BOTH)))
    base = scene_to_dict(load_scene(str(settings["scene"]))) if "scene" in settings else {}
    keys, choices, tables = _varied({part: table for part, table in data.items() if part != "sweep"}, base)
    sweep = Sweep(tuple(keys), tuple(map(tuple, choices)), tables, tuple(solvers) or named, histories)
    if sweep.cases > max_cases:
        raise SceneError(
            f"{sweep.announcement()}. That is more than {max_cases}: shorten the lists, or allow it by --max-cases."
        )
    _check(sweep)
    return sweep


def _named(solvers: Any) -> tuple[str, ...]:
    """The built-in solvers that a file names."""
    names = [solvers] if isinstance(solvers, str) else solvers
    if not isinstance(names, list) or not names or not all(isinstance(name, str) and name in BOTH for name in names):
        code = any(isinstance(name, str) and ":" in name for name in (names if isinstance(names, list) else ()))
        why = " A file names no code: that is said on the command line, --solver module:function." if code else ""
        raise SceneError(f"sweep.solvers = {solvers!r} is not possible: it lists 'rigid', 'flexible' or both.{why}")
    return tuple(dict.fromkeys(names))


def _check(sweep: Sweep) -> None:
    """Some combination can be, and what is wrong in all of them is said at once.

    Raises
    ------
    SceneError
        As the first combination says.
    """
    first: SceneError | None = None
    for values in itertools.product(*sweep.choices):
        try:
            scene_from_dict(_filled(sweep.tables, sweep.keys, values))
        except SceneError as error:
            if " is not a " in str(error) or " is missing" in str(error):
                raise
            first = first or error
        else:
            return
    if first is not None:
        raise first


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


def _filled(tables: Mapping[str, Any], keys: Sequence[str], values: tuple[Any, ...]) -> dict[str, Any]:
    filled = {part: dict(table) for part, table in tables.items()}
    for key, value in zip(keys, values, strict=True):
        part, _, name = key.partition(".")
        filled[part][name] = value
    return filled


def run_sweep(
    sweep: Sweep | str | PathLike[str] | Mapping[str, Any],
    pool: Pool | None = None,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
    say: Callable[[str], None] | None = None,
) -> Table:
    """Run a sweep and give its table.

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
    """
    sweep = as_sweep(sweep)
    asked: list[tuple[dict[str, Any], str, Case | str]] = []
    for values, scene in sweep.points:
        for name in sweep.solvers:
            what = scene if isinstance(scene, str) else Case(name, scene, histories=sweep.histories)
            asked.append((dict(zip(sweep.keys, values, strict=True)), name, what))
    cases = [case for _, _, case in asked if isinstance(case, Case)]
    outcomes = iter(run_cases(cases, pool or Here(), out, progress, forget=True, say=say))
    rows = []
    for at, name, case in asked:
        outcome = next(outcomes) if isinstance(case, Case) else Outcome("", name, {}, version(), failure=case)
        rows.append(Row(at, name, outcome))
    return Table(tuple(rows))
