"""A stage of a step, before it is solved and after, on any ring.

The stages (:mod:`flexible.time.methods`) all have the form ``pos = pos_pred + d, vel = vel_pred + d/beta,
acc = d/beta^2`` with the small increment d as the unknown.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class Predictor(NamedTuple):
    """A stage's form: pos = ``pos`` + d, vel = ``vel`` + d/``beta``, acc = d/``beta``^2."""

    pos: Any
    vel: Any
    beta: float
    guess: Any  # of d


class Near(NamedTuple):
    """The last stage that was solved, where Newton on the next one begins, and what is expected of that."""

    window: Any  # first rim element and number of elements
    u: Any  # displacement of its nodes
    pos: Any
    elastic: float  # N_el there
    expected: float  # N_el here
    known: float  # share of 1 + N to which forces are to be found


class Stage(NamedTuple):
    """One stage of a step, solved or not; of one that is not, only ``ok`` and ``window`` have a meaning."""

    ok: bool
    d: Any = None  # increment of pos
    acc: Any = None
    forces: Any = None  # of the floor on all coordinates
    matrix: Any = None  # Newton's; the model's own business
    window: Any = None  # first rim element and number of elements
    u: Any = None
    nodal: Any = None
    res: Any = None
    bristles: Any = None
