"""Which scenes the flexible hoop cannot be: said before anything is built, run or written."""

from __future__ import annotations

from rigid import Scene, SceneError, SceneLike, as_scene

THINNEST = 9e-4  # wall over R: quads are too long for a thinner one, and rounding errors of their stretching too large

LEAST_MASS = 1e-8  # mass of the hoop over the disk's, if it has one: steps do not follow a lighter one's vibrations

WIDEST = 1.0  # half-width over R of the patch under the weight: no point of a hoop is further to either side than R


def ensure_possible(scene: SceneLike) -> None:
    """Of a scene in any units, or what says which (see :func:`rigid.simulate`).

    Raises
    ------
    SceneError
        A point mass without inertia, which cannot ride on a flexible hoop, a hoop that has next to no mass, a wall too
        thin for quads, or a floor too soft to stand on.
    """
    scene = as_scene(scene)
    if scene.hoop.k == 0 and scene.hoop.mass_ratio == 0:
        raise SceneError(
            "hoop.k = 0 is not possible here: the flexible hoop needs a disk with a radius, or a hoop with a mass."
        )
    if 0 < scene.hoop.mass_ratio < LEAST_MASS:
        raise SceneError(
            f"hoop.mass_ratio = {scene.hoop.mass_ratio:g} is not possible here: so light a ring vibrates too fast "
            f"for any step; take 0, with which the hoop moves alike, or {LEAST_MASS:g} and more."
        )
    ensure_thick(scene.to_dimensionless().wall)
    _ensure_stands(scene)


def _ensure_stands(scene: Scene) -> None:
    """Whether the patch under the weight of disk and hoop is one that a hoop can have."""
    least = 1.5 * (1 + scene.hoop.mass_ratio) / WIDEST**3
    if scene.contact.stiffness <= least:
        half = WIDEST * (least / scene.contact.stiffness) ** (1 / 3)
        raise SceneError(
            f"contact.stiffness = {scene.contact.stiffness:g} is not possible here: under the weight of disk and hoop "
            f"the patch would reach {half:.3g} R to either side, and only above {least:.4g} is that less than R."
        )


def ensure_thick(wall: float) -> None:
    """Of a wall, its thickness over R.

    Raises
    ------
    SceneError
        It is too thin for quads.
    """
    if wall < THINNEST:
        raise SceneError(
            f"the wall is {wall:.2g} R, too thin for the quads of the flexible ring: from {THINNEST:g} R on its "
            "bending is known; with hoop.r = 1 and ring.thickness = 0.001 it is the same line, of the same "
            "ring.bending_stiffness."
        )
