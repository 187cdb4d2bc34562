"""What lies ahead of a run: how far it has still to go, and the rigid hoop from where it stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import rigid
from rigid import Kind, Motion, Release, Run, Scene
from rigid.phases.choice import LEAST_LOSS, SLIPS

from ..airborne import taken_over
from ..builder import Builder
from ..contact.laws.listing import rigid_limit
from ..models.select import Hoop
from ..models.state import State
from ..time.advance import SHORTEST


def rest_of(run: Run, builder: Builder) -> Run | None:
    """How far there is still to run; None if that is reached."""
    if run.turns is not None:
        left = run.turns - len(builder.turns)
        return Run(turns=left) if left > 0 else None
    if run.t_end is not None:
        return Run(t_end=run.t_end - builder.t) if run.t_end - builder.t >= SHORTEST else None
    return run


def from_release(scene: Scene, run: Run) -> Motion:
    """The motion of the rigid hoop that stands for a flexible one from the release on."""
    return rigid.simulate(rigid_limit(scene.replace(run=run)))


def from_here(scene: Scene, hoop: Hoop, state: State, run: Run) -> Motion:
    """The motion of the rigid hoop that takes over from a flexible one where that stands, on the floor or in a hop."""
    omega, slip, aloft = taken_over(hoop, state)
    release = Release(float(state.pos[2]), omega, slip)
    begun = replace(scene.solve, start="equilibrium")  # undeformed it is let go once
    return rigid.simulate(rigid_limit(replace(scene, release=release, run=run, solve=begun)), aloft)


def slips_no_more(motion: Motion) -> bool:
    """Whether a run to rest is over where this rigid motion begins."""
    slips = [phase.t_end for phase in motion.phases if phase.kind != Kind.ROLL]
    if not slips or motion.scene.friction.mu == 0:
        return True
    if len(slips) < SLIPS:
        return False
    return _takes_next_to_nothing(motion, slips[int(SLIPS) - 1])


def _takes_next_to_nothing(motion: Motion, t: float) -> bool:
    """Whether a rigid motion has lost as little by then as ends a run to rest."""
    before, after = motion.at(np.array([0.0, t])).energy
    return bool(before - after <= LEAST_LOSS * after)


def whirls(motion: Motion) -> bool:
    """Whether a run to turns has none to wait for: this rigid motion has none, and has done with slipping but for what
    a patch creeps.
    """
    if motion.scene.run.turns is None or motion.period is None or motion.turns:
        return False
    slipped = max((phase.t_end for phase in motion.phases if phase.kind != Kind.ROLL), default=0.0)
    return _takes_next_to_nothing(motion, slipped)
