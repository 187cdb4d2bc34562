"""Values with numbers that may be unknown, and are the same where they are unknown alike."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np


class Same:
    """A dataclass whose ``==`` and hash take two NaN for the same number, as ``array_equal(equal_nan=True)`` does."""

    __slots__ = ()

    def _compared(self) -> tuple[Any, ...]:
        """The values that count, None where one is NaN, and arrays as their shape and entries."""
        assert dataclasses.is_dataclass(self)
        values = (getattr(self, field.name) for field in dataclasses.fields(self) if field.compare)
        return tuple(map(_known, values))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Same) or type(other) is not type(self):
            return NotImplemented
        return self._compared() == other._compared()

    def __hash__(self) -> int:
        return hash(self._compared())


def _known(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.shape, tuple(None if entry != entry else entry for entry in value.ravel().tolist())
    return None if value != value else value
