"""The march of :mod:`flexible.time.advance` compiled for the arrays of a chain.

In a module of its own, so that its compiled code has a home of its own: whether a machine has that of a reduced hoop
says nothing of this one.
"""

from __future__ import annotations

from rigid.kernel.compile import jit, part

from ..chain import stage, whole
from ..models.state import rotation
from .advance import advance
from .events import sight
from .stages import take

take_chain = part(
    take, module=__name__, solved=stage.solved_in_step, held=whole.held_by, floor_forces=whole.floor_forces,
    momentum_error=whole.momentum_error,
)  # fmt: skip
sight_chain = part(sight, module=__name__, rotation=part(rotation, module=__name__, held=whole.held_by))
advance_chain = jit(
    advance, module=__name__, needs=(stage.solve_stage,), tried=take_chain, held=whole.held_by,
    energies_of=whole.energies_of, lacks=whole.lacks, sight=sight_chain,
)  # fmt: skip
