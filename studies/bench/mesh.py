"""`hoop bench mesh`: what elements leave of a pulse, by the wall and its stiffness, and what they are chosen by.

Scene B with other walls, with steps, modes and points that leave nothing to speak of: on 240 elements around, on those
that ``RTOL`` chooses, and on three times as many around and through. In impulses and loss, over J_N.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import nan
from typing import NamedTuple

from flexible.ring.choice import AROUND, elements_through, forget_rings, mesh_error
from rigid import Scene

from .knobs import Setting, pulse_at
from .race import Claim, Result, Row
from .truth.reference import errors, scene_b

RTOL = 1e-4
STILL = 3e-6  # of all that is no mesh
OVER = 4.0  # what is stated of 240 elements, times what is assumed of them
ROUNDED = 1.5e-3  # wall over R: in a thinner one more elements through it leave more, by rounding
MOST, MOST_ROUNDED, THICKEST = 0.5, 1.0, 0.17  # of the chosen ones, times RTOL, and the wall up to which it is stated
RADII = (1.001, 1.002, 1.005, 1.01, 1.02, 1.05, 1.1, 1.2, 1.5)
RINGS = ((65.0, 0.0), (1e3, 0.0), (1e4, 0.0), (1e4, 1.0))  # E I and damping ratio
SOLVER = "hoop-pulse reduced"


class Place(NamedTuple):
    """A wall and its stiffness."""

    name: str  # of the ring
    r: float
    scene: Scene

    @property
    def title(self) -> str:
        """The row's, in tables and figures."""
        return f"r = {self.r:g}, {self.name}"


def places(quick: bool) -> Iterator[Place]:
    """From walls that hardly have a thickness to a third of R."""
    for bending, damping in RINGS[:1] if quick else RINGS:
        name = f"E I = {bending:g}" + (", damped" if damping else "")
        for r in (1.005, 1.05, 1.2) if quick else RADII:
            ring, contact = {"bending_stiffness": bending}, {"damping": damping}
            yield Place(name, r, scene_b().replace(hoop={"r": r}, ring=ring, contact=contact))


def meshes(place: Place) -> dict[str, Setting]:
    """240 elements, the chosen ones and the finest, everything else the same."""
    still, chosen = Setting.of(place.scene, STILL), Setting.of(place.scene, RTOL)
    on_chosen = replace(still, around=chosen.around, through=chosen.through)
    finest = on_chosen.on_finer_elements()
    if place.scene.wall < ROUNDED:
        finest = replace(finest, through=chosen.through)
    return {
        "usual": replace(still, around=AROUND, through=elements_through(place.scene.wall)),
        "chosen": on_chosen,
        "finest": finest,
    }


def compared(place: Place) -> dict[str, Row]:
    """What the meshes but the finest leave against it; where a run did not come to its end, that is a note."""
    tried = meshes(place)
    finest = tried.pop("finest")
    assumed = mesh_error(place.scene.ring.bending_stiffness, place.scene.wall)
    rows = {mesh: Row(SOLVER, f"{by.around} x {by.through}, {mesh}", place.title, []) for mesh, by in tried.items()}
    try:
        true = pulse_at(place.scene, finest)
        for mesh, row in rows.items():
            start = time.process_time()
            off, peak = errors(pulse_at(place.scene, tried[mesh]), true)
            row.seconds.append(time.process_time() - start)
            row.error, row.more = off, {"error_peak": peak, "assumed": assumed, "wall": place.scene.wall}
    except RuntimeError as trouble:
        for row in rows.values():
            row.note = "" if row.seconds else str(trouble)
    finally:
        forget_rings()
    return rows


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """What the meshes leave, and what is stated of it."""
    result, everywhere = Result(), list(places(quick))
    over: dict[str, float] = {}
    left: dict[float, list[float]] = {MOST: [], MOST_ROUNDED: []}
    for number, place in enumerate(everywhere):
        rows = compared(place)
        result.rows += rows.values()
        if not any(row.note for row in rows.values()):
            usual, chosen = rows["usual"], rows["chosen"]
            over[place.name] = max(over.get(place.name, 0.0), usual.error / usual.more["assumed"])
            if place.scene.wall < THICKEST:
                left[MOST if place.scene.wall > ROUNDED else MOST_ROUNDED].append(chosen.error / RTOL)
        if progress is not None:
            progress((number + 1) / len(everywhere))
    result.claims = [
        Claim(f"{name}: what {AROUND} around leave, over what is assumed", times, OVER, at_most=True)
        for name, times in over.items()
    ]
    for at_most, found in left.items():
        if found or at_most == MOST:
            said = "" if at_most == MOST else f" in a wall below {ROUNDED}"
            name = f"chosen at rtol {RTOL:.0e}: the most that is left{said}, over rtol"
            result.claims.append(Claim(name, max(found, default=nan), at_most, at_most=True))
    return result
