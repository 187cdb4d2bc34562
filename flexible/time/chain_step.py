"""The step of :mod:`flexible.time.stages` compiled for the arrays of a chain.

In a module of its own, so that its compiled code has a home of its own: whether a machine has that of a reduced hoop
says nothing of this one.
"""

from __future__ import annotations

from rigid.kernel.compile import jit

from ..chain import stage, whole
from .stages import take

take_chain = jit(
    take, module=__name__, solved=stage.solved_in_step, held=whole.held_by, floor_forces=whole.floor_forces,
    momentum_error=whole.momentum_error,
)  # fmt: skip
