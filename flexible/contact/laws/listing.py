"""The laws by name, and the one place where compiled code tells them apart."""

from __future__ import annotations

from typing import Any

from rigid import Scene
from rigid.kernel.compile import loop

from . import brush, patch, regularised
from .brush import Brush
from .law import Law
from .patch import Patch, sharing
from .regularised import Regularised

LAWS: dict[str, type[Law]] = {law.name: law for law in (Patch, Brush, Regularised)}


@loop
def tractions(
    forces: Any, points: Any, foundation: Any, carried: Any, mode: int, load: Any, slip: Any, law: Any
) -> Any:  # fmt: skip
    """What the scene's law answers; see :class:`flexible.contact.laws.law.Law`."""
    if law.law == patch.CODE:
        return patch.tractions(forces, points, foundation, carried, mode, load, slip, law)
    if law.law == brush.CODE:
        return brush.tractions(forces, points, foundation, carried, mode, load, slip, law)
    return regularised.tractions(forces, points, foundation, carried, mode, load, slip, law)


def rigid_limit(scene: Scene) -> Scene:
    """The scene whose rigid motion is the limit of this one's flexible motion; where mu_s > mu that may be another."""
    mu_s = LAWS[scene.contact.law].static_coefficient(scene.friction)
    return scene if mu_s == scene.friction.mu_s else scene.replace(friction={"mu_s": mu_s})


__all__ = ["LAWS", "rigid_limit", "sharing", "tractions"]
