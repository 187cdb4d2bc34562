"""What a scene may hold: every refusal is one sentence with the key, the value and what is allowed.

A part of a scene says the same whether it is made by its constructor, changed by ``Scene.replace`` or read from a file.
A file names R, m and g all or none; in Python each of them is 1 if it is not named.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from difflib import get_close_matches
from fractions import Fraction
from functools import wraps
from math import log10, radians
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

C = TypeVar("C")

MOST_DEGREES = 5e10  # 1e9 radians or so: of a larger angle too few digits would be left within a turn

_PACKAGES = ("rigid", "meshes", "flexible", "studies")

_LINE = 60  # characters of a value that a sentence shows

_MEANT = {
    "mu_k": "mu", "mu_d": "mu", "mu_kinetic": "mu", "mu_dynamic": "mu", "mu_static": "mu_s", "mu_0": "mu_s",
    "radius": "R", "mass": "m", "gravity": "g", "nu": "poisson", "omega": "omega0", "slip": "slip0", "tol": "rtol",
}  # fmt: skip
"""What other books call a key."""


WORDS = ("run.until", "contact.law", "solve.level", "solve.resolve", "solve.start", "solve.integrator")
"""Keys whose value is a word; that of all others is a number."""


class SceneError(ValueError):
    """A scene that cannot be: one sentence that names the key, the value and what is allowed."""


def unknown(kind: str, name: str, known: Sequence[str]) -> SceneError:
    """What to say of a key that there is not: the one that was meant, if that can be told, or all that there are."""
    key = name.rpartition(".")[2]
    meant = _MEANT.get(key)
    near = [meant] if meant in known else get_close_matches(key, known, n=1, cutoff=0.7)
    hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}."
    return SceneError(f"{name} is not a {kind}: {hint}")


def users_level() -> int:
    """The ``stacklevel`` by which a warning points at the line outside this project that led to it."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] in _PACKAGES:
        level, frame = level + 1, frame.f_back
    return level


def in_radians(key: str, value: Any) -> float:
    """An angle given in degrees."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SceneError(f"{key} = {shown(value)} is not possible: it must be a number, in degrees.")
    if not abs(value) <= MOST_DEGREES:
        raise SceneError(f"{key} = {shown(value)} is not possible: it must lie between -5e10 and 5e10 degrees.")
    return radians(value)


def plain(key: str, value: Any) -> Any:
    """A number or a word as Python has it, a scalar of numpy's included."""
    value = _item(value)
    if isinstance(value, (list, tuple)):
        told = "hoop study sweep runs the values of a list"
        raise SceneError(f"{key} = {shown(value)} is not possible: {told}.")
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        kind = "word" if key in WORDS else "real number"
        raise SceneError(f"{key} = {shown(value)} is not possible: it must be a {kind}.")
    return value


def _item(value: Any) -> Any:
    """What Python has for a scalar of numpy's, and the float next to a fraction or a decimal; anything else, and what
    is masked, as it is.
    """
    if value is np.ma.masked:
        return value
    if isinstance(value, (Fraction, Decimal)):
        try:
            return float(value)
        except (OverflowError, ValueError):  # none is next to it
            return value
    scalar = isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0)
    return value.item() if scalar else value


def answering(
    name: str | None, degrees: Mapping[str, str] | None = None, in_files: Mapping[str, str] | None = None
) -> Callable[[type[C]], type[C]]:
    """A constructor that answers a wrong key, a missing one or a wrong type as a scene file is answered.

    Parameters
    ----------
    name : str or None
        The table of a scene file that this class stands for; None for the scene, whose keys are its parts.
    degrees : mapping, optional
        Fields that may be given in degrees too, and how they are called then.
    in_files : mapping, optional
        Keys of the table that are no fields, and how to say here what they say.
    """
    angles = {key: field for field, key in (degrees or {}).items()}
    table = "a scene" if name is None else f"[{name}]"
    kind = "part of a scene" if name is None else f"key of {table}"

    def called(key: str) -> str:
        return key if name is None else f"{name}.{key}"

    def decorate(cls: type[C]) -> type[C]:
        create = cls.__init__
        signature = inspect.signature(create)
        fields = [field for field in signature.parameters if field != "self"]
        defaults = {field: signature.parameters[field].default for field in fields}
        needed = [field for field in fields if defaults[field] is inspect.Parameter.empty]

        def checked(field: str, value: Any) -> Any:
            left_out = value is None and defaults.get(field) is None
            return value if name is None or left_out else plain(called(field), value)

        @wraps(create)
        def init(self: Any, *values: Any, **keys: Any) -> None:
            if len(values) > len(fields):
                raise SceneError(f"{table} has {len(fields)} keys, {', '.join(fields)}: {len(values)} were given.")
            given = dict(zip(fields, values, strict=False))
            for key, value in keys.items():
                if key in (in_files or {}):
                    raise SceneError(f"{called(key)} is a key of files and dicts alone: {(in_files or {})[key]}.")
                if key not in fields and key not in angles:
                    raise unknown(kind, called(key), [*fields, *angles])
                field = angles.get(key, key)
                if field in given:
                    raise SceneError(f"{called(key)} = {value!r} is not possible: {called(field)} is given already.")
                given[field] = in_radians(called(key), checked(key, value)) if key in angles else value
            for field in needed:
                if field not in given:
                    raise SceneError(f"{called((degrees or {}).get(field, field))} is missing: a scene needs it.")
            create(self, **{field: checked(field, value) for field, value in given.items()})

        more = [inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=None) for key in angles]
        signed = signature.replace(parameters=[*signature.parameters.values(), *more])
        init.__signature__ = signed  # type: ignore[attr-defined]
        cls.__init__ = init  # type: ignore[method-assign]
        return cls

    return decorate


