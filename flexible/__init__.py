"""The flexible hoop: what happens inside an interaction pulse.

A :class:`rigid.Scene` goes in, a :class:`FlexibleMotion` comes out::

    from flexible import simulate
    from rigid import load_scene

    motion = simulate(load_scene("paper-3.3-massless"))
    motion.pulses, motion.ledger, motion.at([0.0, 1.0])

In the order in which they build on each other:

the ring       ``ring`` its elasticity, ``reduction`` to modes and static compliance, ``nodal`` all nodes
the frame      ``frame`` inertia in axes that float on the disk
the contact    ``points`` of the rim near the floor, ``foundation`` under them, ``friction`` along it,
               ``tangent`` from points to unknowns, ``contact`` all of it together, ``touch`` the law and the window
               of a scene
the levels     ``reduced``, ``full``, ``exact`` hoops behind one interface, ``levels`` which a scene gets
time           ``step`` one implicit stage, ``state`` an instant and what is kept of it, ``trial`` one step,
               ``march`` adaptive steps and located events
a run          ``rest`` equilibrium, ``start`` hand-over from a rigid motion, ``limit`` the rigid hoop a law tends
               to, ``solve`` simulate(scene), ``pieces`` what it is put together from, ``stretch`` records read as
               phases and pulses, ``units``, ``motion`` what comes back
fields         ``interior`` displacement and stress, ``profile`` of the patch, ``rim``, ``curves``,
               ``fields`` all of it as a series on disk
"""

from .motion import FlexibleMotion, FlexiblePulse, History, Ledger
from .solve import simulate

__all__ = ["FlexibleMotion", "FlexiblePulse", "History", "Ledger", "simulate"]
