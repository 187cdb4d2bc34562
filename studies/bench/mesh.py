"""`hoop bench mesh`: what elements leave of a pulse, by the wall and its stiffness, and what they are chosen by.

Scene B with other walls, with steps, modes and points that leave nothing to speak of: on 240 elements around, on those
that ``RTOL`` chooses, and on three times as many around and through. In impulses and loss, over J_N.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from flexible.ring.choice import AROUND, elements_through, forget_rings, mesh_error
from rigid import Scene

from .knobs import FINER, MOST_AROUND, MOST_THROUGH, Setting, pulse_at
from .race import Claim, Result, Row
from .truth.reference import errors, scene_b

RTOL = 1e-4
STILL = 3e-6  # of all that is no mesh
OVER, MOST = 4.0, 0.5  # what is stated: times what is assumed of 240 elements, times RTOL of the chosen ones
STATED = (
    1.5e-3,
    0.17,
)  # walls over R of which it is: in thinner ones rounding leaves more, in thicker ones those through
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
    wall = place.scene.wall
    still, chosen = Setting.of(place.scene, STILL), Setting.of(place.scene, RTOL)
    usual = replace(still, around=AROUND, through=elements_through(wall))
    finest = {
        "around": min(FINER * chosen.around, MOST_AROUND), "through": min(FINER * chosen.through, MOST_THROUGH),
    }  # fmt: skip
    return {
        "usual": usual,
        "chosen": replace(still, around=chosen.around, through=chosen.through),
        "finest": replace(still, **finest),
    }


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """What the meshes leave, and what is stated of it."""
    result, everywhere = Result(), list(places(quick))
    over: dict[str, float] = {}
    left = 0.0
    for number, place in enumerate(everywhere):
        true = pulse_at(place.scene, meshes(place)["finest"])
        for mesh, setting in meshes(place).items():
            if mesh == "finest":
                continue
            row = Row(SOLVER, f"{setting.around} x {setting.through}, {mesh}", place.title, [])
            result.rows.append(row)
            start = time.process_time()
            off, peak = errors(pulse_at(place.scene, setting), true)
            row.seconds.append(time.process_time() - start)
            assumed = mesh_error(place.scene.ring.bending_stiffness, place.scene.wall)
            row.error, row.more = off, {"error_peak": peak, "assumed": assumed, "wall": place.scene.wall}
            if not STATED[0] < place.scene.wall < STATED[1]:
                continue
            if mesh == "chosen":
                left = max(left, off / RTOL)
            else:
                over[place.name] = max(over.get(place.name, 0.0), off / assumed)
        forget_rings()
        if progress is not None:
            progress((number + 1) / len(everywhere))
    result.claims = [
        Claim(f"{name}: what {AROUND} around leave, over what is assumed", most, OVER, at_most=True)
        for name, most in over.items()
    ]
    result.claims.append(
        Claim(f"chosen at rtol {RTOL:.0e}: the most that is left, over rtol", left, MOST, at_most=True)
    )
    return result
