"""Which ring a scene stands on: elements around it and through its wall, by its tolerance, stiffness and wall."""

from __future__ import annotations

import gc
from functools import lru_cache
from math import ceil, inf, log2, pi, sqrt

from meshes import ring_mesh
from rigid import Scene

from .fem import Ring, membrane_stiffness
from .possible import ensure_thick

AROUND = 240  # elements where no tolerance asks for more
MESH_ERROR, MESH_ORDER = 3e-5, 3.4  # with so many, of the impulses over J_N; order with which it falls
MESH_WALL, MESH_THIN = 0.02, 1.75  # wall over R at which it is that, power with which it grows as the wall gets thinner
MESH_SOFT = 400.0  # bending stiffness from which on it is less, like its root
DENTED = 0.033  # wall over R from which on a stiff floor dents it rather than bends it
DENT_ERROR, MOST_DENT = 100.0, 1e-4  # the same where the floor dents the wall, times E b in m g/R, and at most
THICK = 1 / 6  # wall from which on that is more, and a pulse knows more of what the elements through it leave
MOST_AROUND, MOST_THROUGH = 1200, 10  # the compliance of so long a rim is 180 MB
FAR_ERROR, FAR_SOFT, FAR_SOFTER = 1e-4, 10.0, 1.6  # a ring that bends far: its error at so small an E I, and its power
MOST_FAR = 480  # around such a ring: its sections pay in every step
UNEVEN, FELT = 0.7, 1e-3  # by how much over E b places on an element give; share of a patch's own that is felt
PULSE, GENTLE = 100.0, 3.0  # weights that press in a pulse, and always: what is as wide as an element feels no places
KEPT = 8  # rings, with what was made of them
STOUT = 2.0  # wall over the distance of the rim's nodes from which on the wall is dented there before it bends


@lru_cache(maxsize=KEPT)
def _shared_ring(wall: float, elements: int, through: int, halved: int, weld: float, poisson: float) -> Ring:
    if _shared_ring.cache_info().currsize == KEPT:
        gc.collect()  # those that are not kept any more and what was made of them refer to each other
    return Ring(ring_mesh(1 - wall, 1.0, elements, through, weld, halved=halved), poisson)


def forget_rings() -> None:
    """Keep none of the rings so far for scenes to come, nor what was made of them: a fine one's take some 0.5 GB."""
    _shared_ring.cache_clear()
    gc.collect()  # they and what was made of them refer to each other


def elements_through(wall: float, rtol: float = inf) -> int:
    """Elements through a wall, its thickness over R, by which the ring is good to 0.1 %; to less below rtol = 1e-4.

    With t of them the frequencies n = 2...4 of a free ring, and its compliances to outer tractions cos n theta, are off
    by at most 1.2 wall^2/t^4; that is ten times rtol, of which a pulse of a thin ring knows a fortieth, and of one
    beyond ``THICK`` more and more, like the wall's fifth power (README.md, section 2).
    """
    known = 10 * min(1.0, (THICK / wall) ** 5)
    return max(1, min(MOST_THROUGH, ceil((1.2 * wall**2 / min(1e-3, known * rtol)) ** 0.25)))


def halved_at_rim(wall: float, around: int, through: int) -> int:
    """How often the outermost elements of a thick wall are halved toward the rim: to half of their length along it.

    A dent is as deep as it is wide, and a stiff floor's is as wide as the rim's elements can tell.
    """
    length = 2 * pi / around
    return max(0, round(log2(2 * wall / (through * length)))) if wall > DENTED else 0


def mesh_error(bending_stiffness: float, wall: float) -> float:
    """What ``AROUND`` elements leave in the impulses of a pulse, over J_N; the wall over R, its E I in m g R^2.

    Found where they leave most, at an undamped brush under a ring of E I = 65 with mass; of thick soft walls by how
    deep the floor dents them where that is narrower than an element (README.md, section 2; `hoop bench mesh`).
    """
    bent = MESH_ERROR * (MESH_WALL / wall) ** MESH_THIN * min(1.0, sqrt(MESH_SOFT / bending_stiffness))
    if wall <= DENTED:
        return bent
    return max(bent, min(DENT_ERROR * wall**3 / (12 * bending_stiffness), MOST_DENT * max(1.0, wall / THICK)))


def elements_around(rtol: float, bending_stiffness: float, wall: float) -> int:
    """Elements around a ring whose mesh leaves no more than a third of ``rtol``."""
    error = mesh_error(bending_stiffness, wall)
    return min(max(AROUND, ceil(AROUND * (3 * error / rtol) ** (1 / MESH_ORDER))), MOST_AROUND)


def elements_bent_far(rtol: float, bending_stiffness: float) -> int:
    """The same around a ring whose sections turn far, 240 to 480; what they leave is of the first order."""
    error = FAR_ERROR * (FAR_SOFT / bending_stiffness) ** FAR_SOFTER
    return min(max(AROUND, 2 * round(AROUND / 2 * 3 * error / rtol)), MOST_FAR)


def feels_places(scene: Scene, around: int) -> bool:
    """Whether a floor knows the places on an element of a rim of so many from each other.

    It does where what they give by differs by a share of its own patch's depth under the weight, and that patch is
    narrow: the floor's own, in a pulse, within half an element, the one that Hertz has on a rigid floor, under little
    more than the weight, within one. A patch that is damped by more is as much the stiffer for what comes as fast.
    """
    foundation, weight = scene.contact.stiffness, 1 + scene.hoop.mass_ratio
    half_width, elastic = (1.5 * weight / foundation) ** (1 / 3), membrane_stiffness(scene)
    share, length = UNEVEN * 2 * foundation * half_width / elastic, 2 * pi / around
    narrow = 2 * half_width * PULSE ** (1 / 3) < length and sqrt(GENTLE * 4 * weight / (pi * elastic)) < length
    return max(1.0, scene.contact.damping) * share > FELT and narrow


def elements_of_stout(wall: float) -> int:
    """Elements around from which on a wall is thick beside the distance of their nodes."""
    return ceil(STOUT * pi / wall)


def ring_of(scene: Scene, through: int = 1, linear: bool = True) -> Ring:
    """The ring of a scene; one is built per shape, and shared by all stiffnesses, masses and contacts.

    ``through`` is the least number of elements through the wall. Unless the scene says how many, its tolerance does,
    and how many around: of a ``linear`` ring, or of one whose sections turn far.

    Raises
    ------
    SceneError
        The wall is too thin for quads.
    """
    ensure_thick(scene.wall)
    rtol, bending_stiffness = scene.solve.rtol, scene.ring.bending_stiffness
    through = scene.solve.through or max(through, elements_through(scene.wall, rtol if linear else inf))
    around = scene.solve.elements or (
        elements_around(rtol, bending_stiffness, scene.wall) if linear else elements_bent_far(rtol, bending_stiffness)
    )
    stout = max(around, elements_of_stout(scene.wall))
    most = MOST_AROUND if linear else MOST_FAR
    if not scene.solve.elements and stout <= most and feels_places(scene, stout):
        around = stout
    halved = halved_at_rim(scene.wall, around, through)
    return _shared_ring(scene.wall, around, through, halved, scene.ring.weld_half_angle, scene.ring.poisson)
