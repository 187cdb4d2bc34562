"""The rigid hoop to which an elastic one tends: what a roll is held against."""

from __future__ import annotations

from flexible import rigid_limit
from rigid import Motion, Run, Scene, simulate


def rigid_motion(scene: Scene, run: Run | None = None) -> Motion:
    """From the scene's release as far as ``run`` says, or the scene; of the static coefficient that its law leaves."""
    limit = rigid_limit(scene)
    return simulate(limit if run is None else limit.replace(run=run))
