"""The laws by name, and the one place where compiled code tells them apart.

A law but the paper's has one mode, without a stick that could break.
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from rigid import Scene, SceneLike, as_scene
from rigid.kernel.compile import apart, loop

from ..points.bristles import Carried
from ..points.data import Load, Parameters, PointForces, Shared, Slip, Tractions
from ..points.detection import Points
from ..points.normal import Foundation
from . import brush, patch, regularised
from .brush import Brush
from .law import Law
from .patch import Patch, sharing
from .regularised import Regularised

LAWS: dict[str, type[Law]] = {law.name: law for law in (Patch, Brush, Regularised)}


def example() -> tuple[tuple[Any, ...], Tractions]:
    """Arguments and a result of :func:`tractions`, of the types that compiled code has."""
    row, fives, whole, flag = np.empty(0), np.empty((0, 5)), np.empty(0, np.int64), np.empty(0, np.int8)
    shape = np.empty((0, 3))
    points = Points(whole, flag, whole, shape, shape, *[row] * 16)
    forces = PointForces(row, row, row, row, row, fives, row, fives, flag)
    carried = Carried(row, row, row, row, row, flag, flag, row, row, row)
    law = Parameters(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    load, slip = Load(0.0, 0.0, 0.0), Slip(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    answer = Tractions(Shared(False, 0.0, 0.0, 0.0, 0.0, 0.0), 0.0, 0.0, 0.0, False)
    return (forces, points, Foundation(row, row, row, 0.0, 0.0), carried, 0, load, slip, law), answer


@apart(example)
def tractions(
    forces: PointForces, points: Points, foundation: Foundation, carried: Carried, mode: int, load: Load, slip: Slip,
    law: Parameters,
) -> Any:  # fmt: skip
    """What the scene's law answers; see :class:`flexible.contact.laws.law.Law`."""
    if law.law == patch.CODE:
        return patch.tractions(forces, points, foundation, carried, mode, load, slip, law)
    if law.law == brush.CODE:
        return brush.tractions(forces, points, foundation, carried, mode, load, slip, law)
    return regularised.tractions(forces, points, foundation, carried, mode, load, slip, law)


@loop
def may_end(law: Any) -> bool:
    """Whether a mode of the law can end otherwise than off the floor."""
    return bool(law.law == patch.CODE)


@loop
def is_smoothed(law: Any) -> bool:
    """Whether friction answers to the velocity of the patch alone."""
    return bool(law.law == regularised.CODE)


@loop
def excess(law: Any, state: Any, force: float, velocity: float) -> float:
    """How far the patch is past the end of its mode: positive past it, within 1 at it, -inf where it is none.

    Counted in ``force``, a tolerance relative to 1 + N, or in ``velocity``, one on slip velocities. Of the ``state``
    here and below only what :class:`flexible.contact.laws.law.PatchState` has is looked at.
    """
    return patch.excess(law, state, force, velocity) if law.law == patch.CODE else -inf


@loop
def successor(law: Any, state: Any) -> int:
    """The mode that follows the one that has ended."""
    return patch.successor(state) if law.law == patch.CODE else state.mode


def opposite(law: Any, state: Any) -> int | None:
    """The other way of sliding than a patch slides in, or would break loose into; None of a law with one mode."""
    return patch.opposite(state) if law.law == patch.CODE else None


@loop
def care(law: Any, state: Any) -> float:
    """What share of its tolerance a step may take here, where the end of a mode magnifies errors."""
    return patch.care(law, state) if law.law == patch.CODE else 1.0


@loop
def breaks(law: Any, before: Any, now: Any) -> bool:
    """Whether the patch may break loose in a step without an event that tells when."""
    return bool(law.law == brush.CODE and brush.breaks(law, before, now))


@loop
def is_loaded(law: Any, state: Any) -> bool:
    """Whether a patch that may break so is about to."""
    return bool(law.law == brush.CODE and brush.is_loaded(law, state))


@loop
def free(law: Any, state: Any) -> int:
    """The mode in which a patch that is off the floor comes down."""
    return patch.free(state) if law.law == patch.CODE else state.mode


@loop
def sticks(law: Any, mode: int) -> bool:
    """Whether the patch as a whole holds on to the floor in this mode, to the last digit."""
    return bool(law.law == patch.CODE and mode == patch.STICK)


def rigid_limit(scene: SceneLike) -> Scene:
    """The scene whose rigid motion is the limit of this one's flexible motion; where mu_s > mu that may be another.

    ``scene`` is a scene or what says which (see :func:`rigid.simulate`).
    """
    scene = as_scene(scene)
    mu_s = LAWS[scene.contact.law].static_coefficient(scene.friction)
    return scene if mu_s == scene.friction.mu_s else scene.replace(friction={"mu_s": mu_s})


__all__ = [
    "LAWS", "breaks", "care", "excess", "free", "is_loaded", "is_smoothed", "may_end", "opposite", "rigid_limit",
    "sharing", "sticks", "successor", "tractions",
]  # fmt: skip
