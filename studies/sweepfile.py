"""What a sweep runs, and the TOML file that says so: a scene in which any value may be a list."""

from __future__ import annotations

import itertools
import os
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf, prod
from os import PathLike
from pathlib import Path
from typing import Any

from rigid import Scene, SceneError, scene_from_dict, scene_names, scene_to_dict
from rigid.allowed import require, shown
from rigid.elastic import SECTION, UNITS
from rigid.scenefile import ensure_possible, scene_tables

from .running.files import trouble
from .running.solvers import solver

BOTH = ("rigid", "flexible")

MAX_CASES = 100_000
"""Cases of a sweep unless more are asked for: a product of lists soon has more than anyone wants to run."""


@dataclass(frozen=True)
class Sweep:
    """What a sweep runs: the product of its lists, whose scenes are made when they are asked for, and once.

    Attributes
    ----------
    keys : tuple of str
        The keys that vary, "hoop.k" for instance.
    choices : tuple of tuples
        The values of each key.
    tables : mapping
        The scene over which they are laid, as its TOML file would say.
    solvers : tuple of str
        Who runs each scene.
    histories : bool
        Whether the forces through each pulse are kept too.
    repeated : int
        How many values stood in a list where they stand already, and were left out.
    """

    keys: tuple[str, ...]
    choices: tuple[tuple[Any, ...], ...]
    tables: Mapping[str, Mapping[str, Any]]
    solvers: tuple[str, ...]
    histories: bool = False
    repeated: int = 0

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
        """The values in every combination, and the scene there or the sentence that says why no hoop can have them."""
        return iter(self._made)

    @cached_property
    def _made(self) -> tuple[tuple[tuple[Any, ...], Scene | str], ...]:
        made: list[tuple[tuple[Any, ...], Scene | str]] = []
        for values in itertools.product(*self.choices):
            try:
                made.append((values, scene_from_dict(_filled(self.tables, self.keys, values))))
            except SceneError as error:
                made.append((values, str(error)))
        return tuple(made)

    @property
    def impossible(self) -> int:
        """Number of cases that no hoop can be, mu above mu_s for instance: they are not run."""
        return sum(isinstance(scene, str) for _, scene in self.points) * len(self.solvers)

    @property
    def refusal(self) -> str:
        """What is said of the first combination that no hoop can have; empty where there is none."""
        return next((scene for _, scene in self.points if isinstance(scene, str)), "")

    def announcement(self, made: bool = False) -> str:
        """How many cases there are, and of what; ``made`` also says how many no hoop can be, as its scenes tell."""
        lists = [f"{len(values)} of {key}" for key, values in zip(self.keys, self.choices, strict=True)]
        factors = [*lists, f"{len(self.solvers)} {'solver' if len(self.solvers) == 1 else 'solvers'}"]
        once = " (of equal values one)" if self.repeated else ""
        none = f", {self.impossible} of them no hoop" if made and self.impossible else ""
        return f"{self.cases} {'case' if self.cases == 1 else 'cases'}{none}: {' × '.join(factors)}{once}"


def load_sweep(path: str | PathLike[str], solvers: str | Sequence[str] = (), max_cases: int = MAX_CASES) -> Sweep:
    """A sweep from a TOML file: a scene in which any value may be a list, and a table [sweep].

    ``[sweep]`` may name ``scene`` (a shipped scene or file from which all starts), ``solvers`` ("rigid", "flexible" or
    both) and ``histories``. A scene's file is looked for beside the sweep's first, then in the current folder.

    Parameters
    ----------
    path : path
        The file. It is data: whatever it holds, no code of its choice is run.
    solvers : str or sequence of str, optional
        Who runs each scene in place of those that the file names; here ``module:function`` is possible too.
    max_cases : int
        More cases than this are refused, before any of them is made.

    Raises
    ------
    SceneError
        No path, not a file, not TOML, an unknown key, no combination that can be, or too many of them.
    """
    if not isinstance(path, (str, PathLike)):
        raise SceneError(f"{shown(path)} is not a sweep: that is the path of a TOML file.")
    path = Path(path)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise SceneError(trouble(error, path)) from None
    except UnicodeDecodeError:
        raise SceneError(f"{path} is not a sweep: it is not text.") from None
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{path} is not TOML: {error}.") from None
    settings = data.get("sweep")
    if isinstance(settings, dict) and isinstance(scene := settings.get("scene"), str):
        beside = os.path.join(path.parent, scene)
        if scene not in scene_names() and os.path.isfile(beside):
            settings["scene"] = beside
    return sweep_from_dict(data, solvers, max_cases)