def require(
    key: str, value: Any, low: float, high: float, allowed: str, *, open_low: bool = False, open_high: bool = False
) -> float:
    """A number as Python has it; refused if it is none from ``low`` to ``high``, which belong to it unless open."""
    value = _item(value)
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if number and abs(value) <= sys.float_info.max:
        above = value > low if open_low else value >= low
        below = value < high if open_high else value <= high
        if above and below:
            return value
    elif number:
        allowed = "it must be a finite number"
    elif isinstance(value, str):
        allowed = "it is text, not a number"
    raise SceneError(f"{key} = {shown(value)} is not possible: {allowed}.")


def require_list(
    key: str, values: Any, low: float, high: float, allowed: str, *, open_low: bool = False
) -> tuple[float, ...]:
    """Numbers in a row as Python has them, a single one too; each as of :func:`require`."""
    one = _item(values)
    if isinstance(one, (int, float)):
        values = (one,)
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, (Sequence, np.ndarray)):
        raise SceneError(f"{key} = {shown(values)} is not possible: it is a number or a list of them.")
    return tuple(require(key, value, low, high, allowed, open_low=open_low) for value in values)


def shown(value: Any) -> str:
    """A value as a sentence can show it: a whole number that no float holds by its power of ten, of others a line."""
    if isinstance(value, int) and abs(value) > sys.float_info.max:
        return f"{'-' if value < 0 else ''}10^{round(value.bit_length() * log10(2))} or so"
    text = " ".join(repr(value).split())
    return text if len(text) <= _LINE else f"{text[: _LINE - 3]}..."


def times_within(t: ArrayLike, end: float, slack: float) -> NDArray[np.float64]:
    """Times of a motion that goes from 0 to ``end``, of any shape; those that ``slack`` has beyond these are at them.

    Raises
    ------
    ValueError
        What is no real number, or lies outside.
    """
    try:
        given = np.asarray(t)
        any_object = given.dtype.kind == "O" and not any(
            one is None or isinstance(one, (bool, str)) for one in given.flat
        )
        numbers = any_object or given.dtype.kind in "iuf"
        times = given.astype(float) if numbers and not np.ma.is_masked(t) else None
    except (TypeError, ValueError):  # rows of several lengths too
        times = None
    wrong = shown(_item(t))
    if times is not None:
        outside = times[~((times >= -slack) & (times <= end + slack))]
        if not outside.size:
            return np.clip(times, 0.0, end)
        wrong = shown(float(outside[0])) if times.ndim else wrong
    told = f"{end:g}"
    if float(told) > end:  # up to what is told all is possible
        told = repr(float(end))
    raise ValueError(f"times = {wrong} is not possible: the motion goes from 0 to {told}.")


def require_choice(key: str, value: Any, choices: tuple[str, ...]) -> None:
    """Refuse a word that is none of the choices."""
    if value not in choices:
        raise SceneError(f"{key} = {shown(value)} is not possible: it must be one of {', '.join(map(repr, choices))}.")


def require_whole(key: str, value: Any, low: int, high: int) -> int:
    """A whole number as Python has it; refused if it is none from ``low`` to ``high``."""
    value = _item(value)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise SceneError(f"{key} = {shown(value)} is not possible: it must be a whole number from {low} to {high}.")
    return value
