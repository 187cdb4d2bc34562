"""Scenes as TOML: files, the paper's cases by name, and one sentence for every mistake.

Keys are those of :mod:`rigid.scene`; angles are in degrees there (``phi0_deg``, ``weld_half_angle_deg``). Not every
angle is that of a float in degrees: one that is not is written in radians too (``phi0``), so that a scene survives
its file to the last bit. A ring that one can hold may be described by its material and section in SI units instead of
a bending stiffness: see :func:`rigid.elastic.ring_of_section`.
"""

from __future__ import annotations

import dataclasses
import sys
import tomllib
import warnings
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from importlib.resources import files
from math import degrees, inf, isclose, nextafter, radians
from os import PathLike
from pathlib import Path
from typing import Any

from .allowed import SceneError, in_radians, plain, shown, unknown
from .elastic import SECTION, UNITS, require_section, ring_of_section
from .output.units import Unit, units_of
from .scene import PARTS, Scene

SceneLike = Scene | str | PathLike[str] | Mapping[str, Any]
"""What a solver takes for a scene: one, the name of a shipped one, the path of a file, what a file says as a dict."""

_NEEDED = {"hoop": ("k",), "friction": ("mu_s", "mu"), "release": ("phi0_deg",)}
_AGREEABLE = {"hoop": {"k": 0.5}, "friction": {"mu_s": 1e9, "mu": 0.0}, "release": {"phi0": 0.0}}
"""What every possible value of another key of the table can stand beside."""

_IN_DEGREES = {"phi0": "phi0_deg", "weld_half_angle": "weld_half_angle_deg"}
_IN_SI = {"hoop.R": "m", "hoop.m": "kg", "hoop.g": "m/s²", "ring.youngs_modulus": "Pa", "ring.density": "kg/m³"}
_IN_SI |= {f"ring.{key}": "m" for key in SECTION if f"ring.{key}" not in _IN_SI}


def _file_keys(part: str) -> dict[str, str]:
    """Key in a file -> field of the part, for one part of a scene."""
    return {_IN_DEGREES.get(f.name, f.name): f.name for f in dataclasses.fields(PARTS[part])}


def _exact_degrees(angle: float) -> float:
    """Degrees that ``radians`` turns back into ``angle`` to the last bit if there are any."""
    value = degrees(angle)
    for candidate in (round(value, 12), value, nextafter(value, inf), nextafter(value, -inf)):
        if radians(candidate) == angle:
            return candidate
    return value


def scene_from_dict(data: Mapping[str, Any]) -> Scene:
    """The scene that a parsed TOML file describes.

    Raises
    ------
    SceneError
        One sentence with the key, the value and what is allowed.
    """
    parts: dict[str, Any] = {}
    _ensure_known(data)
    data = _without_section(data)
    _ensure_all_units(data.get("hoop", {}))
    for part, table in data.items():
        keys = _file_keys(part)
        values = {}
        for key, value in table.items():
            if _is_beside(part, key, table):
                continue
            name, value = keys[key], plain(f"{part}.{key}", value)
            values[name] = in_radians(f"{part}.{key}", value) if name in _IN_DEGREES else value
        values |= _to_the_last_bit(part, table, values)
        parts[part] = values
    _point_mass(data.get("hoop", {}), parts)
    for part, needed in _NEEDED.items():
        for key in needed:
            if _file_keys(part)[key] not in parts.get(part, {}):
                raise SceneError(f"{part}.{key} is missing: a scene needs it.")
    return Scene(**{part: PARTS[part](**values) for part, values in parts.items()})


def ensure_possible(part: str, key: str, value: Any) -> None:
    """Whether some scene can have this value, beside whatever else.

    Raises
    ------
    SceneError
        There is no such key, or no scene with this value.
    """
    _ensure_known({part: {key: value}})
    if part == "ring" and key in SECTION:
        require_section(key, plain(f"{part}.{key}", value))
    elif key == "point_mass":
        _point_mass({key: value}, {part: {}})
    else:
        others = {name: its for name, its in _AGREEABLE.get(part, {}).items() if _IN_DEGREES.get(name) != key}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of an angle: the scene with it says that again
            PARTS[part](**others | {key: value})


