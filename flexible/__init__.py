"""The flexible hoop: what happens inside an interaction pulse.

A :class:`rigid.Scene` goes in, a :class:`FlexibleMotion` comes out::

    from flexible import simulate
    from rigid import load_scene

    motion = simulate(load_scene("paper-3.3-massless"))
    motion.pulses, motion.ledger, motion.at([0.0, 1.0])

In the order in which they build on each other:

``ring``      its elasticity and inertia, from the mesh to modes and static compliance
``chain``     the same as parts between rigid sections that turn and move far
``contact``   points of the rim near the floor, the foundation under them, friction along it
``models``    a hoop that can be moved in time: reduced, all nodes, geometrically exact, chain
``time``      one implicit step; adaptive steps with located events
``handover``  where a flexible segment begins: in the equilibrium of a rigid motion
``solve``     simulate(scene); ``limit`` the rigid hoop that a contact law tends to, ``builder`` what a motion is put
              together from, ``segment`` records read as phases and pulses, ``units``, ``motion`` what comes back
``output``    displacement and stress, and all fields as a series on disk (not loaded here)
"""

from .motion import FlexibleMotion, FlexiblePulse, History, Ledger
from .solve import simulate

__all__ = ["FlexibleMotion", "FlexiblePulse", "History", "Ledger", "simulate"]
