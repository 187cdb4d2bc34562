"""States of the ring as arrays and back, for a file.

What has one size in all states of a hoop is stacked; what has not (the rim near the floor, the points in contact) is
laid end to end, with its lengths.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .contact.points.data import Bristles, Rates, Resultants
from .models.state import State

Arrays = dict[str, NDArray[Any]]

_NUMBERS = ("t", "x_C", "slip_velocity", "elastic_rate", "elastic_bend")
_WHOLE = ("mode", "window")
_STACKED = ("pos", "vel", "acc", "jerk")
_ENDED = ("u", "nodal")


def pack(states: Sequence[State]) -> Arrays:
    """States of one hoop, (n,) of them, as arrays by name."""
    arrays: Arrays = {
        **{name: np.array([getattr(state, name) for state in states]) for name in (*_NUMBERS, *_WHOLE)},
        **{name: np.stack([getattr(state, name) for state in states]) for name in _STACKED},
        "res": np.array([tuple(state.res) for state in states], dtype=float),
        "rates": np.array([tuple(state.rates) for state in states], dtype=float),
        "nodes": np.array([len(state.u) for state in states]),
        "points": np.array([len(state.bristles.number) for state in states]),
    }
    for name in _ENDED:
        arrays[name] = np.concatenate([getattr(state, name) for state in states])
    for name in Bristles._fields:
        arrays[f"bristles.{name}"] = np.concatenate([getattr(state.bristles, name) for state in states])
    return arrays


def unpack(arrays: Mapping[str, NDArray[Any]]) -> tuple[State, ...]:
    """The states again, the same to the last bit.

    Raises
    ------
    KeyError, ValueError, IndexError, TypeError
        Arrays that :func:`pack` did not make.
    """
    nodes, points = (np.cumsum(arrays[name])[:-1] for name in ("nodes", "points"))
    ended = {name: np.split(arrays[name], nodes) for name in _ENDED}
    bristles = {name: np.split(arrays[f"bristles.{name}"], points) for name in Bristles._fields}
    states = []
    for i in range(len(arrays["t"])):
        values: dict[str, Any] = {name: float(arrays[name][i]) for name in _NUMBERS}
        values |= {name: arrays[name][i].copy() for name in _STACKED}
        values |= {name: ended[name][i].copy() for name in _ENDED}
        first, count = arrays["window"][i].tolist()
        res, rates = Resultants(*arrays["res"][i].tolist()), Rates(*arrays["rates"][i].tolist())
        points_of = Bristles(**{name: bristles[name][i].copy() for name in Bristles._fields})
        states.append(
            State(
                mode=int(arrays["mode"][i]), window=(first, count), res=res, bristles=points_of, rates=rates, **values
            )
        )
    return tuple(states)