def _ensure_all_units(hoop: Mapping[str, Any]) -> None:
    """Whether SI units are those of lengths, masses and gravity, or of none, whatever the numbers: nobody's g is 1."""
    given = [key for key in UNITS if key in hoop]
    missing = [key for key in UNITS if key not in hoop]
    if given and missing:
        others = " and ".join(f"hoop.{key}" for key in missing)
        raise SceneError(f"hoop.{given[0]} is in SI units: {others} must be given in them too.")


def _no_part(name: str) -> SceneError:
    """What to say of a table that no scene has: where a key of that name stands, if it is one."""
    for part in PARTS:
        if name in _file_keys(part):
            return SceneError(f"{name} is not a part of a scene: it is a key of [{part}].")
    return unknown("part of a scene", name, list(PARTS))


def _ensure_known(data: Mapping[str, Any]) -> None:
    """Whether all keys are a scene's, before what one that is written wrong leaves out is missed."""
    if not isinstance(data, Mapping):
        raise SceneError(f"{shown(data)} is not a scene: that is a table of {', '.join(PARTS)}.")
    for part, table in data.items():
        if part not in PARTS:
            raise _no_part(str(part))
        if not isinstance(table, Mapping):
            raise SceneError(f"{part} = {table!r} is not possible: {part} is a table, [{part}].")
        known = [*_file_keys(part), *(SECTION if part == "ring" else ())]
        for key in table:
            if key not in known and not _is_beside(part, key, table):
                raise unknown(f"key of [{part}]", f"{part}.{key}", known)


def _is_beside(part: str, key: str, table: Mapping[str, Any]) -> bool:
    """Whether a key says what another one does: a point mass, or an angle in radians beside its degrees."""
    return (key == "point_mass" and part == "hoop") or _IN_DEGREES.get(key) in table


