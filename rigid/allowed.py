"""What a scene may hold: every refusal is one sentence with the key, the value and what is allowed."""

from __future__ import annotations

import sys
from math import log10
from typing import Any


class SceneError(ValueError):
    """A scene that cannot be: one sentence that names the key, the value and what is allowed."""


def require(
    key: str, value: Any, low: float, high: float, allowed: str, *, open_low: bool = False, open_high: bool = False
) -> None:
    """Refuse a value that is no finite number from ``low`` to ``high``, which belong to it unless open."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if number and abs(value) <= sys.float_info.max:
        above = value > low if open_low else value >= low
        below = value < high if open_high else value <= high
        if above and below:
            return
    elif number:
        allowed = "it must be a finite number"
    raise SceneError(f"{key} = {shown(value)} is not possible: {allowed}.")


def shown(value: Any) -> str:
    """A value as a sentence can show it: a whole number that no float holds by its power of ten."""
    if isinstance(value, int) and abs(value) > sys.float_info.max:
        return f"{'-' if value < 0 else ''}10^{round(value.bit_length() * log10(2))} or so"
    return repr(value)


def require_choice(key: str, value: Any, choices: tuple[str, ...]) -> None:
    """Refuse a word that is none of the choices."""
    if value not in choices:
        raise SceneError(f"{key} = {value!r} is not possible: it must be one of {', '.join(map(repr, choices))}.")


def require_whole(key: str, value: Any, low: int, high: int) -> None:
    """Refuse what is no whole number from ``low`` to ``high``."""
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise SceneError(f"{key} = {shown(value)} is not possible: it must be a whole number from {low} to {high}.")
