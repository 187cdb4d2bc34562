"""What is told of an atlas."""

from __future__ import annotations

from ..plots.sheet import Column, Sheet
from .study import Atlas

TOLD = 5e-5
"""Share of the area from which on a sequence is listed."""


def atlas_sheets(atlas: Atlas) -> list[Sheet | str]:
    """The sequences by their share of the map, and what it took."""
    told = [region for region in atlas.regions if region.share >= TOLD]
    across, up = atlas.plane.keys
    left = atlas.regions[len(told) :]  # the smallest, as these are largest first
    plural = "s" if len(left) > 1 else ""
    said = f"{len(left)} more sequence{plural} of less than {100 * TOLD:g} % each: atlas.json has all."
    count, runs = (f"{number:,}".replace(",", " ") for number in (atlas.sequence.size, atlas.found.runs))
    return [
        Sheet(
            f"The first pulse over {across} and {up}",
            [Column("phases", [region.phases for region in told], words=True)],
            [Column("of the map [%]", [f"{100 * region.share:.2f}" for region in told])],
        ),
        *([said] if left else []),
        f"{count} hoops in {atlas.seconds:.1f} s by {runs} runs, boundaries to a quarter of a square.",
    ]
