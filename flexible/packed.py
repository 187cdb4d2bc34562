"""What a file keeps of a motion, as arrays and plain data, and states of its ring as arrays and back.

What has one size in all states of a hoop is stacked; what has not (the rim near the floor, the points in contact) is
laid end to end, with its lengths.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid.output.file import Stored

from .contact.points.data import Bristles, Rates, Resultants
from .models.state import State
from .motion import FlexibleMotion

Arrays = dict[str, NDArray[Any]]

COURSE = ("step", "pace", "attempts", "turns", "way", "stalls")  # what of where a march stands a file keeps as it is

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


def stored(motion: FlexibleMotion, pieces: Sequence[tuple[dict[str, Any], Arrays]]) -> Stored:
    """What a file keeps of a motion: its pieces, each as plain data and arrays, where each march stands, and the states
    of the ring if the motion has them."""
    arrays: Arrays = {}
    for number, (_, found) in enumerate(pieces):
        arrays |= {f"{number}.{name}": column for name, column in found.items()}
    marches = []
    for number, (marched, turned) in enumerate(motion.marches):
        course = marched.course
        arrays |= {f"march{number}.{name}": a for name, a in pack([marched.state, course.now.state]).items()}
        if motion.kept:
            arrays |= {f"kept{number}.{name}": a for name, a in pack(motion.kept[number].states).items()}
        marches.append({
            "attempts": marched.attempts, "turned": turned,
            "course": {name: getattr(course.now, name) for name in COURSE}, "length": course.length,
            "books": course.now.books._asdict(),
        })  # fmt: skip
    lists = {name: [dataclasses.asdict(item) for item in getattr(motion, name)] for name in ("phases", "turns")}
    pulses = [dataclasses.asdict(dataclasses.replace(pulse, sample=None)) for pulse in motion.pulses]
    told = {
        **lists, "pulses": pulses, "pieces": [piece for piece, _ in pieces],
        "ledger": dataclasses.asdict(motion.ledger), "ended": motion.ended, "period": motion.period,
        "completed": motion.completed, "steps": motion.steps, "history": motion.history is not None,
        "marches": marches, "kept": bool(motion.kept),
    }  # fmt: skip
    return Stored("flexible", told, arrays)
