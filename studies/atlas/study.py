"""The atlas: a map of rigid hoops over two quantities."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rigid import SceneError, SceneLike, as_scene, scene_to_dict
from rigid.allowed import shown
from rigid.lists import phases_of
from rigid.output import summary

from ..running.files import write_whole
from .plane import Array, Plane, Region, plane, words
from .refine import FIRST, Map, refined

OVER = (("hoop.k", 0.02, 0.9), ("friction.mu", 0.02, 1.0))
"""Sections 3.1 and 3.2 of the paper in one plane."""
SIDE = 1024

LARGEST = 8192
"""Most squares along a side, as of ``hoop study atlas --side``."""

SHADE = 1 / 256
"""How far a value may be off in the middle between hoops that were run, where one is run to see it: a shade of a
picture, of its range. Beside the middle it may be some half more, and a few shades where values bend or jump between
(README.md, "A map of rigid hoops")."""


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class Atlas(summary.Summarised):
    """A map of (side + 1)^2 hoops over two quantities; rows run up, columns across.

    Attributes
    ----------
    plane : Plane
        Scene and axes.
    x : (side + 1,) array
        Values across.
    y : (side + 1,) array
        Values up.
    found : Map
        Sequences, values, hops, jams; which were run.
    regions : tuple of Region
        What the contact does in the pulse and the share of the map in which it does, largest first.
    seconds : float
        Wall time it took.
    """

    plane: Plane
    x: Array
    y: Array
    found: Map
    regions: tuple[Region, ...]
    seconds: float = field(compare=False)

    @property
    def sequence(self) -> NDArray[np.int64]:
        """Phases of the first pulse by number, (side + 1, side + 1)."""
        return self.found.sequence

    @property
    def impulse_share(self) -> Array:
        """J_F/(mu J_N), (side + 1, side + 1); NaN where there is no pulse."""
        return self.found.values[0]

    @property
    def friction_loss(self) -> Array:
        """Over M g R."""
        return self.found.values[1]

    @property
    def peak_normal_force(self) -> Array:
        """Over M g."""
        return np.asarray(10 ** self.found.values[2])

    def save(self, path: Path) -> Path:
        """All arrays as npz, whole or not at all."""
        across, up = self.plane.keys
        names = np.array([[str(region.sequence), region.phases] for region in self.regions])
        arrays = {
            across: self.x,
            up: self.y,
            "sequence": self.sequence,
            "sequence_within_squares": self.found.squares,
            "sequences": names,
            "impulse_share": self.impulse_share.astype(np.float32),
            "friction_loss": self.friction_loss.astype(np.float32),
            "peak_normal_force": self.peak_normal_force.astype(np.float32),
            "hops": self.found.hops,
            "jams": self.found.jams,
            "computed": self.found.computed,
        }

        def fill(part: Path) -> None:
            with part.open("wb") as file:  # savez would add a suffix to a name
                np.savez_compressed(file, allow_pickle=False, **arrays)

        return write_whole(Path(path), fill)

    def plot(self) -> Figure:
        """The map as a picture."""
        from .figures import Drawn, picture

        return picture(Drawn(self.plane, self.found, self.regions))

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        return {
            "scene": scene_to_dict(self.plane.scene),
            "over": {axis.key: [axis.low, axis.high] for axis in (self.plane.across, self.plane.up)},
            "side": len(self.x) - 1,
            "hoops": self.sequence.size,
            "computed": self.found.runs,
            "seconds": self.seconds,
            "regions": [
                {"sequence": r.sequence, "phases": r.phases, "share": r.share} for r in self.regions
            ],
            "hopping": float(self.found.hops.mean()),
            "jamming": float(self.found.jams.mean()),
            "paper": [{"scene": name, "x": x, "y": y} for name, x, y in self.plane.scenes_of_the_paper()],
        }  # fmt: skip

    def _title(self) -> str:
        return f"Atlas over {' and '.join(self.plane.keys)}: {self.sequence.size} hoops, {self.found.runs} of them run"

    def _lines(self) -> list[summary.Line]:
        return [(f"{region.share:.1%}", region.phases) for region in self.regions]


def atlas_of(
    scene: SceneLike = "paper-3.1",
    over: Mapping[str, tuple[float, float]] | Sequence[tuple[str, float, float]] = OVER,
    side: int = SIDE,
    progress: Callable[[float], None] = lambda share: None,
) -> Atlas:
    """Map the first pulse of rigid hoops over two quantities.

    Parameters
    ----------
    scene : Scene, str, path or dict
        What the two quantities do not vary.
    over : mapping or sequence
        Two keys, each with the two ends of its range: ``{"hoop.k": (0.02, 0.9), "friction.mu": (0.02, 1)}``. A range
        over two decades or more runs evenly in the logarithm.
    side : int
        Squares along a side, rounded up to a multiple of 16.
    progress : callable
        Told the share that is done.

    Raises
    ------
    SceneError
        What no scene or no atlas can be.
    """
    if not (isinstance(side, int | np.integer) and 0 < side <= LARGEST):
        raise SceneError(f"side = {shown(side)} is not possible: it is a whole number of squares, from 1 to {LARGEST}.")
    chosen = plane(as_scene(scene), over)
    count = max(1, -(-side // FIRST)) * FIRST
    start = time.perf_counter()
    found = refined(lambda u, v: chosen.run(chosen.across.at(u), chosen.up.at(v)), count, SHADE, progress)
    seconds = time.perf_counter() - start
    numbers, areas = np.unique(found.squares, return_counts=True)
    regions = [
        Region(int(number), words(int(number), phases_of(max(float(number), 0.0))), float(area / found.squares.size))
        for number, area in zip(numbers, areas, strict=True)
    ]
    regions.sort(key=lambda region: -region.share)
    share = np.linspace(0.0, 1.0, count + 1)
    return Atlas(chosen, chosen.across.at(share), chosen.up.at(share), found, tuple(regions), seconds)
