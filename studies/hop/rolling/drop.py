"""How far the normal force falls where a slip begins, by which an undamped hoop is thrown up.

What holds an elastic hoop up is pressed as before the jump, and undamped N swings about the force behind it from the
one in front. A wall softer than the floor, a linear spring, lets it come down to 2 N_behind - N_front: below 0, so that
the hoop leaves the floor, from a ratio of 2 on. The patch under a stiffer wall, N ~ depth^(3/2), does from 5/2 on.
"""

from __future__ import annotations

from itertools import pairwise

from rigid import Kind, Run, Scene

from .limit import rigid_motion


def drop(scene: Scene) -> float | None:
    """N in front of over N behind the first slip out of a roll of the rigid hoop to which a scene's tends, up to its
    first turn; None without one.
    """
    motion = rigid_motion(scene.to_dimensionless(), Run(turns=1))
    for phase, after in pairwise(motion.phases):
        if phase.kind is Kind.ROLL and after.kind in (Kind.SPIN, Kind.SKID):
            front, behind = (float(motion.at(after.t_start, side).normal_force) for side in ("left", "right"))
            return front / behind
    return None