def sweep_from_dict(data: Mapping[str, Any], solvers: str | Sequence[str] = (), max_cases: int = MAX_CASES) -> Sweep:
    """The sweep that a parsed TOML file describes; see :func:`load_sweep`. ``scene`` may be a Scene too."""
    if not isinstance(data, Mapping):
        raise SceneError(f"{shown(data)} is not a sweep: that is a table of the parts of scenes, and sweep.")
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
    laid = {part: table for part, table in data.items() if part != "sweep"}
    base = _base(settings["scene"], laid) if "scene" in settings else {}
    keys, choices, tables, repeated = _varied(laid, base)
    who = (solvers,) if isinstance(solvers, str) or not isinstance(solvers, Iterable) else tuple(solvers)
    for name in who:
        solver(name)
    sweep = Sweep(tuple(keys), tuple(choices), tables, tuple(dict.fromkeys(who)) or named, histories, repeated)
    if sweep.cases > require("max_cases", max_cases, 1, inf, "it is a number of cases, 1 or more"):
        raise SceneError(
            f"{sweep.announcement()}. That is more than {max_cases}: shorten the lists, or allow it:"
            " max_cases, on the command line --max-cases."
        )
    _check(sweep)
    return sweep


#: keys without units of what a section in SI units, or ``point_mass``, says in other words
_RESTATED = {"ring": ("bending_stiffness", "thickness", "section_width"), "hoop": ("k", "r", "mass_ratio")}


def _base(source: Any, laid: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of the scene from which all starts, over which others are to be laid.

    They are its file's own, so that a section in SI units is that of a hoop of another size or mass too; where it is
    what the section says that is laid over them without units, they are what it says of the scene's own.

    Raises
    ------
    SceneError
        No such scene, or what says no scene.
    """
    if not isinstance(source, (Scene, str, PathLike)):
        raise SceneError(f"sweep.scene = {shown(source)} is not possible: it is the name of a scene, or a path.")
    tables = scene_to_dict(source) if isinstance(source, Scene) else scene_tables(source)
    scene = scene_from_dict(tables)
    given = {part: set(table) for part, table in laid.items() if isinstance(table, Mapping)}
    in_units = given.get("hoop", set()) & set(UNITS) or given.get("ring", set()) & set(SECTION)
    restated = any(given.get(part, set()) & set(keys) for part, keys in _RESTATED.items())
    return scene_to_dict(scene) if restated and not in_units else tables


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


def _varied(
    data: Mapping[str, Any], base: Mapping[str, Any]
) -> tuple[list[str], list[tuple[Any, ...]], dict[str, Any], int]:
    """Keys given as lists, their values, the tables of the scene over which they are laid, and how many values recur.

    Raises
    ------
    SceneError
        No table, or a list without a value or with one that no scene can have.
    """
    keys, choices, repeated = [], [], 0
    tables: dict[str, Any] = {part: dict(table) for part, table in base.items()}
    for part, table in data.items():
        if not isinstance(table, Mapping):
            raise SceneError(f"{part} = {table!r} is not possible: {part} is a table, [{part}].")
        if part == "run":
            tables["run"] = {}  # how far to run is said anew, not added to
        for key, value in table.items():
            if isinstance(value, tuple | range) or getattr(value, "ndim", 0) > 0:  # of a dict in a program
                value = value.tolist() if hasattr(value, "tolist") else list(value)
            if isinstance(value, list):
                if not value:
                    raise SceneError(f"{part}.{key} = [] is not possible: a list needs a value.")
                for one in value:
                    if isinstance(one, list | tuple):
                        raise SceneError(f"{part}.{key} = {one!r} is not possible: {part}.{key} is a list of lists.")
                    ensure_possible(part, key, one)
                keys.append(f"{part}.{key}")
                choices.append(tuple(dict.fromkeys(value)))
                repeated += len(value) - len(choices[-1])
            laid = tables.setdefault(part, {})
            laid[key] = value
            if key.endswith("_deg"):  # in radians beside, to the last bit
                laid.pop(key.removesuffix("_deg"), None)
    return keys, choices, tables, repeated


def _filled(tables: Mapping[str, Any], keys: Sequence[str], values: tuple[Any, ...]) -> dict[str, Any]:
    filled = {part: dict(table) for part, table in tables.items()}
    for key, value in zip(keys, values, strict=True):
        part, _, name = key.partition(".")
        filled[part][name] = value
    return filled