def _without_section(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """The same with a section in SI units turned into bending stiffness, radii and mass without units."""
    ring, hoop = data.get("ring"), data.get("hoop")
    if not isinstance(ring, Mapping) or not isinstance(hoop, Mapping) or not set(SECTION) & set(ring):
        return data
    of_ring, of_hoop = ring_of_section(ring, hoop)
    kept = {key: value for key, value in ring.items() if key not in SECTION}
    return {**data, "ring": kept | of_ring, "hoop": {**hoop, **of_hoop}}


def _to_the_last_bit(part: str, table: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, float]:
    """Angles that stand in radians beside their degrees."""
    exact = {}
    for name, key in _IN_DEGREES.items():
        if name in table and key in table:
            angle = table[name]
            number = isinstance(angle, (int, float)) and abs(angle) <= sys.float_info.max
            if not number or not isclose(angle, values[name], rel_tol=1e-14):
                told = f"give {key}; beside that it must be {key} in radians."
                raise SceneError(f"{part}.{name} = {shown(angle)} is not possible: {told}")
            exact[name] = float(angle)
    return exact


def _point_mass(hoop: Mapping[str, Any], parts: dict[str, Any]) -> None:
    """``point_mass = true`` asks for k = 0 on a massless hoop of no wall."""
    asked = hoop.get("point_mass", False)
    if not isinstance(asked, bool):
        raise SceneError(f"hoop.point_mass = {asked!r} is not possible: it is true or false.")
    if asked:
        for key, only in (("k", 0), ("mass_ratio", 0), ("r", 1)):
            if hoop.get(key, only) != only:
                raise SceneError(
                    f"hoop.{key} = {hoop[key]!r} is not possible: with point_mass = true it must be {only}."
                )
        parts["hoop"] |= {"k": 0.0}


def scene_to_dict(scene: SceneLike) -> dict[str, dict[str, Any]]:
    """A scene, or what says which, as the nested dict of its TOML file; keys that say nothing are left out."""
    scene = as_scene(scene)
    data: dict[str, dict[str, Any]] = {}
    for part in PARTS:
        table = {}
        for key, name in _file_keys(part).items():
            value = getattr(getattr(scene, part), name)
            if value is not None:
                table[key] = _exact_degrees(value) if name in _IN_DEGREES else value
                if name in _IN_DEGREES and radians(table[key]) != value:
                    table[name] = value
        data[part] = table
    return data


def scene_names() -> list[str]:
    """Names of the scenes that ship with the package."""
    return sorted(
        entry.name.removesuffix(".toml") for entry in files("rigid.scenes").iterdir() if entry.name.endswith(".toml")
    )


def as_scene(source: SceneLike) -> Scene:
    """A scene from whatever says which: see ``SceneLike``.

    Raises
    ------
    SceneError
        No such scene, or one that cannot be.
    """
    if isinstance(source, Scene):
        return source
    if isinstance(source, Mapping):
        return scene_from_dict(source)
    if isinstance(source, (str, PathLike)):
        return load_scene(source)
    raise SceneError(f"{source!r} is not a scene: it must be a Scene, a name, the path of a file, or a dict.")


def scene_text(name: str) -> str:
    """The TOML of a shipped scene.

    Raises
    ------
    SceneError
        There is no scene of that name.
    """
    if name not in scene_names():
        load_scene(name)  # says which names are near
        raise SceneError(f"{name} is a file, not a shipped scene: it can be read as it is.")
    return (files("rigid.scenes") / f"{name}.toml").read_text(encoding="utf-8")


def load_scene(source: str | PathLike[str]) -> Scene:
    """A scene by the name of a shipped one ("paper-3.1"), or by the path of a TOML file ("./paper-3.1", called so).

    Raises
    ------
    SceneError
        No such scene, not TOML, or a scene that cannot be.
    """
    return scene_from_dict(scene_tables(source))


def units_of_keys(keys: Iterable[str], scene: Scene) -> dict[str, str]:
    """What a number that stands at a key of a scene's file is in, by key; "1" for a pure number.

    Parameters
    ----------
    keys : iterable of str
        With their tables, "hoop.k".
    scene : Scene
        In whose units numbers with a dimension are read.
    """
    found = {}
    for name in keys:
        part, _, key = name.partition(".")
        said = units_of(PARTS[part]).get(key, Unit.NUMBER) if part in ("release", "run") else Unit.NUMBER
        in_file = "°" if key in _IN_DEGREES.values() else said.label(scene) or "1"
        found[name] = in_file if scene.dimensionless else _IN_SI.get(name, in_file)
    return found


def scene_tables(source: str | PathLike[str]) -> dict[str, Any]:
    """What the file of a scene says, in its own words: a section in SI units too, of which a scene knows no more.

    Raises
    ------
    SceneError
        No such scene, or not TOML.
    """
    if not isinstance(source, (str, PathLike)):
        raise SceneError(f"{source!r} is neither the name of a scene nor the path of a file.")
    if source in scene_names():  # whatever else is called so here
        return tomllib.loads(scene_text(str(source)))
    path = Path(source)
    try:
        # a pipe too; an editor may begin it with a mark
        text = path.read_text(encoding="utf-8-sig") if path.exists() and not path.is_dir() else None
    except UnicodeDecodeError:
        raise SceneError(f"{path} is not a scene: it is not text.") from None
    except OSError as error:
        raise SceneError(f"{path} cannot be read: {error.strerror}.") from None
    if text is None:
        near = get_close_matches(str(source), scene_names(), n=3) or scene_names()
        raise SceneError(f"{str(source) or repr('')} is neither a file nor the name of a scene: try {', '.join(near)}.")
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is a ValueError
        raise SceneError(f"{source} is not TOML: {error}.") from None
